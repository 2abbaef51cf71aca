// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <limits>
#include <map>

#include <polhode/assembly/state_archive.hpp>
#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/base/names.hpp>
#include <polhode/body/point_motion.hpp>
#include <polhode/fe/solid_elements.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/build_system.hpp>
#include <polhode/model/method.hpp>
#include <polhode/model/separate_overlaps.hpp>
#include <polhode/model/simulation.hpp>
#include <polhode/solve/node_motion.hpp>

namespace polhode {

namespace {

double wall_clock() {
  using namespace std::chrono;
  return duration<double>(steady_clock::now().time_since_epoch()).count();
}

double cpu_clock() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Above this many bodies the start does not solve for multipliers that the method does not need.
constexpr int kSmallSystem = 2000;
/// How far assembling the start may move a body that was said to be in place, and one that was not.
constexpr double kMoveAsGiven = 1e-4, kMoveToAssemble = 0.5;
/// Two times closer than this part of the distance between outputs are the same.
constexpr double kSameTime = 1e-9;

}  // namespace

struct Simulation::Impl {
  Model model;
  SystemMap map;
  System system;
  Method method;
  std::unique_ptr<Stepper> stepper;
  std::unique_ptr<LoadStepper> statics;  ///< Of a static analysis; `stepper` keeps its ledger.
  ContactKeeper contacts;
  State state;
  StartReport start_report;
  RunSummary figures;  ///< Times, end and message; the rest is in the state.
  std::string narration, engine_name;
  double start_seconds = 0.0, output_seconds = 0.0;
  // What stands at t_n is solved for once per state.
  std::unique_ptr<InstantSolver> instant_solver;
  InstantSolution instant;
  State projected;  ///< The state with velocities on G v = 0: what is reported.
  std::int64_t instant_step = -1;
  std::map<int, LeastStretch> least_stretches;  ///< By group of elements, see watch_stretches().

  explicit Impl(Model m)
      : model(std::move(m)),
        system(build_system(model, &map)),
        contacts(map.contacts, map.contact) {
    method = choose_method(system, model.analysis);
    narration = method.narration;
    if (model.analysis.type == "statics") choose_statics();
    for (const SolidMap& solid : map.solids)
      for (const std::string& warning : solid.plan.warnings)
        narration += format("Warning: {}\n", warning);
    engine_name = statics ? "mumps" : method.engine->name();
    stepper = std::make_unique<Stepper>(system, std::move(method.engine), method.ga, method.control,
                                        *method.kernels);
  }

  void choose_statics() {
    for (const BodySpec& body : model.bodies)
      if (!body.velocity.isZero(0.0) || !body.angular_velocity.isZero(0.0))
        throw InputError(format("bodies.{}", body.name),
                         "has a velocity, but in statics and modes nothing moves",
                         "Leave velocity and angular_velocity out, or use type: dynamics");
    StaticOptions options;
    options.load_steps = model.analysis.load_steps.value_or(0);
    options.max_iterations = model.analysis.max_iterations.value_or(options.max_iterations);
    statics = std::make_unique<LoadStepper>(system, options);
    narration.clear();  // it was about steps in time
  }

  /// Time that the run ends at; in statics the full load.
  [[nodiscard]] double end() const { return statics ? 1.0 : model.analysis.duration; }

  StepReport advance(double t_limit) {
    if (!statics) {
      StepReport report = stepper->advance(state, t_limit);
      if (report.accepted) contacts.after_step(state);
      return report;
    }
    const double before = state.t;
    const std::size_t tried = statics->report().steps.size();
    const int iterations = statics->report().iterations;
    StepReport report;
    report.accepted = statics->advance(state, std::min(t_limit, 1.0));
    const StaticReport& r = statics->report();
    report.t = state.t;
    report.dt = state.t - before;
    report.rejected = static_cast<int>(r.steps.size() - tried) - (report.accepted ? 1 : 0);
    report.message = r.message;
    state.dt_last = report.dt;
    state.ledger.steps += report.accepted ? 1 : 0;
    state.ledger.rejected += report.rejected;
    state.ledger.iterations += r.iterations - iterations;
    return report;
  }

  void start_consistently() {
    const double t0 = wall_clock();
    state = system.initial_state();
    const bool small = system.body_count() <= kSmallSystem;
    const AnalysisSpec& a = model.analysis;
    StartOptions options;
    options.multipliers = small;
    options.smooth_multipliers =
        a.smooth_multipliers && small && a.step && method.control.order == 2;
    if (model.contacts.resolve_overlaps) move_apart();
    start_report = start(system, state, method.ga, a.step.value_or(0.0), options);
    refuse_bad_start();
    refuse_overlaps();
    if (map.contacts && a.step) state.dt_next = *a.step;  // stiffness follows it
    if (statics) statics->begin(state);
    stepper->begin(state);
    contacts.begin(state);
    state.ledger.constraint_max = 0.0;
    start_seconds = wall_clock() - t0;
  }

