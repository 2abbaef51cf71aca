// SPDX-License-Identifier: Apache-2.0
// Stops of joints that are rows of the step.
#include <polhode/joints/resistance_coordinates.hpp>

namespace polhode {

int Resistance::rows() const {
  int count = 0;
  for_ends([&](const JointLimits&, bool, double, double, int) { ++count; });
  return count;
}

/// @eq{contact-rows}
void Resistance::unilateral_rows(const View& v, std::vector<UnilateralRow>& list) const {
  const Motion m = motion(v, true);
  for_ends([&](const JointLimits& limits, bool slides, double sign, double limit, int) {
    const Coordinate& c = m.of[slides ? m.slide : m.turn];
    const double factor = sign * (slides ? 1.0 : limits.radius);
    list.push_back({.on_a = factor * c.on_a,
                    .on_b = factor * c.on_b,
                    .by_a = factor * c.by_a,
                    .by_b = factor * c.by_b,
                    .gap_n = factor * (c.at_n - limit),
                    .gap_n1 = factor * (c.at_n1 - limit),
                    .restitution = limits.restitution});
  });
}

void Resistance::add_stops(const View& v, const double* memory, Vec6& on_a, Vec6& on_b) const {
  const Motion m = motion(v, false);
  for_ends([&](const JointLimits& limits, bool slides, double sign, double, int entry) {
    const Coordinate& c = m.of[slides ? m.slide : m.turn];
    const double force =
        sign * (slides ? 1.0 : limits.radius) * read_record<UnilateralMemory>(memory + entry).force;
    on_a += force * c.on_a;
    on_b += force * c.on_b;
  });
}

}  // namespace polhode
