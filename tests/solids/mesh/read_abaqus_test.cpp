// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::read_abaqus_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Two bricks one above the other, unit cubes, with numbers that are not consecutive.
std::string two_bricks(const std::string& rest) {
  std::string text = "** written by hand\n*Heading\n two bricks\n*Node, nset=All\n";
  for (int z = 0; z < 3; ++z)
    for (int k = 0; k < 4; ++k)
      text += "  " + std::to_string(100 * (z + 1) + k) + ", " + std::to_string(k == 1 || k == 2) +
              "., " + std::to_string(k > 1) + ".0D0, " + std::to_string(z) + "\n";
  return text +
         "*Element, type=C3D8R,\n elset=\"Lower half\"\n10, 100, 101, 102, 103, 200,\n"
         "201, 202, 203\n*ELEMENT, TYPE=C3D8R, ELSET=upper\n20, 200, 201, 202, 203,\n"
         "300, 301, 302, 303\n" +
         rest;
}

std::string message(const std::string& text) {
  try {
    (void)solids::parse_mesh("part.inp", text);
    return "no error";
  } catch (const InputError& e) {
    return e.what();
  }
}

TEST(ReadAbaqus, GathersSets) {
  const solids::Mesh mesh =
      solids::parse_mesh("part.inp", two_bricks("*NSET, NSET=foot, GENERATE\n100, 103, 1\n"
                                                "*NSET, NSET=ends\nFOOT, 301,\n303\n"
                                                "*ELSET, ELSET=both\nUpper, lower HALF\n"
                                                "*ELSET, ELSET=step, GENERATE\n10, 20, 10\n"
                                                "*MATERIAL, NAME=rubber\n*DENSITY\n1100.,\n"));
  EXPECT_EQ(mesh.node_sets.at("All").size(), 12U);
  EXPECT_THAT(mesh.node_sets.at("foot"), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(mesh.node_sets.at("ends"), ElementsAre(0, 1, 2, 3, 9, 11));
  EXPECT_THAT(mesh.element_sets.at("Lower half"), ElementsAre(0));
  EXPECT_THAT(mesh.element_sets.at("both"), ElementsAre(0, 1));
  EXPECT_THAT(mesh.element_sets.at("step"), ElementsAre(0, 1));
  EXPECT_EQ(mesh.node_label(4), 200);
  EXPECT_EQ(mesh.element_label(1), 20);
  EXPECT_THAT(mesh.notes,
              ElementsAre("ignored, as it does not define the mesh: *DENSITY, *MATERIAL"));
  EXPECT_THAT(solids::mesh_faults(mesh), testing::IsEmpty());
}

// Each face by its Abaqus name and its position on a unit cube, a tetrahedron, a wedge.
TEST(ReadAbaqus, NumbersTheFacesOfSolids) {
  const auto middle = [](const solids::Mesh& mesh, const char* name) {
    const solids::Surface& surface = mesh.surfaces.at(name);
    Vec3 sum = Vec3::Zero();
    for (int node : surface.nodes()) sum += mesh.nodes[node];
    return Vec3(sum / static_cast<double>(surface.nodes().size()));
  };
  const solids::Mesh brick = solids::parse_mesh(
      "part.inp", two_bricks("*SURFACE, NAME=S1\n10, S1\n*SURFACE, NAME=S2\nLower half, S2\n"
                             "*SURFACE, NAME=S3, TYPE=ELEMENT\n10, S3\n*SURFACE, NAME=S4\n10, S4\n"
                             "*SURFACE, NAME=S5\n10, s5\n*SURFACE, NAME=S6\n10, S6\n"
                             "*SURFACE, NAME=free\nlower half,\n"
                             "*SURFACE, NAME=points, TYPE=NODE\n100, 101\n"));
  EXPECT_EQ(middle(brick, "S1"), Vec3(0.5, 0.5, 0.0));
  EXPECT_EQ(middle(brick, "S2"), Vec3(0.5, 0.5, 1.0));
  EXPECT_EQ(middle(brick, "S3"), Vec3(0.5, 0.0, 0.5));
  EXPECT_EQ(middle(brick, "S4"), Vec3(1.0, 0.5, 0.5));
  EXPECT_EQ(middle(brick, "S5"), Vec3(0.5, 1.0, 0.5));
  EXPECT_EQ(middle(brick, "S6"), Vec3(0.0, 0.5, 0.5));
  EXPECT_EQ(brick.surfaces.at("free").size(), 5);
  EXPECT_THAT(brick.node_sets.at("points"), ElementsAre(0, 1));

  const solids::Mesh tet = solids::parse_mesh(
      "part.inp",
      "*NODE\n1, 0, 0, 0\n2, 3\n3, 0, 3\n4, 0, 0, 3\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n"
      "*SURFACE, NAME=S1\n1, S1\n*SURFACE, NAME=S2\n1, S2\n*SURFACE, NAME=S3\n1, S3\n"
      "*SURFACE, NAME=S4\n1, S4\n");
  EXPECT_EQ(middle(tet, "S1"), Vec3(1, 1, 0));
  EXPECT_EQ(middle(tet, "S2"), Vec3(1, 0, 1));
  EXPECT_EQ(middle(tet, "S3"), Vec3(1, 1, 1));
  EXPECT_EQ(middle(tet, "S4"), Vec3(0, 1, 1));

  const solids::Mesh wedge = solids::parse_mesh(
      "part.inp",
      "*NODE\n1, 0, 0, 0\n2, 3\n3, 0, 3\n4, 0, 0, 2\n5, 3, 0, 2\n6, 0, 3, 2\n"
      "*ELEMENT, TYPE=C3D6\n1, 1, 2, 3, 4, 5, 6\n"
      "*SURFACE, NAME=S1\n1, S1\n*SURFACE, NAME=S2\n1, S2\n*SURFACE, NAME=S3\n1, S3\n"
      "*SURFACE, NAME=S4\n1, S4\n*SURFACE, NAME=S5\n1, S5\n");
  EXPECT_EQ(middle(wedge, "S1"), Vec3(1, 1, 0));
  EXPECT_EQ(middle(wedge, "S2"), Vec3(1, 1, 2));
  EXPECT_EQ(middle(wedge, "S3"), Vec3(1.5, 0, 1));
  EXPECT_EQ(middle(wedge, "S4"), Vec3(1.5, 1.5, 1));
  EXPECT_EQ(middle(wedge, "S5"), Vec3(0, 1.5, 1));
}

TEST(ReadAbaqus, ReadsOnePartInPlace) {
  const std::string body =
      two_bricks("*END PART\n*ASSEMBLY, NAME=A\n*INSTANCE, NAME=P-1, PART=P\n");
  const solids::Mesh mesh =
      solids::parse_mesh("part.inp", "*PART, NAME=P\n" + body +
                                         "*END INSTANCE\n*NSET, NSET=tip, INSTANCE=P-1\n300\n"
                                         "*END ASSEMBLY\n");
  EXPECT_THAT(mesh.node_sets.at("tip"), ElementsAre(8));
  EXPECT_EQ(
      message("*PART, NAME=P\n" + body + "1, 0, 0\n*END INSTANCE\n"),
      "part.inp:28:1: the instance is moved, which is not supported. Leave the translation out "
      "and place the mesh in the model.");
  EXPECT_EQ(message("*PART, NAME=P\n*END PART\n*PART, NAME=Q\n"),
            "part.inp:3:1: the file has more than one part. Write it without parts and assemblies, "
            "or one part by itself.");
}

TEST(ReadAbaqus, LocatesErrors) {
  EXPECT_EQ(message(two_bricks("*INCLUDE, INPUT=more.inp\n")),
            "part.inp:24:1: *INCLUDE is not supported, and the mesh depends on it. Write the nodes "
            "and elements out in one file.");
  EXPECT_EQ(message(two_bricks("*ELEMENT, TYPE=C3D13\n1, 100\n")),
            "part.inp:24:1: elements of type 'C3D13' are not supported. Types: C3D4, C3D10, C3D6, "
            "C3D15, C3D8, C3D20, C3D27 with any letters behind, T3D2, B31; CPS, CPE, S, M3D and "
            "SFM3D of 3, "
            "4, 6, 8 or 9 nodes as surfaces.");
  EXPECT_EQ(
      message(two_bricks("*ELEMENT, TYPE=C3D4\n30, 100, 101, 102, 999\n")),
      "part.inp:25:1: element 30 names node 999, which does not exist. The file has 12 nodes.");
  EXPECT_EQ(message(two_bricks("*ELEMENT, TYPE=C3D4\n10, 100, 101, 102, 200\n")),
            "part.inp:25:1: element 10 is given twice. Give each element a number of its own.");
  EXPECT_EQ(message(two_bricks("*ELEMENT, TYPE=C3D4\n30, 100, 101, 102, 100\n")),
            "part.inp:25:1: element 30 (tet4) has node 100 twice. Collapsed elements are not "
            "supported: use wedges or tetrahedra there.");
  EXPECT_EQ(message(two_bricks("*ELEMENT, TYPE=C3D4\n30, 100, 101, 102\n")),
            "part.inp:25:1: an element of type C3D4 has 4 nodes, but 3 are given. Export the mesh "
            "again from the program that made it.");
  EXPECT_EQ(
      message(two_bricks("*ELEMENT, TYPE=C3D8\n30, 100, 101, 102, 103, 200, 201, 202, 203\n")),
      "part.inp:25:1: element 30 has the nodes of element 10. Leave one of them out.");
  EXPECT_EQ(message(two_bricks("*NODE\n100, 5, 5, 5\n")),
            "part.inp:25:1: node 100 is given twice. Give each node a number of its own.");
  EXPECT_EQ(message(two_bricks("*NODE\n400, 5, five, 5\n")),
            "part.inp:25:1: a coordinate is expected here, but 'five' is no finite number. Export "
            "the mesh again from the program that made it.");
  EXPECT_EQ(message(two_bricks("*NSET, NSET=a\n100, 999\n")),
            "part.inp:25:1: set 'a' names node 999, which does not exist. The file has 12 nodes.");
  EXPECT_EQ(message(two_bricks("*ELSET, ELSET=a\nuper\n")),
            "part.inp:25:1: there is no set of elements 'uper' above. Did you mean 'upper'? Sets: "
            "Lower half, upper.");
  EXPECT_EQ(message(two_bricks("*SURFACE, NAME=a\n10, S7\n")),
            "part.inp:25:1: 'S7' is no face of element 10 (hex8). Faces of solids are S1, S2, ….");
  EXPECT_THAT(message(two_bricks("*NSET, NSET=a, GENERATE\n1, 1000000000000, 1\n")),
              HasSubstr("the numbers 1 to 1000000000000 by 1 cannot be generated"));
  EXPECT_EQ(message(two_bricks("*NSET\n100\n")),
            "part.inp:24:1: *NSET needs NSET=…. Name it in the keyword's line.");
  EXPECT_EQ(message("*HEADING\nnothing\n"),
            "part.inp: the file has no nodes. Check that it is the mesh you meant.");
}

// A set that contains itself would double with every line.
TEST(ReadAbaqus, MergesNestedSetsWithoutDuplicates) {
  std::string text = two_bricks("*NSET, NSET=a\n100, 101\n*NSET, NSET=a\n");
  for (int i = 0; i < 100; ++i) text += "a, a, a, a, a, a, a, a\n";
  EXPECT_THAT(solids::parse_mesh("part.inp", text).node_sets.at("a"), ElementsAre(0, 1));
}

}  // namespace
}  // namespace polhode::read_abaqus_tests
