// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/statics/turning_model.hpp>

namespace polhode {

namespace {

/// Change of a force, stiffness or constraint, as a part of its size, above which it is no
/// rounding.
constexpr double kChanges = 1e-6;
/// Angles by which the model is turned [rad]: no two of them, nor their sum, are a part of a turn.
constexpr double kTurns[] = {0.7, 1.9};
/// Relative size of a row of G normal to the others below which it depends on them.
constexpr double kDependent = 1e-9;

/// What an interaction with the ground exerts on its moving body, rotations in lengths of the
/// model.
struct OnGround {
  Vec6 wrench = Vec6::Zero();
  Mat6 stiffness = Mat6::Zero();  ///< With compliant rows.
  Mat6 barred = Mat6::Zero();     ///< Projection onto the motions that exact rows exclude.
  double gap = 0.0;               ///< Largest value of an exact row [m or -].
};

bool touches_ground(const InteractionRef& ref) { return (ref.a == kGround) != (ref.b == kGround); }

PairTerms terms_at(const System& system, const State& state, const InteractionRef& ref,
                   const BodyStep& a, const BodyStep& b, bool tangents) {
  const std::vector<double> none(kMaxRows, 0.0);
  StepContext context;
  context.t_n = state.t;
  context.conserving = false;
  context.tangents = tangents;
  const PairStep step{a, b, context, none.data(), state.history.data() + ref.first_history};
  PairTerms terms;
  terms.set_zero();
  const int item = ref.item;
  system.group(ref.group).evaluate({&item, 1}, {&step, 1}, {&terms, 1});
  return terms;
}

OnGround on_ground(const System& system, const State& state, const InteractionRef& ref) {
  const PairTerms t = terms_at(system, state, ref, system.instant(state, ref.a),
                               system.instant(state, ref.b), true);
  const bool first = ref.b == kGround;
  const double length = system.length_scale();
  Vec6 scale;
  scale << Vec3::Ones(), Vec3::Constant(1.0 / length);
  OnGround found;
  found.wrench = first ? t.wrench_a : t.wrench_b;
  found.stiffness = -(first ? t.D_aa : t.D_bb);
  Mat exact(6, 0);
  for (int k = 0; k < ref.rows; ++k) {
    const Vec6 G = (first ? t.G_a : t.G_b).row(k);
    const Vec6 B = (first ? t.B_a : t.B_b).col(k);
    if (t.compliance[k] > 0.0) {
      found.wrench -= B * t.g[k] / t.compliance[k];
      found.stiffness += B * G.transpose() / t.compliance[k];
      continue;
    }
    found.gap = std::max(found.gap, std::abs(t.g[k]));
    exact.conservativeResize(6, exact.cols() + 1);
    exact.rightCols<1>() = scale.cwiseProduct(G).normalized();
  }
  found.wrench = scale.cwiseProduct(found.wrench);
  found.stiffness = scale.asDiagonal() * found.stiffness * scale.asDiagonal();
  if (exact.cols() == 0) return found;
  Eigen::ColPivHouseholderQR<Mat> qr(6, exact.cols());
  qr.setThreshold(kDependent);
  qr.compute(exact);
  const Mat Q = Mat(qr.householderQ()).leftCols(qr.rank());
  found.barred = Q * Q.transpose();
  return found;
}

Mat6 both(const Mat3& R) {
  Mat6 T = Mat6::Zero();
  T.topLeftCorner<3, 3>() = T.bottomRightCorner<3, 3>() = R;
  return T;
}

/// The state turned about the axis as a whole.
State turned_state(const System& system, const State& state, const TurningFrame& frame,
                   const Mat3& R) {
  State turned = state;
  for (int b = 0; b < system.body_count(); ++b) {
    BodyMotion m = system.motion(state, b);
    m.r = frame.through + R * (m.r - frame.through);
    m.q = (Quat(R) * m.q).normalized();
    turned.set_motion(system.slot(b), m);
  }
  for (std::size_t k = 0; k < state.node_x.size(); k += 3) {
    const Vec3 x = Eigen::Map<const Vec3>(state.node_x.data() + k);
    Eigen::Map<Vec3>(turned.node_x.data() + k) = frame.through + R * (x - frame.through);
  }
  return turned;
}

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw InputError(where, what,
                   "Use what is the same in all directions about the axis, such as a revolute "
                   "joint or an isotropic bushing, or let the ground turn (spin_ground: turns)");
}

std::string path_of(const System& system, const InteractionRef& ref) {
  const std::string& kind = system.group(ref.group).kind();
  const char* map = kind == "joint" ? "joints" : kind == "cable" ? "cables" : "loads";
  return format("{}.{}", map, system.name(ref));
}

/// Checks dampers on the ground: of constant damping, the same in all directions about the axis.
void check_damper(const System& system, const State& state, const State& turned, const Mat6& T,
                  const InteractionRef& ref) {
  const char* what = "has friction or damping on the ground that is not linear in the speed";
  if (ref.rows > 0) refuse(path_of(system, ref), what);
  const Mat6 C = damping_on_ground(system, state, ref);
  const bool first = ref.b == kGround;
  const BodyStep ground = BodyStep::ground(1.0);
  const int body = first ? ref.a : ref.b;
  const BodyMotion m = system.motion(state, body);
  const auto wrench = [&](double speed) -> Vec6 {
    const Vec3 v = speed * system.length_scale() * Vec3(0.6, -0.5, 0.4);
    const Vec3 w = speed * Vec3(-0.3, 0.7, 0.2);
    const BodyStep step = BodyStep::at_instant(m.r, m.Lambda(), v, m.q.conjugate() * w);
    const PairTerms t = first ? terms_at(system, state, ref, step, ground, false)
                              : terms_at(system, state, ref, ground, step, false);
    return first ? t.wrench_a : t.wrench_b;
  };
  const Vec6 still = wrench(0.0), once = wrench(1.0) - still, thrice = wrench(3.0) - still;
  if ((thrice - 3.0 * once).norm() > kChanges * thrice.norm()) refuse(path_of(system, ref), what);
  const Mat6 C_turned = damping_on_ground(system, turned, ref);
  if ((T * C * T.transpose() - C_turned).norm() > kChanges * C.norm())
    refuse(path_of(system, ref), "damps other motions of the model as it turns on the ground");
}

void check_interactions(const System& system, const State& state, const State& turned,
                        const Mat3& R) {
  const Mat6 T = both(R);
  for (const InteractionRef& ref : system.interactions()) {
    if (!touches_ground(ref)) continue;
    const OnGround at = on_ground(system, state, ref), then = on_ground(system, turned, ref);
    const double length = system.length_scale();
    const double stiffness = at.stiffness.norm() + then.stiffness.norm();
    if ((T * at.barred * T.transpose() - then.barred).norm() > kChanges ||
        then.gap > at.gap + kChanges * std::max(1.0, length))
      refuse(path_of(system, ref), "holds other motions of the model as it turns on the ground");
    if ((T * at.stiffness * T.transpose() - then.stiffness).norm() > kChanges * stiffness ||
        (T * at.wrench - then.wrench).norm() >
            kChanges * (at.wrench.norm() + then.wrench.norm()) + 1e-9 * stiffness * length)
      refuse(path_of(system, ref), "exerts another force as the model turns on the ground");
    if (system.traits(ref).dissipates) check_damper(system, state, turned, T, ref);
  }
}

/// Forces of a group of elements on all nodes.
std::vector<double> node_forces(const System& system, const State& state, int g) {
  const Nodes& nodes = system.nodes();
  StepContext context;
  context.t_n = state.t;
  context.conserving = false;
  std::vector<double> force(3 * static_cast<std::size_t>(nodes.count()), 0.0);
  std::vector<double> scratch(nodes.group(g).scratch_size(), 0.0);
  const double* history = state.element_history.data() + nodes.first_history(g);
  nodes.group(g).begin_step(history, scratch.data());
  (void)nodes.group(g).evaluate(node_instant(system, state, context), history, scratch.data(),
                                Mat3::Identity(), {force.data(), nullptr, nullptr});
  return force;
}

void check_nodes(const System& system, const State& state, const State& turned, const Mat3& R) {
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    const bool held = nodes[i].body == kGround;
    const bool prescribed = std::any_of(nodes.prescribed().begin(), nodes.prescribed().end(),
                                        [&](const PrescribedComponent& p) { return p.node == i; });
    const NodePlace place = nodes.place_of(i);
    if ((held || prescribed) && place.group >= 0)
      refuse(nodes.group(place.group).name(),
             held ? "is bonded to the ground, which does not turn with it"
                  : "has prescribed nodes, which do not turn with it");
  }
  for (int g = 0; g < nodes.group_count(); ++g) {
    if (!nodes.group(g).external() && !nodes.group(g).barrier_constraint()) continue;
    const std::vector<double> at = node_forces(system, state, g);
    const std::vector<double> then = node_forces(system, turned, g);
    double change = 0.0, size = 0.0;
    for (std::size_t k = 0; k < at.size(); k += 3) {
      const Vec3 f = Eigen::Map<const Vec3>(at.data() + k);
      size = std::max(size, f.norm());
      change = std::max(change, (R * f - Eigen::Map<const Vec3>(then.data() + k)).norm());
    }
    if (change > kChanges * size)
      refuse(nodes.group(g).name(), "exerts another force as the model turns on the ground");
  }
}

}  // namespace

