// SPDX-License-Identifier: Apache-2.0
// Derivatives of steps that end at impacts, and of those after them.
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/parameter_inputs.hpp>
#include <polhode/gradient/whole_step_derivative.hpp>

namespace polhode {

namespace {

/// Steps of the differences by the length of a step and by its time, as parts of the length: the
/// residual is a power of the length, and a function of time that the step resolves.
constexpr double kLengthStep = 1e-3, kTimeStep = 1e-2;
/// Part of the forces of a step that contacts and stops have in a step without them: round-off.
constexpr double kBalanced = 1e-6;
/// Rate of the margin of an event at it, as a part of the mean one in the step before, below which
/// it only reaches its level.
constexpr double kSlow = 1e-3;
/// Difference of the velocities behind an impact from those of its own law, as a part of them.
constexpr double kSameImpact = 1e-7;

}  // namespace

/// Derivatives at fixed places, start velocities and multipliers: inertia, with the inverse
/// square of the length, in closed form, all else by differences.
WholeStepDerivative::ByTime WholeStepDerivative::by_time(std::size_t step) {
  const double h = tape_.sequence[step].length;
  const State &from = tape_.ends[step], &to = tape_.after(step, 0, 0);
  const int bodies = system_.body_count();
  const auto steps_of = [&](const Trial& x) {
    std::vector<BodyStep> steps;
    for (int b = 0; b < bodies; ++b) steps.push_back(body_step(system_, from, x, b));
    steps.push_back(BodyStep::ground(x.context.ga.alpha_f));
    return steps;
  };
  const auto residual = [&](double later, double longer) {
    Trial x = trial(from, to, h + longer);
    x.context.t_n += later;
    x.context.tangents = false;
    Vec of = Vec::Zero(single_.inputs());
    sweep_->run(steps_of(x), x.context, x.lambda.data(), from.history.data(),
                [&](int i, const PairStep&, const PairTerms& t) {
                  const InteractionRef& ref = system_.interactions()[static_cast<std::size_t>(i)];
                  if (ref.a != kGround) of.segment<6>(6 * ref.a) -= t.wrench_a;
                  if (ref.b != kGround) of.segment<6>(6 * ref.b) -= t.wrench_b;
                  for (int k = 0; k < ref.rows; ++k) of[6 * bodies + ref.first_row + k] = t.g[k];
                });
    return of;
  };
  const auto difference = [&](double d, const auto& at) -> Vec {
    return (2.0 / 3.0 * (at(d) - at(-d)) - 1.0 / 12.0 * (at(2.0 * d) - at(-2.0 * d))) / d;
  };
  ByTime by;
  by.length = difference(kLengthStep * h, [&](double d) { return residual(0.0, d); });
  by.time = difference(kTimeStep * h, [&](double d) { return residual(d, 0.0); });
  by.velocities = Vec::Zero(single_.state_size());
  const std::vector<BodyStep> steps = steps_of(trial(from, to, h));
  for (int b = 0; b < bodies; ++b) {
    const BodyStep& s = steps[static_cast<std::size_t>(b)];
    const BodyData& body = system_.bodies()[static_cast<std::size_t>(b)];
    const Vec3 h_n = s.Lambda_n * (body.inertia * s.W_n);
    const Vec3 mixed = s.Lambda_n1 * (body.inertia * (s.W_n + 2.0 * s.W_n1));
    by.length.segment<3>(6 * b) -= 2.0 * body.mass / (h * h) * s.v_n1;
    by.length.segment<3>(6 * b + 3) += (h_n - mixed) / (h * h);
    by.velocities.segment<3>(kStateNumbers * b + 6) = -(s.v_n + s.v_n1) / h;
    by.velocities.segment<3>(kStateNumbers * b + 9) = -(s.W_n + s.W_n1) / h;
  }
  return by;
}

Vec WholeStepDerivative::by_length(const ByTime& times) {
  Vec along = Vec::Zero(single_.state_size());
  single_.push(times.length, along);
  return along + times.velocities;
}

Vec WholeStepDerivative::by_state(std::size_t step) const {
  if (const int event = tape_.event_at(step + 1); event >= 0) {
    const EventMargin& margin = *tape_.margins[static_cast<std::size_t>(event)];
    return margin.sign() * margin.slope(system_, tape_.after(step, 0, 0)).by_state;
  }
  const InstantRow& row = *tape_.closing_at(step + 1);
  Vec by = Vec::Zero(single_.state_size());
  if (row.a != kGround) by.segment<6>(kStateNumbers * row.a) = row.by_a;
  if (row.b != kGround) by.segment<6>(kStateNumbers * row.b) += row.by_b;
  return by;
}

/// Derivative of the same by a parameter, at a fixed state.
double WholeStepDerivative::of_end(ParameterShift& shift, std::size_t step) const {
  if (const int event = tape_.event_at(step + 1); event >= 0) {
    const auto e = static_cast<std::size_t>(event);
    return shift.of_margin(e, tape_.margins[e]->slope(system_, tape_.after(step, 0, 0)));
  }
  return shift.of_gap(*tape_.closing_at(step + 1), tape_.ends[step + 1]);
}

const State& WholeStepDerivative::before_jump(std::size_t step) {
  const State &from = tape_.ends[step], &to = tape_.ends[step + 1];
  before_jump_ = to;
  const Trial x = trial(from, to, tape_.sequence[step].length);
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyStep s = body_step(system_, from, x, b);
    BodyMotion m = system_.motion(to, b);
    m.v = s.v_n1;
    m.W = s.W_n1;
    before_jump_.set_motion(system_.slot(b), m);
  }
  return before_jump_;
}

