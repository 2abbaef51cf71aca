// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/closed_form_point.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode::contact {

namespace {

/// Damping ratio of resting contact with e < 1.
constexpr double kRestDamping = 0.3;
/// Largest tolerance of rounded shapes, as a part of their rounding radius.
constexpr double kOfRounding = 0.85;
/// Overlaps that springs do not reach: of rounded shapes, as a part of their rounding radius, and
/// without a given stiffness in tolerances.
constexpr double kDeepest = 0.9, kDeepestTolerances = 4.0;
/// Ratio of margin to required margin above which candidates are found again, as after a diverged
/// iteration.
constexpr double kWideMargin = 8.0;

void check_law(const ContactLaw& law) {
  const auto refuse = [](const char* what, double value, const char* hint) {
    throw InputError("contacts", format("{} is {}", what, value), hint);
  };
  if (!(law.friction.mu >= 0.0) || !(law.friction.mu_across >= 0.0))
    refuse("the coefficient of friction", std::min(law.friction.mu, law.friction.mu_across),
           "Give a number that is zero or positive");
  if (!(law.restitution >= 0.0 && law.restitution <= 1.0))
    refuse("the restitution", law.restitution, "Give a number from 0 to 1");
  for (const double x : {law.stiffness, law.tolerance, law.friction.rolling, law.friction.torsion,
                         law.friction.stiffness, law.friction.damping})
    if (!(x >= 0.0)) refuse("a constant of the contact law", x, "Give it zero or positive");
  if (law.damped && !is_spring(law.potential))
    refuse("the damped rebound with the barrier", law.restitution,
           "Choose the linear or the Hertz law for it, or leave out rebound: damped");
  if (law.damped && law.restitution < 0.05)
    refuse("the restitution of a damped rebound", law.restitution,
           "Give at least 0.05, or leave out rebound: damped");
}

/// c |w_pre| of the damper with which a mass rebounds with e, the root of (1 + e) x = ln((1 + x)/(1
/// − e x)) for any exponent of the spring. @eq{contact-damped}
double damping_number(double e) {
  if (e >= 1.0) return 0.0;
  double low = 0.75 * (1.0 - e * e) / (1.0 + e * e * e), high = 1.0 / e;
  for (int k = 0; k < 60; ++k) {
    const double x = 0.5 * (low + high);
    ((1.0 + e) * x > std::log((1.0 + x) / (1.0 - e * x)) ? low : high) = x;
  }
  return low;
}

/// c of resting contact [s/m]. @param load  Weight on the point [N].
double rest_damping(const NormalLaw& law, double k, double mass, double load) {
  const double slope = law.with_stiffness(k).slope_under(load);
  return 2.0 * kRestDamping * std::sqrt(slope * mass) / load;
}

}  // namespace

/// Adapts the damping of resting contact to the load. A spring chosen for any body of the model may
/// carry more than its own two bodies; a damper chosen for these would let the load sink too
/// slowly.
void ContactSet::damp_load(Point& p) const {
  const PointHistory& h = p.data.history;
  const double gravity = system_->gravity().norm();
  if (!p.data.normal.is_spring() || !p.open_stiffness || h.in_impact() ||
      !(p.data.rate_damping > 0.0))
    return;
  if (p.rest_damping == 0.0 || (p.damped && h.approach < 0.0)) return;
  const double mass = std::max(p.mass, h.force / gravity);
  p.data.rate_damping = rest_damping(p.data.normal, h.stiffness, mass, mass * gravity);
}

int ContactSet::add_shape(PlacedShape shape) {
  shapes_.push_back(std::move(shape));
  return static_cast<int>(shapes_.size()) - 1;
}

int ContactSet::add_material(const ContactMaterial& material) {
  ContactLaw law;
  law.friction.mu = material.mu;
  law.restitution = material.restitution;
  check_law(law);
  materials_.push_back(material);
  return static_cast<int>(materials_.size()) - 1;
}

void ContactSet::set_default(const ContactLaw& law) {
  check_law(law);
  default_law_ = law;
}

void ContactSet::set_law(int material_a, int material_b, const ContactLaw& law) {
  check_law(law);
  laws_[std::minmax(material_a, material_b)] = law;
}

void ContactSet::exclude(int owner_a, int owner_b) {
  excluded_.insert(std::minmax(owner_a, owner_b));
}

