// SPDX-License-Identifier: Apache-2.0
// Geometry and masses of the built-in models, the same as in the tables of time per step; the
// N-four-bar is that of the IFToMM library of computational benchmark problems (case A02).
#include <polhode/io/text/example_models.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::example_models_tests {
namespace {

using testing::HasSubstr;

Model model_of(const std::string& name, const std::map<std::string, std::string>& values) {
  for (const io::ModelGenerator& generator : io::model_generators())
    if (generator.name == name)
      return io::read_model_text(io::generate_model(generator, values), name + ".yaml");
  throw std::logic_error("no generator " + name);
}

/// Point Z of body b, in the ground frame.
Vec3 place(const Model& model, const JointSpec& joint, int body, const Vec3& Z) {
  (void)joint;
  if (body == kGround) return Z;
  const BodySpec& spec = model.bodies[static_cast<std::size_t>(body)];
  return spec.position + spec.orientation * Z;
}

TEST(ModelGenerators, GiveModelsThatAreAssembled) {
  for (const io::ModelGenerator& generator : io::model_generators()) {
    const Model model = model_of(generator.name, {{"N", "7"}});
    for (const JointSpec& joint : model.joints) {
      const Vec3 gap =
          place(model, joint, joint.b, joint.Z_b) - place(model, joint, joint.a, joint.Z_a);
      EXPECT_LT(gap.norm(), 1e-15) << generator.name << ", joint " << joint.name;
    }
  }
}

TEST(ModelGenerators, CountBodiesAndJointsOfTheFourBar) {
  const Model model = model_of("n_four_bar", {{"N", "40"}});
  ASSERT_EQ(model.bodies.size(), 81u);
  EXPECT_EQ(model.joints.size(), 121u);
  EXPECT_EQ(model.bodies[0].name, "b0");
  EXPECT_EQ(model.bodies[40].position, Vec3(40, 0.5, 0));  // The last upright.
  EXPECT_EQ(model.bodies[41].position, Vec3(0.5, 1, 0));   // The first bar.
  EXPECT_EQ(model.bodies[0].inertia(0, 0),
            1.0 / 12.0);  // Exact, so that published figures can be compared.
  EXPECT_EQ(model.bodies[0].inertia(1, 1), 1e-3);
  EXPECT_EQ(model.bodies[41].inertia(0, 0), 1e-3);
  EXPECT_EQ(model.bodies[0].angular_velocity, Vec3(0, 0, -1));
  EXPECT_EQ(model.bodies[41].velocity, Vec3(1, 0, 0));
  EXPECT_EQ(model.gravity, Vec3(0, -9.81, 0));
  EXPECT_EQ(model.analysis.duration, 10.0);
  EXPECT_EQ(model.analysis.step, 0.01);
}

TEST(ModelGenerators, HangTheChainOnTheGround) {
  const Model model = model_of("chain", {{"N", "3"}, {"joint", "spherical"}});
  ASSERT_EQ(model.joints.size(), 3u);
  EXPECT_EQ(model.joints[0].a, kGround);
  EXPECT_EQ(model.joints[2].a, 1);
  EXPECT_EQ(model.joints[2].type, "spherical");
  EXPECT_EQ(model.bodies[1].inertia(1, 1), 0.1 * 0.1 / 12 + 1e-3);
}

TEST(ModelGenerators, BranchTheTreeInTwo) {
  const Model model = model_of("binary_tree", {{"N", "7"}});
  for (int i = 1; i < 7; ++i)
    EXPECT_EQ(model.joints[static_cast<std::size_t>(i)].a, (i - 1) / 2) << "rod " << i;
}

TEST(ModelGenerators, RefuseUnknownParametersAndInvalidValues) {
  const io::ModelGenerator& chain = io::model_generators()[1];
  const auto message = [&](const std::map<std::string, std::string>& values) -> std::string {
    try {
      (void)io::generate_model(chain, values);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message({{"n", "3"}}), HasSubstr("chain: has no parameter 'n'."));
  EXPECT_THAT(message({{"N", "3.5"}}), HasSubstr("but is '3.5'"));
  EXPECT_THAT(message({{"N", "0"}}), HasSubstr("from 1 to"));
  EXPECT_THAT(message({{"joint", "hinge"}}), HasSubstr("Use revolute or spherical."));
}

}  // namespace
}  // namespace polhode::example_models_tests
