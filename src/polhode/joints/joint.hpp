// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <polhode/joints/driven_turn.hpp>
#include <polhode/joints/enforcement.hpp>
#include <polhode/joints/moving_frame.hpp>
#include <polhode/joints/recipe.hpp>
#include <polhode/joints/resistance.hpp>
#include <polhode/system/free_coordinate.hpp>
#include <polhode/system/interaction.hpp>

namespace polhode {

/// Free coordinates of a joint at an instant; the first `count` are valid.
struct JointCoordinates {
  int count = 0;
  std::array<double, 6> value{};  ///< [rad], turns counted, or [m].
  std::array<double, 6> rate{};   ///< [rad/s] or [m/s].
};

/// Wrench of side a of a joint on side b, at the joint's point on b.
struct Reaction {
  Vec3 force = Vec3::Zero();   ///< [N]
  Vec3 moment = Vec3::Zero();  ///< [N m]
};

/// A joint: quadratic constraint parts between two frames, enforced by multipliers.
///
/// Its rows and multipliers are in the order of MotionBasis. Bodies, frames and rows are in the
/// solver's order, which reverse() may have changed; reports are in the user's order a → b.
class Joint : public InteractionItem {
 public:
  static constexpr const char* kKind = "joint";

  Joint() = default;
  /// @param item_name  As in the user's file.
  /// @param type       Name of its JointKind.
  Joint(std::string item_name, std::string type, Participants pair, const JointRecipe& recipe);

  [[nodiscard]] const std::string& type() const { return type_; }
  [[nodiscard]] const JointParts& parts() const { return parts_; }
  [[nodiscard]] const JointFrames& frames() const { return frames_; }  ///< Solver's order.
  [[nodiscard]] bool reversed() const { return reversed_; }  ///< Solver's a is the user's b.

  /// Sets friction and stops, before the system is finished.
  /// @throws InputError if this type of joint supports none.
  void set_resistance(const JointResistance& data);
  /// Null if the joint moves freely.
  [[nodiscard]] const Resistance* resistance() const { return resistance_.get(); }
  /// Report of friction and stops. @param step  An instant with its history; the joint must have a
  /// resistance.
  [[nodiscard]] ResistanceReport resistance_report(const PairStep& step) const;

  /// Prescribes the motion of the frame on the first body, before the system is finished.
  /// @throws InputError if the joint is a distance, or has friction or stops.
  void set_motion(const FrameMotion& motion);
  [[nodiscard]] bool frame_moves() const { return motion_ != nullptr; }
  /// Sums the impulses of its wrench over the run, before the system is finished.
  void record_impulses() { records_ = true; }
  [[nodiscard]] bool records_impulses() const { return records_; }
  /// Impulses since the start of the whole wrench of a on b about the world's origin, with
  /// friction, stops and velocity jumps [N s, N m s]. @param step  With the current history; the
  /// joint must record them.
  [[nodiscard]] Reaction impulses(const PairStep& step) const;
  /// Work of the prescribed motion since the start [J]. @param step  With the current history.
  [[nodiscard]] double drive_work(const PairStep& step) const;
  /// Power of the prescribed motion at an instant [W].
  [[nodiscard]] double drive_power(const PairStep& step) const;

  /// Enforces the rows by a stiffness, before the system is finished.
  /// @param stiffest  Largest stiffness of all augmented joints [N/m or N m/rad].
  /// @throws InputError if it has no rows, or a required stiffness is not positive.
  void set_enforcement(const JointEnforcement& enforcement, double stiffest);
  /// Whether springs replace its rows.
  [[nodiscard]] bool penalised() const { return held_by_ && !held_by_->compliance.isZero(0.0); }

