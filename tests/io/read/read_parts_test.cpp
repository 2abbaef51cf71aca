// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::read_parts_tests {
namespace {

/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

/// Two bodies without a plane of symmetry, with most kinds of joints and loads between them, the
/// ground and a third body that slides and turns.
const std::string kArm =
    "format: 1\n"
    "variables: {L: 1.0}\n"
    "bodies:\n"
    "  upper:\n"
    "    mass: 2\n"
    "    inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.02, xz: -0.03, yz: 0.05}\n"
    "    position: [0.5, 0.2, -0.1]\n"
    "    orientation: {rotation_vector: [0.3, -0.4, 0.5]}\n"
    "    angular_velocity: [0.2, 0.7, -0.4]\n"
    "  lower:\n"
    "    shape: {hull: {points: [[0, 0, 0], [0.5, 0, 0], [0, 0.4, 0], [0, 0, 0.3], [0.4, 0.3, "
    "0]]}}\n"
    "    density: 100\n"
    "    position: [L, 0.4, -0.3]\n"
    "    orientation: {axis: [1, 2, 3], angle: 40 deg}\n"
    "  sleeve: {shape: {cone: [0.1, 0.4]}, density: 500, position: [1.6, 0.5, 0.1],\n"
    "    velocity: [0.1, 0.2, 0.1]}\n"
    "joints:\n"
    "  shoulder: {type: universal, bodies: [ground, upper], at: [0, 0.1, 0], axes: [x, y]}\n"
    "  elbow: {type: revolute, bodies: [upper, lower], at: [1, 0.3, -0.2], axis: [1, 2, 0.5],\n"
    "    limits: {lower: -20 deg, upper: 1}}\n"
    "  shaft: {type: cylindrical, bodies: [lower, sleeve], at: [1.6, 0.5, 0.1], axis: [1, 0.2, "
    "0.3],\n"
    "    limits: {lower: -0.5, upper: 0.8}}\n"
    "loads:\n"
    "  spring: {type: spring_damper, bodies: [ground, lower], at: [[0, 2, 1], [1, 0.5, -0.3]],\n"
    "    stiffness: 30, damping: 0.5, free_length: 1}\n"
    "  push: {type: force, body: upper, at_body: [0.1, 0.2, 0.3], force: [3*sin(2*t), 2, 1]}\n"
    "  pull: {type: force, body: lower, body_fixed: true, force: [1, 2*cos(t), -1]}\n"
    "  twist: {type: moment, body: lower, moment: [0.3, -0.2*t, 0.4]}\n"
    "  turn: {type: rotary_motor, joint: elbow, moment: 0.5*cos(3*t)}\n"
    "  slide: {type: translational_spring, joint: shaft, stiffness: 20, free_displacement: 0.1}\n"
    "  wind: {type: torsional_spring, joint: shaft, stiffness: 2, free_angle: 0.5}\n"
    "  mount: {type: bushing, bodies: [ground, sleeve], at: [1.6, 0.5, 0.1], stiffness: [5, 6, "
    "7],\n"
    "    stiffness_matrix: [[1, 0, 0, 0.1, 0, 0], [0, 1, 0, 0, 0.2, 0], [0, 0, 1, 0, 0, 0],\n"
    "      [0.1, 0, 0, 1, 0, 0], [0, 0.2, 0, 0, 1, 0], [0, 0, 0, 0, 0, 1]]}\n"
    "cables:\n"
    "  rope: {through: [[ground, [0.5, 2, 1]], [upper, [0.5, 0.2, -0.1]]], stiffness: 40,\n"
    "    free_length: 1, damping: 0.3}\n";

const std::string kAnalysis = "analysis: {duration: 0.5, step: 5 ms}\n";

class ReadParts : public testing::Test {
 protected:
  void SetUp() override { write(folder_ / "arm.yaml", kArm); }

  Model whole(const std::string& parts, const std::string& more = "") {
    write(folder_ / "m.yaml", "format: 1\nparts:\n" + parts + more + kAnalysis);
    return io::read_model(folder_ / "m.yaml");
  }
  Model arm() {
    write(folder_ / "alone.yaml", kArm + kAnalysis);
    return io::read_model(folder_ / "alone.yaml");
  }
  std::string faults(const std::string& parts, const std::string& more = "") {
    try {
      static_cast<void>(whole(parts, more));
    } catch (const io::ModelErrors& errors) {
      std::string text = errors.text();
      const std::string path = folder_ / "";
      for (std::size_t k = 0; (k = text.find(path, k)) != std::string::npos;)
        text.erase(k, path.size());
      return text;
    }
    return "none";
  }