/// Refuses events whose margin hardly changes: kSlow of what it could with the speeds there.
void WholeStepDerivative::check_rate(std::size_t step, double rate) const {
  const int event = tape_.event_at(step + 1);
  if (event < 0) return;
  const auto& spec = model_.events[static_cast<std::size_t>(event)];
  const EventMargin& margin = *tape_.margins[static_cast<std::size_t>(event)];
  const double before = margin.value(system_, tape_.ends[step]),
               size = std::abs(before) / tape_.sequence[step].length;
  if (rate > kSlow * size) return;
  throw InputError(
      format("events.{}", spec.name),
      format("occurs at t = {:.6g} s where its channel hardly changes: its time has no "
             "derivative",
             tape_.ends[step + 1].t),
      "Choose another level");
}

void WholeStepDerivative::linearize_impact(std::size_t step) {
  projection_.linearize_impact(before_jump(step), *rows_, *tape_.closing_at(step + 1));
}

/// Compares the velocities behind an impact with those of a single row without friction.
void WholeStepDerivative::check_impact(std::size_t step) const {
  const State &end = tape_.ends[step + 1], &found = projection_.projected();
  const InstantRow& row = *tape_.closing_at(step + 1);
  double size = 0.0;
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyMotion m = system_.motion(end, b);
    size = std::max(size, m.v.norm() + system_.length_scale() * m.W.norm());
  }
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyMotion m = system_.motion(end, b), n = system_.motion(found, b);
    if ((m.v - n.v).norm() + system_.length_scale() * (m.W - n.W).norm() <= kSameImpact * size)
      continue;
    throw InputError(rows_->name(row),
                     format("has an impact at t = {:.6g} s in which others take part, which has no "
                            "derivative yet",
                            end.t),
                     "Let one contact or stop close at a time, while no other is closed");
  }
}