  // Functions of an interaction item.
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] int history_size() const { return bend() + (parts_.equal_turns ? kBendSize : 0); }
  [[nodiscard]] bool lazy_history() const { return !resistance_ && !motion_ && !records_; }
  [[nodiscard]] bool conservative() const { return !resistance_ && !motion_; }
  [[nodiscard]] bool dissipates() const { return resistance_ != nullptr; }
  [[nodiscard]] bool works() const {
    return (resistance_ && resistance_->has_forces()) || penalised();
  }
  [[nodiscard]] bool compliant() const { return penalised(); }
  [[nodiscard]] bool has_barrier() const { return resistance_ && resistance_->has_barrier(); }
  [[nodiscard]] double clearance(const PairStep& step) const;
  void impacts(const PairStep& step, std::vector<Impact>& list) const;
  [[nodiscard]] int unilateral() const { return resistance_ ? resistance_->rows() : 0; }
  [[nodiscard]] int unilateral_entry() const {
    return unilateral() > 0 ? angles() + resistance_->row_entry() : -1;
  }
  void unilateral_rows(const PairStep& step, std::vector<UnilateralRow>& list) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  [[nodiscard]] double reach() const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  [[nodiscard]] bool piecewise() const { return resistance_ && resistance_->data().friction; }
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const {
    return motion_ ? motion_->time_functions() : std::vector<TimeFunctionPtr>();
  }
  [[nodiscard]] int time_order() const { return 0; }
  [[nodiscard]] bool prescribes() const { return motion_ != nullptr; }
  void prescribed(const PairStep& step, TimeSide side, PrescribedRows& rows) const;
  [[nodiscard]] int work_entry() const { return motion_ ? angles() : -1; }
  [[nodiscard]] ImpulseSum impulse_sum() const {
    return !records_ ? ImpulseSum::none : reversed_ ? ImpulseSum::on_a : ImpulseSum::on_b;
  }
  [[nodiscard]] int impulse_entry() const { return records_ ? record() : -1; }
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void commit_off(const PairStep& step, double* history) const { count_turns(step, history); }
  /// Activates the joint; a fixed joint keeps its sides at their present relative position.
  void switch_on(const PairStep& step, double* history) const;
  [[nodiscard]] bool acceptable(const PairStep& step) const;
  /// A frame that is driven by whole turns leaves no trace in the rows.
  [[nodiscard]] bool always_queried() const {
    return motion_ && motion_->rotation != FrameMotion::Rotation::none;
  }
  [[nodiscard]] const char* refusal() const {
    return always_queried()
               ? "reached the mirror image of its assembly, or is driven by half a turn in one step"
               : InteractionItem::refusal();
  }
  [[nodiscard]] std::optional<MotionBasis> motion_basis() const;
  [[nodiscard]] Coupling coupling() const {
    return resistance_ || held_by_ || parts_.planes > 0 || parts_.distance ? Coupling::all
           : parts_.turns()                                                ? Coupling::couple
                                                                           : Coupling::none;
  }
  [[nodiscard]] bool reversible() const;
  void reverse();

  /// Angle about the common axis of the two sides, in the user's order; nothing if the joint keeps
  /// no two axes parallel or leaves no angle free.
  [[nodiscard]] std::optional<FreeAngle> axis_angle() const;

  /// A free coordinate by its name among coordinate_names(), in the user's order; "" for the only
  /// one of its kind. Nothing if there is none, or it is one of three free rotations.
  [[nodiscard]] std::optional<FreeAngle> free_angle(const std::string& coordinate) const;
  [[nodiscard]] std::optional<FreeDisplacement> free_displacement(
      const std::string& coordinate) const;

  // Names of the free coordinates, for reports; `step` of reports is in the solver's order, values
  // are at t_{n+1}. x, y, z are displacements along the axes of a, rx, ry, rz rotations. Three free
  // rotations are the components in a's axes of the rotation vector, their rates those of the
  // relative angular velocity; the two of equal turns are those of the rotation vector, whose z
  // component is zero. Rods have angles, a link its distance, and a distance joint has none.
  [[nodiscard]] std::vector<std::string> coordinate_names() const;
  /// Free coordinates of b's frame relative to a's. @param step  With the current history.
  [[nodiscard]] JointCoordinates coordinates(const PairStep& step) const;
  /// Constraint values, rows() of them [m or -].
  [[nodiscard]] Vec6 residual(const PairStep& step) const;
  /// Wrench of a on b by the multipliers of `step`, at its joint point on b.
  /// @param joint_axes  Components along the axes of a's joint frame; else of the world.
  [[nodiscard]] Reaction reaction(const PairStep& step, bool joint_axes) const;

