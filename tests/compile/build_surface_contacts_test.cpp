// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::build_surface_contacts_tests {
namespace {

using testing::HasSubstr;

/// A pad on a plate above the floor, with a roller beside it.
Model model_of(const std::string& contacts, const std::string& pad = "",
               const std::string& analysis = "{duration: 1 s, step: 10 ms}",
               const std::string& floor = "") {
  return io::read_model_text(R"(
format: 1
bodies:
  floor: {fixed: true, shape: {plane: z})" +
                                 floor + R"(}
  plate: {shape: {box: [1, 1, 0.1]}, density: 500, position: [0, 0, 0.65]}
  roller: {shape: {cylinder: [0.4, 0.6]}, density: 500, position: [2, 0, 0.3]}
materials:
  rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.25, density: 1000}
solids:
  pad:
    mesh: {block: {size: [0.4, 0.4, 0.5], cells: [4, 4, 5]}, position: [0, 0, 0.35]}
    material: rubber
    bonded: {plate: zmax}
    )" + pad + "\n" + contacts +
                                 "\nanalysis: " + analysis + "\n",
                             "m.yaml");
}
const std::string kAlone = "exclude: [[plate, floor], [plate, roller], [roller, floor]]";

std::vector<std::string> met(const Model& model) {
  std::vector<std::string> names;
  for (const SurfacePair& pair : plan_surface_contacts(model))
    names.push_back(model.bodies[static_cast<std::size_t>(pair.side.index)].name);
  std::sort(names.begin(), names.end());
  return names;
}

TEST(BuildSurfaceContacts, LetsASolidTouchAllBodiesExceptThoseItIsBondedTo) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(met(model_of("")), Names{}) << "without contacts";
  EXPECT_EQ(met(model_of("contacts: {}")), (Names{"floor", "roller"}));
  EXPECT_EQ(met(model_of("contacts: {joint_neighbours: true}")),
            (Names{"floor", "plate", "roller"}));
  EXPECT_EQ(met(model_of("contacts: {pairs: {own: {between: [pad, plate]}}}")),
            (Names{"floor", "plate", "roller"}))
      << "a pair that is named is included";
  EXPECT_EQ(met(model_of("contacts: {exclude: [[floor, pad]]}")), Names{"roller"});
  EXPECT_EQ(met(model_of("contacts: {}", "contact: {touches: false}")), Names{});
  EXPECT_EQ(met(model_of("contacts: {}", "contact: {meets: [base]}", "{duration: 1 s, step: 10 ms}",
                         ", contact: {groups: [base]}")),
            Names{"floor"});
  EXPECT_EQ(met(model_of("contacts: {}", "contact: {groups: [soft]}")), (Names{"floor", "roller"}));
}

TEST(BuildSurfaceContacts, PrefersLawsOfBodyPairsThenOfMaterialPairs) {
  const auto friction = [](const std::string& contacts, const std::string& body) {
    const Model model = model_of(contacts, "contact: {material: soft}",
                                 "{duration: 1 s, step: 10 ms}", ", contact: {material: ice}");
    for (const SurfacePair& pair : plan_surface_contacts(model))
      if (model.bodies[static_cast<std::size_t>(pair.side.index)].name == body)
        return pair.law.friction;
    return -1.0;
  };
  const std::string materials = "materials: {ice: {friction: 0.04}, soft: {friction: 1}}";
  const std::string contacts = "contacts: {default: {friction: 0.25}, " + materials;
  EXPECT_DOUBLE_EQ(friction(contacts + "}", "floor"), 0.2);
  EXPECT_DOUBLE_EQ(friction(contacts + "}", "roller"), 0.5);
  const std::string pair = ", pairs: {m: {materials: [soft, ice], friction: 0.3}";
  EXPECT_EQ(friction(contacts + pair + "}}", "floor"), 0.3);
  EXPECT_EQ(friction(contacts + pair + ", f: {between: [floor, pad], friction: 0.7}}}", "floor"),
            0.7);
}

/// The law as built, and the number of contact points.
struct Built {
  Simulation simulation;
  const surface_contact::SurfaceContact* contact = nullptr;

