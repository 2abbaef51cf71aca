// SPDX-License-Identifier: Apache-2.0
// Impacts and resting contact: the phases of a point from closing to opening.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/point_weight.hpp>

namespace polhode::contact {

namespace {

/// Share of the force of dissipative resting contact that is evaluated at the end of the step.
/// @eq{contact-plastic}
constexpr double kRestShare = 0.5;
/// Steps per impact that a damper needs.
constexpr double kResolved = 20.0;
/// Smallest distance between a gap and the floor of its barrier, as a part of the tolerance.
constexpr double kMinBand = 0.1;
/// Part of the slow speed up to which a resting contact takes part in impacts elsewhere.
constexpr double kPressed = 0.1;

}  // namespace

void ContactSet::set_band(Point& p, double stiffness, double upper, double lower) const {
  NormalLaw& law = p.data.normal;
  law.stiffness = p.data.history.stiffness = stiffness;
  law.upper = p.data.history.reach = upper;
  law.lower = p.data.history.floor = lower;
  p.least_gap = lower > kNoFloor ? lower : -std::numeric_limits<double>::infinity();
}

void ContactSet::set_phase(Point& p, ContactPhase phase) const {
  PointData& d = p.data;
  d.history.phase = phase;
  const bool lasts = phase == ContactPhase::rest || phase == ContactPhase::landing;
  const bool by_damper = p.damped && d.history.approach < 0.0;
  const bool takes = p.restitution < 1.0 && !by_damper;
  d.end_share = 0.0;
  if (lasts && takes) d.end_share = kRestShare;
  // An impact without rebound ends where it closes, not at the distance it would have reached.
  if (phase == ContactPhase::compression && d.history.restitution == 0.0) d.end_share = 1.0;
  d.rate_damping = lasts && takes ? p.rest_damping : 0.0;
  if (by_damper) d.rate_damping = p.damping_number / -d.history.approach;
}

/// Starts the barrier's band at the present gap. A gap that is within the band although no force
/// acted on the path to it, as at the start, stores no energy. A spring has its floor below it.
void ContactSet::start_band(Point& p) const {
  const NormalLaw& law = p.data.normal;
  if (law.is_near_floor(p.gap_n))
    set_band(p, law.stiffness, law.reach(), NormalLaw::floor_below(p.gap_n));
  if (law.is_spring()) return;
  const double least = kMinBand * law.tolerance, standard = -law.tolerance;
  const double lower = std::min(standard, p.gap_n - least);
  const double narrower = std::min(1.0, (p.gap_n - lower) / law.tolerance);
  set_band(p, p.open_stiffness ? law.stiffness / narrower : law.stiffness, p.gap_n, lower);
}

/// Changes the stiffness and sets the activation distance with which the point stores this energy
/// at its gap.
/// @eq{turn-law}
void ContactSet::store_again(Point& p, double stiffness, double energy) const {
  const NormalLaw law = p.data.normal.with_stiffness(stiffness);
  const double upper = law.reach_for(p.data.history.gap, energy);
  set_band(p, stiffness, upper, p.data.history.floor);
}

/// Largest speed of resting contact under a force: what the force adds in two steps, and what a
/// body gets that is pressed into its band from rest.
double ContactSet::slow_speed(const Point& p, double force, double dt) const {
  const double a = std::max(system_->gravity().norm(), force / p.mass);
  const double depth = p.data.normal.with_stiffness(p.rest_stiffness).depth_under(p.mass * a);
  return kSlowReboundSteps * std::max(a * std::abs(dt), std::sqrt(a * depth));
}

/// Sets the phase of a point at t_n. An open point gets the phase in which it would close: an
/// impact is faster than what gravity, or for a closed point its force, adds in two steps. A
/// shorter rebound than that is suppressed. A damper replaces that law where the steps resolve it.
/// @eq{turn-law}
void ContactSet::begin_phase(Point& p, double speed, double dt) const {
  PointHistory& h = p.data.history;
  p.speed_n = speed;
  p.unresolved = false;
  p.force_n = h.closed ? h.force : 0.0;
  const double gravity = system_->gravity().norm();
  const auto impact = [&](double slow) {
    h.restitution = p.restitution < 1.0 && -p.restitution * speed < slow ? 0.0 : p.restitution;
    set_phase(p, ContactPhase::compression);
    return std::max(p.rest_stiffness, p.data.normal.stiffness_in_impact(p.mass, -speed));
  };
  if (h.closed) {
    damp_load(p);
    if (h.in_impact() || (p.damped && h.approach < 0.0) || p.restitution == 1.0) return;
    const double slow = slow_speed(p, h.force, dt);
    if (!(-speed > slow)) return;
    const double energy = p.data.normal.energy(h.gap);
    const double k = impact(slow);
    if (p.open_stiffness && k > h.stiffness) store_again(p, k, energy);
    return;
  }
  const double slow = kSlowReboundSteps * gravity * std::abs(dt);
  double k = p.rest_stiffness;
  h.approach = 0.0;
  if (p.damped && p.open_stiffness && speed < 0.0) {
    const double rests = gravity > 0.0 ? p.rest_stiffness : 0.0;
    k = std::max(rests, p.data.normal.stiffness_in_impact(p.mass, -speed));
  }
  const auto duration = [&](double stiffness) {
    return p.data.normal.with_stiffness(stiffness).impact_duration(p.mass, -speed);
  };
  if (p.damped && speed < 0.0 && duration(k) > kResolved * std::abs(dt)) {
    h.approach = speed;
    set_phase(p, ContactPhase::landing);
  } else if (-speed > slow) {
    k = impact(slow);
    const bool own = !p.open_stiffness && p.data.normal.is_spring();
    const double stiffness = p.open_stiffness ? k : p.rest_stiffness;
    p.unresolved = (own || p.damped) && duration(stiffness) < kResolved * std::abs(dt);
  } else {
    set_phase(p, ContactPhase::landing);
  }
  if (!p.open_stiffness) k = p.rest_stiffness;
  set_band(p, k, 0.0, p.floor);
  if (p.gap_n >= p.data.normal.reach()) return;
  h.closed = true;
  h.gap = p.gap_n;
  start_band(p);
}

/// Keeps the part of the stored energy that an impact returns; the stiffness is reduced by it. A
/// spring keeps, of what it has, what brings it back to its tolerance. @eq{turn-law}
void ContactSet::keep_part(Point& p, double part) const {
  const PointHistory& h = p.data.history;
  const double whole = p.data.normal.energy(h.gap);
  const double k = std::max(part * h.stiffness, p.rest_stiffness);
  store_again(p, k, part * whole);
  const double deepest = -p.data.normal.tolerance;
  if (p.data.normal.is_spring() && h.reach < deepest)
    set_band(p, k, std::min(deepest, p.data.normal.reach_for(h.gap, whole)), h.floor);
}

/// Component of gravity along the normal that opposes separation [m/s²].
double ContactSet::gravity_along(const Point& p, const Vec3& n) const {
  Vec3 pull = Vec3::Zero();
  if (shapes_[p.a].body != kGround) pull += system_->gravity();
  if (shapes_[p.b].body != kGround) pull -= system_->gravity();
  return -n.dot(pull);
}

/// Normal speed after the turn of a point that left its band with `speed`; beyond the band it moved
/// under gravity alone. @eq{turn-law}
double ContactSet::exit_speed(const Point& p, const Vec3& n, double speed) const {
  const double e = p.data.history.restitution;
  if (e == 1.0) return speed;
  const double lost = fallen(p, n), apart = std::max(0.0, p.speed_n), kept = apart * apart;
  return std::sqrt(std::max(kept + e * e * (speed * speed + lost - kept) - lost, 0.0));
}

/// 2 a h: reduction by gravity of the squared speed since the point left its band [m²/s²].
double ContactSet::fallen(const Point& p, const Vec3& n) const {
  return 2.0 * gravity_along(p, n) * std::max(0.0, p.report.gap_n1 - p.data.normal.reach());
}

/// Impact row of a point at t_{n+1} with the normal and the point of the gap at that instant,
/// common to both bodies, so that momenta are exact. The target speed is the present one.
PairImpact ContactSet::row_at(const Point& p, const State& state) const {
  PairImpact r;
  r.bodies = {shapes_[p.a].body, shapes_[p.b].body};
  const auto motion = [&](int body) {
    return body == kGround ? BodyMotion{} : system_->motion(state, body);
  };
  const BodyMotion a = motion(r.bodies.a), b = motion(r.bodies.b);
  const Mat3 Lambda_a = a.Lambda(), Lambda_b = b.Lambda();  // placements refer to these
  const Placement<double> at_a(a.r, Lambda_a, 0), at_b(b.r, Lambda_b, 6);
  const Gap<double> g = gap(p.data.pair, *p.data.a, *p.data.b, at_a, at_b);
  const Vec3 n = value(g.normal);
  // Separated bodies are a gap apart: the lighter one receives its impulse at its surface.
  const auto mass = [&](int body) { return body == kGround ? 0.0 : 1.0 / carried_mass_[body]; };
  const double lean = (mass(r.bodies.a) - mass(r.bodies.b)) / (mass(r.bodies.a) + mass(r.bodies.b));
  const Vec3 c = value(g.point) + 0.5 * lean * g.distance * n;
  Impact& impact = r.impact;
  impact.arm_a = c - a.r;
  impact.arm_b = c - b.r;
  impact.on_a << n, impact.arm_a.cross(n);
  impact.on_b << -n, -impact.arm_b.cross(n);
  Vec3 v = Vec3::Zero();
  if (r.bodies.a != kGround) v += a.v + a.omega().cross(impact.arm_a);
  if (r.bodies.b != kGround) v -= b.v + b.omega().cross(impact.arm_b);
  const double speed = n.dot(v);
  impact.wanted = speed;
  const FrictionLaw& f = p.data.friction;
  if (!(f.mu > 0.0)) return r;
  impact.mu = f.mu;
  impact.mu_across = f.mu_across > 0.0 ? f.mu_across : f.mu;
  // Resting contact that sticks is bounded by static friction.
  const bool sticks = !p.data.history.in_impact() && !p.data.history.slips;
  if (sticks && f.mu_static > f.mu && impact.mu_across == f.mu)
    impact.mu = impact.mu_across = f.mu_static;
  const Vec3 slip = v - speed * n;
  Vec3 along = Lambda_a * f.direction;
  along -= n.dot(along) * n;
  if (impact.mu == impact.mu_across) along = slip;
  if (along.squaredNorm() < 1e-24 * std::max(1e-300, v.squaredNorm()))
    along = n.cross(std::abs(n.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY());
  // Once more across the normal: a small slip is a difference of larger numbers.
  along.normalize();
  impact.along = (along - n.dot(along) * n).normalized();
  impact.across = n.cross(impact.along);
  return r;
}

double ContactSet::weight_now(const Point& p, const State& state) const {
  const auto motion = [&](int body) {
    return body == kGround ? BodyMotion{} : system_->motion(state, body);
  };
  const BodyMotion a = motion(shapes_[p.a].body), b = motion(shapes_[p.b].body);
  const Mat3 Lambda_a = a.Lambda(), Lambda_b = b.Lambda();
  return weight_at(p.data, Placement<double>(a.r, Lambda_a, 0),
                   Placement<double>(b.r, Lambda_b, 6));
}

/// Impact of a point at t_{n+1} in an accepted step, by its phase; none in most steps.
/// @eq{turn-law}
std::optional<PairImpact> ContactSet::impact_of(Point& p, const State& state, Work& work) {
  PointHistory& h = p.data.history;
  if (!p.touched || (p.damped && h.approach < 0.0) || p.sensor) return {};
  if (!(p.report.normal_force > 0.0)) return {};
  const bool lasts = !h.in_impact();
  if (h.phase == ContactPhase::rest) return {};
  PairImpact r = row_at(p, state);
  Impact& impact = r.impact;
  const Vec3 n = impact.on_a.head<3>();
  const double speed = impact.wanted;
  impact.given = step_length_ * p.report.normal_force;
  if (lasts) impact.friction_impulse = step_length_ * p.report.friction_force;
  const bool turns = speed >= 0.0;  // friction may have reversed it at t_n
  const auto rests = [&] {
    if (!h.closed) return;
    const double energy = p.data.normal.energy(h.gap);
    const NormalLaw law = p.data.normal.with_stiffness(p.rest_stiffness);
    if (p.open_stiffness && law.reach_for(h.gap, energy) <= 0.0)
      store_again(p, p.rest_stiffness, energy);
    set_phase(p, ContactPhase::rest);
  };
  // Features whose potential fades as they become parallel store a part of the energy.
  const double plain = h.closed ? p.data.normal.energy(h.gap) : 0.0;
  const double weight = weight_now(p, state);
  const double stored_n = p.data.normal.energy(p.report.gap_n);
  ImpactCourse course;
  course.turns = turns;
  course.restitution = h.phase == ContactPhase::restitution ? 1.0 : h.restitution;
  course.fallen = fallen(p, n);
  course.stored_n = weight * stored_n;
  course.stored_n1 = weight * plain;
  const auto release = [&] {
    const double released = weight * (plain - p.data.normal.energy(h.gap));
    work.stored -= released;
    work.dissipated += released;
    p.impact_loss += released;
  };
  switch (h.phase) {
    case ContactPhase::landing:
      if (p.restitution == 1.0 || p.speed_n >= 0.0 || !(speed > 0.0)) return {};
      impact.wanted = 0.0;  // the midpoint rule would return it
      set_phase(p, ContactPhase::rest);
      break;
    case ContactPhase::compression:
      if (!turns) break;
      impact.wanted = exit_speed(p, n, speed);
      if (h.closed && h.restitution < 1.0) {
        const double e = h.restitution;
        if (!p.data.normal.is_spring() || p.open_stiffness) {
          keep_part(p, e * e);
        } else if (e > 0.0) {
          set_band(p, e * e * h.stiffness, h.reach, h.floor);
        }
        release();
      }
      h.restitution > 0.0 ? set_phase(p, ContactPhase::restitution) : rests();
      break;
    case ContactPhase::restitution:
      if (!(speed > 0.0)) rests();
      break;
    case ContactPhase::rest:
      return {};
  }
  if (!lasts && impact.mu > 0.0) r.course = course;
  return r;
}

Work ContactSet::impacts(State& state, std::vector<PairImpact>& list) {
  settling_.clear();
  Work work;
  if (acts_by_rows()) {
    find_rows(state, list);
    return work;
  }
  bool remembered = false;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    const ContactPhase before = p.data.history.phase;
    const std::optional<PairImpact> impact = impact_of(p, state, work);
    remembered = remembered || before != p.data.history.phase;
    if (!impact) continue;
    settling_.push_back(i);
    list.push_back(*impact);
  }
  if (remembered) save(state);
  return work;
}

void ContactSet::resting(const State& state, std::span<const int> bodies,
                         std::vector<PairImpact>& list) {
  if (impulses_) return;
  std::vector<char> listed(points_.size(), 0);
  for (int i : settling_) listed[i] = 1;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[i];
    const PointHistory& h = p.data.history;
    const int a = shapes_[p.a].body, b = shapes_[p.b].body;
    if (!h.closed || h.in_impact() || p.sensor) continue;
    if (is_slack(p, h.gap)) continue;
    if (p.restitution == 1.0 || (p.damped && h.approach < 0.0)) continue;
    const bool theirs = std::binary_search(bodies.begin(), bodies.end(), a) ||
                        std::binary_search(bodies.begin(), bodies.end(), b);
    if (!theirs || listed[i]) continue;
    settling_.push_back(i);
    PairImpact& r = list.emplace_back(row_at(p, state));
    r.slow = kPressed * slow_speed(p, p.force_n, step_length_);
    // By the midpoint rule it returns the energy that an impact in the step has stored in it.
    r.impact.given = step_length_ * p.report.normal_force;
    r.impact.friction_impulse = step_length_ * p.report.friction_force;
  }
}

/// Adds the impulses at the end of the step to its reported forces.
void ContactSet::settled(State& state, std::span<const ResolvedImpact> impacts) {
  for (std::size_t k = 0; k < settling_.size(); ++k) {
    Point& p = points_[settling_[k]];
    const ResolvedImpact& s = impacts[k];
    p.impact_loss += s.normal_loss;
    p.friction_loss += s.friction_loss;
    lost_in_impacts_ += s.normal_loss;
    lost_by_friction_ += s.friction_loss;
    if (!(step_length_ > 0.0)) continue;
    PointReport& r = p.report;
    r.normal_force += s.normal / step_length_;
    r.friction_force += s.friction / step_length_;
    r.force += (s.normal * r.normal + s.friction) / step_length_;
  }
  if (acts_by_rows()) close_rows(state, impacts);
}

}  // namespace polhode::contact
