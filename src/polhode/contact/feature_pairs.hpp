// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include <polhode/contact/gap.hpp>

namespace polhode::contact {

/// A feature pair of two shapes in either order.
struct OrderedPair {
  FeaturePair pair;
  bool swapped = false;  ///< Side a of the pair is the second shape.

  /// Sorts and names the pair within its two shapes; the same in every step and every run.
  [[nodiscard]] std::uint64_t key() const {
    return (static_cast<std::uint64_t>(pair.kind) << 57) |
           (static_cast<std::uint64_t>(swapped) << 56) |
           (static_cast<std::uint64_t>(pair.i) << 28) | static_cast<std::uint64_t>(pair.j);
  }
};

/// Appends the feature pairs of two shapes whose gap at the given placements may be below
/// `distance`, sorted by key. Shapes that are both planes have none.
///
/// Corners of each meet the solid of the other, edges meet edges; round solids meet planes by
/// their extreme points, edges, and each other. @eq{contact-sum-of-features}
///
/// @param each_triangle  Triangles, edges and corners of surfaces as pairs of their own, for
/// impulses.
void near_feature_pairs(const Shape& first, const Shape& second, const Placement<double>& at_first,
                        const Placement<double>& at_second, double distance,
                        std::vector<OrderedPair>& found, bool each_triangle = false);

}  // namespace polhode::contact
