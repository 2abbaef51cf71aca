// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace polhode {

/// Interface of a group of elements with internal unknowns, such as enhanced strains or pressures:
/// those updated by ElementGroup::advance(), and restored by a line search. Linear combinations a·x
/// + b·y of two sets are valid sets.
class InternalUnknowns {
 public:
  virtual ~InternalUnknowns() = default;
  [[nodiscard]] virtual std::size_t unknowns_size() const = 0;  ///< Of the whole group.
  virtual void get_unknowns(const double* scratch, double* unknowns) const = 0;
  virtual void set_unknowns(const double* unknowns, double* scratch) const = 0;
  /// Largest difference of the unknowns in two states, from their histories of this group [m].
  [[nodiscard]] virtual double difference(const double* history,
                                          const double* other_history) const = 0;
};

}  // namespace polhode
