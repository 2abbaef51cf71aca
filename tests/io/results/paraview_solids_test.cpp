// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/paraview.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/io/text/file_error.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <support/scratch.hpp>

namespace polhode::paraview_solids_tests {
namespace {

using testing::HasSubstr;

/// Numbers of a named array, in the part of the file that a tag opens, by the array's offset.
template <class T>
std::vector<T> array(const std::string& file, const std::string& tag, const std::string& name) {
  std::smatch match;
  const std::string head = file.substr(file.find(tag), file.find("<AppendedData") - file.find(tag));
  if (!std::regex_search(head, match, std::regex("Name=\"" + name + "\"[^>]*offset=\"(\\d+)\"")))
    return {};
  const std::size_t begin =
      file.find('_', file.find("<AppendedData")) + 1 + std::stoul(match[1].str());
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, file.data() + begin, sizeof bytes);
  std::vector<T> values(bytes / sizeof(T));
  std::memcpy(values.data(), file.data() + begin + sizeof bytes, bytes);
  return values;
}

/// A report whose numbers are functions of the node or element.
SolidReport report_of(const solids::Mesh& mesh) {
  SolidReport report;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3 u(0.25, 0.0, static_cast<double>(i));
    report.position.push_back(mesh.nodes[i] + u);
    report.displacement.push_back(u);
    report.velocity.emplace_back(-static_cast<double>(i), 1.0, 2.0);
  }
  for (int e = 0; e < mesh.element_count(); ++e) {
    ElementSample sample;
    sample.cauchy << 1, 4, 6, 4, 2, 5, 6, 5, 3;
    sample.principal_stretches = {2.0, 1.0, 0.5};
    sample.strain_energy_density = e;
    sample.volume = 1.0;
    report.elements.push_back(sample);
  }
  report.nodal = solids::NodalRecovery(mesh, {1.0, 1.0}).fields(report.elements);
  return report;
}

TEST(SolidsWriter, WritesEverySolidAtItsPosition) {
  const test::Scratch scratch;
  const solids::Mesh hex =
      solids::make_mesh("hex", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 2}}}, "hex8");
  const solids::Mesh wedge =
      solids::make_mesh("w", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, "wedge6");
  io::SolidsWriter writer(scratch / "view", "solids", {"a", "b"}, {&hex, &wedge});
  writer.append(0.5, {report_of(hex), report_of(wedge)});
  writer.close();
  EXPECT_THAT(io::read_file(scratch / "view/solids.pvd"),
              HasSubstr("timestep=\"0.5\" part=\"0\" file=\"solids/000000.vtu\""));
  const std::string vtu = io::read_file(scratch / "view/solids/000000.vtu");
  EXPECT_THAT(vtu, HasSubstr("NumberOfPoints=\"20\" NumberOfCells=\"4\""));
  EXPECT_THAT(vtu,
              HasSubstr("Name=\"solid b\" NumberOfTuples=\"1\" format=\"ascii\">1</DataArray>"));
  const auto points = array<float>(vtu, "<Points>", "points");
  ASSERT_EQ(points.size(), 60u);
  EXPECT_FLOAT_EQ(points[3 * 13 + 2], static_cast<float>(wedge.nodes[1].z() + 1.0));
  EXPECT_EQ(array<std::uint8_t>(vtu, "<Cells>", "types"),
            (std::vector<std::uint8_t>{12, 12, 13, 13}));
  EXPECT_EQ(array<std::int64_t>(vtu, "<Cells>", "offsets"),
            (std::vector<std::int64_t>{8, 16, 22, 28}));
  EXPECT_EQ(array<std::int32_t>(vtu, "<CellData", "solid"),
            (std::vector<std::int32_t>{0, 0, 1, 1}));
  EXPECT_EQ(array<float>(vtu, "<CellData", "cauchy").size(), 24u);
  EXPECT_THAT(array<float>(vtu, "<CellData", "strain_energy_density"),
              testing::ElementsAre(0, 1, 0, 1));
  EXPECT_THAT(array<float>(vtu, "<CellData", "principal_stretches"),
              testing::Contains(0.5F).Times(4));
  const auto tensor = array<float>(vtu, "<PointData", "cauchy");
  EXPECT_EQ(std::vector<float>(tensor.begin(), tensor.begin() + 6),
            (std::vector<float>{1, 2, 3, 4, 5, 6}));  // xx, yy, zz, xy, yz, xz.
}

/// Fields of contact of one of two solids; the other one has none.
TEST(SolidsWriter, WritesFieldsOfContact) {
  const test::Scratch scratch;
  const solids::Mesh hex =
      solids::make_mesh("hex", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, "hex8");
  io::SolidsWriter writer(scratch / "view", "solids", {"a", "b"}, {&hex, &hex});
  SolidContactFields fields{std::vector<double>(8, 0.0), std::vector<double>(8, 0.5)};
  fields.pressure[3] = 2.0;
  writer.append(0.5, {report_of(hex), report_of(hex)}, {{}, fields});
  writer.append(0.6, {report_of(hex), report_of(hex)});
  writer.close();
  const std::string vtu = io::read_file(scratch / "view/solids/000000.vtu");
  const auto pressure = array<float>(vtu, "<PointData", "contact_pressure");
  const auto gap = array<float>(vtu, "<PointData", "contact_gap");
  ASSERT_EQ(pressure.size(), 16u);
  ASSERT_EQ(gap.size(), 16u);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(std::isnan(pressure[i]), i < 8);
    EXPECT_EQ(std::isnan(gap[i]), i < 8);
  }
  EXPECT_EQ(pressure[11], 2.0F);
  EXPECT_EQ(gap[15], 0.5F);
  EXPECT_THAT(io::read_file(scratch / "view/solids/000001.vtu"),
              testing::Not(HasSubstr("contact_pressure")));
}

/// Node order of VTK's cells of positive volume: the normal of the triangle 0 1 2 of a wedge points
/// outwards.
TEST(SolidsWriter, OrdersNodesOfWedgesAsVtkDoes) {
  constexpr std::array<std::array<std::size_t, 2>, 9> kEdges{
      {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
  for (const std::size_t size : {std::size_t{6}, std::size_t{15}}) {
    const test::Scratch scratch;
    const solids::Mesh wedge = solids::make_mesh(
        "w", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, "wedge" + std::to_string(size));
    SolidReport report = report_of(wedge);
    report.position = wedge.nodes;
    io::SolidsWriter writer(scratch / "view", "solids", {"w"}, {&wedge});
    writer.append(0.0, {report});
    writer.close();
    const std::string vtu = io::read_file(scratch / "view/solids/000000.vtu");
    const auto cells = array<std::int64_t>(vtu, "<Cells>", "connectivity");
    ASSERT_EQ(cells.size(), 2 * size);
    EXPECT_EQ(array<std::uint8_t>(vtu, "<Cells>", "types")[0], size == 6 ? 13 : 26);
    for (std::size_t at = 0; at < cells.size(); at += size) {
      const auto X = [&](std::size_t k) {
        return wedge.nodes[static_cast<std::size_t>(cells[at + k])];
      };
      const Vec3 normal = (X(1) - X(0)).cross(X(2) - X(0));
      EXPECT_LT(normal.dot(X(3) - X(0)), 0.0);
      for (std::size_t k = 6; k < size; ++k)
        EXPECT_EQ(X(k), Vec3(0.5 * (X(kEdges[k - 6][0]) + X(kEdges[k - 6][1])))) << k;
    }
  }
}

}  // namespace
}  // namespace polhode::paraview_solids_tests
