// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::read_errors_tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string message(const std::string& name, const std::string& text) {
  try {
    (void)solids::parse_mesh(name, text);
    return "no error";
  } catch (const InputError& e) {
    return e.what();
  }
}

std::string gmsh2(const std::string& nodes, const std::string& elements) {
  return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + nodes + "$EndNodes\n$Elements\n" +
         elements + "$EndElements\n";
}
const std::string kNodes = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";

TEST(GmshErrors, AreLocated) {
  EXPECT_EQ(message("a.msh", gmsh2(kNodes, "1\n1 4 2 0 1 1 2 3 4\n")), "no error");
  EXPECT_EQ(
      message("a.msh", gmsh2(kNodes, "1\n1 7 2 0 1 1 2 3 4 5\n")),
      "a.msh:13:3: elements of type 7 (5-node pyramid) are not supported. Mesh with hexahedra "
      "of 8, 20 or 27 nodes, tetrahedra of 4 or 10, or prisms of 6 or 15.");
  EXPECT_THAT(message("a.msh", gmsh2(kNodes, "1\n1 99 2 0 1 1 2 3 4 5\n")),
              StartsWith("a.msh:13:3: there is no element type 99."));
  EXPECT_EQ(message("a.msh", gmsh2(kNodes, "1\n1 4 2 0 1 1 2 3 7\n")),
            "a.msh:13:1: element 1 names node 7, which does not exist. The file has 4 nodes.");
  EXPECT_EQ(message("a.msh", gmsh2("4\n1 0 0 0\n2 1 0 0\n2 0 1 0\n4 0 0 1\n", "0\n")),
            "a.msh:8:1: node 2 is given twice. Give each node a number of its own.");
  EXPECT_THAT(
      message("a.msh", gmsh2(kNodes, "2\n1 4 2 0 1 1 2 3 4\n")),
      StartsWith("a.msh:14:1: the number of an element is expected here, but '$EndElements' "
                 "is no whole number."));
  EXPECT_THAT(message("a.msh", gmsh2("3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", "0\n")),
              StartsWith("a.msh:9:1: $EndNodes is expected here, but '4' is found."));
  EXPECT_THAT(message("a.msh", gmsh2("1000000000000\n1 0 0 0\n", "0\n")),
              StartsWith("a.msh:5:1: 1000000000000 nodes are announced, but the"));
  EXPECT_THAT(message("a.msh", gmsh2("-1\n", "0\n")), HasSubstr("-1 nodes cannot be"));
  EXPECT_THAT(
      message("a.msh", gmsh2("1\n1 0 nan 0\n", "0\n")),
      StartsWith("a.msh:6:5: a coordinate is expected here, but 'nan' is no finite number."));
  EXPECT_THAT(message("a.msh", gmsh2("1\n1 0 1e200 0\n", "0\n")),
              HasSubstr("node 1 has the coordinates"));
  EXPECT_EQ(
      message("a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n"),
      "a.msh:2:1: version 4 of the format is not supported. Save the mesh in format 4.1 or 2.2 "
      "(Mesh.MshFileVersion).");
  EXPECT_EQ(message("a.msh", "solid\n"),
            "a.msh:1:1: a Gmsh file begins with '$MeshFormat'. Save the mesh in format 4.1 or 2.2 "
            "(Mesh.MshFileVersion).");
  EXPECT_EQ(message("a.msh", ""),
            "a.msh:1:1: a Gmsh file begins with '$MeshFormat'. Save the mesh in format 4.1 or 2.2 "
            "(Mesh.MshFileVersion).");
  EXPECT_EQ(message("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n"),
            "a.msh:5:1: 4 nodes are announced, but the 9 bytes that follow cannot hold them. The "
            "file is cut short or damaged. Export the mesh again.");
}

TEST(GmshErrors, NameWhatAHeaderOrASectionShouldHave) {
  EXPECT_EQ(message("a.msh", "$MeshFormat\n2.2 2 8\n$EndMeshFormat\n"),
            "a.msh:2:5: the kind of file is 2, but 0 (text) or 1 (binary) is expected. Export the "
            "mesh again from the program that made it.");
  const std::string header = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  EXPECT_THAT(message("a.msh", header + "$PhysicalNames\n1\n5 1 \"pad\"\n$EndPhysicalNames\n"),
              StartsWith("a.msh:6:1: a group cannot have the dimension 5."));
  EXPECT_THAT(message("a.msh", header + "$Elements\n0 0 0 0\n$EndElements\n$Entities\n0 0 0 0\n"
                                        "$EndEntities\n"),
              HasSubstr("the entities come after the elements."));
  EXPECT_THAT(message("a.msh", header + "$Nodes\n1 1 1 1\n5 1 0 1\n1\n0 0 0\n$EndNodes\n"),
              StartsWith("a.msh:6:1: an entity cannot have the dimension 5."));
}