/// Law of two shapes. Combined if no pair law is given: √(μ_a μ_b), the smaller restitution.
const ContactLaw& ContactSet::law(int shape_a, int shape_b) const {
  const std::pair<int, int> key = std::minmax(shapes_[shape_a].material, shapes_[shape_b].material);
  if (const auto stated = laws_.find(key); stated != laws_.end()) return stated->second;
  if (key.first < 0) return default_law_;
  const auto [at, fresh] = combined_.try_emplace(key, default_law_);
  if (fresh) {
    const ContactMaterial &a = materials_[key.first], &b = materials_[key.second];
    at->second.friction.mu = std::sqrt(a.mu * b.mu);
    at->second.restitution = std::min(a.restitution, b.restitution);
  }
  return at->second;
}

bool ContactSet::may_meet(const PlacedShape& a, const PlacedShape& b) const {
  if (a.body == b.body) return false;
  if (!(a.groups & b.meets) || !(b.groups & a.meets)) return false;
  if (!a.shape.bounded() && !b.shape.bounded()) return false;
  return excluded_.empty() || !excluded_.contains(owners(a, b));
}

std::pair<int, int> ContactSet::owners(const PlacedShape& a, const PlacedShape& b) {
  const int x = a.owner == -2 ? a.body : a.owner, y = b.owner == -2 ? b.body : b.owner;
  return {std::min(x, y), std::max(x, y)};
}

void ContactSet::prepare(const System& system) {
  system_ = &system;
  const auto n = static_cast<std::size_t>(system.body_count());
  reach_of_body_.assign(n, 0.0);
  size_of_body_.assign(n, std::numeric_limits<double>::infinity());
  stride_.assign(n, std::numeric_limits<double>::infinity());
  for (const PlacedShape& s : shapes_) {
    if (s.body == kGround) continue;
    if (s.body < 0 || s.body >= system.body_count())
      throw InputError("contacts", format("shape '{}' is on body {}", s.name, s.body),
                       "Name a body of the model");
    reach_of_body_[s.body] = std::max(reach_of_body_[s.body], s.shape.reach);
    size_of_body_[s.body] = std::min(size_of_body_[s.body], s.shape.bound_radius);
  }
  carried_mass_.clear();
  inverse_inertia_.clear();
  for (int b = 0; b < system.body_count(); ++b) {
    carried_mass_.push_back(system.carried_mass(b));
    inverse_inertia_.emplace_back(system.bodies()[b].inertia.inverse());
  }
  heaviest_ = 0.0;
  for (const PlacedShape& s : shapes_)
    if (s.body != kGround) heaviest_ = std::max(heaviest_, carried_mass_[s.body]);
  references_.assign(n, {});
  wrenches_.assign(n, Vec6::Zero());
}

