// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/lattice.hpp>

namespace polhode::solids {
namespace {

constexpr double kQuarter = std::numbers::pi / 4.0;
/// Corner of the square in the middle of a disc, or of the cube in a ball, over the radius; and the
/// bulge of its sides, which keeps angles at its corners away from 90 and 180 degrees.
constexpr double kCore = 0.45;
constexpr double kBulge = 0.15;
constexpr double kMaxNodes = 2e7;

using ParameterKind = MeshParameter::Kind;
const std::vector<std::string> kSolids = {"hex8",  "hex20", "hex27",  "tet4",
                                          "tet10", "tet15", "wedge6", "wedge15"};
const std::vector<std::string> kSolidsWithoutWedge = {"hex8", "hex20", "hex27",
                                                      "tet4", "tet10", "tet15"};

int count(double value) { return static_cast<int>(std::lround(value)); }

/// Whether a coordinate or a distance has a value, in the definition of named sides.
bool is_at(double x, double value, double size) { return std::abs(x - value) <= 1e-9 * size; }

std::vector<NamedSide> box_sides(const Vec3& half) {
  const double size = half.norm();
  std::vector<NamedSide> sides;
  for (int k = 0; k < 3; ++k)
    for (double sign : {-1.0, 1.0})
      sides.push_back({std::string(1, "xyz"[k]) + (sign < 0.0 ? "min" : "max"),
                       [=](const Vec3& X) { return is_at(X[k], sign * half[k], size); }});
  return sides;
}

Mesh block(const MeshGenerator& self, const MeshParameters& p, std::string_view type) {
  const std::vector<double>&size = p.at("size"), &cells = p.at("cells"), &ratio = p.at("grading");
  const Vec3 lengths{size[0], size[1], size[2]};
  const Patch patch{
      .ends = {graded(count(cells[0]), ratio[0]), graded(count(cells[1]), ratio[1]),
               graded(count(cells[2]), ratio[2])},
      .map = [=](const Vec3& u) -> Vec3 { return (u.array() - 0.5) * lengths.array(); }};
  return lattice_mesh(self.name, {patch}, type, box_sides(0.5 * lengths));
}

std::vector<NamedSide> round_sides(double outer, double inner, double length) {
  const double size = outer + length;
  const auto radius = [](const Vec3& X) { return std::hypot(X[0], X[1]); };
  std::vector<NamedSide> sides;
  sides.push_back({"outer", [=](const Vec3& X) { return is_at(radius(X), outer, size); }});
  sides.push_back({"start", [=](const Vec3& X) { return is_at(X[2], -0.5 * length, size); }});
  sides.push_back({"end", [=](const Vec3& X) { return is_at(X[2], 0.5 * length, size); }});
  if (inner > 0.0)
    sides.push_back({"inner", [=](const Vec3& X) { return is_at(radius(X), inner, size); }});
  return sides;
}

Mesh cylinder(const MeshGenerator& self, const MeshParameters& p, std::string_view type) {
  const double R = 0.5 * p.at("diameter")[0], length = p.at("length")[0];
  const std::vector<double>& cells = p.at("cells");
  const std::vector<double>& ratio = p.at("grading");
  if (count(cells[1]) % 4 != 0)
    throw InputError(self.name, format("cells: {} cells around, which 4 does not divide", cells[1]),
                     "Use 4, 8, 12, …");
  const int side = count(cells[1]) / 4;
  const double a = kCore * R;
  const auto z = [=](double w) { return (w - 0.5) * length; };
  const auto along = graded(count(cells[2]), ratio[1]);
  std::vector<Patch> patches;
  const auto core = [=](double s, double t) {
    return Vec3{a * s * (1.0 + kBulge * (1.0 - t * t)), a * t * (1.0 + kBulge * (1.0 - s * s)), 0};
  };
  patches.push_back(
      {.ends = {graded(side, 1.0), graded(side, 1.0), along}, .map = [=](const Vec3& u) -> Vec3 {
         return core(2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0) + z(u[2]) * Vec3::UnitZ();
       }});
  for (int quarter = 0; quarter < 4; ++quarter) {
    static constexpr std::array<std::array<double, 2>, 4> kTurns{
        {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    const double c = kTurns[quarter][0], s = kTurns[quarter][1];
    patches.push_back({.ends = {graded(count(cells[0]), ratio[0]), graded(side, 1.0), along},
                       .map = [=](const Vec3& u) -> Vec3 {
                         const double v = 2.0 * u[1] - 1.0, angle = kQuarter * v;
                         const Vec3 rim{R * std::cos(angle), R * std::sin(angle), 0};
                         const Vec3 x = (1.0 - u[0]) * core(1.0, v) + u[0] * rim;
                         return {c * x[0] - s * x[1], s * x[0] + c * x[1], z(u[2])};
                       }});
  }
  return lattice_mesh(self.name, patches, type, round_sides(R, 0.0, length));
}

Mesh tube(const MeshGenerator& self, const MeshParameters& p, std::string_view type) {
  const double outer = 0.5 * p.at("outer")[0], inner = 0.5 * p.at("inner")[0];
  const double length = p.at("length")[0];
  const std::vector<double>& cells = p.at("cells");
  const std::vector<double>& ratio = p.at("grading");
  if (inner >= outer)
    throw InputError(
        self.name,
        format("inner: {} m is not below the outer diameter, {} m", 2.0 * inner, 2.0 * outer),
        "Give diameters, the inner one smaller");
  if (count(cells[1]) < 3)
    throw InputError(self.name, format("cells: {} cells around are too few", cells[1]),
                     "Use at least 3");
  const Patch patch{
      .ends = {graded(count(cells[0]), ratio[0]), graded(count(cells[1]), 1.0),
               graded(count(cells[2]), ratio[1])},
      .map = [=](const Vec3& u) -> Vec3 {
        const double radius = inner + u[0] * (outer - inner);
        const double angle = 8.0 * kQuarter * u[1];
        return {radius * std::cos(angle), radius * std::sin(angle), (u[2] - 0.5) * length};
      }};
  return lattice_mesh(self.name, {patch}, type, round_sides(outer, inner, length));
}

/// Point of the ball's core in the first octant, u in the unit cube.
Vec3 ball_core(double a, const Vec3& u) {
  const Vec3 rest = Vec3::Ones() - u.cwiseAbs2();
  return a * Vec3{u[0] * (1.0 + 0.5 * kBulge * (rest[1] + rest[2])),
                  u[1] * (1.0 + 0.5 * kBulge * (rest[0] + rest[2])),
                  u[2] * (1.0 + 0.5 * kBulge * (rest[0] + rest[1]))};
}

/// Point between the core's face across axis k and the sphere; s is the depth, 0 at the core.
Vec3 ball_shell(double R, double a, int k, double s, const Vec3& on_face) {
  Vec3 direction;
  for (int i = 0; i < 3; ++i) direction[i] = i == k ? 1.0 : std::tan(kQuarter * on_face[i]);
  return (1.0 - s) * ball_core(a, on_face) + s * R * direction.normalized();
}

Mesh sphere(const MeshGenerator& self, const MeshParameters& p, std::string_view type) {
  const double R = 0.5 * p.at("diameter")[0], a = kCore * R;
  const std::vector<double>& cells = p.at("cells");
  const std::vector<double>& ratio = p.at("grading");
  const int octants = count(p.at("octants")[0]);
  if (octants != 1 && octants != 2 && octants != 4 && octants != 8)
    throw InputError(self.name, format("octants: {} is not 1, 2, 4 or 8", octants),
                     "1 has x, y, z ≥ 0, 2 has y, z ≥ 0, 4 has z ≥ 0, 8 is the whole ball");
  const auto across = graded(count(cells[0]), ratio[1]), even = graded(count(cells[0]), 1.0),
             deep = graded(count(cells[1]), ratio[0]);
  const std::array<std::vector<double>, 3> core_ends{across, across, even};
  std::vector<Patch> patches;
  for (int octant = 0; octant < octants; ++octant) {
    const Vec3 sign{octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0};
    // A mirrored patch has the opposite orientation: its first two coordinates are exchanged.
    const bool mirrored = sign.prod() < 0.0;
    const auto add = [&](std::array<std::vector<double>, 3> ends,
                         const std::function<Vec3(const Vec3&)>& map) {
      if (mirrored) std::swap(ends[0], ends[1]);
      patches.push_back({.ends = std::move(ends), .map = [=](const Vec3& u) -> Vec3 {
                           return sign.cwiseProduct(map(mirrored ? Vec3{u[1], u[0], u[2]} : u));
                         }});
    };
    add(core_ends, [=](const Vec3& u) { return ball_core(a, u); });
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      add({core_ends[i], core_ends[j], deep}, [=](const Vec3& u) {
        Vec3 on_face;
        on_face[k] = 1.0;
        on_face[i] = u[0];
        on_face[j] = u[1];
        return ball_shell(R, a, k, u[2], on_face);
      });
    }
  }
  std::vector<NamedSide> sides{{"outer", [=](const Vec3& X) { return is_at(X.norm(), R, R); }}};
  for (int k = 0; k < 3; ++k)
    sides.push_back(
        {std::string(1, "xyz"[k]) + "mid", [=](const Vec3& X) { return is_at(X[k], 0.0, R); }});
  return lattice_mesh(self.name, patches, type, sides);
}

Mesh line(const MeshGenerator& self, const MeshParameters& p, std::string_view type) {
  const std::vector<double>& numbers = p.at("points");
  if (numbers.size() < 6 || numbers.size() % 3 != 0)
    throw InputError(self.name, format("points: {} coordinates are given", numbers.size()),
                     "Give at least two points of three coordinates");
  const int n = count(p.at("cells")[0]);
  const int segments = static_cast<int>(numbers.size()) / 3 - 1;
  const CellShape& shape = cell_shape(type);
  Mesh mesh;
  mesh.name = self.name;
  mesh.blocks.push_back({.type = shape.name, .nodes = {}});
  const auto point = [&](int i) {
    return Vec3{numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
  };
  const int parts = n * shape.order;  // nodes of one segment without its first
  mesh.nodes.push_back(point(0));
  for (int s = 0; s < segments; ++s) {
    if ((point(s + 1) - point(s)).norm() == 0.0)
      throw InputError(self.name, format("points: points {} and {} are equal", s + 1, s + 2),
                       "Leave one of them out");
    for (int i = 1; i <= parts; ++i) {
      const double t = static_cast<double>(i) / parts;
      mesh.nodes.push_back((1.0 - t) * point(s) + t * point(s + 1));
    }
  }
  for (int e = 0; e < n * segments; ++e) {
    const int begin = e * shape.order;
    std::vector<int>& nodes = mesh.blocks[0].nodes;
    nodes.push_back(begin);
    nodes.push_back(begin + shape.order);
    if (shape.order == 2) nodes.push_back(begin + 1);
  }
  mesh.node_sets["start"] = {0};
  mesh.node_sets["end"] = {static_cast<int>(mesh.nodes.size()) - 1};
  return mesh;
}

void check_values(std::string_view where, const MeshParameter& parameter,
                  const std::vector<double>& values) {
  const std::string path = format("{}.{}", where, parameter.name);
  const std::size_t n = parameter.size();
  if (n > 0 && values.size() != n)
    throw InputError(
        path,
        format("{} numbers are given, but there are {}: {}", values.size(), n, parameter.values),
        "Give each once");
  for (double value : values) {
    if (!std::isfinite(value))
      throw InputError(path, format("{} is no finite number", value), "Give a finite one");
    if (parameter.kind == ParameterKind::kPoint) continue;
    if (!(value > 0.0))
      throw InputError(path, format("{} is not positive", value), "Give a positive number");
    if (parameter.kind == ParameterKind::kCount &&
        (value != std::floor(value) || value > kMaxNodes))
      throw InputError(path, format("{} is not a count of cells", value),
                       "Give a whole number of reasonable size");
    if (parameter.kind == ParameterKind::kRatio && (value < 1e-4 || value > 1e4))
      throw InputError(path, format("a ratio of {} is too far from 1", value),
                       "Stay between 1e-4 and 1e4");
  }
}

}  // namespace

std::size_t MeshParameter::size() const {
  if (kind == ParameterKind::kPoint) return 0;
  return 1 + static_cast<std::size_t>(std::count(values.begin(), values.end(), ','));
}

const std::vector<MeshGenerator>& mesh_generators() {
  static const std::vector<MeshGenerator> generators{
      {"block",
       "a block, centred at the origin",
       {{"size", ParameterKind::kLength, "x, y, z", {}, "lengths of its sides"},
        {"cells", ParameterKind::kCount, "x, y, z", {}, "cells along each side"},
        {"grading", ParameterKind::kRatio, "x, y, z", {1, 1, 1}, "last cell over first cell"}},
       kSolids,
       "xmin, xmax, ymin, ymax, zmin, zmax",
       block},
      {"cylinder",
       "a round bar along z",
       {{"diameter", ParameterKind::kLength, "diameter", {}, "overall"},
        {"length", ParameterKind::kLength, "length", {}, "along z"},
        {"cells",
         ParameterKind::kCount,
         "radial, around, along",
         {},
         "radial ones lie between a core and the rim; 4 divides those around"},
        {"grading", ParameterKind::kRatio, "radial, along", {1, 1}, "last cell over first cell"}},
       kSolids,
       "outer, start, end",
       cylinder},
      {"tube",
       "a hollow round bar along z",
       {{"outer", ParameterKind::kLength, "diameter", {}, "outer diameter"},
        {"inner", ParameterKind::kLength, "diameter", {}, "inner diameter"},
        {"length", ParameterKind::kLength, "length", {}, "along z"},
        {"cells", ParameterKind::kCount, "radial, around, along", {}, "cells; at least 3 around"},
        {"grading", ParameterKind::kRatio, "radial, along", {1, 1}, "last cell over first cell"}},
       kSolids,
       "inner, outer, start, end",
       tube},
      {"sphere",
       "a ball, or the part of it in some octants",
       {{"diameter", ParameterKind::kLength, "diameter", {}, "overall"},
        {"cells",
         ParameterKind::kCount,
         "octant, radial",
         {},
         "cells along an edge of an octant's core, and from the core to the surface"},
        {"grading",
         ParameterKind::kRatio,
         "radial, pole",
         {1, 1},
         "last cell over first cell, from the core to the surface, and away from the z axis"},
        {"octants",
         ParameterKind::kCount,
         "octants",
         {8},
         "8: the ball; 4: z ≥ 0; 2: y, z ≥ 0; 1: x, y, z ≥ 0"}},
       kSolidsWithoutWedge,
       "outer; xmid, ymid, zmid where it is cut",
       sphere},
      {"line",
       "straight lines from point to point, for beams and cables",
       {{"points",
         ParameterKind::kPoint,
         "x, y, z of each point",
         {},
         "where the lines begin and end"},
        {"cells", ParameterKind::kCount, "cells", {}, "cells of each line"}},
       {"line2", "line3"},
       "start, end (nodes)",
       line},
  };
  return generators;
}

const MeshGenerator* find_mesh_generator(std::string_view name) {
  for (const MeshGenerator& generator : mesh_generators())
    if (generator.name == name) return &generator;
  return nullptr;
}

Mesh make_mesh(std::string_view where, std::string_view generator, const MeshParameters& parameters,
               std::string_view type) {
  const MeshGenerator* found = find_mesh_generator(generator);
  if (!found) {
    std::vector<std::string> names;
    for (const MeshGenerator& one : mesh_generators()) names.push_back(one.name);
    throw InputError(where, format("there is no mesh generator '{}'", generator),
                     did_you_mean(generator, names) + "Generators: " + name_list(names));
  }
  std::vector<std::string> known;
  for (const MeshParameter& parameter : found->parameters) known.push_back(parameter.name);
  for (const auto& [name, values] : parameters)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(where, format("'{}' has no parameter '{}'", generator, name),
                       did_you_mean(name, known) + "Parameters: " + name_list(known));
  MeshParameters all = parameters;
  double cells = 1.0;
  for (const MeshParameter& parameter : found->parameters) {
    const auto entry = all.try_emplace(parameter.name, parameter.preset).first;
    if (entry->second.empty())
      throw InputError(where, format("'{}' is missing", parameter.name),
                       format("Give {}: {}", parameter.values, parameter.meaning));
    check_values(where, parameter, entry->second);
    if (parameter.name == "cells")
      for (double n : entry->second) cells *= n;
  }
  if (cells > kMaxNodes / 27.0)
    throw InputError(where, format("{} cells are too many for one mesh", cells), "Use fewer");
  const std::string wanted(type.empty() ? std::string_view(found->elements[0]) : type);
  if (std::find(found->elements.begin(), found->elements.end(), wanted) == found->elements.end())
    throw InputError(
        where, format("a '{}' cannot be made of '{}'", generator, wanted),
        did_you_mean(wanted, found->elements) + "Types: " + name_list(found->elements));
  try {
    Mesh mesh = found->make(*found, all, wanted);
    mesh.name = where;
    return mesh;
  } catch (const InputError& e) {
    throw InputError(where, e.what_is_wrong(), e.hint());
  }
}

}  // namespace polhode::solids