std::string word(std::int32_t value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

TEST(GmshErrors, NamePlacesInBinaryFiles) {
  const std::string header = "$MeshFormat\n2.2 1 8\n";
  EXPECT_THAT(message("a.msh", header + word(7) + "\n$EndMeshFormat\n"),
              HasSubstr("the byte order is unknown: 1 reads as 7."));
  std::string nodes = "$Nodes\n4\n";
  for (std::int32_t i = 1; i <= 4; ++i) nodes += word(i) + std::string(3 * sizeof(double), '\0');
  std::string elements = "$Elements\n1\n" + word(4) + word(2) + word(0);
  for (std::int32_t element = 1; element <= 2; ++element) {
    elements += word(element);
    for (std::int32_t i = 1; i <= 4; ++i) elements += word(i);
  }
  EXPECT_THAT(message("a.msh", header + word(1) + "\n$EndMeshFormat\n" + nodes + "\n$EndNodes\n" +
                                   elements + "\n$EndElements\n"),
              HasSubstr("2 elements follow, but 1 of 1 are still to come."));
}

std::string vtu(const std::string& points, const std::string& cells) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"4\" "
         "NumberOfCells=\"1\">\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
         "format=\"ascii\">" +
         points + "</DataArray></Points>\n<Cells>\n" + cells +
         "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}
std::string cells(const std::string& connectivity, const std::string& offset,
                  const std::string& type) {
  return "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">" + connectivity +
         "</DataArray>\n<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">" + offset +
         "</DataArray>\n<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">" + type +
         "</DataArray>\n";
}
const std::string kPoints = "0 0 0 1 0 0 0 1 0 0 0 1";

TEST(VtuErrors, AreLocated) {
  EXPECT_EQ(message("a.vtu", vtu(kPoints, cells("0 1 2 3", "4", "10"))), "no error");
  EXPECT_EQ(
      message("a.vtu", vtu(kPoints, cells("0 1 2 3", "4", "14"))),
      "a.vtu:9:1: cell 0 has the VTK type 14, which is not supported. Mesh with hexahedra (12, "
      "25, 29), tetrahedra (10, 24) or wedges (13, 26).");
  EXPECT_THAT(message("a.vtu", vtu(kPoints, cells("0 1 2 4", "4", "10"))),
              StartsWith("a.vtu:7:1: cell 0 names point 4; the first is 0, the last 3."));
  EXPECT_THAT(message("a.vtu", vtu(kPoints, cells("0 1 2", "3", "10"))),
              StartsWith("a.vtu:8:1: cell 0 (tet4) has 3 nodes instead of 4."));
  EXPECT_THAT(message("a.vtu", vtu("0.5 0 0 1 0 0 0 1 0 0 0", cells("0 1 2 3", "4", "10"))),
              StartsWith("a.vtu:5:9: array '': 12 numbers are expected, but 11 are given."));
  EXPECT_THAT(message("a.vtu", vtu(kPoints + " 7", cells("0 1 2 3", "4", "10"))),
              HasSubstr("array '' has more than the 12 numbers expected"));
  EXPECT_THAT(message("a.vtu", "<VTKFile type=\"PolyData\">"),
              HasSubstr("the file holds a 'PolyData', not an UnstructuredGrid"));
  EXPECT_THAT(
      message("a.vtu", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\">"),
      HasSubstr("data compressed by 'vtkLZ4DataCompressor' are not supported"));
  EXPECT_THAT(message("a.vtu", "# vtk DataFile Version 3.0\n"), HasSubstr("begins with <VTKFile>"));
  EXPECT_THAT(message("a.vtu", vtu(kPoints, "")), HasSubstr("the cells have no array 'offsets'"));
}

/// A file with one tetrahedron in which one text is replaced by another.
std::string changed_vtu(const std::string& from, const std::string& to) {
  std::string text = vtu(kPoints, cells("0 1 2 3", "4", "10"));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return message("a.vtu", text.replace(at, from.size(), to));
}

TEST(VtuErrors, NameTheArrayAndItsFault) {
  EXPECT_THAT(changed_vtu("NumberOfComponents=\"3\"", "NumberOfComponents=\"2\""),
              HasSubstr("points have '2' components instead of 3."));
  EXPECT_THAT(changed_vtu("\"Int32\" Name=\"offsets\"", "\"Float32\" Name=\"offsets\""),
              HasSubstr("array 'offsets' has to be of integers."));
  EXPECT_THAT(changed_vtu("format=\"ascii\">0 1 2 3", "format=\"binary\">???"),
              HasSubstr("the data are cut short in their header, or are no base64"));
  EXPECT_THAT(changed_vtu("\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3",
                          "\"UInt64\" Name=\"connectivity\" format=\"binary\">"
                          "IAAAAP//////////////////////////////////////////"),
              HasSubstr("18446744073709551615 is too large a number"));
  EXPECT_THAT(changed_vtu("Name=\"types\"", "Name=types"),
              HasSubstr("an attribute has no value in quotes."));
  std::string appended = vtu(kPoints, cells("0 1 2 3", "4", "10"));
  appended.replace(appended.find("format=\"ascii\">0 1 2 3"), 14,
                   "format=\"appended\" offset=\"9000\"");
  appended.replace(appended.find("</VTKFile>"), 0,
                   "<AppendedData encoding=\"raw\">_1234</AppendedData>\n");
  EXPECT_THAT(message("a.vtu", appended),
              HasSubstr("the offset '9000' lies outside of the appended data"));
}

}  // namespace
}  // namespace polhode::read_errors_tests
