// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstring>
#include <limits>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <polhode/system/state_archive.hpp>

namespace polhode::state_archive_tests {
namespace {

using testing::HasSubstr;

/// Bodies with joints, contact with friction and a spring.
const char* const kModel = R"(format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  box: {shape: {box: [0.2, 0.2, 0.2]}, density: 1000, position: [0, 0, 0.13], velocity: [1, 0, 0]}
  ball: {shape: {sphere: 0.2}, density: 1000, position: [0.5, 0, 0.12], velocity: [-1, 0, 0]}
  arm: {mass: 1, inertia: [1, 1, 1], position: [2, 0, 1]}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [1, 0, 1], axis: y}}
contacts: {default: {friction: 0.3}}
analysis: {duration: 1, step: 2 ms}
)";

struct Middle {
  Simulation simulation{io::read_model_text(kModel, "m.yaml")};
  std::string bytes;
  Middle() {
    for (int k = 0; k < 60; ++k) (void)simulation.step(1.0);  // The box touches the floor.
    bytes = state_bytes(simulation.system(), simulation.state());
  }
  [[nodiscard]] std::string refusal(const std::string& forged) const {
    try {
      Simulation other(Model(simulation.model()),
                       state_from_bytes(simulation.system(), forged, "forged.pst"));
      for (int k = 0; k < 2; ++k)
        if (!other.step(10.0).accepted) return "";
    } catch (const InputError& error) {
      return error.what();
    } catch (const SolveError&) {
    }
    return "";
  }
};

// Places in lists and counts within their bounds, a motion that is finite: the invariants of every
// state that a run has. A forged checkpoint has a valid checksum, so each number is checked.
TEST(StateArchive, RefusesPlacesBeyondTheEndOfAList) {
  const Middle m;
  State state = m.simulation.state();
  const auto forged = [&](auto change) {
    State other = state;
    change(other);
    return m.refusal(state_bytes(m.simulation.system(), other));
  };
  EXPECT_EQ(forged([](State&) {}), "");
  const char* none = "forged.pst: is no state. Take another checkpoint; this one is damaged.";
  EXPECT_EQ(forged([](State& s) { s.past_next = 992; }), none);
  EXPECT_EQ(forged([](State& s) { s.past_next = -1; }), none);
  EXPECT_EQ(forged([](State& s) { s.past_count = kPast + 1; }), none);
  EXPECT_EQ(forged([](State& s) { s.ledger.errors.body = 4; }), none);
  EXPECT_EQ(forged([](State& s) { s.ledger.errors.node = 0; }), none);
  EXPECT_EQ(forged([](State& s) { s.ledger.steps = -3; }), none);
  EXPECT_EQ(forged([](State& s) { s.easy_steps = -2; }), none);
  EXPECT_EQ(forged([](State& s) { s.blocks[0].r[1][0] = 1e300; }), none);
  EXPECT_EQ(forged([](State& s) { s.blocks[0].q[0][0] += 0.5; }), none);
  EXPECT_EQ(forged([](State& s) { s.t = std::numeric_limits<double>::quiet_NaN(); }), none);
  const char* contacts =
      "restart: has contacts that this model cannot have. Take another checkpoint; this one is "
      "damaged.";
  EXPECT_EQ(forged([](State& s) { s.contacts[0] = -5.0; }), contacts);
  EXPECT_EQ(forged([](State& s) { s.contacts[0] = 1e18; }), contacts);
  EXPECT_EQ(forged([](State& s) { s.contacts.pop_back(); }), contacts);
  // The first number of the last record of a row, of 22 numbers, is its shape.
  EXPECT_EQ(forged([](State& s) { s.contacts[s.contacts.size() - 22] = 1e9; }), contacts);
}

// Any eight bytes replaced: refused, or a run that ends with a message; the sanitizers watch.
TEST(StateArchive, SurvivesEveryForgedNumber) {
  const Middle m;
  const auto number = [](double x) { return std::bit_cast<std::int64_t>(x); };
  int refused = 0, tried = 0;
  const std::int64_t values[] = {-1,
                                 1000,
                                 std::int64_t{1} << 62,
                                 number(1e300),
                                 number(1e18),
                                 number(std::numeric_limits<double>::quiet_NaN())};
  for (std::size_t at = 0; at + 8 <= m.bytes.size(); at += 8) {
    std::string forged = m.bytes;
    std::memcpy(forged.data() + at, &values[(at / 8) % 6], 8);
    ++tried;
    refused += m.refusal(forged).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, tried / 4);
}

TEST(StateArchive, ASealedStateIsRefusedWithAChangedByte) {
  const Middle m;
  const System& system = m.simulation.system();
  const std::string sealed = sealed_state(system, m.simulation.state());
  EXPECT_EQ(state_bytes(system, state_from_sealed(system, sealed, "state")), m.bytes);
  for (std::size_t at = 0; at < sealed.size(); at += 131) {
    std::string bad = sealed;
    bad[at] = static_cast<char>(bad[at] ^ 1);
    try {
      (void)state_from_sealed(system, bad, "state");
      ADD_FAILURE() << at;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("its checksum is wrong"));
    }
  }
  EXPECT_THROW((void)state_from_sealed(system, "short", "state"), InputError);
}

}  // namespace
}  // namespace polhode::state_archive_tests
