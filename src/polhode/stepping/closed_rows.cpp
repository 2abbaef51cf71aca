// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include <polhode/math/cayley.hpp>
#include <polhode/stepping/closed_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Length of the step with which candidates are searched [s]. The margins by the fall in it affect
/// cost alone.
constexpr double kInstantSearch = 1e-2;
/// Relative rounding of the rate of a row.
constexpr double kRateRounding = 1e-9;
/// Way over which the convective acceleration of a stop is a central difference, as a part of the
/// model's size or in rad: its error is the square, that of rounding 1e-16 over it.
constexpr double kConvectiveWay = 1e-5;
/// Relative error of the accelerations of rows.
constexpr double kRowAccelerations = 1e-14;
/// Square of the part of a direction in the tangent plane below which it has none.
constexpr double kNormalDirection = 1e-12;

}  // namespace

ClosedRows::ClosedRows(const System& system, BodyContacts* contacts)
    : system_(&system), contacts_(contacts), stops_(unilateral_stops(system)) {}

double ClosedRows::rate(const Row& row) const {
  const Motion a = motion_of(row.a), b = motion_of(row.b);
  return row.on_a.head<3>().dot(a.v) + row.on_a.tail<3>().dot(a.omega) +
         row.on_b.head<3>().dot(b.v) + row.on_b.tail<3>().dot(b.omega);
}

/// Rate that the speeds of the bodies could give a row [m/s].
double ClosedRows::largest_rate(const Row& row) const {
  double sum = 0.0;
  for (const auto& [body, on] : {std::pair(row.a, row.on_a), std::pair(row.b, row.on_b)}) {
    const Motion m = motion_of(body);
    sum += on.head<3>().norm() * m.v.norm() + on.tail<3>().norm() * m.omega.norm();
  }
  return sum;
}

/// Stops at their ends; the records of others lose their forces.
void ClosedRows::find_stops(State& state, double rounding) {
  double fastest = 0.0;
  for (const Motion& m : motions_)
    fastest = std::max({fastest, m.v.norm() / system_->length_scale(), m.omega.norm()});
  const double time = fastest > 0.0 ? kConvectiveWay / fastest : 0.0;
  const auto moved = [&](int body, double by) {
    BodyStep s = body == kGround ? steps_.back() : steps_[static_cast<std::size_t>(body)];
    if (body == kGround || by == 0.0) return s;
    const Motion m = motion_of(body);
    const double turn = by * m.omega.norm();
    if (turn != 0.0) {
      s.theta = 2.0 * std::tan(0.5 * turn) * m.omega.normalized();
      s.Lambda_n1 = cay(s.theta) * s.Lambda_n;
    }
    s.u = by * m.v;
    s.r_n1 = s.r_n + s.u;
    return s;
  };
  StepContext at;
  at.t_n = state.t;
  at.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  at.conserving = false;
  const std::vector<double> none(kMaxRows, 0.0);
  std::vector<UnilateralRow> found;
  for (const UnilateralStop& stop : stops_) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(stop.interaction)];
    double* history = state.history.data() + ref.first_history;
    const auto row_at = [&](double by) {
      found.clear();
      const BodyStep a = moved(ref.a, by), b = moved(ref.b, by);
      system_->group(ref.group).unilateral_rows(ref.item, {a, b, at, none.data(), history}, found);
      Row row;
      row.a = ref.a;
      row.b = ref.b;
      if (!found.empty()) {
        row.on_a = found[static_cast<std::size_t>(stop.number)].by_a;
        row.on_b = found[static_cast<std::size_t>(stop.number)].by_b;
      }
      return row;
    };
    Row row = row_at(0.0);
    UnilateralMemory record = read_record<UnilateralMemory>(state.history.data() + stop.memory);
    record.force = 0.0;
    write_record(record, state.history.data() + stop.memory);
    if (found.empty()) continue;
    const bool near =
        found[static_cast<std::size_t>(stop.number)].gap_n1 <= system_->touching_gap();
    const bool rests = std::abs(rate(row)) <= rounding + kRateRounding * largest_rate(row);
    if (record.closed == 0.0 && !(near && rests)) continue;
    if (time > 0.0) row.convective = (rate(row_at(time)) - rate(row_at(-time))) / (2.0 * time);
    row.with_a = row.on_a;
    row.with_b = row.on_b;
    row.memory = stop.memory;
    blocks_.push_back(
        {.kind = ImpulseRows::Kind::normal, .first = static_cast<Eigen::Index>(rows_.size())});
    rows_.push_back(row);
  }
}

