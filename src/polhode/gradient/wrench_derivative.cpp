// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/gradient/wrench_derivative.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/system/interaction.hpp>

namespace polhode {

namespace {

/// Steps of the differences by place, as parts of the mechanism's size or in radians: the largest
/// is used unless a load is short beside it, or a law bends there.
constexpr std::array<double, 4> kPlaceSteps = {3e-4, 3e-5, 3e-6, 3e-7};
/// Part by which the differences of order two may differ from those of order four, whose error then
/// is near its square.
constexpr double kSmallTruncation = 1e-6;

BodyStep seen_backwards(const BodyStep& x) {
  BodyStep y = x;
  y.alpha_f = 1.0 - x.alpha_f;
  y.rate = 0.0;
  if (!x.moves) return y;
  std::swap(y.r_n, y.r_n1);
  std::swap(y.Lambda_n, y.Lambda_n1);
  std::swap(y.v_n, y.v_n1);
  std::swap(y.W_n, y.W_n1);
  y.u = -x.u;
  y.theta = -x.theta;
  return y;
}

/// The step from another place at t_n to the same one at t_{n+1}; velocities are held.
/// @param i  0 to 2: moved along x, y or z; 3 to 5: turned about them.
BodyStep from_elsewhere(const BodyStep& x, int i, double d) {
  BodyStep y = x;
  const Vec3 move = d * Vec3::Unit(i % 3);
  if (i < 3) {
    y.r_n += move;
    y.u -= move;
    return y;
  }
  const Quat turn = quaternion_from_rotation_vector(move);
  y.Lambda_n = turn.toRotationMatrix() * x.Lambda_n;
  const Quat left = quaternion_from_cayley(x.theta) * turn.conjugate();
  y.theta = 2.0 / left.w() * left.vec();
  return y;
}

/// The body at t_n.
BodyStep at_start(const BodyStep& x) {
  return x.moves ? BodyStep::at_instant(x.r_n, x.Lambda_n, x.v_n, x.W_n) : BodyStep::ground(1.0);
}

/// Largest force, moment and row of an interaction.
struct Sizes {
  double force = 0.0, moment = 0.0, row = 0.0;
  template <class Values>
  void include(const Values& v) {
    for (int side = 0; side < 12; side += 6) {
      force = std::max(force, v.template segment<3>(side).cwiseAbs().maxCoeff());
      moment = std::max(moment, v.template segment<3>(side + 3).cwiseAbs().maxCoeff());
    }
    row = std::max(row, v.template tail<6>().cwiseAbs().maxCoeff());
  }
  /// Largest part of these in others, of forces and moments in what is larger of the two.
  [[nodiscard]] double part_of(const Sizes& all, double length) const {
    const double f = std::max(all.force, all.moment / length);
    const auto part = [](double x, double of) { return x == 0.0 ? 0.0 : x / of; };
    return std::max({part(force, f), part(moment, f * length), part(row, all.row)});
  }
};

}  // namespace

WrenchDerivative::WrenchDerivative(const System& system) : system_(&system), map_(kkt_map(system)) {
  for (linear::KktValues* v : {&by_place_, &by_velocity_}) {
    v->diagonal.resize(static_cast<std::size_t>(system.body_count()));
    v->pairs.resize(map_.topology.pairs.size());
  }
  for (const InteractionRef& ref : system.interactions())
    backwards_.push_back(system.group(ref.group).is_of(kTypeTag<Joint>));
  terms_.set_zero();
}

void WrenchDerivative::evaluate(const State& from, const Trial& step,
                                std::span<const BodyStep> steps, double scale) {
  scale_ = scale;
  for (linear::KktValues* v : {&by_place_, &by_velocity_}) {
    for (Mat6& K : v->diagonal) K.setZero();
    for (linear::KktValues::Pair& p : v->pairs)
      for (auto* block : {&p.K_ab, &p.K_ba, &p.B_a, &p.B_b}) block->setZero();
    for (linear::KktValues::Pair& p : v->pairs) {
      p.G_a.setZero();
      p.G_b.setZero();
    }
  }
  const auto body = [&](int b) -> const BodyStep& {
    return b == kGround ? steps.back() : steps[static_cast<std::size_t>(b)];
  };
  for (std::size_t i = 0; i < system_->interactions().size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    const Sides sides{body(ref.a), body(ref.b), step.context, step.lambda.data() + ref.first_row,
                      from.history.data() + ref.first_history};
    const int at = static_cast<int>(i);
    if (backwards_[i]) {
      see_backwards(ref, sides);
      add(by_place_, at, 1.0);
      continue;
    }
    tangents(ref, sides);
    add(by_velocity_, at, 1.0);
    BodyStep a = sides.a, b = sides.b;
    a.rate = b.rate = 0.0;
    tangents(ref, {a, b, sides.context, sides.lambda, sides.history});
    add(by_velocity_, at, -1.0);
    difference(ref, sides);
    add(by_place_, at, 1.0);
  }
}

WrenchDerivative::Values WrenchDerivative::values(const InteractionRef& ref, const Sides& sides) {
  const PairStep step{sides.a, sides.b, sides.context, sides.lambda, sides.history};
  system_->group(ref.group).evaluate({&ref.item, 1}, {&step, 1}, {&terms_, 1});
  Values v;
  v << terms_.wrench_a, terms_.wrench_b, Vec6::Zero();
  for (int k = 0; k < ref.rows; ++k) v[12 + k] = terms_.g[k];
  return v;
}

void WrenchDerivative::tangents(const InteractionRef& ref, const Sides& sides) {
  StepContext context = sides.context;
  context.tangents = true;
  terms_.set_zero();
  static_cast<void>(values(ref, {sides.a, sides.b, context, sides.lambda, sides.history}));
}

void WrenchDerivative::see_backwards(const InteractionRef& ref, const Sides& sides) {
  StepContext context = sides.context;
  context.t_n = sides.context.t_n1();
  context.dt = -sides.context.dt;
  context.ga.alpha_f = 1.0 - sides.context.ga.alpha_f;
  tangents(ref, {seen_backwards(sides.a), seen_backwards(sides.b), context, sides.lambda,
                 sides.history});
  terms_.G_a.setZero();  // rows hold at t_{n+1}
  terms_.G_b.setZero();
}

/// Memory of an interaction at another place at t_n, such as the angle of a joint there.
const double* WrenchDerivative::history_at(const InteractionRef& ref, const Sides& sides) {
  const InteractionGroup& group = system_->group(ref.group);
  const int size = group.traits(ref.item).history_size;
  if (size == 0) return sides.history;
  history_.assign(sides.history, sides.history + size);
  StepContext still;
  still.t_n = sides.context.t_n;
  const BodyStep a = at_start(sides.a), b = at_start(sides.b);
  group.commit(ref.item, {a, b, still, sides.lambda, history_.data()}, history_.data());
  return history_.data();
}

/// Puts the differences into terms_ as tangents.
void WrenchDerivative::difference(const InteractionRef& ref, const Sides& sides) {
  StepContext context = sides.context;
  context.tangents = false;
  const double length = system_->length_scale();
  Eigen::Matrix<double, 18, 12> best = Eigen::Matrix<double, 18, 12>::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (const double part : kPlaceSteps) {
    Eigen::Matrix<double, 18, 12> D = Eigen::Matrix<double, 18, 12>::Zero();
    Sizes all, errors;
    for (int i = 0; i < 12; ++i) {
      const bool of_a = i < 6;
      if ((of_a ? ref.a : ref.b) == kGround) continue;
      const double d = part * (i % 6 < 3 ? length : 1.0);
      const auto at = [&](double k) {
        const BodyStep moved = from_elsewhere(of_a ? sides.a : sides.b, i % 6, k * d);
        const Sides from{of_a ? moved : sides.a, of_a ? sides.b : moved, context, sides.lambda,
                         sides.history};
        return values(ref, {from.a, from.b, context, sides.lambda, history_at(ref, from)});
      };
      const Values near = 0.5 * (at(1.0) - at(-1.0)), far = 0.5 * (at(2.0) - at(-2.0));
      const Values change = 4.0 / 3.0 * near - 1.0 / 6.0 * far;
      D.col(i) = change / d;
      all.include(change);
      errors.include(Values(change - near));
    }
    const double error = errors.part_of(all, length);
    if (error < least) {
      least = error;
      best = D;
    }
    if (error <= kSmallTruncation) break;
  }
  terms_.D_aa = best.block<6, 6>(0, 0);
  terms_.D_ab = best.block<6, 6>(0, 6);
  terms_.D_ba = best.block<6, 6>(6, 0);
  terms_.D_bb = best.block<6, 6>(6, 6);
  terms_.G_a = best.block<6, 6>(12, 0);
  terms_.G_b = best.block<6, 6>(12, 6);
}

void WrenchDerivative::add(linear::KktValues& to, int interaction, double factor) {
  const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(interaction)];
  const double s = -factor * scale_;
  if (ref.a != kGround) to.diagonal[static_cast<std::size_t>(ref.a)] += s * terms_.D_aa;
  if (ref.b != kGround) to.diagonal[static_cast<std::size_t>(ref.b)] += s * terms_.D_bb;
  const int pair = map_.pair[static_cast<std::size_t>(interaction)];
  if (pair < 0) return;
  linear::KktValues::Pair& v = to.pairs[static_cast<std::size_t>(pair)];
  v.K_ab += s * terms_.D_ab;
  v.K_ba += s * terms_.D_ba;
  v.G_a.topRows(ref.rows) += factor * terms_.G_a.topRows(ref.rows);
  v.G_b.topRows(ref.rows) += factor * terms_.G_b.topRows(ref.rows);
}

}  // namespace polhode