/// @eq{located-step}
WholeStepDerivative::Inputs WholeStepDerivative::push_located(std::size_t step,
                                                              std::vector<ParameterShift>& shifts,
                                                              const Vec* direction, Mat& tangents) {
  Inputs inputs = {linearize_single(step, 0, 0, shifts)};
  const State& reached = tape_.after(step, 0, 0);
  if (single_.unbalanced(trial(tape_.ends[step], reached, tape_.sequence[step].length)) > kBalanced)
    throw InputError("contacts",
                     format("act in the step from t = {:.6g} s without an impact at its end, which "
                            "has no derivative yet",
                            tape_.ends[step].t),
                     "Take a shorter step, or compare runs");
  const bool moves = tape_.moves(step + 1);
  const Eigen::Index time = single_.state_size();
  ByTime times;
  if (moves || starts_late(step)) times = by_time(step);
  Mat rhs = in_directions(inputs[0], direction);
  for (Eigen::Index c = 0; c < tangents.cols(); ++c) {
    Vec dy = tangents.col(c).head(time), in = rhs.col(c);
    const double late = tangents(time, c);
    if (starts_late(step)) in += late * times.time;
    if (!moves && starts_late(step)) in -= late * times.length;
    single_.push(in, dy);
    if (!moves) {
      if (starts_late(step)) dy -= late * times.velocities;
      tangents(time, c) = 0.0;
    }
    tangents.col(c).head(time) = dy;
  }
  for (ParameterShift& shift : shifts) shift.follow_switches(tape_.ends[step + 1]);
  if (!moves) return inputs;

  const Vec along = by_length(times), gap = by_state(step);
  const double rate = gap.dot(along);
  check_rate(step, rate);
  std::vector<Eigen::Triplet<double>> of_gap, of_impact;
  for (std::size_t j = 0; j < shifts.size(); ++j)
    of_gap.emplace_back(0, static_cast<int>(j), of_end(shifts[j], step));
  inputs.push_back(sparse_inputs(1, shifts.size(), of_gap));
  rhs = in_directions(inputs[1], direction);
  for (Eigen::Index c = 0; c < tangents.cols(); ++c) {
    const double longer = -(gap.dot(tangents.col(c).head(time)) + rhs(0, c)) / rate;
    tangents.col(c).head(time) += longer * along;
    tangents(time, c) += longer;
  }
  if (!tape_.closing_at(step + 1)) return inputs;

  linearize_impact(step);
  check_impact(step);
  for (std::size_t j = 0; j < shifts.size(); ++j)
    shifts[j].add_projection(projection_.stages(), static_cast<int>(j), of_impact);
  inputs.push_back(sparse_inputs(projection_.inputs(), shifts.size(), of_impact));
  const Mat jumps = in_directions(inputs[2], direction);
  for (Eigen::Index c = 0; c < tangents.cols(); ++c) {
    Vec dy = tangents.col(c).head(time);
    projection_.push(jumps.col(c), dy);
    tangents.col(c).head(time) = dy;
  }
  return inputs;
}

/// @eq{located-step}
void WholeStepDerivative::pull_located(std::size_t step, const Inputs& inputs, std::vector<Vec>& mu,
                                       std::vector<Vec>& by) {
  const InstantRow* const closing = tape_.closing_at(step + 1);
  const bool moves = tape_.moves(step + 1);
  const State& from = tape_.ends[step];
  const State& to = closing ? before_jump(step) : tape_.after(step, 0, 0);
  single_.linearize(from, to, trial(from, to, tape_.sequence[step].length));
  const Eigen::Index time = single_.state_size();
  ByTime times;
  Vec along, gap;
  if (moves || starts_late(step)) times = by_time(step);
  if (moves) {
    along = by_length(times);
    gap = by_state(step);
  }
  if (closing) linearize_impact(step);
  for (std::size_t o = 0; o < mu.size(); ++o) {
    if (mu[o].isZero(0.0)) continue;
    Vec m = mu[o].head(time);
    double late = moves ? mu[o][time] : 0.0;
    if (closing) by[o] += inputs[2].transpose() * projection_.pull(m);
    if (moves) {
      const double longer = (m.dot(along) + late) / gap.dot(along);
      by[o] += inputs[1].transpose() * Vec::Constant(1, -longer);
      m -= longer * gap;
    } else if (starts_late(step)) {
      late -= m.dot(times.velocities);
    }
    const Vec eta = single_.pull(m);
    by[o] += inputs[0].transpose() * eta;
    if (starts_late(step)) late += eta.dot(times.time);
    if (starts_late(step) && !moves) late -= eta.dot(times.length);
    mu[o].head(time) = m;
    mu[o][time] = late;
  }
}

}  // namespace polhode
