// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/instant_rows.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/system/unilateral_stops.hpp>

namespace polhode {

namespace {

/// Rotation of a body that looks ahead, at most [rad].
constexpr double kMostAhead = 0.5;
/// Displacements, as parts of the mechanism's size, among which one finds a point that is near.
constexpr double kFirstProbe = 1e-2, kLastProbe = 10.0, kProbeFactor = 5.0;

BodyStep moved_by(const BodyStep& from, const Vec3& u, const Vec3& theta) {
  BodyStep s = from;
  s.u = u;
  s.theta = theta;
  s.r_n1 = s.r_n + u;
  s.Lambda_n1 = cay(theta) * s.Lambda_n;
  return s;
}

Vec6 velocity_in(const State& state, const System& system, int body) {
  Vec6 v = Vec6::Zero();
  if (body == kGround) return v;
  const BodyMotion m = system.motion(state, body);
  v << m.v, m.omega();
  return v;
}

}  // namespace

std::vector<BodyStep> instant_steps(const System& system, const State& state) {
  std::vector<BodyStep> steps;
  for (int b = 0; b < system.body_count(); ++b) steps.push_back(system.instant(state, b));
  steps.push_back(BodyStep::ground(1.0));
  return steps;
}

bool InstantRows::of(const System& system) { return has_unilateral_rows(system); }

InstantRows::InstantRows(const System& system, double dt)
    : system_(&system), dt_(dt), contacts_(system.contacts().get()) {
  if (contacts_) impulsive_ = contacts_->impulsive();
}

StepContext InstantRows::context(double t) const {
  StepContext c;
  c.ga = GeneralizedAlpha::from_spectral_radius(1.0);
  c.t_n = t;
  c.dt = dt_;
  return c;
}

void InstantRows::add_stops(std::span<const BodyStep> steps, const double* history, double t,
                            std::vector<InstantRow>& rows) const {
  StepContext at = context(t);
  at.dt = 0.0;
  const std::vector<double> no_lambda(kMaxRows, 0.0);
  std::vector<UnilateralRow> found;
  const auto step_of = [&](int body) -> const BodyStep& {
    return body == kGround ? steps.back() : steps[static_cast<std::size_t>(body)];
  };
  for (const int i : system_->unilateral()) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(i)];
    found.clear();
    system_->group(ref.group).unilateral_rows(
        ref.item,
        {step_of(ref.a), step_of(ref.b), at, no_lambda.data(), history + ref.first_history}, found);
    for (std::size_t k = 0; k < found.size(); ++k) {
      InstantRow& row = rows.emplace_back();
      row.a = ref.a;
      row.b = ref.b;
      row.by_a = found[k].by_a;
      row.by_b = found[k].by_b;
      row.gap = found[k].gap_n1;
      row.restitution = found[k].restitution;
      row.interaction = i;
      row.number = static_cast<int>(k);
    }
  }
}

void InstantRows::add_contacts(const State& state, std::span<const BodyStep> steps,
                               std::span<const BodyStep> moved, std::vector<InstantRow>& rows) {
  const StepContext at = context(state.t);
  contacts_->begin_step(state, steps, at);
  if (!impulsive_->covers(moved)) {
    const std::vector<Vec6> nowhere(static_cast<std::size_t>(system_->body_count()), Vec6::Zero());
    contacts_->cover(moved, at, nowhere);
  }
  points_.clear();
  impulsive_->find_points(moved, at, points_);
  for (const ImpulsePoint& p : points_) {
    InstantRow& row = rows.emplace_back();
    row.a = p.a;
    row.b = p.b;
    row.normal = p.normal_n;
    row.place = p.place_n;
    const auto arm = [&](int body) {
      return Vec3(p.place_n - steps[static_cast<std::size_t>(body)].r_n);
    };
    if (p.a != kGround) row.by_a << p.normal_n, arm(p.a).cross(p.normal_n);
    if (p.b != kGround) row.by_b << -p.normal_n, -arm(p.b).cross(p.normal_n);
    row.gap = p.gap;
    row.restitution = p.restitution;
    row.friction = std::max({p.friction, p.rolling, p.torsion});
  }
}

std::vector<InstantRow> InstantRows::ahead(const State& state, double time) {
  std::vector<InstantRow> rows;
  const std::vector<BodyStep> steps = instant_steps(*system_, state);
  add_stops(steps, state.history.data(), state.t, rows);
  if (!impulsive_) return rows;
  std::vector<BodyStep> moved = steps;
  for (int b = 0; b < system_->body_count(); ++b) {
    BodyStep& s = moved[static_cast<std::size_t>(b)];
    const Vec3 omega = s.Lambda_n * s.W_n;
    const double turn = std::min(time * omega.norm(), kMostAhead);
    const Vec3 theta =
        turn > 0.0 ? Vec3(2.0 * std::tan(0.5 * turn) * omega.normalized()) : Vec3(Vec3::Zero());
    s = moved_by(s, time * s.v_n, theta);
  }
  add_contacts(state, steps, moved, rows);
  return rows;
}

InstantRow InstantRows::same(const State& state, std::span<const BodyStep> steps,
                             const double* history, const InstantRow& like) {
  std::vector<InstantRow> rows;
  if (!like.is_contact()) {
    add_stops(steps, history, state.t, rows);
    for (const InstantRow& row : rows)
      if (row.interaction == like.interaction && row.number == like.number) return row;
    throw InputError(name(like), "is missing", "Leave this parameter out");
  }
  const double size = system_->length_scale();
  for (double way = kFirstProbe; way < kLastProbe; way *= kProbeFactor) {
    std::vector<BodyStep> moved(steps.begin(), steps.end());
    const int body = like.a != kGround ? like.a : like.b;
    const double sign = like.a != kGround ? -1.0 : 1.0;
    BodyStep& s = moved[static_cast<std::size_t>(body)];
    s = moved_by(s, sign * way * size * like.normal, Vec3::Zero());
    rows.clear();
    add_contacts(state, steps, moved, rows);
    const auto miss = [&](const InstantRow& row) {
      return (1.0 - row.normal.dot(like.normal)) + (row.place - like.place).norm() / size;
    };
    std::erase_if(rows, [&](const InstantRow& row) {
      return row.a != like.a || row.b != like.b || row.normal.dot(like.normal) < 0.5;
    });
    const auto nearest = std::min_element(
        rows.begin(), rows.end(),
        [&](const InstantRow& x, const InstantRow& y) { return miss(x) < miss(y); });
    if (nearest != rows.end()) return *nearest;
  }
  throw InputError(name(like), "is no longer there beside the motion of the run",
                   "Choose a parameter that moves it by less");
}

double InstantRows::speed(const State& state, const InstantRow& row) const {
  return row.by_a.dot(velocity_in(state, *system_, row.a)) +
         row.by_b.dot(velocity_in(state, *system_, row.b));
}

double InstantRows::size_of_speed(const State& state, const InstantRow& row) const {
  double size = 0.0;
  for (const auto& [body, by] : {std::pair(row.a, row.by_a), std::pair(row.b, row.by_b)}) {
    const Vec6 v = velocity_in(state, *system_, body);
    size += by.head<3>().norm() * v.head<3>().norm() + by.tail<3>().norm() * v.tail<3>().norm();
  }
  return size;
}

std::string InstantRows::name(const InstantRow& row) const {
  return row.is_contact() ? "the contact of " + pair_name(*system_, row.a, row.b)
                          : stop_name(*system_, row.interaction);
}

}  // namespace polhode
