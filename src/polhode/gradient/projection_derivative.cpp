// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/kkt_product.hpp>
#include <polhode/gradient/projection_derivative.hpp>
#include <polhode/gradient/step_derivative.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {

namespace {

/// Proximal ε of the projection of velocities, whose solutions are swept until it has no effect.
constexpr double kProjectionProximal = 1e-8;
/// Bounds of the ε of an iteration of the positions, and its factor on the square of the largest
/// row: those of InstantSolver::assemble_positions().
constexpr double kEpsilonBySquare = 1e-2, kMostEpsilon = 1e-3;
/// Step of the differences of G by places, as a part of the mechanism's size or in radians.
constexpr double kRowStep = 1e-3;
/// Sweeps of a solution, and its remainder that is round-off [-].
constexpr int kProjectionSweeps = 40;
constexpr double kProjectionSolved = 1e-15;
/// Difference of the iterates from those of the projection, over the mechanism's size.
constexpr double kSameProjection = 1e-8;

StepContext instant_context(double t) {
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(0.0);  // α_f = 1: the instant itself
  context.conserving = false;
  context.t_n = t;
  return context;
}

std::vector<BodyStep> instants(const System& system, const State& state) {
  std::vector<BodyStep> steps;
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  return steps;
}

Vec6 velocity_of(const BodyStep& x) {
  Vec6 v;
  v << x.v_n1, x.Lambda_n1 * x.W_n1;
  return v;
}

void set_zero(const KktMap& map, linear::KktValues& values) {
  values.diagonal.assign(static_cast<std::size_t>(map.topology.bodies), Mat6::Zero());
  values.pairs.resize(map.topology.pairs.size());
  for (linear::KktValues::Pair& v : values.pairs) {
    for (Mat6* block : {&v.K_ab, &v.K_ba}) block->setZero();
    v.B_a.setZero();
    v.B_b.setZero();
    v.G_a.setZero();
    v.G_b.setZero();
    v.C.setZero();
  }
}

BodyStep moved_instant(const BodyStep& x, int i, double d) {
  const Vec3 move = d * Vec3::Unit(i % 3);
  return i < 3 ? BodyStep::at_instant(x.r_n1 + move, x.Lambda_n1, x.v_n1, x.W_n1)
               : BodyStep::at_instant(
                     x.r_n1, quaternion_from_rotation_vector(move).toRotationMatrix() * x.Lambda_n1,
                     x.v_n1, x.W_n1);
}

}  // namespace

int stage_inputs(const System& system) { return 6 * system.body_count() + system.rows() + 1; }

void stage_terms(const System& system, const ProjectionStage& stage,
                 const std::vector<double>& history, const std::vector<int>& bodies,
                 InteractionSweep& rows, double unit_mass, Vec& out) {
  const std::vector<BodyStep> steps = instants(system, stage.at);
  const int first_row = 6 * system.body_count();
  const std::vector<double> no_lambda(static_cast<std::size_t>(system.rows()), 0.0);
  out = Vec::Zero(stage_inputs(system));
  const auto displacement = [&](int body) -> Vec6 {
    return body == kGround ? Vec6(Vec6::Zero()) : Vec6(stage.x.segment<6>(6 * body));
  };
  for (const int b : bodies) {
    const BodyData& body = system.bodies()[static_cast<std::size_t>(b)];
    const Mat3& Lambda = steps[static_cast<std::size_t>(b)].Lambda_n1;
    const Vec6 d = displacement(b);
    out.segment<3>(6 * b) = body.mass / unit_mass * d.head<3>();
    out.segment<3>(6 * b + 3) =
        Lambda * (body.inertia * (Lambda.transpose() * d.tail<3>())) / unit_mass;
  }
  for (const InteractionRef& ref : system.interactions()) {
    const double m = system.traits(ref).coupled_mass / unit_mass;
    if (m == 0.0) continue;
    for (const auto& [own, other] : {std::pair(ref.a, ref.b), std::pair(ref.b, ref.a)})
      if (own != kGround)
        out.segment<3>(6 * own) += m * (displacement(other) - displacement(own)).template head<3>();
  }
  const auto field = [&](int body) -> Vec6 {
    if (body == kGround) return Vec6::Zero();
    return displacement(body) +
           (stage.velocities ? velocity_of(steps[static_cast<std::size_t>(body)]) : Vec6::Zero());
  };
  rows.run(
      steps, instant_context(stage.at.t), no_lambda.data(), history.data(),
      [&](int i, const PairStep& step, const PairTerms& t) {
        const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
        const Vec6 of_a = field(ref.a), of_b = field(ref.b);
        Vec6 rate = Vec6::Zero();
        if (stage.velocities && system.traits(ref).prescribes)
          rate = system.group(ref.group).prescribed(ref.item, step, TimeSide::kAfter).rate;
        for (int k = 0; k < ref.rows; ++k) {
          const int row = first_row + ref.first_row + k;
          const double mu = stage.x[row];
          if (ref.a != kGround) {
            out.segment<6>(6 * ref.a) -= mu * t.G_a.row(k).transpose();
            out[row] += t.G_a.row(k) * of_a;
          }
          if (ref.b != kGround) {
            out.segment<6>(6 * ref.b) -= mu * t.G_b.row(k).transpose();
            out[row] += t.G_b.row(k) * of_b;
          }
          out[row] += stage.velocities ? -rate[k] : t.g[k];
        }
      },
      true);
}

