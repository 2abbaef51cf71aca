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

// What code that looks inside a simulation knows: <polhode/simulation/simulation_details.hpp>.
class System;
struct State;
struct SolidMap;
struct SolidPoint;
struct ContactMap;
struct SurfacePointReport;
struct ProbeTarget;
namespace contact {
class ContactSet;
struct TouchingPoint;
}  // namespace contact

/// Why a run ended.
enum class RunEnd { finished, not_converged, interrupted, limit };

/// How a joint stands at the state of a simulation.
struct JointReport {
  std::vector<double>
      coordinates;             ///< Free coordinates, user's order a→b, turns counted [rad or m].
  std::vector<double> rates;   ///< Their rates.
  Vec3 force = Vec3::Zero();   ///< That a exerts on b, world axes [N].
  Vec3 moment = Vec3::Zero();  ///< At the joint's point on b [N m].
  double residual = 0.0;       ///< Largest |g| of its rows [m or -].
  /// Of a joint with friction or limits: friction on b by free coordinate [N or N m], whether it
  /// slipped in the last step, force of the stops by limited coordinate [N or N m].
  std::vector<double> friction, stops;
  bool slips = false;
  /// Drive of a joint whose frame moves as prescribed: power [W] and work since the start [J].
  std::vector<double> power, work;
};

/// The figures a run ends with; `run --json` prints them under these names.
struct RunSummary {
  RunEnd end = RunEnd::finished;
  std::string message;  ///< For a run that did not finish: what happened and what to try.
  double t = 0.0;
  std::int64_t steps = 0, rejected_steps = 0, newton_iterations = 0;
  double energy_drift = 0.0, linear_momentum_drift = 0.0, angular_momentum_drift = 0.0;
  double constraint_residual_max = 0.0, velocity_constraint_residual_max = 0.0;
  /// Errors of the steps as estimated on the way, lengths over the mechanism's size, angles in
  /// radians.
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
  int order = 2;
  std::optional<StaticReport> statics;  ///< Of a static analysis; t is the load factor then.
  double strain_energy = 0.0;           ///< Of a static analysis: in springs, beams and solids [J].
  std::string narration;                ///< What was chosen and why, a few lines.
  std::vector<std::string> warnings;    ///< What was seen at output times and deserves a look.
  /// An event of the model, since the start.
  struct Event {
    std::string name;
    std::int64_t count = 0;  ///< How often it came.
    double time = 0.0;       ///< When it came last [s].
    double lost = 0.0;       ///< Kinetic energy lost then, by what it switched on [J].
    double impulse = 0.0;    ///< Largest of a row then [N s or N m s].
  };
  std::vector<Event> events;
  /// Of models with contact.
  struct Contacts {
    int shapes = 0;          ///< Of bodies that may touch bodies.
    int surfaces = 0;        ///< Of solids, each with every shape that it may touch.
    int touching = 0;        ///< Pairs of shapes or surfaces that press on each other now.
    double least_gap = 0.0;  ///< After any step since the start or restart [m]; NaN: none was near.
    double lost_in_impacts = 0.0, lost_by_friction = 0.0;  ///< Since the start [J].
    /// What the energy changed by beyond loads and losses [J]; below zero: lost.
    double numerical = 0.0;
    /// Of the non-smooth law: sweeps over all points, mean of the steps since the start, and steps
    /// that ended above sweep_tolerance.
    std::optional<std::pair<double, std::int64_t>> sweeps;
  };
  std::optional<Contacts> contacts;
  /// Quality of a solid's stress on its mesh, seen at output times since the start or
  /// restart: √(error energy / largest energy so far) of NodalFields [-].
  struct SolidStress {
    std::string solid;
    double error = 0.0;      ///< Now.
    double error_max = 0.0;  ///< Largest.
    double t_max = 0.0;      ///< When that was [s], or at which load factor.
  };
  std::vector<SolidStress> solids;
};

/// A compiled model with its state and method: what steps, runs and is looked at.
class Simulation {
 public:
  /// Builds the system, assembles and projects the start, chooses solver and order.
  /// @throws InputError if the model cannot be built or its start not assembled.
  explicit Simulation(Model model);
  /// Continues from a saved state: equal to the straight run bit for bit.
  Simulation(Model model, State state);
  ~Simulation();
  Simulation(Simulation&&) noexcept;

  [[nodiscard]] const Model& model() const;
  [[nodiscard]] const System& system() const;
  [[nodiscard]] const State& state() const;
  [[nodiscard]] double time() const;
  [[nodiscard]] const StartReport& start_report() const;

