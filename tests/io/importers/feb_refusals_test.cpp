// SPDX-License-Identifier: Apache-2.0
// Files of FEBio with parts that a model would silently miss.
#include "feb_fixture.hpp"

namespace polhode::feb_refusals_tests {
namespace {

using namespace feb_tests;

using testing::HasSubstr;
using testing::Not;

std::string soft(const std::string& modulus = "<E>1000</E>") {
  return tag("material", tag("density", "1000") + modulus + tag("v", "0.3"),
             "id='1' name='soft' type='neo-Hookean'");
}

/// A cube of tissue.
std::string cube(const std::string& domains, const std::string& material = soft(),
                 const std::string& control_inside = "", const std::string& more = "") {
  return feb(control("DYNAMIC", 10, 0.1, control_inside) + tag("Material", material) +
             tag("Mesh", block(1, "part", Vec3::Zero(), Vec3::Ones())) +
             tag("MeshDomains", domains) + more);
}

class FebRefusals : public FebFixture {
 protected:
  std::string refused(const std::string& text) {
    try {
      static_cast<void>(io::read_model(write("m.feb", text)));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  std::string report(const std::string& text) {
    std::string list;
    for (const io::ImportNote& n : io::expanded_model(write("m.feb", text)).report.notes)
      list += format("{}: {}: {}\n", n.place.line, io::word_of(n.kind), n.what);
    return list;
  }
};

TEST_F(FebRefusals, DomainsHaveMaterialsThatExist) {
  EXPECT_EQ(refused(cube(domain("part", "soft"))), "none");
  EXPECT_THAT(refused(cube(domain("part", "soff"))),
              HasSubstr("there is no material 'soff'. Did you mean 'soft'?"));
  EXPECT_THAT(refused(cube("")), HasSubstr("the elements 'part' are in no domain"));
  EXPECT_THAT(refused(cube(domain("part", "soft") + domain("part", "soft"))),
              HasSubstr("the elements 'part' are in two domains"));
  // A material that is not read is the only error.
  const std::string other =
      refused(cube(domain("part", "soft"), tag("material", "", "id='1' name='soft' type='foam'")));
  EXPECT_THAT(other, HasSubstr("the material 'soft' of type 'foam' is not read"));
  EXPECT_THAT(other, Not(HasSubstr("no solid")));
}

TEST_F(FebRefusals, ParametersThatChangeByALoadControllerAreRefused) {
  const std::string loads = tag("LoadData", curve(1, "0,0;1,1"));
  EXPECT_THAT(refused(cube(domain("part", "soft"), soft("<E lc='1'>1000</E>"), "", loads)),
              HasSubstr("<E> changes by the load controller 1"));
  EXPECT_EQ(refused(cube(domain("part", "soft"), soft("<E lc='0'>1000</E>"), "", loads)), "none");
}

TEST_F(FebRefusals, UnknownTagsOfControlAreListed) {
  const std::string notes =
      report(cube(domain("part", "soft"), soft(),
                  "<time_steper/><zap>1</zap><plot_level>PLOT_MAJOR_ITRS</plot_level>"
                  "<solver type='solid'><dtol>0.1</dtol><dtoll>1</dtoll></solver>"));
  EXPECT_THAT(notes, HasSubstr("<time_steper> in <Control> is unknown"));
  EXPECT_THAT(notes, HasSubstr("<zap> in <Control> is unknown"));
  EXPECT_THAT(notes, HasSubstr("<dtoll> in <solver> is unknown"));
  EXPECT_THAT(notes, Not(HasSubstr("plot_level")));
  EXPECT_THAT(notes, Not(HasSubstr("<dtol> ")));
}

TEST_F(FebRefusals, WhatChangesTheForcesOfContactIsRefused) {
  const auto contact = [&](const std::string& type, const std::string& inside) {
    std::string mesh = block(1, "part", Vec3::Zero(), Vec3::Ones()) +
                       block(11, "plate", Vec3(-1, -1, 1.1), Vec3(2, 2, 1.2));
    mesh += tag("Surface", tag("quad4", "5,6,7,8", "id='1'"), "name='top'") +
            tag("Surface", tag("quad4", "11,14,13,12", "id='1'"), "name='under'") +
            tag("SurfacePair", tag("primary", "top") + tag("secondary", "under"), "name='pair'");
    return feb(
        control("DYNAMIC", 10, 0.1) + tag("Material", soft() + rigid(2, "plate")) +
        tag("Mesh", mesh) + tag("MeshDomains", domain("part", "soft") + domain("plate", "plate")) +
        tag("Rigid", fixed("plate", "111111")) +
        tag("Contact", tag("contact", inside, "type='" + type + "' surface_pair='pair' name='c'")));
  };
  EXPECT_EQ(refused(contact("sliding-elastic", "<penalty>1</penalty><two_pass>1</two_pass>")),
            "none");
  EXPECT_EQ(refused(contact("sliding-elastic", "<tension>0</tension><offset>0</offset>")), "none");
  EXPECT_THAT(refused(contact("sliding-elastic", "<tension>1</tension>")),
              HasSubstr("contact with tension is not read"));
  EXPECT_THAT(refused(contact("sticky", "<max_traction>5</max_traction>")),
              HasSubstr("<max_traction> of contact is not read"));
  EXPECT_THAT(refused(contact("sliding-elastic", "<offset>0.05</offset>")),
              HasSubstr("<offset> of contact is not read"));
  EXPECT_THAT(refused(contact("sliding-elastic", "<fric_coeff lc='1'>0.1</fric_coeff>")),
              HasSubstr("<fric_coeff> changes by the load controller 1"));
  EXPECT_THAT(report(contact("sliding-elastic", "<penaltty>1</penaltty>")),
              HasSubstr("<penaltty> in <contact> is unknown"));
}

// Two million lines of elements, which are not read at all.
TEST_F(FebRefusals, FilesOfTooManyElementsAreRefusedBeforeTheyAreRead) {
  const std::string line = "<elem id='1234567'>1,2,3,4,5,6,7,8</elem>\n";
  std::string lines;
  lines.reserve(2'000'000 * line.size());
  for (int k = 0; k < 2'000'000; ++k) lines += line;
  const std::string said = refused(feb(
      control("STATIC", 1, 1.0) + tag("Mesh", tag("Elements", lines, "type='hex8' name='part'"))));
  EXPECT_THAT(said, HasSubstr("bytes, more than 67108864"));
  EXPECT_LT(said.size(), 1000U);
}

TEST_F(FebRefusals, OptionsWithoutAMeaningAreErrors) {
  const std::string path = write("m.feb", cube(domain("part", "soft")));
  const auto message = [&](const char* option) -> std::string {
    try {
      static_cast<void>(io::read_model(path, {option}));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  };
  EXPECT_THAT(message("import.start.hinge=0.3"), HasSubstr("import.start is given"));
  EXPECT_THAT(message("import.base=floating"), HasSubstr("Leave import.base out"));
}

}  // namespace
}  // namespace polhode::feb_refusals_tests
