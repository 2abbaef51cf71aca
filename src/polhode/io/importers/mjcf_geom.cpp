// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_geom.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/importers/mjcf_medium.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;
using geometry::MassProperties;

/// Groups of geoms that are shown unless asked otherwise.
constexpr double kLastShownGroup = 2.0;
/// Largest number of bits of contact.
constexpr double kMostBits = 2147483647.0;
/// Number of heights of one field, at most, and relative difference of the spacings of its grid up
/// to which they are equal.
constexpr double kMostHeights = 1e6, kSameSpacing = 1e-6;

/// Integrals over the tetrahedra between the triangles of a surface and a point, each counted
/// positive.
struct Tetrahedra {
  double volume = 0.0;
  Vec3 first = Vec3::Zero();   ///< ∫ x dV, x from the point.
  Mat3 second = Mat3::Zero();  ///< ∫ x xᵀ dV.
  double area = 0.0;
  Vec3 middle = Vec3::Zero();  ///< Mean of the surface, from the point.
};

Tetrahedra tetrahedra(const geometry::TriangleSurface& surface, const Vec3& point) {
  Tetrahedra whole;
  for (const auto& t : surface.triangles) {
    Mat3 P;
    for (int k = 0; k < 3; ++k)
      P.col(k) = surface.points[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])] - point;
    const double volume = std::abs(P.determinant()) / 6.0;
    const Vec3 sum = P.rowwise().sum();
    whole.volume += volume;
    whole.first += volume / 4.0 * sum;
    whole.second += volume / 20.0 * (sum * sum.transpose() + P * P.transpose());
    const double area = 0.5 * (P.col(1) - P.col(0)).cross(P.col(2) - P.col(0)).norm();
    whole.area += area;
    whole.middle += area / 3.0 * sum;
  }
  whole.middle /= whole.area;
  return whole;
}

/// Mass properties of a surface at density 1 that MuJoCo calls legacy: centre of mass by the
/// tetrahedra from the middle of the surface, volume and inertia by those from the centre of mass.
/// They are right for surfaces that are star-shaped about these points.
MassProperties legacy_properties(const geometry::TriangleSurface& surface) {
  const Vec3 middle = tetrahedra(surface, Vec3::Zero()).middle;
  const Tetrahedra about_middle = tetrahedra(surface, middle);
  const Vec3 com = middle + about_middle.first / about_middle.volume;
  const Tetrahedra whole = tetrahedra(surface, com);
  return {whole.volume, com, whole.second.trace() * Mat3::Identity() - whole.second};
}

/// Sizes of a model file by those of MJCF, which are half lengths. @returns whether they are there.
bool full_sizes(const std::string& type, const std::vector<double>& half, std::vector<double>& s) {
  const std::size_t count = type == "sphere" ? 1 : type == "box" || type == "ellipsoid" ? 3 : 2;
  if (half.size() < count) return false;
  for (std::size_t k = 0; k < count; ++k) s.push_back(2.0 * half[k]);
  if (type == "capsule") s[1] += s[0];
  for (const double size : s)
    if (!(size > 0.0)) return false;
  return true;
}

}  // namespace

MjcfGeoms::MjcfGeoms(MjcfFile& file, const std::string& folder)
    : file_(file), folder_(folder), in_pairs_(names_in_pairs()) {
  for (const auto* asset : file_.sections("asset"))
    for (const auto* e : file_.xml.children(*asset, "hfield")) read_heights(*e);
  for (const auto* asset : file_.sections("asset"))
    for (const auto* e : file_.xml.children(*asset, "mesh")) {
      const MjcfTag tag{file_, *e, {"mesh"}, ""};
      std::string path = tag.text("file");
      std::string name = tag.text("name");
      if (name.empty()) name = fs::path(path).stem().string();
      if (file_.compiler.strip_path) path = fs::path(path).filename().string();
      if (!path.empty()) path = (fs::path(file_.compiler.mesh_folder) / path).string();
      meshes_[name] = {
          e, path, tag.vector("scale", Vec3::Ones()), tag.text("inertia", "legacy"), {}};
      Pose& reference = meshes_[name].reference;
      reference.p = tag.vector("refpos", Vec3::Zero());
      if (const auto q = tag.numbers("refquat", 4, 4); !q.empty()) {
        const Quat turn(q[0], q[1], q[2], q[3]);
        if (turn.norm() > 0.0)
          reference.R = turn.normalized().toRotationMatrix();
        else
          file_.xml.fault(*e, "'refquat' of <mesh> has no length",
                          "Give numbers that are not all zero.");
      }
      file_.ignored.attributes(*e, {"class", "maxhullvert", "smoothnormal", "content_type"});
    }
}

