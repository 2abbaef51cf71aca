// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <polhode/contact_laws/exit_speed.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/mean_turn.hpp>
#include <polhode/engines/nonsmooth_engine.hpp>

namespace polhode {

namespace {

/// Largest number of searches with updated geometry, after the first.
constexpr int kMaxRounds = 4;
/// Relative change of the motion at which the iteration of motion-dependent loads ends.
constexpr double kSameMotion = 1e-13;
constexpr int kMaxRepeats = 60;
/// Depth of an overlap, as a part of the smaller size, that no step with unconverged impulses may
/// produce.
constexpr double kPressedIn = 0.1;
/// Increase of a penetration, as a part of the smaller size, above which a step with converged
/// impulses is too long for the motion of the contact point.
constexpr double kSinks = 3e-3;
/// Change of speeds in the last sweep over few points, relative to gravity's speed increment in a
/// step, above which a step fails.
constexpr double kFarOff = 1.0;
/// Largest number of solutions of a step that would gain energy, each with more points held back.
constexpr int kMaxHeldBack = 3;
/// Largest number of sweeps before Newton's method, unless given.
constexpr int kUsualSweeps = 100;
/// Largest number of sweeps in a step times that of points and turns, unless the sweeps are given
/// or fewer than the usual ones: few bodies with large mass ratios or elastic impacts need many.
constexpr int kAffordable = 200000;
/// Number of points and turns for which Newton's method also follows sweeps that have converged.
constexpr int kFew = 20;
/// Tolerance of Newton's method, which converges quadratically, as a part of that of sweeps.
constexpr double kExact = 1e-6;
/// Reference speed of tolerances without gravity: this part of the fastest speed.
constexpr double kPartOfSpeed = 1e-2;

}  // namespace

bool NonsmoothEngine::has_impulses(const System& system) {
  if (!system.contacts()) return false;
  const ImpulsiveContacts* c = system.contacts()->impulsive();
  return c && c->impulses() && !c->impulses()->rigid;
}

NonsmoothEngine::NonsmoothEngine(const System& system)
    : system_(&system),
      contacts_(system.contacts().get()),
      impulsive_(contacts_ ? contacts_->impulsive() : nullptr),
      bodies_(system.body_count()),
      loads_(system) {
  if (!has_impulses(system) || system.rows() > 0 || !system.nodes().empty())
    throw InputError("contacts", "the non-smooth law supports bodies with contact and loads only",
                     "Use another law in models with joints or solids");
  options_ = *impulsive_->impulses();
  contacts_->prepare(system);
  const auto n = static_cast<std::size_t>(bodies_);
  steps_.assign(n + 1, BodyStep::ground(0.5));
  loads_now_.assign(n, Vec6::Zero());
  impulses_.assign(n, Vec6::Zero());
  nowhere_.assign(n, Vec6::Zero());
  inertia_.resize(n);
  sweeps_.bodies.assign(n + 1, {});
  for (const BodyData& body : system.bodies()) {
    sweeps_.bodies[round_.size()].inverse_mass = 1.0 / body.mass;
    round_.push_back(body.inertia == body.inertia(0, 0) * Mat3::Identity() ? 1 : 0);
  }
}

/// Predictor: bodies keep their velocities of t_n.
void NonsmoothEngine::begin_step(const State& state, Trial& trial) {
  const double dt = dt_ = trial.context.dt;
  double fastest = 0.0;
  for (int b = 0; b < bodies_; ++b) {
    BodyStep& s = steps_[b] = body_step(*system_, state, trial, b);
    s.r_n1 = s.r_n;
    s.Lambda_n1 = s.Lambda_n;
    s.u = s.theta = Vec3::Zero();
    const Mat3& J = system_->bodies()[b].inertia;
    inertia_[b] = round_[b] ? J : Mat3(s.Lambda_n * J * s.Lambda_n.transpose());
    sweeps_.bodies[b].inverse_inertia = inertia_[b].inverse();
    fastest = std::max(fastest, s.v_n.squaredNorm());
  }
  reference_ = system_->gravity().norm() * std::abs(dt);
  if (reference_ == 0.0) reference_ = kPartOfSpeed * std::sqrt(fastest);
  contacts_->begin_step(state, steps_, trial.context);
}

/// Moves the bodies by impulses and loads: exactly, by the same equations as any force.
/// Motion-dependent loads are iterated.
bool NonsmoothEngine::move(const State& state, const Trial& trial) {
  const double dt = trial.context.dt, per_length = 1.0 / system_->length_scale();
  StepContext values = trial.context;
  values.tangents = false;
  for (int repeat = 0; repeat < kMaxRepeats; ++repeat) {
    std::fill(loads_now_.begin(), loads_now_.end(), Vec6::Zero());
    if (!loads_.empty())
      loads_.run(steps_, values, trial.lambda.data(), state.history.data(),
                 [&](int interaction, const PairStep&, const PairTerms& t) {
                   const InteractionRef& ref = system_->interactions()[interaction];
                   if (ref.a != kGround) loads_now_[ref.a] += t.wrench_a;
                   if (ref.b != kGround) loads_now_[ref.b] += t.wrench_b;
                 });
    std::fill(impulses_.begin(), impulses_.end(), Vec6::Zero());
    for (const ImpulsePoint& p : points_) {
      if (p.a != kGround) impulses_[p.a].head<3>() += p.impulse;
      if (p.b != kGround) impulses_[p.b].head<3>() -= p.impulse;
    }
    double change = 0.0, size = 0.0;
    for (int b = 0; b < bodies_; ++b) {
      BodyStep& s = steps_[b];
      const Vec3 before = s.u, impulse = dt * loads_now_[b].head<3>() + impulses_[b].head<3>();
      s.u = dt * (s.v_n + 0.5 * (dt * system_->gravity() + impulse / system_->bodies()[b].mass));
      change = std::max(change, per_length * (s.u - before).norm());
      size = std::max(size, per_length * s.u.norm());
    }
    // Lever arms are those of the middle of the step, which is now known.
    for (const ImpulsePoint& p : points_) {
      const auto turn = [&](int body, double sign) {
        if (body == kGround) return;
        const Vec3 arm = p.place - steps_[body].r_n - 0.5 * steps_[body].u;
        impulses_[body].tail<3>() += sign * (arm.cross(p.impulse) + p.turning);
      };
      turn(p.a, 1.0);
      turn(p.b, -1.0);
    }
    for (int b = 0; b < bodies_; ++b) {
      BodyStep& s = steps_[b];
      const Vec3 before = s.theta, tau = dt * loads_now_[b].tail<3>() + impulses_[b].tail<3>();
      const Vec3 omega = s.Lambda_n * s.W_n;
      Vec3 mean = repeat > 0 ? Vec3(before / dt) : omega;
      if (round_[b]) {
        mean = mean_turn_of_a_ball(inertia_[b](0, 0), omega, tau, dt);
      } else if (!try_mean_turn(inertia_[b], omega, tau, dt, mean)) {
        worst_body_ = b;
        return false;
      }
      s.theta = dt * mean;
      change = std::max(change, (s.theta - before).norm());
      size = std::max(size, s.theta.norm());
      s.r_n1 = s.r_n + s.u;
      s.Lambda_n1 = cay(s.theta) * s.Lambda_n;
      s.v_n1 = 2.0 / dt * s.u - s.v_n;
      s.W_n1 = 2.0 / dt * (s.Lambda_n.transpose() * s.theta) - s.W_n;
    }
    if (loads_.empty() || change <= kSameMotion * std::max(1e-3, size)) return true;
  }
  worst_body_ = -1;
  return false;
}

/// @param first  The steps contain no impulses yet.
void NonsmoothEngine::set_up(double dt, bool first) {
  for (int b = 0; b < bodies_; ++b) {
    sweeps_.bodies[b].v = 2.0 / dt * steps_[b].u;
    sweeps_.bodies[b].w = 2.0 / dt * steps_[b].theta;
  }
  const double slow = kSlowReboundSteps * system_->gravity().norm() * std::abs(dt);
  sweeps_.points.resize(points_.size());
  sweeps_.turns.clear();
  for (int k = 0; k < point_count(); ++k) {
    ImpulsePoint& at = points_[k];
    ProjectedGaussSeidel::Point& p = sweeps_.points[k];
    const BodyStep &a = steps_[index(at.a)], &b = steps_[index(at.b)];
    p.a = index(at.a);
    p.b = index(at.b);
    p.normal = at.normal;
    // The ground's lever arms are not used.
    p.arm_a = a.moves ? Vec3(at.place - a.r_n - 0.5 * a.u) : Vec3::Zero();
    p.arm_b = b.moves ? Vec3(at.place - b.r_n - 0.5 * b.u) : Vec3::Zero();
    const Vec3 w_a = a.Lambda_n * a.W_n, w_b = b.Lambda_n * b.W_n;
    p.least = at.rate + contact::least_exit_speed(at.gap, at.rate, at.restitution, dt, slow);
    const bool held_back = k < static_cast<int>(held_back_.size()) && held_back_[k];
    p.wanted = Vec3::Zero();
    if (!held_back) p.wanted = at.velocity - p.normal.dot(at.velocity) * p.normal;
    p.friction = at.friction;
    p.normal_impulse = std::max(0.0, p.normal.dot(at.impulse));
    p.friction_impulse = at.impulse - p.normal.dot(at.impulse) * p.normal;
    const double limit = p.friction * p.normal_impulse, size = p.friction_impulse.norm();
    if (size > limit) p.friction_impulse *= limit / size;
    if (first) {
      at.impulse = p.normal_impulse * p.normal + p.friction_impulse;
      sweeps_.apply(p, at.impulse);
    } else if (k < static_cast<int>(places_.size())) {  // its impulse now acts here
      const Vec3 moment = (at.place - places_[k]).cross(at.impulse);
      sweeps_.turn(p, moment);
    }
    if (at.rolling == 0.0 && at.torsion == 0.0) continue;
    const Vec3 turns = held_back ? Vec3(Vec3::Zero()) : Vec3(w_a - w_b);
    sweeps_.turns.push_back({k, at.rolling, at.torsion, turns, at.turning});
    if (first) sweeps_.turn(p, at.turning);
  }
}

/// Largest number of sweeps in a step.
int NonsmoothEngine::most_sweeps() const {
  if (options_.sweeps > 0) return options_.sweeps;
  return std::max(kUsualSweeps, kAffordable / std::max(1, unknowns()));
}

/// Gauss-Seidel sweeps. If the usual number does not suffice, Newton's method continues from them
/// for few points; if it fails, more sweeps follow. @returns whether the first sweep changed
/// nothing.
bool NonsmoothEngine::sweep() {
  const double enough = options_.tolerance * reference_;
  bool exact = false;
  double first_change = -1.0;
  bool compact = false;
  const auto run = [&](int most) {
    compact = compact_.take(sweeps_);
    if (!compact) sweeps_.prepare();
    do {
      const bool backwards = search_.sweeps % 2 == 1;
      const double change =
          std::sqrt(compact ? compact_.sweep(backwards) : sweeps_.sweep(backwards));
      ++search_.sweeps;
      search_.change = reference_ > 0.0 ? change / reference_ : change;
      search_.converged = change <= enough;
      exact = change <= kExact * enough;
      if (first_change < 0.0) first_change = change;
    } while (!search_.converged && search_.sweeps < most);
    if (compact) compact_.give_back();
  };
  run(options_.sweeps > 0 ? options_.sweeps : kUsualSweeps);
  if (search_.converged ? !exact && unknowns() <= kFew : is_small()) {
    if (compact) sweeps_.prepare();
    if (solve_impulses(sweeps_, enough, kExact * enough)) search_.converged = true;
  }
  if (!search_.converged && search_.sweeps < most_sweeps()) run(most_sweeps());
  for (int k = 0; k < point_count(); ++k) {
    const ProjectedGaussSeidel::Point& p = sweeps_.points[k];
    points_[k].impulse = p.normal_impulse * p.normal + p.friction_impulse;
  }
  for (const ProjectedGaussSeidel::Turn& t : sweeps_.turns) points_[t.point].turning = t.impulse;
  return first_change <= enough;
}

/// Search for the impulses. The first round starts from the contact-free motion and from the
/// impulses of the last step, later rounds from the motion with impulses: geometry and rotations
/// are updated then.
bool NonsmoothEngine::search(const State& state, const Trial& trial) {
  const StepContext& context = trial.context;
  points_.clear();
  held_back_.clear();
  search_ = {};
  search_.converged = true;
  if (!move(state, trial)) return false;
  const double scale = state.dt_last > 0.0 ? context.dt / state.dt_last : 1.0;
  for (int round = 0; round < kMaxRounds; ++round) {
    const int known = point_count();
    const int found = impulsive_->find_points(steps_, context, points_);
    for (int k = known; k < point_count(); ++k) {
      points_[k].impulse *= round == 0 ? scale : 0.0;
      points_[k].turning *= round == 0 ? scale : 0.0;
    }
    if (points_.empty()) return true;
    places_.clear();
    for (int k = 0; k < known; ++k) places_.push_back(points_[k].place);
    impulsive_->place_points(steps_, points_);
    set_up(context.dt, round == 0);
    const bool unchanged = sweep();
    if (!move(state, trial)) return false;
    if (round > 0 && found == 0 && (unchanged || !search_.converged)) break;
  }
  return true;
}

Iteration NonsmoothEngine::iterate(const State& state, Trial& trial, bool, double) {
  Iteration done;
  for (int again = 0; again < kMaxRounds; ++again) {
    if (!search(state, trial)) {
      done.reason = worst_body_ >= 0 ? "a body rotates too far in one step"
                                     : "the loads are too stiff for this step";
      done.worst_body = worst_body_;
      return done;
    }
    if (impulsive_->covers(steps_)) break;
    contacts_->cover(steps_, trial.context, nowhere_);
  }
  add_up(trial.context.dt);
  for (int round = 0; round < kMaxHeldBack && hold_back(); ++round) {
    places_.clear();
    for (const ImpulsePoint& p : points_) places_.push_back(p.place);
    set_up(trial.context.dt, false);
    sweep();
    if (!move(state, trial)) return done;
    add_up(trial.context.dt);
  }
  std::optional<std::pair<int, int>> overlap;
  if (search_.converged) overlap = impulsive_->passed(steps_);
  if (const int k = pressed_in(trial.context); k >= 0) overlap = {points_[k].a, points_[k].b};
  if (overlap) {
    const auto name = [&](int body) {
      return body == kGround ? std::string("the ground")
                             : format("body '{}'", system_->bodies()[body].name);
    };
    done.reason = format("{1} and {0} would overlap", name(overlap->first), name(overlap->second));
    done.reason +=
        search_.converged
            ? std::string(": take shorter steps")
            : format(", as {} sweeps did not converge: raise contacts.sweeps", search_.sweeps);
    return done;
  }
  for (int b = 0; b < bodies_; ++b) {
    const BodyStep& s = steps_[b];
    if (!s.u.allFinite() || !s.theta.allFinite()) return done;
    done.rotation = std::max(done.rotation, s.theta.norm());
    move_body(state, trial, system_->slot(b), s.u, s.theta);
  }
  done.solved = true;
  return done;
}

/// Holds points back in a step that would gain energy: friction adds energy where a point first
/// slips along the force that will hold it. Such points get zero mean slip over the step, so that
/// they dissipate. @eq{nonsmooth-energy}
bool NonsmoothEngine::hold_back() {
  double taken = 0.0, pressed = 0.0;
  for (int k = 0; k < point_count(); ++k) {
    taken += losses_[k].normal + losses_[k].friction;
    pressed += points_[k].impulse.norm();
  }
  if (taken >= -options_.tolerance * reference_ * pressed) return false;
  held_back_.resize(points_.size(), 0);
  bool any = false;
  for (std::size_t k = 0; k < points_.size(); ++k) {
    if (held_back_[k] || !(losses_[k].friction < 0.0)) continue;
    held_back_[k] = 1;
    any = true;
  }
  return any;
}

/// The deepest point at the end of the step whose penetration has increased considerably, or with
/// an unconverged search is considerable and has increased; otherwise, if the search is far from
/// convergence, that with the largest impulse; −1: none.
int NonsmoothEngine::pressed_in(const StepContext& context) {
  const int known = point_count();
  impulsive_->find_points(steps_, context, points_);
  for (int k = known; k < point_count(); ++k)  // found too late to act
    points_[k].impulse = points_[k].turning = Vec3::Zero();
  impulsive_->place_points(steps_, std::span(points_).subspan(static_cast<std::size_t>(known)));
  losses_.resize(points_.size());
  int worst = -1;
  double deepest = 0.0;
  for (int k = 0; k < point_count(); ++k) {
    const ImpulsePoint& p = points_[k];
    const double gap = impulsive_->gap_after(steps_, p), sinks = std::min(0.0, p.gap) - gap;
    const bool too_much =
        search_.converged ? sinks > kSinks * p.size : sinks > 0.0 && gap < -kPressedIn * p.size;
    if (!too_much || gap / p.size >= deepest) continue;
    deepest = gap / p.size;
    worst = k;
  }
  // Few points for which sweeps and Newton's method both failed: where surfaces are flush the gaps
  // do not show the error, as a corner is then near the side of the other body.
  if (worst >= 0 || search_.converged || !is_small() || search_.change < kFarOff) return worst;
  const auto weaker = [](const ImpulsePoint& p, const ImpulsePoint& q) {
    return p.impulse.squaredNorm() < q.impulse.squaredNorm();
  };
  return static_cast<int>(std::max_element(points_.begin(), points_.end(), weaker) -
                          points_.begin());
}

/// Energy losses of the impulses from the resulting motion: −½ p·y. @eq{nonsmooth-energy}
void NonsmoothEngine::add_up(double dt) {
  losses_.resize(points_.size());
  for (int k = 0; k < point_count(); ++k) {
    const ImpulsePoint& p = points_[k];
    const BodyStep &a = steps_[index(p.a)], &b = steps_[index(p.b)];
    const auto way = [&](const BodyStep& s) {
      return Vec3(s.u + s.theta.cross(p.place - s.r_n - 0.5 * s.u));
    };
    const Vec3 slip = way(a) - way(b);
    const double normal_impulse = p.normal.dot(p.impulse), along = p.normal.dot(slip);
    losses_[k].normal = -normal_impulse * along / dt;
    losses_[k].friction =
        -((p.impulse - normal_impulse * p.normal).dot(slip) + p.turning.dot(a.theta - b.theta)) /
        dt;
  }
}

void NonsmoothEngine::add_ground_wrench(double* force, double* moment) const {
  for (const ImpulsePoint& p : points_) {
    if (p.a != kGround && p.b != kGround) continue;
    const double sign = p.b == kGround ? 1.0 : -1.0;
    const Vec3 f = sign / dt_ * p.impulse;
    const Vec3 m = p.place.cross(f) + sign / dt_ * p.turning;
    for (int i = 0; i < 3; ++i) {
      force[i] += f[i];
      moment[i] += m[i];
    }
  }
}

Work NonsmoothEngine::commit(State& state, const Trial& trial) {
  return impulsive_->commit_impulses(state, steps_, trial.context, points_, losses_, search_);
}

}  // namespace polhode
