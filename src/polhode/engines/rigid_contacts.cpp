// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/rigid_contacts.hpp>

namespace polhode {

namespace {

/// Rounding of positions and of velocities, relative to their size.
constexpr double kGapRounding = 8.0 * std::numeric_limits<double>::epsilon();
constexpr double kSpeedRounding = 64.0 * std::numeric_limits<double>::epsilon();
/// Error of the displacement along a row that is solved, in gaps that count as touching.
constexpr double kRoundings = 100.0;
/// Rows of all islands, and of one, for which the dense matrices of the row problem are not too
/// large: 18 MB, and 0.05 s for each of its factorisations.
constexpr std::size_t kMostRows = 1500, kMostRowsOfIsland = 600;

}  // namespace

bool RigidContacts::of(const System& system) {
  if (!system.contacts()) return false;
  const ImpulsiveContacts* c = system.contacts()->impulsive();
  return c && c->impulses() && c->impulses()->rigid;
}

RigidContacts::RigidContacts(const System& system)
    : system_(&system), contacts_(system.contacts().get()), impulsive_(contacts_->impulsive()) {
  contacts_->prepare(system);
  touching_ = impulsive_->touching_gap();
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.assign(n + 1, BodyStep::ground(0.5));
  nowhere_.assign(n, Vec6::Zero());
}

void RigidContacts::take_steps(const State& state, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b)
    steps_[static_cast<std::size_t>(b)] = body_step(*system_, state, trial, b);
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

void RigidContacts::begin_step(const State& state, const Trial& trial) {
  take_steps(state, trial);
  std::vector<BodyStep> start = steps_;
  for (BodyStep& s : start) {
    s.r_n1 = s.r_n;
    s.Lambda_n1 = s.Lambda_n;
    s.u = s.theta = Vec3::Zero();
  }
  contacts_->begin_step(state, start, trial.context);
  dt_ = trial.context.dt;
  points_.clear();
  first_ = true;
}

void RigidContacts::find(const StepContext& context) {
  if (!impulsive_->covers(steps_)) {
    contacts_->cover(steps_, context, nowhere_);
    points_.clear();  // they are numbered anew
    first_ = true;
  }
  const std::size_t known = points_.size();
  impulsive_->find_points(steps_, context, points_);
  for (std::size_t k = known; k < points_.size(); ++k)
    points_[k].impulse = points_[k].turning = Vec3::Zero();
  impulsive_->place_points(steps_, points_);
}

void RigidContacts::put_rows() {
  rows_.clear();
  blocks_.clear();
  lengths_.clear();
  for (int k = 0; k < static_cast<int>(points_.size()); ++k) {
    const ImpulsePoint& p = points_[static_cast<std::size_t>(k)];
    const auto arm = [&](int body) {
      const BodyStep& s = step_of(body);
      return Vec3(p.place - s.r_n - 0.5 * s.u);
    };
    const auto add = [&](const Vec3& direction, bool turns) {
      Row& row = rows_.emplace_back();
      row.a = p.a;
      row.b = p.b;
      row.point = k;
      row.direction = direction;
      row.turns = turns;
      const Vec3 force = turns ? Vec3(Vec3::Zero()) : direction;
      row.on_a << force, turns ? direction : Vec3(arm(p.a).cross(direction));
      row.on_b << -force, turns ? Vec3(-direction) : Vec3(-arm(p.b).cross(direction));
      row.by_a = row.on_a;
      row.by_b = row.on_b;
      lengths_.push_back(turns ? p.size : 1.0);
    };
    const auto normal = static_cast<Eigen::Index>(rows_.size());
    add(p.normal, false);
    const auto [n, place] = impulsive_->direction_after(steps_, p);
    rows_.back().by_a << n, (place - step_of(p.a).r_n1).cross(n);
    rows_.back().by_b << -n, -(place - step_of(p.b).r_n1).cross(n);
    blocks_.push_back({.kind = ImpulseRows::Kind::normal, .first = normal});
    if (!rests(p)) continue;
    const auto bound = [&](Eigen::Index size, double along, double across) {
      blocks_.push_back({.kind = ImpulseRows::Kind::friction,
                         .first = static_cast<Eigen::Index>(rows_.size()),
                         .size = size,
                         .normal = normal,
                         .half_axes = {along, across, 0.0}});
    };
    Vec3 along = p.along - p.normal.dot(p.along) * p.normal;
    along = along.squaredNorm() > 1e-12 ? Vec3(along.normalized()) : p.normal.unitOrthogonal();
    const Vec3 across = p.normal.cross(along);
    if (p.friction > 0.0) {
      bound(2, p.friction, p.friction_across);
      add(along, false);
      add(across, false);
    }
    if (p.torsion > 0.0) {
      bound(1, p.torsion, 0.0);
      add(p.normal, true);
    }
    if (p.rolling > 0.0) {
      bound(2, p.rolling, p.rolling);
      add(along, true);
      add(across, true);
    }
  }
}

/// Relative displacement of a point over the step.
Vec3 RigidContacts::slip_of(const ImpulsePoint& p) const {
  const auto way = [&](const BodyStep& s) {
    return Vec3(s.u + s.theta.cross(p.place - s.r_n - 0.5 * s.u));
  };
  return way(step_of(p.a)) - way(step_of(p.b));
}

double RigidContacts::displacement(const Row& row) const {
  const auto& [a, b] = std::pair(step_of(row.a), step_of(row.b));
  Vec6 x_a, x_b;
  x_a << a.u, a.theta;
  x_b << b.u, b.theta;
  return row.on_a.dot(x_a) + row.on_b.dot(x_b);
}

double RigidContacts::change(const Row& row, const Vec& x) {
  double sum = 0.0;
  if (row.a != kGround) sum += row.by_a.dot(x.segment<6>(6 * row.a));
  if (row.b != kGround) sum += row.by_b.dot(x.segment<6>(6 * row.b));
  return sum;
}

std::string RigidContacts::names_of(int a, int b) const {
  const auto name = [&](int body) {
    return body == kGround
               ? std::string("the ground")
               : format("body '{}'", system_->bodies()[static_cast<std::size_t>(body)].name);
  };
  return format("{} and {}", name(a), name(b));
}

/// @eq{contact-rows}
bool RigidContacts::solve(const State& state, const Trial& trial, double scale,
                          const linear::LinearSolver& solver, Vec& x) {
  solved_ = true;
  take_steps(state, trial);
  find(trial.context);
  put_rows();
  const auto n = static_cast<Eigen::Index>(rows_.size());
  if (n == 0) return true;
  if (rows_.size() > kMostRows) {
    solved_ = false;
    unsolved_ = format("contacts have {} rows, more than the {} of law: rigid; use law: barrier",
                       rows_.size(), kMostRows);
    return false;
  }
  const double per_way = 2.0 / dt_, per_impulse = scale / dt_;
  responses_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    Vec& response = responses_[i];
    response.setZero(x.size());
    if (row.a != kGround) response.segment<6>(6 * row.a) = per_impulse * row.on_a;
    if (row.b != kGround) response.segment<6>(6 * row.b) += per_impulse * row.on_b;
    solver.solve(response);
  }

