// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/elements/kernels.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode {

/// A type of solid element as users name it.
struct ElementKind {
  std::string name;     ///< "element" of a solid in the model file.
  std::string meaning;  ///< One line.
  std::string shape;    ///< A cell_shape(): nodes in its order, faces as it has them.
  Quadrature stiffness;
  Quadrature mass;             ///< Rules of their own: others would make singular masses.
  std::string warning = {};    ///< What a user of it should know; "" if nothing.
  double least_stretch = 0.0;  ///< Below this principal stretch it is not to be trusted.
  double most_poisson = 0.5;   ///< Above this Poisson's ratio it locks.
  int kernel = 0;              ///< Place in kElementSizes.

  [[nodiscard]] const CellShape& cell() const { return cell_shape(shape); }
  [[nodiscard]] const ElementSizes& sizes() const { return kElementSizes[kernel]; }
};

/// Every type of element, in the order of the documentation.
[[nodiscard]] const std::vector<ElementKind>& element_kinds();

/// The element type of this name. @throws InputError that lists the names if it is unknown.
[[nodiscard]] const ElementKind& element_kind(std::string_view name);

/// What suits cells of a shape: "hex8" is taken as hex8_eas9, or hex8_q1p0 for uncoupled materials;
/// a kind's own name stands for itself; "" chooses by the shape of the cells.
/// @param where   Path of the solid in the user's model.
/// @param wanted  What the user wrote, may be empty.
/// @param shape   Shape of the cells.
/// @throws InputError if there is none, or it does not suit shape or material.
[[nodiscard]] const ElementKind& choose_element(std::string_view where, std::string_view wanted,
                                                std::string_view shape, bool uncoupled);

}  // namespace polhode
