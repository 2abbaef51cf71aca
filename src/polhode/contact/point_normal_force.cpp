// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/contact/contact_point.hpp>

namespace polhode::contact {

/// Normal force of a point. The damper of a spring acts on the share of the end as well: otherwise
/// that share would return what an impact has left in the spring.
NormalForce normal_force(const PointData& data, double gap_n, double gap_n1, double dt) {
  NormalLaw::WithSlope f = data.normal.quotient_and_slope(gap_n, gap_n1);
  const double quotient = f.value, share = data.end_share;
  const bool spring = data.normal.is_spring();
  const auto add_share = [&](bool now) {
    if (!now || !(share > 0.0)) return;
    const NormalLaw::WithSlope end = data.normal.force_and_slope(gap_n1);
    f = {(1.0 - share) * f.value + share * end.value, (1.0 - share) * f.slope + share * end.slope};
  };
  add_share(spring);
  if (data.rate_damping > 0.0) {
    const double factor = std::max(0.0, 1.0 - data.rate_damping / dt * (gap_n1 - gap_n));
    f.slope = factor > 0.0 ? factor * f.slope - data.rate_damping / dt * f.value : 0.0;
    f.value *= factor;
  }
  add_share(!spring);
  return {f.value, -f.slope, quotient};
}

}  // namespace polhode::contact