  Mat A(n, n);
  Vec y(n), given = Vec::Zero(n);
  for (Eigen::Index i = 0; i < n && !first_; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    const ImpulsePoint& p = points_[static_cast<std::size_t>(row.point)];
    given[i] = (row.turns ? p.turning : p.impulse).dot(row.direction);
    if (given[i] != 0.0) x += given[i] * responses_[static_cast<std::size_t>(i)];
  }
  double fastest = 0.0, far = system_->length_scale();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    const ImpulsePoint& p = points_[static_cast<std::size_t>(row.point)];
    const bool normal = i == 0 || rows_[static_cast<std::size_t>(i - 1)].point != row.point;
    const double way = normal ? impulsive_->gap_after(steps_, p) : displacement(row);
    y[i] = per_way * (way + change(row, x));
    far = std::max(far, p.place.lpNorm<Eigen::Infinity>());
    fastest = std::max(fastest, p.velocity.norm());
    for (Eigen::Index j = 0; j < n; ++j)
      A(i, j) = per_way * change(row, responses_[static_cast<std::size_t>(j)]);
  }
  const double rounding = kSpeedRounding * fastest + kGapRounding * far * std::abs(per_way);
  Vec p = Vec::Zero(n);
  for (const std::vector<Eigen::Index>& island : islands(A)) {
    if (island.size() > kMostRowsOfIsland) {
      solved_ = false;
      const Row& row = rows_[static_cast<std::size_t>(island.front())];
      unsolved_ = format(
          "the contact of {} and what it moves have {} rows, more than the {} of law: rigid; use "
          "law: barrier",
          names_of(row.a, row.b), island.size(), kMostRowsOfIsland);
      return false;
    }
    RowProblem problem(static_cast<Eigen::Index>(island.size()));
    problem.A = A(island, island);
    problem.b = y(island);
    problem.given = given(island);
    take_blocks(island, problem);
    Vec of_island = Vec::Zero(problem.b.size());
    const RowReport report = problem.solve(of_island, rounding);
    if (!report.converged) {
      solved_ = false;
      const auto worst = static_cast<std::size_t>(std::max<Eigen::Index>(0, report.worst));
      unsolved_ = format("the contact of {} is not solved: it misses by {:.2g} m/s",
                         names_of(rows_[static_cast<std::size_t>(island[worst])].a,
                                  rows_[static_cast<std::size_t>(island[worst])].b),
                         report.error);
    }
    p(island) = of_island;
  }
  first_ = false;
  for (ImpulsePoint& point : points_) point.impulse = point.turning = Vec3::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    if (p[i] != 0.0) x += p[i] * responses_[static_cast<std::size_t>(i)];
    ImpulsePoint& point = points_[static_cast<std::size_t>(row.point)];
    (row.turns ? point.turning : point.impulse) += (given[i] + p[i]) * row.direction;
  }
  return x.allFinite();
}