 private:
  /// History of a joint that may be switched on at another position: whether it was, and the frame
  /// on b.
  enum Anchor : int { kAnchored, kAnchorZ, kAnchorR = kAnchorZ + 3, kAnchorSize = kAnchorR + 9 };
  [[nodiscard]] bool anchors() const {
    return switching != Switching::never && parts_.coincident && parts_.axes == 3 && !motion_;
  }
  /// Offset of the anchor in the history.
  [[nodiscard]] int anchor() const {
    return angles() + (resistance_ ? resistance_->memory_size() : 0) + (motion_ ? 1 : 0);
  }
  /// Offset of the impulses in the history.
  static constexpr int kRecordSize = 6;
  [[nodiscard]] int record() const { return anchor() + (anchors() ? kAnchorSize : 0); }
  /// Offset in the history of (w, x, y) of the relative quaternion of equal turns, which continues
  /// through every position and so fixes the sign of the row.
  static constexpr int kBendSize = 3;
  [[nodiscard]] int bend() const { return record() + (records_ ? kRecordSize : 0); }
  [[nodiscard]] Vec3 bend(const PairStep& step) const;
  /// Frames valid in this step. @param own  Storage for them.
  [[nodiscard]] const JointFrames& held_frames(const PairStep& step, JointFrames& own) const;
  void count_turns(const PairStep& step, double* history) const;
  [[nodiscard]] int angles() const;            ///< Number of coordinates with counted turns.
  [[nodiscard]] FreeAngle angle(int i) const;  ///< i-th of them, user's order.
  [[nodiscard]] bool translation_free(int user_axis) const;
  [[nodiscard]] Configuration at_n1(const PairStep& step) const;
  /// Configuration at t_n, with the frame on a displaced by its motion.
  [[nodiscard]] Configuration at_n(const PairStep& step) const;
  [[nodiscard]] Vec6 residual(const Configuration& q) const;
  /// Sides at t_{n+αf} and t_{n+1}, as far as the parts need them.
  void arrange(const PairStep& step, Configuration& q_alpha, Configuration& q_n1) const;
  /// γ without the accelerations of a moving frame. @param frame  Its velocities.
  [[nodiscard]] Vec6 velocity_terms(const PairStep& step, const FrameRates& frame) const;
  /// γ of the prescribed motion.
  [[nodiscard]] Vec6 acceleration_terms(const PairStep& step, TimeSide side) const;
  /// Replaces rows by springs, or weights exact ones.
  void soften(const PairStep& step, PairTerms& terms) const;
  /// Energy of the springs at t_{n+1} [J].
  [[nodiscard]] double spring_energy(const PairStep& step) const;
  /// Work of the prescribed motion over the step by unit multipliers.
  [[nodiscard]] Vec6 drive_increments(const PairStep& step) const;
  /// Result of with(a, b) for the sides in the user's order; a moving frame is taken at rest on its
  /// side.
  template <class With>
  auto with_sides(const PairStep& step, With&& with) const;
  /// Calls what(view) with the data that the resistance needs.
  template <class What>
  auto with_view(const PairStep& step, What&& what) const;
  [[nodiscard]] Mat3 relative_turn(const BodyStep& a, const BodyStep& b) const;
  [[nodiscard]] JointCoordinates coordinates(const BodyStep& a, const BodyStep& b,
                                             const double* history) const;

  JointFrames frames_;
  JointParts parts_;
  int rows_ = 0, shift_ = 0;
  RodKind rod_ = RodKind::none;
  bool reversed_ = false, records_ = false;
  JointFrames user_frames_;  ///< As frames_ before any reversal.
  std::string type_;
  std::shared_ptr<const Resistance> resistance_;
  std::shared_ptr<const FrameMotion> motion_;
  struct Held {
    Vec6 compliance;  ///< Of springs, else zero [m/N] or [1/(N m)].
    Vec6 weight;      ///< As in PairTerms.
  };
  std::shared_ptr<const Held> held_by_;
};

}  // namespace polhode