void ClosedRows::find_contacts(const State& state, double rounding) {
  StepContext search;
  search.t_n = state.t;
  search.dt = kInstantSearch;
  search.ga.alpha_f = 1.0;
  search.conserving = false;
  contacts_->begin_step(state, steps_, search);
  std::vector<ContactInstant> found;
  contacts_->impulsive()->points_at(steps_, found);
  for (const ContactInstant& at : found)
    if (at.gap <= system_->touching_gap() || !at.impulse.isZero(0.0)) put_contact(at, rounding);
}

/// Rows of a contact point that stays closed: its normal, and friction that holds. Friction of a
/// point that slides acts against its slip, in proportion to the normal force.
void ClosedRows::put_contact(const ContactInstant& at, double rounding) {
  const Motion a = motion_of(at.a), b = motion_of(at.b);
  Eigen::Matrix<double, 12, 1> twist;
  twist << a.v, a.omega, b.v, b.omega;
  const Vec3 n = at.normal, n_rate = at.normal_by * twist, place_rate = at.place_by * twist;
  const Vec3 arm_a = at.place - a.r, arm_b = at.place - b.r;
  const Vec3 slip = a.v + a.omega.cross(arm_a) - b.v - b.omega.cross(arm_b);
  const Vec3 turn = a.omega - b.omega;
  const auto row_of = [&](const Vec3& d, bool turns) {
    Row row;
    row.a = at.a;
    row.b = at.b;
    const Vec3 force = turns ? Vec3(Vec3::Zero()) : d;
    if (at.a != kGround) row.on_a << force, turns ? d : Vec3(arm_a.cross(d));
    if (at.b != kGround) row.on_b << -force, turns ? Vec3(-d) : Vec3(-arm_b.cross(d));
    row.length = turns ? at.size : 1.0;
    if (!turns)
      row.convective = d.dot(a.omega.cross(place_rate - a.v) - b.omega.cross(place_rate - b.v));
    row.with_a = row.on_a;
    row.with_b = row.on_b;
    return row;
  };
  Row normal = row_of(n, false);
  normal.convective += n_rate.dot(slip);
  const auto rests = [&](double speed, const Row& row) {
    return speed <= rounding + kRateRounding * largest_rate(row);
  };
  const bool closed = !at.impulse.isZero(0.0);
  if (!closed && !rests(std::abs(n.dot(slip)), normal)) return;
  const auto first = static_cast<Eigen::Index>(rows_.size());
  rows_.push_back(normal);
  blocks_.push_back({.kind = ImpulseRows::Kind::normal, .first = first});
  const auto hold = [&](std::initializer_list<Vec3> directions, bool turns, double along,
                        double across) {
    blocks_.push_back({.kind = ImpulseRows::Kind::friction,
                       .first = static_cast<Eigen::Index>(rows_.size()),
                       .size = static_cast<Eigen::Index>(directions.size()),
                       .normal = first,
                       .half_axes = {along, across, 0.0}});
    for (const Vec3& d : directions) rows_.push_back(row_of(d, turns));
  };
  const auto slide = [&](const Vec3& per_force, bool turns) {
    const Row row = row_of(per_force, turns);
    rows_[static_cast<std::size_t>(first)].with_a += row.on_a;
    rows_[static_cast<std::size_t>(first)].with_b += row.on_b;
  };
  Vec3 along = at.along - n.dot(at.along) * n;
  along = along.squaredNorm() > kNormalDirection ? Vec3(along.normalized()) : n.unitOrthogonal();
  const Vec3 across = n.cross(along);
  if (at.friction > 0.0) {
    const Vec3 tangential = slip - n.dot(slip) * n;
    if (tangential.isZero(0.0) || (closed ? !at.slips : rests(tangential.norm(), normal))) {
      const bool isotropic = at.friction_across == at.friction;
      const double mu = isotropic ? at.static_friction : at.friction;
      hold({along, across}, false, mu, isotropic ? mu : at.friction_across);
    } else {  // the force of the friction ellipse with the largest dissipation
      const double x = at.friction * along.dot(tangential),
                   y = at.friction_across * across.dot(tangential);
      slide(-(at.friction * x * along + at.friction_across * y * across) / std::hypot(x, y), false);
    }
  }
  const auto turns_at_rest = [&](double speed) {
    return speed * at.size <= rounding + kRateRounding * largest_rate(normal);
  };
  if (at.torsion > 0.0) {
    const double speed = n.dot(turn);
    if (turns_at_rest(std::abs(speed)))
      hold({n}, true, at.torsion, 0.0);
    else
      slide(-at.torsion * std::copysign(1.0, speed) * n, true);
  }
  if (at.rolling > 0.0) {
    const Vec3 rolls = turn - n.dot(turn) * n;
    if (turns_at_rest(rolls.norm()))
      hold({along, across}, true, at.rolling, at.rolling);
    else
      slide(-at.rolling * rolls.normalized(), true);
  }
}