/// Heights as numbers, which MuJoCo scales to the range from 0 to the height in 'size', rows from
/// +y to -y; none are a flat field. Those in files are not read.
void MjcfGeoms::read_heights(const XmlFile::Element& e) {
  XmlFile& xml = file_.xml;
  const auto rows = xml.number(e, "nrow"), columns = xml.number(e, "ncol");
  const auto size = xml.numbers(e, "size", 4, 4);
  const std::string name = xml.text(e, "name").value_or("");
  const auto is_count = [](double n) { return n >= 2.0 && n <= 1e4 && n == std::floor(n); };
  if (!size || xml.text(e, "file") || !rows || !columns || !is_count(*rows) ||
      !is_count(*columns) || *rows * *columns > kMostHeights || !((*size)[0] > 0.0) ||
      !((*size)[1] > 0.0))
    return;
  const auto m = static_cast<std::size_t>(*rows), n = static_cast<std::size_t>(*columns);
  std::vector<double> values(m * n, 0.0);
  if (e.Attribute("elevation") != nullptr) {
    const auto given = xml.numbers(e, "elevation", m * n, m * n);
    if (!given) return;
    values = *given;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    const double from = *least, range = *most - *least;
    for (double& z : values) z = range > 0.0 ? (z - from) / range * (*size)[2] : 0.0;
  }
  Heights field{2.0 * (*size)[0] / (*columns - 1.0), 2.0 * (*size)[1] / (*rows - 1.0), {}};
  for (std::size_t row = m; row-- > 0;)
    field.rows.emplace_back(values.begin() + static_cast<std::ptrdiff_t>(row * n),
                            values.begin() + static_cast<std::ptrdiff_t>((row + 1) * n));
  heights_[name] = std::move(field);
}

/// Names of geoms that touch in pairs of their own.
std::set<std::string> MjcfGeoms::names_in_pairs() {
  std::set<std::string> names;
  for (const auto* section : file_.sections("contact"))
    for (const auto* e = section->FirstChildElement("pair"); e != nullptr;
         e = e->NextSiblingElement("pair"))
      for (const char* attribute : {"geom1", "geom2"})
        if (const char* name = e->Attribute(attribute)) names.insert(name);
  return names;
}

MassProperties MjcfGeoms::mass_of_mesh(const Mesh& mesh) {
  geometry::TriangleSurface surface =
      geometry::read_surface((fs::path(folder_) / mesh.file).string());
  const Pose to_mesh = mesh.reference.inverse();
  for (Vec3& x : surface.points) x = (to_mesh * x).cwiseProduct(mesh.scale);
  if (mesh.inertia == "exact") {
    geometry::check_closed(mesh.file, surface);
    return geometry::mass_properties(surface, 1.0);
  }
  if (mesh.inertia == "convex")
    return geometry::mass_properties(geometry::convex_hull(mesh.file, surface.points), 1.0);
  if (mesh.inertia == "legacy") return legacy_properties(surface);
  throw InputError("mesh", format("has the inertia {}", quote(mesh.inertia)),
                   "Give convex, exact or legacy");
}

