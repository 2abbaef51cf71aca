// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>

#include "contact/shapes_for_tests.hpp"
#include "contact/starts.hpp"
#include "model_scene.hpp"
#include "support/obj_file.hpp"
#include "support/scratch.hpp"

namespace polhode::test::contact_conservation_tests {
namespace {

/// A shape about a metre in size, off the body's centre.
/// @param folder  Of a mesh file, written here.
ShapeSpec shape_of(const std::string& type, const Scratch& folder) {
  ShapeSpec spec = ModelScene::shape(type, {});
  spec.position = {0.05, -0.03, 0.02};
  spec.orientation = Quat(Random(3).frame());
  if (type == "sphere") spec.sizes = {0.8};
  if (type == "capsule") spec.sizes = {0.4, 1.2};
  if (type == "box") spec.sizes = {0.8, 0.7, 0.5};
  if (type == "tube") spec.sizes = {0.8, 0.5, 0.7};
  if (type == "hull") spec.points = stone(5);
  if (type == "mesh") {
    spec.file = folder / "torus.obj";
    write_obj(spec.file, torus(0.35, 0.15));
  }
  return spec;
}

/// Two bodies connected by a spring that collide repeatedly. Without friction and with e = 1 energy
/// and both momenta are conserved, apart from the rounding of gaps where an impact is stopped
/// within a step: the fewer steps it has, the deeper it ends in the barrier. A ball against a mesh
/// needs shorter steps, since its distance is that of its centre.
class TiedScene : public ModelScene {
 public:
  int a = -1, b = -1;

  /// @param turns  Whether the second body rotates.
  TiedScene(const std::string& first, const std::string& second, bool turns)
      : ModelScene(Vec3::Zero()) {
    BodyMotion m = at({-0.7, 0.0, 0.0}, {0.1, 0.2, 0.0});
    m.W = {0.5, -0.3, 0.4};
    a = add("a", shape_of(first, folder_), 1.0, {0.05, 0.06, 0.08}, m);
    m = at({0.8, 0.05, -0.05}, {-0.05, -0.1, 0.1});
    if (turns) m.W = {-0.2, 0.4, 0.6};
    b = add("b", shape_of(second, folder_), 1.5, {0.08, 0.09, 0.1}, m);
    LoadSpec spring;
    spring.name = "spring";
    spring.type = "spring_damper";
    spring.a = a;
    spring.b = b;
    spring.parameters = {{"stiffness", 4.0}, {"free_length", 0.1}};
    model.loads.push_back(spring);
    law(0.0, 1.0);
    model.analysis.newton_tolerance = 1e-12;
  }
  /// A deformable bar bonded to a body at one end, without contact.
  /// @param from  Middle of that end in the axes of the body [m]; it goes along x.
  void add_bar(int body, const Vec3& from, double length) {
    MaterialSpec foam;
    foam.name = "foam";
    foam.type = "neo_hookean";
    foam.parameters = {{"youngs_modulus", 1e4}, {"poisson_ratio", 0.3}};
    foam.density = 100.0;
    model.materials = {foam};
    SolidSpec bar;
    bar.name = "bar_of_" + model.bodies.at(static_cast<std::size_t>(body)).name;
    bar.material = "foam";
    bar.element = "hex8_eas9";
    bar.mesh.type = "block";
    bar.mesh.parameters = {{"size", {length, 0.1, 0.1}}, {"cells", {1, 1, 1}}};
    bar.mesh.position = model.bodies.at(static_cast<std::size_t>(body)).position + from +
                        Vec3(0.5 * length, 0.0, 0.0);
    solids::Selection end;
    end.kind = solids::Selection::Kind::kPlane;
    end.normal = Vec3::UnitX();
    end.level = solids::Selection::Level::kMin;
    bar.bonded = {{.body = body, .place = {}, .nodes = {end}}};
    bar.contact.touches = false;
    model.solids.push_back(bar);
  }
  /// Takes steps. @returns the number of impacts.
  int count_hits(int steps) {
    int hits = 0;
    bool touched = false;
    for (int k = 0; k < steps; ++k) {
      step();
      double force = 0.0;
      for (const auto& r : simulation().contact_set()->reports()) force += r.normal_force;
      if (force > 0.0 && !touched) ++hits;
      touched = force > 0.0;
    }
    return hits;
  }
  /// @param most  Of the drifts [-].
  void expect_conservation(double most) const {
    const Ledger& l = simulation().state().ledger;
    testing::Test::RecordProperty("energy_drift",
                                  format("{:.2e}", l.energy_drift / l.energy_scale));
    testing::Test::RecordProperty("angular_momentum_drift",
                                  format("{:.2e}", l.l_drift / l.l_scale));
    EXPECT_LT(l.energy_drift, most * l.energy_scale);
    EXPECT_LT(l.p_drift, most * l.p_scale);
    EXPECT_LT(l.l_drift, most * l.l_scale);
  }

