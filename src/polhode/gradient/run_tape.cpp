// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/composition.hpp>
#include <polhode/gradient/run_tape.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/simulation/method.hpp>
#include <polhode/stepping/single_step.hpp>

namespace polhode {

namespace {

/// Largest memory for the states of a run [bytes].
constexpr double kMostMemory = 4e9;

}  // namespace

RunTape run_onto_tape(Simulation& simulation) {
  RunTape tape;
  const Model& model = simulation.model();
  const System& system = simulation.system();
  require_end(model.analysis);
  const double end = model.analysis.duration;
  Method method = choose_method(system, model);
  const int order = method.control.order;
  const std::vector<double> stages = order > 2
                                         ? composition_stages(order, order > 4 && system.rows() > 0)
                                         : std::vector<double>{1.0};
  std::unique_ptr<SingleStep> single;
  if (order > 2)
    single = std::make_unique<SingleStep>(system, std::move(method.engine), method.ga,
                                          *method.kernels, method.control.conserving);
  const State& start = simulation.state();
  const double bytes = static_cast<double>(start.blocks.size() * sizeof(BodyBlock) +
                                           8 * (start.lambda.size() + start.history.size()));
  const double needed = bytes * static_cast<double>(stages.size()) * end / *model.analysis.step;
  if (needed > kMostMemory)
    throw InputError("analysis.duration",
                     format("is too long for a gradient: its states need {:.1f} GB", 1e-9 * needed),
                     "Take longer steps, or a shorter run");
  tape.states.push_back(start);
  tape.ends.push_back(0);
  while (simulation.time() < end * (1.0 - 1e-9)) {
    const double t = simulation.time();
    const StepReport report = simulation.step(end);
    if (!report.accepted)
      throw SolveError(report.message, "The run must end before it has a gradient");
    if (method.ga.delta != 0.0 && simulation.state().rates_dt == 0.0 &&
        simulation.time() < end * (1.0 - 1e-9))
      throw InputError("analysis.rho_inf",
                       format("is {:g}, and at t = {:.6g} s a function has a break: accelerations "
                              "begin anew there, which has no derivative yet",
                              method.ga.rho_inf, simulation.time()),
                       "Use rho_inf: 1, or a smooth function");
    if (report.dt == 0.0) {
      tape.states.back().t = simulation.time();
      continue;
    }
    const double h = order == 2 ? simulation.state().dt_last : simulation.time() - t;
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const double length = stages[k] * h;
      if (k + 1 == stages.size()) {
        tape.states.push_back(simulation.state());
      } else {
        State next = tape.states.back();
        const NewtonReport again = single->take(next, length, method.control.newton, {-1, false});
        if (!again.converged) throw SolveError(again.text(), "Take a shorter step");
        tape.states.push_back(std::move(next));
      }
      tape.lengths.push_back(length);
    }
    tape.ends.push_back(tape.states.size() - 1);
  }
  return tape;
}

}  // namespace polhode