Mat6 damping_on_ground(const System& system, const State& state, const InteractionRef& ref) {
  const bool first = ref.b == kGround;
  const BodyMotion m = system.motion(state, first ? ref.a : ref.b);
  const BodyStep ground = BodyStep::ground(1.0);
  const double speed = system.length_scale();
  Mat6 C;
  for (int c = 0; c < 6; ++c) {
    const double h = c < 3 ? speed : 1.0;
    Vec6 change = Vec6::Zero();
    for (const double side : {1.0, -1.0}) {
      Vec6 rate = Vec6::Zero();
      rate[c] = side * h;
      const BodyStep step = BodyStep::at_instant(m.r, m.Lambda(), rate.head<3>(),
                                                 m.q.conjugate() * Vec3(rate.tail<3>()));
      const PairTerms t = first ? terms_at(system, state, ref, step, ground, false)
                                : terms_at(system, state, ref, ground, step, false);
      change += side * (first ? t.wrench_a : t.wrench_b);
    }
    C.col(c) = -change / (2.0 * h);
  }
  return C;
}

/// @eq{spin-invariance}
void check_turning(const System& system, const State& state, const TurningFrame& frame) {
  const Vec3& g = system.gravity();
  if ((frame.across() * g).norm() > kChanges * g.norm())
    throw InputError("gravity", "is not along the axis of the spin, in whose frame it turns",
                     "Leave gravity out, or let the axis be vertical");
  if (frame.ground_turns || frame.speed == 0.0) return;
  for (const double angle : kTurns) {
    const Mat3 R = exp_map(angle * frame.axis);
    const State turned = turned_state(system, state, frame, R);
    check_interactions(system, state, turned, R);
    check_nodes(system, state, turned, R);
  }
}

}  // namespace polhode
