// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/clock.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/simulation/modal.hpp>
#include <polhode/statics/turning_model.hpp>

namespace polhode {

namespace {

/// Unbalanced forces, as a part of the largest force, above which a warning is given.
constexpr double kUnbalanced = 1e-6;

/// Velocity of a centre of mass, relative to the size of the model times its angular velocity,
/// below which it is rounding.
constexpr double kStays = 1e-9;

/// Difference of velocities from those of one rotation, relative to the largest, below which it is
/// rounding of what a user writes.
constexpr double kTogether = 1e-6;

/// Angular velocities of the bodies of the system at the start, in body axes; empty without
/// rotation. @throws InputError if there is any motion other than rotation about a body's own
/// centre of mass.
std::vector<Vec3> steady_spin(const Model& model) {
  for (const SolidSpec& solid : model.solids)
    if ((solid.velocity && !solid.velocity->isZero(0.0)) ||
        (solid.angular_velocity && !solid.angular_velocity->isZero(0.0)))
      throw InputError(format("solids.{}", solid.name),
                       "has a velocity, but modes need a state of rest",
                       "Leave it out, or ask for modes about a steady spin (analysis.spin)");
  const bool any = std::any_of(model.bodies.begin(), model.bodies.end(), [](const BodySpec& b) {
    return !b.velocity.isZero(0.0) || !b.angular_velocity.isZero(0.0);
  });
  if (!any) return {};
  const System system = build_system(model, nullptr);
  const State state = system.initial_state();
  std::vector<Vec3> spin;
  bool turns = false;
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    if (m.v.norm() > kStays * system.length_scale() * m.W.norm())
      throw InputError(format("bodies.{}", system.bodies()[b].name),
                       format("moves with {:.3g} m/s, but modes need a steady state", m.v.norm()),
                       "Leave velocity out; a body may turn about an axis through its centre of "
                       "mass");
    spin.push_back(system.bodies()[b].point_mass ? Vec3(Vec3::Zero()) : m.W);
    turns = turns || !spin.back().isZero(0.0);
  }
  if (!turns) return {};
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    const int b = nodes[i].body;
    const NodePlace place = nodes.place_of(i);
    if (b < 0 || place.group < 0 || spin[static_cast<std::size_t>(b)].isZero(0.0)) continue;
    throw InputError(nodes.group(place.group).name(),
                     format("rotates with body '{}', but modes contain the gyroscopic and "
                            "centrifugal forces of bodies and beams only",
                            system.bodies()[b].name),
                     "Ask for modes about a steady spin (analysis.spin), or leave the angular "
                     "velocity out");
  }
  return spin;
}

/// Rotation of a model whose axis is not given: that of all its parts at the start.
/// @throws InputError if there is none.
TurningFrame frame_of_velocities(const Model& model) {
  const System system = build_system(model, nullptr);
  const State state = system.initial_state();
  BodyMotion fastest;
  for (int b = 0; b < system.body_count(); ++b)
    if (const BodyMotion m = system.motion(state, b);
        !system.bodies()[b].point_mass && m.W.norm() > fastest.W.norm())
      fastest = m;
  if (fastest.W.isZero(0.0))
    throw InputError("analysis.spin_axis", "is missing, and no body turns at the start",
                     "Give the axis, such as spin_axis: z");
  const Vec3 omega = fastest.q * fastest.W;
  TurningFrame frame;
  frame.axis = omega.normalized();
  frame.through = model.analysis.spin_through.value_or(fastest.r + omega.cross(fastest.v) /
                                                                       omega.squaredNorm());
  const double rounding = kTogether * system.length_scale() * omega.norm();
  const auto refuse = [](const std::string& where) {
    throw InputError(where, "does not turn with the others about one axis at the start",
                     "Give it their rotation, or give spin_axis: then everything turns about it");
  };
  const auto expected = [&](const Vec3& x) -> Vec3 { return omega.cross(x - frame.through); };
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    if ((m.v - expected(m.r)).norm() > rounding ||
        (!system.bodies()[b].point_mass && (m.q * m.W - omega).norm() > kTogether * omega.norm()))
      refuse(format("bodies.{}", system.bodies()[b].name));
  }
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i)
    if (const NodePlace place = nodes.place_of(i);
        place.group >= 0 && !nodes.bonded(i) &&
        (nodes[i].velocity - expected(nodes[i].position)).norm() > rounding)
      refuse(nodes.group(place.group).name());
  return frame;
}

/// Frame of the steady spin of analysis.spin.
/// @throws InputError if the axis is not known.
TurningFrame turning_frame(const Model& model) {
  const AnalysisSpec& analysis = model.analysis;
  TurningFrame frame;
  if (analysis.spin_axis) {
    frame.axis = analysis.spin_axis->normalized();
    frame.through = analysis.spin_through.value_or(Vec3::Zero());
  } else {
    frame = frame_of_velocities(model);
  }
  frame.ground_turns = analysis.spin_ground == "turns";
  return frame;
}

