// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/beams/muscle_curves.hpp>
#include <polhode/beams/running_cable.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/gauss_rule.hpp>

namespace polhode {

namespace {

/// Part of a metre below which two points coincide and define no direction.
constexpr double kNoSpan = 1e-14;
/// Relative change of the length below which difference quotients are inaccurate.
constexpr double kShortWay = 1e-4;
/// α_f for which mean velocities of the step are difference quotients.
constexpr double kMidpoint = 0.5;
/// Smallest fibre length, as a part of the optimal length.
constexpr double kShortestFibre = 1e-2;

}  // namespace

RunningCable::RunningCable(RunningCableSpec spec) : spec_(std::move(spec)) {
  const std::string where = format("cables.{}", spec_.name);
  const auto refuse = [&](const std::string& key, const std::string& what, const char* hint) {
    throw InputError(key.empty() ? where : where + "." + key, what, hint);
  };
  if (spec_.nodes.size() < 2) refuse("through", "has fewer than two points", "Give two or more");
  if (!(spec_.stiffness >= 0.0) || !(spec_.damping >= 0.0))
    refuse("", "has a negative stiffness or damping", "Give numbers that are not negative");
  if (spec_.friction > 0.0) add_friction();
  add_windings();
  if (!spec_.muscle) return;
  const HillMuscle& m = *spec_.muscle;
  if (!(m.max_force > 0.0) || !(m.optimal_length > 0.0) || !(m.max_velocity > 0.0) ||
      !(m.tendon_length >= 0.0) || !m.activation)
    refuse("muscle", "lacks max_force, optimal_length, max_velocity or activation",
           "Give numbers above zero, and an activation from 0 to 1");
}

std::vector<TimeFunctionPtr> RunningCable::time_functions() const {
  return {spec_.tension, spec_.muscle ? spec_.muscle->activation : nullptr};
}

RunningCable::Course RunningCable::course(const NodeStep& step, bool tangents) const {
  Course c;
  if (!spec_.windings.empty()) add_wound(step, tangents, c);
  const double af = step.alpha_f;
  const bool middle = af == kMidpoint && step.context.dt != 0.0;
  double by_velocities = 0.0;
  for (std::size_t k = 0; k + 1 < spec_.nodes.size(); ++k) {
    if (const int w = c.wound_of.empty() ? -1 : c.wound_of[k]; w >= 0) {
      const WoundSpan& wound = c.wound[static_cast<std::size_t>(w)].span;
      c.n += wound.l_n;
      c.n1 += wound.l_n1;
      c.change += wound.change;
      by_velocities += wound.rate_alpha;
      c.spans.push_back({.change = wound.change, .wound = w});
      continue;
    }
    const int i = spec_.nodes[k], j = spec_.nodes[k + 1];
    const Vec3 d_n = NodeStep::at(step.x_n, j) - NodeStep::at(step.x_n, i);
    const Vec3 d_n1 = NodeStep::at(step.x_n1, j) - NodeStep::at(step.x_n1, i);
    const double l_n = d_n.norm(), l_n1 = d_n1.norm();
    const double l_alpha = (1.0 - af) * l_n + af * l_n1;
    c.n += l_n;
    c.n1 += l_n1;
    Span s;
    if (l_alpha > kNoSpan) {
      s.per_length = 1.0 / l_alpha;
      s.n = s.per_length * ((1.0 - af) * d_n + af * d_n1);
      if (l_n1 > kNoSpan) s.e = d_n1 / l_n1;
      const Vec3 moved = NodeStep::at(step.u, j) - NodeStep::at(step.u, i);
      s.change = (d_n + d_n1).dot(moved) / (l_n + l_n1);
      c.change += s.change;
      if (middle) {
        s.rate = s.e / step.context.dt;
      } else {
        const Vec3 v = step.velocity_alpha(j) - step.velocity_alpha(i);
        by_velocities += s.n.dot(v);
        s.rate = af * (step.rate * s.n + s.per_length * (v - s.n.dot(v) * s.e));
      }
    }
    c.spans.push_back(s);
  }
  c.rate = middle ? c.change / step.context.dt : by_velocities;
  return c;
}

RunningCable::Fibre RunningCable::fibre(double length) const {
  const HillMuscle& m = *spec_.muscle;
  const double height = std::sin(m.pennation);
  const double along = std::max(kShortestFibre, (length - m.tendon_length) / m.optimal_length);
  Fibre f;
  f.length = std::hypot(along, height);
  f.cosine = along / f.length;
  f.bend = height * height / (f.length * f.length * f.length * m.optimal_length);
  return f;
}

/// @eq{muscle-force}
RunningCable::Law RunningCable::elastic(double length) const {
  Law law;
  if (taut(length)) law = {spec_.stiffness * (length - spec_.free_length), spec_.stiffness};
  if (!spec_.muscle) return law;
  const Fibre f = fibre(length);
  const CurveValue p = passive_force_length(f.length);
  const double F = spec_.muscle->max_force;
  law.value += F * p.value * f.cosine;
  law.slope +=
      F * (p.slope * f.cosine * f.cosine / spec_.muscle->optimal_length + p.value * f.bend);
  return law;
}

double RunningCable::energy(double length) const {
  double energy = 0.0;
  if (taut(length)) energy = 0.5 * spec_.stiffness * std::pow(length - spec_.free_length, 2);
  if (spec_.muscle)
    energy += spec_.muscle->max_force * spec_.muscle->optimal_length *
              (passive_energy(fibre(length).length) - passive_energy(1.0));
  return energy;
}

RunningCable::Tension RunningCable::tension(const NodeStep& step, const Course& c) const {
  Tension T;
  const double af = step.alpha_f, shift = 2.0 * af - 1.0;
  const double low = c.n1 - (1.0 - shift) * c.change, way = c.n1 - low;
  const Law end = elastic(c.n1);
  // Mean from low to L_{n+1}: at ρ∞ = 1 the change of the energy over that of the length.
  double taut_part = taut(c.n1) ? 1.0 : 0.0;
  if (!step.context.conserving || way == 0.0) {
    const Law law = elastic((1.0 - af) * c.n + af * c.n1);
    T.elastic = law.value;
    T.by_n1 = af * law.slope;
  } else if (std::abs(way) > kShortWay * c.n1 || taut(low) != taut(c.n1)) {
    T.elastic = (energy(c.n1) - energy(low)) / way;
    T.by_n1 = (end.value - T.elastic + shift * (T.elastic - elastic(low).value)) / way;
  } else {
    for (const auto& [place, weight] : kGauss) {
      const Law law = elastic(low + place * way);
      T.elastic += weight * law.value;
      T.by_n1 += weight * (place + (1.0 - place) * shift) * law.slope;
    }
  }
  if (taut(low) != taut(c.n1))
    taut_part = std::abs((taut(c.n1) ? c.n1 : low) - spec_.free_length) / std::abs(way);
  T.damper = spec_.damping * taut_part * taut_part * c.rate;
  T.by_rate = spec_.damping * taut_part * taut_part;
  if (spec_.tension_only && spec_.damping > 0.0 &&
      T.elastic + T.damper <= 0.0) {  // no cable pushes
    T.damper = -T.elastic;
    T.by_n1 = T.by_rate = 0.0;
  }
  if (spec_.tension)
    T.active += step.context.load_factor * (*spec_.tension)(step.context.t_alpha());
  if (!spec_.muscle) return T;
  const HillMuscle& m = *spec_.muscle;
  const Fibre f = fibre((1.0 - af) * c.n + af * c.n1);
  const double per = 1.0 / (m.optimal_length * m.max_velocity), v = f.cosine * c.rate * per;
  const double a = (*m.activation)(step.context.t_alpha());
  const CurveValue length = active_force_length(f.length), velocity = force_velocity(v);
  const double fibre_force = m.max_force * (a * length.value * velocity.value + m.damping * v);
  T.active += fibre_force * f.cosine;
  const double by_speed = m.max_force * f.cosine * (a * length.value * velocity.slope + m.damping);
  T.by_rate += by_speed * per * f.cosine;
  T.by_n1 += m.max_force * f.cosine * a * length.slope * velocity.value * af * f.cosine /
                 m.optimal_length +
             by_speed * per * af * f.bend * c.rate + fibre_force * af * f.bend;
  return T;
}

ElementReport RunningCable::evaluate(const NodeStep& step, const double* history, double*,
                                     const Mat3&, const ElementSink& sink) const {
  const Course c = course(step, sink.tangent != nullptr);
  if (c.refused) return {.least_volume = kNoLine, .worst_element = 0};
  const Tension T = tension(step, c);
  const double af = step.alpha_f;
  const std::size_t count = nodes_.size();
  std::optional<Grip> grip;
  if (friction_) grip = this->grip(step, c, T.sum(), history);
  const auto N = [&](std::size_t k) {
    return grip ? grip->held.tension[static_cast<Eigen::Index>(k)] : T.sum();
  };
  std::vector<double> force(3 * count, 0.0);
  const auto at = [&](std::size_t node) { return Eigen::Map<Vec3>(force.data() + 3 * node); };
  for (std::size_t k = 0; k < c.spans.size(); ++k) {
    at(k) += N(k) * c.spans[k].n;
    at(k + 1) -= N(k) * c.spans[k].n;
  }
  for (const Wound& w : c.wound) {
    const WoundNodes places = wound_places(w.winding);
    for (int i = 0; i < kWoundNodes; ++i)
      at(static_cast<std::size_t>(places[static_cast<std::size_t>(i)])) -=
          T.sum() * w.span.n.segment<3>(3 * i);
  }
  sink.add_force(nodes_, force.data());
  if (!sink.tangent) return {};
  const auto size = static_cast<Eigen::Index>(3 * count);
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Matrix K = Matrix::Zero(size, size);
  Vec by_end = Vec::Zero(size);
  for (std::size_t k = 0; k < c.spans.size(); ++k) {
    const Span& s = c.spans[k];
    const auto i = static_cast<Eigen::Index>(3 * k), j = i + 3;
    const Vec3 by_point = T.by_n1 * s.e + T.by_rate * s.rate;
    by_end.segment<3>(i) -= by_point;
    by_end.segment<3>(j) += by_point;
    const Mat3 turn = N(k) * af * s.per_length * (Mat3::Identity() - s.n * s.e.transpose());
    K.block<3, 3>(i, i) -= turn;
    K.block<3, 3>(i, j) += turn;
    K.block<3, 3>(j, i) += turn;
    K.block<3, 3>(j, j) -= turn;
  }
  const bool middle = af == kMidpoint && step.context.dt != 0.0;
  for (const Wound& w : c.wound) {
    const WoundNodes places = wound_places(w.winding);
    const Vec18 rate = middle ? Vec18(w.span.e / step.context.dt) : w.span.rate;
    for (int i = 0; i < kWoundNodes; ++i) {
      const Eigen::Index row = 3 * places[static_cast<std::size_t>(i)];
      by_end.segment<3>(row) +=
          T.by_n1 * w.span.e.segment<3>(3 * i) + T.by_rate * rate.segment<3>(3 * i);
      for (int j = 0; j < kWoundNodes; ++j)
        K.block<3, 3>(row, 3 * places[static_cast<std::size_t>(j)]) -=
            T.sum() * w.span.turn.block<3, 3>(3 * i, 3 * j);
    }
  }
  const Mat by_nodes = grip ? tension_by_nodes(*grip, c, by_end) : Mat(by_end.transpose());
  for (const Wound& w : c.wound) {
    const WoundNodes places = wound_places(w.winding);
    for (int i = 0; i < kWoundNodes; ++i)
      K.middleRows<3>(3 * places[static_cast<std::size_t>(i)]) -=
          w.span.n.segment<3>(3 * i) * by_nodes.row(0);
  }
  for (std::size_t k = 0; k < c.spans.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(3 * k);
    const auto row = by_nodes.row(grip ? static_cast<Eigen::Index>(k) : 0);
    K.middleRows<3>(i) += c.spans[k].n * row;
    K.middleRows<3>(i + 3) -= c.spans[k].n * row;
  }
  sink.add_tangent(0, static_cast<int>(count), K.data());
  return {};
}

/// Slack, taut, or let go faster than it shortens by itself; and by span on its obstacle or
/// straight.
void RunningCable::pieces(const NodeStep& instant, const double*, ForcePieces& pieces) const {
  const Course c = course(instant);
  const Tension T = tension(instant, c);
  const bool pulls = !spec_.tension_only || spec_.damping == 0.0 || T.elastic + T.damper > 0.0;
  pieces.add(!taut(c.n1) ? 0.0 : pulls ? 1.0 : 2.0, spec_.damping > 0.0);
  for (const int wound : c.wound_of) pieces.add(wound >= 0 ? 1.0 : 0.0);
}

void RunningCable::commit(const NodeStep& step, double* history, const double*) const {
  if (!friction_ || step.context.dt == 0.0) return;
  const Course c = course(step);
  const Vec parts = grip(step, c, tension(step, c).sum(), history).parts;
  std::copy(parts.begin(), parts.end(), history);
}

/// @eq{running-cable} @eq{cable-capstan}
Work RunningCable::work(const NodeStep& step, const double* history, const double*) const {
  const Course c = course(step);
  Work work{.stored = energy(c.n1)};
  if (step.context.dt == 0.0) {
    if (friction_) work.stored += friction_->energy(parts_of(history));
    return work;
  }
  const Tension T = tension(step, c);
  work.dissipated = T.damper * c.change;
  work.put_in = -T.active * c.change;
  if (!friction_) return work;
  const Grip g = grip(step, c, T.sum(), history);
  const double after = friction_->energy(g.parts);
  double done = friction_->energy(parts_of(history)) - after;
  for (std::size_t k = 0; k < c.spans.size(); ++k)
    done += (g.held.tension[static_cast<Eigen::Index>(k)] - T.sum()) * c.spans[k].change;
  work.stored += after;
  work.dissipated += std::max(0.0, done);
  return work;
}

RunningCableReport RunningCable::report(const NodeStep& instant, const double* history) const {
  const Course c = course(instant);
  const Tension T = tension(instant, c);
  RunningCableReport r{.tension = T.sum(), .length = c.n1, .rate = c.rate, .energy = energy(c.n1)};
  r.tensions.assign(c.spans.size(), r.tension);
  if (friction_) {
    const Vec held = grip(instant, c, r.tension, history).held.tension;
    r.tensions.assign(held.begin(), held.end());
    r.energy += friction_->energy(parts_of(history));
  }
  if (!spec_.muscle) return r;
  const Fibre f = fibre(c.n1);
  r.fibre_length = f.length * spec_.muscle->optimal_length;
  r.activation = (*spec_.muscle->activation)(instant.context.t_n);
  r.passive = spec_.muscle->max_force * passive_force_length(f.length).value * f.cosine;
  return r;
}

}  // namespace polhode
