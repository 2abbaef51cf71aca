// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/build_solids.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Layout of each event's entries in the state, see System::memory(): number of occurrences, time
/// of the last occurrence [s], whether the condition is still fulfilled, energy loss [J] and
/// largest impulse [N s or N m s] of the last occurrence.
struct EventMemory {
  enum Entry : int { kCount, kTime, kSpent, kLost, kImpulse, kSize };
};

/// Layout of each controller's numbers, behind those of events: number of evaluations, time of the
/// last one [s], its output and its slope [1/s], the error and its rate, its integral [s], the
/// filtered rate, its value just before that time, whether it is switched off, and whether nothing
/// used it from that time on; then the states of its transfer function.
struct ControllerMemory {
  enum Entry : int {
    kCount,
    kTime,
    kValue,
    kSlope,
    kError,
    kRate,
    kIntegral,
    kLag,
    kBefore,
    kOff,
    kIdle,
    kSize
  };
  [[nodiscard]] static int size(const ControllerSpec& spec) {
    return kSize + std::max(static_cast<int>(spec.denominator.size()) - 1, 0);
  }
};

class PairOnNodes;
class RunningCable;

/// Positions of the objects of a Model in its System.
struct SystemMap {
  std::vector<int> body;   ///< By Model::bodies: index into System::bodies(), kGround if fixed.
  std::vector<int> joint;  ///< By Model::joints: index into System::interactions().
  /// By Model::loads: likewise; -1 for a load on a solid.
  std::vector<int> load;
  /// Those between points of solids, by Model::loads; owned by the System.
  std::map<int, const PairOnNodes*> load_on_nodes;
  std::vector<SolidMap> solids;         ///< By Model::solids.
  std::vector<std::vector<int>> beam;   ///< By Model::beams and element: likewise.
  std::vector<std::vector<int>> cable;  ///< By Model::cables and segment: likewise.
  /// A cable that runs through its points.
  struct Running {
    int group = -1;                       ///< Of elements; −1: not a running cable.
    const RunningCable* cable = nullptr;  ///< That group; owned by the System.
  };
  std::vector<Running> running_cable;             ///< By Model::cables.
  std::vector<EventSpec> events;                  ///< Including those of joints that break.
  std::shared_ptr<contact::ContactSet> contacts;  ///< Null without contact.
  ContactMap contact;
};

/// Compiles a model: numbers its bodies, joints and loads and chooses the tree.
///
/// Fixed bodies become the ground, with their points and axes in world coordinates. A point mass
/// gets an inertia that has no effect.
///
/// @param map  Filled if given.
/// @throws InputError if a type is unknown, if a joint or load connects only fixed bodies or would
/// rotate a point mass, or if a torsional spring's joint has no axis.
[[nodiscard]] System build_system(const Model& model, SystemMap* map = nullptr);

/// Joint of an interaction of a built system. @throws std::logic_error if it is none.
[[nodiscard]] const Joint& joint_at(const System& system, int interaction);

}  // namespace polhode
