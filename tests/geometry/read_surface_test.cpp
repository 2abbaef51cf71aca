// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/shapes.hpp>

namespace polhode::read_surface_tests {
namespace {

geometry::TriangleSurface box() {
  const double sizes[] = {2.0, 1.0, 0.5};
  return geometry::shape_surface(*geometry::find_shape_kind("box"), sizes);
}

const Vec3& corner(const geometry::TriangleSurface& surface, int index) {
  return surface.points[static_cast<std::size_t>(index)];
}

std::string text_stl(const geometry::TriangleSurface& surface) {
  std::string text = "solid box\n";
  for (const auto& triangle : surface.triangles) {
    text += "  facet normal 0 0 0\n    outer loop\n";
    for (const int i : triangle) {
      const Vec3& x = corner(surface, i);
      text += format("      vertex {} {:e} +{}\n", x[0], x[1], x[2] + 1.0);
    }
    text += "    endloop\n  endfacet\n";
  }
  return text + "endsolid box\n";
}

void append(std::string& bytes, std::uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>((word >> (8 * i)) & 0xffU);
}

std::string binary_stl(const geometry::TriangleSurface& surface) {
  std::string bytes = "solid that is binary all the same";
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(surface.triangles.size()));
  for (const auto& triangle : surface.triangles) {
    bytes.append(12, '\0');  // the normal, which readers should ignore
    for (const int i : triangle)
      for (const double coordinate : corner(surface, i))
        append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string refusal(const std::string& name, const std::string& bytes) {
  try {
    (void)geometry::parse_surface(name, bytes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void expect_box(const geometry::TriangleSurface& surface, const Vec3& centre) {
  EXPECT_EQ(surface.points.size(), 8U);
  EXPECT_EQ(surface.triangles.size(), 12U);
  EXPECT_NO_THROW(geometry::check_closed("box", surface));
  const geometry::MassProperties found = geometry::mass_properties(surface, 1.0);
  const geometry::MassProperties expected = geometry::mass_properties(box(), 1.0);
  EXPECT_NEAR(found.mass, 1.0, 1e-14);
  EXPECT_LT((found.com - centre).norm(), 1e-14);
  EXPECT_LT((found.inertia - expected.inertia).norm(), 1e-14);
}

TEST(ReadStl, ReadsTheTextForm) {
  expect_box(geometry::parse_surface("a.stl", text_stl(box())), {0, 0, 1});
}

TEST(ReadStl, ReadsTheBinaryFormThatBeginsWithSolid) {
  expect_box(geometry::parse_surface("a.STL", binary_stl(box())), {0, 0, 0});
}

TEST(ReadStl, ReadsLineEndingsOfEverySystem) {
  std::string text = text_stl(box());
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2)
    text.replace(i, 1, "\r\n");
  expect_box(geometry::parse_surface("a.stl", text), {0, 0, 1});
}

TEST(ReadStl, RefusesATextCutShort) {
  const std::string text = text_stl(box());
  const std::string message = refusal("a.stl", text.substr(0, text.find("endsolid")));
  EXPECT_EQ(message,
            "a.stl:85: the file is cut short: it ends after 12 triangles without 'endsolid'. "
            "Export the file again from the program that made it.");
}

TEST(ReadStl, RefusesABinaryFileCutShort) {
  const std::string bytes = binary_stl(box());
  EXPECT_EQ(refusal("a.stl", bytes.substr(0, bytes.size() - 60)),
            "a.stl: the file is cut short: it declares 12 triangles, but ends after 10 (624 of 684 "
            "bytes). Export the file again from the program that made it.");
}

TEST(ReadStl, NamesTheLineOfABadNumber) {
  EXPECT_EQ(refusal("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 O 0\n"),
            "a.stl:5: 'O' is not a finite number. Export the file again from the program that made "
            "it.");
  EXPECT_EQ(refusal("a.stl", "solid\nfacet\nvertex 0 nan 0\n"),
            "a.stl:3: 'nan' is not a finite number. Export the file again from the program that "
            "made it.");
  EXPECT_EQ(refusal("a.stl", "solid\nfacet\nvertex 0 1\n"),
            "a.stl:3: a point has three coordinates, but fewer are given. Export the file again "
            "from the program that made it.");
}

TEST(ReadStl, NamesTheTriangleOfABadNumber) {
  std::string bytes = binary_stl(box());
  std::string infinite;
  append(infinite, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()));
  bytes.replace(84 + 50 * 3 + 12 + 12 + 4, 4, infinite);  // triangle 4, corner 2, y
  EXPECT_EQ(refusal("a.stl", bytes),
            "a.stl: triangle 4: corner 2 has a coordinate that is not a finite number. Export the "
            "file again from the program that made it.");
}

TEST(ReadStl, RefusesKeywordsOutOfOrder) {
  const std::pair<const char*, const char*> cases[] = {
      {"solid\nvertex 0 0 0\n", "'vertex' is outside of a facet"},
      {"solid\nfacet\nfacet\n", "'facet' is out of place"},
      {"solid\nfacet\nendfacet\n", "a facet has three corners, but 0 are given"},
      {"solid\nsolid\n", "'solid' begins before the last solid has ended"},
      {"solid\nendsolid\nendsolid\n", "'endsolid' is out of place"},
      {"solid\nfacet\nendsolid\n", "'endsolid' is out of place"},
      {"solid\n<html>\n", "'<html>' is not a word of an STL file"},
      {"solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
       "a facet has more than three corners"}};
  for (const auto& [text, expected] : cases)
    EXPECT_NE(refusal("a.stl", text).find(expected), std::string::npos) << refusal("a.stl", text);
}

TEST(ReadStl, RefusesAFileWithoutTriangles) {
  EXPECT_EQ(refusal("a.stl", "solid\nendsolid\n"),
            "a.stl: the file has no triangles. Export the file again from the program that made "
            "it.");
  EXPECT_EQ(
      refusal("a.stl", ""),
      "a.stl: the file has 0 bytes and is no STL file: the text form begins with 'solid', the "
      "binary form has at least 84 bytes. Export the file again from the program that made "
      "it.");
}

TEST(ReadObj, ReadsFacesInEveryForm) {
  // A box of four-cornered faces: plain, with texture, with normals, counted from the end.
  const std::string text =
      "# box\nmtllib box.mtl\no box\n"
      "v -1 -0.5 -0.25\nv 1 -0.5 -0.25\nv 1 0.5 -0.25\nv -1 0.5 -0.25\n"
      "v -1 -0.5 0.25 1.0\nv 1 -0.5 0.25\nv 1 0.5 0.25\nv -1 0.5 0.25\nvn 0 0 1\nvt 0 0\n"
      "f 1 4 3 2\nf 5/1 6/1 7/1 8/1\nf 1//1 2//1 6//1 5//1\nf 2/1/1 3/1/1 7/1/1 6/1/1 # side\n"
      "f -6 -5 -1 -2\nf 1 5 \\\n  8 4\n";
  expect_box(geometry::parse_surface("box.obj", text), {0, 0, 0});
}

TEST(ReadObj, IsExactForAFaceThatIsNotConvex) {
  // An L-shaped prism of height 1 and area 3: the fan overlaps itself, its signed areas do not.
  const std::string text =
      "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
      "v 0 0 1\nv 2 0 1\nv 2 1 1\nv 1 1 1\nv 1 2 1\nv 0 2 1\n"
      "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\n"
      "f 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 12\n";
  const geometry::MassProperties found =
      geometry::mass_properties(geometry::parse_surface("l.obj", text), 1.0);
  EXPECT_NEAR(found.mass, 3.0, 1e-14);
  EXPECT_LT((found.com - Vec3(2.5 / 3.0, 2.5 / 3.0, 0.5)).norm(), 1e-14);
}

TEST(ReadObj, ReportsErrorsWithTheirLocation) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::string hint = ". Export the file again from the program that made it.";
  EXPECT_EQ(refusal("a.obj", points + "f 1 2 4\n"),
            "a.obj:4: point 4 is used, but 3 points are defined above" + hint);
  EXPECT_EQ(refusal("a.obj", points + "f 1 2 -4\n"),
            "a.obj:4: point -4 is used, but 3 points are defined above" + hint);
  EXPECT_EQ(refusal("a.obj", points + "f 1 2 0\n"),
            "a.obj:4: '0' is not the number of a point" + hint);
  EXPECT_EQ(refusal("a.obj", points + "f 1 2\n"),
            "a.obj:4: a face has at least three corners, but 2 are given" + hint);
  EXPECT_EQ(refusal("a.obj", points + "f 1 2 \\\n"),
            "a.obj:4: the file is cut short: it ends within a face" + hint);
  EXPECT_EQ(refusal("a.obj", "v 0 0\n"),
            "a.obj:1: a point has three coordinates, but fewer are given" + hint);
  EXPECT_EQ(refusal("a.obj", points), "a.obj: the file has no triangles" + hint);
  EXPECT_EQ(refusal("a.obj", binary_stl(box())),
            "a.obj: the file is not text, so it is no OBJ file" + hint);
}

TEST(ReadSurface, RefusesOtherFormats) {
  EXPECT_EQ(refusal("part.step", "ISO-10303-21;"),
            "part.step: a surface cannot be read from a file ending in '.step'. Use .stl (text or "
            "binary), .obj, .dae, or .msh of MuJoCo.");
}

std::string msh(const geometry::TriangleSurface& surface) {
  std::string bytes;
  const auto count = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  for (const std::uint32_t n :
       {count(surface.points.size()), 1U, 2U, count(surface.triangles.size())})
    append(bytes, n);
  for (const Vec3& x : surface.points)
    for (const double coordinate : x)
      append(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(coordinate)));
  bytes.append(12 + 16, '\x7f');  // a normal and two points of a texture, which are not read
  for (const auto& triangle : surface.triangles)
    for (const int i : triangle) append(bytes, static_cast<std::uint32_t>(i));
  return bytes;
}

TEST(ReadSurface, ReadsBinaryMeshesOfMujoco) {
  const std::string bytes = msh(box());
  expect_box(geometry::parse_surface("a.msh", bytes), {0, 0, 0});
  const std::string hint = " Export the file again from the program that made it.";
  EXPECT_EQ(refusal("a.msh", bytes.substr(0, 9)),
            "a.msh: the file has 9 bytes and is no MSH file." + hint);
  EXPECT_EQ(refusal("a.msh", bytes.substr(0, bytes.size() - 1)),
            format("a.msh: the file has {} bytes, but declares 8 points and 12 triangles, which "
                   "are {} bytes.",
                   bytes.size() - 1, bytes.size()) +
                hint);
  std::string other = bytes;
  other[bytes.size() - 4] = 9;
  EXPECT_EQ(refusal("a.msh", other),
            "a.msh: triangle 12: point 9 is used, but there are 8 points." + hint);
  other = bytes;
  for (std::size_t k = 16; k < 20; ++k) other[k] = '\xff';
  EXPECT_EQ(refusal("a.msh", other),
            "a.msh: point 1: has a coordinate that is not a finite number." + hint);
  EXPECT_NE(refusal("a.msh", "$MeshFormat\n4.1 0 8\n").find("is a mesh of Gmsh"),
            std::string::npos);
}

TEST(ReadSurface, ReadsAFileAndNamesOneThatIsMissing) {
  const std::string path = testing::TempDir() + "polhode_read_surface_test.stl";
  std::ofstream(path, std::ios::binary) << binary_stl(box());
  expect_box(geometry::read_surface(path), {0, 0, 0});
  std::filesystem::remove(path);
  try {
    (void)geometry::read_surface(path);
    FAIL() << "a missing file was read";
  } catch (const InputError& e) {
    EXPECT_EQ(e.where(), path);
    EXPECT_EQ(e.what_is_wrong(), "the file cannot be opened (No such file or directory)");
  }
}

TEST(ReadSurface, RefusesADirectory) {
  const std::string path = testing::TempDir() + "polhode_directory.stl";
  std::filesystem::create_directory(path);
  EXPECT_THROW((void)geometry::read_surface(path), InputError);
  std::filesystem::remove(path);
}

TEST(ReadSurface, FailsOnlyWithAMessage) {
  // Every truncation of three files: it is read or refused.
  for (const auto& [name, bytes] : {std::pair{"a.stl", text_stl(box())},
                                    {"a.stl", binary_stl(box())},
                                    {"a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}})
    for (std::size_t n = 0; n < bytes.size(); ++n)
      EXPECT_NO_THROW((void)refusal(name, bytes.substr(0, n))) << name << " " << n;
}

}  // namespace
}  // namespace polhode::read_surface_tests