  /// Takes one accepted step, not beyond t_limit. In statics time is the load factor, and a step
  /// goes to the next equilibrium.
  StepReport step(double t_limit);
  /// Steps to the model's duration, or to the full load; calls observe(*this) at the start and
  /// after every step whose end is an output time (model.output.every), and on_step after every
  /// step. Stops early, after the current step, when *stop becomes true.
  RunSummary run(const std::function<void(Simulation&)>& observe = {},
                 const std::function<void(Simulation&)>& on_step = {},
                 const std::atomic<bool>* stop = nullptr);
  /// The figures so far.
  [[nodiscard]] RunSummary summary() const;

  // What stands at the present state; bodies and joints by index in the Model. Motions of model
  // bodies are of their centre of mass; fixed bodies stand still. Velocities are projected onto the
  // constraints: those of the state carry a part normal to them, of order Δt².
  [[nodiscard]] BodyMotion body(int body) const;
  /// The same by name, as everything below that has a name. @throws InputError if the model has
  /// none of that name; the message has the nearest ones.
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
  /// The numbers of the channels of its kind, see LoadKind::channels.
  [[nodiscard]] std::vector<double> load(int load) const;
  [[nodiscard]] std::vector<double> load(std::string_view name) const;
  [[nodiscard]] BeamReport beam(int beam) const;  ///< By index in the Model.
  [[nodiscard]] BeamReport beam(std::string_view name) const;
  [[nodiscard]] CableReport cable(int cable) const;  ///< Likewise.
  [[nodiscard]] CableReport cable(std::string_view name) const;
  /// What a controller aims at, sees, and sets until it acts again, in SI.
  [[nodiscard]] std::array<double, 3> controller(int controller) const;
  [[nodiscard]] std::array<double, 3> controller(std::string_view name) const;
  /// An event has ended the run.
  [[nodiscard]] bool stopped() const;
  /// What a probe of the model's output records, at the present state: the time, then the numbers
  /// of the columns that probe_columns() names, such as "x [m]".
  [[nodiscard]] std::vector<double> probe(std::string_view name) const;
  [[nodiscard]] std::vector<std::string> probe_columns(std::string_view name) const;
  /// Energies and momenta, and what was put in and dissipated since the start.
  [[nodiscard]] Balance balance() const;

  // Deformable solids, by index in the Model.
  [[nodiscard]] const std::vector<SolidMap>& solids() const;
  /// Valid until the next step.
  [[nodiscard]] const SolidReport& solid(int solid) const;
  [[nodiscard]] const SolidReport& solid(std::string_view name) const;
  /// Position, displacement since the start and velocity of a material point.
  [[nodiscard]] std::array<Vec3, 3> solid_point(int solid, const SolidPoint& point) const;
  /// Cauchy stress of a material point, world axes [Pa]: between the stresses at nodes.
  [[nodiscard]] Mat3 solid_stress(int solid, const SolidPoint& point) const;
  /// Names of what holds nodes of a solid: bonded bodies, then prescribed nodes.
  [[nodiscard]] std::vector<std::string> interfaces(int solid) const;
  /// What interfaces(solid)[k] exerts on the solid.
  [[nodiscard]] InterfaceReport interface_reaction(int solid, int k) const;
  // Contact of bodies, and of surfaces of solids and of cables with them.
  [[nodiscard]] bool has_contacts() const;
  /// Null unless bodies may touch bodies.
  [[nodiscard]] const contact::ContactSet* contact_set() const;
  [[nodiscard]] const ContactMap& contact_map() const;
  /// Of contact_map().pairs[pair]: over the last step.
  [[nodiscard]] ContactReport contact(int pair) const;
  /// Index into contact_map().pairs of two sides. @throws InputError if not kept.
  [[nodiscard]] int contact_pair(int side_a, int side_b) const;
  [[nodiscard]] ContactLosses contact_losses() const;
  /// Points of bodies that carried force in the last step; shapes as in contact_map().body.
  [[nodiscard]] const std::vector<contact::TouchingPoint>& contact_points() const;
  /// The same of contact_map().surfaces[surface].
  [[nodiscard]] std::vector<SurfacePointReport> surface_points(int surface) const;
  /// What sensors told since the start or restart.
  [[nodiscard]] const std::vector<SensorEvent>& sensor_events() const;
  /// SHA-256 over the whole state, moving bodies in the model's order.
  [[nodiscard]] std::string state_hash() const;

 private:
  /// A step with the events that it meets.
  StepReport advance(double t_limit);
  /// Lets all events come that are due. @returns false if one cannot; the report says why.
  bool let_events_come(StepReport& report);
  [[nodiscard]] Vec3 node_velocity(int node) const;
  [[nodiscard]] const ProbeTarget& probe_target_of(std::string_view name) const;
  void watch_stress();

  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
