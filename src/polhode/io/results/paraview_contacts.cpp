// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/results/paraview.hpp>

namespace polhode::io {

void ContactsWriter::append(double t, const std::vector<contact::TouchingPoint>& points) {
  std::vector<float> places, forces, frictions, normals, gaps;
  std::vector<std::int32_t> bodies;
  std::vector<std::int64_t> corners, ends;
  const auto add = [](std::vector<float>& list, const Vec3& x) {
    for (int k = 0; k < 3; ++k) list.push_back(static_cast<float>(x[k]));
  };
  for (const contact::TouchingPoint& p : points) {
    add(places, p.point);
    add(forces, p.force);
    add(frictions, p.friction);
    normals.push_back(static_cast<float>(p.normal.dot(p.force - p.friction)));
    gaps.push_back(static_cast<float>(p.gap));
    for (const int shape : {p.a, p.b})
      bodies.push_back(body_of_shape_[static_cast<std::size_t>(shape)]);
    corners.push_back(static_cast<std::int64_t>(corners.size()));
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  VtkFile file("PolyData");
  file.names("body_names", bodies_);
  file.text(
      format("<Piece NumberOfPoints=\"{0}\" NumberOfVerts=\"{0}\">\n<Points>\n", points.size()));
  file.array("points", 3, places);
  file.text("</Points>\n<PointData Vectors=\"force\" Scalars=\"normal_force\">\n");
  file.array("force", 3, forces);
  file.array("friction", 3, frictions);
  file.array("normal_force", 1, normals);
  file.array("gap", 1, gaps);
  file.array("bodies", 2, bodies);
  file.text("</PointData>\n<Verts>\n");
  file.array("connectivity", 1, corners);
  file.array("offsets", 1, ends);
  file.text("</Verts>\n</Piece>\n");
  series_.append(t, file.bytes());
}

}  // namespace polhode::io