  void refuse_bad_start() const {
    const StartReport& r = start_report;
    if (!r.assembled) {
      std::string names;
      for (const std::string& n : r.unsatisfied) names += (names.empty() ? "" : ", ") + n;
      throw InputError("the start",
                       format("cannot be assembled: {} contradict one another{}",
                              names.empty() ? "the joints" : names,
                              format(" (largest residual {:.2g})", r.position_residual)),
                       "Check positions and axes of these joints; 'polhode check' lists residuals");
    }
    for (std::size_t i = 0; i < model.joints.size(); ++i) refuse_outside_limits(i);
    bool to_assemble = false;
    for (const JointSpec& j : model.joints) to_assemble = to_assemble || j.assembled_start;
    const double given = model.analysis.assembly_tolerance;
    const double allowed = given > 0.0 ? given : to_assemble ? kMoveToAssemble : kMoveAsGiven;
    if (r.largest_move > allowed)
      throw InputError("the start",
                       format("assembling moves body '{}' by {:.2g} (of the mechanism's size, or "
                              "radians), more than analysis.assembly_tolerance = {:.2g}",
                              r.moved_body, r.largest_move, allowed),
                       "Give the body's position closer to where its joints want it, or raise "
                       "assembly_tolerance");
  }

  /// Elements that are compressed more than their kind stands: the worst of each group is kept.
  void watch_stretches() {
    StepContext still;
    still.t_n = state.t;
    const Nodes& nodes = system.nodes();
    for (int g = 0; g < nodes.group_count(); ++g) {
      const auto* solid = dynamic_cast<const SolidElements*>(&nodes.group(g));
      if (!solid || solid->element().least_stretch == 0.0) continue;
      const LeastStretch now = solid->least_stretch(
          node_instant(state, still), state.element_history.data() + nodes.first_history(g));
      LeastStretch& least = least_stretches[g];
      if (now.value < least.value) least = now;
    }
  }

  /// What watch_stretches() has seen.
  [[nodiscard]] std::vector<std::string> warnings() const {
    std::vector<std::string> list;
    for (const auto& [g, least] : least_stretches) {
      const auto& solid = dynamic_cast<const SolidElements&>(system.nodes().group(g));
      const std::string text = solid.stretch_warning(least);
      if (!text.empty()) list.push_back(text);
    }
    return list;
  }

  /// A joint that starts beyond its stops, or in the half of a stop's band behind the end.
  void refuse_outside_limits(std::size_t index) const {
    const Joint& joint = joint_at(system, map.joint[index]);
    if (!joint.has_barrier()) return;
    const PairView view = system.instant(state, system.interactions()[map.joint[index]], nullptr);
    const JointCoordinates c = joint.coordinates(view.step());
    const std::vector<std::string> names = joint.coordinate_names();
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto& limits =
          names[k] == "z" ? joint.resistance()->data().slide : joint.resistance()->data().turn;
      const double play = limits ? 0.5 * limits->law.tolerance : 0.0;
      if (!limits || (c.value[k] >= limits->lower - play && c.value[k] <= limits->upper + play))
        continue;
      throw InputError(format("joints.{}", joint.name),
                       format("starts at {} = {:.6g}, outside its limits [{:g}, {:g}]", names[k],
                              c.value[k], limits->lower, limits->upper),
                       "Move the bodies, or widen the limits");
    }
  }

  void move_apart() {
    if (!map.contacts) return;
    const SeparationReport moved = separate_overlaps(system, *map.contacts, state);
    for (const auto& [body, distance] : moved.moves)
      narration += format("'{}' was moved by {:.3g} m, as it overlapped at the start.\n",
                          system.bodies()[static_cast<std::size_t>(body)].name, distance);
  }

  void refuse_overlaps() const {
    if (!map.contacts) return;
    const std::vector<std::string> list = overlaps_at(system, *map.contacts, state);
    if (list.empty()) return;
    throw InputError(
        "contacts", "shapes overlap at the start: " + name_list(list, 12),
        model.contacts.resolve_overlaps
            ? "They could not be moved apart: correct positions or sizes"
            : "Correct positions or sizes, exclude pairs that are meant to overlap, or "
              "set contacts.overlaps: resolve");
  }