  Built(const std::string& contacts, const std::string& pad) : simulation(model_of(contacts, pad)) {
    for (const ContactMap::Surface& s : simulation.contact_map().surfaces)
      if (simulation.model().bodies[static_cast<std::size_t>(s.side.index)].name == "floor")
        contact = &dynamic_cast<const surface_contact::SurfaceContact&>(
            simulation.system().nodes().group(s.group));
  }
};

// @tests{surface-stiffness}
TEST(BuildSurfaceContacts, ChoosesBandAndStiffnessFromTheSolid) {
  const Built plain("contacts: {" + kAlone + "}", "contact: {surface: zmin}");
  ASSERT_TRUE(plain.contact);
  EXPECT_EQ(plain.contact->size(), 25);
  const contact::NormalLaw& law = plain.contact->law().normal;
  EXPECT_NEAR(law.tolerance, 1e-4, 1e-12) << "1e-3 of an edge";
  EXPECT_NEAR(law.stiffness, 1.5 * 0.02 * 1e6 / 1e-4, 1.0) << "2 % of Young's modulus";
  EXPECT_EQ(law.force(0.0), 0.0) << "no force where surfaces just touch";
  EXPECT_NEAR(law.force(-0.5e-4), 0.02 * 1e6, 1e-6) << "in the middle of the band";
  EXPECT_EQ(plain.contact->law().end_share, 0.5) << "restitution 0";

  const Built stated("contacts: {" + kAlone +
                         ", default: {gap_tolerance: 1 mm, reference_pressure: 4 kPa, "
                         "restitution: 1, friction: 0.3}}",
                     "");
  EXPECT_EQ(stated.contact->law().normal.tolerance, 1e-3);
  EXPECT_NEAR(stated.contact->law().normal.force(-0.5e-3), 4e3, 1e-9);
  EXPECT_EQ(stated.contact->law().end_share, 0.0);
  EXPECT_EQ(stated.contact->law().mu, 0.3);
  // The whole boundary: 5 x 5 x 6 nodes less the 3 x 3 x 4 inside.
  EXPECT_EQ(stated.contact->size(), 150 - 36);
  // The stiffness does not depend on the step, so that results converge with the step to a limit.
  Model quick = model_of("contacts: {" + kAlone + ", default: {gap_tolerance: 1 mm}}");
  quick.analysis.step = 1e-4;
  const Simulation fast(std::move(quick));
  const int group = fast.contact_map().surfaces.front().group;
  EXPECT_NEAR(
      dynamic_cast<const surface_contact::SurfaceContact&>(fast.system().nodes().group(group))
          .law()
          .normal.stiffness,
      1.5 * 0.02 * 1e6 / 1e-3, 1.0);
}

std::string complaint(const std::string& contacts, const std::string& pad = "",
                      const std::string& analysis = "{duration: 1 s, step: 10 ms}") {
  try {
    const Simulation simulation(model_of(contacts, pad, analysis));
  } catch (const std::exception& e) {
    return e.what();
  }
  return "";
}

TEST(BuildSurfaceContacts, RefusesSolidsThatOverlapAtTheStart) {
  EXPECT_EQ(complaint("contacts: {" + kAlone + "}"), "");
  Model model = model_of("contacts: {" + kAlone + "}");
  model.solids[0].mesh.position[2] -= 0.11;
  try {
    const Simulation simulation(std::move(model));
    FAIL() << "the pad starts 1 cm in the floor";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("pad in floor by 0.01 m"));
    EXPECT_THAT(e.what(), HasSubstr("contacts.overlaps: resolve"));
  }
}

TEST(BuildSurfaceContacts, RefusesFrictionAndContactsOfBodiesInStatics) {
  const std::string statics = "{type: statics}";
  const std::string hold = "prescribed: {hold: {nodes: zmin, x: 0, y: 0, z: 0}}";
  EXPECT_EQ(complaint("contacts: {" + kAlone + "}", hold, statics), "");
  EXPECT_THAT(complaint("contacts: {" + kAlone + ", default: {friction: 0.2}}", hold, statics),
              HasSubstr("touch with friction, which statics does not support"));
  EXPECT_THAT(complaint("contacts: {}", hold, statics), HasSubstr("bodies may touch bodies"));
}

