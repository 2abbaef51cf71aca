// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <optional>

#include <polhode/beams/wound_span.hpp>

namespace polhode {

namespace {

using geometry::wrap;
using geometry::Wrapping;

using Mat6x18 = Eigen::Matrix<double, 6, 3 * kWoundNodes>;

/// Gauss's rule of two points on [0, 1].
constexpr double kFirst = 0.21132486540518712, kSecond = 0.78867513459481288;
/// Steps of the points from which on the rule is corrected, as parts of the obstacle's size: where
/// the cable stays on or off it, and where it lifts off or touches within the step.
constexpr double kCorrected = 1e-3, kCorrectedAtTouch = 1e-6;
/// Rounding of the change of a length, by its bound and by the size.
constexpr double kJump = 1e-9, kRound = 1e-11;

Vec3 node(const double* x, int i) { return NodeStep::at(x, i); }

/// Derivative of the coordinates by the nodes; linear in the nodes.
Mat6x18 derivative(const std::array<Vec3, kWoundNodes>& x, double arm) {
  Mat6x18 D = Mat6x18::Zero();
  for (int point = 0; point < 2; ++point) {
    const int own = point == 0 ? 0 : kWoundNodes - 1;
    const Vec3 from = (x[static_cast<std::size_t>(own)] - x[1]) / arm;
    for (int k = 0; k < 3; ++k) {
      const int axis = 2 + k, row = 3 * point + k;
      const Vec3 along = (x[static_cast<std::size_t>(axis)] - x[1]) / arm;
      D.block<1, 3>(row, 3 * own) += along.transpose();
      D.block<1, 3>(row, 3 * axis) += from.transpose();
      D.block<1, 3>(row, 3) -= (along + from).transpose();
    }
  }
  return D;
}

/// Derivative of Σ G_k Dπ_k by the nodes: that of each coordinate is constant.
Mat18 bent(const Vec6& G, double arm) {
  Mat18 B = Mat18::Zero();
  const auto add = [&](int i, int j, double value) {
    B.block<3, 3>(3 * i, 3 * j).diagonal().array() += value;
    B.block<3, 3>(3 * j, 3 * i).diagonal().array() += value;
  };
  for (int point = 0; point < 2; ++point) {
    const int own = point == 0 ? 0 : kWoundNodes - 1;
    for (int k = 0; k < 3; ++k) {
      const double g = G[3 * point + k] / arm;
      add(2 + k, own, g);
      add(2 + k, 1, -g);
      add(1, own, -g);
      add(1, 1, g);
    }
  }
  return B;
}

std::optional<Wrapping> wrap_at(const geometry::Roller& roller, const Vec6& pi, bool second) {
  return wrap(roller, pi.head<3>(), pi.tail<3>(), second);
}

Vec6 gradient(const Wrapping& w) {
  Vec6 g;
  g << w.by_p, w.by_q;
  return g;
}

/// Discrete gradient of the length by the coordinates, with its derivative by those at t_{n+1}.
struct Mean {
  Vec6 G = Vec6::Zero();
  Mat6 by_end = Mat6::Zero();

