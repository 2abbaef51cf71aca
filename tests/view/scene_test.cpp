// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/scene.hpp>

#include <cmath>
#include <cstring>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/recorder.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/view/chunk.hpp>
#include <support/scratch.hpp>

namespace polhode::scene_tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// Every kind of shape, two of them equal, with a joint, a spring, a beam, a cable, a solid and
/// contact.
constexpr const char* kModel = R"(format: 1
title: All of it </script><b>
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  hills: {fixed: true, position: [9, 9, 0], shape: {height_field: {heights: [[0, 0, 0], [0, 1, 0]], spacing: 1}}}
  ball: {shape: {sphere: 0.2}, density: 1000, position: [3, 0, 0.5]}
  other_ball: {shape: {sphere: 0.2}, density: 900, position: [4, 0, 0.5]}
  brick: {shape: {box: [0.2, 0.1, 0.3]}, density: 1000, position: [5, 0, 1]}
  rest:
    shape:
      - {cylinder: [0.1, 0.3]}
      - {capsule: [0.1, 0.3], position: [1, 0, 0]}
      - {cone: [0.1, 0.3], position: [2, 0, 0]}
      - {ellipsoid: [0.1, 0.2, 0.3], position: [3, 0, 0]}
      - {tube: [0.2, 0.1, 0.3], position: [4, 0, 0]}
      - {hull: {points: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}, position: [5, 0, 0]}
      - {mesh: part.obj, position: [6, 0, 0]}
    density: 1000
    position: [10, 0, 5]
  stone: {point_mass: true, mass: 2, position: [1, 0, 1]}
  bone: {mass: 1, inertia: [1, 1, 0.1], position: [0, 5, 3]}
joints:
  hinge: {type: revolute, bodies: [ground, bone], at: [0, 5, 3], axis: x}
loads:
  spring: {type: spring_damper, bodies: [ground, brick], at: [[5, 0, 3], [5, 0, 1.1]], stiffness: 100, damping: 1}
  dashpot: {type: spring_damper, bodies: [ground, brick], at: [[5, 1, 3], [5, 0, 1.1]], damping: 1}
materials:
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 8000}
  rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.4, density: 1100}
sections:
  rod: {type: rectangle, height: 20 mm, width: 10 mm, material: steel}
beams:
  mast: {points: [[0, 0, 0], [0, 0, 2]], elements: 2, section: rod, up: y, bonded: {ground: start}}
cables:
  stay: {through: [[ground, [-2, 0, 0]], [mast, end]], stiffness: 10 kN}
solids:
  pad: {mesh: {block: {size: [0.2, 0.2, 0.2], cells: [2, 2, 2]}, position: [0, 5, 2]}, material: rubber, bonded: {bone: zmax}}
contacts: {exclude: [[ball, brick]]}
analysis: {duration: 3 ms, step: 1 ms}
)";

constexpr const char* kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

class SceneTest : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "part.obj") << kTetrahedron;
    std::ofstream(folder_ / "model.yaml") << kModel;
    Simulation simulation(io::read_model(folder_ / "model.yaml"));
    io::Recorder recorder(simulation, folder_ / "model.results",
                          {.version = "1", .model_file = "model.yaml", .model_text = kModel});
    simulation.run([&](Simulation& s) { recorder.frame(s); }, [](Simulation&) {});
    recorder.frame(simulation);
    recorder.close();
  }
  [[nodiscard]] SceneData scene(const SceneOptions& options = {}) const {
    const io::ResultsReader results(folder_ / "model.results/results.h5");
    const Model model = model_of_results(results, folder_ / "model.results");
    return make_scene(results, &model, options);
  }
  static std::vector<float> floats(const SceneData& scene, const json& packed) {
    const std::size_t words = packed["n"].get<std::size_t>() * packed["w"].get<std::size_t>();
    const std::string bytes =
        unpack_words(scene.chunks[packed["c"].get<std::size_t>()], words, packed["w"]);
    std::vector<float> values(words);
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
  }
  test::Scratch folder_;
};

TEST_F(SceneTest, ContainsEveryKindOfObject) {
  const SceneData data = scene();
  const json m = json::parse(data.manifest);
  std::map<std::string, json> body;
  for (const json& b : m["bodies"]) body[b["name"]] = b;
  EXPECT_TRUE(body["floor"]["parts"][0].contains("plane"));
  EXPECT_EQ(body["ball"]["parts"][0]["mesh"], body["other_ball"]["parts"][0]["mesh"])
      << "equal shapes are one mesh";
  EXPECT_NE(body["ball"]["parts"][0]["mesh"], body["brick"]["parts"][0]["mesh"]);
  EXPECT_EQ(body["rest"]["parts"].size(), 7U);
  std::vector<std::string> types;
  for (const json& mesh : m["meshes"]) {
    types.push_back(mesh["type"]);
    EXPECT_GT(mesh["triangles"]["n"], 0) << mesh;
  }
  EXPECT_THAT(types,
              testing::IsSupersetOf({"height_field", "sphere", "box", "cylinder", "capsule", "cone",
                                     "ellipsoid", "tube", "hull", "mesh", "inertia"}));
  EXPECT_EQ(body["ball"]["line"], 7);
  std::map<std::string, json> joint;  // Includes the fixed joint of the beam.
  for (const json& j : m["joints"]) joint[j["name"]] = j;
  EXPECT_EQ(joint["hinge"]["type"], "revolute");
  std::map<std::string, json> load;
  for (const json& l : m["loads"]) load[l["name"]] = l;
  EXPECT_EQ(load["spring"]["damping"], 1.0);
  EXPECT_TRUE(load["spring"]["coil"] && load["spring"]["damper"]);
  EXPECT_FALSE(load["dashpot"]["coil"]) << "a damper alone has no coil";
  EXPECT_TRUE(load["dashpot"]["damper"]);
  EXPECT_EQ(m["beams"][0]["height"], 0.02);
  EXPECT_EQ(m["cables"][0]["name"], "stay");
  EXPECT_EQ(m["solids"][0]["triangles"]["n"], 6 * 4 * 2) << "six sides of 2 x 2 squares";
  EXPECT_EQ(m["solids"][0]["shown"].size(), 26U) << "27 nodes, one of them inside";
  EXPECT_EQ(m["frames"], m["time"].size());
}