/// @eq{contact-stiffness} @eq{spring-stiffness}
void ContactSet::complete_law(Point& p, double dt) const {
  const PlacedShape &a = shapes_[p.a], &b = shapes_[p.b];
  const ContactLaw& law = this->law(p.a, p.b);
  const auto inverse_mass = [&](const PlacedShape& s) {
    return s.body == kGround ? 0.0 : 1.0 / carried_mass_[s.body];
  };
  const double mass = 1.0 / (inverse_mass(a) + inverse_mass(b));
  const bool spring = is_spring(law.potential);
  const bool plane = !a.shape.bounded() || !b.shape.bounded();
  const double rounding = a.shape.rounding + b.shape.rounding;
  PointData& d = p.data;
  d.length = std::min(a.shape.size, b.shape.size);
  d.mass = mass;
  d.normal.potential = law.potential;
  d.normal.tolerance =
      law.tolerance > 0.0 ? law.tolerance : 1e-3 * std::min(a.shape.detail, b.shape.detail);
  if (!plane) d.normal.tolerance = std::min(d.normal.tolerance, kOfRounding * rounding);
  const double tolerance = d.normal.tolerance;
  const double weight = mass * system_->gravity().norm();
  // Springs let heavier bodies than they were chosen for pass, and any body may lie on any other.
  const double rests = spring ? heaviest_ * system_->gravity().norm() : weight;
  const double load = law.reference_load > 0.0 ? law.reference_load : rests;
  // A damper works over the duration of a contact, which must not depend on the step.
  const double by_step = law.damped && load > 0.0 ? 0.0 : mass / (dt * dt);
  p.open_stiffness = law.stiffness == 0.0;
  const NormalLaw stated = d.normal.with_stiffness(law.stiffness);
  const auto [k, k_T] = p.open_stiffness
                            ? d.normal.stiffness_under(load, by_step)
                            : NormalLaw::Stiffness{stated.stiffness, stated.bristle_stiffness()};
  p.mass = mass;
  p.rest_stiffness = k;
  p.bristle_stiffness = k_T;
  p.rest_damping = weight > 0.0 ? rest_damping(d.normal, k, mass, weight) : 0.0;
  p.restitution = law.restitution;
  p.damped = law.damped;
  p.damping_number = law.damped ? damping_number(law.restitution) : 0.0;
  p.may_be_closed_form = d.a && is_closed_form_point(d);
  p.sensor = law.sensor;
  p.law_dt = dt;
  p.floor = plane ? kNoFloor : -kDeepest * rounding;
  if (p.open_stiffness) p.floor = std::max(p.floor, -kDeepestTolerances * tolerance);
  if (!spring) p.floor = -tolerance;
  const PointHistory& h = d.history;
  if (h.closed && h.stiffness > 0.0)
    set_band(p, h.stiffness, h.reach, h.floor);
  else
    set_band(p, k, 0.0, p.floor);
  set_phase(p, h.phase);

  d.friction = law.friction;
  FrictionLaw& f = d.friction;
  if (f.stiffness == 0.0)
    f.stiffness = h.closed && h.bristle_stiffness > 0.0 ? h.bristle_stiffness : k_T;
  d.history.bristle_stiffness = f.stiffness;
  if (f.damping == 0.0) f.damping = 0.7 * std::sqrt(f.stiffness * mass);
  if (f.turning_stiffness == 0.0) f.turning_stiffness = f.stiffness * d.length * d.length;
  if (f.turning_damping == 0.0)
    f.turning_damping = 0.7 * std::sqrt(f.turning_stiffness * mass * d.length * d.length);
}

void ContactSet::open_or_close(std::span<const BodyStep> steps, const StepContext& context) {
  balls_.resize(points_.size());
  renewed_ = true;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    open_or_close(points_[i], balls_[i], steps, context);
    if (context.ga.alpha_f != 0.5) balls_[i].holds = false;
  }
  if (!impulses_) share_friction();
}

void ContactSet::open_or_close(Point& p, SpherePairCache& balls, std::span<const BodyStep> steps,
                               const StepContext& context) const {
  PointHistory& h = p.data.history;
  p.plain = p.may_be_closed_form && context.ga.alpha_f == 0.5;
  const auto index = [&](int shape) {
    const int body = shapes_[shape].body;
    return body == kGround ? static_cast<int>(steps.size()) - 1 : body;
  };
  const int at_a = index(p.a), at_b = index(p.b);
  const BodyStep &a = steps[at_a], &b = steps[at_b];
  balls = p.plain ? sphere_pair_cache(p.data, a, b) : SpherePairCache{};
  balls.a = at_a;
  balls.b = at_b;
  Vec3 c, n;
  if (balls.holds) {
    p.gap_n = balls.gap_n;
    n = balls.distance > 0.0 ? Vec3(balls.offset / balls.distance) : balls.offset;
    c = a.r_n - (p.data.a->rounding + 0.5 * p.gap_n) * n;
  } else {
    const Gap<double> g =
        gap(p.data.pair, *p.data.a, *p.data.b, Placement<double>(a.r_n, a.Lambda_n, 0),
            Placement<double>(b.r_n, b.Lambda_n, 6));
    p.gap_n = g.distance;
    c = value(g.point);
    n = value(g.normal);
  }
  if (h.closed && !impulses_) p.gap_n = h.gap;
  balls.gap_n = p.gap_n;
  if (starts_ && acts_by_rows()) h.kept = kept_gap(p.gap_n, touching_gap());
  p.normal_n = n;
  p.place_n = c;
  if (!impulses_) {
    const Vec3 v_a = a.v_n + (a.Lambda_n * a.W_n).cross(c - a.r_n);
    const Vec3 v_b = b.v_n + (b.Lambda_n * b.W_n).cross(c - b.r_n);
    begin_phase(p, n.dot(v_a - v_b), context.dt);
  }
  balls.reach = p.data.normal.reach();
  balls.least_gap = p.least_gap;
}

