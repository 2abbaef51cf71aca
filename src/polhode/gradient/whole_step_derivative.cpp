// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/parameter_inputs.hpp>
#include <polhode/gradient/whole_step_derivative.hpp>

namespace polhode {

namespace {

/// Part of a body's forces that the step seen backwards may lack: round-off of stiff forces is
/// 1e-10 of them, a law that is not symmetric has parts of order of the step.
constexpr double kSymmetric = 1e-6;
/// Difference of a velocity from that of its step, as a part of the speed, that is a jump.
constexpr double kJumped = 1e-5;

[[noreturn]] void refuse_jump(const System& system, int body, double t) {
  throw InputError(format("bodies.{}", system.bodies()[static_cast<std::size_t>(body)].name),
                   format("has a velocity that jumps at t = {:.6g} s", t),
                   "Use drives without kinks: a jump has no derivative yet");
}

}  // namespace

WholeStepDerivative::WholeStepDerivative(const Simulation& simulation, const RunTape& tape)
    : system_(simulation.system()),
      model_(simulation.model()),
      tape_(tape),
      single_(system_, model_.analysis.rho_inf),
      combination_(system_),
      projection_(system_) {
  if (!tape.located()) return;
  sweep_.emplace(system_);
  rows_.emplace(system_, *model_.analysis.step);
}

Trial WholeStepDerivative::trial(const State& from, const State& to, double length) const {
  Trial step = single_.trial(from, to, length);
  step.context.conserving = model_.analysis.conserving;
  return step;
}

void WholeStepDerivative::check_single(double t) const {
  if (single_.jump() > kJumped) refuse_jump(system_, single_.jumped_body(), t);
  if (single_.asymmetry() <= kSymmetric) return;
  const auto body = static_cast<std::size_t>(single_.least_symmetric());
  throw InputError(format("bodies.{}", system_.bodies()[body].name),
                   format("feels a force at t = {:.6g} s that is not symmetric in time: {:.1g} "
                          "of it differs in the step seen backwards",
                          t, single_.asymmetry()),
                   "Leave out loads with memory, one after the other, to find it");
}

/// Compares the end of an extrapolated step with what its members give.
void WholeStepDerivative::check_end(std::size_t step) const {
  const State& found = system_.rows() > 0 ? projection_.projected() : combination_.combined();
  const State& end = tape_.ends[step + 1];
  const double rate = system_.length_scale() / tape_.sequence[step].length;
  for (int b = 0; b < system_.body_count(); ++b) {
    const BodyMotion m = system_.motion(end, b), n = system_.motion(found, b);
    const double size = std::max(m.v.norm(), kJumped * rate);
    const double turn = std::max(m.W.norm(), kJumped / tape_.sequence[step].length);
    if ((m.v - n.v).norm() > kJumped * size || (m.W - n.W).norm() > kJumped * turn)
      refuse_jump(system_, b, end.t);
  }
}

Eigen::SparseMatrix<double> WholeStepDerivative::linearize_single(
    std::size_t at, std::size_t member, std::size_t k, std::vector<ParameterShift>& shifts) {
  const double length = tape_.members[at][member].lengths[k];
  const State& from = single_.beginning(tape_.before(at, member, k), length);
  const State& to = tape_.closing_at(at + 1) ? before_jump(at) : tape_.after(at, member, k);
  Trial step = trial(from, to, length);
  step.context.tangents = false;
  std::vector<BodyStep> steps;
  for (int b = 0; b < system_.body_count(); ++b) steps.push_back(body_step(system_, from, step, b));
  steps.push_back(BodyStep::ground(step.context.ga.alpha_f));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < shifts.size(); ++j) {
    shifts[j].add_residual(from, step, steps, static_cast<int>(j), entries);
    shifts[j].commit(step, steps);
  }
  step.context.tangents = true;
  single_.linearize(from, to, step);
  check_single(from.t);
  return sparse_inputs(single_.inputs(), shifts.size(), entries);
}

Eigen::SparseMatrix<double> WholeStepDerivative::push_single(std::size_t at, std::size_t member,
                                                             std::size_t k,
                                                             std::vector<ParameterShift>& shifts,
                                                             const Vec* direction, Mat& tangents) {
  Eigen::SparseMatrix<double> by = linearize_single(at, member, k, shifts);
  const Mat rhs = in_directions(by, direction);
  for (Eigen::Index c = 0; c < tangents.cols(); ++c) {
    Vec dy = tangents.col(c);
    single_.push(rhs.col(c), dy);
    tangents.col(c) = dy;
  }
  return by;
}

