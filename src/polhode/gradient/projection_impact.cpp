// SPDX-License-Identifier: Apache-2.0
// The impact of a unilateral row behind the projection of the velocities.
#include <algorithm>
#include <cmath>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/gradient/kkt_product.hpp>
#include <polhode/gradient/projection_derivative.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;

/// Step of the differences of a row by places, as a part of the mechanism's size or in radians.
constexpr double kImpactStep = 1e-3;

/// Parts of a vector over all bodies that belong to those of a row; zero for the ground.
Vec12 of_bodies(const InstantRow& row, const Vec& x) {
  Vec12 of = Vec12::Zero();
  if (row.a != kGround) of.head<6>() = x.segment<6>(6 * row.a);
  if (row.b != kGround) of.tail<6>() = x.segment<6>(6 * row.b);
  return of;
}

void add_to_bodies(const InstantRow& row, const Vec12& of, Vec& x) {
  if (row.a != kGround) x.segment<6>(6 * row.a) += of.head<6>();
  if (row.b != kGround) x.segment<6>(6 * row.b) += of.tail<6>();
}

Vec12 gradient_of(const InstantRow& row) {
  Vec12 J;
  J << row.by_a, row.by_b;
  return J;
}

/// Velocities of both bodies of a row, world.
Vec12 speeds(const System& system, const State& state, const InstantRow& row) {
  Vec12 v = Vec12::Zero();
  for (const auto& [body, at] : {std::pair(row.a, 0), std::pair(row.b, 6)}) {
    if (body == kGround) continue;
    const BodyMotion m = system.motion(state, body);
    v.segment<6>(at) << m.v, m.omega();
  }
  return v;
}

/// v + d + e v, along which the row is zero.
Vec12 zero_speed(const System& system, const ProjectionStage& stage) {
  const InstantRow& row = stage.impact->row;
  return (1.0 + row.restitution) * speeds(system, stage.at, row) + of_bodies(row, stage.x);
}

}  // namespace

/// @eq{impact-derivative}
void add_impact_terms(const System& system, const ProjectionStage& stage, const InstantRow& row,
                      Vec& out) {
  const Vec12 J = gradient_of(row), v = speeds(system, stage.at, row);
  add_to_bodies(row, -stage.impact->impulse * J, out);
  out[out.size() - 1] = J.dot((1.0 + row.restitution) * v + of_bodies(row, stage.x));
}

/// Bodies that joints connect with those of a row, directly or through others.
void ProjectionDerivative::tie_bodies(const InstantRow& row) {
  const int n = system_->body_count();
  DisjointSets sets(static_cast<std::size_t>(n));
  for (const InteractionRef& ref : system_->interactions())
    if ((ref.rows > 0 || system_->traits(ref).coupled_mass != 0.0) && ref.a != kGround &&
        ref.b != kGround)
      sets.join(ref.a, ref.b);
  if (row.a != kGround && row.b != kGround) sets.join(row.a, row.b);
  const int of_row = sets.first_of(row.a != kGround ? row.a : row.b);
  ties_.assign(static_cast<std::size_t>(n), 0);
  for (int b = 0; b < n; ++b)
    ties_[static_cast<std::size_t>(b)] = sets.first_of(b) == of_row ? 1 : 0;
}

/// Changes the velocities of the bodies that take part.
void ProjectionDerivative::jump(const Vec& x) {
  for (int b = 0; b < system_->body_count(); ++b) {
    if (!takes_part(b)) continue;
    BodyMotion m = system_->motion(projected_, b);
    m.v += x.segment<3>(6 * b);
    m.W += m.Lambda().transpose() * x.segment<3>(6 * b + 3);
    projected_.set_motion(system_->slot(b), m);
  }
}

/// @eq{impact-derivative}
void ProjectionDerivative::linearize_impact(const State& given, InstantRows& rows,
                                            const InstantRow& row) {
  stages_.clear();
  linear_.clear();
  projected_ = given;
  tie_bodies(row);
  if (system_->rows() > 0) {
    add_stage(given, true);
    jump(stages_.back().x);
  }
  add_stage(projected_, true);
  ProjectionStage& stage = stages_.back();
  Linear& l = linear_.back();
  stage.impact = StageImpact{row, 0.0};
  const double speed = gradient_of(row).dot(speeds(*system_, projected_, row));
  const Vec none = Vec::Zero(6 * system_->body_count() + system_->rows());
  double impulse = 0.0;
  stage.x = solve_impact(stage, l, none, -(1.0 + row.restitution) * speed, 0.0, false, impulse);
  stage.impact->impulse = impulse;
  differentiate_places(stage, l);
  differentiate_impact(stage, rows, l);
  jump(stage.x);
}

