// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Rounding of positions and of velocities, relative to their size.
constexpr double kGapRounding = 8.0 * std::numeric_limits<double>::epsilon();
constexpr double kSpeedRounding = 64.0 * std::numeric_limits<double>::epsilon();
/// Displacement, in sizes of the model, below which row problems are solved exactly. No step ends
/// with an increment that is longer.
constexpr double kExactBelow = 1e-6;
/// Rows of all islands, and of one, for which the dense matrices of the row problem are not too
/// large: 18 MB, and 0.05 s for each of its factorisations.
constexpr std::size_t kMostRows = 1500, kMostRowsOfIsland = 600;

}  // namespace

bool UnilateralRows::of(const System& system) { return has_unilateral_rows(system); }

UnilateralRows::UnilateralRows(const System& system)
    : system_(&system), contacts_(system.contacts().get()), touching_(system.touching_gap()) {
  if (contacts_) {
    impulsive_ = contacts_->impulsive();
    contacts_->prepare(system);
  }
  for (const UnilateralStop& stop : unilateral_stops(system)) stops_.push_back({stop});
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.assign(n + 1, BodyStep::ground(0.5));
  nowhere_.assign(n, Vec6::Zero());
}

void UnilateralRows::take_steps(const State& state, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b)
    steps_[static_cast<std::size_t>(b)] = body_step(*system_, state, trial, b);
  steps_.back() = BodyStep::ground(trial.context.ga.alpha_f);
}

void UnilateralRows::take_stops(const State& state, const Trial& trial) {
  for (Stop& stop : stops_) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(stop.interaction)];
    if (stop.number == 0) {
      found_.clear();
      const PairView view = pair_view(*system_, state, trial, ref);
      system_->group(ref.group).unilateral_rows(ref.item, view.step(), found_);
    }
    stop.exists = !found_.empty();
    if (stop.exists) stop.row = found_[static_cast<std::size_t>(stop.number)];
  }
}

void UnilateralRows::begin_step(const State& state, const Trial& trial) {
  dt_ = trial.context.dt;
  points_.clear();
  first_ = true;
  for (Stop& stop : stops_) {
    stop.listed = false;
    const double* const memory = state.history.data() + stop.memory;
    stop.impulse = read_record<UnilateralMemory>(memory).force * dt_;  // as of points, a guess
  }
  if (!contacts_) return;
  take_steps(state, trial);
  std::vector<BodyStep> start = steps_;
  for (BodyStep& s : start) {
    s.r_n1 = s.r_n;
    s.Lambda_n1 = s.Lambda_n;
    s.u = s.theta = Vec3::Zero();
  }
  contacts_->begin_step(state, start, trial.context);
}

/// Lists contact points that must act at the iterate, and stops that must after these increments.
void UnilateralRows::find(const StepContext& context, const Vec& x) {
  for (Stop& stop : stops_) {
    if (!stop.exists || stop.listed) continue;
    double gap = stop.row.gap_n1;
    if (stop.a != kGround) gap += stop.row.by_a.dot(x.segment<6>(6 * stop.a));
    if (stop.b != kGround) gap += stop.row.by_b.dot(x.segment<6>(6 * stop.b));
    stop.listed = stop.row.gap_n <= touching_ || stop.row.gap_n1 < 0.0 || gap < 0.0;
  }
  if (!contacts_) return;
  if (!impulsive_->covers(steps_)) {
    contacts_->cover(steps_, context, nowhere_);
    points_.clear();  // they are numbered anew
    first_ = true;
  }
  const std::size_t known = points_.size();
  impulsive_->find_points(steps_, context, points_);
  // Those of the last step are a guess for the first row problem of this one.
  for (std::size_t k = known; k < points_.size() && !first_; ++k)
    points_[k].impulse = points_[k].turning = Vec3::Zero();
  impulsive_->place_points(steps_, points_);
}

