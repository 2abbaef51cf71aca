// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/simulation/smooth_model.hpp>
#include <polhode/solids/solid_elements.hpp>

namespace polhode {

namespace {

/// Rates and coordinates within which a law is searched for kinks [SI].
constexpr double kLawRange = 0x1p20;

/// Kinds of loads with histories or curves that extrapolation does not combine.
constexpr std::array<std::string_view, 4> kNotCombined = {"point_on_curve", "curve_on_curve",
                                                          "point_on_surface", "rolling"};

const std::string kOrderTwo = "Use order: 2 for this model";

/// Search for the first part that is not smooth.
class Search {
 public:
  Search(int order, bool automatic) : order_(order), automatic_(automatic) {}
  void joints(const Model& model);
  void interactions(const System& system);
  void controllers(const Model& model);
  void load(const LoadSpec& load);
  /// Kinks that a load or a cable with a fixed step must not have.
  void kinks_of(const LoadSpec& load);
  void kinks_of(const CableLineSpec& cable);
  void laws(const LoadSpec& load);
  void cable(const CableLineSpec& cable);
  void elements(const Nodes& nodes);
  [[nodiscard]] const std::optional<NotSmooth>& found() const { return found_; }

 private:
  void refuse(const std::string& what, const std::string& why, const std::string& hint) {
    if (!found_) found_ = {what, why, hint};
  }
  void law(const LoadSpec& load, const std::string& key, const TimeFunction& law);
  /// Whether a force with a jump in this derivative keeps the order: a step across the jump has an
  /// error H^(derivative + 2) in positions, and a run crosses it a bounded number of times.
  /// Automatic steps end at kinks and jumps.
  [[nodiscard]] bool smooth_enough(int derivative) const {
    return automatic_ || derivative + 2 >= order_;
  }

  int order_;
  bool automatic_;
  std::optional<NotSmooth> found_;
};

void Search::law(const LoadSpec& load, const std::string& key, const TimeFunction& law) {
  int worst = order_;
  for (TimeBreak b = law.next_break(-kLawRange, kLawRange); b.exists() && worst > 0;
       b = law.next_break(b.t, kLawRange))
    worst = std::min(worst, b.derivative);
  const bool potential = key == "energy", of_rate = key.starts_with("damper");
  // Jumps of a law of a rate are dry friction, those of a potential infinite forces.
  const bool never = worst == 0 && (potential || of_rate);
  if (potential) worst = std::max(0, worst - 1);
  if (never || !smooth_enough(worst))
    refuse(format("{} of '{}'", key, load.name),
           worst == 0 ? "jumps" : format("has kinks in its derivative {}", worst),
           "Use a smooth expression, or a lower order; order: 2 always runs");
}

void Search::load(const LoadSpec& load) {
  if (std::find(kNotCombined.begin(), kNotCombined.end(), load.type) != kNotCombined.end())
    refuse(format("'{}' is a {}", load.name, load.type), "whose state it does not combine",
           kOrderTwo);
  if (!automatic_) kinks_of(load);
  laws(load);
}

void Search::laws(const LoadSpec& load) {
  for (const auto& [key, of_key] : load.laws)
    if (of_key) law(load, key, *of_key);
}

void Search::kinks_of(const LoadSpec& load) {
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
  if (given("quadratic") && !smooth_enough(2))
    refuse(format("'{}' is quadratic", load.name), "with a kink of the second derivative at zero",
           "Use order: 4 or 2");
}

void Search::cable(const CableLineSpec& cable) {
  if (cable.friction > 0.0)
    refuse(format("the cable '{}' has friction", cable.name), "which is not smooth", kOrderTwo);
  if (cable.contact)
    refuse(format("the cable '{}' has contact", cable.name), "which is not smooth", kOrderTwo);
  if (!automatic_) kinks_of(cable);
}

void Search::kinks_of(const CableLineSpec& cable) {
  if (!cable.around.empty())
    refuse(format("the cable '{}' runs around an obstacle", cable.name),
           "where its stiffness jumps as it lifts off", kOrderTwo);
  if (cable.tension_only)
    refuse(format("the cable '{}' can go slack", cable.name), "where its force has a kink",
           "Write tension_only: false if it stays taut, or use order: 2");
}

void Search::joints(const Model& model) {
  for (const JointSpec& joint : model.joints) {
    if (joint.friction)
      refuse(format("the joint '{}' has dry friction", joint.name), "which is not smooth",
             kOrderTwo);
    if ((joint.limits || joint.angle_limits || joint.type == "slack_link") && !automatic_)
      refuse(format("the joint '{}' has stops", joint.name), "at which the velocity jumps",
             "Give a tolerance instead of a step, or use order: 2");
    if (joint.enforcement)
      refuse(format("the joint '{}' is held by springs", joint.name),
             "whose state it does not combine", "Leave its enforcement out, or use order: 2");
  }
}

void Search::interactions(const System& system) {
  for (const InteractionRef& ref : system.interactions()) {
    const InteractionTraits& traits = system.traits(ref);
    if (traits.set_valued || (traits.has_barrier && !automatic_) || traits.compliant ||
        traits.unilateral > 0)
      refuse(format("the {} '{}'", system.group(ref.group).kind(), system.name(ref)),
             "is not smooth", kOrderTwo);
  }
}

void Search::controllers(const Model& model) {
  for (const ControllerSpec& controller : model.controllers)
    if (!controller.sample)
      refuse(format("the controller '{}' is continuous", controller.name),
             "and acts at the ends of steps", "Give it a sample time, or use order: 2");
}

void Search::elements(const Nodes& nodes) {
  for (int g = 0; g < nodes.group_count(); ++g) {
    const ElementGroup& group = nodes.group(g);
    if (as_slide(group))
      refuse(format("'{}' slides along a beam", group.name()), "whose state it does not combine",
             kOrderTwo);
    if (const solids::SolidElements* solid = solids::as_solid(group);
        solid && !solid->material().relaxation().empty())
      refuse(format("the stress of {} relaxes", quote(group.name())),
             "and its steps are not symmetric in time", kOrderTwo);
    if (group.barrier_constraint() || group.changing_sparsity() || group.surface_impacts())
      refuse(format("the {} of '{}'", group.kind(), group.name()), "is not smooth", kOrderTwo);
  }
}

}  // namespace

std::optional<NotSmooth> not_smooth(const Model& model, const System& system, int order,
                                    bool automatic) {
  if (model.contacts.present || system.contacts())
    return NotSmooth{"the model has contacts", "which are not smooth", kOrderTwo};
  Search search(order, automatic);
  search.controllers(model);
  search.joints(model);
  for (const LoadSpec& load : model.loads) search.load(load);
  for (const CableLineSpec& cable : model.cables) search.cable(cable);
  search.interactions(system);
  search.elements(system.nodes());
  return search.found();
}

}  // namespace polhode
