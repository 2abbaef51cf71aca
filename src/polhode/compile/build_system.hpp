// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/build_solids.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// What the state remembers of each event, see System::memory(): how often it came, when last [s],
/// whether it came while its condition still holds, and of the last time energy lost [J] and the
/// largest impulse [N s or N m s].
struct EventMemory {
  enum Entry : int { kCount, kTime, kSpent, kLost, kImpulse, kSize };
};

/// Likewise of each controller, behind those of events: how often it acted, when last [s], what it
/// set then and its slope [1/s], the error and its rate, its integral [s], the rate behind the lag
/// of its filter; and behind these the states of its transfer function.
struct ControllerMemory {
  enum Entry : int { kCount, kTime, kValue, kSlope, kError, kRate, kIntegral, kLag, kSize };
  [[nodiscard]] static int size(const ControllerSpec& spec) {
    return kSize + std::max(static_cast<int>(spec.denominator.size()) - 1, 0);
  }
};

class RunningCable;

/// Where the things of a Model went in its System.
struct SystemMap {
  std::vector<int> body;   ///< By Model::bodies: index into System::bodies(), kGround if fixed.
  std::vector<int> joint;  ///< By Model::joints: index into System::interactions().
  /// By Model::loads: likewise; of a load on a solid -1.
  std::vector<int> load;
  std::vector<SolidMap> solids;         ///< By Model::solids.
  std::vector<std::vector<int>> beam;   ///< By Model::beams and element: likewise.
  std::vector<std::vector<int>> cable;  ///< By Model::cables and piece: likewise.
  /// A cable that slides through its points.
  struct Running {
    int group = -1;                       ///< Of elements; −1: the cable does not slide.
    const RunningCable* cable = nullptr;  ///< That group; the System keeps it.
  };
  std::vector<Running> running_cable;             ///< By Model::cables.
  std::vector<EventSpec> events;                  ///< With those of joints that break.
  std::shared_ptr<contact::ContactSet> contacts;  ///< Null if nothing touches.
  ContactMap contact;
};

/// Compiles a model: numbers its bodies, joints and loads and chooses the tree.
///
/// Fixed bodies become the ground, their points and axes moved to world coordinates. A point mass
/// gets an inertia that nothing ever turns.
///
/// @param map  Filled in if given.
/// @throws InputError if a type is unknown, if a joint or load connects nothing that moves or
///         would turn a point mass, or if a torsional spring's joint has no axis.
[[nodiscard]] System build_system(const Model& model, SystemMap* map = nullptr);

/// The joint behind an interaction of a built system. @throws std::logic_error if it is none.
[[nodiscard]] const Joint& joint_at(const System& system, int interaction);

}  // namespace polhode
