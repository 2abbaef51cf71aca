// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/geometry/surface_of_revolution.hpp>

namespace polhode::geometry {
namespace {

using Sizes = std::span<const double>;
constexpr double kPi = std::numbers::pi;

MassProperties centred(double volume, const Vec3& moments) {
  return {.mass = volume, .com = Vec3::Zero(), .inertia = moments.asDiagonal()};
}

// Box [x, y, z].

MassProperties box_properties(Sizes s) {
  const double V = s[0] * s[1] * s[2];
  const double xx = s[0] * s[0];
  const double yy = s[1] * s[1];
  const double zz = s[2] * s[2];
  return centred(V, V / 12.0 * Vec3(yy + zz, xx + zz, xx + yy));
}

TriangleSurface box_surface(Sizes s, int /*segments*/) {
  TriangleSurface box;
  for (int corner = 0; corner < 8; ++corner)
    box.points.emplace_back(((corner & 1) ? 0.5 : -0.5) * s[0], ((corner & 2) ? 0.5 : -0.5) * s[1],
                            ((corner & 4) ? 0.5 : -0.5) * s[2]);
  box.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return box;
}

// Ellipsoid [x, y, z] and sphere [diameter].

MassProperties ellipsoid_properties(Sizes s) {
  const double V = kPi / 6.0 * s[0] * s[1] * s[2];
  const double xx = s[0] * s[0];
  const double yy = s[1] * s[1];
  const double zz = s[2] * s[2];
  return centred(V, V / 20.0 * Vec3(yy + zz, xx + zz, xx + yy));
}

TriangleSurface ellipsoid_surface(Sizes s, int segments) {
  TriangleSurface ellipsoid =
      surface_of_revolution(arc_profile(0.5, 0.0, -1, 1, segments), segments);
  for (Vec3& x : ellipsoid.points) x = x.cwiseProduct(Vec3(s[0], s[1], s[2]));
  return ellipsoid;
}

MassProperties sphere_properties(Sizes s) {
  return ellipsoid_properties(std::array{s[0], s[0], s[0]});
}

TriangleSurface sphere_surface(Sizes s, int segments) {
  return ellipsoid_surface(std::array{s[0], s[0], s[0]}, segments);
}

// Tube [outer, inner, length] and cylinder [diameter, length].

MassProperties tube_properties(Sizes s) {
  const double outer = 0.5 * s[0];
  const double inner = 0.5 * s[1];
  const double length = s[2];
  const double V = kPi * (outer - inner) * (outer + inner) * length;
  const double radii = outer * outer + inner * inner;
  const double across = radii / 4.0 + length * length / 12.0;
  return centred(V, V * Vec3(across, across, radii / 2.0));
}

std::string tube_misfit(Sizes s) {
  if (s[1] < s[0]) return "";
  return format("the inner diameter, {:g} m, must be less than the outer one, {:g} m", s[1], s[0]);
}

TriangleSurface tube_surface(Sizes s, int segments) {
  const double outer = 0.5 * s[0];
  const double inner = 0.5 * s[1];
  const double half = 0.5 * s[2];
  const Profile profile{{inner, -half}, {outer, -half}, {outer, half}, {inner, half}};
  return ring_of_revolution(profile, segments);
}

MassProperties cylinder_properties(Sizes s) { return tube_properties(std::array{s[0], 0.0, s[1]}); }

TriangleSurface cylinder_surface(Sizes s, int segments) {
  const double r = 0.5 * s[0];
  const double half = 0.5 * s[1];
  return surface_of_revolution({{0.0, -half}, {r, -half}, {r, half}, {0.0, half}}, segments);
}

// Capsule [diameter, length over all].

MassProperties capsule_properties(Sizes s) {
  const double r = 0.5 * s[0];
  const double h = s[1] - s[0];  // length of the cylindrical part
  const double barrel = kPi * r * r * h;
  const double cap = 2.0 / 3.0 * kPi * r * r * r;  // each
  const double cap_centroid = 0.5 * h + 0.375 * r;
  const double across = barrel * (r * r / 4.0 + h * h / 12.0) +
                        2.0 * cap * (83.0 / 320.0 * r * r + cap_centroid * cap_centroid);
  const double along = barrel * r * r / 2.0 + 2.0 * cap * 0.4 * r * r;
  return centred(barrel + 2.0 * cap, {across, across, along});
}

std::string capsule_misfit(Sizes s) {
  if (s[1] >= s[0]) return "";
  return format("the length over all, {:g} m, must be at least the diameter, {:g} m", s[1], s[0]);
}

TriangleSurface capsule_surface(Sizes s, int segments) {
  const double r = 0.5 * s[0];
  const double shift = 0.5 * (s[1] - s[0]);
  Profile profile = arc_profile(r, -shift, -1, 0, segments);
  const Profile top = arc_profile(r, shift, 0, 1, segments);
  profile.insert(profile.end(), shift > 0.0 ? top.begin() : top.begin() + 1, top.end());
  return surface_of_revolution(profile, segments);
}

// Cone [diameter, length], apex towards +z.

MassProperties cone_properties(Sizes s) {
  const double r = 0.5 * s[0];
  const double h = s[1];
  const double V = kPi / 3.0 * r * r * h;
  const double across = 3.0 / 20.0 * r * r + 3.0 / 80.0 * h * h;
  return centred(V, V * Vec3(across, across, 0.3 * r * r));
}

TriangleSurface cone_surface(Sizes s, int segments) {
  const double r = 0.5 * s[0];
  const double h = s[1];
  return surface_of_revolution({{0.0, -0.25 * h}, {r, -0.25 * h}, {0.0, 0.75 * h}}, segments);
}

}  // namespace

const std::vector<ShapeKind>& shape_kinds() {
  const ShapeSize x{"x", "length along x"};
  const ShapeSize y{"y", "length along y"};
  const ShapeSize z{"z", "length along z"};
  const ShapeSize diameter{"diameter", "full width of the circle"};
  const ShapeSize length{"length", "length along z"};
  static const std::vector<ShapeKind> kinds{
      {"box", "a block", {x, y, z}, nullptr, box_properties, box_surface},
      {"sphere", "a ball", {diameter}, nullptr, sphere_properties, sphere_surface},
      {"cylinder",
       "a round bar along z",
       {diameter, length},
       nullptr,
       cylinder_properties,
       cylinder_surface},
      {"capsule",
       "a round bar along z with hemispherical ends",
       {diameter, {"length", "overall length along z"}},
       capsule_misfit,
       capsule_properties,
       capsule_surface},
      {"cone",
       "a cone along z, its apex towards +z; the origin is its centroid, a quarter of the length "
       "above the base",
       {{"diameter", "full width of the base"},
        {"length", "length along z, from the base to the apex"}},
       nullptr,
       cone_properties,
       cone_surface},
      {"ellipsoid", "an ellipsoid", {x, y, z}, nullptr, ellipsoid_properties, ellipsoid_surface},
      {"tube",
       "a hollow round bar along z",
       {{"outer", "outer diameter"}, {"inner", "inner diameter"}, length},
       tube_misfit,
       tube_properties,
       tube_surface},
  };
  return kinds;
}

const ShapeKind* find_shape_kind(std::string_view name) {
  const auto& kinds = shape_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const ShapeKind& k) { return k.name == name; });
  return found == kinds.end() ? nullptr : &*found;
}

