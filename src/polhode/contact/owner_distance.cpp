// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Largest number of doublings of the search radius.
constexpr int kMaxDoublings = 60;

/// Distance of two shapes [m].
double distance_of(const geometry::Shape& a, const geometry::Shape& b,
                   const Placement<double>& at_a, const Placement<double>& at_b) {
  double least = std::numeric_limits<double>::infinity();
  if (!a.bounded() && !b.bounded()) return least;
  double near = 0.1 * std::min(a.size, b.size);
  if (a.bounded() && b.bounded())
    near += std::max(0.0, value(at_a.point(a.bound_centre) - at_b.point(b.bound_centre)).norm() -
                              a.bound_radius - b.bound_radius);
  std::vector<OrderedPair> found;
  // All pairs of features within the search radius `near` are in the list.
  for (int k = 0; k < kMaxDoublings && !(least <= near); ++k, near *= 2.0) {
    found.clear();
    near_feature_pairs(a, b, at_a, at_b, near, found);
    for (const OrderedPair& f : found) {
      const Gap<double> g =
          f.swapped ? gap(f.pair, b, a, at_b, at_a) : gap(f.pair, a, b, at_a, at_b);
      least = std::min(least, g.distance);
    }
  }
  return least;
}

}  // namespace

double ContactSet::distance(int owner_a, int owner_b, std::span<const BodyStep> instants) const {
  const std::pair<int, int> wanted{std::min(owner_a, owner_b), std::max(owner_a, owner_b)};
  const auto at = [&](const PlacedShape& s, int first) {
    const BodyStep& step = s.body == kGround ? instants.back() : instants[s.body];
    return Placement<double>(step.r_n, step.Lambda_n, first);
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < shapes_.size(); ++i)
    for (std::size_t j = i + 1; j < shapes_.size(); ++j)
      if (owners(shapes_[i], shapes_[j]) == wanted)
        least = std::min(least, distance_of(shapes_[i].shape, shapes_[j].shape, at(shapes_[i], 0),
                                            at(shapes_[j], 6)));
  return least;
}

}  // namespace polhode::contact