  const InstantSolution& at_instant() {
    if (instant_step == state.ledger.steps) return instant;
    if (statics) {
      projected = state;
      instant.r_ddot.assign(system.body_count(), Vec3::Zero());
      instant.alpha.assign(system.body_count(), Vec3::Zero());
      instant.lambda = state.lambda;
      instant.node_force = statics->newton().node_residual();
      instant_step = state.ledger.steps;
      return instant;
    }
    if (!instant_solver) instant_solver = std::make_unique<InstantSolver>(system);
    projected = state;
    const VelocityReport v = instant_solver->project_velocities(projected);
    figures.velocity_constraint_residual_max =
        std::max(figures.velocity_constraint_residual_max, v.residual_before);
    instant = instant_solver->accelerations(projected, contacts.wrenches());
    instant_step = state.ledger.steps;
    return instant;
  }
};

Simulation::Simulation(Model model) : impl_(std::make_unique<Impl>(std::move(model))) {
  impl_->start_consistently();
}

Simulation::Simulation(Model model, State state) : impl_(std::make_unique<Impl>(std::move(model))) {
  if (state.blocks.size() != impl_->system.initial_state().blocks.size() ||
      state.node_x.size() != impl_->system.initial_state().node_x.size() ||
      state.lambda.size() != impl_->system.initial_state().lambda.size())
    throw InputError("restart", "the state belongs to another model",
                     "Restart with the model it was saved from");
  impl_->state = std::move(state);
  impl_->contacts.resume(impl_->state);
}

Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

const Model& Simulation::model() const { return impl_->model; }
const System& Simulation::system() const { return impl_->system; }
const State& Simulation::state() const { return impl_->state; }
const StartReport& Simulation::start_report() const { return impl_->start_report; }

StepReport Simulation::step(double t_limit) {
  const double wall = wall_clock(), cpu = cpu_clock();
  StepReport report = impl_->advance(t_limit);
  impl_->figures.wall_time_s += wall_clock() - wall;
  impl_->figures.cpu_time_s += cpu_clock() - cpu;
  return report;
}

RunSummary Simulation::run(const std::function<void(Simulation&)>& observe,
                           const std::function<void(Simulation&)>& on_step,
                           const std::atomic<bool>* stop) {
  Impl& s = *impl_;
  const double end = s.end();
  const std::optional<double> every = s.statics ? std::nullopt : s.model.output.every;
  const bool automatic = !s.model.analysis.step;
  const double wall = wall_clock(), cpu = cpu_clock();
  const auto look = [&] {
    const double t0 = wall_clock();
    s.at_instant();  // the velocity residual is part of the figures
    s.watch_stretches();
    if (observe) observe(*this);
    s.output_seconds += wall_clock() - t0;
  };
  const auto output_after = [&](double t) {
    return every ? (std::floor(t / *every + kSameTime) + 1.0) * *every : end;
  };
  if (s.state.ledger.steps == 0) look();
  s.figures.end = RunEnd::finished;
  double next = output_after(s.state.t);
  while (s.state.t < end * (1.0 - kSameTime)) {
    if (stop && stop->load()) {
      s.figures.end = RunEnd::interrupted;
      break;
    }
    const StepReport report = s.advance(automatic ? std::min(next, end) : end);
    if (!report.accepted) {
      s.figures.end = RunEnd::not_converged;
      s.figures.message = report.message;
      s.watch_stretches();
      break;
    }
    if (on_step) on_step(*this);
    const bool finished = s.state.t >= end * (1.0 - kSameTime);
    if (!every || finished || s.state.t >= next * (1.0 - kSameTime)) {
      look();
      next = output_after(s.state.t);
    }
  }
  s.figures.wall_time_s += wall_clock() - wall;
  s.figures.cpu_time_s += cpu_clock() - cpu;
  return summary();
}

