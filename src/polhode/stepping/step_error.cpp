// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/step_error.hpp>

#include <algorithm>
#include <cmath>

#include <polhode/system/internal_unknowns.hpp>

namespace polhode {

namespace {

/// Largest distance of two fields with three numbers a node.
double distance(const std::vector<double>& x, const std::vector<double>& y) {
  double most = 0.0;
  for (std::size_t k = 0; k + 2 < x.size(); k += 3)
    most = std::max(most, std::hypot(x[k] - y[k], x[k + 1] - y[k + 1], x[k + 2] - y[k + 2]));
  return most;
}

double body_difference(const System& system, const State& x, const State& y, double H, int body) {
  const double per_length = 1.0 / system.length_scale();
  const BodyMotion m = system.motion(x, body), n = system.motion(y, body);
  return std::max({per_length * (m.r - n.r).norm(), 2.0 * (m.q.conjugate() * n.q).vec().norm(),
                   per_length * H * (m.v - n.v).norm(), H * (m.W - n.W).norm()});
}

}  // namespace

int most_different_body(const System& system, const State& x, const State& y, double H) {
  int worst = -1;
  double most = 0.0;
  for (int b = 0; b < system.body_count(); ++b) {
    const double of_body = body_difference(system, x, y, H, b);
    if (of_body > most) worst = b;
    most = std::max(most, of_body);
  }
  return most >= state_difference(system, x, y, H) ? worst : -1;
}

double state_difference(const System& system, const State& x, const State& y, double H) {
  double most = 0.0;
  const double per_length = 1.0 / system.length_scale();
  for (int b = 0; b < system.body_count(); ++b)
    most = std::max(most, body_difference(system, x, y, H, b));
  most = std::max({most, per_length * distance(x.node_x, y.node_x),
                   per_length * H * distance(x.node_v, y.node_v)});
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    if (const InternalUnknowns* inner = nodes.group(g).internal_unknowns()) {
      const std::size_t first = nodes.first_history(g);
      most = std::max(most, per_length * inner->difference(x.element_history.data() + first,
                                                           y.element_history.data() + first));
    }
  return most;
}

double jump_difference(const System& system, const State& x, const State& y, double H) {
  double most = 0.0;
  const double per_length = 1.0 / system.length_scale();
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(x, b), n = system.motion(y, b);
    most = std::max({most, per_length * (m.v - n.v).norm(), (m.W - n.W).norm()});
  }
  return H * std::max(most, per_length * distance(x.node_v, y.node_v));
}

double extent(const System& system) {
  const State& start = system.initial_state();
  double far = 0.0;
  for (int b = 0; b < system.body_count(); ++b)
    far = std::max(far, system.motion(start, b).r.norm());
  for (const double x : start.node_x) far = std::max(far, std::abs(x));
  return far;
}

}  // namespace polhode
