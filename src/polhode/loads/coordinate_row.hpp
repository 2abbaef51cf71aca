// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A part of a row between free coordinates of any joints, Σ fᵢ qᵢ = c: one coordinate, between the
/// bodies of its joint. The row's multiplier λ exerts the force or moment fᵢ λ along qᵢ, by the
/// discrete gradient of qᵢ, so that the whole row does no work at ρ∞ = 1. @eq{coupling-row}
class CoordinateRow : public InteractionItem {
 public:
  static constexpr const char* kKind = "coupling";
  /// @param load  With the value offset [m or rad], or without: that of the start.
  /// @param part  Which of its coordinates.
  CoordinateRow(const LoadDescription& load, std::size_t part);

  [[nodiscard]] int rows() const { return 1; }
  [[nodiscard]] int history_size() const { return kHistory; }
  [[nodiscard]] bool row_goes_on() const { return !last_; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  /// Report at an instant: force or moment along the coordinate, the coordinate with counted turns,
  /// and its rate.
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;

 protected:
  [[nodiscard]] const JointCoordinate& coordinate() const { return coordinate_; }
  /// The coordinate over the step.
  [[nodiscard]] CoordinateMotion motion(const PairStep& step) const {
    return coordinate_motion(coordinate_, step.a, step.b, at_n(step), step.context.conserving);
  }

 private:
  /// Layout of the history: the coordinate at t_n and at the start, and 1 once these are known.
  enum History : int { kNow, kFirst, kStarted, kHistory };

  /// Value at t_n to which turns are counted; near the model's start until they are.
  [[nodiscard]] double at_n(const PairStep& step) const {
    return step.history[kStarted] == 0.0 ? near_ : step.history[kNow];
  }

  JointCoordinate coordinate_;
  double factor_ = 1.0, near_ = 0.0;
  double offset_ = 0.0;  ///< c, in the first part.
  bool absolute_;        ///< c is given, and does not follow from the start.
  bool last_ = true;
};

/// Adds a part for each coordinate to the system, one after the other.
void add_coupling(System& system, const LoadDescription& load);

}  // namespace polhode
