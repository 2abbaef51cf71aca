// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A gear: two coordinates with counted turns in a ratio, x_0 = ratio·x_1 + constant, as one row
/// with the sum of their discrete gradients, so that it does no work at ρ∞ = 1. @eq{gear-row}
///
/// The coordinates are those of joints if at most two moving bodies take part. Wheels on a moving
/// carrier refer to each other: their angles are counted from the line of centres or, if their axes
/// are not parallel, from the other's axis. @eq{gear-angle}
class Gear : public InteractionItem {
 public:
  static constexpr const char* kKind = "gear";
  /// @param load  Its gear pair; value ratio [-], or radius [m] where x_0 is a displacement.
  explicit Gear(const LoadDescription& load);

  [[nodiscard]] int rows() const { return 1; }
  [[nodiscard]] int history_size() const { return kHistory; }
  [[nodiscard]] Coupling coupling() const { return Coupling::all; }
  [[nodiscard]] bool holds_ground() const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force or moment on the second body along x_0, and that along x_1;
  /// changes of x_0 and x_1 since the start; power from x_0 to x_1 [W].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  /// Activates the gear; its coordinates count from their present values.
  void switch_on(const PairStep& step, double* history) const { initialize(step, history); }

 private:
  /// Layout of the history: coordinates at t_n and at the start, the radii of their angles, and 1
  /// once these are known.
  enum History : int { kNow = 0, kFirst = 2, kRadius = 4, kStarted = 6, kHistory };

  [[nodiscard]] CoordinateMotion coordinate(int i, const PairStep& step) const;
  [[nodiscard]] double rate(int i, const PairStep& step) const;
  [[nodiscard]] double acceleration(int i, const PairStep& step) const;

  GearPair pair_;
  double ratio_;
};

/// A screw: the displacement of a cylindrical joint is pitch/2π times its angle.
struct Screw : Gear {
  static constexpr const char* kKind = "screw";
  /// @param load  Its gear pair, displacement and angle; value pitch [m].
  explicit Screw(const LoadDescription& load);
};

/// Adds a gear or a screw to the system.
void add_gear(System& system, const LoadDescription& load);
void add_screw(System& system, const LoadDescription& load);

}  // namespace polhode
