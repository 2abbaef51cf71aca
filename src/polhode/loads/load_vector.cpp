// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/loads/load_vector.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

namespace {

/// Small displacement over a length, or a small angle: about the square root of round-off.
constexpr double kSmallMove = 1e-7;

/// Interpolated orientation; at the middle half of the rotation.
Quat mean_orientation(const Mat3& Lambda_n, const Mat3& Lambda_n1, double weight) {
  const Quat from(Lambda_n), to(Lambda_n1);
  const double sign = from.dot(to) < 0.0 ? -1.0 : 1.0;
  return Quat((1.0 - weight) * from.coeffs() + weight * sign * to.coeffs()).normalized();
}

/// Derivative of a PointReading by the increment (Δr, Δθ) of its body: column k is by component k.
struct ReadingTangent {
  Eigen::Matrix<double, 3, 6> position, velocity, turn, angular_velocity;
};

ReadingTangent reading_tangent(const BodyStep& body, const Vec3& Z) {
  const Carried z = body.vector(Z);
  const double af = body.alpha_f;
  const Mat3 by_turn = body.omega_alpha_tangent();
  ReadingTangent t;
  t.position << af * Mat3::Identity(), -af * hat(z.at_n1);
  t.velocity << af * body.rate * Mat3::Identity(),
      -hat(z.at_alpha) * by_turn - af * hat_hat(body.omega_alpha(), z.at_n1);
  t.angular_velocity << Mat3::Zero(), by_turn;
  t.turn.setZero();
  const Quat mean = mean_orientation(body.Lambda_n, body.Lambda_n1, af);
  for (int k = 0; k < 3; ++k) {
    const Quat moved =
        mean_orientation(body.Lambda_n, exp_map(kSmallMove * Vec3::Unit(k)) * body.Lambda_n1, af);
    t.turn.col(3 + k) = 2.0 / kSmallMove * (moved * mean.conjugate()).vec();
  }
  return t;
}

}  // namespace

PointReading point_reading(const StepContext& context, const BodyStep& body, const Vec3& Z) {
  const Carried z = body.vector(Z);
  const Vec3 omega = body.omega_alpha();
  return {.t = context.t_alpha(),
          .position = body.point(Z).at_alpha,
          .velocity = body.velocity_alpha() + omega.cross(z.at_alpha),
          .orientation = mean_orientation(body.Lambda_n, body.Lambda_n1, body.alpha_f),
          .angular_velocity = omega};
}

LoadVector::LoadVector(const LoadDescription& load)
    : vector_(load.vector), body_fixed_(load.body_fixed) {
  if (const auto* f = std::get_if<PointFunction>(&load.of_motion)) function_ = *f;
  dead_ = !function_ && !body_fixed_ && is_constant(vector_);
  length_ = load.mass_b > 0.0 ? std::sqrt(0.5 * load.inertia_b.trace() / load.mass_b) : 0.0;
}

LoadVector::OverStep LoadVector::over_step(const PairStep& step, const Vec3& Z) const {
  const BodyStep& b = step.b;
  OverStep s{polhode::evaluate(vector_, step.context)};
  if (function_) add_function(step, Z, s);
  if (!body_fixed_) return s;
  // Components that rotate with the body are averaged like any body-fixed vector.
  const Carried carried = b.vector(s.value);
  s.value = carried.at_alpha;
  if (step.context.tangents) {
    if (function_) s.by_b = ((1.0 - b.alpha_f) * b.Lambda_n + b.alpha_f * b.Lambda_n1) * s.by_b;
    s.by_b.rightCols<3>() -= b.alpha_f * hat(carried.at_n1);
  }
  return s;
}

void LoadVector::add_function(const PairStep& step, const Vec3& Z, OverStep& s) const {
  const double factor = step.context.load_factor;
  const PointReading at = point_reading(step.context, step.b, Z);
  const Vec3 value = function_->value(at);
  s.value += factor * value;
  if (!step.context.tangents) return;
  const ReadingTangent move = reading_tangent(step.b, Z);
  if (function_->derivative) {
    const PointDerivative d = function_->derivative(at);
    s.by_b = factor * (d.position * move.position + d.velocity * move.velocity +
                       d.turn * move.turn + d.angular_velocity * move.angular_velocity);
    return;
  }
  const double length = std::max(length_, 0.01 * at.position.norm());
  for (int k = 0; k < 6; ++k) {
    const double h = kSmallMove * (k < 3 && length > 0.0 ? length : 1.0);
    PointReading moved = at;
    moved.position += h * move.position.col(k);
    moved.velocity += h * move.velocity.col(k);
    moved.angular_velocity += h * move.angular_velocity.col(k);
    moved.orientation = Quat(exp_map(h * Vec3(move.turn.col(k)))) * at.orientation;
    s.by_b.col(k) = factor / h * (function_->value(moved) - value);
  }
}

Vec3 LoadVector::value(const PairStep& step, const Vec3& Z) const {
  Vec3 v = polhode::evaluate(vector_, step.context);
  if (function_)
    v += step.context.load_factor * function_->value(point_reading(step.context, step.b, Z));
  return body_fixed_ ? step.b.vector(v).at_alpha : v;
}

Vec3 LoadVector::at_instant(const PairStep& step, const Vec3& Z) const {
  Vec3 v = polhode::evaluate(vector_, step.context.t_n1());
  if (function_) v += function_->value(point_reading(step.context, step.b, Z));
  return body_fixed_ ? step.b.vector(v).at_n1 : v;
}

CoordinateValue coordinate_value(const CoordinateFunction& f, const CoordinateReading& at,
                                 bool tangents) {
  CoordinateValue v{f.value(at)};
  if (!tangents) return v;
  if (f.derivative) {
    const CoordinateDerivative d = f.derivative(at);
    v.by_value = d.value;
    v.by_rate = d.rate;
    return v;
  }
  const auto difference = [&](double CoordinateReading::*part) {
    CoordinateReading moved = at;
    moved.*part += kSmallMove * std::max(1e-3, std::abs(at.*part));
    return (f.value(moved) - v.value) / (moved.*part - at.*part);
  };
  v.by_value = difference(&CoordinateReading::value);
  v.by_rate = difference(&CoordinateReading::rate);
  return v;
}

}  // namespace polhode
