// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <polhode/solids/elements/registry.hpp>
#include <polhode/solids/materials/material.hpp>
#include <polhode/system/element_group.hpp>
#include <polhode/system/internal_unknowns.hpp>

namespace polhode::solids {

/// Solid elements of one type and material.
struct SolidElementsDescription {
  std::string name;     ///< Of the solid, for messages: "solids.pad".
  std::string element;  ///< A kind of element_kinds().
  std::shared_ptr<const Material> material;
  double density = 0.0;           ///< In the undeformed shape [kg/m³]; positive.
  bool conserving = true;         ///< Stress by discrete gradients; false: of the averaged F.
  std::vector<int> connectivity;  ///< Numbers of nodes, element after element.
  std::span<const Vec3> X;        ///< Reference positions of all nodes [m].
  /// If the material needs them: the direction of each family, the same in all elements or element
  /// after element; any length.
  std::vector<Vec3> fibres = {};
  std::string isa = "automatic";  ///< Instruction set of the kernels: automatic, baseline, ...
};

/// Smallest principal stretch of an element.
struct LeastStretch {
  double value = 1.0;  ///< Mean over the element [-].
  int element = -1;
  Vec3 direction = Vec3::Zero();  ///< Of it in the undeformed shape [-].
};

/// A group of solid elements. `scratch` must be zero at its first use, and a first evaluation with
/// tangents must precede one without: elements with enhanced strains condense in it. work() over a
/// step uses the history of t_n: call it before commit().
class SolidElements : public ElementGroup, public InternalUnknowns {
 public:
  const InternalUnknowns* internal_unknowns() const override { return this; }
  [[nodiscard]] virtual const ElementKind& element() const = 0;
  [[nodiscard]] virtual const Material& material() const = 0;
  /// Warnings about the choice of element; empty if none.
  [[nodiscard]] virtual const std::vector<std::string>& warnings() const = 0;
  /// Volume in the undeformed shape [m³].
  [[nodiscard]] virtual double volume() const = 0;
  /// Smallest principal stretch at an instant. Some kinds of element (ElementKind::least_stretch)
  /// are unreliable below a bound; see stretch_warning().
  [[nodiscard]] virtual LeastStretch least_stretch(const NodeStep& instant,
                                                   const double* history) const = 0;
  /// Warning if the stretch is below the bound; "" otherwise.
  [[nodiscard]] virtual std::string stretch_warning(const LeastStretch& least) const = 0;
};

/// A group of elements as solid elements; null if it is of another kind.
[[nodiscard]] const SolidElements* as_solid(const ElementGroup& group);

/// @throws InputError for bad numbers of nodes, a density that is not positive, missing directions
/// of fibres, elements that are inverted or flat in the undeformed shape (which are named).
[[nodiscard]] std::unique_ptr<SolidElements> make_solid_elements(SolidElementsDescription d);

}  // namespace polhode::solids
