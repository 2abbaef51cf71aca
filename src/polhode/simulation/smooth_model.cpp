// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/smooth_model.hpp>

namespace polhode {

namespace {

/// Rates and coordinates within which a law is searched for kinks [SI].
constexpr double kLawRange = 0x1p20;

/// Kinds of loads with histories or curves that extrapolation does not combine.
constexpr std::array<std::string_view, 4> kNotCombined = {"point_on_curve", "curve_on_curve",
                                                          "point_on_surface", "rolling"};

/// Whether a force with a jump in this derivative keeps the order: a step across the jump has an
/// error H^(derivative + 2) in positions, and a run crosses it a bounded number of times.
bool smooth_enough(int derivative, int order) { return derivative + 2 >= order; }

[[noreturn]] void refuse(const std::string& what, const std::string& why, const std::string& hint) {
  throw InputError("analysis.method", format("is extrapolation, but {} {}", what, why), hint);
}

const std::string kOrderTwo = "Use order: 2 for this model";

void check_law(const LoadSpec& load, const std::string& key, const TimeFunction& law, int order) {
  int worst = order;
  for (TimeBreak b = law.next_break(-kLawRange, kLawRange); b.exists() && worst > 0;
       b = law.next_break(b.t, kLawRange))
    worst = std::min(worst, b.derivative);
  if (!smooth_enough(worst, order))
    refuse(format("{} of '{}'", key, load.name),
           worst == 0 ? "jumps" : format("has kinks in its derivative {}", worst),
           "Use a smooth expression, or a lower order; order: 2 always runs");
}

void check_load(const LoadSpec& load, int order) {
  if (std::find(kNotCombined.begin(), kNotCombined.end(), load.type) != kNotCombined.end())
    refuse(format("'{}' is a {}", load.name, load.type), "whose state it does not combine",
           kOrderTwo);
  const auto given = [&](const char* key) {
    const auto at = load.parameters.find(key);
    return at != load.parameters.end() && at->second != 0.0;
  };
  if (const auto acts = load.words.find("acts"); acts != load.words.end() && acts->second != "both")
    refuse(format("'{}' acts in {} only", load.name, acts->second), "and has a kink where it ends",
           "Write acts: both where its sign does not change, or use order: 2");
  if (given("max_moment") || given("max_force"))
    refuse(format("the servo '{}' has a limit", load.name), "at which its force has a kink",
           "Leave the limit out if it is not reached, or use order: 2");
  if (given("quadratic") && !smooth_enough(2, order))
    refuse(format("'{}' is quadratic", load.name), "with a kink of the second derivative at zero",
           "Use order: 4 or 2");
  for (const auto& [key, law] : load.laws)
    if (law) check_law(load, key, *law, order);
}

void check_cable(const CableLineSpec& cable) {
  if (cable.friction > 0.0)
    refuse(format("the cable '{}' has friction", cable.name), "which is not smooth", kOrderTwo);
  if (cable.contact)
    refuse(format("the cable '{}' has contact", cable.name), "which is not smooth", kOrderTwo);
  if (cable.muscle)
    refuse(format("'{}' is a muscle", cable.name), "whose curves have kinks", kOrderTwo);
  if (!cable.around.empty())
    refuse(format("the cable '{}' runs around an obstacle", cable.name),
           "where its stiffness jumps as it lifts off", kOrderTwo);
  if (cable.tension_only)
    refuse(format("the cable '{}' can go slack", cable.name), "where its force has a kink",
           "Write tension_only: false if it stays taut, or use order: 2");
}

}  // namespace

void require_smooth(const Model& model, const System& system, int order) {
  if (model.contacts.present || system.contacts())
    refuse("the model has contacts", "which are not smooth", kOrderTwo);
  for (const JointSpec& joint : model.joints) {
    if (joint.friction)
      refuse(format("the joint '{}' has dry friction", joint.name), "which is not smooth",
             kOrderTwo);
    if (joint.limits || joint.angle_limits || joint.type == "slack_link")
      refuse(format("the joint '{}' has stops", joint.name), "at which the velocity jumps",
             "Leave its limits out if they are not reached, or use order: 2");
    if (joint.enforcement)
      refuse(format("the joint '{}' is held by springs", joint.name),
             "whose state it does not combine", "Leave its enforcement out, or use order: 2");
  }
  for (const LoadSpec& load : model.loads) check_load(load, order);
  for (const CableLineSpec& cable : model.cables) check_cable(cable);
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (traits.set_valued || traits.has_barrier || traits.compliant || traits.unilateral > 0)
      refuse(format("the {} '{}'", system.group(ref.group).kind(), system.name(ref)),
             "is not smooth", kOrderTwo);
  }
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g) {
    const ElementGroup& group = nodes.group(g);
    if (group.barrier_constraint() || group.changing_sparsity() || group.surface_impacts())
      refuse(format("the {} of '{}'", group.kind(), group.name()), "is not smooth", kOrderTwo);
  }
}

}  // namespace polhode
