// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/axis_drag.hpp>

#include <cmath>
#include <limits>

#include <polhode/loads/pair_duals.hpp>

namespace polhode {

namespace {

using Dual = PairDuals::Dual;
using DualVector = PairDuals::Vector;

Vec3 by_axis(const LoadDescription& load, const std::string& key) {
  return {load.value(key + ".x", 0.0), load.value(key + ".y", 0.0), load.value(key + ".z", 0.0)};
}

/// A vector with its derivative by one body's increments.
DualVector with_derivative(const Vec3& value, const Mat3& by, int first) {
  DualVector v{Dual(value.x()), Dual(value.y()), Dual(value.z())};
  Dual* const component[3] = {&v.x, &v.y, &v.z};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) component[i]->d[first + k] = by(i, k);
  return v;
}

/// Motion of b relative to a over the step, at the place of b's point, with all derivatives.
struct Flow {
  DualVector arm_a, arm_b, velocity, turning;
};

Flow flow_of(const PairStep& step, const PairDuals& pair, const Vec3& Z_b) {
  const BodyStep &a = step.a, &b = step.b;
  const double af = b.alpha_f;
  const auto velocity = [af](const BodyStep& body, int first) {
    return with_derivative(body.velocity_alpha(), af * body.rate * Mat3::Identity(), first);
  };
  const auto turning = [](const BodyStep& body, int first) {
    return with_derivative(body.omega_alpha(), body.omega_alpha_tangent(), first + 3);
  };
  const DualVector place = pair.point_b(Z_b).mean(af), turn_a = turning(a, 0),
                   turn_b = turning(b, 6);
  Flow f;
  f.arm_a = place - pair.point_a(Vec3::Zero()).mean(af);
  f.arm_b = place - pair.point_b(Vec3::Zero()).mean(af);
  f.turning = turn_b - turn_a;
  f.velocity =
      (velocity(b, 6) + cross(turn_b, f.arm_b)) - (velocity(a, 0) + cross(turn_a, f.arm_a));
  return f;
}

Dual resistance(double linear, double quadratic, const Dual& v) {
  return (linear + quadratic * (v.v < 0.0 ? -v : v)) * v;
}

std::vector<double> report_of_axis_drag(const InteractionGroup& group, int item,
                                        const PairStep& step) {
  return items_of<AxisDrag>(group)[static_cast<std::size_t>(item)].report(step);
}

}  // namespace

AxisDrag::AxisDrag(const LoadDescription& load)
    : Z_b_(load.Z_b),
      R_b_(load.R_b),
      linear_(by_axis(load, "linear")),
      quadratic_(by_axis(load, "quadratic")),
      turning_(by_axis(load, "turning")),
      quadratic_turning_(by_axis(load, "quadratic_turning")) {
  name = load.name;
  bodies = load.bodies;
}

void AxisDrag::evaluate(const PairStep& step, PairTerms& t) const {
  const PairDuals pair(step);
  const Flow f = flow_of(step, pair, Z_b_);
  DualVector force = contact::constant<Dual>(Vec3::Zero()), moment = force;
  for (int i = 0; i < 3; ++i) {
    const DualVector e = pair.vector_b(R_b_.col(i)).mean(step.b.alpha_f);
    force = force - resistance(linear_[i], quadratic_[i], dot(e, f.velocity)) * e;
    moment = moment - resistance(turning_[i], quadratic_turning_[i], dot(e, f.turning)) * e;
  }
  pair.add(force, f.arm_a, f.arm_b, t);
  pair.add_couple(moment, t);
  clear_ground_sides(step, t);
}

/// Signs of the components with a quadratic part, whose second derivatives jump at zero.
void AxisDrag::pieces(const PairStep& step, ForcePieces& pieces) const {
  const PairDuals pair(step);
  const Flow f = flow_of(step, pair, Z_b_);
  for (int i = 0; i < 3; ++i) {
    const DualVector e = pair.vector_b(R_b_.col(i)).mean(step.b.alpha_f);
    if (quadratic_[i] != 0.0) pieces.add(dot(e, f.velocity).v > 0.0 ? 1.0 : 0.0);
    if (quadratic_turning_[i] != 0.0) pieces.add(dot(e, f.turning).v > 0.0 ? 1.0 : 0.0);
  }
}

Work AxisDrag::work(const PairStep& step) const {
  const PairDuals pair(step);
  const Flow f = flow_of(step, pair, Z_b_);
  const auto lost = [](double linear, double quadratic, double v) {
    return (linear + quadratic * std::abs(v)) * v * v;
  };
  double power = 0.0;
  for (int i = 0; i < 3; ++i) {
    const DualVector e = pair.vector_b(R_b_.col(i)).mean(step.b.alpha_f);
    power += lost(linear_[i], quadratic_[i], dot(e, f.velocity).v) +
             lost(turning_[i], quadratic_turning_[i], dot(e, f.turning).v);
  }
  return {.dissipated = step.context.dt * power};
}

std::vector<double> AxisDrag::report(const PairStep& step) const {
  PairTerms t;
  t.set_zero();
  evaluate(step, t);
  const bool from_b = step.b.moves;
  const Vec3 force = from_b ? Vec3(t.wrench_b.head<3>()) : Vec3(-t.wrench_a.head<3>());
  const Vec3 arm =
      from_b ? Vec3(step.b.vector(Z_b_).at_n1) : Vec3(step.b.point(Z_b_).at_n1 - step.a.r_n1);
  const Vec3 moment =
      (from_b ? Vec3(t.wrench_b.tail<3>()) : Vec3(-t.wrench_a.tail<3>())) - arm.cross(force);
  std::vector<double> list = numbers(force);
  list.insert(list.end(), moment.data(), moment.data() + 3);
  return list;
}

LoadKind axis_drag_kind() {
  constexpr double kLargest = std::numeric_limits<double>::max();
  LoadKind kind;
  kind.name = AxisDrag::kKind;
  kind.meaning =
      "resistance of a medium, at rest relative to the first body, to the second one, by its axes";
  kind.place = LoadPlace::frames;
  kind.turns = true;
  kind.add = [](System& system, const LoadDescription& load) {
    system.group<AxisDrag>().add(load);
  };
  kind.channels = {{"force", "N", 3}, {"moment", "N m", 3}};
  kind.report = report_of_axis_drag;
  kind.vectors = {
      {"linear", "N*s/m", 0.0, 0.0, kLargest, "force per velocity along x, y, z"},
      {"quadratic", "N*s^2/m^2", 0.0, 0.0, kLargest, "force per squared velocity along x, y, z"},
      {"turning", "N*m*s/rad", 0.0, 0.0, kLargest, "moment per angular velocity about x, y, z"},
      {"quadratic_turning", "N*m*s^2/rad^2", 0.0, 0.0, kLargest,
       "moment per squared angular velocity about x, y, z"}};
  kind.needs_one_of = {"linear", "quadratic", "turning", "quadratic_turning"};
  return kind;
}

}  // namespace polhode