TEST_F(SceneTest, ContainsTheNumbersOfTheResults) {
  const SceneData data = scene();
  const json m = json::parse(data.manifest);
  const io::ResultsReader results(folder_ / "model.results/results.h5");
  for (const json& channel : m["channels"]) {
    const std::string path = channel["path"];
    const std::vector<double> expected = results.read("/" + path);
    const std::vector<float> found = floats(data, channel["data"]);
    ASSERT_EQ(found.size(), expected.size()) << path;
    for (std::size_t i = 0; i < found.size(); ++i)
      if (!std::isnan(expected[i])) {
        ASSERT_EQ(found[i], static_cast<float>(expected[i])) << path;
      }
  }
}

TEST_F(SceneTest, ContainsFieldsOnTheOuterFacesOfSolids) {
  const SceneData data = scene();
  const json m = json::parse(data.manifest), solid = m["solids"][0];
  const io::ResultsReader results(folder_ / "model.results/results.h5");
  // All eight elements of the cube own triangles, in some order.
  EXPECT_EQ(solid["owners"]["n"], solid["triangles"]["n"]);
  std::map<std::string, std::size_t> found;
  for (const json& field : solid["fields"]) {
    const std::string of = field["of"], name = field["name"];
    ++found[of];
    const std::vector<double> all = results.read("/solids/pad/" + of + "/" + name);
    const std::vector<float> seen = floats(data, field["data"]);
    const std::size_t entries = of == "nodes" ? 27 : 8, rows = of == "nodes" ? 26 : 8;
    EXPECT_EQ(seen.size() / rows, all.size() / entries) << name;
    double sum = 0.0, expected = 0.0;
    if (of == "elements") {
      for (const float v : seen) sum += v;
      for (const double v : all) expected += static_cast<float>(v);
      EXPECT_NEAR(sum, expected, 1e-6 * (1.0 + std::abs(expected))) << name;
      EXPECT_TRUE(data.later.contains(field["data"]["c"])) << name;
    }
  }
  EXPECT_GE(found["nodes"], 4U);
  EXPECT_GE(found["elements"], 3U);
}

TEST_F(SceneTest, KeepsTheEnergyDriftThatSinglePrecisionWouldHide) {
  const SceneData data = scene();
  const json manifest = json::parse(data.manifest);
  for (const json& channel : manifest["channels"]) {
    if (channel["path"] != "energy/drift") continue;
    for (float x : floats(data, channel["data"])) EXPECT_LT(std::abs(x), 1e-9F);
  }
  EXPECT_THAT(data.manifest, HasSubstr("\"energy/drift\""));
}

TEST_F(SceneTest, LeavesOutFramesIfThereAreTooMany) {
  SceneOptions options;
  options.max_frames = 2;
  const SceneData data = scene(options);
  EXPECT_EQ(data.frames, 2U);
  EXPECT_EQ(data.every, 2U);
  EXPECT_EQ(json::parse(data.manifest)["file_frames"], 4);
}

TEST_F(SceneTest, EscapesTextOfTheModelInThePage) {
  const std::string page = scene_page("<html><!--POLHODE-DATA--></html>", scene());
  const std::size_t begin = page.find("application/json"), end = page.find("</script>", begin);
  EXPECT_THAT(page.substr(begin, end - begin), HasSubstr("\\u003c/script>\\u003cb>"));
  EXPECT_THAT(page, Not(HasSubstr("<b>")));
  EXPECT_THAT(page, HasSubstr("id=\"chunk-0\">"));
  EXPECT_THROW((void)scene_page("no place", scene()), std::invalid_argument);
}

TEST_F(SceneTest, ShowsBodiesWithoutTheModelFile) {
  const io::ResultsReader results(folder_ / "model.results/results.h5");
  const json m = json::parse(make_scene(results, nullptr).manifest);
  EXPECT_EQ(m["bodies"][2]["parts"].size(), 1U);
  EXPECT_THAT(m["notes"][0].get<std::string>(), HasSubstr("cannot be read"));
}

}  // namespace
}  // namespace polhode::scene_tests