ProjectionDerivative::ProjectionDerivative(const System& system)
    : system_(&system), map_(kkt_map(system)), projector_(system), sweep_(system) {}

int ProjectionDerivative::inputs() const {
  return static_cast<int>(stages_.size()) * stage_inputs(*system_);
}

void ProjectionDerivative::linearize(const State& given) {
  stages_.clear();
  linear_.clear();
  ties_.clear();
  projected_ = given;
  const PositionReport positions = projector_.assemble_positions(projected_);
  const VelocityReport velocities = projector_.project_velocities(projected_);
  State at = given;
  for (int i = 0; i < positions.iterations; ++i) {
    add_stage(at, false);
    const Vec& x = stages_.back().x;
    for (int b = 0; b < system_->body_count(); ++b) {
      BodyMotion m = system_->motion(at, b);
      m.r += x.segment<3>(6 * b);
      m.q = (quaternion_from_cayley(x.segment<3>(6 * b + 3)) * m.q).normalized();
      at.set_motion(system_->slot(b), m);
    }
  }
  for (int b = 0; b < system_->body_count(); ++b)
    POLHODE_ASSERT((system_->motion(at, b).r - system_->motion(projected_, b).r).norm() <=
                   kSameProjection * system_->length_scale());
  if (velocities.solves > 0) add_stage(at, true);
}

void ProjectionDerivative::linearize_velocities(const State& given) {
  stages_.clear();
  linear_.clear();
  ties_.clear();
  projected_ = given;
  if (system_->rows() == 0) return;
  add_stage(given, true);
  jump(stages_.back().x);
}

void ProjectionDerivative::put_masses(const State& at, linear::KktValues& values) const {
  const double per_mass = 1.0 / system_->mean_mass();
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
    const Mat3 Lambda = system_->motion(at, b).Lambda();
    Mat6& M = values.diagonal[static_cast<std::size_t>(b)];
    M.topLeftCorner<3, 3>().diagonal().setConstant(per_mass * body.mass);
    M.bottomRightCorner<3, 3>() = per_mass * Lambda * body.inertia * Lambda.transpose();
  }
  for (std::size_t i = 0; i < system_->interactions().size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    const double m = per_mass * system_->traits(ref).coupled_mass;
    if (m == 0.0) continue;
    for (const int body : {ref.a, ref.b})
      if (body != kGround)
        values.diagonal[static_cast<std::size_t>(body)].topLeftCorner<3, 3>().diagonal().array() -=
            m;
    if (map_.pair[i] < 0) continue;
    linear::KktValues::Pair& v = values.pairs[static_cast<std::size_t>(map_.pair[i])];
    v.K_ab.topLeftCorner<3, 3>().diagonal().array() += m;
    v.K_ba.topLeftCorner<3, 3>().diagonal().array() += m;
  }
}

