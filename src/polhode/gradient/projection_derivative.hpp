// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/gradient/instant_rows.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

/// A row J that a velocity jump d ends: J (v + d) + e J v = 0. @eq{impact-derivative}
struct StageImpact {
  InstantRow row;
  double impulse = 0.0;  ///< Scaled, as multipliers.
};

/// A linear system of a projection, [M −Gᵀ; G ε] x = b, at its solution.
struct ProjectionStage {
  State at;                 ///< Where M and G are those of its bodies.
  Vec x;                    ///< Displacements or jumps by body, world, then multipliers, scaled.
  bool velocities = false;  ///< Jumps of velocities; else displacements.
  double epsilon = 0.0;
  /// Row whose value sets ε, which grows with its square; −1: ε is constant.
  int largest_row = -1;
  double largest = 0.0;  ///< Its value [m or -].
  std::optional<StageImpact> impact = {};
};

/// Numbers of a projection's stage that depend on parameters: those of [M −Gᵀ; G ε] x − b at fixed
/// x, and the relative change of ε, or the value of the row of an impact.
[[nodiscard]] int stage_inputs(const System& system);

/// Terms of a stage at a fixed solution: M d − Gᵀ μ by body in units of the mean mass, and G d + g
/// or G (v + d) − ċ by row; the relative change of ε is left zero.
/// @param bodies  Those that count. @param rows  Of the interactions that count.
/// @param unit_mass  m_ref of the stage [kg].
void stage_terms(const System& system, const ProjectionStage& stage,
                 const std::vector<double>& history, const std::vector<int>& bodies,
                 InteractionSweep& rows, double unit_mass, Vec& out);
/// Adds those of its impact. @param row  In the model of the terms.
void add_impact_terms(const System& system, const ProjectionStage& stage, const InstantRow& row,
                      Vec& out);

/// The derivative of the projection of positions onto g = 0 and of velocities onto G v = 0 behind
/// an extrapolated step, as an implicit function of what is projected. Each iteration of the
/// positions is one, since their result depends on all of them. @eq{projection-derivative}
class ProjectionDerivative {
 public:
  explicit ProjectionDerivative(const System& system);

  /// Projects a state, and factors the derivative.
  void linearize(const State& given);
  /// Projects, instead of that, the velocities alone.
  void linearize_velocities(const State& given);
  /// Projects, instead of that, the velocities of the bodies that joints tie to a row, which then
  /// jump by its impact, without friction. @param rows  Of the system.
  void linearize_impact(const State& given, InstantRows& rows, const InstantRow& row);
  [[nodiscard]] const State& projected() const { return projected_; }
  [[nodiscard]] const std::vector<ProjectionStage>& stages() const { return stages_; }
  /// Number of all inputs, see stage_inputs().
  [[nodiscard]] int inputs() const;
  /// Largest remainder of a solution so far, as a part of the terms of its right-hand side [-].
  [[nodiscard]] double defect() const { return defect_; }

  /// From the derivative of what is given to that of the projected state. @param by_parameter
  /// Derivative of the inputs, times that of the parameter.
  void push(const Vec& by_parameter, Vec& dy);
  /// From weights of the projected state to those of what is given. @returns weights of the inputs.
  Vec pull(Vec& mu);

 private:
  /// Factors and second derivatives of a stage.
  struct Linear {
    std::unique_ptr<linear::LinearSolver> solver;
    linear::KktValues values;  ///< M and G.
    linear::KktValues by_q;    ///< Of the terms by (dr, dφ), at fixed x.
    /// Derivative of the terms of an impact by (dr, dφ) of its two bodies.
    Eigen::Matrix<double, 12, 12> impulse_by_q;
    Eigen::Matrix<double, 12, 1> speed_by_q;
  };
  void add_stage(const State& at, bool velocities);
  void tie_bodies(const InstantRow& row);
  void differentiate_impact(const ProjectionStage& stage, InstantRows& rows, Linear& l) const;
  void jump(const Vec& x);
  /// Solves with the row of an impact. @param of_row  Its right-hand side, 0 if transposed.
  /// @param impulse  The last unknown.
  [[nodiscard]] Vec solve_impact(const ProjectionStage& stage, const Linear& l, const Vec& rhs,
                                 double of_row, double size, bool transposed, double& impulse);
  void put_masses(const State& at, linear::KktValues& values) const;
  void differentiate_places(const ProjectionStage& stage, Linear& l) const;
  /// @param size  Of the terms of which the right-hand side is the sum, which may nearly cancel.
  [[nodiscard]] Vec solve(const ProjectionStage& stage, const Linear& l, const Vec& rhs,
                          double size, bool transposed);
  [[nodiscard]] bool takes_part(int body) const {
    return ties_.empty() || ties_[static_cast<std::size_t>(body)] != 0;
  }
  /// Solution with an impact, of right-hand sides without it. @param dq, dv  Of the bodies, world.
  /// @param input  Derivative of the row's terms by the parameter.
  [[nodiscard]] Vec push_impact(const ProjectionStage& stage, const Linear& l, const Vec& dq,
                                const Vec& dv, double input, Vec rhs, double size);
  /// Adds the transposed terms of the row. @param of_row  Weight of its right-hand side.
  void pull_impact(const ProjectionStage& stage, const Linear& l, const Vec& x, double of_row,
                   Vec& of_q, Vec& of_v) const;
  void push_positions(std::size_t stage, const Vec& inputs, Vec& dy);
  void push_velocities(std::size_t stage, const Vec& inputs, Vec& dy);
  void pull_positions(std::size_t stage, Vec& mu, Eigen::Ref<Vec> eta);
  void pull_velocities(std::size_t stage, Vec& mu, Eigen::Ref<Vec> eta);

  const System* system_;
  KktMap map_;
  InstantSolver projector_;
  InteractionSweep sweep_;
  State projected_;
  std::vector<ProjectionStage> stages_;
  std::vector<Linear> linear_;
  std::vector<char> ties_;  ///< By body: whether its velocity takes part; empty: all.
  double defect_ = 0.0;
};

}  // namespace polhode
