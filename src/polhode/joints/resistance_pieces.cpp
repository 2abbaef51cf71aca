// SPDX-License-Identifier: Apache-2.0
// States of friction and stops of a joint, for steps that end where these change, its report and
// its inertia.
#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/joints/resistance_coordinates.hpp>

namespace polhode {

namespace {

/// Name of the state of a stop on which nothing rests.
constexpr double kFree = 2.0;

}  // namespace

double Resistance::inertia_about(const Vec3& axis, const BodyStep& a, const BodyStep& b) const {
  double per_inertia = 0.0;
  const BodyStep* const bodies[2] = {&a, &b};
  for (std::size_t i = 0; i < 2; ++i) {
    const Vec3 e = bodies[i]->Lambda_n1.transpose() * axis;
    const double own = e.dot(data_.friction->inertia[i] * e);
    if (own > 0.0) per_inertia += 1.0 / own;
  }
  return per_inertia > 0.0 ? 1.0 / per_inertia : 0.0;
}

void Resistance::stop_pieces(const double* memories, ForcePieces& pieces) const {
  for_limits([&](const JointLimits& limits, bool, int memory) {
    // Falling with the load of a stop at rest, and 1 without one.
    const auto stop = read_record<StopMemory>(memories + memory);
    const double load = -stop.side * stop.acceleration * limits.inertia;
    const double scale = limits.law.stiffness * limits.law.tolerance;
    const auto phase = static_cast<contact::ContactPhase>(static_cast<int>(stop.phase));
    const bool rests =
        load > 0.0 && limits.restitution < 1.0 &&
        (phase == contact::ContactPhase::rest || phase == contact::ContactPhase::landing);
    pieces.slips.push_back(rests ? (scale - load) / (scale + load) : kFree);
  });
}

void Resistance::pieces(const View& v, ForcePieces& pieces) const {
  stop_pieces(v.memory, pieces);
  if (!data_.friction) return;
  const auto memory = read_record<BristleMemory>(v.memory);
  const BodyStep& a = v.step.a;
  Vec3 kept(memory.bristle);
  if (kind_ == Kind::spherical) kept = a.Lambda_n1 * kept;
  const Vec3 rate = rates(v, v.q_n1, a, v.step.b);
  const bool slips = memory.slips != 0.0;
  const auto sign = [&](double x) { return !slips ? 0.0 : x < 0.0 ? -1.0 : 1.0; };
  // Coordinates of one cone slip in a direction that may turn without a jump.
  const bool one_cone = kind_ == Kind::cylindrical || kind_ == Kind::spherical;
  if (one_cone) return pieces.slips.push_back(sign(rate.dot(kept)));
  for (int i = 0; i < cones(); ++i)
    pieces.slips.insert(pieces.slips.end(), {sign(kept[i]), sign(rate[i] * kept[i])});
}

ResistanceReport Resistance::report(const View& v) const {
  ResistanceReport r;
  if (data_.friction) {
    const JointFriction& f = *data_.friction;
    r.count = kind_ == Kind::revolute || kind_ == Kind::prismatic      ? 1
              : kind_ == Kind::cylindrical || kind_ == Kind::universal ? 2
                                                                       : 3;
    const Motion m = motion(v, false);
    const auto memory = read_record<BristleMemory>(v.memory);
    Vec3 kept(memory.bristle);
    if (kind_ == Kind::spherical)  // from the body's to the joint's axes
      kept = v.q_n1.R_a.transpose() * (v.step.a.Lambda_n1 * kept);
    for (int i = 0; i < r.count; ++i)
      r.friction[static_cast<std::size_t>(i)] = -f.stiffness * m.of[i].lever * kept[i];
    r.slips = memory.slips != 0.0;
  }
  for_limits([&](const JointLimits& limits, bool slides, int memory) {
    const Stop stop = stop_of(v, limits, slides, place(v, slides), memory);
    (slides ? r.slide : r.turn) = stop.sign() * stop.law().force(stop.gap_n1());
  });
  for_ends([&](const JointLimits& limits, bool slides, double sign, double, int entry) {
    const double force = sign * read_record<UnilateralMemory>(v.memory + entry).force;
    (slides ? r.slide : r.turn) += (slides ? 1.0 : limits.radius) * force;
  });
  return r;
}

}  // namespace polhode
