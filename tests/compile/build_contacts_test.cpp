// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include <polhode/compile/build_system.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::build_contacts_tests {
namespace {

const char* kBodies = R"(
  floor: {fixed: true, shape: {plane: z}, contact: {material: ice}}
  wall: {fixed: true, shape: {plane: x, position: [-9, 0, 0]}}
  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 1], contact: {material: rubber}}
  b: {shape: {sphere: 0.2}, mass: 3, position: [1, 0, 1]}
  c: {shape: [{sphere: 0.2}, {sphere: 0.2, position: [0, 0, 0.5]}], mass: 1, position: [2, 0, 1]}
)";

Model model_of(const std::string& more, const std::string& bodies = kBodies) {
  return io::read_model_text("format: 1\ngravity: [0, 0, -10]\nbodies:" + bodies + more +
                                 "\nanalysis: {duration: 1 s, step: 10 ms}\n",
                             "m.yaml");
}

struct Built {
  Model model;
  ContactMap map;
  std::shared_ptr<contact::ContactSet> set;

  explicit Built(Model m) : model(std::move(m)) {
    std::vector<int> bodies;
    int next = 0;
    for (const BodySpec& body : model.bodies) bodies.push_back(body.fixed ? kGround : next++);
    set = build_contacts(model, bodies, map);
  }
  [[nodiscard]] const contact::ContactLaw& law(const std::string& a, const std::string& b) const {
    return set->law(shape(a), shape(b));
  }
  [[nodiscard]] int shape(const std::string& name) const {
    const auto& all = set->shapes();
    for (int i = 0; i < static_cast<int>(all.size()); ++i)
      if (all[static_cast<std::size_t>(i)].name == name) return i;
    throw std::logic_error("no shape " + name);
  }
  [[nodiscard]] bool may_touch(const std::string& a, const std::string& b) const {
    const auto& all = set->shapes();
    return set->may_meet(all[static_cast<std::size_t>(shape(a))],
                         all[static_cast<std::size_t>(shape(b))]);
  }
};

TEST(BuildContacts, GivesNothingWithoutTheSection) {
  ContactMap map;
  EXPECT_EQ(build_contacts(model_of("", "\n  a: {mass: 1, inertia: [1, 1, 1]}\n"), {0}, map),
            nullptr);
}

TEST(BuildContacts, PrefersLawsOfBodyPairsThenOfMaterialPairs) {
  const Built built(model_of(R"(
contacts:
  default: {friction: 0.25, restitution: 0.4}
  materials: {rubber: {friction: 1, restitution: 0.9}, ice: {friction: 0.04, restitution: 0.3}}
  pairs:
    skid: {materials: [rubber, ice], friction: 0.07}
    feet: {between: [b, floor], friction: 0.8, law: linear}
)"));
  EXPECT_EQ(built.law("a", "floor").friction.mu, 0.07);
  EXPECT_EQ(built.law("a", "floor").restitution, 0.3);  // combined: the smaller one
  EXPECT_EQ(built.law("b", "floor").friction.mu, 0.8);
  EXPECT_EQ(built.law("b", "floor").potential, contact::NormalPotential::linear);
  EXPECT_EQ(built.law("c.0", "floor").friction.mu, std::sqrt(0.25 * 0.04));
  EXPECT_EQ(built.law("a", "b").friction.mu, std::sqrt(1 * 0.25));
  EXPECT_EQ(built.law("b", "c.1").friction.mu, 0.25);
  EXPECT_EQ(built.law("b", "c.1").restitution, 0.4);
}

TEST(BuildContacts, CombinesMaterialsByTheGivenRule) {
  for (const auto& [way, value] :
       {std::pair("mean", 0.5), std::pair("minimum", 0.2), std::pair("maximum", 0.8),
        std::pair("product", 0.16), std::pair("geometric_mean", 0.4)}) {
    const Built built(model_of(std::string(R"(
contacts:
  default: {friction: 0.2}
  materials: {rubber: {friction: 0.8}, ice: {}}
  combine: {friction: )") + way +
                               "}\n"));
    EXPECT_DOUBLE_EQ(built.law("a", "b").friction.mu, value) << way;
  }
}

TEST(BuildContacts, LeavesOutExcludedPairsAndBodiesThatShareAJoint) {
  const std::string contacts = R"(
joints: {link: {type: spherical, bodies: [a, b], at: [0.5, 0, 1]}}
contacts:
  materials: {rubber: {}, ice: {}}
  exclude: [[c, wall]]
)";
  const Built built(model_of(contacts));
  EXPECT_FALSE(built.may_touch("a", "b"));
  EXPECT_FALSE(built.may_touch("c.0", "wall"));
  EXPECT_TRUE(built.may_touch("c.0", "floor")) << "a fixed body that is not excluded";
  EXPECT_FALSE(built.may_touch("c.0", "c.1")) << "shapes of the same body";
  EXPECT_TRUE(Built(model_of(contacts + "  joint_neighbours: true\n")).may_touch("a", "b"));
  EXPECT_TRUE(Built(model_of(contacts + "  pairs: {ab: {between: [a, b]}}\n")).may_touch("a", "b"))
      << "a pair that is named is included";
}

TEST(BuildContacts, LetsGroupsTouchIfBothAllowIt) {
  const Built built(model_of("contacts: {}\n", R"(
  floor: {fixed: true, shape: {plane: z}}
  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 1], contact: {groups: [left], meets: [default]}}
  b: {shape: {sphere: 0.2}, mass: 1, position: [1, 0, 1], contact: {groups: [right]}}
)"));
  EXPECT_TRUE(built.may_touch("a", "floor"));
  EXPECT_TRUE(built.may_touch("b", "floor"));
  EXPECT_FALSE(built.may_touch("a", "b"));
}

