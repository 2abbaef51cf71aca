// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/model/model.hpp>
#include <polhode/simulation/beam_report.hpp>
#include <polhode/simulation/contact_report.hpp>
#include <polhode/simulation/solid_report.hpp>
#include <polhode/statics/static_report.hpp>
#include <polhode/stepping/balance.hpp>
#include <polhode/stepping/start_report.hpp>
#include <polhode/stepping/step_report.hpp>

namespace polhode {

// Code that needs the internals includes <polhode/simulation/simulation_details.hpp>.
class System;
struct State;
struct SolidMap;
struct SolidPoint;
struct ContactMap;
struct ProbeTarget;
namespace contact {
class ContactSet;
struct TouchingPoint;
}  // namespace contact
namespace surface_contact {
struct SurfacePointReport;
}

/// Reasons for the end of a run.
enum class RunEnd { finished, not_converged, interrupted, limit };

/// Joint coordinates and forces at the state of a simulation.
struct JointReport {
  std::vector<double>
      coordinates;             ///< Free coordinates, user's order a→b, turns counted [rad or m].
  std::vector<double> rates;   ///< Their rates.
  Vec3 force = Vec3::Zero();   ///< Of a on b, world axes [N].
  Vec3 moment = Vec3::Zero();  ///< At the joint's point on b [N m].
  double residual = 0.0;       ///< Largest |g| of its rows [m or -].
  /// Of a joint with friction or limits: friction on b by free coordinate [N or N m], whether it
  /// slipped in the last step, force of the stops by limited coordinate [N or N m].
  std::vector<double> friction, stops;
  bool slips = false;
  /// Drive of a joint whose frame moves as prescribed: power [W] and work since the start [J].
  std::vector<double> power, work;
  /// Impulses since the start of the whole wrench of a on b about the world's origin, with
  /// friction, stops and velocity jumps [N s, N m s]; in models whose velocities may jump
  /// (model/velocity_jumps.hpp), else none.
  std::vector<Vec3> impulses;
};

/// Final figures of a run; `run --json` prints them under these names.
struct RunSummary {
  RunEnd end = RunEnd::finished;
  std::string message;  ///< For an unfinished run: what happened and what to try.
  double t = 0.0;
  std::int64_t steps = 0, rejected_steps = 0, newton_iterations = 0;
  double energy_drift = 0.0, linear_momentum_drift = 0.0, angular_momentum_drift = 0.0;
  double constraint_residual_max = 0.0, velocity_constraint_residual_max = 0.0;
  /// Estimated errors of the steps, lengths over the mechanism's size, angles in radians.
  struct Errors {
    double largest = 0.0, sum = 0.0;  ///< Of a step, and of all steps that have an estimate.
    double time = 0.0;                ///< End of the step with the largest [s].
    std::string whose;                ///< "body 'pole'"; empty if not known.
    std::int64_t steps = 0;           ///< Steps with an estimate.
  };
  std::optional<Errors> errors;  ///< None if no step has an estimate.
  double wall_time_s = 0.0, cpu_time_s = 0.0;
  std::vector<std::pair<std::string, double>> phases;  ///< Name, seconds.
  std::string result_hash, solver, instruction_set, version;
  int order = 2;                        ///< The highest one if it varies.
  std::string scheme = "order 2";       ///< In words: "orders 4 to 12 by extrapolation".
  std::optional<StaticReport> statics;  ///< Of a static analysis; t is the load factor then.
  double strain_energy = 0.0;           ///< Of a static analysis: in springs, beams and solids [J].
  std::string narration;                ///< Choices and reasons, a few lines.
  std::vector<std::string> warnings;    ///< Conspicuous findings at output times.
  /// Reasons not to trust the run, a sentence each: balances that do not close, constraints that do
  /// not hold. They are among the warnings too.
  std::vector<std::string> distrust;
  [[nodiscard]] bool trusted() const { return distrust.empty(); }
  /// An event of the model, since the start.
  struct Event {
    std::string name;
    std::int64_t count = 0;  ///< Number of occurrences.
    double time = 0.0;       ///< Of the last occurrence [s].
    double lost = 0.0;       ///< Kinetic energy lost then, by interactions switched on [J].
    double impulse = 0.0;    ///< Largest of a row then [N s or N m s].
  };
  std::vector<Event> events;
  /// Figures of models with contact.
  struct Contacts {
    int shapes = 0;    ///< Of bodies that may be in contact with bodies.
    int surfaces = 0;  ///< Of solids, each with every shape it may be in contact with.
    int touching = 0;  ///< Pairs of shapes or surfaces in contact at present.
    /// After any step since the start or restart [m]; NaN: no shapes were near.
    double least_gap = 0.0;
    double lost_in_impacts = 0.0, lost_by_friction = 0.0;  ///< Since the start [J].
    /// Change of the energy beyond loads and losses [J]; negative: lost.
    double numerical = 0.0;
    /// Of the non-smooth law: mean number of sweeps over all points per step since the start, and
    /// number of steps that ended above sweep_tolerance.
    std::optional<std::pair<double, std::int64_t>> sweeps;
  };
  std::optional<Contacts> contacts;
  /// Quality of a solid's stress on its mesh, at output times since the start or restart: √(error
  /// energy / largest energy so far) of NodalFields [-].
  struct SolidStress {
    std::string solid;
    double error = 0.0;      ///< At present.
    double error_max = 0.0;  ///< Largest.
    double t_max = 0.0;      ///< Its time [s], or load factor.
  };
  std::vector<SolidStress> solids;
};

/// A compiled model with its state and method, for stepping, running and reports.
class Simulation {
 public:
  /// Builds the system, assembles and projects the initial state, chooses solver and order.
  /// @throws InputError if the model cannot be built or its start not assembled.
  explicit Simulation(Model model);
  /// Continues from a saved state: equal bit for bit to the uninterrupted run.
  Simulation(Model model, State state);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const System& system() const;
  [[nodiscard]] const State& state() const;
  [[nodiscard]] double time() const;
  [[nodiscard]] const StartReport& start_report() const;