void check_shape_sizes(std::string_view where, const ShapeKind& kind, Sizes sizes) {
  std::string names;
  for (const ShapeSize& size : kind.sizes) names += (names.empty() ? "" : ", ") + size.name;
  const std::string hint = format("Write {}: [{}], full lengths", kind.name, names);
  if (sizes.size() != kind.sizes.size())
    throw InputError(
        where,
        format("'{}' has {} size{}, but {} given", kind.name, kind.sizes.size(),
               kind.sizes.size() == 1 ? "" : "s",
               sizes.size() == 1 ? std::string("1 is") : format("{} are", sizes.size())),
        hint);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (!std::isfinite(sizes[i]) || sizes[i] <= 0.0)
      throw InputError(where,
                       format("the size '{}' of '{}' must be positive and finite, but is {:g} m",
                              kind.sizes[i].name, kind.name, sizes[i]),
                       hint);
  if (kind.misfit != nullptr)
    if (const std::string misfit = kind.misfit(sizes); !misfit.empty())
      throw InputError(where, misfit, hint);
}

MassProperties shape_mass_properties(std::string_view where, const ShapeKind& kind, Sizes sizes,
                                     double density) {
  check_shape_sizes(where, kind, sizes);
  if (!std::isfinite(density) || density <= 0.0)
    throw InputError(where,
                     format("the density must be positive and finite, but is {:g} kg/m³", density),
                     "Give a density, e.g. 7850 for steel, or mass and inertia of the body");
  MassProperties properties = kind.unit_mass_properties(sizes);
  properties.mass *= density;
  properties.inertia *= density;
  return properties;
}

TriangleSurface shape_surface(const ShapeKind& kind, Sizes sizes, int segments) {
  return kind.surface(sizes, std::max(segments, 3));
}

}  // namespace polhode::geometry