MjcfGeom MjcfGeoms::read(const MjcfTag& tag, const Pose& frame, bool massive) {
  MjcfGeom geom;
  XmlFile& xml = file_.xml;
  const auto& e = tag.e;
  file_.ignored.attributes(e, {"name", "rgba", "material", "user", "priority", "solref", "solimp",
                               "solmix", "margin", "gap", "fitscale", "fluidcoef", "shellinertia"});
  geom.ellipsoid = tag.text("fluidshape", "none") == "ellipsoid";
  const std::string type = tag.text("type", "sphere");
  const double group = tag.number("group", 0.0);
  geom.seen = group <= kLastShownGroup;
  const auto whole = [&](const char* attribute) {
    const double value = tag.number(attribute, 1.0);
    if (value == std::floor(value) && std::abs(value) <= kMostBits) return static_cast<int>(value);
    xml.fault(e, format("'{}' of <geom> is {}", attribute, value), "Give a whole number.");
    return 1;
  };
  const std::pair bits{whole("contype"), whole("conaffinity")};
  geom.touches = bits.first != 0 || bits.second != 0 || in_pairs_.contains(tag.name().value_or(""));
  if (const std::vector<double> friction = tag.numbers("friction", 1, 3); !friction.empty())
    std::copy(friction.begin(), friction.end(), geom.friction.begin());
  geom.dimensions = tag.number("condim", 3.0);
  massive = massive && group >= file_.compiler.groups[0] && group <= file_.compiler.groups[1];
  RobotShape shape;
  shape.at = &e;
  shape.kind = type;
  shape.name = tag.name().value_or("");
  shape.contact_bits = bits;
  shape.friction = geom.dimensions >= 3.0 ? geom.friction[0] : 0.0;
  Pose pose = tag.pose();
  std::vector<double> half = tag.numbers("size", 1, 3);
  if (const auto ends = tag.numbers("fromto", 6, 6); !ends.empty()) {
    const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
    if (!((to - from).norm() > 0.0) || half.empty()) {
      xml.fault(e, "'fromto' of <geom> has no length, or 'size' is missing",
                "Give two points, and a radius.");
      return geom;
    }
    pose = {0.5 * (from + to), rotation_to((from - to).normalized())};
    const double length = 0.5 * (to - from).norm();
    half = type == "box" || type == "ellipsoid" ? std::vector{half[0], half[0], length}
                                                : std::vector{half[0], length};
  }
  shape.pose = frame * pose;
  const auto density = [&](double volume) {
    const double mass = tag.number("mass", -1.0);
    return mass >= 0.0 ? mass / volume : tag.number("density", 1000.0);
  };
  if (tag.boolean("shellinertia", false) && massive)
    xml.fault(e, "the mass of <geom> is in its shell", "Give the body an <inertial>.");
  const std::string mesh_name = tag.text("mesh");
  if (type == "mesh" || (!mesh_name.empty() && type != "sdf")) {
    const auto found = meshes_.find(mesh_name);
    if (found == meshes_.end()) {
      std::vector<std::string> names;
      for (const auto& mesh : meshes_) names.push_back(mesh.first);
      xml.fault(e, format("there is no mesh {}", quote(mesh_name)),
                did_you_mean(mesh_name, names) + "Meshes: " + name_list(names, 12) + ".");
      return geom;
    }
    const bool fits = type != "mesh";
    const bool plain = !fits && !found->second.file.empty();
    const Mesh& mesh = found->second;
    const bool even = mesh.scale == Vec3::Constant(mesh.scale[0]);
    const Pose in_geom = shape.pose;
    if (plain && !even && !mesh.reference.R.isIdentity(0.0)) {
      file_.ignored.add(e, "a <mesh> with 'refquat' and a scale that differs by direction",
                        "is no shape: only its mass is read");
    } else if (plain) {
      shape.file = mesh.file;
      shape.scale = mesh.scale;
      const Pose to_mesh = mesh.reference.inverse();
      shape.pose = in_geom * Pose{to_mesh.p.cwiseProduct(mesh.scale), to_mesh.R};
      geom.shape = shape;
    } else {
      file_.ignored.add(e, fits ? "the fit of a <geom> to a mesh" : "a <mesh> without a file",
                        "is not read: it is a picture only");
    }
    if (!massive || tag.number("mass", 1.0) == 0.0 || density(1.0) == 0.0) return geom;
    try {
      if (!plain) throw InputError("mesh", "is not read from a file", "");
      MassProperties unit = mass_of_mesh(mesh);
      const double rho = density(unit.mass);
      unit.mass *= rho;
      unit.inertia *= rho;
      geom.axes = in_geom.R * rotated_to_principal(unit.inertia / unit.mass);
      geom.mass = geometry::placed(unit, in_geom.p, in_geom.R);
    } catch (const InputError& error) {
      xml.fault(e,
                format("the mass of the mesh {} is not known: {}", quote(mesh_name),
                       error.what_is_wrong()),
                "Give the body an <inertial>.");
    }
    return geom;
  }
  static const std::vector<std::string> types{
      "plane", "hfield", "sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh", "sdf"};
  if (std::find(types.begin(), types.end(), type) == types.end())
    xml.fault(e, format("<geom> has the unknown type {}", quote(type)),
              did_you_mean(type, types) + "Types: " + name_list(types) + ".");
  if (type == "plane") geom.shape = shape;
  const auto field = heights_.find(tag.text("hfield"));
  if (type == "hfield" && field != heights_.end() &&
      std::abs(field->second.along_x - field->second.along_y) <=
          kSameSpacing * field->second.along_x) {
    shape.kind = "height_field";
    shape.sizes = {field->second.along_x};
    shape.heights = field->second.rows;
    geom.shape = shape;
  } else if (type == "hfield" || type == "sdf")
    file_.ignored.add(e, format("<geom type=\"{}\">", type), "is not read");
  const geometry::ShapeKind* kind = geometry::find_shape_kind(type);
  if (kind == nullptr || std::find(types.begin(), types.end(), type) == types.end()) return geom;
  if (!full_sizes(type, half, shape.sizes)) {
    xml.fault(e, format("the {} has too few sizes, or one that is not above 0", type),
              "Give 'size'.");
    return geom;
  }
  geom.shape = shape;
  if (!massive) return geom;
  const double rho = density(kind->unit_mass_properties(shape.sizes).mass);
  if (rho == 0.0) return geom;
  if (rho < 0.0) {
    xml.fault(e, "the mass of <geom> is negative", "Give a mass that is not.");
    return geom;
  }
  try {
    const MassProperties own = geometry::shape_mass_properties("geom", *kind, shape.sizes, rho);
    geom.axes = shape.pose.R;
    geom.mass = geometry::placed(own, shape.pose.p, shape.pose.R);
  } catch (const InputError& error) {  // Numbers that overflow.
    xml.fault(e, "the mass of <geom> cannot be computed: " + error.what_is_wrong(),
              "Give another size, or a density that is finite.");
  }
  return geom;
}

}  // namespace polhode::io