void ProjectionDerivative::add_stage(const State& at, bool velocities) {
  const std::vector<BodyStep> steps = instants(*system_, at);
  const std::vector<double> no_lambda(static_cast<std::size_t>(system_->rows()), 0.0);
  const int first_row = 6 * system_->body_count();
  ProjectionStage stage{.at = at, .x = {}, .velocities = velocities};
  Linear l;
  set_zero(map_, l.values);
  put_masses(at, l.values);
  Vec rhs = Vec::Zero(first_row + system_->rows());
  double largest_term = 0.0;
  sweep_.run(
      steps, instant_context(at.t), no_lambda.data(), at.history.data(),
      [&](int i, const PairStep& step, const PairTerms& t) {
        const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(i)];
        if (ref.rows == 0) return;  // in a batch with others that have rows
        linear::KktValues::Pair& v =
            l.values.pairs[static_cast<std::size_t>(map_.pair[static_cast<std::size_t>(i)])];
        v.G_a = t.G_a;
        v.G_b = t.G_b;
        v.B_a = t.G_a.transpose();
        v.B_b = t.G_b.transpose();
        v.C = kProjectionProximal * t.weight;
        Vec6 rate = Vec6::Zero();
        if (velocities && system_->traits(ref).prescribes)
          rate = system_->group(ref.group).prescribed(ref.item, step, TimeSide::kAfter).rate;
        for (int k = 0; k < ref.rows; ++k) {
          const int row = first_row + ref.first_row + k;
          if (!velocities) {
            rhs[row] = -t.g[k];
            if (std::abs(t.g[k]) > std::abs(stage.largest)) {
              stage.largest = t.g[k];
              stage.largest_row = ref.first_row + k;
            }
            continue;
          }
          const auto subtract = [&](double term) {
            rhs[row] -= term;
            largest_term = std::max(largest_term, std::abs(term));
          };
          subtract(-rate[k]);
          if (ref.a != kGround)
            subtract(t.G_a.row(k) * velocity_of(steps[static_cast<std::size_t>(ref.a)]));
          if (ref.b != kGround)
            subtract(t.G_b.row(k) * velocity_of(steps[static_cast<std::size_t>(ref.b)]));
        }
      },
      true);
  stage.epsilon = kProjectionProximal;
  if (!velocities) {
    const double by_square = kEpsilonBySquare * stage.largest * stage.largest;
    stage.epsilon = std::clamp(by_square, kProximal, kMostEpsilon);
    if (stage.epsilon != by_square) stage.largest_row = -1;
    for (linear::KktValues::Pair& v : l.values.pairs) v.C.setConstant(stage.epsilon);
  }
  l.solver = linear::make_linear_solver("block_lu");
  l.solver->analyse(map_.topology);
  if (!l.solver->factor(l.values))
    throw SolveError(
        format("The matrix of the projection at t = {:.6g} s is singular, so that it has no "
               "derivative",
               at.t),
        "Look for bodies that nothing holds");
  stage.x = solve(stage, l, rhs, largest_term, false);
  differentiate_places(stage, l);
  stages_.push_back(std::move(stage));
  linear_.push_back(std::move(l));
}

