// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <polhode/system/body_contacts.hpp>
#include <polhode/system/pair_terms.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// Law of contacts that act by impulses, and termination of the impulse iteration of a step.
struct ImpulseOptions {
  int sweeps = 0;           ///< Largest number; 0: 100, or 200,000 over the number of points.
  double tolerance = 1e-3;  ///< Change of a point's speed in a sweep, as part of |g| Δt [-].
  /// Rows of the step, exact in position, with a velocity problem at its end; otherwise Moreau's
  /// velocities with these sweeps.
  bool rigid = false;
};

/// A possible contact point of two bodies in the step, and its impulse. World axes; +impulse acts
/// on a, the opposite on b, both at the same point.
struct ImpulsePoint {
  int a = kGround, b = kGround;
  Vec3 normal = Vec3::UnitZ();  ///< From b to a, middle of the step.
  /// Point [m] at which the displacement along the normal is the change of the gap.
  Vec3 place = Vec3::Zero();
  Vec3 normal_n = Vec3::UnitZ(), place_n = Vec3::Zero();  ///< At t_n.
  double gap = 0.0;                                       ///< At t_n [m].
  double kept = 0.0;                                      ///< See kept_gap() [m].
  double rate = 0.0;                                      ///< Of the gap at t_n [m/s].
  /// Of a relative to b at the contact point at t_n [m/s].
  Vec3 velocity = Vec3::Zero();
  double restitution = 0.0, friction = 0.0;  ///< [-]
  double friction_across = 0.0;              ///< Across `along` [-].
  Vec3 along = Vec3::UnitX();                ///< Direction of `friction`.
  double rolling = 0.0, torsion = 0.0;       ///< Angular impulse over normal impulse [m].
  Vec3 impulse = Vec3::Zero();               ///< Initially that of the last step [N s].
  Vec3 turning = Vec3::Zero();               ///< Rolling and torsional friction [N m s].
  double slip = 0.0;                         ///< Of a row over the step [m].
  double size = 1.0;                         ///< Smallest half size of both shapes [m].
  int number = 0;                            ///< Number among the contacts.
};

/// A contact point at an instant, with what an equilibrium needs of it: the derivatives of its
/// normal and place by the increments (Δr_a, Δθ_a, Δr_b, Δθ_b), and its history.
struct ContactInstant {
  using ByIncrements = Eigen::Matrix<double, 3, 12>;
  int a = kGround, b = kGround;
  int number = 0;                                     ///< Among the contacts, at this instant only.
  std::array<std::uint64_t, 2> key{};                 ///< Of its two features, for all instants.
  double gap = 0.0;                                   ///< [m]
  Vec3 normal = Vec3::UnitZ(), place = Vec3::Zero();  ///< From b to a, unit; [m].
  ByIncrements normal_by = ByIncrements::Zero(), place_by = ByIncrements::Zero();
  double friction = 0.0, friction_across = 0.0;         ///< Kinetic [-].
  double static_friction = 0.0;                         ///< Not below the kinetic one [-].
  Vec3 along = Vec3::UnitX();                           ///< Direction of `friction`, world.
  double rolling = 0.0, torsion = 0.0;                  ///< [m]
  double size = 1.0;                                    ///< As ImpulsePoint::size [m].
  Vec3 impulse = Vec3::Zero(), turning = Vec3::Zero();  ///< Of the last step, if closed after it.
  bool slips = false;                                   ///< At the end of it.
};

/// Energy loss of the bodies by an impulse [J].
struct ImpulseLoss {
  double normal = 0.0, friction = 0.0;
};

/// Outcome of the impulse iteration of a step.
struct ImpulseSearch {
  int sweeps = 0;
  double change = 0.0;     ///< In the last sweep, as ImpulseOptions::tolerance [-].
  bool converged = false;  ///< It came below the tolerance.
};

