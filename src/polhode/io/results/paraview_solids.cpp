// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <numeric>

#include <polhode/core/format.hpp>
#include <polhode/io/results/paraview.hpp>

namespace polhode::io {

namespace {

/// Adds the components of a symmetric tensor in VTK's order.
void add_tensor(std::vector<float>& list, const Mat3& T) {
  for (const auto& [i, j] : {std::pair(0, 0), {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}})
    list.push_back(static_cast<float>(T(i, j)));
}

void add_vectors(std::vector<float>& list, const std::vector<Vec3>& vectors) {
  for (const Vec3& x : vectors)
    for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(x[c]));
}

/// Stress and energy at points or in cells.
struct FrameValues {
  std::vector<float> cauchy, von_mises, energy;

  void add(const Mat3& stress, double mises, double density) {
    add_tensor(cauchy, stress);
    von_mises.push_back(static_cast<float>(mises));
    energy.push_back(static_cast<float>(density));
  }
  void write(VtkFile& file) const {
    file.array("cauchy", 6, cauchy);
    file.array("von_mises", 1, von_mises);
    file.array("strain_energy_density", 1, energy);
  }
};

/// Cells of all solids with their points, in the order of VTK.
struct Cells {
  std::vector<std::int64_t> corners, ends;
  std::vector<std::uint8_t> types;
  std::vector<std::int32_t> owners;

  void add(const solids::Mesh& mesh, std::int64_t first, int owner) {
    for (const solids::ElementBlock& block : mesh.blocks) {
      const solids::CellShape& shape = block.shape();
      const std::vector<std::size_t> order = vtk_order(shape);
      for (std::size_t at = 0; at < block.nodes.size(); at += order.size()) {
        for (const std::size_t k : order) corners.push_back(first + block.nodes[at + k]);
        ends.push_back(static_cast<std::int64_t>(corners.size()));
        types.push_back(static_cast<std::uint8_t>(shape.vtk));
        owners.push_back(owner);
      }
    }
  }
};

}  // namespace

std::vector<std::size_t> vtk_order(const solids::CellShape& shape) {
  // VTK sees the triangle 0 1 2 of a wedge from outside, we see it from inside.
  if (shape.name == "wedge6") return {0, 2, 1, 3, 5, 4};
  if (shape.name == "wedge15") return {0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};
  std::vector<std::size_t> order(static_cast<std::size_t>(shape.size()));
  std::iota(order.begin(), order.end(), 0);
  return order;
}

void SolidsWriter::append(double t, const std::vector<SolidReport>& reports,
                          const std::vector<SolidContactFields>& contacts) {
  std::vector<float> points, displacements, velocities, stretches, errors, pressures, gaps;
  FrameValues at_nodes, in_cells;
  Cells cells;
  for (std::size_t s = 0; s < reports.size(); ++s) {
    const SolidReport& report = reports[s];
    cells.add(*meshes_[s], static_cast<std::int64_t>(points.size() / 3), static_cast<int>(s));
    add_vectors(points, report.position);
    add_vectors(displacements, report.displacement);
    add_vectors(velocities, report.velocity);
    const solids::NodalFields& nodal = report.nodal;
    for (std::size_t i = 0; i < nodal.cauchy.size(); ++i)
      at_nodes.add(nodal.cauchy[i], nodal.von_mises[i], nodal.strain_energy_density[i]);
    for (const ElementSample& e : report.elements) {
      in_cells.add(e.cauchy, solids::von_mises(e.cauchy), e.strain_energy_density);
      add_vectors(stretches, {e.principal_stretches});
    }
    for (const double error : nodal.stress_error) errors.push_back(static_cast<float>(error));
    if (contacts.empty()) continue;
    const auto add = [&](std::vector<float>& list, const std::vector<double>& field) {
      list.insert(list.end(), field.begin(), field.end());
      list.resize(points.size() / 3, std::numeric_limits<float>::quiet_NaN());
    };
    add(pressures, contacts[s].pressure);
    add(gaps, contacts[s].gap);
  }
  VtkFile file("UnstructuredGrid");
  file.indices("solid", solids_);
  file.text(format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n<Points>\n",
                   points.size() / 3, cells.ends.size()));
  file.array("points", 3, points);
  file.text("</Points>\n<Cells>\n");
  file.array("connectivity", 1, cells.corners);
  file.array("offsets", 1, cells.ends);
  file.array("types", 1, cells.types);
  file.text("</Cells>\n<PointData Vectors=\"displacement\" Scalars=\"von_mises\">\n");
  file.array("displacement", 3, displacements);
  file.array("velocity", 3, velocities);
  at_nodes.write(file);
  if (!contacts.empty()) {
    file.array("contact_pressure", 1, pressures);
    file.array("contact_gap", 1, gaps);
  }
  file.text("</PointData>\n<CellData Scalars=\"von_mises\">\n");
  in_cells.write(file);
  file.array("principal_stretches", 3, stretches);
  file.array("stress_error", 1, errors);
  file.array("solid", 1, cells.owners);
  file.text("</CellData>\n</Piece>\n");
  series_.append(t, file.bytes());
}

}  // namespace polhode::io