void WholeStepDerivative::combine(std::size_t step) {
  const std::size_t count = tape_.members[step].size();
  std::vector<const State*> ends;
  for (std::size_t j = 0; j < count; ++j) ends.push_back(&tape_.members[step][j].states.back());
  combination_.linearize(tape_.ends[step], tape_.sequence[step].length, ends);
  if (system_.rows() > 0) projection_.linearize(combination_.combined());
}

WholeStepDerivative::Inputs WholeStepDerivative::push(std::size_t step,
                                                      std::vector<ParameterShift>& shifts,
                                                      const Vec* direction, Mat& tangents) {
  if (tape_.located()) return push_located(step, shifts, direction, tangents);
  Inputs inputs;
  const std::vector<TapeMember>& members = tape_.members[step];
  if (members.size() == 1) {
    for (std::size_t k = 0; k < members[0].lengths.size(); ++k)
      inputs.push_back(push_single(step, 0, k, shifts, direction, tangents));
    return inputs;
  }
  std::vector<Mat> ends;
  for (std::size_t j = 0; j < members.size(); ++j) {
    for (ParameterShift& shift : shifts) shift.begin_member(j == 0);
    ends.push_back(tangents);
    for (std::size_t k = 0; k < members[j].lengths.size(); ++k)
      inputs.push_back(push_single(step, j, k, shifts, direction, ends.back()));
    for (ParameterShift& shift : shifts) shift.end_member();
  }
  combine(step);
  check_end(step);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t j = 0; j < shifts.size(); ++j) {
    shifts[j].combine(combination_);
    if (system_.rows() > 0)
      shifts[j].add_projection(projection_.stages(), static_cast<int>(j), entries);
    shifts[j].remember_coordinates(tape_.ends[step + 1]);
  }
  inputs.push_back(sparse_inputs(projection_.inputs(), shifts.size(), entries));
  const Mat rhs = in_directions(inputs.back(), direction);
  for (Eigen::Index c = 0; c < tangents.cols(); ++c) {
    std::vector<Vec> columns;
    for (const Mat& end : ends) columns.emplace_back(end.col(c));
    Vec dy = combination_.push(columns);
    projection_.push(rhs.col(c), dy);
    tangents.col(c) = dy;
  }
  return inputs;
}

void WholeStepDerivative::pull_single(std::size_t at, std::size_t member, std::size_t k,
                                      const Eigen::SparseMatrix<double>& inputs,
                                      std::vector<Vec>& mu, std::vector<Vec>& by) {
  const double length = tape_.members[at][member].lengths[k];
  const State& from = single_.beginning(tape_.before(at, member, k), length);
  const State& to = tape_.after(at, member, k);
  single_.linearize(from, to, trial(from, to, length));
  for (std::size_t o = 0; o < mu.size(); ++o)
    if (!mu[o].isZero(0.0)) by[o] += inputs.transpose() * single_.pull(mu[o]);
}

void WholeStepDerivative::pull(std::size_t step, const Inputs& inputs, std::vector<Vec>& mu,
                               std::vector<Vec>& by) {
  if (tape_.located()) return pull_located(step, inputs, mu, by);
  const std::vector<TapeMember>& members = tape_.members[step];
  std::size_t next = inputs.size();
  if (members.size() == 1) {
    for (std::size_t k = members[0].lengths.size(); k-- > 0;)
      pull_single(step, 0, k, inputs[--next], mu, by);
    return;
  }
  combine(step);
  --next;
  std::vector<std::vector<Vec>> of_members(members.size());  // by member and outcome
  for (std::size_t o = 0; o < mu.size(); ++o) {
    by[o] += inputs[next].transpose() * projection_.pull(mu[o]);
    std::vector<Vec> parts = combination_.pull(mu[o]);
    for (std::size_t j = 0; j < members.size(); ++j) of_members[j].push_back(std::move(parts[j]));
    mu[o].setZero();
  }
  for (std::size_t j = members.size(); j-- > 0;) {
    for (std::size_t k = members[j].lengths.size(); k-- > 0;)
      pull_single(step, j, k, inputs[--next], of_members[j], by);
    for (std::size_t o = 0; o < mu.size(); ++o) mu[o] += of_members[j][o];
  }
}

}  // namespace polhode
