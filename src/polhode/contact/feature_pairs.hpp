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

  /// Key that identifies the pair within its two shapes and sorts it; the same in every step and
  /// run.
  [[nodiscard]] std::uint64_t key() const {
    return (static_cast<std::uint64_t>(pair.kind) << 57) |
           (static_cast<std::uint64_t>(swapped) << 56) |
           (static_cast<std::uint64_t>(pair.i) << 28) | static_cast<std::uint64_t>(pair.j);
  }
};

/// Appends the feature pairs of two shapes whose gap at the given placements may be below
/// `distance`, sorted by key. Shapes that are both planes have none.
///
/// Corners of each shape are paired with the solid of the other, edges with edges; round solids
/// with planes at their extreme points, with edges, and with each other. Parallel straight sides
/// are in contact at the discs at their ends. A tube is represented by the cylinder between its
/// outer rims, by its rims and by its inner side.
/// @eq{contact-sum-of-features}
void near_feature_pairs(const geometry::Shape& first, const geometry::Shape& second,
                        const Placement<double>& at_first, const Placement<double>& at_second,
                        double distance, std::vector<OrderedPair>& found);

}  // namespace polhode::contact
