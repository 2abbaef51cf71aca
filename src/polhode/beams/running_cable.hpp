// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <polhode/beams/cable_friction.hpp>
#include <polhode/beams/hill_muscle.hpp>
#include <polhode/beams/running_cable_report.hpp>
#include <polhode/beams/wound_span.hpp>
#include <polhode/core/time_function.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// Description of a cable that runs over its points.
struct RunningCableSpec {
  std::string name;
  std::vector<int> nodes;    ///< Of the System, bonded to bodies, from end to end.
  double stiffness = 0.0;    ///< Force per elongation; 0: none [N/m].
  double free_length = 0.0;  ///< [m]
  double damping = 0.0;      ///< Force per rate of elongation, while taut [N s/m].
  bool tension_only = true;  ///< Slack when shorter than its free length.
  TimeFunctionPtr tension;   ///< Additional tension; null: none [N].
  std::optional<HillMuscle> muscle;
  double friction = 0.0;  ///< On each point between the ends: coefficient μ [-].
  /// Wrap angles about these points in addition to the cable's change of direction [rad].
  std::vector<double> wrapped;
  std::vector<double> pieces;         ///< With friction: free lengths from point to point [m].
  std::vector<WindingSpec> windings;  ///< Obstacles, at most one in a span.
};

/// Line of a running cable at an instant, with pieces on obstacles.
struct CableLineNow {
  std::vector<Vec3> points;     ///< World [m].
  std::vector<double> lengths;  ///< Of the pieces between them, along the cable [m].
  /// Obstacle of each point, or one of these.
  std::vector<int> winding;
  static constexpr int kPoint = -1;  ///< A point of the cable.
  static constexpr int kFree = -2;   ///< Of a straight span past an obstacle.
};

/// A massless cable that runs over points of any number of bodies: one tension N in all its spans,
/// a function of its total length L = Σ l_i, its rate and time. With friction N is the mean of the
/// spans' tensions, see CableFriction.
///
/// The force on a point between two spans is N (n_i − n_{i−1}), n_i = u_{i,α}/l_{i,α}, with
/// discrete gradients of the lengths of the spans: ΔL = Σ n_i·Δu_i. With the mean of its elastic
/// tension over the step a cable conserves its energy exactly at ρ∞ = 1. @eq{running-cable}
class RunningCable : public ElementGroup {
 public:
  /// @throws InputError for invalid numbers.
  explicit RunningCable(RunningCableSpec spec);

  /// "running cable", and the names of its obstacles.
  [[nodiscard]] std::string kind() const override;
  /// Least volume of a trial step in which a point is inside of an obstacle, or the cable comes to
  /// its other side.
  static constexpr double kNoLine = -1e300;
  [[nodiscard]] const std::string& name() const override { return spec_.name; }
  [[nodiscard]] int size() const override { return 1; }
  [[nodiscard]] int nodes_per_element() const override { return static_cast<int>(nodes_.size()); }
  [[nodiscard]] std::span<const int> nodes(int) const override { return nodes_; }
  [[nodiscard]] bool conservative() const override {
    return !dissipates() && !spec_.tension && !spec_.muscle;
  }
  [[nodiscard]] bool dissipates() const override {
    return spec_.damping > 0.0 || spec_.muscle || friction_;
  }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const override;
  /// With friction: deviation of each span's tension from the mean [N].
  [[nodiscard]] std::size_t history_size() const override {
    return friction_ ? spec_.nodes.size() - 1 : 0;
  }
  [[nodiscard]] bool piecewise() const override {
    return (spec_.tension_only && spec_.stiffness > 0.0) || !spec_.windings.empty();
  }
  void pieces(const NodeStep& instant, const double* history, ForcePieces& pieces) const override;
  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  [[nodiscard]] Work work(const NodeStep& step, const double* history,
                          const double* scratch) const override;

  [[nodiscard]] RunningCableReport report(const NodeStep& instant, const double* history) const;
  /// Its line at an instant.
  [[nodiscard]] CableLineNow line(const NodeStep& instant) const;

