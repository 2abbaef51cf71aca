// SPDX-License-Identifier: Apache-2.0
// Spans of a running cable around an obstacle: work, momenta, tangents.
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/beams/running_cable.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::wound_span_tests {
namespace {

class Ramp final : public TimeFunction {
 public:
  double operator()(double t) const override { return 0.3 + 0.2 * t; }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), 0.2, 0.0};
  }
};

/// Three points, then the frame of the obstacle between the first two.
constexpr int kNodes = 7;
constexpr double kArm = 0.2;

std::vector<geometry::Roller> rollers() {
  const double infinite = std::numeric_limits<double>::infinity();
  geometry::Roller sided{{0.2, 0.2, infinite}};
  sided.side = Vec3(0.0, -1.0, 0.0);  // the longer way
  return {{{0.2, 0.2, 0.2}}, {{0.2, 0.2, infinite}}, {{0.25, 0.2, 0.15}}, sided};
}

RunningCableSpec cable(const geometry::Roller& roller, int kind) {
  RunningCableSpec spec;
  spec.name = "rope";
  spec.nodes = {0, 1, 2};
  spec.stiffness = 300.0;
  spec.free_length = 1.0;
  spec.windings = {{.name = "bone", .span = 0, .roller = roller, .frame = {3, 4, 5, 6}}};
  spec.windings[0].arm = kArm;
  if (kind == 1) spec.damping = 5.0;
  if (kind == 2) {
    spec.stiffness = 0.0;
    spec.muscle = HillMuscle{.max_force = 400.0,
                             .optimal_length = 0.7,
                             .tendon_length = 0.7,
                             .pennation = 0.3,
                             .max_velocity = 8.0,
                             .damping = 0.1,
                             .activation = std::make_shared<Ramp>()};
  }
  return spec;
}

/// A step of all nodes; the obstacle moves as a rigid body.
struct Sample {
  RunningCable cable;
  std::vector<double> x_n, x_n1, u, v_n, v_n1;
  StepContext context;
  double rate = 0.0;

  Sample(const RunningCableSpec& spec, double rho_inf, double move, unsigned seed) : cable(spec) {
    Random random(seed);
    context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
    context.t_n = 0.4;
    context.dt = 0.01;
    rate = context.ga.c / context.dt;
    const auto add = [&](const Vec3& from, const Vec3& to) {
      const Vec3 v = random.vector(2.0);
      for (int c = 0; c < 3; ++c) {
        x_n.push_back(from[c]);
        x_n1.push_back(to[c]);
        u.push_back(to[c] - from[c]);
        v_n.push_back(v[c]);
        v_n1.push_back(v[c] + rate * (to[c] - from[c]));
      }
    };
    const Mat3 turn_n = exp_map(random.vector(1.0));
    const Mat3 turn_n1 = exp_map(random.vector(move)) * turn_n;
    const Vec3 r_n = random.vector(0.3), r_n1 = r_n + random.vector(move);
    for (const Vec3& at : {Vec3(-0.5, 0.08, 0.05), Vec3(0.4, 0.1, -0.1), Vec3(0.6, 0.7, 0.0)}) {
      const Vec3 x = r_n + turn_n * at;
      add(x, x + random.vector(move));
    }
    add(r_n, r_n1);
    for (int k = 0; k < 3; ++k) add(r_n + kArm * turn_n.col(k), r_n1 + kArm * turn_n1.col(k));
  }
  [[nodiscard]] Sample moved(const Vec& d) const {
    Sample s = *this;
    for (std::size_t k = 0; k < x_n1.size(); ++k) {
      const double by = d[static_cast<Eigen::Index>(k)];
      s.x_n1[k] += by;
      s.u[k] += by;
      s.v_n1[k] += rate * by;
    }
    return s;
  }
  [[nodiscard]] NodeStep step() const {
    return {.x_n = x_n.data(),
            .x_n1 = x_n1.data(),
            .u = u.data(),
            .v_n = v_n.data(),
            .v_n1 = v_n1.data(),
            .context = context,
            .alpha_f = context.ga.alpha_f,
            .rate = rate};
  }
  /// Force on the nodes in their own order; the tangent likewise.
  [[nodiscard]] Vec force(Mat* K = nullptr) const {
    std::vector<double> f(3 * kNodes, 0.0), k(9 * kNodes * kNodes, 0.0);
    std::vector<int> slots;
    for (int i = 0; i < kNodes * kNodes; ++i) slots.push_back(i);
    const ElementReport report = cable.evaluate(step(), nullptr, nullptr, Mat3::Identity(),
                                                {f.data(), K ? k.data() : nullptr, slots.data()});
    EXPECT_GT(report.least_volume, 0.0);
    if (K) {
      K->resize(3 * kNodes, 3 * kNodes);
      for (int i = 0; i < kNodes; ++i)
        for (int j = 0; j < kNodes; ++j)
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              (*K)(3 * i + r, 3 * j + c) =
                  k[static_cast<std::size_t>(9 * (i * kNodes + j) + 3 * r + c)];
    }
    return Eigen::Map<const Vec>(f.data(), 3 * kNodes);
  }
};

}  // namespace