RunSummary Simulation::summary() const {
  const Impl& s = *impl_;
  const Ledger& l = s.state.ledger;
  const auto relative = [](double drift, double scale) {
    return scale > 0.0 ? drift / scale : drift;
  };
  RunSummary r = s.figures;
  r.t = s.state.t;
  r.steps = l.steps;
  r.rejected_steps = l.rejected;
  r.newton_iterations = l.iterations;
  r.energy_drift = relative(l.energy_drift, l.energy_scale);
  r.linear_momentum_drift = relative(l.p_drift, l.p_scale);
  r.angular_momentum_drift = relative(l.l_drift, l.l_scale);
  r.constraint_residual_max = l.constraint_max;
  r.phases = {{"start", s.start_seconds}};
  for (const auto& phase : s.stepper->phases()) r.phases.push_back(phase);
  r.phases.emplace_back("output", s.output_seconds);
  r.result_hash = state_hash();
  r.solver = s.engine_name;
  r.instruction_set = s.method.kernels->name;
  r.version = POLHODE_VERSION;
  r.order = s.method.control.order;
  r.narration = s.narration;
  r.warnings = s.warnings();
  if (s.statics) {
    r.statics = s.statics->report();
    r.strain_energy = s.statics->strain_energy(s.state);
  }
  if (s.map.contacts) {
    const ContactLosses lost = s.contacts.losses();
    const Balance b = balance();
    r.contacts = RunSummary::Contacts{
        .shapes = static_cast<int>(s.map.contact.body.size()),
        .touching = s.contacts.touching(),
        .least_gap = s.contacts.least_gap(),
        .lost_in_impacts = lost.impacts,
        .lost_by_friction = lost.friction,
        .numerical = b.kinetic + b.potential - l.initial_energy - b.put_in + b.dissipated};
  }
  return r;
}

BodyMotion Simulation::body(int body) const {
  const int index = impl_->map.body[body];
  if (index != kGround) {
    impl_->at_instant();
    return impl_->system.motion(impl_->projected, index);
  }
  const BodySpec& fixed = impl_->model.bodies[body];
  BodyMotion m;
  m.r = fixed.position;
  m.q = fixed.orientation;
  return m;
}

Simulation::PointMotion Simulation::point(int body, const Vec3& Z) const {
  const BodyMotion m = this->body(body);
  const int index = impl_->map.body[body];
  const Pose pose{m.r, m.Lambda()};
  if (index == kGround) return {point_position(pose, Z), Vec3::Zero(), Vec3::Zero()};
  const InstantSolution& now = impl_->at_instant();
  const Velocities rates{m.v, m.omega()};
  return {point_position(pose, Z), point_velocity(pose, rates, Z),
          point_acceleration(pose, rates, {now.r_ddot[index], now.alpha[index]}, Z)};
}

JointReport Simulation::joint(int joint, bool joint_axes) const {
  const System& system = impl_->system;
  const int interaction = impl_->map.joint[joint];
  const InteractionRef& ref = system.interactions()[interaction];
  const InstantSolution& now = impl_->at_instant();
  const PairView view = system.instant(impl_->projected, ref, now.lambda.data());
  const PairStep step = view.step();
  const Joint& item = joint_at(system, interaction);
  const JointCoordinates free = item.coordinates(step);
  const Reaction reaction = item.reaction(step, joint_axes);
  JointReport report;
  report.coordinates.assign(free.value.begin(), free.value.begin() + free.count);
  report.rates.assign(free.rate.begin(), free.rate.begin() + free.count);
  report.force = reaction.force;
  report.moment = reaction.moment;
  report.residual =
      item.rows() > 0 ? item.residual(step).head(item.rows()).lpNorm<Eigen::Infinity>() : 0.0;
  if (!item.resistance()) return report;
  const ResistanceReport resistance = item.resistance_report(step);
  report.friction.assign(resistance.friction.begin(),
                         resistance.friction.begin() + resistance.count);
  report.slips = resistance.slips;
  if (item.resistance()->data().slide) report.stops.push_back(resistance.slide);
  if (item.resistance()->data().turn) report.stops.push_back(resistance.turn);
  return report;
}

std::vector<double> Simulation::load(int load) const {
  impl_->at_instant();
  const System& system = impl_->system;
  const InteractionRef& ref = system.interactions()[impl_->map.load[load]];
  const PairView view = system.instant(impl_->projected, ref, nullptr);
  return load_kind(model().loads[load].type).report(system.group(ref.group), ref.item, view.step());
}

BeamReport Simulation::beam(int beam) const {
  const auto k = static_cast<std::size_t>(beam);
  return beam_report(*this, impl_->model.beams.at(k), impl_->map.beam.at(k));
}

CableReport Simulation::cable(int cable) const {
  const auto k = static_cast<std::size_t>(cable);
  return cable_report(*this, impl_->model.cables.at(k), impl_->map.cable.at(k));
}

Balance Simulation::balance() const { return impl_->stepper->balance(impl_->state); }

const std::vector<SolidMap>& Simulation::solids() const { return impl_->map.solids; }

namespace {

Vec3 at_node(const std::vector<double>& field, int node) {
  return Eigen::Map<const Vec3>(field.data() + 3 * node);
}

}  // namespace

