// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::read_collada_tests {
namespace {

using testing::HasSubstr;

/// Rounding of a few operations on numbers of size 10.
constexpr double kRounding = 1e-14;

/// A wedge: a right triangle of legs 3 and 2 with length 4, quadrangles and triangles as faces.
const std::string kPoints = "0 0 0  3 0 0  0 2 0  0 0 4  3 0 4  0 2 4";
const std::string kWedge =
    "v 0 0 0\nv 3 0 0\nv 0 2 0\nv 0 0 4\nv 3 0 4\nv 0 2 4\n"
    "f 1 3 2\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n";

/// The wedge with normals beside its points, so that each corner has two numbers.
const std::string kPolylist =
    "<polylist count='5'><input semantic='VERTEX' source='#v' offset='0'/>"
    "<input semantic='NORMAL' source='#n' offset='1'/><vcount>3 3 4 4 4</vcount>"
    "<p>0 0 2 0 1 0  3 0 4 0 5 0  0 0 1 0 4 0 3 0  1 0 2 0 5 0 4 0  2 0 0 0 3 0 5 0</p></polylist>";

std::string geometry_tag(const std::string& parts, const std::string& points = kPoints,
                         int count = 6, const std::string& accessor = "stride='3'") {
  return "<library_geometries><geometry id='g'><mesh><source id='x'><float_array id='a' "
         "count='18'>" +
         points + "</float_array><technique_common><accessor source='#a' " + accessor + " count='" +
         format("{}", count) +
         "'/></technique_common></source>\n<vertices id='v'><input semantic='POSITION' "
         "source='#x'/></vertices>\n" +
         parts + "</mesh></geometry></library_geometries>\n";
}
std::string collada(const std::string& inside, const std::string& unit = "1") {
  return "<?xml version='1.0'?>\n<COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
         "version='1.4.1'><asset><unit meter='" +
         unit + "'/><up_axis>Y_UP</up_axis></asset>\n" + inside + "</COLLADA>\n";
}
std::string scene(const std::string& nodes, const std::string& library = "") {
  return library + "<library_visual_scenes><visual_scene id='s'>" + nodes +
         "</visual_scene></library_visual_scenes>\n<scene><instance_visual_scene "
         "url='#s'/></scene>\n";
}
geometry::TriangleSurface read(const std::string& text) {
  return geometry::parse_surface("part.dae", text);
}
std::string refusal(const std::string& text) {
  try {
    static_cast<void>(read(text));
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}
void expect_same(const geometry::TriangleSurface& a, const geometry::TriangleSurface& b) {
  EXPECT_TRUE(geometry::edge_report(a).closed());
  const auto one = geometry::mass_properties(a, 1.0), other = geometry::mass_properties(b, 1.0);
  EXPECT_NEAR(one.mass, other.mass, kRounding * std::abs(other.mass));
  EXPECT_LT((one.com - other.com).norm(), 10.0 * kRounding * (1.0 + other.com.norm()));
  EXPECT_LT((one.inertia - other.inertia).norm(), 10.0 * kRounding * other.inertia.norm());
}
const std::string kInstance = "<instance_geometry url='#g'/>";

TEST(ReadCollada, HasTheGeometryOfTheSameObj) {
  const auto wedge = geometry::parse_surface("part.obj", kWedge);
  const auto same =
      read(collada(geometry_tag(kPolylist) + scene("<node>" + kInstance + "</node>")));
  EXPECT_EQ(same.points, wedge.points);
  EXPECT_EQ(same.triangles, wedge.triangles);
  // Without a scene, all geometries.
  EXPECT_EQ(read(collada(geometry_tag(kPolylist))).triangles, wedge.triangles);
  const std::string input = "<input semantic='VERTEX' source='#v' offset='0'/>";
  for (const std::string& parts :
       {"<triangles>" + input +
            "<p>0 2 1 3 4 5 0 1 4 0 4 3 1 2 5 1 5 4 2 0 3 2 3 5</p></triangles>",
        "<polygons>" + input +
            "<p>0 2 1</p><p>3 4 5</p><p>0 1 4 3</p><p>1 2 5 4</p><p>2 0 3 5</p></polygons>",
        "<trifans>" + input + "<p>0 1 4 3</p><p>1 2 5 4</p><p>2 0 3 5</p></trifans><triangles>" +
            input + "<p>0 2 1 3 4 5</p></triangles>",
        // A strip of triangles around the side turns over at each of them.
        "<tristrips>" + input + "<p>3 0 4 1 5 2 3 0</p></tristrips><triangles>" + input +
            "<p>0 2 1 3 4 5</p></triangles>"})
    expect_same(read(collada(geometry_tag(parts))), wedge);
}

TEST(ReadCollada, PlacesItsPartsByTheNodesOfTheSceneAndTheUnit) {
  const auto wedge = geometry::parse_surface("part.obj", kWedge);
  // Outer translation, rotation and scale, inner matrix; the point x goes through them from inside.
  const std::string node =
      "<node><translate>1 2 3</translate><rotate>0 0 1 90</rotate><scale>2 2 2</scale>"
      "<node><matrix>1 0 0 5  0 0 -1 0  0 1 0 0  0 0 0 1</matrix>" +
      kInstance + "</node></node>";
  geometry::TriangleSurface placed = wedge;
  for (Vec3& x : placed.points) {
    const Vec3 inner(x.x() + 5.0, -x.z(), x.y());
    const Vec3 doubled = 2.0 * inner;
    x = 0.01 * (Vec3(-doubled.y(), doubled.x(), doubled.z()) + Vec3(1, 2, 3));
  }
  expect_same(read(collada(geometry_tag(kPolylist) + scene(node), "0.01")), placed);
  // A node of a library, used by a scene.
  const std::string library = "<library_nodes><node id='n'>" + node + "</node></library_nodes>";
  expect_same(read(collada(geometry_tag(kPolylist) +
                               scene("<node><instance_node url='#n'/></node>", library),
                           "0.01")),
              placed);
  // Mirrored parts still face outward.
  const auto mirrored = read(collada(geometry_tag(kPolylist) +
                                     scene("<node><scale>1 1 -1</scale>" + kInstance + "</node>")));
  EXPECT_NEAR(geometry::signed_volume(mirrored), 12.0, 12.0 * kRounding);
  EXPECT_NEAR(geometry::mass_properties(mirrored, 1.0).com.z(), -2.0, kRounding * 10.0);
}

TEST(ReadCollada, ReadsPointsByTheirAccessor) {
  std::string strided;
  for (const char* x : {"0 0 0", "3 0 0", "0 2 0", "0 0 4", "3 0 4", "0 2 4"})
    strided += std::string("7 ") + x + " ";
  const auto surface = read(collada(geometry_tag(kPolylist, strided, 6, "stride='4' offset='1'")));
  EXPECT_EQ(surface.points, geometry::parse_surface("part.obj", kWedge).points);
}

TEST(ReadCollada, RefusesWhatItCannotReadWithTheLine) {
  const auto with = [](const std::string& part, int count = 6) {
    return refusal(collada(geometry_tag(part, kPoints, count)));
  };
  const std::string input = "<input semantic='VERTEX' source='#v' offset='0'/>";
  EXPECT_THAT(refusal("<COLLADA"), HasSubstr("the text is not XML"));
  EXPECT_THAT(refusal("<mesh/>"), HasSubstr("the file's tag is <mesh>, not <COLLADA>"));
  EXPECT_THAT(refusal(collada("")), HasSubstr("no triangles"));
  EXPECT_THAT(with("<triangles>" + input + "<p>0 1 9</p></triangles>"),
              HasSubstr("part.dae:5: point 9 is used, but there are 6 points"));
  EXPECT_THAT(with("<triangles>" + input + "<p>0 1 x</p></triangles>"),
              HasSubstr("not a finite number"));
  EXPECT_THAT(with("<triangles>" + input + "<p>0 1</p></triangles>"),
              HasSubstr("no whole triangles"));
  EXPECT_THAT(with("<polylist>" + input + "<vcount>4</vcount><p>0 1 2</p></polylist>"),
              HasSubstr("<vcount> is of other polygons"));
  EXPECT_THAT(with(kPolylist, 7), HasSubstr("7 points are declared, but there are 18 numbers"));
  EXPECT_THAT(with("<triangles><p>0 1 2</p></triangles>"), HasSubstr("no input of VERTEX"));
  EXPECT_THAT(refusal(collada(geometry_tag(kPolylist) +
                              scene("<node><instance_geometry url='#h'/></node>"))),
              HasSubstr("names '#h', which is not in the file"));
  EXPECT_THAT(refusal(collada(geometry_tag(kPolylist) +
                              scene("<node><instance_controller url='#g'/></node>"))),
              HasSubstr("bones"));
  EXPECT_THAT(refusal(collada(geometry_tag(kPolylist), "0")), HasSubstr("no length"));
}

TEST(ReadCollada, BoundsInstancesThatStandInEachOther) {
  EXPECT_THAT(refusal(collada(scene("<node id='n'><instance_node url='#n'/></node>"))),
              HasSubstr("contain each other"));
  // Sixty doublings.
  std::string nodes = "<library_nodes>";
  for (int k = 0; k < 60; ++k)
    nodes += format("<node id='n{}'><instance_node url='#n{}'/><instance_node url='#n{}'/></node>",
                    k, k + 1, k + 1);
  nodes += "<node id='n60'>" + kInstance + "</node></library_nodes>";
  EXPECT_THAT(refusal(collada(scene("<node><instance_node url='#n0'/></node>", nodes))),
              testing::AnyOf(HasSubstr("contain each other"), HasSubstr("not in the file")));
}

}  // namespace
}  // namespace polhode::read_collada_tests