void UnilateralRows::put_point(int number) {
  const ImpulsePoint& p = points_[static_cast<std::size_t>(number)];
  const auto arm = [&](int body) {
    const BodyStep& s = step_of(body);
    return Vec3(p.place - s.r_n - 0.5 * s.u);
  };
  const auto add = [&](const Vec3& direction, bool turns) {
    Row& row = rows_.emplace_back();
    row.a = p.a;
    row.b = p.b;
    row.source = number;
    row.direction = direction;
    row.turns = turns;
    const Vec3 force = turns ? Vec3(Vec3::Zero()) : direction;
    row.on_a << force, turns ? direction : Vec3(arm(p.a).cross(direction));
    row.on_b << -force, turns ? Vec3(-direction) : Vec3(-arm(p.b).cross(direction));
    row.by_a = row.on_a;
    row.by_b = row.on_b;
    row.way = displacement(row);
    lengths_.push_back(turns ? p.size : 1.0);
  };
  const auto normal = static_cast<Eigen::Index>(rows_.size());
  add(p.normal, false);
  const auto [n, place] = impulsive_->direction_after(steps_, p);
  rows_.back().by_a << n, (place - step_of(p.a).r_n1).cross(n);
  rows_.back().by_b << -n, -(place - step_of(p.b).r_n1).cross(n);
  rows_.back().way = impulsive_->gap_after(steps_, p) - p.kept;
  blocks_.push_back({.kind = ImpulseRows::Kind::normal, .first = normal});
  if (!rests(p)) return;
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

void UnilateralRows::put_rows() {
  rows_.clear();
  blocks_.clear();
  lengths_.clear();
  for (int k = 0; k < static_cast<int>(points_.size()); ++k) put_point(k);
  for (std::size_t k = 0; k < stops_.size(); ++k) {
    const Stop& stop = stops_[k];
    if (!stop.exists || !stop.listed) continue;
    blocks_.push_back(
        {.kind = ImpulseRows::Kind::normal, .first = static_cast<Eigen::Index>(rows_.size())});
    Row& row = rows_.emplace_back();
    row.a = stop.a;
    row.b = stop.b;
    row.on_a = stop.row.on_a;
    row.on_b = stop.row.on_b;
    row.by_a = stop.row.by_a;
    row.by_b = stop.row.by_b;
    row.source = static_cast<int>(points_.size() + k);
    row.way = stop.row.gap_n1;
    lengths_.push_back(1.0);
  }
}

/// Relative displacement of a point over the step.
Vec3 UnilateralRows::slip_of(const ImpulsePoint& p) const {
  const auto way = [&](const BodyStep& s) {
    return Vec3(s.u + s.theta.cross(p.place - s.r_n - 0.5 * s.u));
  };
  return way(step_of(p.a)) - way(step_of(p.b));
}

double UnilateralRows::displacement(const Row& row) const {
  const auto& [a, b] = std::pair(step_of(row.a), step_of(row.b));
  Vec6 x_a, x_b;
  x_a << a.u, a.theta;
  x_b << b.u, b.theta;
  return row.on_a.dot(x_a) + row.on_b.dot(x_b);
}

double UnilateralRows::change(const Row& row, const Vec& x) {
  double sum = 0.0;
  if (row.a != kGround) sum += row.by_a.dot(x.segment<6>(6 * row.a));
  if (row.b != kGround) sum += row.by_b.dot(x.segment<6>(6 * row.b));
  return sum;
}

std::string UnilateralRows::name_of(const Row& row) const {
  return is_point(row) ? "the contact of " + pair_name(*system_, row.a, row.b)
                       : stop_name(*system_, stop_of(row).interaction);
}

double UnilateralRows::impulse_of(const Row& row) const {
  if (!is_point(row)) return stop_of(row).impulse;
  const ImpulsePoint& p = points_[static_cast<std::size_t>(row.source)];
  return (row.turns ? p.turning : p.impulse).dot(row.direction);
}

void UnilateralRows::add_scales(const Row& row, double& far, double& fastest) const {
  if (is_point(row)) {
    const ImpulsePoint& p = points_[static_cast<std::size_t>(row.source)];
    far = std::max(far, p.place.lpNorm<Eigen::Infinity>());
    fastest = std::max(fastest, p.velocity.norm());
    return;
  }
  double way = 0.0;
  for (const auto& [body, on] : {std::pair(row.a, row.on_a), std::pair(row.b, row.on_b)}) {
    const BodyStep& s = step_of(body);
    way += on.head<3>().cwiseAbs().dot(s.u.cwiseAbs()) +
           on.tail<3>().cwiseAbs().dot(s.theta.cwiseAbs());
  }
  fastest = std::max(fastest, way / std::abs(dt_));
}

/// Stores the impulses of all rows.
void UnilateralRows::take_impulses(const Vec& sums) {
  for (ImpulsePoint& point : points_) point.impulse = point.turning = Vec3::Zero();
  for (Stop& stop : stops_) stop.impulse = 0.0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const double p = sums[static_cast<Eigen::Index>(i)];
    if (!is_point(row)) {
      stops_[static_cast<std::size_t>(row.source) - points_.size()].impulse = p;
      continue;
    }
    ImpulsePoint& point = points_[static_cast<std::size_t>(row.source)];
    (row.turns ? point.turning : point.impulse) += p * row.direction;
  }
}

