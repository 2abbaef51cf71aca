// SPDX-License-Identifier: Apache-2.0
// Springs between points of solids: tangents, balance of forces, and the work that they do.
#include <vector>

#include <gtest/gtest.h>

#include <polhode/loads/pair_on_nodes.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::pair_on_nodes_tests {
namespace {

constexpr int kNodes = 5;

class Pull final : public TimeFunction {
 public:
  double operator()(double t) const override { return 7.0 + 20.0 * t; }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), 20.0, 0.0};
  }
};

/// Points between three and two nodes, of which one belongs to both.
std::array<NodePoint, 2> points() {
  return {NodePoint{{0, 1, 2}, {0.2, 0.5, 0.3}}, NodePoint{{2, 3}, {0.4, 0.6}}};
}

std::unique_ptr<PairOnNodes> spring(const std::string& type) {
  LoadDescription d{.name = "spring", .bodies = {}};
  d.start_length = 0.6;
  if (type == "axial_force") {
    d.drive = "pull";
    d.function = std::make_shared<Pull>();
  } else if (type == "spring_damper") {
    d.values = {{"stiffness", 300.0}, {"quadratic", 50.0}, {"damping", 4.0}};
  } else {
    d.laws["energy"] = std::make_shared<Pull>();
  }
  return make_on_nodes(type)(d, points());
}

struct Moved {
  std::vector<double> x_n, x_n1, u, v_n, v_n1;
  StepContext context;
  double rate = 0.0;

  Moved(double rho_inf, double move, unsigned seed) {
    Random random(seed);
    context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
    context.t_n = 0.4;
    context.dt = 0.01;
    rate = context.ga.c / context.dt;
    for (int i = 0; i < kNodes; ++i) {
      const Vec3 at = random.vector(0.3) + 0.5 * i * Vec3::UnitX();
      const Vec3 way = random.vector(move), v = random.vector(2.0);
      for (int c = 0; c < 3; ++c) {
        x_n.push_back(at[c]);
        x_n1.push_back(at[c] + way[c]);
        u.push_back(way[c]);
        v_n.push_back(v[c]);
        v_n1.push_back(v[c] + rate * way[c]);
      }
    }
  }
  [[nodiscard]] Moved by(const Vec& d) const {
    Moved s = *this;
    for (std::size_t k = 0; k < x_n1.size(); ++k) {
      const double more = d[static_cast<Eigen::Index>(k)];
      s.x_n1[k] += more;
      s.u[k] += more;
      s.v_n1[k] += rate * more;
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
};

Vec force_of(const PairOnNodes& item, const Moved& moved, Mat* K = nullptr) {
  const int n = item.nodes_per_element();
  std::vector<double> f(3 * kNodes, 0.0), k(static_cast<std::size_t>(9 * n * n), 0.0);
  std::vector<int> slots;
  for (int i = 0; i < n * n; ++i) slots.push_back(i);
  item.evaluate(moved.step(), nullptr, nullptr, Mat3::Identity(),
                {f.data(), K != nullptr ? k.data() : nullptr, slots.data()});
  if (K != nullptr) {
    K->setZero(3 * kNodes, 3 * kNodes);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            (*K)(3 * item.nodes(0)[static_cast<std::size_t>(i)] + r,
                 3 * item.nodes(0)[static_cast<std::size_t>(j)] + c) +=
                k[static_cast<std::size_t>(9 * (i * n + j) + 3 * r + c)];
  }
  return Eigen::Map<const Vec>(f.data(), 3 * kNodes);
}

constexpr const char* kTypes[] = {"spring_damper", "axial_force", "potential"};

// @tests{spring-gradient}
TEST(PairOnNodes, TangentsAreThoseOfTheirForces) {
  for (const char* type : kTypes)
    for (const double rho_inf : {1.0, 0.6})
      for (const double move : {1e-3, 0.2}) {
        const auto item = spring(type);
        const Moved at(rho_inf, move, 3);
        Mat K;
        const Vec f = force_of(*item, at, &K);
        expect_derivative(
            K / 300.0, [&](const Vec& d) { return Vec(force_of(*item, at.by(d)) / 300.0); },
            std::string(type) + " tangent", 1e-6);
        EXPECT_GT(f.norm(), 0.1) << type;
        // The last node belongs to neither point.
        EXPECT_EQ(f.tail<3>().norm(), 0.0);
      }
}

// Forces cancel, and their moment about any point at the middle of the step; they are along the
// line of the points.
TEST(PairOnNodes, ForcesBalance) {
  for (const char* type : kTypes) {
    const auto item = spring(type);
    const Moved at(1.0, 0.2, 8);
    const Vec f = force_of(*item, at);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (int i = 0; i < kNodes; ++i) {
      sum += f.segment<3>(3 * i);
      moment += at.step().position_alpha(i).cross(Vec3(f.segment<3>(3 * i)));
    }
    EXPECT_LT(sum.norm(), 1e-13 * f.norm()) << type;
    EXPECT_LT(moment.norm(), 1e-13 * f.norm()) << type;
  }
}

// What the nodes receive is what the spring loses, exactly, over any step.
TEST(PairOnNodes, WorkOfTheForcesIsTheChangeOfEnergy) {
  for (const char* type : kTypes) {
    const auto item = spring(type);
    const Moved at(1.0, 0.2, 5);
    const Vec f = force_of(*item, at);
    const double done = f.dot(Eigen::Map<const Vec>(at.u.data(), 3 * kNodes));
    Moved before = at;
    before.x_n1 = before.x_n;
    const Work w = item->work(at.step(), nullptr, nullptr);
    const Work start = item->work(before.step(), nullptr, nullptr);
    // The damper's rate is that of the mean velocities, as is its dissipation.
    double power = w.dissipated;
    if (std::string(type) == "spring_damper") {
      Moved mean = at;
      for (std::size_t k = 0; k < mean.v_n.size(); ++k)
        mean.v_n[k] = mean.v_n1[k] = mean.u[k] / mean.context.dt;
      const Vec g = force_of(*item, mean);
      const double exact = g.dot(Eigen::Map<const Vec>(at.u.data(), 3 * kNodes));
      const Work of_mean = item->work(mean.step(), nullptr, nullptr);
      EXPECT_NEAR(exact, start.stored - of_mean.stored - of_mean.dissipated, 1e-10);
      continue;
    }
    EXPECT_NEAR(done, start.stored - w.stored - power + w.put_in, 1e-10) << type;
  }
}

TEST(PairOnNodes, ReportIsThatOfASpringBetweenBodies) {
  const auto item = spring("spring_damper");
  Moved at(1.0, 0.1, 2);
  at.x_n1 = at.x_n;
  const std::vector<double> values = item->report(at.step());
  const Vec3 a = 0.2 * at.step().at(at.x_n.data(), 0) + 0.5 * at.step().at(at.x_n.data(), 1) +
                 0.3 * at.step().at(at.x_n.data(), 2);
  const Vec3 b = 0.4 * at.step().at(at.x_n.data(), 2) + 0.6 * at.step().at(at.x_n.data(), 3);
  ASSERT_EQ(values.size(), 6u);
  EXPECT_NEAR(values[3], (b - a).norm(), 1e-14);
}

}  // namespace
}  // namespace polhode::test::pair_on_nodes_tests
