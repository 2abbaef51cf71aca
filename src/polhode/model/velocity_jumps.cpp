// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/model/model.hpp>
#include <polhode/model/velocity_jumps.hpp>

namespace polhode {

bool velocities_may_jump(const Model& model) {
  if (model.analysis.type != "dynamics") return false;
  if (model.contacts.present || !model.events.empty()) return true;
  const auto any = [](const auto& list, auto&& holds) {
    return std::any_of(list.begin(), list.end(), holds);
  };
  return any(model.joints,
             [](const JointSpec& joint) {
               return joint.limits || joint.angle_limits || joint.motion || joint.breaks.force ||
                      joint.breaks.moment || joint.type == "slack_link";
             }) ||
         any(model.loads,
             [](const LoadSpec& load) {
               return load.type.ends_with("motor") && load.drive != "force" &&
                      load.drive != "moment";
             }) ||
         any(model.solids, [](const SolidSpec& solid) { return !solid.prescribed.empty(); });
}

}  // namespace polhode