bool ContactSet::begin_step(const State& state, std::span<const BodyStep> steps,
                            const StepContext& context) {
  starts_ = state.ledger.steps == 0;
  const bool same = loaded_ && saved_ == state.contacts;
  const std::vector<Participants> before = pairs_;
  if (!same) {
    load(state);
    longest_step_ = std::max(longest_step_, std::abs(context.dt));
    if (points_.size() + state.contacts.size() > 0) find_candidates(longest_step_);
  }
  longest_step_ = std::max(longest_step_, std::abs(context.dt));
  bool stale = false;
  for (int body = 0; body < static_cast<int>(references_.size()); ++body) {
    if (reach_of_body_[body] == 0.0) continue;
    const BodyStep& s = steps[body];
    const double ahead = context.dt * (s.v_n.norm() + s.W_n.norm() * reach_of_body_[body]);
    const double margin = references_[body].margin, wanted = margin_of(body, s, context.dt);
    if (!(moved(body, s.r_n, s.Lambda_n) + ahead < margin) || margin > kWideMargin * wanted)
      stale = true;
    stride_[body] = std::max(2.0 * size_of_body_[body], wanted);
  }
  if (stale) {
    for (Reference& r : references_) r.margin = -1.0;
    refer(steps, context);
    find_candidates(longest_step_);
  }
  for (Point& p : points_)
    if (p.law_dt != longest_step_) complete_law(p, longest_step_);
  open_or_close(steps, context);
  slides_.clear();
  tightest_ = -1;
  return !std::equal(
      before.begin(), before.end(), pairs_.begin(), pairs_.end(),
      [](const Participants& x, const Participants& y) { return x.a == y.a && x.b == y.b; });
}

bool ContactSet::acts(int point, double gap_1, double& least) {
  const Point& p = points_[point];
  const double reach = p.data.normal.reach();
  if (p.sensor || !(p.gap_n < reach || gap_1 < reach)) return false;
  if (const double room = gap_1 - p.least_gap; room < least) least = room, tightest_ = point;
  return true;
}

void ContactSet::evaluate(std::span<const BodyStep> steps, const StepContext& context,
                          std::span<PairTerms> terms) {
  for (PairTerms& t : terms) context.tangents ? t.set_sums_zero() : t.set_values_zero();
  pointwise_ = false;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    const Point& p = points_[i];
    const BodyStep &a = step_of(p.a, steps), &b = step_of(p.b, steps);
    if (least_gap_at_end(p, a, b) >= p.data.normal.reach()) continue;
    if (!acts(i, gap_at_end(i, a, b), least)) continue;
    PairTerms& t = terms[p.pair];
    if (!p.swapped) {
      add_contact(p.data, a, b, context, t);
      continue;
    }
    std::swap(t.wrench_a, t.wrench_b);
    std::swap(t.D_aa, t.D_bb);
    std::swap(t.D_ab, t.D_ba);
    add_contact(p.data, a, b, context, t);
    std::swap(t.wrench_a, t.wrench_b);
    std::swap(t.D_aa, t.D_bb);
    std::swap(t.D_ab, t.D_ba);
  }
}

namespace {

/// Releases the bristles of a point that opened: their energy is dissipated.
void release_bristles(const FrictionLaw& f, PointReport& r) {
  const double held = 0.5 * f.stiffness * r.after.bristle.squaredNorm() +
                      0.5 * f.turning_stiffness *
                          (r.after.rolling.squaredNorm() + r.after.torsion * r.after.torsion);
  r.work.stored -= held;
  r.work.dissipated += held;
  r.after.bristle.setZero();
  r.after.rolling.setZero();
  r.after.torsion = 0.0;
}

}  // namespace

double ContactSet::least_gap_at_end(const Point& p, const BodyStep& a, const BodyStep& b) const {
  // The combined gap of several features is below the nearest one by less than this.
  const double nearer = 1e-3 * p.data.length;
  const auto moved = [&](int shape, const BodyStep& s) {
    const int body = shapes_[shape].body;
    return body == kGround ? 0.0 : s.u.norm() + s.theta.norm() * reach_of_body_[body];
  };
  return p.gap_n - moved(p.a, a) - moved(p.b, b) - nearer;
}

double ContactSet::gap_at_end(int point, const BodyStep& a, const BodyStep& b) const {
  const Point& p = points_[point];
  return balls_[point].holds ? balls_[point].gap_n1(a, b) : gap_n1(p.data, p.gap_n, a, b);
}