void ProjectionDerivative::differentiate_impact(const ProjectionStage& stage, InstantRows& rows,
                                                Linear& l) const {
  const InstantRow& row = stage.impact->row;
  const std::vector<BodyStep> steps = instant_steps(*system_, stage.at);
  const Vec12 zero = zero_speed(*system_, stage);
  l.impulse_by_q.setZero();
  l.speed_by_q.setZero();
  for (int i = 0; i < 12; ++i) {
    const int body = i < 6 ? row.a : row.b;
    if (body == kGround) continue;
    const double d = kImpactStep * (i % 6 < 3 ? system_->length_scale() : 1.0);
    const auto at = [&](double k) {
      std::vector<BodyStep> moved = steps;
      BodyStep& x = moved[static_cast<std::size_t>(body)];
      const Vec3 move = k * d * Vec3::Unit(i % 3);
      x = i % 6 < 3
              ? BodyStep::at_instant(x.r_n1 + move, x.Lambda_n1, x.v_n1, x.W_n1)
              : BodyStep::at_instant(
                    x.r_n1, quaternion_from_rotation_vector(move).toRotationMatrix() * x.Lambda_n1,
                    x.v_n1, x.W_n1);
      return gradient_of(rows.same(stage.at, moved, stage.at.history.data(), row));
    };
    const Vec12 by = (2.0 / 3.0 * (at(1.0) - at(-1.0)) - 1.0 / 12.0 * (at(2.0) - at(-2.0))) / d;
    l.impulse_by_q.col(i) = -stage.impact->impulse * by;
    l.speed_by_q[i] = by.dot(zero);
  }
}

Vec ProjectionDerivative::solve_impact(const ProjectionStage& stage, const Linear& l,
                                       const Vec& rhs, double of_row, double size, bool transposed,
                                       double& impulse) {
  const InstantRow& row = stage.impact->row;
  Vec column = Vec::Zero(rhs.size());
  add_to_bodies(row, gradient_of(row), column);
  const Vec response = solve(stage, l, column, column.lpNorm<Eigen::Infinity>(), transposed);
  Vec x = size > 0.0 ? solve(stage, l, rhs, size, transposed) : Vec(Vec::Zero(rhs.size()));
  const double mobility = column.dot(response);
  if (transposed) {
    impulse = column.dot(x) / mobility;
    x -= impulse * response;
  } else {
    impulse = (of_row - column.dot(x)) / mobility;
    x += impulse * response;
  }
  return x;
}

Vec ProjectionDerivative::push_impact(const ProjectionStage& stage, const Linear& l, const Vec& dq,
                                      const Vec& dv, double input, Vec rhs, double size) {
  const InstantRow& row = stage.impact->row;
  const Vec12 moved = of_bodies(row, dq), J = gradient_of(row);
  const Vec12 turned = l.impulse_by_q * moved;
  add_to_bodies(row, -turned, rhs);
  const double of_row =
      -(l.speed_by_q.dot(moved) + (1.0 + row.restitution) * J.dot(of_bodies(row, dv)) + input);
  double impulse = 0.0;
  return solve_impact(stage, l, rhs, of_row, std::max(size, turned.lpNorm<Eigen::Infinity>()),
                      false, impulse);
}

void ProjectionDerivative::pull_impact(const ProjectionStage& stage, const Linear& l, const Vec& x,
                                       double of_row, Vec& of_q, Vec& of_v) const {
  const InstantRow& row = stage.impact->row;
  add_to_bodies(row, l.impulse_by_q.transpose() * of_bodies(row, x) + of_row * l.speed_by_q, of_q);
  add_to_bodies(row, (1.0 + row.restitution) * of_row * gradient_of(row), of_v);
}

}  // namespace polhode