 private:
  Scratch folder_;
};

struct Tie {
  std::string first, second;
  double step;  ///< [s]
};
class Tied : public testing::TestWithParam<Tie> {};

TEST_P(Tied, BodiesKeepEnergyAndMomentaOverThousandsOfSteps) {
  TiedScene s(GetParam().first, GetParam().second, true);
  s.begin(GetParam().step);
  EXPECT_GT(s.count_hits(10'000), 5);
  s.expect_conservation(1e-10);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Tied,
                         testing::Values(Tie{"sphere", "sphere", 5e-3}, Tie{"box", "box", 2.5e-3},
                                         Tie{"hull", "hull", 2.5e-3}, Tie{"sphere", "mesh", 1e-3},
                                         Tie{"mesh", "mesh", 1e-3}, Tie{"sphere", "tube", 1e-3},
                                         Tie{"box", "capsule", 2.5e-3}),
                         [](const auto& tied) {
                           return tied.param.first + "_" + tied.param.second;
                         });

/// The same with a bar of deformable solid on each body, and one of them on a joint with a third.
struct Carrying {
  std::string first, second;
  bool joint;
  double step;  ///< [s]
  int steps;
};
class TiedWithSolids : public testing::TestWithParam<Carrying> {};

TEST_P(TiedWithSolids, BodiesKeepEnergyAndMomentaOverThousandsOfSteps) {
  const Carrying& given = GetParam();
  TiedScene s(given.first, given.second, !given.joint);
  s.add_bar(s.a, {-0.3, 0.0, 0.3}, 0.4);
  if (given.joint) {
    const Vec3 start = s.model.bodies[s.b].velocity;
    const int c = s.add_box("c", {0.1, 0.1, 0.1}, 0.4, at({1.5, 0.05, -0.05}, start));
    JointSpec joint;
    joint.name = "joint";
    joint.type = "spherical";
    joint.a = s.b;
    joint.b = c;
    joint.Z_a = {0.6, 0.0, 0.0};
    joint.Z_b = {-0.1, 0.0, 0.0};
    s.model.joints.push_back(joint);
    s.add_bar(c, {0.05, 0.0, 0.0}, 0.3);
  } else {
    s.add_bar(s.b, {0.3, 0.0, 0.0}, 0.3);
  }
  s.begin(given.step);
  EXPECT_GT(s.count_hits(given.steps), 5);
  s.expect_conservation(1e-14 * given.steps);
}

INSTANTIATE_TEST_SUITE_P(Shapes, TiedWithSolids,
                         testing::Values(Carrying{"sphere", "sphere", false, 2.5e-3, 3000},
                                         Carrying{"box", "box", true, 2.5e-3, 3000},
                                         Carrying{"hull", "hull", false, 2.5e-3, 3000},
                                         Carrying{"sphere", "mesh", true, 1e-3, 7000}),
                         [](const auto& tied) {
                           return tied.param.first + "_" + tied.param.second +
                                  (tied.param.joint ? "_on_joints" : "");
                         });

}  // namespace
}  // namespace polhode::test::contact_conservation_tests