/// Copy of the model at rest, for statics.
Model static_model(Model model) {
  model.analysis.type = "statics";
  for (BodySpec& body : model.bodies) body.velocity = body.angular_velocity = Vec3::Zero();
  for (BeamSpec& beam : model.beams) beam.velocity = beam.angular_velocity = Vec3::Zero();
  for (SolidSpec& solid : model.solids) solid.velocity = solid.angular_velocity = std::nullopt;
  return model;
}

}  // namespace

ModalAnalysis::ModalAnalysis(Model model, const std::atomic<bool>* stop) {
  const double wall = wall_clock(), cpu = cpu_clock();
  const AnalysisSpec analysis = model.analysis;
  ModeOptions options;
  options.count = analysis.count;
  if (analysis.spin.size() > 1)
    throw InputError("analysis.spin", format("has {} speeds", analysis.spin.size()),
                     "Give one, or call polhode modes or polhode.spin_modes, which take them all");
  if (analysis.spin.empty()) {
    options.spin = steady_spin(model);
  } else {
    options.frame = turning_frame(model);
    options.frame->speed = analysis.spin.front();
    model.analysis.turning = options.frame;
  }
  simulation_ = std::make_unique<Simulation>(static_model(std::move(model)));
  (void)build_system(simulation_->model(), &map_);
  State state = simulation_->state();
  if (options.frame) check_turning(simulation_->system(), state, *options.frame);
  if (analysis.about == "start" && UnilateralRows::of(simulation_->system()))
    throw InputError("analysis.about",
                     "is start, but forces of contacts and stops with the law rigid follow from an "
                     "equilibrium",
                     "Use about: equilibrium");
  if (analysis.about == "start") {
    // Multipliers that balance the loads with the model at rest.
    const InstantSolution now = InstantSolver(simulation_->system()).accelerations(state);
    if (now.solved) state.lambda = now.lambda;
  } else {
    const RunSummary summary = simulation_->run({}, {}, stop);
    if (summary.end != RunEnd::finished) message_ = summary.message;
    state = simulation_->state();
  }
  const char* stopped =
      "Stopped before modes were computed. Allow more time, or ask for fewer modes";
  if (message_.empty() && stop && stop->load()) message_ = stopped;
  if (message_.empty()) {
    options.stop = stop;
    try {
      report_ = find_modes(simulation_->system(), state, options);
    } catch (const ModesStopped&) {
      message_ = stopped;
    }
    if (!report_.held.empty() && report_.unbalanced > kUnbalanced)
      message_ = format(
          "The forces of contacts and stops at the equilibrium are not known: {:.2g} of the "
          "largest force is unbalanced. Use law: barrier and about: start, or joints instead of "
          "contacts",
          report_.unbalanced);
    if (analysis.about == "start" && report_.unbalanced > kUnbalanced)
      report_.warnings.push_back(format(
          "the start is no equilibrium: {:.2g} of the largest force is unbalanced; use about: "
          "equilibrium",
          report_.unbalanced));
  }
  wall_time_ = wall_clock() - wall;
  cpu_time_ = cpu_clock() - cpu;
}

std::vector<ModalAnalysis> spin_analyses(const Model& model, const std::atomic<bool>* stop) {
  if (model.analysis.spin.empty())
    throw InputError("analysis.spin", "is missing", "Give the speed of the spin");
  std::vector<ModalAnalysis> list;
  for (const double speed : model.analysis.spin) {
    Model at = model;
    at.analysis.spin = {speed};
    list.emplace_back(std::move(at), stop);
    if (!list.back().converged()) break;
  }
  return list;
}

Vec6 ModalAnalysis::body_shape(int mode, int body, bool imaginary) const {
  const int index = map_.body[static_cast<std::size_t>(body)];
  const Mode& m = report_.modes[static_cast<std::size_t>(mode)];
  const Vec& shape = imaginary ? m.shape_imag : m.shape;
  if (index == kGround || shape.size() == 0) return Vec6::Zero();
  return shape.segment<6>(6 * index);
}

std::vector<double> ModalAnalysis::node_shapes(int mode, bool imaginary) const {
  const System& system = simulation_->system();
  const Mode& m = report_.modes[static_cast<std::size_t>(mode)];
  const Vec& shape = imaginary ? m.shape_imag : m.shape;
  if (shape.size() == 0)
    return std::vector<double>(3 * static_cast<std::size_t>(system.nodes().count()), 0.0);
  return node_shape(system, simulation_->state(), shape);
}

}  // namespace polhode
