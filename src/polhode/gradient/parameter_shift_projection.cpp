// SPDX-License-Identifier: Apache-2.0
// A parameter's neighbours in extrapolated steps and impacts: memories, projections and rows.
#include <cmath>
#include <numeric>

#include <polhode/gradient/parameter_shift.hpp>

namespace polhode {

void ParameterShift::keep_memories() {
  for (Neighbour& n : at_) n.kept.push_back(n.history);
}

void ParameterShift::begin_member(bool first) {
  for (Neighbour& n : at_) {
    if (first) n.kept.assign(1, n.history);
    n.history = n.kept.front();
  }
}

void ParameterShift::combine(const CombinationDerivative& combination) {
  for (Neighbour& n : at_) n.history = combination.memory(std::span(n.kept).subspan(1));
}

void ParameterShift::remember_coordinates(const State& projected) {
  for (Neighbour& n : at_) {
    State at = projected;
    at.history = n.history;
    const System& system = n.simulation->system();
    for (const int i : interactions_) {
      const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
      const InteractionTraits& traits = system.traits(ref);
      if (traits.history_size == 0 || traits.lazy_history) continue;
      const PairView view = system.instant(at, ref, at.lambda.data());
      system.group(ref.group).commit(ref.item, view.step(), n.history.data() + ref.first_history);
    }
  }
}

InstantRow ParameterShift::row_of(Neighbour& n, const InstantRow& row, const State& state) const {
  const System& system = n.simulation->system();
  if (!n.rows)
    n.rows =
        std::make_unique<InstantRows>(system, n.simulation->model().analysis.step.value_or(1.0));
  return n.rows->same(state, instant_steps(system, state), n.history.data(), row);
}

double ParameterShift::of_gap(const InstantRow& row, const State& state) {
  std::array<double, 4> gaps;
  for (std::size_t k = 0; k < gaps.size(); ++k) gaps[k] = row_of(at_[k], row, state).gap;
  return (2.0 / 3.0 * (gaps[0] - gaps[1]) - 1.0 / 12.0 * (gaps[2] - gaps[3])) / step_;
}

double ParameterShift::of_margin(std::size_t event, const OutcomeSlope& slope) {
  return at_[0].margins[event]->sign() * of_projection(slope) + difference([&](const Neighbour& n) {
           return n.margins[event]->value_there(n.simulation->system(), slope.at);
         });
}

double ParameterShift::of_projection(const OutcomeSlope& slope) {
  if (slope.stages.empty()) return 0.0;
  std::vector<int> bodies(static_cast<std::size_t>(system_->body_count()));
  std::iota(bodies.begin(), bodies.end(), 0);
  const ProjectionStage& stage = slope.stages.front();
  for (Neighbour& n : at_) {
    const System& system = n.simulation->system();
    if (!n.all) n.all = std::make_unique<InteractionSweep>(system);
    stage_terms(system, stage, stage.at.history, bodies, *n.all, system_->mean_mass(), n.terms);
  }
  return difference([&](const Neighbour& n) { return slope.by_inputs.dot(n.terms); });
}

void ParameterShift::follow_switches(const State& state) {
  for (std::size_t i = 0; i < system_->interactions().size(); ++i) {
    const InteractionRef& ref = system_->interactions()[i];
    if (system_->traits(ref).off < 0 || !system_->is_off(state, static_cast<int>(i))) continue;
    for (Neighbour& n : at_)
      n.simulation->system().group(ref.group).switch_off(ref.item,
                                                         n.history.data() + ref.first_history);
  }
}

void ParameterShift::add_projection(const std::vector<ProjectionStage>& stages, int column,
                                    std::vector<Eigen::Triplet<double>>& entries) {
  const int count = stage_inputs(*system_);
  for (std::size_t s = 0; s < stages.size(); ++s) {
    const ProjectionStage& stage = stages[s];
    ProjectionStage still = stage;  // its rows are g alone
    still.x.setZero();
    const double unit_mass = system_->mean_mass();
    for (Neighbour& n : at_) {
      const System& system = n.simulation->system();
      stage_terms(system, stage, n.history, bodies_, *n.sweep, unit_mass, n.terms);
      if (stage.impact)
        add_impact_terms(system, stage, row_of(n, stage.impact->row, stage.at), n.terms);
      if (stage.largest_row < 0) continue;
      Vec values;
      stage_terms(system, still, n.history, {}, *n.sweep, unit_mass, values);
      n.terms[count - 1] =
          2.0 / stage.largest * values[6 * system.body_count() + stage.largest_row] -
          std::log(system.mean_mass());
    }
    const Vec by = difference([](const Neighbour& n) -> Vec { return n.terms; });
    for (int i = 0; i < count; ++i)
      if (by[i] != 0.0) entries.emplace_back(static_cast<int>(s) * count + i, column, by[i]);
  }
}

}  // namespace polhode