 private:
  struct Span {
    Vec3 n = Vec3::Zero();     ///< Discrete gradient of its length by the second point.
    Vec3 e = Vec3::Zero();     ///< Direction at t_{n+1}.
    Vec3 rate = Vec3::Zero();  ///< Derivative of the cable's rate by the second point [1/s].
    double per_length = 0.0;   ///< 1/l_α; 0: no direction.
    double change = 0.0;       ///< Of its length [m].
    int wound = -1;            ///< Its entry in Course::wound; then the other members are zero.
  };
  /// A span that touches an obstacle in the step.
  struct Wound {
    int winding = 0;
    WoundSpan span;
  };
  /// The whole cable over the step.
  struct Course {
    std::vector<Span> spans;
    std::vector<Wound> wound;
    std::vector<int> wound_of;  ///< Of each span: its entry there, −1: none. Empty: none at all.
    bool refused = false;       ///< A point is inside of an obstacle, or the cable jumps over it.
    double n = 0.0, n1 = 0.0;   ///< Length at t_n, t_{n+1} [m].
    double change = 0.0;        ///< Of the length, without cancellation [m].
    double rate = 0.0;          ///< At t_{n+αf} [m/s].
  };
  /// Parts of the tension, and the derivatives of their sum by L_{n+1} and by the rate.
  struct Tension {
    double elastic = 0.0, damper = 0.0, active = 0.0, by_n1 = 0.0, by_rate = 0.0;
    [[nodiscard]] double sum() const { return elastic + damper + active; }
  };
  /// Tensions of the spans with friction.
  struct Grip {
    CableFriction::Held held;
    Mat by_change;  ///< Of the trial, by the changes of the spans' lengths [N/m].
    Vec parts;      ///< At t_{n+1}, in addition to the mean [N].
    /// By point: derivative of the turning angle by the first span vector [1/m].
    std::vector<Vec3> turn_first;
    std::vector<Vec3> turn_second;  ///< Likewise, by the second span vector.
  };
  /// A force as a function of the length: value and slope.
  struct Law {
    double value = 0.0, slope = 0.0;
  };
  [[nodiscard]] Course course(const NodeStep& step, bool tangents = false) const;
  void add_windings();
  /// Adds spans around obstacles to a course.
  void add_wound(const NodeStep& step, bool tangents, Course& c) const;
  /// Nodes of the System, and of the element, of an obstacle's span.
  [[nodiscard]] WoundNodes wound_nodes(int winding) const;
  [[nodiscard]] WoundNodes wound_places(int winding) const;
  [[nodiscard]] Tension tension(const NodeStep& step, const Course& c) const;
  /// @param mean  Tension N̄ [N].
  [[nodiscard]] Grip grip(const NodeStep& step, const Course& c, double mean,
                          const double* history) const;
  /// Derivatives of the spans' tensions by the nodes at t_{n+1}, one row each [N/m].
  /// @param of_mean  Those of N̄.
  [[nodiscard]] Mat tension_by_nodes(const Grip& g, const Course& c, const Vec& of_mean) const;
  [[nodiscard]] Vec parts_of(const double* history) const {
    return Eigen::Map<const Vec>(history, static_cast<Eigen::Index>(history_size()));
  }
  void add_friction();
  /// Elastic force at a length, including the passive one of a muscle.
  [[nodiscard]] Law elastic(double length) const;
  [[nodiscard]] double energy(double length) const;
  [[nodiscard]] bool taut(double length) const {
    return !spec_.tension_only || length > spec_.free_length;
  }
  /// Fibres at a length of the whole muscle.
  struct Fibre {
    double length = 0.0;  ///< Over the optimal one [-].
    double cosine = 1.0;  ///< Of the pennation: derivative of their length by that of the muscle.
    double bend = 0.0;    ///< Derivative of the cosine by the muscle's length [1/m].
  };
  [[nodiscard]] Fibre fibre(double length) const;

  RunningCableSpec spec_;
  std::vector<int> nodes_;       ///< Points, then the frames of the obstacles.
  std::vector<int> winding_of_;  ///< Of each span, −1: none.
  std::optional<CableFriction> friction_;
};

}  // namespace polhode