void ProjectionDerivative::differentiate_places(const ProjectionStage& stage, Linear& l) const {
  const std::vector<BodyStep> steps = instants(*system_, stage.at);
  const StepContext context = instant_context(stage.at.t);
  const int first_row = 6 * system_->body_count();
  const std::vector<double> no_lambda(kMaxRows, 0.0);
  set_zero(map_, l.by_q);
  const double per_mass = 1.0 / system_->mean_mass();
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyData& body = system_->bodies()[static_cast<std::size_t>(b)];
    const Mat3& Lambda = steps[static_cast<std::size_t>(b)].Lambda_n1;
    const Mat3 J = per_mass * Lambda * body.inertia * Lambda.transpose();
    const Vec3 d = stage.x.segment<3>(6 * b + 3);
    // d(J) d = dφ × J d − J (dφ × d)
    l.by_q.diagonal[static_cast<std::size_t>(b)].bottomRightCorner<3, 3>() +=
        J * hat(d) - hat(Vec3(J * d));
  }
  const auto field = [&](int body) -> Vec6 {
    if (body == kGround) return Vec6::Zero();
    return Vec6(stage.x.segment<6>(6 * body)) +
           (stage.velocities ? velocity_of(steps[static_cast<std::size_t>(body)]) : Vec6::Zero());
  };
  using Terms = Eigen::Matrix<double, 18, 1>;  // −G_aᵀ μ, −G_bᵀ μ, G y
  PairTerms t;
  for (std::size_t i = 0; i < system_->interactions().size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    if (ref.rows == 0) continue;
    const auto p = static_cast<std::size_t>(map_.pair[i]);
    linear::KktValues::Pair& v = l.by_q.pairs[p];
    const Vec6 y_a = field(ref.a), y_b = field(ref.b);
    const BodyStep& a = ref.a == kGround ? steps.back() : steps[static_cast<std::size_t>(ref.a)];
    const BodyStep& b = ref.b == kGround ? steps.back() : steps[static_cast<std::size_t>(ref.b)];
    const auto mu = stage.x.segment(first_row + ref.first_row, ref.rows);
    const auto terms = [&](const BodyStep& at_a, const BodyStep& at_b) {
      const PairStep step{at_a, at_b, context, no_lambda.data(),
                          stage.at.history.data() + ref.first_history};
      t.set_zero();
      system_->group(ref.group).evaluate({&ref.item, 1}, {&step, 1}, {&t, 1});
      Terms of = Terms::Zero();
      of.head<6>() = -t.G_a.topRows(ref.rows).transpose() * mu;
      of.segment<6>(6) = -t.G_b.topRows(ref.rows).transpose() * mu;
      of.segment(12, ref.rows) = t.G_a.topRows(ref.rows) * y_a + t.G_b.topRows(ref.rows) * y_b;
      return of;
    };
    for (int side = 0; side < 2; ++side) {
      if ((side == 0 ? ref.a : ref.b) == kGround) continue;
      Eigen::Matrix<double, 18, 6> D;
      for (int c = 0; c < 6; ++c) {
        const double d = kRowStep * (c < 3 ? system_->length_scale() : 1.0);
        const auto at = [&](double k) {
          return side == 0 ? terms(moved_instant(a, c, k * d), b)
                           : terms(a, moved_instant(b, c, k * d));
        };
        D.col(c) = (2.0 / 3.0 * (at(1.0) - at(-1.0)) - 1.0 / 12.0 * (at(2.0) - at(-2.0))) / d;
      }
      const Mat6 on_a = D.topRows<6>(), on_b = D.middleRows<6>(6);
      (side == 0 ? v.G_a : v.G_b) += D.bottomRows<6>();
      const auto add = [&](int of, const Mat6& own, Mat6& coupled, bool same) {
        if (of == kGround) return;
        if (same)
          l.by_q.diagonal[static_cast<std::size_t>(of)] += own;
        else
          coupled += own;
      };
      add(ref.a, on_a, v.K_ab, side == 0);
      add(ref.b, on_b, v.K_ba, side == 1);
    }
    if (stage.velocities) continue;
    v.G_a.topRows(ref.rows) += l.values.pairs[p].G_a.topRows(ref.rows);
    v.G_b.topRows(ref.rows) += l.values.pairs[p].G_b.topRows(ref.rows);
  }
}

Vec ProjectionDerivative::solve(const ProjectionStage& stage, const Linear& l, const Vec& rhs,
                                double size, bool transposed) {
  Vec x = rhs;
  transposed ? l.solver->solve_transposed(x) : l.solver->solve(x);
  if (!stage.velocities) return x;  // its ε is part of the iteration
  if (size == 0.0) return x;
  Vec best = x, product;
  double last = std::numeric_limits<double>::infinity();
  for (int sweep = 0; sweep < kProjectionSweeps; ++sweep) {
    kkt_product(map_.topology, l.values, x, transposed, product);
    Vec rest = rhs - product;
    const double left = rest.lpNorm<Eigen::Infinity>() / size;
    if (!(left < last)) break;  // round-off
    best = x;
    last = left;
    if (left < kProjectionSolved) break;
    transposed ? l.solver->solve_transposed(rest) : l.solver->solve(rest);
    x += rest;
  }
  defect_ = std::max(defect_, last);
  return best;
}

