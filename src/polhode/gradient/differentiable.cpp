// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/differentiable.hpp>
#include <polhode/gradient/instant_rows.hpp>
#include <polhode/simulation/order_choice.hpp>
#include <polhode/system/time_breaks.hpp>

namespace polhode {

namespace {

/// Loads whose step seen backwards is the same step, and whose memory is a function of the motion
/// or of the start alone: each has a test against differences of runs.
constexpr std::array<std::string_view, 25> kDifferentiable = {"force",
                                                              "moment",
                                                              "spring_damper",
                                                              "potential",
                                                              "axial_force",
                                                              "vector_damper",
                                                              "bushing",
                                                              "attraction",
                                                              "gravity_gradient",
                                                              "drag",
                                                              "axis_drag",
                                                              "rotor",
                                                              "torsional_spring",
                                                              "translational_spring",
                                                              "rotary_motor",
                                                              "linear_motor",
                                                              "rotary_inerter",
                                                              "linear_inerter",
                                                              "gear",
                                                              "screw",
                                                              "coupling",
                                                              "point_on_surface",
                                                              "point_on_curve",
                                                              "curve_on_curve",
                                                              "rolling"};

[[noreturn]] void refuse_gradient(const std::string& where, const std::string& what,
                                  const std::string& hint) {
  throw InputError(where, what, hint);
}

void check_settings(const AnalysisSpec& a) {
  if (a.type != "dynamics")
    refuse_gradient("analysis.type", format("is {}, but gradients are those of a motion", a.type),
                    "Use type: dynamics");
  if (a.momentum_rate != "momentum")
    refuse_gradient(
        "analysis.momentum_rate",
        format("is {}, but gradients exist for the momentum form only", a.momentum_rate),
        "Use momentum_rate: momentum");
  if (a.jacobian == "never" || a.jacobian == "every_step")
    refuse_gradient(
        "analysis.jacobian",
        format("is {}: its steps are not solved to the digits of a gradient", a.jacobian),
        "Use jacobian: automatic");
  // The last increment e leaves e (e/e_last)², which is what the gradient then is wrong by.
  if (a.newton_tolerance > 1e-5)
    refuse_gradient(
        "analysis.newton_tolerance",
        format("is {:g}: its steps are not solved to the digits of a gradient", a.newton_tolerance),
        "Use at most 1e-5, or leave it out");
}

/// @param by_rows  Whether stops and contacts are rows of the step, whose impacts are located.
void check_joint(const JointSpec& joint, bool by_rows) {
  const std::string where = format("joints.{}", joint.name);
  const bool stops = joint.limits || joint.angle_limits || joint.type == "slack_link";
  if (stops && !by_rows)
    refuse_gradient(where,
                    "has stops that act by forces: where an impact falls within a step depends on "
                    "the parameters, and the gradient on the steps would be a wrong number",
                    "Use contacts: {default: {law: rigid}}, with which impacts are located");
  if (joint.friction)
    refuse_gradient(where, "has dry friction, whose memory has no derivative yet",
                    "Use a damper, or leave the friction out");
  if (joint.enforcement)
    refuse_gradient(where, "is held by springs, which have no derivative yet",
                    "Leave its enforcement out");
  if (joint.breaks.force || joint.breaks.moment)
    refuse_gradient(where, "may break, which is an event within a step",
                    "Leave its strength out if it is not reached");
  if (joint.motion)
    refuse_gradient(where, "has a frame that moves as prescribed, which has no derivative yet",
                    "Use a motor in a joint");
}

void check_load(const LoadSpec& load) {
  const std::string where = format("loads.{}", load.name);
  if (load.type.ends_with("_servo")) {
    const auto given = [&](const char* key) {
      const auto found = load.parameters.find(key);
      return found != load.parameters.end() && found->second != 0.0;
    };
    if (load.drive == "speed" || given("integral") || given("max_moment") || given("max_force"))
      refuse_gradient(where,
                      "is a servo with an integral or a limit, whose memory has no derivative yet",
                      "Use stiffness and damping of an angle or displacement alone");
    return;
  }
  if (std::find(kDifferentiable.begin(), kDifferentiable.end(), load.type) == kDifferentiable.end())
    refuse_gradient(where, format("is of type {}, which has no derivative yet", load.type),
                    "Use a force, a spring, a damper, a motor or a gear");
  if (!std::holds_alternative<std::monostate>(load.of_motion))
    refuse_gradient(where, "is a function in code, whose derivative is not known",
                    "Give an expression or a table in the model");
}

/// Checks a model whose impacts or events are located.
void check_located(const Model& model, const System& system) {
  const AnalysisSpec& a = model.analysis;
  if (!a.step)
    refuse_gradient("analysis.step",
                    "is missing: impacts and events are located within fixed steps",
                    "Give a step instead of a tolerance");
  if (const OrderChoice choice = choose_order(system, model); choice.order != 2)
    refuse_gradient(
        "analysis.order",
        format("is {}: impacts and events are located in steps of order 2", choice.order),
        "Use order: 2");
  if (const TimeBreak at = TimeBreaks(system, a.duration).next(0.0);
      at.exists() && at.t <= a.duration)
    refuse_gradient("loads",
                    format("have a function with a break at t = {:.6g} s, which together with "
                           "impacts or events has no derivative yet",
                           at.t),
                    "Use a smooth function");
  for (const LoadSpec& load : model.loads)
    if (load.drive == "speed")
      refuse_gradient(format("loads.{}", load.name),
                      "prescribes a speed, whose integral together with impacts or events has no "
                      "derivative yet",
                      "Prescribe the angle or the displacement");
}

}  // namespace

void require_differentiable(const Model& model, const System& system) {
  check_settings(model.analysis);
  const bool by_rows = InstantRows::of(system);
  if ((model.contacts.present || system.contacts()) && !model.contacts.rigid())
    refuse_gradient(
        "contacts.default.law",
        format("is {}, with which the gradient of a run whose steps are kept is a wrong "
               "number: where an impact falls within a step depends on the parameters",
               model.contacts.standard.potential),
        "Use law: rigid, with which impacts are located, or compare runs");
  if (by_rows) check_located(model, system);
  if (!model.events.empty()) {
    if (by_rows)
      refuse_gradient(format("events.{}", model.events.front().name),
                      "has no derivative yet in a model with contacts or stops",
                      "Leave one of both out");
    check_located(model, system);
    if (model.analysis.rho_inf < 1.0)
      refuse_gradient("analysis.rho_inf",
                      format("is {:g}: accelerations begin anew at events, which has no derivative "
                             "yet",
                             model.analysis.rho_inf),
                      "Use rho_inf: 1, or leave events out");
  }
  if (!model.controllers.empty())
    refuse_gradient(format("controllers.{}", model.controllers.front().name),
                    "has a memory without derivative",
                    "Use springs, dampers and motors instead of a controller");
  if (!model.solids.empty())
    refuse_gradient(format("solids.{}", model.solids.front().name),
                    "is a deformable solid, which has no derivative yet", "Use rigid bodies");
  if (!model.cables.empty())
    refuse_gradient(format("cables.{}", model.cables.front().name),
                    "is a cable, which has no derivative yet", "Use a spring_damper");
  for (const BeamSpec& beam : model.beams)
    if (beam.section.relaxation_time > 0.0)
      refuse_gradient(format("beams.{}", beam.name),
                      "is viscous, and its memory has no derivative yet",
                      "Leave the relaxation time of its section out");
  for (const JointSpec& joint : model.joints) check_joint(joint, by_rows);
  for (const LoadSpec& load : model.loads) check_load(load);
  if (!system.nodes().empty())
    refuse_gradient("the model",
                    "has nodes of solids, cables or beams, which have no derivative yet",
                    "Use rigid bodies, and beams without loads along them");
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (!traits.set_valued && !traits.has_barrier && !traits.compliant) continue;
    refuse_gradient(format("{} '{}'", system.group(ref.group).kind(), system.name(ref)),
                    "has a law that jumps, at which there is no derivative",
                    "Use a law without jumps");
  }
}

}  // namespace polhode