/// Whether a spring is slack: an impact has left its activation distance below the surface, and the
/// gap lies between the two. It keeps that distance until the surfaces part, since a spring that
/// started from the surface again would create energy. @eq{turn-law}
bool ContactSet::is_slack(const Point& p, double gap) {
  const NormalLaw& law = p.data.normal;
  return law.is_spring() && gap >= law.reach() && gap < 0.0;
}

Work ContactSet::commit(State& state, std::span<const BodyStep> steps, const StepContext& context) {
  Work work;
  StepContext values = context;
  values.tangents = false;
  PairTerms unused;
  unused.set_zero();
  touched_ = false;
  for (Vec6& w : wrenches_) w.setZero();
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    const BodyStep &a = step_of(p.a, steps), &b = step_of(p.b, steps);
    const double gap_1 = gap_at_end(i, a, b);
    const double reach = p.data.normal.reach();
    PointHistory& h = p.data.history;
    p.impact_loss = p.friction_loss = 0.0;
    const bool touched_before = p.touched;
    p.touched = acts(i, gap_1, least);
    touched_ = touched_ || p.touched;
    if (!p.touched) {
      if (touched_before) p.report = {};
      p.report.gap_n = p.gap_n;
      p.report.gap_n1 = gap_1;
      if (h.closed && is_slack(p, gap_1)) {
        set_phase(p, ContactPhase::rest);
        h = h.without_bristles();
        h.gap = gap_1;
        h.force = 0.0;
      } else {
        h = {.stiffness = h.stiffness, .bristle_stiffness = h.bristle_stiffness};
      }
      continue;
    }
    unused.wrench_a.setZero();
    unused.wrench_b.setZero();
    if (p.plain && pointwise_) {
      const PointForce f = closed_form_force(p.data, p.gap_n, gap_1, a, b, values, &p.report);
      unused.wrench_a << f.force, f.moment_a;
      unused.wrench_b << -f.force, f.moment_b;
    } else {
      add_contact(p.data, a, b, values, unused, &p.report);
    }
    if (gap_1 >= reach) release_bristles(p.data.friction, p.report);
    if (h.in_impact()) {  // friction is an impulse now: the bristles' energy is dissipated
      const FrictionLaw& f = p.data.friction;
      p.report.work.dissipated +=
          0.5 * f.stiffness * h.bristle.squaredNorm() +
          0.5 * f.turning_stiffness * (h.rolling.squaredNorm() + h.torsion * h.torsion);
    }
    const PointReport& r = p.report;
    if (shapes_[p.a].body != kGround) wrenches_[shapes_[p.a].body] += unused.wrench_a;
    if (shapes_[p.b].body != kGround) wrenches_[shapes_[p.b].body] += unused.wrench_b;
    work.stored += r.work.stored;
    work.dissipated += r.work.dissipated;
    lost_by_friction_ += r.work.dissipated;
    h.bristle = r.after.bristle;
    h.normal = r.after.normal;
    h.rolling = r.after.rolling;
    h.torsion = r.after.torsion;
    h.slips = r.after.slips;
    h.closed = gap_1 < reach || is_slack(p, gap_1);
    h.gap = r.gap_n1;
    h.force = r.normal_force;
  }
  step_length_ = context.dt;
  release_patches(steps, context.dt);
  save(state);
  return work;
}

/// Stored energy at an instant. The query changes nothing: results are equal bit for bit however
/// often it is made. What a state other than the last one has closed is found again when its next
/// step begins.
double ContactSet::stored(const State& state, std::span<const BodyStep> instants) {
  if (impulses_) return 0.0;
  if (!loaded_ || saved_ != state.contacts) {
    StepContext still;
    still.dt = state.dt_next > 0.0 ? state.dt_next : 1e-2;
    begin_step(state, instants, still);
    loaded_ = false;
  }
  double energy = 0.0;
  for (const Point& p : points_) {
    if (p.sensor || !p.data.history.closed) continue;
    energy += stored_at(p.data, step_of(p.a, instants), step_of(p.b, instants)) +
              0.5 * p.data.friction.stiffness * p.data.history.bristle.squaredNorm() +
              0.5 * p.data.friction.turning_stiffness *
                  (p.data.history.rolling.squaredNorm() +
                   p.data.history.torsion * p.data.history.torsion);
  }
  return energy;
}

}  // namespace polhode::contact
