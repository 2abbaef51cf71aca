// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/kkt_matrix.hpp>
#include <polhode/simulation/method.hpp>

#include "engine.hpp"

namespace polhode::python {

namespace {

/// Residual and tangent of one step from the present state, at an iterate.
///
/// @param x  Displacement and Cayley vector of each moving body over the step, then multipliers;
/// none: the
///           predictor with the present velocities.
/// @returns residual, column starts, rows and values of the tangent, x, numbers of moving bodies.
nb::tuple step_equations(Engine& engine, double dt, const std::optional<std::vector<double>>& x) {
  const Engine::Use used = engine.use();
  Simulation& simulation = *used;
  const Model& model = engine.model();
  if (model.analysis.type != "dynamics" || !model.solids.empty() || simulation.has_contacts())
    throw InputError(
        "step_equations",
        "are available only for bodies and joints in dynamics, without solids and contacts",
        "Leave these out of the model");
  const System& system = simulation.system();
  const State& state = simulation.state();
  const Method method = choose_method(system, model);
  Trial trial;
  trial.context.ga = method.ga;
  trial.context.conserving = method.control.conserving;
  trial.context.t_n = state.t;
  trial.context.dt = dt;
  start_trial(system, state, trial);
  const int bodies = system.body_count(), rows = system.rows(), size = 6 * bodies + rows;
  if (x && static_cast<int>(x->size()) != size)
    throw InputError("x", format("has {} numbers, not {}", x->size(), size),
                     "Give six for each moving body, and one for each multiplier");
  std::vector<double> at(static_cast<std::size_t>(size));
  if (x) at = *x;
  const auto part = [&](int i) { return Eigen::Map<Vec3>(at.data() + i); };
  for (int b = 0; b < bodies; ++b) {
    if (!x) {
      const BodyMotion m = system.motion(state, b);
      part(6 * b) = dt * m.v;
      part(6 * b + 3) = dt * m.omega();
    }
    move_body(state, trial, system.slot(b), part(6 * b), part(6 * b + 3));
  }
  for (int row = 0; row < rows; ++row) {
    double& lambda = at[static_cast<std::size_t>(6 * bodies + row)];
    if (!x) lambda = state.lambda[row];
    trial.lambda[row] = trial.lambda_centre[row] = lambda;
  }

  NewtonSystem newton(system, momentum_rate(model.analysis.momentum_rate));
  newton.assemble(state, trial, true);
  std::vector<double> residual;
  for (int b = 0; b < bodies; ++b)
    residual.insert(residual.end(), newton.body_residual(b).begin(), newton.body_residual(b).end());
  for (int row = 0; row < rows; ++row) residual.push_back(newton.row_residual(row));
  linear::KktMatrix matrix(newton.topology());
  matrix.set(newton.values());
  // The engine multiplies rows of bodies by s, and multipliers.
  const double s = trial.scale(system);
  std::vector<double> values = matrix.values();
  for (int j = 0; j < matrix.size(); ++j)
    for (int k = matrix.column_start()[j]; k < matrix.column_start()[j + 1]; ++k)
      values[k] *= (j < 6 * bodies ? 1.0 : s) / (matrix.row_index()[k] < 6 * bodies ? s : 1.0);
  const auto list = [](auto numbers) {
    const std::size_t n = numbers.size();
    return array_of(std::move(numbers), {n});
  };
  const auto whole = [&](const std::vector<int>& v) {
    return list(std::vector<std::int64_t>(v.begin(), v.end()));
  };
  std::vector<std::string> names;
  for (const BodyData& body : system.bodies()) names.push_back(body.name);
  return nb::make_tuple(list(std::move(residual)), whole(matrix.column_start()),
                        whole(matrix.row_index()), list(std::move(values)), list(std::move(at)),
                        nb::cast(names));
}

}  // namespace

void bind_equations(nb::module_& m) {
  m.def("step_equations", &step_equations, nb::arg("engine"), nb::arg("dt"), nb::arg("x").none());
}

}  // namespace polhode::python