// Nodes of the frame are moved one by one, which no rigid body does: the tangent holds there too.
TEST(WoundSpan, HasTheTangentOfItsForces) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (const double move : {0.06, 1e-5})
      for (const geometry::Roller& roller : rollers())
        for (int kind = 0; kind < 3; ++kind) {
          const Sample s(cable(roller, kind), rho_inf, move, 2);
          Mat K;
          (void)s.force(&K);
          expect_derivative(
              K, [&](const Vec& d) -> Vec { return s.moved(d).force(); },
              "kind " + std::to_string(kind) + " rho " + std::to_string(rho_inf), 2e-7, 2e-6);
        }
}

// Work is the stored energy, the dissipated and the supplied one; resultant force and moment
// vanish.
// @tests{wrap-gradient}
TEST(WoundSpan, ReturnsExactlyTheEnergyItStored) {
  for (const double move : {0.06, 0.02, 1e-3, 1e-4, 1e-7})
    for (unsigned seed = 1; seed <= 3; ++seed)
      for (const geometry::Roller& roller : rollers())
        for (int kind = 0; kind < 3; ++kind) {
          const Sample s(cable(roller, kind), 1.0, move, seed);
          const Vec f = s.force();
          Sample before = s;
          before.x_n1 = s.x_n;
          before.context.dt = 0.0;
          const Work w = s.cable.work(s.step(), nullptr, nullptr);
          const double stored =
              w.stored - before.cable.work(before.step(), nullptr, nullptr).stored;
          const double work = f.dot(Eigen::Map<const Vec>(s.u.data(), 3 * kNodes));
          EXPECT_NEAR(work, w.put_in - w.dissipated - stored, 2e-13 * (1.0 + f.norm()))
              << seed << " move " << move << " kind " << kind;
          Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
          for (int i = 0; i < kNodes; ++i) {
            const Vec3 force = f.segment<3>(3 * i);
            sum += force;
            moment += s.step().position_alpha(i).cross(force);
          }
          EXPECT_LT(sum.norm(), 1e-13 * (1.0 + f.norm()));
          EXPECT_LT(moment.norm(), 1e-13 * (1.0 + f.norm()));
        }
}

// A step in which it lifts off, one in which it comes down, one along the surface through which the
// straight way of a point would go.
TEST(WoundSpan, KeepsEnergyWhereItLiftsOffAndTouches) {
  const geometry::Roller roller{{0.2, 0.2, 0.2}};
  const Vec3 high(-0.5, 0.3, 0.0), low(-0.5, 0.05, 0.0), behind(-0.25, -0.05, 0.0);
  for (const auto& [from, to] : {std::pair{low, high}, {high, low}, {high, behind}})
    for (const double part : {1.0, 1e-2}) {
      Sample s(cable(roller, 0), 1.0, 0.0, 1);
      const Vec3 grazes(-0.5, 0.2 - 1e-4, 0.0), other(0.4, 0.2, 0.0);
      const Vec3 middle = part == 1.0 ? 0.5 * (from + to) : grazes;
      for (int c = 0; c < 3; ++c) {
        const auto i = static_cast<std::size_t>(c);
        for (const std::size_t node : {3, 4, 5, 6})
          s.x_n[3 * node + i] = s.x_n1[3 * node + i] = static_cast<int>(node) == 4 + c ? kArm : 0.0;
        s.x_n[3 + i] = s.x_n1[3 + i] = other[c];
        s.x_n[i] = middle[c] - 0.5 * part * (to - from)[c];
        s.x_n1[i] = middle[c] + 0.5 * part * (to - from)[c];
        s.u[i] = s.x_n1[i] - s.x_n[i];
      }
      const Vec f = s.force();
      Sample before = s;
      before.x_n1 = s.x_n;
      before.context.dt = 0.0;
      const double stored = s.cable.work(s.step(), nullptr, nullptr).stored -
                            before.cable.work(before.step(), nullptr, nullptr).stored;
      EXPECT_NEAR(f.dot(Eigen::Map<const Vec>(s.u.data(), 3 * kNodes)), -stored,
                  1e-12 * (1.0 + f.norm()));
    }
}

// Refused: a point inside of the obstacle, and a course on its other side.
TEST(WoundSpan, RefusesWhatNoCableDoes) {
  geometry::Roller roller{{0.2, 0.2, std::numeric_limits<double>::infinity()}};
  roller.side = Vec3::UnitY();
  const auto least = [&](const Vec3& from, const Vec3& to) {
    Sample s(cable(roller, 0), 1.0, 0.0, 1);
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      for (const std::size_t node : {3, 4, 5, 6})
        s.x_n[3 * node + i] = s.x_n1[3 * node + i] = static_cast<int>(node) == 4 + c ? kArm : 0.0;
      s.x_n[3 + i] = s.x_n1[3 + i] = Vec3(0.4, 0.0, 0.0)[c];
      s.x_n[i] = from[c];
      s.x_n1[i] = to[c];
      s.u[i] = to[c] - from[c];
    }
    std::vector<double> f(3 * kNodes, 0.0);
    return s.cable
        .evaluate(s.step(), nullptr, nullptr, Mat3::Identity(), {f.data(), nullptr, nullptr})
        .least_volume;
  };
  EXPECT_EQ(least({-0.4, 0.0, 0.0}, {-0.35, 0.05, 0.0}), 1.0);
  EXPECT_EQ(least({-0.4, 0.0, 0.0}, {-0.15, 0.0, 0.0}), RunningCable::kNoLine);
  EXPECT_EQ(least({-0.05, -0.4, 0.0}, {0.05, -0.4, 0.0}), RunningCable::kNoLine);
}

}  // namespace polhode::test::wound_span_tests
