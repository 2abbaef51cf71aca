// SPDX-License-Identifier: Apache-2.0
// Helpers for tests of contact of solids' surfaces and cables over one step.
#pragma once

#include <vector>

#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/surface_law.hpp>
#include <polhode/system/changing_sparsity.hpp>
#include <polhode/system/nodes.hpp>
#include <support/random_steps.hpp>

namespace polhode::test {

/// Stiffnesses of size one, for surfaces of size one.
inline surface_contact::SurfaceLaw soft_law(double tolerance, double mu, double end_share = 0.0) {
  surface_contact::SurfaceLaw l;
  l.normal.tolerance = tolerance;
  l.normal.stiffness = 30.0;
  l.mu = mu;
  l.bristle = 40.0;
  l.end_share = end_share;
  return l;
}

/// Nodes that move over a step.
struct MovingNodes {
  std::vector<Vec3> X;
  std::vector<double> x_n, x_n1, u;
  StepContext context;
  double alpha_f = 0.5;

  [[nodiscard]] NodeStep step() const {
    return {x_n.data(), x_n1.data(), u.data(), u.data(), u.data(), context, alpha_f, 1.0};
  }
  [[nodiscard]] NodeStep start() const {
    return {x_n.data(), x_n.data(), u.data(), u.data(), u.data(), context, 1.0, 0.0};
  }
  void move(std::size_t k, double by) {
    x_n1[k] += by;
    u[k] += by;
  }
};

/// Forces on all nodes.
inline Vec forces_over(const NodeStep& step, std::size_t size, const ElementGroup& contact,
                       const std::vector<double>& history) {
  Vec f = Vec::Zero(static_cast<Eigen::Index>(size));
  contact.evaluate(step, history.data(), nullptr, Mat3::Identity(),
                   ElementSink{f.data(), nullptr, nullptr});
  return f;
}

/// The matrix of a group whose blocks move.
template <class Contact>
Mat tangent_over(const NodeStep& step, std::size_t size, const Contact& contact,
                 const std::vector<double>& history) {
  const NodeBlocks& blocks = contact.blocks(history.data());
  std::vector<double> values(9 * blocks.row.size(), 0.0);
  Vec f = Vec::Zero(static_cast<Eigen::Index>(size));
  contact.evaluate(step, history.data(), nullptr, Mat3::Identity(),
                   ElementSink{f.data(), values.data(), nullptr});
  Mat K = Mat::Zero(f.size(), f.size());
  for (std::size_t b = 0; b < blocks.row.size(); ++b)
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        K(3 * blocks.row[b] + r, 3 * blocks.column[b] + c) +=
            values[9 * b + static_cast<std::size_t>(3 * r + c)];
  return K;
}

inline Vec forces(const surface_contact::SolidContact& contact, const MovingNodes& nodes,
                  const std::vector<double>& history) {
  return forces_over(nodes.step(), nodes.x_n.size(), contact, history);
}
inline Mat tangent(const surface_contact::SolidContact& contact, const MovingNodes& nodes,
                   const std::vector<double>& history) {
  return tangent_over(nodes.step(), nodes.x_n.size(), contact, history);
}
/// Size of the history of a contact point of solids: its bristle comes first, later, among others,
/// the amount by which its band is lowered.
inline constexpr std::size_t kPointNumbers = 14, kLoweredNumber = 11;
inline std::size_t first_of_points(const MovingNodes& nodes) { return 3 * nodes.X.size() + 1; }

/// History at the start, with the whole band for points that start within it.
inline std::vector<double> with_whole_bands(const surface_contact::SolidContact& contact,
                                            const MovingNodes& nodes) {
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  for (std::size_t p = 1; p <= contact.points().size(); ++p)
    history[first_of_points(nodes) + kPointNumbers * (p - 1) + kLoweredNumber] = 0.0;
  return history;
}
/// A history in which every point has a bristle, and its whole band.
inline std::vector<double> bristles(const surface_contact::SolidContact& contact,
                                    const MovingNodes& nodes, unsigned seed) {
  Random random(seed);
  std::vector<double> history = with_whole_bands(contact, nodes);
  for (std::size_t p = 0; p < contact.points().size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      history[first_of_points(nodes) + kPointNumbers * p + c] = 0.05 * random.number();
  return history;
}

}  // namespace polhode::test