/// A contact point that was a closed row in the last step of a state.
struct ClosedRow {
  std::array<double, 5> features;  ///< Name of the two features that touch.
  Participants bodies;
  Vec3 point, normal;     ///< World, in the middle of the step; from b to a.
  Vec3 impulse, turning;  ///< On a in the step, world [N s], [N m s].
  double pressed;         ///< Normal part of the impulse [N s].
  double held;            ///< Friction, as a part of that under which it sticks [-].
  bool slips;
};

/// Interface of impulsive contacts: their possible contact points in a step, and their histories.
class ImpulsiveContacts {
 public:
  virtual ~ImpulsiveContacts() = default;
  /// Gap up to which surfaces touch: the accuracy of positions [m].
  [[nodiscard]] virtual double touching_gap() const = 0;
  /// Null: these contacts act by forces.
  [[nodiscard]] virtual const ImpulseOptions* impulses() const = 0;
  /// Whether the list of candidates covers the bodies' motion in these steps; if not,
  /// BodyContacts::cover() extends it, and points are renumbered.
  [[nodiscard]] virtual bool covers(std::span<const BodyStep> steps) const = 0;
  /// Appends points that are not listed yet and must act if bodies move by these steps, including
  /// those that acted in the last step. After begin_step(). @returns their number.
  virtual int find_points(std::span<const BodyStep> steps, const StepContext& context,
                          std::vector<ImpulsePoint>& list) = 0;
  /// Updates normals and positions to those of the middle of the steps.
  virtual void place_points(std::span<const BodyStep> steps,
                            std::span<ImpulsePoint> list) const = 0;
  /// Gap of a point at the end of the steps [m].
  [[nodiscard]] virtual double gap_after(std::span<const BodyStep> steps,
                                         const ImpulsePoint& point) const = 0;
  /// Normal, from b to a, and place of a point at the end of the steps: the gradient of the gap.
  [[nodiscard]] virtual std::pair<Vec3, Vec3> direction_after(std::span<const BodyStep> steps,
                                                              const ImpulsePoint& point) const = 0;
  /// Two bodies that overlap at the end of the steps, as no point found them: rows by their gaps,
  /// also if they have passed through each other within the step, other laws if an edge enters a
  /// body in a fast step.
  [[nodiscard]] virtual std::optional<std::pair<int, int>> passed(
      std::span<const BodyStep> steps) const = 0;
  /// Appends all candidates for contact points where bodies are, after begin_step() there.
  virtual void points_at(std::span<const BodyStep> instants,
                         std::vector<ContactInstant>& list) const = 0;
  /// Largest part of increments from these instants that takes no two bodies deeper into each other
  /// than half of their smaller half thickness, so that their gaps still tell on which side they
  /// are. Increments must be covered.
  [[nodiscard]] virtual double part_on_one_side(std::span<const BodyStep> instants,
                                                std::span<const Vec6> increments) const = 0;
  /// Rows that are closed at a state and pressed in the step before, if contacts are rows.
  [[nodiscard]] virtual std::vector<ClosedRow> closed_rows(const State& state) const = 0;
  /// Commits an accepted step like BodyContacts::commit().
  virtual Work commit_impulses(State& state, std::span<const BodyStep> steps,
                               const StepContext& context, std::span<const ImpulsePoint> list,
                               std::span<const ImpulseLoss> losses,
                               const ImpulseSearch& search) = 0;
};

/// Whether contacts are rows of the step: velocities jump only where one closes, and its error can
/// be estimated as that of a step with joints.
[[nodiscard]] inline bool are_rows(BodyContacts* contacts) {
  const ImpulsiveContacts* const impulsive = contacts ? contacts->impulsive() : nullptr;
  return impulsive && impulsive->impulses() && impulsive->impulses()->rigid;
}

/// Number of steps of gravity whose speed increment is the smallest rebound speed; slower rebounds
/// are suppressed [-].
inline constexpr double kSlowReboundSteps = 2.0;

}  // namespace polhode
