// SPDX-License-Identifier: Apache-2.0
// Members of a Simulation; for simulation.cpp and simulation_reports.cpp only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/compile/build_system.hpp>
#include <polhode/core/clock.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/simulation/controllers.hpp>
#include <polhode/simulation/dense_output.hpp>
#include <polhode/simulation/event_watch.hpp>
#include <polhode/simulation/held_values.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/simulation/probe.hpp>
#include <polhode/simulation/rows_at_instants.hpp>
#include <polhode/simulation/seen_bodies.hpp>
#include <polhode/simulation/separate_overlaps.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/surface_contact_report.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/stepping/extrapolated_velocities.hpp>
#include <polhode/stepping/instant_tree.hpp>
#include <polhode/stepping/step_lengths.hpp>

namespace polhode {

/// Number of bodies above which multipliers at the start are not computed unless the method needs
/// them.
inline constexpr int kSmallSystem = 2000;
/// Largest number of breaks of a prescribed motion that are checked before a run.
inline constexpr int kMaxBreaks = 10000;
/// Largest displacements of a body by the initial assembly: with a given position, and without.
inline constexpr double kMoveAsGiven = 1e-4, kMoveToAssemble = 0.5;

/// Largest number of iterations of a load step with unilateral rows, whose increments are limited
/// so that no two bodies pass each other.
inline constexpr int kIterationsWithRows = 200;

/// Strain below which it is rounding: the solid counts as unstressed.
inline constexpr double kRoundedStrain = 1e-10;

struct Simulation::Impl {
  Model model;
  ControllerOutputs outputs;
  std::shared_ptr<HeldNumbers> held;  ///< Set by a program between steps; null if there are none.
  std::vector<double> reported_held;  ///< Those that the instantaneous results hold for.
  SystemMap map;
  System system;
  Method method;
  std::unique_ptr<Stepper> stepper;
  std::unique_ptr<LoadStepper> statics;  ///< Of a static analysis; `stepper` keeps its ledger.
  ContactStatistics contacts;
  std::unique_ptr<EventWatch> events;        ///< Null if there are none.
  std::unique_ptr<Controllers> controllers;  ///< Likewise.
  std::unique_ptr<DenseOutput> dense;        ///< Null where frames are ends of steps.
  bool between_steps = false;                ///< `state` is one of `dense`.
  std::vector<int> due_at_start;             ///< Events found nearer than a step is short.
  State state;
  StartReport start_report;
  RunSummary figures;  ///< Times, end and message; other figures are in the state.
  std::string narration, engine_name;
  std::string
      pole;  ///< Names a function of time without bounds in the last run(), if there is one.
  double start_seconds = 0.0, output_seconds = 0.0;
  double advance_seconds = 0.0;  ///< In advance(): phases of the stepper, and all between them.
  double last_work = 1.0;        ///< Wall time of the last single step [s].
  // Instantaneous results, computed once per state.
  std::unique_ptr<InstantTree> instant_tree;  ///< Of systems that solve_along_tree() takes.
  std::unique_ptr<InstantSolver> instant_solver;
  RowsAtInstants rows_at_instants;
  InstantSolution instant;
  State projected;  ///< The state with velocities on G v = 0, which is reported.
  std::int64_t instant_step = -1;
  SeenBodies seen_bodies;  ///< Of `projected`.
  /// Largest |G v| at output times, its time [s], and the largest magnitudes of its terms.
  double velocity_residual = 0.0, velocity_time = 0.0, velocity_scale = 0.0;
  /// Smallest of surfaces of solids after any step [m].
  double surface_gap = std::numeric_limits<double>::quiet_NaN();
  /// A solid's report at the instant, and the largest error of its stress.
  struct SolidWatch {
    solids::NodalRecovery recovery;
    double least_energy;  ///< Rounding of the energy [J].
    SolidReport report = {};
    std::int64_t step = -1;
    double largest_energy = 0.0, error_energy = 0.0, largest_error = 0.0, t_largest = 0.0;

