// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/channels.hpp>

#include <cmath>
#include <cstring>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/view/glb.hpp>
#include <support/scratch.hpp>

namespace polhode::channels_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kModel = R"(format: 1
title: Falling arm
gravity: [0, 0, -10]
bodies:
  stone: {shape: {sphere: 0.2}, density: 1000, position: [5, 0, 0]}
  arm: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y}
loads:
  spring: {type: spring_damper, bodies: [ground, arm], at: [[1, 0, 1], [1, 0, 0]], stiffness: 100, damping: 1}
contacts: {exclude: [[stone, arm]]}
analysis: {duration: 0.1 s, step: 10 ms}
output:
  probes:
    end: {body: arm, point: [0.5, 0, 0], every: 10 ms}
    slow: {joint: hinge, every: 50 ms}
)";

class ChannelsTest : public testing::Test {
 protected:
  void SetUp() override {
    Simulation simulation(io::read_model_text(kModel, "model.yaml"));
    io::Recorder recorder(simulation, folder_ / "r",
                          {.model_file = "model.yaml", .model_text = kModel});
    recorder.step(simulation);
    simulation.run([&](Simulation& s) { recorder.frame(s); },
                   [&](Simulation& s) { recorder.step(s); });
    recorder.frame(simulation);
    recorder.close();
  }
  [[nodiscard]] io::ResultsReader results() const {
    return io::ResultsReader(folder_ / "r/results.h5");
  }
  [[nodiscard]] std::vector<std::string> names(const std::string& name) const {
    std::vector<std::string> list;
    for (const ChannelColumn& c : channel_columns(results(), name)) list.push_back(c.name);
    return list;
  }
  test::Scratch folder_;
};

TEST_F(ChannelsTest, AFallingStoneFollowsTheClosedForm) {
  const std::vector<ChannelColumn> z = channel_columns(results(), "bodies.stone.position.z");
  ASSERT_EQ(z.size(), 1U);
  EXPECT_EQ(z[0].unit, "m");
  ASSERT_EQ(z[0].values.size(), 11U);
  // The step of order 2 is exact for a constant force.
  for (std::size_t k = 0; k < 11; ++k)
    EXPECT_NEAR(z[0].values[k], -0.5 * 10.0 * 1e-4 * static_cast<double>(k * k), 1e-14);
}

// The arm turns about y, which is the same in both axes; a channel that is computed is found by its
// name, and is not among those of a whole table.
TEST_F(ChannelsTest, AngularVelocityIsAlsoAlongTheBodysAxes) {
  const io::ResultsReader r = results();
  const auto own = channel_columns(r, "bodies.arm.angular_velocity_body");
  const auto world = channel_columns(r, "bodies.arm.angular_velocity");
  ASSERT_EQ(own.size(), 3U);
  EXPECT_EQ(own[1].name, "bodies.arm.angular_velocity_body.y");
  EXPECT_EQ(own[1].unit, "rad/s");
  EXPECT_GT(std::abs(world[1].values.back()), 0.1);
  for (std::size_t f = 0; f < own[1].values.size(); ++f) {
    EXPECT_NEAR(own[0].values[f], 0.0, 1e-14);
    EXPECT_NEAR(own[1].values[f], world[1].values[f], 1e-14);
  }
  EXPECT_EQ(channel_columns(r, "bodies.arm.angular_velocity_body.y").size(), 1U);
  for (const std::string& name : channel_names(r)) EXPECT_EQ(name.find("_body"), std::string::npos);
}

TEST_F(ChannelsTest, ANameSelectsAComponentAChannelOrAGroup) {
  EXPECT_THAT(
      names("bodies.arm.velocity"),
      ElementsAre("bodies.arm.velocity.x", "bodies.arm.velocity.y", "bodies.arm.velocity.z"));
  EXPECT_THAT(names("joints.hinge.coordinates"), ElementsAre("joints.hinge.coordinates"));
  EXPECT_THAT(names("loads.spring"),
              ElementsAre("loads.spring.force.x", "loads.spring.force.y", "loads.spring.force.z",
                          "loads.spring.length", "loads.spring.rate", "loads.spring.energy"));
  EXPECT_THAT(names("energy"), testing::Contains("energy.kinetic"));
}

TEST_F(ChannelsTest, TheLengthOfASpringIsThatBetweenItsEnds) {
  const io::ResultsReader r = results();
  const auto length = channel_columns(r, "loads.spring.length")[0].values;
  const auto angle = channel_columns(r, "joints.hinge.coordinates")[0].values;
  for (std::size_t k = 0; k < length.size();
       ++k)  // The arm turns about y: its end is at (cos, −sin).
    EXPECT_NEAR(length[k], std::hypot(1.0 - std::cos(angle[k]), 1.0 + std::sin(angle[k])), 1e-12);
}