  /// Takes one accepted step, not beyond t_limit. In statics time is the load factor, and a step
  /// leads to the next equilibrium. @throws InputError unless t_limit is after time().
  StepReport step(double t_limit);
  /// Steps to the model's duration, or to the full load; calls observe(*this) at the start and
  /// after every step whose end is an output time (model.output.every), and then on_step after
  /// every step. Stops early, after the current step, when *stop becomes true.
  RunSummary run(const std::function<void(Simulation&)>& observe = {},
                 const std::function<void(Simulation&)>& on_step = {},
                 const std::atomic<bool>* stop = nullptr);
  /// Figures so far.
  [[nodiscard]] RunSummary summary() const;

  // Reports at the present state; bodies and joints by index in the Model. Motions of model bodies
  // are of their centre of mass; fixed bodies are at rest. Velocities are projected onto the
  // constraints: those of the state have a part normal to them, of order Δt².
  [[nodiscard]] BodyMotion body(int body) const;
  /// Motion of a body by name; other reports are available by name too. @throws InputError if the
  /// model has none of that name; the message lists the nearest ones.
  [[nodiscard]] BodyMotion body(std::string_view name) const;
  /// Position, velocity and acceleration of a point of a body, Z from the centre of mass, body
  /// axes.
  struct PointMotion {
    Vec3 position, velocity, acceleration;
  };
  [[nodiscard]] PointMotion point(int body, const Vec3& Z) const;
  [[nodiscard]] PointMotion point(std::string_view body, const Vec3& Z) const;
  /// World components [rad/s²].
  [[nodiscard]] Vec3 angular_acceleration(int body) const;
  /// @param joint_axes  Force and moment along the joint's axes instead of the world's.
  [[nodiscard]] JointReport joint(int joint, bool joint_axes = false) const;
  [[nodiscard]] JointReport joint(std::string_view name, bool joint_axes = false) const;
  /// Values of the channels of its kind, see LoadKind::channels.
  [[nodiscard]] std::vector<double> load(int load) const;
  [[nodiscard]] std::vector<double> load(std::string_view name) const;
  [[nodiscard]] BeamReport beam(int beam) const;  ///< By index in the Model.
  [[nodiscard]] BeamReport beam(std::string_view name) const;
  [[nodiscard]] CableReport cable(int cable) const;  ///< Likewise.
  [[nodiscard]] CableReport cable(std::string_view name) const;
  /// Target, measured value and present output of a controller, in SI.
  [[nodiscard]] std::array<double, 3> controller(int controller) const;
  [[nodiscard]] std::array<double, 3> controller(std::string_view name) const;
  /// Whether an event has ended the run.
  [[nodiscard]] bool stopped() const;
  /// Values of a probe of the model's output at the present state: the time, then the columns named
  /// by probe_columns(), such as "x [m]".
  [[nodiscard]] std::vector<double> probe(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> probe_columns(std::string_view name) const;
  /// Energies and momenta, work input and dissipation since the start.
  [[nodiscard]] Balance balance() const;

  // Deformable solids, by index in the Model.
  [[nodiscard]] const std::vector<SolidMap>& solids() const;
  /// Valid until the next step.
  [[nodiscard]] const SolidReport& solid(int solid) const;
  [[nodiscard]] const SolidReport& solid(std::string_view name) const;
  /// Position, displacement since the start and velocity of a material point.
  [[nodiscard]] std::array<Vec3, 3> solid_point(int solid, const SolidPoint& point) const;
  /// Cauchy stress of a material point, world axes [Pa]: interpolated between nodes.
  [[nodiscard]] Mat3 solid_stress(int solid, const SolidPoint& point) const;
  /// Names of a solid's interfaces: bonded bodies, then prescribed nodes.
  [[nodiscard]] std::vector<std::string> interfaces(int solid) const;
  /// Wrench of interfaces(solid)[k] on the solid.
  [[nodiscard]] InterfaceReport interface_reaction(int solid, int k) const;
  // Contact of bodies, and of surfaces of solids and of cables with them.
  [[nodiscard]] bool has_contacts() const;
  /// Null unless bodies may be in contact with bodies.
  [[nodiscard]] const contact::ContactSet* contact_set() const;
  [[nodiscard]] const ContactMap& contact_map() const;
  /// Report of contact_map().pairs[pair] over the last step.
  [[nodiscard]] ContactReport contact(int pair) const;
  /// Index into contact_map().pairs of two sides. @throws InputError if there is no such pair.
  [[nodiscard]] int contact_pair(const Side& a, const Side& b) const;
  [[nodiscard]] ContactLosses contact_losses() const;
  /// Contact points of bodies with force in the last step; shapes as in contact_map().body.
  [[nodiscard]] const std::vector<contact::TouchingPoint>& contact_points() const;
  /// Contact points of contact_map().surfaces[surface].
  [[nodiscard]] std::vector<surface_contact::SurfacePointReport> surface_points(int surface) const;
  /// Sensor events since the start or restart.
  [[nodiscard]] const std::vector<SensorEvent>& sensor_events() const;
  /// SHA-256 over the whole state, moving bodies in the model's order.
  [[nodiscard]] std::string state_hash() const;
  /// Whether run() is recording a state between the ends of a step, see DenseOutput.
  [[nodiscard]] bool between_steps() const;

 private:
  /// Takes a step and handles its events.
  StepReport advance(double t_limit);
  /// Executes all events that are due. @returns false if one cannot be executed; the report says
  /// why.
  bool let_events_come(StepReport& report);
  [[nodiscard]] Vec3 node_velocity(int node) const;
  [[nodiscard]] const ProbeTarget& probe_target_of(std::string_view name) const;
  void watch_stress();

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
