// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/results/paraview.hpp>

namespace polhode::io {

namespace {

/// Radii of beams with sections of unknown size, and of cables, as parts of the size of the
/// mechanism.
constexpr double kBeamRadius = 5e-3, kCableRadius = 2e-3;

void add(std::vector<float>& list, const Vec3& x) {
  for (int c = 0; c < 3; ++c) list.push_back(static_cast<float>(x[c]));
}

/// Drawn lines at one time.
struct Lines {
  std::vector<float> points, velocity, y_axis, radius, force, moment, strain, curvature;
  std::vector<std::int64_t> corners, ends;
  std::vector<std::int32_t> owners;

  void add_point(const Vec3& x, const Vec3& v, const Vec3& y, double r) {
    add(points, x);
    add(velocity, v);
    add(y_axis, y);
    radius.push_back(static_cast<float>(r));
  }
  /// Adds a line between the points k and k + 1.
  void add_line(std::size_t k, const Vec6& forces, const Vec6& strains, std::size_t owner) {
    corners.push_back(static_cast<std::int64_t>(k));
    corners.push_back(static_cast<std::int64_t>(k + 1));
    ends.push_back(static_cast<std::int64_t>(corners.size()));
    add(force, forces.head<3>());
    add(moment, forces.tail<3>());
    add(strain, strains.head<3>());
    add(curvature, strains.tail<3>());
    owners.push_back(static_cast<std::int32_t>(owner));
  }
  [[nodiscard]] std::size_t count() const { return radius.size(); }

  [[nodiscard]] std::string vtp(const std::vector<std::string>& names) const {
    VtkFile file("PolyData");
    file.names("line_names", names);
    file.text(format("<Piece NumberOfPoints=\"{}\" NumberOfLines=\"{}\">\n<Points>\n", count(),
                     ends.size()));
    file.array("points", 3, points);
    file.text("</Points>\n<PointData Scalars=\"radius\" Vectors=\"velocity\">\n");
    file.array("radius", 1, radius);
    file.array("velocity", 3, velocity);
    file.array("y_axis", 3, y_axis);
    file.text("</PointData>\n<Lines>\n");
    file.array("connectivity", 1, corners);
    file.array("offsets", 1, ends);
    file.text("</Lines>\n<CellData Scalars=\"line\">\n");
    file.array("line", 1, owners);
    file.array("force", 3, force);
    file.array("moment", 3, moment);
    file.array("strain", 3, strain);
    file.array("curvature", 3, curvature);
    file.text("</CellData>\n</Piece>\n");
    return file.bytes();
  }
};

}  // namespace

LinesWriter::LinesWriter(const std::string& folder, const std::string& name, const Model& model,
                         double size, std::optional<double> keep)
    : series_(folder, name, "vtp", keep) {
  for (const BeamSpec& beam : model.beams) {
    names_.push_back(beam.name);
    const double across = beam.section.height + beam.section.width;
    radii_.push_back(across > 0.0 ? 0.25 * across : kBeamRadius * size);
  }
  for (const CableLineSpec& cable : model.cables) {
    names_.push_back(cable.name);
    radii_.push_back(kCableRadius * size);
  }
}

void LinesWriter::append(double t, const std::vector<BeamReport>& beams,
                         const std::vector<CableReport>& cables) {
  Lines lines;
  std::size_t owner = 0;
  for (const BeamReport& beam : beams) {
    const std::size_t first = lines.count();
    for (std::size_t k = 0; k < beam.position.size(); ++k)
      lines.add_point(beam.position[k], beam.velocity[k], beam.orientation[k] * Vec3::UnitY(),
                      radii_.at(owner));
    for (std::size_t k = 0; k < beam.forces.size(); ++k)
      lines.add_line(first + k, beam.forces[k], beam.strains[k], owner);
    ++owner;
  }
  for (const CableReport& cable : cables) {
    const std::size_t first = lines.count();
    for (std::size_t k = 0; k < cable.position.size(); ++k)
      lines.add_point(cable.position[k], cable.velocity[k], Vec3::Zero(), radii_.at(owner));
    for (std::size_t k = 0; k < cable.tension.size(); ++k)
      lines.add_line(first + k, cable.tension[k] * Vec6::Unit(0), cable.strain[k] * Vec6::Unit(0),
                     owner);
    ++owner;
  }
  series_.append(t, lines.vtp(names_));
}

}  // namespace polhode::io
