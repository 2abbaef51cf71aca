// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include <polhode/newton/globalization.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::globalization_tests {
namespace {

using namespace test;

/// Engine whose iterations move body 0 along x by the listed increments, one after the other.
class ListedIncrements final : public NewtonEngine {
 public:
  ListedIncrements(const System& system, std::vector<double> list)
      : system_(system), list_(std::move(list)) {}
  [[nodiscard]] std::string name() const override { return "listed"; }
  void begin_step(const State&, Trial&) override {}
  void resume(const State&, Trial&) override { ++resumed; }
  Iteration iterate(const State& state, Trial& trial, bool, double damping) override {
    const double size = list_.at(static_cast<std::size_t>(calls++));
    const Vec3 u = body_step(system_, state, trial, 0).u;
    move_body(state, trial, system_.slot(0), u + Vec3(damping * size, 0, 0), Vec3::Zero());
    dampings.push_back(damping);
    Iteration done;
    done.solved = true;
    done.increment = size;
    return done;
  }
  [[nodiscard]] ConstraintCheck check(const State&, Trial&) override { return {}; }
  [[nodiscard]] int worst_body() const override { return 0; }
  void end_step(const State&, Trial&) override {}

  int calls = 0, resumed = 0;
  std::vector<double> dampings;

 private:
  const System& system_;
  std::vector<double> list_;
};

class OfABody : public testing::Test {
 protected:
  void SetUp() override {
    trial_.context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
    trial_.context.dt = 0.01;
    start_trial(system_, state_, trial_);
  }
  [[nodiscard]] double moved() const { return body_step(system_, state_, trial_, 0).u.x(); }

  System system_ = double_pendulum().system();
  State state_ = system_.initial_state();
  Trial trial_;
};

using GlobalizationOfGrowth = OfABody;

TEST_F(GlobalizationOfGrowth, UndoesALargeIncrementThatGrewAndHalvesTheNext) {
  ListedIncrements engine(system_, {0.1, 0.5, 0.4, 0.01});
  Globalization globalization(system_, state_, trial_, engine, true);
  (void)globalization.iterate(0.0, true);
  EXPECT_FALSE(globalization.undone());
  const double before = moved();
  (void)globalization.iterate(0.1, true);
  EXPECT_TRUE(globalization.undone());
  EXPECT_EQ(moved(), before);
  EXPECT_EQ(engine.resumed, 1);
  // An increment of that size is undone each time, until the damping is small.
  (void)globalization.iterate(0.1, true);
  EXPECT_TRUE(globalization.undone());
  (void)globalization.iterate(0.1, true);
  EXPECT_FALSE(globalization.undone());
  EXPECT_EQ(engine.dampings, (std::vector<double>{1.0, 1.0, 0.5, 0.25}));
  EXPECT_NEAR(moved(), 0.1 + 0.25 * 0.01, 1e-15);
}

TEST_F(GlobalizationOfGrowth, AcceptsSmallIncrementsAndEnginesWithTheirOwnSearch) {
  for (const bool undoes : {true, false}) {
    const double last = undoes ? 0.04 : 0.1;
    ListedIncrements engine(system_, {last, 0.5});
    Globalization globalization(system_, state_, trial_, engine, undoes);
    (void)globalization.iterate(0.0, true);
    (void)globalization.iterate(last, true);
    EXPECT_FALSE(globalization.undone());
    EXPECT_EQ(engine.resumed, 0);
  }
}

}  // namespace
}  // namespace polhode::globalization_tests