  test::Scratch folder_;
};

TEST_F(ReadParts, AddsPrefixesToNamesAndConnectsParts) {
  const Model m = whole(
      "  left: {file: arm.yaml, prefix: l_}\n"
      "  right: {file: arm.yaml, position: [0, 5, 0], variables: {L: 1.25}}\n",
      "joints:\n"
      "  across: {type: distance, bodies: [l_sleeve, right_sleeve], at: [[1.6, 0.5, 0], [1.6, 5, "
      "0]]}\n"
      "loads:\n  more: {type: torsional_spring, joint: l_elbow, stiffness: 3}\n");
  ASSERT_EQ(m.bodies.size(), 6u);
  EXPECT_EQ(m.bodies[1].name, "l_lower");
  EXPECT_EQ(m.joints.back().name, "across");
  EXPECT_EQ(m.joints.back().a, m.body_index("l_sleeve"));
  EXPECT_EQ(m.joints.back().b, m.body_index("right_sleeve"));
  EXPECT_EQ(m.loads[m.load_index("right_turn")].joint, "right_elbow");
  EXPECT_EQ(m.joints[m.joint_index("right_elbow")].b, m.body_index("right_lower"));
  EXPECT_NEAR(m.bodies[m.body_index("right_lower")].position.x() -
                  m.bodies[m.body_index("l_lower")].position.x(),
              0.25, kRounding);
}

/// Motion of a part at another pose: the motion of the part, transformed. The laws of mechanics do
/// not depend on position, direction or handedness.
struct Placed {
  Mat3 A = Mat3::Identity();
  Vec3 r = Vec3::Zero();
  double handed = 1.0;
};

void expect_same_motion(const Model& alone, const Model& placed, const Placed& p) {
  Simulation first(alone), second(placed);
  while (first.time() < 0.4999) {
    ASSERT_TRUE(first.step(0.5).accepted);
    ASSERT_TRUE(second.step(0.5).accepted);
  }
  // Rounding and the ends of iterations differ between the runs; in half a second such differences
  // grow by less than a factor of 1000.
  constexpr double kSame = 1e-10;
  for (int i = 0; i < 3; ++i) {
    const BodyMotion a = first.body(i), b = second.body(i);
    EXPECT_GT((a.r - alone.bodies[static_cast<std::size_t>(i)].position).norm(), 0.02) << i;
    EXPECT_LT((b.r - p.r - p.A * a.r).norm(), kSame) << i;
    EXPECT_LT((b.v - p.A * a.v).norm(), 10 * kSame) << i;
    EXPECT_LT((b.omega() - p.handed * p.A * a.omega()).norm(), 10 * kSame) << i;
  }
  for (const char* name : {"elbow", "shaft"}) {
    const int joint = alone.joint_index(name);
    EXPECT_LT((second.joint(joint).force - p.A * first.joint(joint).force).norm(), 1e-7) << name;
  }
}

TEST_F(ReadParts, MoveAsTheyWouldAloneWhereverTheyArePlaced) {
  const Model placed = whole(
      "  p: {file: arm.yaml, position: [3, -2, 1], orientation: {axis: [1, -1, 2], angle: 70 "
      "deg}}\n");
  const Quat q(Eigen::AngleAxisd(70.0 * std::numbers::pi / 180.0, Vec3(1, -1, 2).normalized()));
  expect_same_motion(arm(), placed, {q.toRotationMatrix(), Vec3(3, -2, 1)});
}

TEST_F(ReadParts, MirroredTheyMoveAsTheMirrorImage) {
  for (int axis = 0; axis < 3; ++axis) {
    const Model placed = whole(std::string("  p: {file: arm.yaml, mirror: ") + "xyz"[axis] +
                               ", position: [1, 2, 3], orientation: {axis: z, angle: 90 deg}}\n");
    Mat3 S = Mat3::Identity();
    S(axis, axis) = -1.0;
    const Quat q(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()));
    expect_same_motion(arm(), placed, {q.toRotationMatrix() * S, Vec3(1, 2, 3), -1.0});
  }
}

