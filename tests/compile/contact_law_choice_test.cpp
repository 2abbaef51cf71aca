// SPDX-License-Identifier: Apache-2.0
// The law of contacts that a model gets which names none.
#include <string>

#include <gtest/gtest.h>

#include <polhode/compile/contact_law_choice.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::contact_law_choice_tests {
namespace {

constexpr const char* kBall = "  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 1]}\n";
constexpr const char* kCrate =
    "  crate: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [1, 0, 1]}\n";

Model model(const std::string& bodies, const std::string& contacts = "{}",
            const std::string& analysis = "", const std::string& more = "") {
  return io::read_model_text(
      format("format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
             "  floor: {{fixed: true, shape: {{plane: z}}}}\n{}{}contacts: {}\n"
             "analysis: {{duration: 1, step: 1 ms{}}}\n",
             bodies, more, contacts, analysis),
      "m.yaml");
}

std::string law(const Model& m) { return m.contacts.standard.potential; }

}  // namespace

TEST(ContactLawChoice, RowsOfFewBodies) {
  EXPECT_EQ(law(model(kBall)), "rigid");
  EXPECT_EQ(law(model(std::string(kBall) + kCrate, "{default: {friction: 0.3}}")), "rigid");
  const Model pairs = model(kBall, "{pairs: {bounce: {between: [ball, floor], restitution: 0.5}}}");
  EXPECT_EQ(law(pairs), "rigid");
  EXPECT_EQ(pairs.contacts.pairs.at(0).law.potential, "rigid");
}

TEST(ContactLawChoice, AKeyOfForcesAsksForThem) {
  for (const char* key : {"law: barrier", "gap_tolerance: 1 mm", "stiffness: 1e5",
                          "reference_load: 10", "friction_stiffness: 1e5, friction: 0.1"}) {
    EXPECT_EQ(law(model(kBall, format("{{default: {{{}}}}}", key))), "barrier") << key;
    EXPECT_EQ(law(model(kBall, format("{{pairs: {{p: {{between: [ball, floor], {}}}}}}}", key))),
              "barrier")
        << key;
  }
  EXPECT_EQ(law(model(kBall, "{default: {law: hertz}}")), "hertz");
}

TEST(ContactLawChoice, ForcesForTheRestAndWhy) {
  const auto why = [](const Model& m) {
    EXPECT_EQ(law(m), "barrier");
    return choose_contact_law(m).reason;
  };
  EXPECT_EQ(why(model(kBall, "{}", ", rho_inf: 0.9")), "as rho_inf is below 1");
  EXPECT_EQ(why(model(kBall, "{}", ", momentum_rate: kinematic")),
            "as momentum_rate is not momentum");
  EXPECT_EQ(why(model(std::string(kCrate) +
                      "  chest: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 1]}\n")),
            "as two bodies with edges may touch");
  EXPECT_EQ(why(model("  drum: {shape: {cylinder: [0.2, 0.2]}, mass: 1, position: [0, 0, 1]}\n")),
            "as body 'drum' has a rim, which may come to lie flat");
  std::string many;
  for (int k = 0; k < 13; ++k)
    many += format("  b{}: {{shape: {{sphere: 0.1}}, mass: 1, position: [{}, 0, 1]}}\n", k, k);
  EXPECT_EQ(why(model(many)), "as more than 12 bodies may touch");
  EXPECT_EQ(why(model("  pipe: {shape: {tube: [0.2, 0.1, 0.3]}, mass: 1, position: [0, 0, 1]}\n")),
            "as body 'pipe' has a tube");
  EXPECT_EQ(why(model(kBall, "{}", "",
                      "joints:\n  rail: {type: prismatic, bodies: [ground, ball], at: [0, 0, 1], "
                      "axis: x, limits: {upper: 1, band: 1 mm}}\n")),
            "as the stop of joint 'rail' gives way");
}

}  // namespace polhode::contact_law_choice_tests
