// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/kkt_matrix.hpp>
#include <polhode/newton/tangent_check.hpp>

namespace polhode {

namespace {

/// Displacement of the differences, in units of ℓ and of a radian: truncation 1e-10 of the third
/// derivative, rounding 1e-11 of the residual.
constexpr double kDisplacement = 1e-5;

/// The trial that goes on with the velocities of the state.
Trial sample_trial(const System& system, const State& state, double dt, double rho_inf) {
  Trial trial;
  trial.context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
  trial.context.t_n = state.t;
  trial.context.dt = dt;
  start_trial(system, state, trial);
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    move_body(state, trial, system.slot(b), dt * m.v, dt * m.omega());
  }
  if (std::all_of(trial.lambda.begin(), trial.lambda.end(), [](double l) { return l == 0.0; })) {
    const double weight = system.mean_mass() * std::max(1.0, system.gravity().norm());
    for (int row = 0; row < system.rows(); ++row)
      trial.lambda[row] = (row % 2 == 0 ? 1.0 : -0.5) * weight;
  }
  return trial;
}

class Comparison {
 public:
  Comparison(const System& system, const State& state, double dt, double rho_inf, MomentumRate form)
      : system_(system),
        state_(state),
        trial_(sample_trial(system, state, dt, rho_inf)),
        newton_(system, form),
        matrix_(newton_.topology()) {
    newton_.assemble(state, trial_, true);
    matrix_.set(newton_.values());
    measure_rows();
  }

  /// Columns of one body's displacement and rotation.
  void move(int body) {
    const BodyStep at = body_step(system_, state_, trial_, body);
    const double length = system_.length_scale();
    for (int i = 0; i < 6; ++i) {
      const double unit = i < 3 ? length : 1.0;
      const auto residual = [&](double h) {
        const Vec3 d = h * unit * Vec3::Unit(i % 3);
        move_body(state_, trial_, system_.slot(body), i < 3 ? Vec3(at.u + d) : at.u,
                  i < 3 ? at.theta : compose_cayley(d, at.theta));
        return scaled_residual();
      };
      const Vec numeric =
          (residual(kDisplacement) - residual(-kDisplacement)) / (2.0 * kDisplacement);
      compare(6 * body + i, numeric, unit);
    }
    move_body(state_, trial_, system_.slot(body), at.u, at.theta);
  }
  /// Column of a multiplier, which is linear.
  void pull(int row) {
    const double s = trial_.scale(system_), lambda = trial_.lambda[row];
    trial_.lambda[row] = lambda + 0.5 / s;
    const Vec ahead = scaled_residual();
    trial_.lambda[row] = lambda - 0.5 / s;
    const Vec numeric = ahead - scaled_residual();
    trial_.lambda[row] = lambda;
    compare(6 * system_.body_count() + row, numeric, 1.0);
  }

  [[nodiscard]] TangentReport report() const {
    TangentReport report = worst_;
    if (row_ >= 0) {
      report.row = name(row_, {"force", "moment"}, "row");
      report.column = name(column_, {"displacement", "turn about"}, "multiplier");
    }
    return report;
  }

 private:
  Vec scaled_residual() {
    newton_.assemble(state_, trial_, false);
    return -newton_.right_hand_side();
  }
  [[nodiscard]] double column_unit(int column) const {
    return column < 6 * system_.body_count() && column % 6 < 3 ? system_.length_scale() : 1.0;
  }
  void measure_rows() {
    row_size_ = Vec::Zero(matrix_.size());
    for (int j = 0; j < matrix_.size(); ++j)
      for (int k = matrix_.column_start()[j]; k < matrix_.column_start()[j + 1]; ++k) {
        double& size = row_size_[matrix_.row_index()[k]];
        size = std::max(size, std::abs(column_unit(j) * matrix_.values()[k]));
      }
  }
  void compare(int column, const Vec& numeric, double unit) {
    Vec analytic = Vec::Zero(matrix_.size());
    for (int k = matrix_.column_start()[column]; k < matrix_.column_start()[column + 1]; ++k)
      analytic[matrix_.row_index()[k]] = unit * matrix_.values()[k];
    for (int i = 0; i < matrix_.size(); ++i) {
      const double size = std::max({row_size_[i], std::abs(numeric[i]), 1e-6});
      const double error = std::abs(analytic[i] - numeric[i]) / size;
      if (error <= worst_.error) continue;  // a NaN goes on and stays
      worst_.error = error;
      worst_.analytic = analytic[i];
      worst_.numeric = numeric[i];
      row_ = i;
      column_ = column;
    }
  }
  [[nodiscard]] std::string name(int i, std::pair<const char*, const char*> of_body,
                                 const char* of_row) const {
    const int bodies = 6 * system_.body_count();
    if (i < bodies)
      return format("{} {} of body '{}'", i % 6 < 3 ? of_body.first : of_body.second, "xyz"[i % 3],
                    system_.bodies()[i / 6].name);
    for (const InteractionRef& ref : system_.interactions())
      if (i - bodies >= ref.first_row && i - bodies < ref.first_row + ref.rows)
        return format("{} {} of {} '{}'", of_row, i - bodies - ref.first_row + 1,
                      system_.group(ref.group).kind(), system_.name(ref));
    return "?";
  }

  const System& system_;
  const State& state_;
  Trial trial_;
  NewtonSystem newton_;
  KktMatrix matrix_;
  Vec row_size_;
  TangentReport worst_;
  int row_ = -1, column_ = -1;
};

}  // namespace

std::string TangentReport::text() const {
  if (row.empty()) return "the tangent agrees exactly with differences of the residual";
  return format(
      "largest difference between tangent and differences of the residual: {:.1e} of its row, "
      "{} by {}: {:.9g} against {:.9g}",
      error, row, column, analytic, numeric);
}

TangentReport check_tangents(const System& system, const State& state, double dt, double rho_inf,
                             MomentumRate form, int most_bodies) {
  Comparison comparison(system, state, dt, rho_inf, form);
  const int bodies = system.body_count();
  const int every = std::max(1, (bodies + most_bodies - 1) / std::max(1, most_bodies));
  int moved = 0;
  for (int b = 0; b < bodies; b += every, ++moved) comparison.move(b);
  for (int row = 0; row < system.rows(); row += every) comparison.pull(row);
  TangentReport report = comparison.report();
  report.bodies_moved = moved;
  return report;
}

}  // namespace polhode