    void see(const solids::NodalFields& nodal, double t) {
      largest_energy = std::max(largest_energy, nodal.energy);
      error_energy = nodal.error_energy;
      if (error_energy <= largest_error) return;
      largest_error = error_energy;
      t_largest = t;
    }
    /// √ of the ratio to the largest energy, which increases during the run.
    [[nodiscard]] double part(double energy) const {
      return largest_energy > least_energy ? std::sqrt(energy / largest_energy) : 0.0;
    }
  };
  std::map<int, ProbeTarget> probes;     ///< Those queried by name.
  std::deque<SolidWatch> solid_watches;  ///< Created at first use; references to them stay valid.
  std::map<const solids::SolidElements*, solids::LeastStretch>
      least_stretches;  ///< See watch_stretches().

  explicit Impl(Model m)
      : model(std::move(m)),
        outputs(own_outputs(model)),
        held(own_held_numbers(model)),
        system(build_system(model, &map)),
        contacts(map.contacts, map.contact) {
    method = choose_method(system, model);
    narration = method.narration;
    if (model.analysis.type == "statics") choose_statics();
    for (const SolidMap& solid : map.solids)
      for (const std::string& warning : solid.plan.warnings)
        narration += format("Warning: {}\n", warning);
    engine_name = statics ? "mumps" : method.engine->name();
    stepper = std::make_unique<Stepper>(system, std::move(method.engine), method.ga, method.control,
                                        *method.kernels);
  }

  /// Resolves the channels of events and controllers.
  void watch(const Simulation& simulation) {
    if (!map.events.empty()) events = std::make_unique<EventWatch>(simulation, map);
    if (!model.controllers.empty())
      controllers = std::make_unique<Controllers>(simulation, map, outputs, method.control.order);
  }

  /// Whether states between the ends of steps can be recorded.
  bool has_dense_output() {
    if (!model.output.between_steps || statics || events || controllers ||
        !DenseOutput::suits(system, method.control))
      return false;
    if (!dense) dense = std::make_unique<DenseOutput>(system, choose_method(system, model));
    return true;
  }

  void choose_statics() {
    for (const BodySpec& body : model.bodies)
      if (!body.velocity.isZero(0.0) || !body.angular_velocity.isZero(0.0))
        throw InputError(format("bodies.{}", body.name),
                         "has a velocity, which statics and modes do not support",
                         "Leave velocity and angular_velocity out, or use type: dynamics");
    if (map.contacts && !model.contacts.rigid())
      throw InputError("contacts",
                       "bodies may touch bodies, which statics and modes support with the law "
                       "rigid only",
                       "Give contacts.default law: rigid, exclude these pairs (surfaces of solids "
                       "and cables may touch), or use type: dynamics");
    StaticOptions options;
    options.load_steps = model.analysis.load_steps.value_or(0);
    options.history = model.analysis.history.value_or(0.0);
    options.max_iterations = model.analysis.max_iterations.value_or(
        UnilateralRows::of(system) ? kIterationsWithRows : options.max_iterations);
    statics = std::make_unique<LoadStepper>(system, options);
    narration.clear();  // it describes steps in time
  }

  /// End time of the run; in statics the full load.
  [[nodiscard]] double end() const { return statics ? statics->end() : model.analysis.duration; }

