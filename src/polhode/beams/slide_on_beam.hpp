// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/beams/beam_curve.hpp>
#include <polhode/beams/node_row.hpp>
#include <polhode/core/time_function.hpp>
#include <polhode/system/changing_sparsity.hpp>
#include <polhode/system/element_group.hpp>
#include <polhode/system/internal_unknowns.hpp>

namespace polhode {

/// Description of a point that slides along a beam.
struct SlideOnBeamSpec {
  std::string name, beam;  ///< As in the user's file.
  /// Nodes of the System bonded to each of the beam's nodes, from its start: at its centre, and at
  /// the distance `tip` from there along x, y, z of its section.
  std::vector<std::array<int, 4>> nodes;
  double tip = 1.0;             ///< [m]
  std::vector<double> lengths;  ///< Of the beam's elements, unstressed [m].
  int point = 0;                ///< Node of the System bonded to the body that slides.
  double start = 0.0;           ///< Position along the beam at the start [m].
  /// Elastic stiffness of an element and mass of a node of the beam, by their order of magnitude:
  /// for the scale of iterations [N/m], [kg].
  double element_stiffness = 0.0, node_mass = 0.0;
  double stiffness = 0.0, free_position = 0.0;  ///< Of a spring along the beam [N/m], [m].
  double damping = 0.0;                         ///< Along the beam [N s/m].
  TimeFunctionPtr force;                        ///< On the body, along the beam; null: none [N].
  TimeFunctionPtr position;                     ///< Along the beam; null: free [m].
};

/// State of a point that slides along a beam, at an instant.
struct SlideReport {
  Vec3 tangent = Vec3::Zero();         ///< Of the beam there, unit, world.
  double position = 0.0, speed = 0.0;  ///< Along the beam, unstressed [m], [m/s].
  double energy = 0.0;                 ///< Of its spring [J].
};

/// A joint that keeps a point of a body on the centre line of a beam, free along it.
///
/// Its unknowns are the position s along the beam and three multipliers. With x_b the point, X the
/// beam's curve (BeamCurve) and d_k the axes of one node of the beam,
///
///   g_k = d_k·(x_b − X(s)) = 0   (k = 1, 2, 3),   F·T + ... = Q,   F = Σ λ_k d_k,
///
/// the last of which is the balance along the beam: no force F along the tangent T besides
/// the force Q of springs and drives along it. Forces are the gradient of g at mean positions and
/// mean weights of nodes, T is the divided difference of the curve at mean positions: in this form
/// energy and both momenta are conserved exactly at ρ∞ = 1, at any step and across nodes of the
/// beam. @eq{slide-rows} @eq{slide-along}
///
/// The four unknowns are eliminated within the element. So that this is possible, iterations are
/// proximal in λ: ε(λ − λ of the iterate before) is added to g. What converges is g = 0.
class SlideOnBeam final : public ElementGroup, public InternalUnknowns, public ChangingSparsity {
 public:
  static constexpr const char* kKind = "slide_on_beam";
  explicit SlideOnBeam(SlideOnBeamSpec spec);

  [[nodiscard]] std::string kind() const override { return kKind; }
  [[nodiscard]] const std::string& name() const override { return spec_.name; }
  [[nodiscard]] int size() const override { return 0; }  // its blocks are of ChangingSparsity
  [[nodiscard]] int nodes_per_element() const override { return 1; }
  [[nodiscard]] std::span<const int> nodes(int) const override { return {}; }
  [[nodiscard]] bool has_tangent() const override { return false; }
  [[nodiscard]] bool conservative() const override {
    return !dissipates() && !spec_.force && !spec_.position;
  }
  [[nodiscard]] bool dissipates() const override { return spec_.damping > 0.0; }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const override {
    return {spec_.force, spec_.position};
  }
  [[nodiscard]] std::size_t history_size() const override;
  [[nodiscard]] std::size_t scratch_size() const override;
  [[nodiscard]] const InternalUnknowns* internal_unknowns() const override { return this; }
  [[nodiscard]] const ChangingSparsity* changing_sparsity() const override { return this; }

  void initialize(double* history) const override;
  void begin_step(const double* history, double* scratch) const override;
  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  double advance(const double* du, const Mat3& turn, double* scratch) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  [[nodiscard]] Work work(const NodeStep& step, const double* history,
                          const double* scratch) const override;

  // InternalUnknowns: λ and s.
  [[nodiscard]] std::size_t unknowns_size() const override { return 4; }
  void get_unknowns(const double* scratch, double* unknowns) const override;
  void set_unknowns(const double* unknowns, double* scratch) const override;
  [[nodiscard]] double difference(const double* history, const double* other) const override;

  // ChangingSparsity: nodes near the body.
  [[nodiscard]] const std::vector<int>& reach() const override { return reach_; }
  [[nodiscard]] const NodeBlocks& blocks(const double* history) const override;
  void renew(const NodeStep&, double*) const override {}

  /// Reason to refuse a step that has converged: the point left the beam; empty: none.
  [[nodiscard]] std::string refusal(const double* scratch) const;
  /// Appends the rows of an instant, with the velocities there: two across the beam, and one along
  /// it if the position is prescribed.
  void rows(const NodeStep& instant, const double* history, std::vector<NodeRow>& list) const;

  [[nodiscard]] SlideReport report(const NodeStep& instant, const double* history) const;
  [[nodiscard]] const SlideOnBeamSpec& spec() const { return spec_; }
  [[nodiscard]] const BeamCurve& curve() const { return curve_; }
  /// Place on the curve nearest to a point. @param x  Positions of the nodes, three each.
  [[nodiscard]] double nearest(const double* x, const Vec3& point) const;
  [[nodiscard]] Vec3 place(const double* x, double s, int order) const;

 private:
  struct History;
  struct Scratch;
  struct Local;
  struct Window {
    int first = -1, last = -1;  ///< Nodes of the beam.
    std::vector<int> nodes;     ///< Of the System, ascending.
    NodeBlocks blocks;
  };
  /// Q over a step, with its derivatives by s_{n+1} and by the relative velocity times its tangent.
  struct Along {
    double value = 0.0, by_s = 0.0, by_velocity = 0.0;
  };
  struct Instant;
  [[nodiscard]] const Window& window(const double* history) const;
  [[nodiscard]] double follow(const double* x, const Vec3& point, double s) const;
  void begin_search(const NodeStep& step, const History& h, Scratch& y) const;
  [[nodiscard]] double position_at(const NodeStep& step) const;
  [[nodiscard]] double proximal(const NodeStep& step) const;
  [[nodiscard]] Along along(const NodeStep& step, double s_n, double s, const Local& l) const;
  [[nodiscard]] static double position(const double* history);
  [[nodiscard]] Instant at_instant(const NodeStep& instant, double near) const;
  [[nodiscard]] double present_force(const NodeStep& instant, const Instant& i) const;
  void add_present_force(const NodeStep& instant, double s, const ElementSink& sink) const;
  [[nodiscard]] NodeRow row_along(double s, const Vec3& n) const;

  SlideOnBeamSpec spec_;
  BeamCurve curve_;
  std::vector<int> reach_;
  mutable Window window_;  ///< The last one asked for.
};

/// A group of elements as a SlideOnBeam; null if it is of another kind.
[[nodiscard]] inline const SlideOnBeam* as_slide(const ElementGroup& group) {
  return group.kind() == SlideOnBeam::kKind ? static_cast<const SlideOnBeam*>(&group) : nullptr;
}

}  // namespace polhode