/// @eq{contact-rows}
bool UnilateralRows::solve(const State& state, const Trial& trial, double scale,
                           const linear::LinearSolver& solver, Vec& x) {
  solved_ = true;
  take_steps(state, trial);
  take_stops(state, trial);
  find(trial.context, x);
  put_rows();
  const auto n = static_cast<Eigen::Index>(rows_.size());
  if (n == 0) {
    take_impulses(Vec());
    return true;
  }
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
  Vec y(n), impulses = Vec::Zero(n), guess = Vec::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double before = impulse_of(rows_[static_cast<std::size_t>(i)]);
    (first_ ? guess : impulses)[i] = before;
    if (impulses[i] != 0.0) x += impulses[i] * responses_[static_cast<std::size_t>(i)];
  }
  double fastest = 0.0, far = system_->length_scale();
  for (Eigen::Index i = 0; i < n; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    y[i] = per_way * (row.way + change(row, x));
    add_scales(row, far, fastest);
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
          "{} and what it moves have {} rows, more than the {} of law: rigid; use law: barrier",
          name_of(row), island.size(), kMostRowsOfIsland);
      return false;
    }
    RowProblem problem(static_cast<Eigen::Index>(island.size()));
    problem.A = A(island, island);
    problem.b = y(island);
    problem.given = impulses(island);
    // From the second iteration on, errors are those of the linearisation.
    if (!first_) problem.exact_below = kExactBelow * system_->length_scale() / std::abs(dt_);
    take_blocks(island, problem);
    Vec of_island = Vec::Zero(problem.b.size());
    const Vec before = guess(island);
    const bool guessed = !before.isZero(0.0);
    const RowReport report = problem.solve(of_island, rounding, guessed ? &before : nullptr);
    if (!report.converged) {
      solved_ = false;
      const auto worst = static_cast<std::size_t>(std::max<Eigen::Index>(0, report.worst));
      unsolved_ = format("{} is not solved: it misses by {:.2g} m/s",
                         name_of(rows_[static_cast<std::size_t>(island[worst])]), report.error);
    }
    p(island) = of_island;
  }
  first_ = false;
  for (Eigen::Index i = 0; i < n; ++i)
    if (p[i] != 0.0) x += p[i] * responses_[static_cast<std::size_t>(i)];
  take_impulses(impulses + p);
  return x.allFinite();
}

/// Rows whose impulses move each other, directly or through others: bodies that nothing connects
/// have exact zeros between them.
std::vector<std::vector<Eigen::Index>> UnilateralRows::islands(const Mat& A) const {
  DisjointSets sets(points_.size() + stops_.size());
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    for (Eigen::Index j = 0; j < i; ++j)
      if (A(i, j) != 0.0)
        sets.join(rows_[static_cast<std::size_t>(i)].source,
                  rows_[static_cast<std::size_t>(j)].source);
  std::map<int, std::vector<Eigen::Index>> by_root;
  for (Eigen::Index i = 0; i < A.rows(); ++i)
    by_root[sets.first_of(rows_[static_cast<std::size_t>(i)].source)].push_back(i);
  std::vector<std::vector<Eigen::Index>> list;
  for (auto& [root, rows] : by_root) list.push_back(std::move(rows));
  return list;
}

/// Copies the kinds of an island's rows, ascending, to its problem.
void UnilateralRows::take_blocks(const std::vector<Eigen::Index>& island,
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

}  // namespace polhode
