// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace polhode {

/// A group of elements with unknowns of their own, such as enhanced strains or pressures: what
/// ElementGroup::advance() moves, and what a search goes back to when an iterate is of no use.
/// Numbers of two sets may be mixed: a·x + b·y is a set in between.
class InternalUnknowns {
 public:
  virtual ~InternalUnknowns() = default;
  [[nodiscard]] virtual std::size_t unknowns_size() const = 0;  ///< Of the whole group.
  virtual void get_unknowns(const double* scratch, double* unknowns) const = 0;
  virtual void set_unknowns(const double* unknowns, double* scratch) const = 0;
  /// Largest difference of those that two states hold, from their histories of this group [m].
  [[nodiscard]] virtual double difference(const double* history,
                                          const double* other_history) const = 0;
};

}  // namespace polhode