  /// Takes a step in time, or a load step; settle_step() follows once it is final.
  StepReport take(double t_limit) {
    forget_reports();
    StepReport report = statics ? take_load_step(t_limit) : stepper->advance(state, t_limit);
    if (report.accepted && report.dt != 0.0) contacts.see(state);
    return report;
  }
  /// Clears the reports of the state that the simulation leaves.
  void forget_reports() {
    instant_step = -1;
    for (SolidWatch& watch : solid_watches) watch.step = -1;
  }
  void explain(StepReport& report);
  void settle_step() {
    contacts.after_step(state);
    watch_surfaces();
  }
  /// A state, and the reports of the step that ended there.
  struct Reached {
    State state;
    ContactsSeen contacts;
  };
  [[nodiscard]] Reached reached() const { return {state, contacts.seen()}; }
  /// Continues from another state than the last step ended at.
  void go_to(const Reached& other) {
    state = other.state;
    contacts.go_to(other.contacts);
    stepper->leave();
    forget_reports();
  }
  /// Shortest length of a step, see step_control::shortest_step().
  [[nodiscard]] double shortest_step(const State& before) const {
    const StepControl& control = method.control;
    return step_control::shortest_step(before.t, control.step
                                                     ? std::min(*control.step, control.horizon)
                                                     : std::max(before.dt_next, state.dt_next));
  }
  /// Returns to the time of the first event in the step just taken, if there is one.
  /// @param before  Start of the step. @param start  EventWatch::margins() there.
  /// @returns events nearer to the start than any step is short, which are at the start; the state
  /// is then that of a trial.
  std::vector<int> find_event(const Simulation& simulation, const Reached& before,
                              const std::vector<double>& start, double limit, StepReport& report);
  /// Evaluates the controllers; the report says if one cannot act.
  void let_act(const Simulation& simulation, StepReport& report) {
    const Controllers::Acted acted = controllers->act(simulation, state);
    if (acted.any) instant_step = -1;
    if (acted.jumps) stepper->forces_jump(state);
    if (acted.blind.empty()) return;
    report.accepted = false;
    report.message = acted.blind;
  }
  void begin_control(const Simulation& simulation);
  /// Clears instantaneous results: forces have changed, though positions and time have not.
  void forget_instant() {
    instant_solver.reset();
    instant_step = -1;
  }
  [[nodiscard]] std::string cannot_touch(const EventSpec& event,
                                         const std::vector<std::string>& overlaps) const {
    return format(
        "event '{}' at t = {:.6g} s: shapes whose contact would begin overlap: {}. Choose an "
        "instant at which they are apart or just touch",
        event.name, state.t, name_list(overlaps, 12));
  }
  [[nodiscard]] std::string cannot_switch(const EventSpec& event, const SwitchReport& done) const {
    if (done.worst < 0)
      return format(
          "event '{}' at t = {:.6g} s: its impulses cannot be computed. Look for contradicting "
          "joints",
          event.name, state.t);
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(done.worst)];
    return format(
        "event '{}' at t = {:.6g} s: {} '{}' cannot be switched on, as it is {:.3g} m (or rad) "
        "from being assembled. Choose an instant at which it is assembled, or use a fixed joint, "
        "which keeps the relative position",
        event.name, state.t, system.group(ref.group).kind(), system.name(ref), done.gap);
  }

  /// Must be called before each step. Past accelerations do not predict those by new numbers; steps
  /// of a given length at ρ∞ = 1 do not depend on past ones.
  void notice_held() {
    if (!held || held->now == held->used) return;
    held->used = held->now;
    if (!statics && (model.analysis.rho_inf < 1.0 || !model.analysis.step))
      stepper->forces_jump(state);
  }

  /// Whether an event has ended the run.
  [[nodiscard]] bool stopped() const { return events && events->stopped(state) >= 0; }

  StepReport advance(double t_limit) {
    StepReport report = take(t_limit);
    if (report.accepted && report.dt != 0.0) settle_step();
    return report;
  }
  StepReport take_load_step(double t_limit) {
    const double before = state.t;
    const std::size_t tried = statics->report().steps.size();
    const int iterations = statics->report().iterations;
    StepReport report;
    report.accepted = statics->advance(state, std::min(t_limit, end()));
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
    options.load_factor = statics ? 0.0 : 1.0;
    options.smooth_multipliers =
        a.smooth_multipliers && small && a.step && method.control.order == 2;
    if (model.contacts.resolve_overlaps) move_apart();
    start_report = start(system, state, method.ga, a.step.value_or(0.0), options);
    refuse_bad_start();
    refuse_jumps();
    refuse_overlaps();
    if (map.contacts && a.step) state.dt_next = *a.step;  // the stiffness depends on it
    if (statics) statics->begin(state);
    stepper->begin(state);
    contacts.begin(state);
    watch_surfaces();
    state.ledger.constraint_max = 0.0;
    start_seconds = wall_clock() - t0;
  }