void ProjectionDerivative::push(const Vec& by_parameter, Vec& dy) {
  const int count = stage_inputs(*system_);
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    const Vec inputs = by_parameter.segment(static_cast<Eigen::Index>(s) * count, count);
    stages_[s].velocities ? push_velocities(s, inputs, dy) : push_positions(s, inputs, dy);
  }
}

Vec ProjectionDerivative::pull(Vec& mu) {
  const int count = stage_inputs(*system_);
  Vec eta = Vec::Zero(inputs());
  for (std::size_t s = stages_.size(); s-- > 0;) {
    const auto own = eta.segment(static_cast<Eigen::Index>(s) * count, count);
    stages_[s].velocities ? pull_velocities(s, mu, own) : pull_positions(s, mu, own);
  }
  return eta;
}

void ProjectionDerivative::push_positions(std::size_t at, const Vec& inputs, Vec& dy) {
  const ProjectionStage& stage = stages_[at];
  const Linear& l = linear_[at];
  const int n = system_->body_count(), first_row = 6 * n, rows = system_->rows();
  Vec dq = Vec::Zero(first_row + rows), product;
  for (int b = 0; b < n; ++b) dq.segment<6>(6 * b) = dy.segment<6>(kStateNumbers * b);
  kkt_product(map_.topology, l.by_q, dq, false, product);
  Vec rhs = -product - inputs.head(first_row + rows);
  if (stage.largest_row >= 0) {
    kkt_product(map_.topology, l.values, dq, false, product);
    const double change =
        inputs[first_row + rows] + 2.0 / stage.largest * product[first_row + stage.largest_row];
    rhs.tail(rows) -= stage.epsilon * change * stage.x.tail(rows);
  }
  const Vec dx = solve(stage, l, rhs, 1.0, false);
  for (int b = 0; b < n; ++b) {
    const Vec3 theta = stage.x.segment<3>(6 * b + 3);
    auto phi = dy.segment<3>(kStateNumbers * b + 3);
    dy.segment<3>(kStateNumbers * b) += dx.segment<3>(6 * b);
    phi = (cayley_tangent_inverse(theta).transpose() * dx.segment<3>(6 * b + 3) + cay(theta) * phi)
              .eval();
  }
}

void ProjectionDerivative::pull_positions(std::size_t at, Vec& mu, Eigen::Ref<Vec> eta) {
  const ProjectionStage& stage = stages_[at];
  const Linear& l = linear_[at];
  const int n = system_->body_count(), first_row = 6 * n, rows = system_->rows();
  Vec weights = Vec::Zero(first_row + rows), product;
  for (int b = 0; b < n; ++b) {
    const Vec3 theta = stage.x.segment<3>(6 * b + 3);
    auto phi = mu.segment<3>(kStateNumbers * b + 3);
    weights.segment<3>(6 * b) = mu.segment<3>(kStateNumbers * b);
    weights.segment<3>(6 * b + 3) = cayley_tangent_inverse(theta) * phi;
    phi = (cay(theta).transpose() * phi).eval();
  }
  const Vec x = solve(stage, l, weights, weights.lpNorm<Eigen::Infinity>(), true);
  eta.head(first_row + rows) = -x;
  kkt_product(map_.topology, l.by_q, x, true, product);
  Vec of_q = -product.head(first_row);
  if (stage.largest_row >= 0) {
    const double change = -stage.epsilon * x.tail(rows).dot(stage.x.tail(rows));
    eta[first_row + rows] = change;
    kkt_product(map_.topology, l.values, Vec::Unit(first_row + rows, first_row + stage.largest_row),
                true, product);
    of_q += 2.0 / stage.largest * change * product.head(first_row);
  }
  for (int b = 0; b < n; ++b) mu.segment<6>(kStateNumbers * b) += of_q.segment<6>(6 * b);
}

