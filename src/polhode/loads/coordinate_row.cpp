// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/coordinate_row.hpp>

namespace polhode {

CoordinateRow::CoordinateRow(const LoadDescription& load, std::size_t part)
    : coordinate_(load.coupled[part].coordinate),
      factor_(load.coupled[part].factor),
      near_(load.coupled[part].near),
      offset_(part == 0 ? load.value("offset", 0.0) : 0.0),
      absolute_(load.values.contains("offset")),
      last_(part + 1 == load.coupled.size()) {
  name = load.name;
  bodies = load.coupled[part].bodies;
}

/// The sum of g over the parts is that of the row. @eq{coupling-row}
void CoordinateRow::evaluate(const PairStep& step, PairTerms& t) const {
  const CoordinateMotion q = motion(step);
  add_force(q, factor_ * step.lambda[0], step, t);
  if (absolute_)
    t.g[0] = factor_ * q.at_n1 - offset_;
  else  // before assembly of the start its coordinates are not known
    t.g[0] = step.history[kStarted] == 0.0 ? 0.0 : factor_ * (q.at_n1 - step.history[kFirst]);
  t.B_a.col(0) = factor_ * q.mu_a;
  t.B_b.col(0) = factor_ * q.mu_b;
  if (step.context.tangents) {
    t.G_a.row(0) = factor_ * q.at_n1_a;
    t.G_b.row(0) = factor_ * q.at_n1_b;
  }
  clear_ground_sides(step, t);
}

void CoordinateRow::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  gamma[0] =
      factor_ *
      std::visit([&](const auto& q) { return q.acceleration_at_n1(step.a, step.b); }, coordinate_);
}

std::vector<double> CoordinateRow::report(const PairStep& step) const {
  return {factor_ * step.lambda[0], coordinate_at_n1(coordinate_, step.a, step.b, at_n(step)),
          coordinate_rate_at_n1(coordinate_, step.a, step.b)};
}

void CoordinateRow::initialize(const PairStep& step, double* history) const {
  history[kNow] = history[kFirst] = coordinate_at_n1(coordinate_, step.a, step.b, near_);
  history[kStarted] = 1.0;
}

void CoordinateRow::commit(const PairStep& step, double* history) const {
  history[kNow] = coordinate_at_n1(coordinate_, step.a, step.b, history[kNow]);
}

void add_coupling(System& system, const LoadDescription& load) {
  for (std::size_t part = 0; part < load.coupled.size(); ++part)
    system.group<CoordinateRow>().add(load, part);
}

}  // namespace polhode