// The end of the arm is 1 m from the hinge and moves at the rate of its angle; the force of the
// hinge has one size in a table of frames, in that of its probe, and from its components.
TEST_F(ChannelsTest, VectorsHaveASizeAndProbesHaveColumns) {
  const io::ResultsReader r = results();
  const ProbeTables probes(folder_ / "r/results.h5");
  EXPECT_THAT(probes.names(), ElementsAre("end", "slow"));
  const ReportTable table =
      table_of(r, probes,
               {"probes.end.v.size", "joints.hinge.rates", "bodies.arm.velocity.size",
                "probes.end.distance", "probes.end.x"});
  ASSERT_EQ(table.columns.size(), 5U);
  EXPECT_EQ(table.columns[0].name, "probes.end.v.size");
  EXPECT_EQ(table.columns[2].name, "bodies.arm.velocity.size");
  EXPECT_EQ(table.columns[2].unit, "m/s");
  ASSERT_EQ(table.t.size(), 11U);
  for (std::size_t k = 0; k < 11; ++k) {
    const double rate = std::abs(table.columns[1].values[k]);
    EXPECT_NEAR(table.columns[0].values[k], rate, 1e-12);
    EXPECT_NEAR(table.columns[2].values[k], 0.5 * rate, 1e-12);
    EXPECT_NEAR(table.columns[3].values[k], 1.0, 1e-12);
  }
  const ReportTable slow = table_of(r, probes, {"probes.slow.f.size"});
  EXPECT_EQ(slow.t.size(), 3U);
  const auto force = channel_columns(r, "joints.hinge.force.size")[0].values;
  EXPECT_NEAR(slow.columns[0].values[2], force[10], 1e-12);
  EXPECT_EQ(channel_columns(r, "bodies.arm.angular_velocity_body.size").size(), 1U);
  EXPECT_THAT(channel_names(r, probes), testing::Contains("probes.slow.rate rz"));
  const std::string svg =
      channels_svg(r, probes, {"probes.end.v.size", "joints.hinge.force.size"}, "t [s]");
  EXPECT_THAT(svg, HasSubstr("probes.end.v.size [m/s]"));
  EXPECT_THAT(svg, testing::Not(HasSubstr("probes.end.v.size<")));  // one curve needs no legend
  EXPECT_THAT(svg, HasSubstr("joints.hinge.force.size [N]"));

  const auto refused = [&](const std::vector<std::string>& names) -> std::string {
    try {
      (void)channels_csv(r, probes, names);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(refused({"probes.end.x", "probes.slow.fx"}),
              HasSubstr("'probes.slow.fx' has other times than 'probes.end.x'"));
  EXPECT_THAT(refused({"probes.edn.x"}),
              HasSubstr("there is no 'probes.edn.x'. Did you mean 'end'"));
  EXPECT_THAT(refused({"probes.end.q"}), HasSubstr("probe 'end' has no column 'q'"));
  EXPECT_THAT(refused({"energy.kinetic.size"}), HasSubstr("there is no 'energy.kinetic.size'"));
  try {
    (void)table_of(r, {}, {"probes.end.x"});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("There are no tables of probes beside the results"));
  }
}

TEST_F(ChannelsTest, SuggestsTheNearestName) {
  try {
    (void)names("bodies.amr.position");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no 'bodies.amr.position'"));
    EXPECT_THAT(error.what(), HasSubstr("bodies.arm.position"));
  }
}

TEST_F(ChannelsTest, ATableReadsBackExactly) {
  const io::ResultsReader r = results();
  std::istringstream table(channels_csv(r, {}, {"energy.kinetic"}));
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "t [s],energy.kinetic [J]");
  const std::vector<double> kinetic = channel_columns(r, "energy.kinetic")[0].values;
  for (double expected : kinetic) {
    std::getline(table, line);
    EXPECT_EQ(std::stod(line.substr(line.find(',') + 1)), expected);
  }
  EXPECT_THAT(channels_csv(r, {}, {}), HasSubstr("joints.hinge.moment.y [N m]"));
}

TEST_F(ChannelsTest, APictureHasACurveForEachColumn) {
  const std::string svg =
      channels_svg(results(), {}, {"bodies.arm.position", "energy.kinetic"}, "t [s]");
  EXPECT_THAT(svg, HasSubstr("<svg"));
  EXPECT_THAT(svg, HasSubstr("bodies.arm.position [m]"));
  std::size_t curves = 0;
  for (const char* colour : {"#1f5fa8", "#c8641b", "#2d8a4e"})
    curves += svg.find(colour) != std::string::npos ? 1 : 0;
  EXPECT_EQ(curves, 3U);
  try {
    (void)channels_svg(results(), {}, {"bodies"}, "t [s]");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("curves. Name a part of it, at most eight curves go into a "
                                    "panel."));
  }
}

TEST_F(ChannelsTest, AnAnimatedSceneContainsTheMotion) {
  const io::ResultsReader r = results();
  const Model model = io::read_model_text(kModel, "model.yaml");
  const std::string glb = scene_glb(make_scene(r, &model));
  ASSERT_EQ(glb.substr(0, 4), "glTF");
  std::uint32_t total = 0, length = 0;
  std::memcpy(&total, glb.data() + 8, 4);
  std::memcpy(&length, glb.data() + 12, 4);
  EXPECT_EQ(total, glb.size());
  const auto file = nlohmann::json::parse(glb.substr(20, length));
  const char* numbers = glb.data() + 20 + length + 8;
  EXPECT_EQ(file["meshes"].size(), 2U);
  int stones = 0;
  for (const auto& channel : file["animations"][0]["channels"]) {
    if (file["nodes"][channel["target"]["node"].get<std::size_t>()]["name"] != "stone" ||
        channel["target"]["path"] != "translation")
      continue;
    ++stones;
    const auto& sampler = file["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    const auto& accessor = file["accessors"][sampler["output"].get<std::size_t>()];
    const auto& view = file["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    EXPECT_EQ(accessor["count"], 11);
    float z = 0.0F;
    std::memcpy(&z, numbers + view["byteOffset"].get<std::size_t>() + 4 * (3 * 10 + 2), 4);
    EXPECT_NEAR(z, -0.05, 1e-7);
  }
  EXPECT_EQ(stones, 1);
}

}  // namespace
}  // namespace polhode::channels_tests
