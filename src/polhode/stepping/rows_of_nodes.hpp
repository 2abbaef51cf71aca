// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/equations/node_motion.hpp>

namespace polhode {

/// All rows of nodes at an instant, in terms of its bodies.
struct RowsOfNodes {
  std::vector<NodeRow> rows;
  std::vector<std::vector<Vec6>> on_bodies;  ///< By row and body: force and moment of λ = 1.

  RowsOfNodes(const System& system, const State& state, const StepContext& context) {
    const Nodes& nodes = system.nodes();
    const NodeStep instant = node_instant(system, state, context);
    for (int g = 0; g < nodes.group_count(); ++g)
      if (const SlideOnBeam* slide = as_slide(nodes.group(g)))
        slide->rows(instant, state.element_history.data() + nodes.first_history(g), rows);
    for (const NodeRow& row : rows) {
      std::vector<Vec6> wrench(static_cast<std::size_t>(system.body_count()), Vec6::Zero());
      for (const auto& [node, n] : row.on) {
        const NodeData& data = nodes[node];
        if (data.body < 0) continue;
        Vec6& w = wrench[static_cast<std::size_t>(data.body)];
        w.head<3>() += n;
        w.tail<3>() += (system.motion(state, data.body).q * data.Z).cross(n);
      }
      on_bodies.push_back(std::move(wrench));
    }
  }
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(rows.size()); }
  /// Adds the wrenches of multipliers.
  void add(const Vec& lambda, std::vector<Vec6>& wrenches) const {
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t b = 0; b < wrenches.size(); ++b)
        wrenches[b] += lambda[static_cast<Eigen::Index>(r)] * on_bodies[r][b];
  }
  /// Subtracts the forces of multipliers from those of the bodies on their nodes.
  void subtract(const Vec& lambda, std::vector<double>& forces) const {
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const auto& [node, n] : rows[r].on)
        Eigen::Map<Vec3>(forces.data() + 3 * static_cast<std::ptrdiff_t>(node)) -=
            lambda[static_cast<Eigen::Index>(r)] * n;
  }
  /// Σ n·x of all rows. @param x  By node, three each.
  [[nodiscard]] Vec times(const std::vector<double>& x) const {
    Vec sum = Vec::Zero(count());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (const auto& [node, n] : rows[r].on)
        sum[static_cast<Eigen::Index>(r)] += n.dot(at_node(x, node));
    return sum;
  }
  /// Likewise of velocities by body (linear, angular).
  [[nodiscard]] Vec times(const std::vector<Vec6>& v) const {
    Vec sum = Vec::Zero(count());
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t b = 0; b < v.size(); ++b)
        sum[static_cast<Eigen::Index>(r)] += on_bodies[r][b].dot(v[b]);
    return sum;
  }
  [[nodiscard]] Vec targets(double NodeRow::*which) const {
    Vec t(count());
    for (std::size_t r = 0; r < rows.size(); ++r) t[static_cast<Eigen::Index>(r)] = rows[r].*which;
    return t;
  }
};

inline bool has_rows(const System& system) {
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    if (as_slide(nodes.group(g))) return true;
  return false;
}

}  // namespace polhode
