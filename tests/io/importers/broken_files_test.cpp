// SPDX-License-Identifier: Apache-2.0
// Damaged and huge files of all formats: errors with file and line, in bounded memory.
#include <sys/resource.h>

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/file_error.hpp>

#include <support/paths.hpp>
#include <support/scratch.hpp>

namespace polhode::broken_files_tests {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class BrokenFiles : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// Message of a file that is refused.
  std::string fault(const std::string& name, const std::string& text,
                    const io::Overrides& overrides = {}) {
    try {
      static_cast<void>(io::read_model(write(name, text), overrides));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    } catch (const io::FileError& error) {
      return error.what();
    }
    return "none";
  }
  test::Scratch folder_;
};

std::string corpus(const std::string& name) {
  std::ifstream file(test::source_dir() + "/tests/corpus/robots/" + name, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string mjcf(const std::string& inside) {
  return "<mujoco><worldbody>\n<body name='b'><joint name='j'/>\n" + inside +
         "</body></worldbody></mujoco>\n";
}
std::string sdf(const std::string& inside) {
  return "<sdf version='1.10'><model name='m'>\n<link name='a'>\n" + inside +
         "</link></model></sdf>\n";
}
std::string urdf(const std::string& inside) {
  return "<robot name='r'><link name='base'/><link name='a'>\n" + inside +
         "</link><joint name='j' type='continuous'><parent link='base'/><child link='a'/></joint>"
         "</robot>\n";
}

TEST_F(BrokenFiles, CutAnywhereAreErrorsWithTheirLine) {
  for (const std::string name : {"four_bar.urdf", "walker.xml", "world.sdf", "pendulum.feb"}) {
    const std::string whole = corpus(name);
    ASSERT_GT(whole.size(), 500U);
    for (std::size_t part = 1; part < 40; ++part) {
      const std::string what = fault(name, whole.substr(0, whole.size() * part / 40));
      EXPECT_THAT(what, ContainsRegex(name + ":[0-9]+:[0-9]+: error: ")) << name << " " << part;
      EXPECT_THAT(what, HasSubstr("not XML")) << name << " " << part;
    }
  }
}

TEST_F(BrokenFiles, NumbersThatAreNoneHaveTheirLine) {
  for (const std::string number : {"1e999", "two", "nan", "inf", "0x10", "1,5", "--1", ""}) {
    EXPECT_THAT(fault("a.xml", mjcf("<geom size='" + number + "'/>\n")), HasSubstr("a.xml:3:"))
        << number;
    EXPECT_THAT(fault("a.urdf", urdf("<inertial><mass value='" + number + "'/></inertial>\n")),
                HasSubstr("a.urdf:2:"))
        << number;
    if (!number.empty()) {  // A tag without text has its standard value.
      EXPECT_THAT(fault("a.sdf", sdf("<inertial><mass>" + number + "</mass></inertial>\n")),
                  HasSubstr("a.sdf:3:"))
          << number;
    }
  }
}

TEST_F(BrokenFiles, MassesWithoutInertiaHaveTheirLine) {
  EXPECT_THAT(fault("a.xml", mjcf("<inertial pos='0 0 0' mass='1' diaginertia='0 0 0'/>\n")),
              ContainsRegex("a.xml:2:[0-9]+: error: the link 'b' has no inertia"));
  EXPECT_THAT(fault("a.urdf", urdf("<inertial><mass value='1'/></inertial>\n")),
              ContainsRegex("a.urdf:1:[0-9]+: error: the link 'a' has no inertia"));
  EXPECT_THAT(fault("a.sdf", sdf("<inertial><mass>1</mass><inertia><ixx>0</ixx><iyy>0</iyy>"
                                 "<izz>0</izz></inertia></inertial>\n")),
              ContainsRegex("a.sdf:2:[0-9]+: error: the link 'a' has no inertia"));
  EXPECT_THAT(fault("a.xml", mjcf("<inertial pos='0 0 0' mass='1' diaginertia='1 1 3'/>\n")),
              HasSubstr("a.xml:2:"));
}

TEST_F(BrokenFiles, MeshesThatAreMissingHaveTheirLine) {
  EXPECT_THAT(fault("a.urdf", urdf("<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/>"
                                   "</inertial>\n<visual><geometry><mesh filename='no.stl'/>"
                                   "</geometry></visual>")),
              ContainsRegex("a.urdf:3:[0-9]+: error: there is no mesh 'no.stl'"));
  EXPECT_THAT(fault("a.sdf", sdf("\n<visual name='v'><geometry><mesh><uri>no.stl</uri></mesh>"
                                 "</geometry></visual>")),
              ContainsRegex("a.sdf:4:[0-9]+: error: there is no mesh 'no.stl'"));
  EXPECT_THAT(fault("a.xml",
                    "<mujoco><asset>\n<mesh name='m' file='no.stl'/></asset><worldbody>\n<body>"
                    "<joint/>\n<geom type='mesh' mesh='m'/></body></worldbody></mujoco>"),
              ContainsRegex("a.xml:[24]:[0-9]+: error: the mass of the mesh 'm' is not known"));
}

TEST_F(BrokenFiles, EntitiesAreNotExpanded) {
  std::string bomb = "<!DOCTYPE r [<!ENTITY a 'aaaaaaaaaa'>\n";
  for (char c = 'b'; c < 'z'; ++c) {
    bomb += format("<!ENTITY {} '", c);
    for (int k = 0; k < 10; ++k) bomb += format("&{};", static_cast<char>(c - 1));
    bomb += "'>\n";
  }
  for (const std::string name : {"a.urdf", "a.xml", "a.sdf", "a.feb"})
    EXPECT_THAT(fault(name, bomb + "]><robot>&y;</robot>"),
                HasSubstr("declarations of entities are not allowed"))
        << name;
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

std::string many(const std::string& tag, int count) {
  std::string text;
  text.reserve(tag.size() * static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) text += tag;
  return text;
}

// A tag takes some 200 bytes, and the sanitizers about three times as many.
TEST_F(BrokenFiles, AMillionTagsAreReadInBoundedMemory) {
  const double before = peak_megabytes();
  const std::string tags = many("<zap/>\n", 1'000'000);
  EXPECT_EQ(fault("a.xml", mjcf("<geom size='0.1'/>" + tags)), "none");
  EXPECT_EQ(fault("a.sdf", sdf(tags)), "none");
  EXPECT_EQ(fault("a.urdf", urdf("<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'/>"
                                 "</inertial>" +
                                 tags)),
            "none");
  EXPECT_LT(peak_megabytes() - before, 2000.0);
  EXPECT_THAT(fault("a.urdf", urdf(many("<zap/>\n", 9'700'000))), HasSubstr("a.urdf:1"));
}

// Tags that are read take a time in proportion to their number: with its square these would take
// some minutes.
TEST_F(BrokenFiles, ManyTagsOfOneBodyAreReadInTheirTime) {
  const Model model =
      io::read_model(write("a.xml", mjcf("<geom size='0.1' group='4'/>" +
                                         many("<geom size='0.1' group='4'/>\n", 50'000) +
                                         many("<site/>\n", 50'000))),
                     {});
  const double density = 1000.0, volume = 4.0 / 3.0 * 3.14159265358979324 * 1e-3;
  EXPECT_NEAR(model.bodies.at(1).mass, 50'001 * density * volume, 1e-6);
}

}  // namespace
}  // namespace polhode::broken_files_tests
