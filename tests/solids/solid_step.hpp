// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include <Eigen/Dense>

#include <solids/materials/example_materials.hpp>
#include <support/random_steps.hpp>

#include <polhode/solids/solid_elements.hpp>

namespace polhode::test {

/// Groups of elements over some nodes in one step, with dense matrices.
class SolidStep {
 public:
  std::vector<Vec3> X;
  StepContext context;
  double alpha_f, rate;
  bool mixed_point = false;
  Vec x_n, x_n1, v_n, free_velocity;  ///< v_{n+1} = rate (x_{n+1} − x_n) + free_velocity.
  std::vector<double> history, scratch;

  SolidStep(std::vector<Vec3> positions, const StepContext& with)
      : X(std::move(positions)),
        context(with),
        alpha_f(with.ga.alpha_f),
        rate(with.ga.gamma / (with.ga.beta * with.dt)) {
    x_n.resize(3 * static_cast<Eigen::Index>(X.size()));
    for (std::size_t i = 0; i < X.size(); ++i) x_n.segment<3>(3 * static_cast<int>(i)) = X[i];
    x_n1 = x_n;
    v_n = free_velocity = Vec::Zero(x_n.size());
  }

  /// Random strains at both ends of the step, with large rotations and a displacement.
  /// @param turn  Size of the rotation of the second end relative to the first; 1: arbitrary.
  void move_at_random(Random& random, double size, double turn = 1.0) {
    const Mat3 first = random.frame();
    const auto place = [&](Vec& x) {
      const Mat3 Q = &x == &x_n
                         ? first
                         : Mat3(quaternion_from_rotation_vector(2.5 * turn * random.direction())
                                    .toRotationMatrix() *
                                first);
      Mat3 H;
      for (int i = 0; i < 9; ++i) H.data()[i] = random.number(size);
      const Vec3 r = random.vector();
      for (int i = 0; i < nodes(); ++i)
        x.segment<3>(3 * i) = r + Q * ((Mat3::Identity() + H) * X[static_cast<std::size_t>(i)] +
                                       random.vector(0.2 * size));
    };
    place(x_n);
    place(x_n1);
    for (int i = 0; i < x_n.size(); ++i) v_n[i] = random.number(2.0);
    // At ρ∞ = 1 the mean of the velocities is that of the step.
    free_velocity = -v_n;
    if (context.ga.alpha_f != 0.5)
      for (int i = 0; i < x_n.size(); ++i) free_velocity[i] = random.number(2.0);
  }
  /// The instant at x_n, as in a static analysis.
  void stand_still() {
    alpha_f = 1.0;
    rate = 0.0;
    x_n1 = x_n;
    v_n.setZero();
    free_velocity.setZero();
  }

  [[nodiscard]] int nodes() const { return static_cast<int>(X.size()); }

  /// Allocates the internal unknowns of a group.
  void begin(const ElementGroup& group) {
    history.assign(group.history_size(), 0.0);
    scratch.assign(group.scratch_size(), 0.0);
    group.initialize(history.data());
    group.begin_step(history.data(), scratch.data());
  }

  template <class Use>
  auto with(const Use& use) const {
    const Vec u = x_n1 - x_n, v_n1 = rate * u + free_velocity;
    const bool still = rate == 0.0;
    const NodeStep step{.x_n = x_n.data(),
                        .x_n1 = still ? x_n.data() : x_n1.data(),
                        .u = u.data(),
                        .v_n = v_n.data(),
                        .v_n1 = still ? v_n.data() : v_n1.data(),
                        .context = context,
                        .alpha_f = alpha_f,
                        .rate = rate,
                        .mixed_point = mixed_point};
    return use(step);
  }

