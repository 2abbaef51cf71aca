// SPDX-License-Identifier: Apache-2.0
#include <polhode/base/format.hpp>
#include <polhode/model/modal.hpp>

namespace polhode {

namespace {

/// Unbalanced forces above this part of the largest deserve a word.
constexpr double kUnbalanced = 1e-6;

Model static_model(Model model) {
  model.analysis.type = "statics";
  return model;
}

}  // namespace

ModalAnalysis::ModalAnalysis(Model model) {
  const AnalysisSpec analysis = model.analysis;
  simulation_ = std::make_unique<Simulation>(static_model(std::move(model)));
  (void)build_system(simulation_->model(), &map_);
  State state = simulation_->state();
  if (analysis.about == "start") {
    // The multipliers that carry the loads where the model is at rest.
    const InstantSolution now = InstantSolver(simulation_->system()).accelerations(state);
    if (now.solved) state.lambda = now.lambda;
  } else {
    const RunSummary summary = simulation_->run();
    if (summary.end != RunEnd::finished) {
      message_ = summary.message;
      return;
    }
    state = simulation_->state();
  }
  report_ = find_modes(simulation_->system(), state, {.count = analysis.count});
  if (report_.unbalanced > kUnbalanced)
    report_.warnings.push_back(
        format("the start is no equilibrium: {:.2g} of the largest force is unbalanced; use about: "
               "equilibrium",
               report_.unbalanced));
}

Vec6 ModalAnalysis::body_shape(int mode, int body) const {
  const int index = map_.body[static_cast<std::size_t>(body)];
  if (index == kGround) return Vec6::Zero();
  return report_.modes[static_cast<std::size_t>(mode)].shape.segment<6>(6 * index);
}

}  // namespace polhode