TEST_F(ReadParts, MirroredCoordinatesOfJointsWithOneFreedomStay) {
  const Model alone = arm(), placed = whole("  p: {file: arm.yaml, mirror: y}\n");
  Simulation first(alone), second(placed);
  for (int k = 0; k < 40; ++k) {
    ASSERT_TRUE(first.step(0.5).accepted);
    ASSERT_TRUE(second.step(0.5).accepted);
  }
  const auto coordinates = [&](Simulation& s, const char* joint) {
    return s.joint(alone.joint_index(joint)).coordinates;
  };
  EXPECT_GT(std::abs(coordinates(first, "elbow")[0]), 1e-3);
  EXPECT_NEAR(coordinates(second, "elbow")[0], coordinates(first, "elbow")[0], 1e-10);
}

TEST_F(ReadParts, NestAndKeepTheirSourceLocations) {
  write(folder_ / "pair.yaml",
        "format: 1\n"
        "parts:\n"
        "  a: {file: arm.yaml, position: [0, 1, 0]}\n"
        "  b: {file: arm.yaml, position: [0, -1, 0]}\n");
  const Model m = whole("  p: {file: pair.yaml, position: [10, 0, 0]}\n");
  EXPECT_NEAR((m.bodies[m.body_index("p_b_upper")].position - Vec3(10.5, -0.8, -0.1)).norm(), 0.0,
              kRounding);
  EXPECT_EQ(m.joints[m.joint_index("p_b_elbow")].a, m.body_index("p_b_upper"));
  EXPECT_EQ(m.bodies[3].place.line, 4);
}

TEST_F(ReadParts, MayBeWrittenInTheFileItself) {
  const Model m = whole(
      "  p:\n    position: [1, 0, 0]\n    model:\n      format: 1\n      units: {length: mm}\n"
      "      bodies: {ball: {shape: {sphere: [10]}, mass: 1, position: [0, 20, 0]}}\n");
  EXPECT_NEAR((m.bodies[0].position - Vec3(1, 0.02, 0)).norm(), 0.0, kRounding);
  EXPECT_EQ(m.bodies[0].name, "p_ball");
}

TEST_F(ReadParts, LocatesErrorsInTheFileOfThePart) {
  write(folder_ / "bad.yaml",
        "format: 1\nbodies:\n  rod: {mass: 1, inertia: [1, 1, 1]}\njoints:\n"
        "  pin: {type: revolute, bodies: [ground, rot], at: [0, 0, 0], axis: y}\n");
  EXPECT_EQ(faults("  p: {file: bad.yaml}\n").substr(0, 95),
            "bad.yaml:5:42: error: joints.pin.bodies: unknown body 'rot'. Did you mean 'rod'? "
            "Bodies: ground");
  EXPECT_NE(faults("  p: {file: bad.yaml}\n").find("    5 |   pin: {type: revolute"),
            std::string::npos);
  EXPECT_EQ(faults("  p: {file: bad.yaml}\n  q: {file: bad.yaml}\n"),
            faults("  p: {file: bad.yaml}\n"));
}

TEST_F(ReadParts, ReportsErrorsInAPart) {
  const auto starts = [](const std::string& text, const std::string& with) {
    EXPECT_EQ(text.substr(0, with.size()), with);
  };
  starts(faults("  p: {file: arms.yaml}\n"), "m.yaml:3:13: error: parts.p.file: ");
  starts(faults("  p: {position: [0, 0, 0]}\n"), "m.yaml:3:3: error: parts.p: 'file' is missing.");
  starts(faults("  p: {file: arm.yaml, variables: {l: 2}}\n"),
         "m.yaml:3:38: error: parts.p.variables: the part has no variable 'l'. Did you mean 'L'? "
         "Variables: L.");
  starts(faults("  p: {file: arm.yaml, prefix: ''}\n",
                "bodies: {upper: {mass: 1, point_mass: true}}\n"),
         "m.yaml:3:31: error: parts.p.prefix: the name 'upper' is taken. Choose another prefix.");
  starts(faults("  p: {file: m.yaml}\n"),
         "m.yaml:3:13: error: parts.p.file: 'm.yaml' is part of itself.");
  write(folder_ / "field.yaml",
        "format: 1\nbodies:\n  soil:\n    fixed: true\n"
        "    shape: {height_field: {spacing: 1, heights: [[0, 0], [0, 0]]}}\n");
  starts(faults("  p: {file: field.yaml, mirror: x}\n"),
         "field.yaml:5:5: error: bodies.soil.shape: a height field cannot be mirrored. Give the "
         "mirror image in a part of its own.");
}