  struct Result {
    Vec force;
    Mat tangent;
    ElementReport report;
  };
  Result evaluate(const ElementGroup& group, bool tangents = true,
                  const Mat3& turn = Mat3::Identity()) {
    const int n = nodes(), m = group.nodes_per_element();
    std::vector<int> slots;
    for (int e = 0; e < group.size(); ++e)
      for (int i = 0; i < m; ++i)
        for (int j = 0; j < m; ++j) slots.push_back(group.nodes(e)[i] * n + group.nodes(e)[j]);
    Result r;
    r.force = Vec::Zero(3 * n);
    std::vector<double> blocks(tangents ? 9 * static_cast<std::size_t>(n) * n : 0);
    const ElementSink sink{r.force.data(), tangents ? blocks.data() : nullptr, slots.data()};
    with([&](const NodeStep& step) {
      r.report = group.evaluate(step, history.data(), scratch.data(), turn, sink);
      return 0;
    });
    if (!tangents) return r;
    r.tangent.resize(3 * n, 3 * n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < 9; ++k)
          r.tangent(3 * i + k / 3, 3 * j + k % 3) =
              blocks[9 * (static_cast<std::size_t>(i) * n + j) + k];
    return r;
  }
  /// The same with internal unknowns in equilibrium.
  Result evaluate_balanced(const ElementGroup& group) {
    if (group.scratch_size() > 0) {
      const Vec still = Vec::Zero(x_n.size());
      for (int i = 0; i < 30; ++i) {
        evaluate(group);
        if (group.advance(still.data(), Mat3::Identity(), scratch.data()) < 1e-14) break;
      }
    }
    return evaluate(group);
  }
  Work work(const ElementGroup& group) const {
    return with([&](const NodeStep& s) { return group.work(s, history.data(), scratch.data()); });
  }
  /// Energy at t_n, evaluated at that instant.
  double stored_at_start(const ElementGroup& group) const {
    SolidStep start = *this;
    start.stand_still();
    return start.with([&](const NodeStep& s) { return group.work(s, history.data(), nullptr); })
        .stored;
  }
};

/// A material of the examples, with viscosity if given.
[[nodiscard]] inline std::shared_ptr<const solids::Material> example_material(
    solids::MaterialDescription d, bool viscous = false) {
  if (viscous) d.relaxation_time = 0.2;
  return solids::make_material("materials.m", d);
}

/// A material whose stress relaxes, within a step and in ten; its constant part has a factor.
[[nodiscard]] inline std::shared_ptr<const solids::Material> relaxing_material(
    solids::MaterialDescription d) {
  d.relaxation = {{0.7, 0.05}, {0.4, 1.1}};
  d.long_term_ratio = 0.6;
  return solids::make_material("materials.m", d);
}

/// One element of a kind, slightly distorted; lengths of about 2.
/// Distance of the nearest nodes of a reference cell over half an edge of a tetrahedron, at most 1:
/// strains by random displacements of nodes are the larger the nearer these are.
[[nodiscard]] inline double closeness(const solids::CellShape& cell) {
  double least = 0.5;
  for (int a = 0; a < cell.size(); ++a)
    for (int b = 0; b < a; ++b)
      least = std::min(
          least, (cell.nodes[static_cast<std::size_t>(a)] - cell.nodes[static_cast<std::size_t>(b)])
                     .norm());
  return least / 0.5;
}

[[nodiscard]] inline std::vector<Vec3> distorted_element(const solids::ElementKind& kind,
                                                         Random& random, double size = 0.06) {
  std::vector<Vec3> X;
  const double most = size * closeness(kind.cell());
  for (const Vec3& xi : kind.cell().nodes) X.push_back(xi + random.vector(most));
  return X;
}

[[nodiscard]] inline std::unique_ptr<solids::SolidElements> one_element(
    const solids::ElementKind& kind, std::span<const Vec3> X,
    std::shared_ptr<const solids::Material> material, bool conserving = true,
    const std::string& isa = "automatic") {
  std::vector<int> connectivity;
  for (int i = 0; i < kind.sizes().nodes; ++i) connectivity.push_back(i);
  const std::vector<Vec3> fibres = example_directions(*material);
  return solids::make_solid_elements({.name = "solids.one",
                                      .element = kind.name,
                                      .material = std::move(material),
                                      .density = 1100.0,
                                      .conserving = conserving,
                                      .connectivity = connectivity,
                                      .X = X,
                                      .fibres = fibres,
                                      .isa = isa});
}

/// Whether a material can be used in an element.
[[nodiscard]] inline bool suits(const solids::ElementKind& kind,
                                const solids::MaterialDescription& material) {
  return !kind.sizes().mean_dilatation || solids::material_kind(material.kind).uncoupled;
}

}  // namespace polhode::test
