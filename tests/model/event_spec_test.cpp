// SPDX-License-Identifier: Apache-2.0
// What events switch: names, what goes with a joint, joints that break, and what cannot be
// switched.
#include <polhode/model/event_spec.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::event_spec_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two sliders, a motor and a spring on the first.
Model sliders(const std::string& more = "", const std::string& first = "",
              const std::string& motor = "") {
  return io::read_model_text(R"(
format: 1
bodies:
  a: {mass: 1, inertia: [1, 1, 1]}
  b: {mass: 1, inertia: [1, 1, 1]}
joints:
  guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x)" +
                                 first + R"(}
  other: {type: prismatic, bodies: [ground, b], at: [0, 0, 0], axis: x}
loads:
  pull: {type: force, body: a, force: [1, 0, 0]}
  motor: {type: linear_motor, joint: guide, force: 3)" +
                                 motor + "}\n" + more,
                             "m.yaml", {});
}

std::string refusal(const Model& model, const std::string& name) {
  try {
    (void)switch_target(model, name);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SwitchTarget, IsAJointOrALoad) {
  const Model model = sliders();
  EXPECT_TRUE(switch_target(model, "other").joint);
  EXPECT_EQ(switch_target(model, "other").index, 1);
  EXPECT_FALSE(switch_target(model, "motor").joint);
  EXPECT_EQ(switch_target(model, "motor").index, 1);
}

TEST(SwitchTarget, OfAnUnknownNameSaysWhatThereIs) {
  EXPECT_THAT(refusal(sliders(), "gide"),
              HasSubstr("unknown joint or load 'gide'. Did you mean 'guide'? Joints and loads: "
                        "guide, other, pull, motor."));
  EXPECT_THAT(refusal(sliders(), "a"), HasSubstr("the body 'a' has no contact that could be "
                                                 "switched. Add 'contacts: {}', or name a joint"));
}

TEST(SwitchTarget, IsNotWhatTwoThingsAreCalled) {
  Model model = sliders();
  model.loads[0].name = "guide";
  EXPECT_THAT(refusal(model, "guide"), HasSubstr("'guide' is a joint and a load. Rename one"));
}

TEST(SwitchTarget, IsNoJointThatACouplingNeeds) {
  const Model model = sliders("  both: {type: coupling, joints: [guide, other], factors: [2]}\n");
  EXPECT_THAT(refusal(model, "guide"), HasSubstr("'guide' is in the coupling 'both'"));
  EXPECT_THAT(refusal(model, "other"), HasSubstr("'other' is in the coupling 'both'"));
}

TEST(AllEvents, TakeTheLoadsInAJointWithIt) {
  const std::string off = "events: {gone: {at: 0.5, off: [guide]}}\n";
  EXPECT_THAT(all_events(sliders(off)).at(0).off, ElementsAre("guide", "motor"));
  EXPECT_THAT(all_events(sliders(off, "", ", stays: true")).at(0).off, ElementsAre("guide"));
  // One that is named by an event is switched by that one alone.
  EXPECT_THAT(
      all_events(sliders("events: {gone: {at: 0.5, off: [guide], on: [motor]}}\n")).at(0).off,
      ElementsAre("guide"));
  // It comes back with the joint.
  const auto events = all_events(
      sliders("events: {gone: {at: 0.5, off: [guide]}, back: {at: 0.7, on: [guide]}}\n"));
  ASSERT_EQ(events.size(), 2u);
  EXPECT_THAT(events[1].on, ElementsAre("guide", "motor"));
}

TEST(AllEvents, IncludeJointsThatBreak) {
  const auto events = all_events(sliders("events: {first: {at: 0.5, off: [pull]}}\n",
                                         ", breaks: {force: 20 N, moment: 3 N m}"));
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0].name, "first");
  EXPECT_EQ(events[1].name, "guide breaks by force");
  EXPECT_EQ(events[2].name, "guide breaks by moment");
  for (const int k : {1, 2}) {
    const EventSpec& e = events[static_cast<std::size_t>(k)];
    EXPECT_THAT(e.off, ElementsAre("guide", "motor"));
    ASSERT_TRUE(e.when.has_value());
    EXPECT_EQ(e.when->level, k == 1 ? 20.0 : 3.0);
    EXPECT_TRUE(e.when->above);
    EXPECT_EQ(e.when->channel.of.target, "guide");
    EXPECT_FALSE(e.repeat);
  }
}

}  // namespace
}  // namespace polhode::event_spec_tests