/// @eq{closed-rows}
bool ClosedRows::solve(InstantSolver& solver, State& state, double rounding,
                       std::vector<Vec6>& wrenches) {
  const std::size_t bodies = static_cast<std::size_t>(system_->body_count());
  rows_.clear();
  blocks_.clear();
  motions_.resize(bodies);
  steps_.clear();
  for (std::size_t b = 0; b < bodies; ++b) {
    const BodyMotion m = system_->motion(state, static_cast<int>(b));
    motions_[b] = {m.r, m.v, m.omega()};
    steps_.push_back(system_->instant(state, static_cast<int>(b)));
  }
  steps_.push_back(BodyStep::ground(1.0));
  const std::vector<double> records = state.history;
  find_stops(state, rounding);
  if (contacts_) find_contacts(state, rounding);
  const auto n = static_cast<Eigen::Index>(rows_.size());
  if (n == 0) return true;
  const auto fail = [&] {
    state.history = records;
    return false;
  };
  if (n > kMostDenseRows) return fail();
  const InstantSolution free = solver.accelerations(state, wrenches);
  if (!free.solved || !solver.take_impulses(state)) return fail();
  const auto times = [](const Row& row, const auto& of_body) {
    double sum = 0.0;
    if (row.a != kGround) sum += row.on_a.dot(of_body(row.a));
    if (row.b != kGround) sum += row.on_b.dot(of_body(row.b));
    return sum;
  };
  const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  RowProblem problem(n);
  problem.even = true;
  problem.blocks = blocks_;
  std::vector<Vec6> impulses(bodies);
  double largest = system_->gravity().norm();
  for (Eigen::Index j = 0; j < n; ++j) {
    const Row& row = rows_[at(j)];
    std::fill(impulses.begin(), impulses.end(), Vec6::Zero());
    if (row.a != kGround) impulses[static_cast<std::size_t>(row.a)] += row.with_a;
    if (row.b != kGround) impulses[static_cast<std::size_t>(row.b)] += row.with_b;
    const std::vector<Vec6> jumps = solver.jumps(impulses);
    for (Eigen::Index i = 0; i < n; ++i)
      problem.A(i, j) = times(
          rows_[at(i)], [&](int b) -> const Vec6& { return jumps[static_cast<std::size_t>(b)]; });
    problem.b[j] = row.convective + times(row, [&](int b) {
                     Vec6 acceleration;
                     acceleration << free.r_ddot[static_cast<std::size_t>(b)],
                         free.alpha[static_cast<std::size_t>(b)];
                     return acceleration;
                   });
    problem.lengths[j] = row.length;
    largest = std::max(largest, row.length * std::abs(problem.b[j]));
  }
  Vec p = Vec::Zero(n);
  if (!problem.solve(p, kRowAccelerations * largest).converged) return fail();
  wrenches.resize(bodies, Vec6::Zero());
  for (Eigen::Index j = 0; j < n; ++j) {
    const Row& row = rows_[at(j)];
    if (row.memory >= 0) {
      UnilateralMemory record = read_record<UnilateralMemory>(state.history.data() + row.memory);
      record.force = p[j];
      write_record(record, state.history.data() + row.memory);
      continue;
    }
    if (row.a != kGround) wrenches[static_cast<std::size_t>(row.a)] += p[j] * row.with_a;
    if (row.b != kGround) wrenches[static_cast<std::size_t>(row.b)] += p[j] * row.with_b;
  }
  return true;
}

}  // namespace polhode