TEST_F(ReadParts, CyclesAreFoundAcrossFiles) {
  write(folder_ / "one.yaml", "format: 1\nparts: {x: {file: two.yaml}}\n");
  write(folder_ / "two.yaml", "format: 1\nparts: {y: {file: one.yaml}}\n");
  EXPECT_EQ(faults("  p: {file: one.yaml}\n").substr(0, 76),
            "two.yaml:2:19: error: parts.y.file: 'one.yaml' is part of itself. Leave out ");
}

TEST_F(ReadParts, UsesContactMaterialsOfTheWholeModel) {
  write(folder_ / "ball.yaml",
        "format: 1\nbodies:\n  ball:\n    shape: {sphere: [1]}\n    mass: 1\n"
        "    contact: {material: ruber}\n");
  const std::string contacts = "contacts: {materials: {rubber: {friction: 0.5}}}\n";
  EXPECT_EQ(faults("  p: {file: ball.yaml}\n", contacts).substr(0, 37),
            "ball.yaml:6:25: error: bodies.p_ball.");
}

std::string refusal(const std::string& file) {
  try {
    (void)io::read_model(file);
  } catch (const io::ModelErrors& errors) {
    return errors.diagnostics().front().what;
  }
  return "";
}

// Parts that contain ten parts each, six deep, are a million; the files have 350 bytes.
TEST(Parts, MultiplyUpToABound) {
  const test::Scratch scratch;
  for (int i = 0; i < 12; ++i) {
    std::string text = "format: 1\nparts:\n";
    for (int k = 0; k < 10; ++k)
      text += "  p" + std::to_string(k) + ": {file: f" + std::to_string(i + 1) + ".yaml}\n";
    write(scratch / ("f" + std::to_string(i) + ".yaml"), text);
  }
  write(scratch / "f12.yaml", "format: 1\nbodies: {a: {mass: 1, inertia: [1, 1, 1]}}\n");
  EXPECT_EQ(refusal(scratch / "f0.yaml"), "the model has more than 100000 parts");
}

TEST(Parts, HaveABoundOfBytesAndOfDepth) {
  const test::Scratch scratch;
  std::string large = "format: 1\nbodies: {a: {mass: 1, inertia: [1, 1, 1]}}\n#";
  large.resize(600'000, ' ');
  write(scratch / "large.yaml", large);
  std::string many = "format: 1\nparts:\n";
  for (int k = 0; k < 1000; ++k) many += "  p" + std::to_string(k) + ": {file: large.yaml}\n";
  write(scratch / "many.yaml", many);
  EXPECT_EQ(refusal(scratch / "many.yaml"), "the parts have more than 536870912 bytes");
  for (int i = 0; i < 70; ++i)
    write(scratch / ("d" + std::to_string(i) + ".yaml"),
          "format: 1\nparts: {p: {file: d" + std::to_string(i + 1) + ".yaml, prefix: ''}}\n");
  EXPECT_EQ(refusal(scratch / "d0.yaml"), "parts are nested more than 64 deep");
}

TEST(Parts, HaveNamesThatFilesCanHave) {
  const test::Scratch scratch;
  const std::string name(3000, 'n');
  write(scratch / "m.yaml", "format: 1\nparts: {p: {file: " + name + ".yaml}}\n");
  EXPECT_NE(refusal(scratch / "m.yaml").find("cannot be opened (File name too long)"),
            std::string::npos);
  write(scratch / "m.yaml",
        "format: 1\nbodies: {" + name.substr(0, 300) + ": {mass: 1, inertia: [1, 1, 1]}}\n");
  EXPECT_NE(refusal(scratch / "m.yaml").find("has 300 characters, more than 200"),
            std::string::npos);
  const std::string part =
      "{model: {format: 1, bodies: {b: {mass: 1, inertia: [1, 1, 1]}}}, prefix: ";
  write(scratch / "m.yaml", "format: 1\nparts: {p: " + part + std::string(199, 'q') + "}}\n");
  EXPECT_EQ(refusal(scratch / "m.yaml"), "");
  write(scratch / "m.yaml", "format: 1\nparts: {p: " + part + std::string(200, 'q') + "}}\n");
  EXPECT_NE(refusal(scratch / "m.yaml").find("would have 201 characters, more than 200"),
            std::string::npos);
}

}  // namespace
}  // namespace polhode::read_parts_tests
