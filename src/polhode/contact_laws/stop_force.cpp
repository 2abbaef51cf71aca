// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/contact_laws/stop_force.hpp>

namespace polhode::contact {

namespace {

/// Distance to the floor of the barrier, as a part of its band, below which its force is continued
/// linearly: only iterates get there. Larger in statics, whose iterates are not limited.
constexpr double kStraight = 1e-9, kStraightStatics = 1e-3;

template <class Force>
ForceAndSlope straightened(const NormalLaw& law, double gap, double part, Force&& force) {
  const double least = law.floor() + part * law.band();
  Dual x(std::max(gap, least));
  x.d[0] = 1.0;
  const Dual f = force(x);
  return {gap < least ? f.v + f.d[0] * (gap - least) : f.v, f.d[0]};
}

}  // namespace

ForceAndSlope stop_force(const NormalLaw& law, const GapStep& gap) {
  if (!gap.conserving) {
    const ForceAndSlope end =
        straightened(law, gap.at_n1, kStraightStatics, [&](const Dual& g) { return law.force(g); });
    return {(1.0 - gap.alpha_f) * law.force(gap.at_n) + gap.alpha_f * end.value,
            gap.alpha_f * end.slope};
  }
  return straightened(law, gap.at_n1, kStraight, [&](const Dual& g) {
    const Dual end = law.force(g);
    const Dual quotient =
        law.quotient(gap.at_n, g) + (gap.alpha_f - 0.5) * (end - law.force(gap.at_n));
    return (1.0 - gap.end_share) * quotient + gap.end_share * end;
  });
}

}  // namespace polhode::contact
