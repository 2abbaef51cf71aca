// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/paraview.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <Eigen/Eigenvalues>

#include <polhode/base/format.hpp>
#include <polhode/body/read_surface.hpp>
#include <polhode/body/shapes.hpp>
#include <polhode/io/file_error.hpp>

namespace polhode {

namespace {

/// Triangles around the circle of a round shape: a picture needs no more.
constexpr int kSegments = 24;
/// The list of times is written again at most this often, but at every frame of a slow run [s].
constexpr double kListEvery = 0.2;

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void append(TriangleSurface& sum, const TriangleSurface& part, const Mat3& R, const Vec3& offset) {
  const int first = static_cast<int>(sum.points.size());
  for (const Vec3& p : part.points) sum.points.push_back(offset + R * p);
  for (const auto& [a, b, c] : part.triangles)
    sum.triangles.push_back({first + a, first + b, first + c});
}

/// The box with this mass and inertia: I_x = m (l_y² + l_z²)/12 and so on, solved for the lengths.
TriangleSurface inertia_box(const BodySpec& body, double size) {
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(body.inertia);
  const Vec3& I = axes.eigenvalues();
  Vec3 squares = 6.0 / body.mass * (Vec3::Constant(I.sum()) - 2.0 * I);
  double largest = std::sqrt(std::max(0.0, squares.maxCoeff()));
  if (body.point_mass || !(largest > 0.0)) largest = 0.02 * size;
  std::vector<double> lengths;
  for (double s : squares)
    lengths.push_back(std::max(s > 0.0 ? std::sqrt(s) : 0.0, 0.02 * largest));
  if (body.point_mass) lengths.assign(3, largest);
  Mat3 R = axes.eigenvectors();
  if (R.determinant() < 0.0) R.col(2) *= -1.0;
  TriangleSurface box;
  append(box, shape_surface(*find_shape_kind("box"), lengths), R, Vec3::Zero());
  return box;
}

/// A square of a plane about its point; both sides are seen.
TriangleSurface plane_patch(const std::vector<double>& normal, double half_width) {
  const Vec3 n(normal[0], normal[1], normal[2]);
  const Mat3 R = Quat::FromTwoVectors(Vec3::UnitZ(), n).toRotationMatrix();
  TriangleSurface square;
  for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
    square.points.push_back(half_width * (x * R.col(0) + y * R.col(1)));
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  return square;
}

/// Farthest that a body stands from a point at the start, with room for its own size.
double reach_from(const Vec3& point, const Model& model, double size) {
  double farthest = size;
  for (const BodySpec& body : model.bodies)
    farthest = std::max(farthest, (body.position - point).norm() + size);
  return farthest;
}

TriangleSurface picture_of(const BodySpec& body, const Model& model, double size) {
  TriangleSurface sum;
  for (const ShapeSpec& shape : body.shapes) {
    TriangleSurface surface;
    if (shape.type == "plane")
      surface = plane_patch(
          shape.sizes,
          reach_from(body.position + body.orientation * (shape.position - body.com), model, size));
    else if (const ShapeKind* kind = find_shape_kind(shape.type))
      surface = shape_surface(*kind, shape.sizes, kSegments);
    else if (!shape.file.empty())
      surface = scaled(read_surface(shape.file), shape.scale);
    append(sum, surface, shape.orientation.toRotationMatrix(), shape.position - body.com);
  }
  if (body.shapes.empty() && !body.fixed) sum = inertia_box(body, size);
  return sum;
}

/// Binary blocks of a .vtp file: each is its length and its numbers.
class Blocks {
 public:
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    const std::size_t offset = bytes_.size();
    const std::uint64_t length = values.size() * sizeof(T);
    bytes_.append(reinterpret_cast<const char*>(&length), sizeof length);
    bytes_.append(reinterpret_cast<const char*>(values.data()), length);
    return offset;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string data_array(const char* type, const char* name, int components, std::size_t offset) {
  return format(
      R"(<DataArray type="{}" Name="{}" NumberOfComponents="{}" format="appended" offset="{}"/>)"
      "\n",
      type, name, components, offset);
}

/// Names as VTK writes texts: character codes, each text ended by 0.
std::string name_array(const std::vector<BodyPicture>& pictures) {
  std::string text = format(
      R"(<FieldData><Array type="String" Name="body_names" NumberOfTuples="{}" format="ascii">)",
      pictures.size());
  for (const BodyPicture& picture : pictures) {
    for (const char c : picture.name) text += format("{} ", static_cast<unsigned char>(c));
    text += "0 ";
  }
  return text + "</Array></FieldData>\n";
}

std::string vtp(const std::vector<BodyPicture>& pictures, const std::vector<BodyMotion>& motions) {
  std::vector<float> points, velocities;
  std::vector<std::int64_t> corners, ends;
  std::vector<std::int32_t> owners;
  std::int64_t first = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const TriangleSurface& surface = pictures[i].surface;
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
  Blocks blocks;
  std::string text = R"(<?xml version="1.0"?>
<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">
<PolyData>
)";
  text += name_array(pictures);
  text += format("<Piece NumberOfPoints=\"{}\" NumberOfPolys=\"{}\">\n", first, ends.size());
  text += "<Points>\n" + data_array("Float32", "points", 3, blocks.add(points)) + "</Points>\n";
  text += "<PointData Vectors=\"velocity\">\n" +
          data_array("Float32", "velocity", 3, blocks.add(velocities)) + "</PointData>\n";
  text += "<Polys>\n" + data_array("Int64", "connectivity", 1, blocks.add(corners)) +
          data_array("Int64", "offsets", 1, blocks.add(ends)) + "</Polys>\n";
  text += "<CellData Scalars=\"body\">\n" + data_array("Int32", "body", 1, blocks.add(owners)) +
          "</CellData>\n";
  text += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return text + blocks.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

/// Times of a list written earlier, up to t.
std::vector<double> listed_times(const std::string& path, double t) {
  std::vector<double> times;
  if (!std::filesystem::exists(path)) return times;
  const std::string text = read_file(path);
  constexpr std::string_view kKey = "timestep=\"";
  for (std::size_t at = text.find(kKey); at != std::string::npos; at = text.find(kKey, at)) {
    at += kKey.size();
    const double time = std::strtod(text.c_str() + at, nullptr);
    if (time <= t * (1.0 + 1e-14)) times.push_back(time);
  }
  return times;
}

}  // namespace

std::vector<BodyPicture> body_pictures(const Model& model, double size) {
  std::vector<BodyPicture> pictures;
  for (const BodySpec& body : model.bodies)
    pictures.push_back({body.name, picture_of(body, model, size)});
  return pictures;
}

ParaviewWriter::ParaviewWriter(std::string folder, std::string name,
                               std::vector<BodyPicture> pictures, std::optional<double> keep)
    : folder_(std::move(folder)), name_(std::move(name)), pictures_(std::move(pictures)) {
  make_folder(folder_ + "/" + name_);
  if (keep) times_ = listed_times(format("{}/{}.pvd", folder_, name_), *keep);
  write_list();
}

std::string ParaviewWriter::file(std::size_t frame) const {
  return format("{}/{:06}.vtp", name_, frame);
}

void ParaviewWriter::append(double t, const std::vector<BodyMotion>& motions) {
  const std::string path = folder_ + "/" + file(times_.size());
  const std::string bytes = vtp(pictures_, motions);
  // A new file: many file systems wait for the disk when an old one is written over.
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  std::ofstream stream(path, std::ios::binary | std::ios::trunc);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream) throw FileError::from_errno(path, "cannot be written");
  times_.push_back(t);
  if (now() >= next_listing_) write_list();
}

void ParaviewWriter::write_list() {
  std::string text = R"(<?xml version="1.0"?>
<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">
<Collection>
)";
  for (std::size_t i = 0; i < times_.size(); ++i)
    text += format("<DataSet timestep=\"{}\" part=\"0\" file=\"{}\"/>\n", times_[i], file(i));
  text += "</Collection>\n</VTKFile>\n";
  const double begin = now();
  write_file_atomically(format("{}/{}.pvd", folder_, name_), text, false);
  // Long lists are written less often, so that all lists together stay a small part of the run.
  next_listing_ = now() + std::max(kListEvery, 20.0 * (now() - begin));
}

}  // namespace polhode
