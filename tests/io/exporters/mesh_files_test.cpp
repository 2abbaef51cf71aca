// SPDX-License-Identifier: Apache-2.0
// Exported models whose bodies have the shape of a mesh file, read again from another folder.
#include <filesystem>

#include "export_fixture.hpp"

namespace polhode::mesh_files_tests {
namespace {

using test::Exports;

/// A wedge of the lengths 30, 20 and 10 as an OBJ: half of a box, closed.
constexpr const char* kWedge =
    "v 0 0 0\nv 30 0 0\nv 30 20 0\nv 0 20 0\nv 0 0 10\nv 0 20 10\n"
    "f 1 4 3 2\nf 1 2 5\nf 4 6 3\nf 2 3 6 5\nf 1 5 6 4\n";

/// Two bodies of one mesh in different sizes, in a folder beside that of the mesh.
class MeshFiles : public Exports {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "parts");
    std::filesystem::create_directories(folder_ / "models");
    std::filesystem::create_directories(folder_ / "out/robot");
    std::ofstream(folder_ / "parts/wedge.obj") << kWedge;
    std::ofstream(folder_ / "models/model.yaml") << R"(format: 1
gravity: [0, 0, -9.81]
bodies:
  base: {fixed: true}
  arm:
    density: 2000
    position: [0.1, 0.2, 0.3]
    orientation: {axis: [1, 2, 2], angle: 0.6}
    shape: {mesh: {file: ../parts/wedge.obj, scale: 0.01}}
  hand:
    density: 500
    position: [0.5, 0.2, 0.3]
    shape: {mesh: {file: ../parts/wedge.obj, scale: 0.005}, position: [0.02, 0, 0], orientation: {axis: x, angle: 0.4}}
joints:
  shoulder: {type: revolute, bodies: [base, arm], at: [0, 0, 0.3], axis: y}
  wrist: {type: revolute, bodies: [arm, hand], at: [0.4, 0.2, 0.3], axis: [0, 1, 1]}
)";
  }
};

TEST_F(MeshFiles, LoadAgainFromAnotherFolder) {
  const Model model = io::read_model(folder_ / "models/model.yaml", {});
  // Half a box of 0.3 x 0.2 x 0.1 m.
  ASSERT_NEAR(model.bodies.at(1).mass, 2000.0 * 0.5 * 0.3 * 0.2 * 0.1, 1e-12);
  for (const std::string file : {"out/robot/robot.urdf", "out/robot/robot.xml"}) {
    SCOPED_TRACE(file);
    const Model read = again(model, file);
    const Simulation first(model), second(read);
    for (const char* name : {"arm", "hand"}) {
      const BodySpec& a = model.bodies.at(static_cast<std::size_t>(model.body_index(name)));
      const BodySpec& b = read.bodies.at(static_cast<std::size_t>(read.body_index(name)));
      ASSERT_EQ(b.shapes.size(), 1U) << name;
      EXPECT_EQ(b.shapes[0].type, "mesh");
      EXPECT_EQ(b.shapes[0].scale, a.shapes[0].scale);
      EXPECT_TRUE(std::filesystem::equivalent(b.shapes[0].file, a.shapes[0].file));
      // The shape is where it was: a corner of the mesh in the world.
      const auto corner = [&](const Simulation& s, const ShapeSpec& shape) -> Vec3 {
        const BodyMotion body = s.body(name);
        const BodySpec& spec =
            s.model().bodies.at(static_cast<std::size_t>(s.model().body_index(name)));
        return body.r + body.Lambda() * (shape.position - spec.com +
                                         shape.orientation * Vec3(shape.scale * Vec3(30, 20, 0)));
      };
      EXPECT_NEAR((corner(first, a.shapes[0]) - corner(second, b.shapes[0])).norm(), 0.0, 1e-12)
          << name;
    }
    for (const double step : {0.02, 0.005, 0.001}) expect_same(model, read, step, 1e-12, 1e-10);
  }
}

}  // namespace
}  // namespace polhode::mesh_files_tests