void ProjectionDerivative::push_velocities(std::size_t at, const Vec& inputs, Vec& dy) {
  const ProjectionStage& stage = stages_[at];
  const Linear& l = linear_[at];
  const int n = system_->body_count(), first_row = 6 * n, rows = system_->rows();
  Vec dq = Vec::Zero(first_row + rows), dv = dq, product;
  for (int b = 0; b < n; ++b) {
    const BodyMotion m = system_->motion(stage.at, b);
    const Vec3 dphi = dy.segment<3>(kStateNumbers * b + 3);
    dq.segment<6>(6 * b) = dy.segment<6>(kStateNumbers * b);
    dv.segment<3>(6 * b) = dy.segment<3>(kStateNumbers * b + 6);
    dv.segment<3>(6 * b + 3) =
        dphi.cross(m.omega()) + m.Lambda() * dy.segment<3>(kStateNumbers * b + 9);
  }
  kkt_product(map_.topology, l.by_q, dq, false, product);
  Vec rhs = -product - inputs.head(first_row + rows);
  double size = std::max(product.lpNorm<Eigen::Infinity>(), inputs.lpNorm<Eigen::Infinity>());
  kkt_product(map_.topology, l.values, dv, false, product);
  rhs.tail(rows) -= product.tail(rows);
  size = std::max(size, product.tail(rows).lpNorm<Eigen::Infinity>());
  const Vec dx = stage.impact ? push_impact(stage, l, dq, dv, inputs[first_row + rows], rhs, size)
                              : solve(stage, l, rhs, size, false);
  for (int b = 0; b < n; ++b) {
    if (!takes_part(b)) continue;
    const Vec3 dphi = dy.segment<3>(kStateNumbers * b + 3), jump = stage.x.segment<3>(6 * b + 3);
    dy.segment<3>(kStateNumbers * b + 6) += dx.segment<3>(6 * b);
    dy.segment<3>(kStateNumbers * b + 9) += system_->motion(stage.at, b).Lambda().transpose() *
                                            (dx.segment<3>(6 * b + 3) - dphi.cross(jump));
  }
}

void ProjectionDerivative::pull_velocities(std::size_t at, Vec& mu, Eigen::Ref<Vec> eta) {
  const ProjectionStage& stage = stages_[at];
  const Linear& l = linear_[at];
  const int n = system_->body_count(), first_row = 6 * n, rows = system_->rows();
  Vec weights = Vec::Zero(first_row + rows), of_q, of_v;
  for (int b = 0; b < n; ++b) {
    if (!takes_part(b)) continue;
    weights.segment<3>(6 * b) = mu.segment<3>(kStateNumbers * b + 6);
    weights.segment<3>(6 * b + 3) =
        system_->motion(stage.at, b).Lambda() * mu.segment<3>(kStateNumbers * b + 9);
  }
  const double size = weights.lpNorm<Eigen::Infinity>();
  double of_row = 0.0;
  const Vec x = stage.impact ? solve_impact(stage, l, weights, 0.0, size, true, of_row)
                             : solve(stage, l, weights, size, true);
  eta.head(first_row + rows) = -x;
  kkt_product(map_.topology, l.by_q, x, true, of_q);
  Vec only_rows = Vec::Zero(first_row + rows);
  only_rows.tail(rows) = x.tail(rows);
  kkt_product(map_.topology, l.values, only_rows, true, of_v);  // Gᵀ
  if (stage.impact) {
    eta[first_row + rows] = -of_row;
    pull_impact(stage, l, x, of_row, of_q, of_v);
  }
  for (int b = 0; b < n; ++b) {
    const BodyMotion m = system_->motion(stage.at, b);
    const Vec3 of_omega = of_v.segment<3>(6 * b + 3), jump = stage.x.segment<3>(6 * b + 3);
    mu.segment<6>(kStateNumbers * b) -= of_q.segment<6>(6 * b);
    mu.segment<3>(kStateNumbers * b + 3) +=
        weights.segment<3>(6 * b + 3).cross(jump) - m.omega().cross(of_omega);
    mu.segment<3>(kStateNumbers * b + 6) -= of_v.segment<3>(6 * b);
    mu.segment<3>(kStateNumbers * b + 9) -= m.Lambda().transpose() * of_omega;
  }
}

}  // namespace polhode
