// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/system/pair_terms.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// How long the impulses of a step are sought.
struct ImpulseOptions {
  int sweeps = 100;         ///< At most, over all points.
  double tolerance = 1e-3;  ///< Change of a point's speed in a sweep, as part of |g| Δt [-].
};

/// A place where two bodies may touch in the step, and what impulse acts there. World axes; on a
/// +impulse, on b the opposite, both at the same place.
struct ImpulsePoint {
  int a = kGround, b = kGround;
  Vec3 normal = Vec3::UnitZ();  ///< From b to a, middle of the step.
  /// Point [m] at which the displacement along the normal is the change of the gap.
  Vec3 place = Vec3::Zero();
  double gap = 0.0;                          ///< At t_n [m].
  double rate = 0.0;                         ///< Of the gap at t_n [m/s].
  Vec3 velocity = Vec3::Zero();              ///< Of a against b where they touch at t_n [m/s].
  double restitution = 0.0, friction = 0.0;  ///< [-]
  double rolling = 0.0, torsion = 0.0;       ///< Turning impulse over normal impulse [m].
  Vec3 impulse = Vec3::Zero();               ///< First that of the last step [N s].
  Vec3 turning = Vec3::Zero();               ///< Against rolling and drilling [N m s].
  double size = 1.0;                         ///< Smallest half size of both shapes [m].
  int number = 0;                            ///< Of the contacts'.
};

/// What an impulse did to the energy of the bodies, taken from them [J].
struct ImpulseLoss {
  double normal = 0.0, friction = 0.0;
};

/// How the search of a step went.
struct ImpulseSearch {
  int sweeps = 0;
  double change = 0.0;     ///< In the last sweep, as ImpulseOptions::tolerance [-].
  bool converged = false;  ///< It came below the tolerance.
};

/// Contacts that act by impulses: where they may act in a step, and what they remember of it.
class ImpulsiveContacts {
 public:
  virtual ~ImpulsiveContacts() = default;
  /// Null: these contacts act by forces.
  [[nodiscard]] virtual const ImpulseOptions* impulses() const = 0;
  /// Whether everything that bodies may meet on their way through these steps is known; if not,
  /// BodyContacts::cover() finds it, and points have other numbers then.
  [[nodiscard]] virtual bool covers(std::span<const BodyStep> steps) const = 0;
  /// Appends the points that are not listed yet and must act if bodies go as the steps say, those
  /// that acted in the last step among them. After begin_step(). @returns how many.
  virtual int find_points(std::span<const BodyStep> steps, const StepContext& context,
                          std::vector<ImpulsePoint>& list) = 0;
  /// Renews normals and places: they are those of the middle of the steps.
  virtual void place_points(std::span<const BodyStep> steps,
                            std::span<ImpulsePoint> list) const = 0;
  /// The step is accepted: as BodyContacts::commit().
  virtual Work commit_impulses(State& state, std::span<const BodyStep> steps,
                               const StepContext& context, std::span<const ImpulsePoint> list,
                               std::span<const ImpulseLoss> losses,
                               const ImpulseSearch& search) = 0;
};

/// Rebounds below the speed that gravity brings about in so many steps do not happen [-].
inline constexpr double kSlowReboundSteps = 2.0;

/// The least speed along the normal that a point may end a step with [m/s], negative: it goes on
/// to approach. Twice the mean speed of the step is never more than what energy allows.
/// @eq{nonsmooth-exit}
/// @param w     At t_n, negative: approaching [m/s].
/// @param slow  Rebounds below this speed do not happen [m/s].
[[nodiscard]] double least_exit_speed(double gap, double w, double restitution, double dt,
                                      double slow);

}  // namespace polhode
