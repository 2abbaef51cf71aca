// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_meshes.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/io/importers/package_paths.hpp>

namespace polhode::io {

namespace {

using NoteKind = ImportNote::Kind;

/// Four of many points, each the one farthest from those before it: they lie in a plane if all do.
std::vector<Vec3> spread(const std::vector<Vec3>& points) {
  if (points.size() < 4) return points;
  const auto farthest = [&](auto&& measure) {
    return *std::max_element(points.begin(), points.end(),
                             [&](const Vec3& x, const Vec3& y) { return measure(x) < measure(y); });
  };
  const Vec3 a = points.front();
  const Vec3 b = farthest([&](const Vec3& x) { return (x - a).squaredNorm(); });
  const Vec3 c = farthest([&](const Vec3& x) { return (x - a).cross(b - a).squaredNorm(); });
  const Vec3 n = (b - a).cross(c - a);
  return {a, b, c, farthest([&](const Vec3& x) { return std::abs(n.dot(x - a)); })};
}

SourceNode quoted(const NodeBuilder& make, const std::string& text) {
  SourceNode node = make.text(text);
  node.in_quotes = true;
  return node;
}

}  // namespace

void RobotMeshes::note(ImportNote::Kind kind, const XmlFile::Element& e, std::string what) {
  notes_.push_back({kind, xml_.place(e), std::move(what)});
}

void RobotMeshes::refuse(const XmlFile::Element& e, const std::string& what,
                         const std::string& hint) {
  if (options_.allow_partial)
    note(NoteKind::left_out, e, what);
  else
    xml_.fault(e, what, hint + " Or allow a partial import.");
}

bool RobotMeshes::write(const RobotShape& shape, const NodeBuilder& make, SourceNode& node) {
  const std::string robot_folder =
      shape.folder.value_or(std::filesystem::path(options_.file).parent_path().string());
  const auto path = find_named_file(shape.file, robot_folder, options_.package_paths);
  if (!path) {
    refuse(*shape.at, format("there is no mesh {}", quote(shape.file)),
           "Give import.package_paths, or import.shapes: none.");
    return false;
  }
  std::string ending = std::filesystem::path(*path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (ending != ".stl" && ending != ".obj" && ending != ".msh" && ending != ".dae") {
    const std::string what =
        format("the mesh {} is not read, as {}", quote(shape.file),
               ending.empty() ? std::string("its name has no ending")
                              : format("there is no reader of {} files", ending));
    if (options_.shapes == "collision")
      refuse(*shape.at, what, "Convert it to STL or OBJ.");
    else
      note(NoteKind::ignored, *shape.at, what + ": it is a picture only");
    return false;
  }
  try {
    const geometry::TriangleSurface surface = geometry::read_surface(*path);
    const double scale = shape.scale.x();
    const bool uniform = scale > 0.0 && shape.scale == Vec3::Constant(scale);
    std::string reason = uniform ? "" : "its scale differs by direction or mirrors it";
    if (uniform) {
      try {
        geometry::check_closed(shape.file, surface);
      } catch (const InputError&) {
        reason = "its surface is not closed";
      }
    }
    if (!reason.empty())
      note(NoteKind::approximated, *shape.at,
           format("the mesh {} is replaced by its convex hull, as {}", quote(shape.file), reason));
    std::vector<Vec3> corners = surface.points;
    for (Vec3& x : corners) x = x.cwiseProduct(shape.scale);
    // A hull of the file is made by the model, and here only for its errors, of four points.
    const geometry::TriangleSurface hull =
        reason.empty() ? geometry::TriangleSurface{}
                       : geometry::convex_hull(shape.file, uniform ? spread(corners) : corners);
    SourceNode given = make.map();
    if (uniform) {
      make.put(given, "file", quoted(make, relative(*path)));
      if (scale != 1.0) make.put(given, "scale", make.number(scale));
    } else {
      SourceNode points = make.list();
      for (const Vec3& x : hull.points) points.children.push_back(make.vector(x));
      make.put(given, "points", std::move(points));
    }
    make.put(node, reason.empty() ? "mesh" : "hull", std::move(given));
    return true;
  } catch (const InputError& error) {
    const std::string what =
        format("the mesh {} cannot be used: {}", quote(shape.file), error.what_is_wrong());
    if (options_.shapes == "collision")
      refuse(*shape.at, what, "Mend it.");
    else
      note(NoteKind::ignored, *shape.at, what + "; it is a picture only");
  }
  return false;
}

/// Path as seen from the model's folder.
std::string RobotMeshes::relative(const std::string& path) const {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path here = fs::absolute(folder_.empty() ? fs::path(".") : fs::path(folder_), ignored);
  return fs::absolute(path, ignored)
      .lexically_normal()
      .lexically_proximate(here.lexically_normal())
      .string();
}

void put_sizes(const NodeBuilder& make, const RobotShape& shape, const Pose& pose,
               SourceNode& node) {
  const auto numbers = [&](const std::vector<double>& values) {
    std::vector<SourceNode> list;
    for (const double value : values) list.push_back(make.number(value));
    return make.list(std::move(list));
  };
  if (shape.kind == "plane") {
    make.put(node, "plane", make.direction(pose.R.col(2)));
  } else if (shape.kind == "height_field") {
    SourceNode field = make.map();
    std::vector<SourceNode> rows;
    for (const std::vector<double>& row : shape.heights) rows.push_back(numbers(row));
    make.put(field, "spacing", make.number(shape.sizes.at(0)));
    make.put(field, "heights", make.list(std::move(rows)));
    make.put(node, "height_field", std::move(field));
  } else {
    make.put(node, shape.kind, numbers(shape.sizes));
  }
}

}  // namespace polhode::io
