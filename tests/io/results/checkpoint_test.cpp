// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/checkpoint.hpp>

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/compile/build_system.hpp>
#include <polhode/core/error.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/scratch.hpp>

namespace polhode::checkpoint_tests {
namespace {

using testing::HasSubstr;

/// A chain of hinged bodies on the ground, the last one free.
Model chain(int bodies) {
  Model model;
  model.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i < bodies; ++i) {
    BodySpec body;
    body.name = "b" + std::to_string(i);
    body.mass = 1.0;
    body.inertia = Vec3(0.1, 0.2, 0.25).asDiagonal();
    body.position = Vec3(i + 0.5, 0.0, 0.0);
    model.bodies.push_back(body);
    if (i + 1 == bodies) break;
    JointSpec joint;
    joint.name = "j" + std::to_string(i);
    joint.type = i % 2 == 0 ? "revolute" : "spherical";
    joint.a = i - 1;
    joint.b = i;
    joint.Z_a = i == 0 ? Vec3::Zero() : Vec3(0.5, 0.0, 0.0);
    joint.Z_b = {-0.5, 0.0, 0.0};
    model.joints.push_back(joint);
  }
  return model;
}

/// A state in which all numbers differ.
State unlike_any_other(const System& system) {
  State state = system.initial_state();
  double next = 0.1;
  const auto number = [&] { return next += 1.0 / 3.0; };
  state.t = number();
  for (int i = 0; i < system.body_count(); ++i) {
    BodyMotion m;
    for (Vec3* x : {&m.r, &m.v, &m.W, &m.a, &m.A, &m.h_dot})
      *x = Vec3(number(), number(), number());
    m.q = Quat(number(), number(), number(), number()).normalized();
    state.set_motion(system.slot(i), m);
    BodyBlock& block = state.blocks[static_cast<std::size_t>(system.slot(i) / kLanes)];
    const int lane = system.slot(i) % kLanes;
    for (int c = 0; c < 3; ++c) {
      block.r_rest[c][lane] = number();
      for (int k = 0; k < kPast; ++k) {
        block.past_v[k][c][lane] = number();
        block.past_W[k][c][lane] = number();
      }
    }
  }
  for (double& x : state.lambda) x = number();
  for (double& x : state.history) x = number();
  for (double& x : state.past_time) x = number();
  state.past_count = 3;
  state.past_next = 2;
  state.dt_last = number();
  state.dt_next = number();
  state.error_last = number();
  state.easy_steps = 5;
  state.ledger.initial_energy = number();
  state.ledger.dissipated.add(1.0);
  state.ledger.dissipated.add(1e-17);
  state.ledger.iterations = 1234567890123;
  return state;
}

struct Saved {
  Model model = chain(11);
  System system = build_system(model);
  State state = unlike_any_other(system);
  test::Scratch scratch;
  std::string path = scratch / "checkpoint.pst";
  Saved() { io::write_checkpoint(path, model, system, state); }
};

TEST(Checkpoint, RestoresEveryBit) {
  const Saved s;
  const State back = io::read_checkpoint(s.path, s.model, s.system);
  EXPECT_EQ(state_bytes(s.system, back), state_bytes(s.system, s.state));
  EXPECT_EQ(back.ledger.dissipated.rest, s.state.ledger.dissipated.rest);
  EXPECT_EQ(back.ledger.iterations, 1234567890123);
  const BodyMotion a = s.system.motion(s.state, 10), b = s.system.motion(back, 10);
  EXPECT_EQ(a.h_dot, b.h_dot);
  EXPECT_EQ(a.q.coeffs(), b.q.coeffs());
}

TEST(Checkpoint, AllowsALongerDurationAndOtherOutput) {
  const Saved s;
  Model longer = s.model;
  longer.analysis.duration = 1e3;
  longer.output.every = 0.5;
  longer.title = "another";
  EXPECT_NO_THROW((void)io::read_checkpoint(s.path, longer, s.system));
}

TEST(Checkpoint, RefusesAnotherModel) {
  const Saved s;
  Model heavier = s.model;
  heavier.bodies[3].mass = 2.0;
  try {
    (void)io::read_checkpoint(s.path, heavier, build_system(heavier));
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("was written by a run of another model"));
    EXPECT_EQ(error.where(), s.path);
  }
}

TEST(Checkpoint, RefusesAnotherOrder) {
  const Saved s;
  Model finer = s.model;
  finer.analysis.order = 4;
  finer.analysis.step = 0.01;
  try {
    (void)io::read_checkpoint(s.path, finer, s.system);
    FAIL() << "read";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("was written by a run with order 2, but this one has order "
                                        "4 by composition. Give the analysis.order, method"));
  }
}

TEST(Checkpoint, TellsOfAnotherInstructionSet) {
  Saved s;
  std::string note;
  (void)io::read_checkpoint(s.path, s.model, s.system, &note);
  EXPECT_EQ(note, "");
  Model other = s.model;
  other.analysis.isa = "baseline";
  io::write_checkpoint(s.path, other, s.system, s.state);
  (void)io::read_checkpoint(s.path, s.model, s.system, &note);
  if (available_instruction_sets().size() < 2) GTEST_SKIP() << "there is no other set";
  EXPECT_THAT(note, HasSubstr("was begun with the instruction set baseline and continues with"));
}

// A checkpoint with a changed bit, in every 97th byte, or cut, at every 211th byte, is refused with
// a message.
TEST(Checkpoint, RefusesADamagedFile) {
  const Saved s;
  const std::string good = io::read_file(s.path);
  const auto message = [&](const std::string& bytes) -> std::string {
    std::ofstream(s.path, std::ios::binary | std::ios::trunc) << bytes;
    try {
      (void)io::read_checkpoint(s.path, s.model, s.system);
    } catch (const InputError& error) {
      return error.what();
    }
    return "read";
  };
  for (std::size_t at = 16; at < good.size(); at += 97) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    EXPECT_THAT(message(bad), HasSubstr("is damaged")) << "byte " << at;
  }
  for (std::size_t length = 16; length < good.size(); length += 211)
    EXPECT_THAT(message(good.substr(0, length)), HasSubstr("is damaged")) << length << " bytes";
  EXPECT_THAT(message(good + "x"), HasSubstr("is damaged"));
  EXPECT_THAT(message(""), HasSubstr("is not a Polhode checkpoint"));
  EXPECT_THAT(message("format: 1\nbodies: {}\n"), HasSubstr("is not a Polhode checkpoint"));
  std::string future = good;
  ++future[14];
  EXPECT_THAT(message(future), HasSubstr("format that this version does not read"));
}

TEST(Checkpoint, ReportsAMissingFile) {
  const Saved s;
  EXPECT_THROW((void)io::read_checkpoint("no-such-file.pst", s.model, s.system), io::FileError);
}

TEST(Checkpoint, ReplacesAnOldOneAtomically) {
  const Saved s;
  io::write_checkpoint(s.path, s.model, s.system, s.state);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(s.scratch / ""), {}), 1);
  EXPECT_NO_THROW((void)io::read_checkpoint(s.path, s.model, s.system));
}

}  // namespace
}  // namespace polhode::checkpoint_tests