/// Rows whose impulses move each other, directly or through others: bodies that nothing connects
/// have exact zeros between them.
std::vector<std::vector<Eigen::Index>> RigidContacts::islands(const Mat& A) const {
  DisjointSets sets(points_.size());
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (A(i, j) != 0.0)
        sets.join(rows_[static_cast<std::size_t>(i)].point,
                  rows_[static_cast<std::size_t>(j)].point);
  std::map<int, std::vector<Eigen::Index>> by_root;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    by_root[sets.first_of(rows_[static_cast<std::size_t>(i)].point)].push_back(i);
  std::vector<std::vector<Eigen::Index>> list;
  for (auto& [root, rows] : by_root) list.push_back(std::move(rows));
  return list;
}

/// Copies the kinds of an island's rows, ascending, to its problem.
void RigidContacts::take_blocks(const std::vector<Eigen::Index>& island,
                                RowProblem& problem) const {
  const auto place = [&](Eigen::Index row) {
    return static_cast<Eigen::Index>(std::lower_bound(island.begin(), island.end(), row) -
                                     island.begin());
  };
  for (std::size_t i = 0; i < island.size(); ++i)
    problem.lengths[static_cast<Eigen::Index>(i)] = lengths_[static_cast<std::size_t>(island[i])];
  for (const ImpulseRows& block : blocks_) {
    const Eigen::Index first = place(block.first);
    if (first == static_cast<Eigen::Index>(island.size()) ||
        island[static_cast<std::size_t>(first)] != block.first)
      continue;
    ImpulseRows own = block;
    own.first = first;
    if (block.normal >= 0) own.normal = place(block.normal);
    problem.blocks.push_back(own);
  }
}

void RigidContacts::add_to(ConstraintCheck& check, const State& state, const Trial& trial) {
  take_steps(state, trial);
  for (const ImpulsePoint& p : points_) {
    const double force = std::max(0.0, p.normal.dot(p.impulse)) / std::abs(dt_);
    if (force == 0.0) continue;
    check.work_defect += force * std::abs(impulsive_->gap_after(steps_, p));
    check.work_scale += force * (system_->length_scale() + p.place.lpNorm<1>());
  }
  check.broken = broken();
}

/// Fault of the step, with its bodies: an overlap at the end, at a point without a row, or a gain
/// of energy by rows whose direction at the middle is not that of the change of the gap. Empty:
/// none. Both vanish with the length of the step.
std::string RigidContacts::broken() const {
  const double accuracy = kRoundings * touching_;
  if (const auto pair = impulsive_->passed(steps_))
    return format("{} would overlap", names_of(pair->first, pair->second));
  double gained = 0.0, forces = 0.0, most = 0.0;
  const ImpulsePoint* worst = nullptr;
  for (const ImpulsePoint& p : points_) {
    const double force = p.normal.dot(p.impulse) / dt_, gain = force * p.normal.dot(slip_of(p));
    gained += gain;
    forces += std::abs(force);
    if (gain <= most) continue;
    most = gain;
    worst = &p;
  }
  if (!worst || gained <= accuracy * forces) return {};
  return format("the contact of {} would gain energy", names_of(worst->a, worst->b));
}

void RigidContacts::add_ground_wrench(double* force, double* moment) const {
  for (const ImpulsePoint& p : points_) {
    if (p.a != kGround && p.b != kGround) continue;
    const double sign = (p.b == kGround ? 1.0 : -1.0) / dt_;
    const Vec3 f = sign * p.impulse, m = p.place.cross(f) + sign * p.turning;
    for (int i = 0; i < 3; ++i) {
      force[i] += f[i];
      moment[i] += m[i];
    }
  }
}

/// Losses from the motion of the step: −½ p·y. @eq{contact-rows}
Work RigidContacts::commit(State& state, const Trial& trial) {
  take_steps(state, trial);
  losses_.assign(points_.size(), {});
  for (std::size_t k = 0; k < points_.size(); ++k) {
    ImpulsePoint& p = points_[k];
    const Vec3 slip = slip_of(p);
    const double normal = p.normal.dot(p.impulse);
    p.slip = (slip - p.normal.dot(slip) * p.normal).norm();
    losses_[k].normal = -normal * p.normal.dot(slip) / dt_;
    losses_[k].friction = -((p.impulse - normal * p.normal).dot(slip) +
                            p.turning.dot(step_of(p.a).theta - step_of(p.b).theta)) /
                          dt_;
  }
  ImpulseSearch search;
  search.converged = true;
  return impulsive_->commit_impulses(state, steps_, trial.context, points_, losses_, search);
}

}  // namespace polhode
