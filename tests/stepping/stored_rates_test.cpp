// SPDX-License-Identifier: Apache-2.0
// Accelerations that belong to t_n + δΔt, carried to steps of other lengths.
#include <polhode/stepping/stored_rates.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <polhode/system/lane_access.hpp>
#include <stepping/stepped_model.hpp>

namespace polhode::stored_rates_tests {
namespace {

constexpr const char* kTwoBodies = R"(
format: 1
bodies:
  a: {mass: 1, inertia: [1, 2, 3], position: [1, 0, 0]}
  b: {mass: 2, inertia: [2, 2, 1], position: [0, 3, 0]}
analysis: {duration: 1, step: 0.1}
)";

/// A state whose a, A and ḣ of body b are b + 1, b + 2 and b + 3 times (1, -2, 4).
struct Bench {
  explicit Bench(double rho_inf)
      : ga(GeneralizedAlpha::from_spectral_radius(rho_inf)), model(kTwoBodies, rho_inf) {
    for (int b = 0; b < 2; ++b) set(b, 1.0);
  }
  void set(int body, double factor) {
    const int slot = model.system.slot(body), lane = slot % kLanes;
    BodyBlock& block = model.state.blocks[static_cast<std::size_t>(slot / kLanes)];
    const Vec3 along(1.0, -2.0, 4.0);
    put(block.a, lane, factor * (body + 1.0) * along);
    put(block.A, lane, factor * (body + 2.0) * along);
    put(block.h_dot, lane, factor * (body + 3.0) * along);
  }
  [[nodiscard]] double a(int body) const {
    const int slot = model.system.slot(body);
    return model.state.blocks[static_cast<std::size_t>(slot / kLanes)].a[0][slot % kLanes];
  }
  [[nodiscard]] double h_dot(int body) const {
    const int slot = model.system.slot(body);
    return model.state.blocks[static_cast<std::size_t>(slot / kLanes)].h_dot[2][slot % kLanes];
  }

  GeneralizedAlpha ga;
  test::SteppedModel model;
};

TEST(StoredRates, AreNotThereWhereTheyAreNotUsed) {
  Bench bench(1.0);
  begin_stored_rates(bench.model.state, bench.ga, 0.1);
  EXPECT_EQ(bench.ga.delta, 0.0);
  EXPECT_TRUE(bench.model.state.rates.empty());
  adapt_stored_rates(bench.model.state, bench.ga, 0.3);
  renew_stored_rates(bench.model.state, bench.ga, 0.3);
  EXPECT_EQ(bench.a(1), 2.0);
}

TEST(StoredRates, CarryALinearAccelerationToAStepOfAnyLength) {
  for (const double rho_inf : {0.0, 0.5, 0.9}) {
    Bench bench(rho_inf);
    State& state = bench.model.state;
    begin_stored_rates(state, bench.ga, 0.1);
    const int slot = bench.model.system.slot(1);
    set_stored_rate(state, slot, Vec3(3.0, 0, 0), Vec3::Zero(), Vec3(0, 0, -7.0));
    for (const double dt : {0.1, 0.025, 0.4}) {
      adapt_stored_rates(state, bench.ga, dt);
      const double later = bench.ga.delta * (dt - 0.1);
      EXPECT_NEAR(bench.a(1), 2.0 + 3.0 * later, 1e-15) << rho_inf << ' ' << dt;
      EXPECT_NEAR(bench.h_dot(1), 16.0 - 7.0 * later, 1e-14) << rho_inf << ' ' << dt;
      EXPECT_EQ(bench.a(0), 1.0) << "the other body has no rate";
      // A rejected step leaves no trace, and one of the same length changes nothing.
      restore_stored_rates(state);
      EXPECT_EQ(bench.a(1), 2.0);
      EXPECT_EQ(bench.h_dot(1), 16.0);
    }
  }
}

// An acceleration that grows evenly in time: a(t_n + δΔt) in steps of changing length. The rate is
// found from nothing: a quarter of what a step shows is taken over.
TEST(StoredRates, AreLearntFromTheSteps) {
  Bench bench(0.4);
  State& state = bench.model.state;
  const double delta = bench.ga.delta, slope = 5.0;
  ASSERT_NE(delta, 0.0);
  double t = 0.0, last = 0.1, wrong = slope;
  bench.set(0, 1.0 + slope * delta * last);
  begin_stored_rates(state, bench.ga, last);
  for (int step = 0; step < 60; ++step) {
    const double dt = step % 3 == 0 ? 0.05 : step % 3 == 1 ? 0.2 : 0.1;
    adapt_stored_rates(state, bench.ga, dt);
    const double exact = 1.0 + slope * (t + delta * dt);
    EXPECT_NEAR(bench.a(0) - exact, -wrong * delta * (dt - last), 1e-13 * std::abs(exact)) << step;
    t += dt;
    bench.set(0, 1.0 + slope * (t + delta * dt));
    renew_stored_rates(state, bench.ga, dt);
    wrong *= 1.0 - 0.25 * (1.0 + delta * (dt - last) / dt);
    last = dt;
  }
  EXPECT_LT(std::abs(wrong), 1e-6);
}

}  // namespace
}  // namespace polhode::stored_rates_tests