/// A rope from a mast to a ball, past a post.
Model rope_of(const std::string& contact, const std::string& contacts = "contacts: {}",
              const std::string& mast = "shape: {box: [0.1, 0.1, 1]}") {
  return io::read_model_text(R"(
format: 1
bodies:
  mast: {fixed: true, )" + mast +
                                 R"(, position: [0, 0, -0.4]}
  post: {fixed: true, shape: {sphere: 0.2}, position: [1, 0, -0.2]}
  floor: {fixed: true, shape: {plane: z}, position: [0, 0, -2]}
  ball: {shape: {sphere: 0.1}, mass: 1, position: [2, 0, 0]}
cables:
  rope: {through: [[mast, [0, 0, 0.4]], [ball]], stiffness: 10 kN, free_length: 2, mass_per_length: 0.5,
         elements: 10, )" + contact +
                                 "}\n" + contacts + "\nanalysis: {duration: 1 s, step: 10 ms}\n",
                             "rope.yaml");
}

const surface_contact::SurfaceContact& contact_with(const Simulation& s, const std::string& body) {
  for (const ContactMap::Surface& surface : s.contact_map().surfaces)
    if (s.model().side_name(surface.side) == body)
      return dynamic_cast<const surface_contact::SurfaceContact&>(
          s.system().nodes().group(surface.group));
  throw std::logic_error("the cable does not meet " + body);
}

TEST(BuildSurfaceContacts, LetsACableTouchBodiesIncludingThoseItIsAttachedTo) {
  using Names = std::vector<std::string>;
  const std::string round = "contact: {radius: 20 mm}";
  EXPECT_EQ(met(rope_of("damping: 0")), Names{}) << "without contact";
  EXPECT_EQ(met(rope_of(round)), (Names{"ball", "floor", "mast", "post"}));
  EXPECT_EQ(met(rope_of("contact: {radius: 20 mm, touches: false}")), Names{});
  EXPECT_EQ(met(rope_of(round, "contacts: {exclude: [[rope, mast], [ball, rope]]}")),
            (Names{"floor", "post"}));
  EXPECT_EQ(met(rope_of("contact: {radius: 20 mm, meets: [wood]}", "contacts: {}",
                        "shape: {box: [0.1, 0.1, 1]}, contact: {groups: [wood]}")),
            Names{"mast"});
}

// @tests{cable-gap}
TEST(BuildSurfaceContacts, ChoosesContactPointsOfACableByTheCurvatureOfTheBody) {
  const Simulation s(rope_of("contact: {radius: 20 mm}"));
  EXPECT_EQ(contact_with(s, "floor").size(), 11) << "at the nodes only";
  // Pieces of 0.2 m, points no farther apart than (0.02 + 0.1)/2 m.
  EXPECT_EQ(contact_with(s, "post").size(), 41);
  // Half of the radius: 20 points a piece. The rope comes out of the mast at 0.05 m, where it
  // touches; half a turn of its radius, 0.0628 m, is longer: 7 points are left out.
  EXPECT_EQ(contact_with(s, "mast").size(), 201 - 7);
  // It is fixed to the middle of the ball, of radius 0.05 m, and leaves it at 0.07 m: a piece has
  // six points, 0.0333 m apart, of which three are inside or near.
  EXPECT_EQ(contact_with(s, "ball").size(), 61 - 3);
}

// @tests{cable-stiffness}
TEST(BuildSurfaceContacts, GivesACableTheStiffnessOfASolidRoundBar) {
  const double area = std::numbers::pi * 0.02 * 0.02, pressure = 1e-3 * 10e3 / area;
  const Simulation s(rope_of("contact: {radius: 20 mm}"));
  const contact::NormalLaw& law = contact_with(s, "post").law().normal;
  EXPECT_NEAR(law.tolerance, 2e-5, 1e-12) << "1e-3 of the radius";
  EXPECT_NEAR(law.force(0.0) / pressure, 1.0, 1e-12);
  Model quick = rope_of("contact: {radius: 20 mm}");
  quick.analysis.step = 1e-6;
  const Simulation fast(quick);
  EXPECT_EQ(contact_with(fast, "post").law().normal.stiffness, law.stiffness) << "at any step";
}

}  // namespace
}  // namespace polhode::build_surface_contacts_tests