  void add(const Wrapping& w, double weight, double place) {
    G += weight * gradient(w);
    by_end += weight * place * w.second;
  }
};

/// Mean of the gradients from `shift` of the step to its end; from its ends alone where the
/// straight way between them is through the obstacle.
Mean mean_gradient(const geometry::Roller& roller, const Vec6& pi_n, const Vec6& move, double shift,
                   const Wrapping& low, const Wrapping& end, bool second) {
  Mean m;
  if (shift == 1.0) {
    m.add(end, 1.0, 1.0);
    return m;
  }
  for (const double place : {kFirst, kSecond}) {
    const double at = shift + place * (1.0 - shift);
    const auto w = wrap_at(roller, pi_n + at * move, second);
    if (!w) {
      m = {};
      m.add(low, 0.5, shift);
      m.add(end, 0.5, 1.0);
      return m;
    }
    m.add(*w, 0.5, at);
  }
  return m;
}

/// Gonzalez's correction, after which G·Δπ is the change of the length. J. Nonlinear Sci. 6 (1996)
/// 449-467.
void correct(Mean& m, const Vec6& way, double shift, const Wrapping& low, const Wrapping& end) {
  const double square = way.squaredNorm();
  const double missing = end.length - low.length - m.G.dot(way);
  const Vec6 by =
      gradient(end) - shift * gradient(low) - m.by_end.transpose() * way - (1.0 - shift) * m.G;
  m.G += missing / square * way;
  m.by_end +=
      way / square * by.transpose() +
      missing * (1.0 - shift) / square * (Mat6::Identity() - 2.0 / square * way * way.transpose());
}

}  // namespace

Vec6 wound_coordinates(const WindingSpec& winding, const WoundNodes& nodes, const double* x) {
  const Vec3 middle = node(x, nodes[1]);
  Vec6 pi;
  for (int k = 0; k < 3; ++k) {
    const Vec3 along = (node(x, nodes[static_cast<std::size_t>(2 + k)]) - middle) / winding.arm;
    pi[k] = along.dot(node(x, nodes[0]) - middle);
    pi[3 + k] = along.dot(node(x, nodes[kWoundNodes - 1]) - middle);
  }
  return pi;
}

/// @eq{wrap-gradient}
WoundSpan wound_span(const WindingSpec& winding, const WoundNodes& nodes, const NodeStep& step,
                     bool tangents) {
  const double af = step.alpha_f, shift = 2.0 * af - 1.0, size = winding.roller.size();
  WoundSpan s;
  const Vec6 pi_n = wound_coordinates(winding, nodes, step.x_n);
  const Vec6 pi_n1 = wound_coordinates(winding, nodes, step.x_n1);
  std::array<Vec3, kWoundNodes> x_alpha, x_n1, middle, moved, v;
  for (std::size_t i = 0; i < kWoundNodes; ++i) {
    const int j = nodes[i];
    x_alpha[i] = step.position_alpha(j);
    x_n1[i] = node(step.x_n1, j);
    middle[i] = 0.5 * (node(step.x_n, j) + x_n1[i]);
    moved[i] = node(step.u, j);
    v[i] = step.velocity_alpha(j);
  }
  const auto flat = [](const std::array<Vec3, kWoundNodes>& list) {
    Vec18 all;
    for (int i = 0; i < kWoundNodes; ++i) all.segment<3>(3 * i) = list[static_cast<std::size_t>(i)];
    return all;
  };
  const Vec6 move = derivative(middle, winding.arm) * flat(moved);
  const auto start = wrap_at(winding.roller, pi_n, tangents && shift == 0.0);
  const auto end = wrap_at(winding.roller, pi_n1, tangents);
  s.outcome = WoundSpan::Outcome::inside;
  if (!start || !end) return s;
  s.l_n = start->length;
  s.l_n1 = end->length;
  // Gradients are unit vectors: a larger change is another course around the obstacle. So is one of
  // equal length on the opposite side.
  const double most = move.head<3>().norm() + move.tail<3>().norm();
  s.outcome = WoundSpan::Outcome::jumps;
  if (!(std::abs(s.l_n1 - s.l_n) <= (1.0 + kJump) * most + kRound * size)) return s;
  if (start->touches && end->touches && start->across.dot(end->across) < 0.0) return s;
  auto low = start;
  if (shift > 0.0) low = wrap_at(winding.roller, pi_n + shift * move, tangents);
  if (!low) low = end;
  s.outcome = WoundSpan::Outcome::straight;
  if (!start->touches && !low->touches && !end->touches) return s;
  s.outcome = WoundSpan::Outcome::wound;

  Mean mean = mean_gradient(winding.roller, pi_n, move, shift, *low, *end, tangents);
  const Vec6 way = (1.0 - shift) * move;
  const bool changes = low->touches != end->touches;
  if (way.norm() > (changes ? kCorrectedAtTouch : kCorrected) * size)
    correct(mean, way, shift, *low, *end);

  const Mat6x18 D_alpha = derivative(x_alpha, winding.arm), D_n1 = derivative(x_n1, winding.arm);
  const Vec6 pi_rate = D_alpha * flat(v);
  s.change = shift == 0.0 ? mean.G.dot(move) : s.l_n1 - s.l_n;
  s.n = D_alpha.transpose() * mean.G;
  s.e = D_n1.transpose() * gradient(*end);
  s.rate_alpha = mean.G.dot(pi_rate);
  if (!tangents) return s;
  const Mat6x18 turned = mean.by_end * D_n1;
  s.turn = D_alpha.transpose() * turned + af * bent(mean.G, winding.arm);
  s.rate = turned.transpose() * pi_rate +
           af * (step.rate * D_alpha + derivative(v, winding.arm)).transpose() * mean.G;
  return s;
}

}  // namespace polhode