  /// Rejects jumps of prescribed positions and of speeds of rotors, which no force can produce.
  void refuse_jumps() const {
    if (statics) return;
    for (const SolidSpec& solid : model.solids)
      for (const PrescribedSpec& p : solid.prescribed)
        for (std::size_t c = 0; c < 3; ++c)
          if (p.displacement[c])
            refuse_jumps(format("solids.{}.prescribed.{}.{}", solid.name, p.name, "xyz"[c]),
                         *p.displacement[c], "m");
    for (const LoadSpec& load : model.loads) {
      const std::string where = format("loads.{}.{}", load.name, load.drive);
      if (load.type.ends_with("motor") && (load.drive == "angle" || load.drive == "displacement"))
        refuse_jumps(where, *load.value, load.drive == "angle" ? "rad" : "m");
      if (load.type == "rotor" && load.drive == "speed") refuse_jumps(where, *load.value, "rad/s");
    }
  }
  void refuse_jumps(const std::string& where, const TimeFunction& d, const char* unit) const {
    TimeBreak at;
    for (int k = 0; k < kMaxBreaks; ++k) {
      at = d.next_break(k == 0 ? state.t : at.t, std::min(end(), kEndlessHorizon));
      if (!at.exists()) return;
      if (at.derivative > 0) continue;
      const TimeRates before = d.rates(at.t, TimeSide::kBefore),
                      after = d.rates(at.t, TimeSide::kAfter);
      const double jump =
          jump_at(at.t, before.value, after.value, std::abs(before.rate) + std::abs(after.rate));
      if (jump == 0.0) continue;
      throw InputError(where,
                       format("jumps by {:.6g} {} at t = {:.6g} s, which no finite force can do",
                              jump, unit, at.t),
                       "Give a ramp, such as a table with interpolation: linear");
    }
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
                       "Check positions and axes of these joints");
    }
    for (std::size_t i = 0; i < model.joints.size(); ++i) refuse_outside_limits(i);
    bool to_assemble = false;
    for (const JointSpec& j : model.joints) to_assemble = to_assemble || j.assembled_start;
    for (const LoadSpec& load : model.loads)
      to_assemble = to_assemble || load.parameters.contains("offset");
    const double given = model.analysis.assembly_tolerance;
    const double allowed = given > 0.0 ? given : to_assemble ? kMoveToAssemble : kMoveAsGiven;
    if (r.largest_move > allowed)
      throw InputError("the start",
                       format("assembling moves body '{}' by {:.2g} (of the mechanism's size, or "
                              "radians), more than analysis.assembly_tolerance = {:.2g}",
                              r.moved_body, r.largest_move, allowed),
                       "Give the body a position closer to the assembled one, in a robot's file by "
                       "import.start, "
                       "or raise assembly_tolerance");
  }

  /// Records elements compressed beyond the limit of their kind: the worst of each group.
  void watch_stretches() {
    StepContext still;
    still.t_n = state.t;
    const Nodes& nodes = system.nodes();
    for (const SolidMap& solid : map.solids)
      for (std::size_t b = 0; b < solid.groups.size(); ++b) {
        const solids::SolidElements& elements = *solid.elements[b];
        if (elements.element().least_stretch == 0.0) continue;
        const solids::LeastStretch now = elements.least_stretch(
            node_instant(system, state, still),
            state.element_history.data() + nodes.first_history(solid.groups[b]));
        solids::LeastStretch& least = least_stretches[&elements];
        if (now.value < least.value) least = now;
      }
  }

  SolidWatch& solid_watch(int solid) {
    while (solid_watches.size() <= static_cast<std::size_t>(solid)) {
      const SolidMap& next = map.solids[solid_watches.size()];
      double stiffness = 0.0;
      std::vector<solids::LinearModuli> moduli;
      for (const solids::SolidElements* elements : next.elements) {
        moduli.push_back(elements->material().linear());
        stiffness += moduli.back().shear * elements->volume();
      }
      solid_watches.push_back(
          {solids::NodalRecovery(next.plan.mesh, next.plan.materials, std::move(moduli)),
           stiffness * kRoundedStrain * kRoundedStrain});
    }
    return solid_watches[static_cast<std::size_t>(solid)];
  }

  /// Conspicuous findings of steps and of watch_stretches().
  [[nodiscard]] std::vector<std::string> warnings() const;
  /// Warnings about unstable directions at the end that are those of nearly incompressible meshes.
  [[nodiscard]] std::vector<std::string> mesh_instabilities(const StaticReport& report) const;
  /// Body or solid with the largest error of a step.
  [[nodiscard]] std::string whose_error() const;
  /// Adds warnings of steps that do not resolve the motion. The figures are those of the run so
  /// far.
  void warn_of_errors(std::vector<std::string>& list) const;
  /// Rounding of velocities, which are increments of positions over the last step [m/s]: relative
  /// rounding of a sum of few terms, times the largest distance from the origin.
  /// @eq{velocity-noise}
  [[nodiscard]] double rounding_of_velocities() const;

  /// Rejects a joint that starts beyond its stops by more than their band, or their accuracy.
  void refuse_outside_limits(std::size_t index) const {
    const Joint& joint = joint_at(system, map.joint[index]);
    if (!joint.has_barrier() && joint.unilateral() == 0) return;
    const PairView view = system.instant(state, system.interactions()[map.joint[index]], nullptr);
    const JointCoordinates c = joint.coordinates(view.step());
    const std::vector<std::string> names = joint.coordinate_names();
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto& limits =
          names[k][0] != 'r' ? joint.resistance()->data().slide : joint.resistance()->data().turn;
      const double play = !limits ? 0.0
                          : !limits->by_rows
                              ? limits->law.tolerance
                              : kOverlapGaps * system.touching_gap() / limits->radius;
      if (!limits || (c.value[k] >= limits->lower - play && c.value[k] <= limits->upper + play))
        continue;
      throw InputError(format("joints.{}", joint.name),
                       format("starts at {} = {:.6g}, outside its limits [{:g}, {:g}]", names[k],
                              c.value[k], limits->lower, limits->upper),
                       "Move the bodies, or widen the limits");
    }
  }

  void move_apart() {
    for (const auto& [name, distance] : separate_overlaps(model, system, map, state))
      narration +=
          format("'{}' was moved by {:.3g} m, as it overlapped at the start.\n", name, distance);
  }

  void watch_surfaces() {
    surface_gap = std::fmin(surface_gap, surface_figures(system, state, map.contact).least_gap);
  }

  void refuse_overlaps() const {
    std::vector<std::string> surfaces;
    for (const SideOverlap& overlap : surface_overlaps(model, system, map, state))
      surfaces.push_back(overlap_text(model, overlap));
    if (!surfaces.empty())
      throw InputError(
          "contacts", "surfaces overlap or touch at the start: " + name_list(surfaces, 12),
          model.contacts.resolve_overlaps
              ? "They could not be moved apart: correct positions or sizes. Fixed bodies, cables "
                "and crossing sharp edges are not moved"
              : "Correct positions or sizes, exclude intended overlaps, or set contacts.overlaps: "
                "resolve. Between two solids leave a gap of at least half the gap_tolerance");
    if (!map.contacts) return;
    const std::vector<std::string> list = overlaps_at(system, *map.contacts, state);
    if (list.empty()) return;
    throw InputError("contacts", "shapes overlap at the start: " + name_list(list, 12),
                     model.contacts.resolve_overlaps
                         ? "They could not be moved apart: correct positions or sizes"
                         : "Correct positions or sizes, exclude intended overlaps, or set "
                           "contacts.overlaps: resolve");
  }

  /// An interaction at the present instant.
  PairStep seen(const InteractionRef& ref) {
    const InstantSolution& now = at_instant();
    return seen_bodies.step(system, projected, ref, now.lambda);
  }

  /// Velocities on G v = 0, accelerations and multipliers at the present instant, computed when
  /// they are first asked for.
  const InstantSolution& at_instant() {
    if (held && held->now != reported_held) {
      reported_held = held->now;
      instant_step = -1;
    }
    if (instant_step != state.ledger.steps) compute_instant();
    return instant;
  }
  void compute_instant();
  [[nodiscard]] std::vector<Vec6> contact_wrenches();
  InstantSolver& solver_at_instant();
  bool solve_along_tree(VelocityReport& velocities);
};

}  // namespace polhode
