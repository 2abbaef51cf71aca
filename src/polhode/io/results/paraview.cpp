// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/paraview.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/compile/shape_surface.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/math/dense.hpp>

namespace polhode::io {

namespace {

/// Triangles around the circle of a round shape, sufficient for a picture.
constexpr int kSegments = 24;

void append(geometry::TriangleSurface& sum, const geometry::TriangleSurface& part, const Mat3& R,
            const Vec3& offset) {
  const int first = static_cast<int>(sum.points.size());
  for (const Vec3& p : part.points) sum.points.push_back(offset + R * p);
  for (const auto& [a, b, c] : part.triangles)
    sum.triangles.push_back({first + a, first + b, first + c});
}

}  // namespace

// I_x = m (l_y² + l_z²)/12 and so on, solved for the lengths.
geometry::TriangleSurface inertia_box(const BodySpec& body, double size, double thinnest) {
  const SymmetricEigen axes = eigen_of_symmetric(body.inertia);
  const Vec3& I = axes.values;
  Vec3 squares = 6.0 / body.mass * (Vec3::Constant(I.sum()) - 2.0 * I);
  double largest = std::sqrt(std::max(0.0, squares.maxCoeff()));
  if (body.point_mass || !(largest > 0.0)) largest = 0.02 * size;
  std::vector<double> lengths;
  for (double s : squares)
    lengths.push_back(std::max(s > 0.0 ? std::sqrt(s) : 0.0, thinnest * largest));
  if (body.point_mass) lengths.assign(3, largest);
  Mat3 R = axes.vectors;
  if (R.determinant() < 0.0) R.col(2) *= -1.0;
  geometry::TriangleSurface box;
  append(box, geometry::shape_surface(*geometry::find_shape_kind("box"), lengths), R, Vec3::Zero());
  return box;
}

namespace {

/// Square of a plane about its point, visible from both sides.
geometry::TriangleSurface plane_patch(const std::vector<double>& normal, double half_width) {
  const Vec3 n(normal[0], normal[1], normal[2]);
  const Mat3 R = rotation_between(Vec3::UnitZ(), n).toRotationMatrix();
  geometry::TriangleSurface square;
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
    square.points.push_back(half_width * (x * R.col(0) + y * R.col(1)));
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  return square;
}

/// Largest distance of a body from a point at the start, including its size.
double reach_from(const Vec3& point, const Model& model, double size) {
  double farthest = size;
  for (const BodySpec& body : model.bodies)
    farthest = std::max(farthest, (body.position - point).norm() + size);
  return farthest;
}

geometry::TriangleSurface picture_of(const BodySpec& body, const Model& model, double size) {
  geometry::TriangleSurface sum;
  for (const ShapeSpec& shape : body.shapes) {
    geometry::TriangleSurface surface;
    if (shape.type == "plane")
      surface = plane_patch(
          shape.sizes,
          reach_from(body.position + body.orientation * (shape.position - body.com), model, size));
    else
      surface = shape_surface(format("bodies.{}.shape", body.name), shape, kSegments);
    append(sum, surface, shape.orientation.toRotationMatrix(), shape.position - body.com);
  }
  if (body.shapes.empty() && !body.fixed) sum = inertia_box(body, size);
  return sum;
}

std::string vtp(const std::vector<BodyPicture>& pictures, const std::vector<BodyMotion>& motions) {
  std::vector<float> points, velocities;
  std::vector<std::int64_t> corners, ends;
  std::vector<std::int32_t> owners;
  std::int64_t first = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const geometry::TriangleSurface& surface = pictures[i].surface;
    const Mat3 Lambda = motions[i].Lambda();
    const Vec3 omega = motions[i].omega();
    for (const Vec3& Z : surface.points) {
      const Vec3 z = Lambda * Z;
      const Vec3 x = motions[i].r + z;
      const Vec3 v = motions[i].v + omega.cross(z);
      for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(x[k]));
      for (int k = 0; k < 3; ++k) velocities.push_back(static_cast<float>(v[k]));
    }
    for (const auto& triangle : surface.triangles) {
      for (int corner : triangle) corners.push_back(first + corner);
      ends.push_back(static_cast<std::int64_t>(corners.size()));
      owners.push_back(static_cast<std::int32_t>(i));
    }
    first += static_cast<std::int64_t>(surface.points.size());
  }
  std::vector<std::string> names;
  names.reserve(pictures.size());
  for (const BodyPicture& picture : pictures) names.push_back(picture.name);
  VtkFile file("PolyData");
  file.names("body_names", names);
  file.text(
      format("<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n<Points>\n", first, ends.size()));
  file.array("points", 3, points);
  file.text("</Points>\n<PointData Vectors=\"velocity\">\n");
  file.array("velocity", 3, velocities);
  file.text("</PointData>\n<Polys>\n");
  file.array("connectivity", 1, corners);
  file.array("offsets", 1, ends);
  file.text("</Polys>\n<CellData Scalars=\"body\">\n");
  file.array("body", 1, owners);
  file.text("</CellData>\n</Piece>\n");
  return file.bytes();
}

}  // namespace

std::vector<BodyPicture> body_pictures(const Model& model, double size) {
  std::vector<BodyPicture> pictures;
  const std::vector<bool> nodes = are_nodes(model);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodySpec& body = model.bodies[i];
    pictures.push_back(
        {body.name, nodes[i] ? geometry::TriangleSurface{} : picture_of(body, model, size)});
  }
  return pictures;
}

void ParaviewWriter::append(double t, const std::vector<BodyMotion>& motions) {
  series_.append(t, vtp(pictures_, motions));
}

}  // namespace polhode::io