TEST(BuildContacts, ReportsNamedPairsFirstAndAllPairsIfTheyAreFew) {
  const Built built(model_of(
      "contacts: {materials: {rubber: {}, ice: {}}, sensors: {near: {between: [c, wall]}}}\n"));
  ASSERT_FALSE(built.map.pairs.empty());
  EXPECT_EQ(built.map.pairs[0].sensor, "near");
  EXPECT_TRUE(built.map.all_pairs);
  EXPECT_EQ(built.map.pairs.size(), 9U);  // 3 of balls, 6 with floor and wall
  const Built few(
      model_of("contacts: {materials: {rubber: {}, ice: {}}, record: false, "
               "pairs: {ab: {between: [a, b]}}}\n"));
  EXPECT_EQ(few.map.pairs.size(), 1U);
}

const char* kRope = R"(
materials:
  rubber: {type: elastic, youngs_modulus: 50 MPa, poisson_ratio: 0.4, density: 1000}
sections:
  round: {type: circle, diameter: 0.1, material: rubber}
beams:
  rope: {points: [[-0.5, 0, 2], [0.5, 0, 2], [0.5, 0.4, 2]], elements: 14, section: round, contact: {},
         bonded: {a: start}}
contacts: {}
)";

TEST(BuildContacts, LetsBeamsTouchBodiesAndDistantPartsOfThemselves) {
  const Built built(model_of(kRope,
                             "\n  floor: {fixed: true, shape: {plane: z}}\n"
                             "  a: {shape: {sphere: 0.2}, mass: 1, position: [-0.5, 0, 2]}\n"
                             "  b: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 3]}\n"));
  EXPECT_TRUE(built.may_touch("rope.5", "floor"));
  EXPECT_TRUE(built.may_touch("rope.5", "b"));
  // Elements of 0.1 m, a radius of 0.05 m: elements nearer than half a turn around the bar are
  // excluded.
  EXPECT_FALSE(built.may_touch("rope.5", "rope.6"));
  EXPECT_FALSE(built.may_touch("rope.5", "rope.7"));
  EXPECT_TRUE(built.may_touch("rope.5", "rope.8"));
  // So is the body that holds its end.
  EXPECT_FALSE(built.may_touch("rope.0", "a"));
  EXPECT_FALSE(built.may_touch("rope.1", "a"));
  EXPECT_TRUE(built.may_touch("rope.4", "a"));
  // The node in the corner carries two bars, the others one.
  EXPECT_EQ(built.model.bodies[3 + 10].shapes.size(), 2U);
  EXPECT_EQ(built.model.bodies[3 + 9].shapes.size(), 1U);
}

const char* kOverlapping = R"(
  floor: {fixed: true, shape: {plane: z}}
  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.3]}
  b: {shape: {sphere: 0.2}, mass: 3, position: [0.1, 0, 0.3]}
)";

TEST(BuildContacts, NamesBodiesThatOverlapAtTheStart) {
  try {
    Simulation simulation(model_of("contacts: {}\n", kOverlapping));
    ADD_FAILURE() << "was accepted";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("'a' in 'b' by 0.1 m"), std::string::npos) << e.what();
  }
}

TEST(BuildContacts, MovesOverlappingBodiesApartTheLighterFarther) {
  const Simulation simulation(model_of("contacts: {overlaps: resolve}\n", kOverlapping));
  const double moved_a = -simulation.body(1).r.x(), moved_b = simulation.body(2).r.x() - 0.1;
  EXPECT_NEAR(moved_a, 0.075, 1e-6);
  EXPECT_NEAR(moved_b, 0.025, 1e-6);
  EXPECT_NEAR(simulation.body(1).r.z(), 0.3, 1e-12);
  EXPECT_NE(simulation.summary().narration.find("'a' was moved by"), std::string::npos);
}

}  // namespace
}  // namespace polhode::build_contacts_tests
