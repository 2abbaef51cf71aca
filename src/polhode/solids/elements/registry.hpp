// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/elements/kernels.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::solids {

/// A type of solid element in the model file.
struct ElementKind {
  std::string name;     ///< "element" of a solid in the model file.
  std::string meaning;  ///< One line.
  std::string shape;    ///< A cell_shape() that defines the order of nodes and the faces.
  Quadrature stiffness;
  Quadrature mass;             ///< Separate rules, since others would give singular masses.
  std::string warning = {};    ///< Limitation of the element; "" if none.
  double least_stretch = 0.0;  ///< Principal stretch below which it is unreliable.
  double most_poisson = 0.5;   ///< Poisson's ratio above which it locks.
  int kernel = 0;              ///< Index in kElementSizes.

  [[nodiscard]] const CellShape& cell() const { return cell_shape(shape); }
  [[nodiscard]] const ElementSizes& sizes() const { return kElementSizes[kernel]; }
};

/// Every type of element, in the order of the documentation.
[[nodiscard]] const std::vector<ElementKind>& element_kinds();

/// The element type of this name. @throws InputError that lists the names if it is unknown.
[[nodiscard]] const ElementKind& element_kind(std::string_view name);

/// Element for cells of a shape: "hex8" means hex8_eas9, or hex8_q1p0 for uncoupled materials; a
/// kind's own name means itself; "" chooses by the shape of the cells.
/// @param where  Path of the solid in the user's model.
/// @param wanted  Name given by the user, may be empty.
/// @param shape  Shape of the cells.
/// @throws InputError if there is none, or it does not support shape or material.
[[nodiscard]] const ElementKind& choose_element(std::string_view where, std::string_view wanted,
                                                std::string_view shape, bool uncoupled);

}  // namespace polhode::solids