/// Velocity of a node: a bonded one has its body's, without what Newmark's adds of order Δt².
Vec3 Simulation::node_velocity(int node) const {
  const int body = impl_->system.nodes()[node].body;
  if (body == kFreeNode) return at_node(impl_->state.node_v, node);
  if (body == kGround) return Vec3::Zero();
  impl_->at_instant();
  const BodyMotion m = impl_->system.motion(impl_->projected, body);
  return m.v + m.omega().cross(at_node(impl_->state.node_x, node) - m.r);
}

std::array<Vec3, 3> Simulation::solid_point(int solid, const SolidPoint& point) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  std::array<Vec3, 3> sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    const int node = map.first_node + point.nodes[k];
    const Vec3 x = at_node(impl_->state.node_x, node);
    sum[0] += point.weights[k] * x;
    sum[1] += point.weights[k] * (x - map.plan.start[static_cast<std::size_t>(point.nodes[k])]);
    sum[2] += point.weights[k] * node_velocity(node);
  }
  return sum;
}

SolidReport Simulation::solid(int solid) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  const Nodes& nodes = impl_->system.nodes();
  const State& state = impl_->state;
  SolidReport report;
  for (int k = 0; k < map.node_count(); ++k) {
    const Vec3 x = at_node(state.node_x, map.first_node + k);
    report.position.push_back(x);
    report.displacement.emplace_back(x - map.plan.start[static_cast<std::size_t>(k)]);
    report.velocity.push_back(node_velocity(map.first_node + k));
  }
  StepContext still;
  still.t_n = state.t;
  const NodeStep instant = node_instant(state, still);
  for (const int g : map.groups) {
    const ElementGroup& group = nodes.group(g);
    std::vector<ElementSample> samples(static_cast<std::size_t>(group.size()));
    group.sample(instant, state.element_history.data() + nodes.first_history(g), samples);
    report.elements.insert(report.elements.end(), samples.begin(), samples.end());
  }
  return report;
}

std::vector<std::string> Simulation::interfaces(int solid) const {
  const Model& model = impl_->model;
  const SolidSpec& spec = model.solids.at(static_cast<std::size_t>(solid));
  std::vector<std::string> names;
  for (const BondSpec& bond : spec.bonded) names.push_back(model.body_name(bond.body));
  for (const PrescribedSpec& prescribed : spec.prescribed) names.push_back(prescribed.name);
  return names;
}

InterfaceReport Simulation::interface_reaction(int solid, int k) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  const auto bonds = static_cast<int>(map.plan.bonded.size());
  const std::vector<int>& nodes = k < bonds
                                      ? map.plan.bonded.at(static_cast<std::size_t>(k))
                                      : map.plan.prescribed.at(static_cast<std::size_t>(k - bonds));
  const Nodes& all = impl_->system.nodes();
  const InstantSolution& now = impl_->at_instant();
  InterfaceReport report;
  if (now.node_force.empty()) return report;
  for (const int k_node : nodes) {
    const int node = map.first_node + k_node;
    Vec3 force = at_node(now.node_force, node);
    // Free components of a prescribed node are in balance but for round-off.
    for (int c = 0; c < 3; ++c)
      if (!all.bonded(node) && all.unknown(node, c) >= 0) force[c] = 0.0;
    Vec3 arm = at_node(impl_->state.node_x, node);
    if (all[node].body >= 0) arm -= impl_->system.motion(impl_->state, all[node].body).r;
    report.force += force;
    report.moment += arm.cross(force);
  }
  return report;
}

const contact::ContactSet* Simulation::contact_set() const { return impl_->map.contacts.get(); }

const ContactMap& Simulation::contact_map() const { return impl_->map.contact; }

ContactReport Simulation::contact(int pair) const { return impl_->contacts.report(pair); }

int Simulation::contact_pair(int body_a, int body_b) const {
  const std::vector<ContactMap::Pair>& pairs = contact_map().pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (std::minmax(pairs[k].a, pairs[k].b) == std::minmax(body_a, body_b))
      return static_cast<int>(k);
  throw InputError("contacts",
                   format("results of '{}' and '{}' are not kept", model().body_name(body_a),
                          model().body_name(body_b)),
                   "Name the pair in contacts.pairs or a probe, or set contacts.record: true");
}

ContactLosses Simulation::contact_losses() const { return impl_->contacts.losses(); }

const std::vector<contact::TouchingPoint>& Simulation::contact_points() const {
  return impl_->contacts.points();
}

const std::vector<SensorEvent>& Simulation::sensor_events() const {
  return impl_->contacts.events();
}

std::string Simulation::state_hash() const {
  return polhode::state_hash(impl_->system, impl_->state);
}

}  // namespace polhode
