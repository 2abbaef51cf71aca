// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/vtkhdf.hpp>

#include <algorithm>
#include <functional>
#include <numeric>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/results/paraview.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/view/scene_parts.hpp>
#include <polhode/view/vtkhdf_file.hpp>

namespace polhode {

namespace {

constexpr std::uint8_t kVtkLine = 3, kVtkTriangle = 5;

/// Quantities with a value for each of `entries` points or cells, whose paths begin with `prefix`.
std::vector<VtkHdfField> fields_in(const io::ResultsReader& results, const std::string& prefix,
                                   std::size_t entries, const std::string& but = "") {
  std::vector<VtkHdfField> fields;
  for (const io::ResultsReader::DataSet& set : results.data_sets()) {
    if (set.path.rfind(prefix, 0) != 0 || set.dims.empty() || set.dims[0] != entries) continue;
    const std::string name = set.path.substr(prefix.size());
    if (name == but || name.find('/') != std::string::npos) continue;
    fields.push_back({name, set.unit, set.size() / entries,
                      [&results, path = set.path] { return results.read(path); }});
  }
  return fields;
}

/// Sum of initial values and their changes at each frame.
std::vector<double> moved(const std::vector<double>& start, std::vector<double> changes) {
  if (start.empty()) return {};
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i] += start[i % start.size()];
  return changes;
}

void add_solid(VtkHdfFile& file, const io::ResultsReader& results, const std::string& name) {
  const std::string group = format("{}/{}", io::results::kSolids, name);
  const solids::Mesh mesh = mesh_of_results(results, group);
  VtkHdfGrid grid;
  grid.name = name;
  grid.points = mesh.nodes.size();
  for (const solids::ElementBlock& block : mesh.blocks) {
    const std::vector<std::size_t> order = io::vtk_order(block.shape());
    for (std::size_t at = 0; at < block.nodes.size(); at += order.size()) {
      std::vector<std::int64_t> corners;
      for (const std::size_t k : order) corners.push_back(block.nodes[at + k]);
      grid.add_cell(corners, static_cast<std::uint8_t>(block.shape().vtk));
    }
  }
  grid.positions = [&results, group] {
    return moved(results.vectors(group + "/nodes/reference"),
                 results.read(group + "/nodes/displacement"));
  };
  grid.point_data = fields_in(results, group + "/nodes/", grid.points);
  grid.cell_data = fields_in(results, group + "/elements/", grid.types.size());
  file.add(grid);
}

/// Adds a beam or cable, with a line for each element.
void add_line(VtkHdfFile& file, const io::ResultsReader& results, const std::string& name,
              const std::string& position, const std::string& nodes, const std::string& elements) {
  const io::ResultsReader::DataSet* set = results.find(position);
  if (set == nullptr || set->dims.empty() || set->dims[0] < 2) return;
  VtkHdfGrid grid;
  grid.name = name;
  grid.points = set->dims[0];
  for (std::size_t i = 0; i + 1 < grid.points; ++i)
    grid.add_cell({static_cast<std::int64_t>(i), static_cast<std::int64_t>(i + 1)}, kVtkLine);
  grid.positions = [&results, position] { return results.read(position); };
  grid.point_data = fields_in(results, nodes, grid.points, "position");
  grid.cell_data = fields_in(results, elements, grid.points - 1, "position");
  file.add(grid);
}

/// Surfaces of bodies, by their indices in the results.
using Surfaces = std::vector<std::pair<std::size_t, geometry::TriangleSurface>>;

/// A vector of each body in each frame.
std::vector<double> body_vectors(const io::ResultsReader& results, const std::string& path,
                                 std::size_t bodies) {
  std::vector<double> list = results.read(path);
  if (list.size() != results.frames() * bodies * 3)
    results.refuse("its lists of bodies do not fit each other");
  return list;
}

/// Adds a grid of surfaces that are moved with their bodies.
void add_surfaces(VtkHdfFile& file, const io::ResultsReader& results, const std::string& name,
                  const Surfaces& surfaces, std::size_t bodies) {
  const std::string group = io::results::kPackedBodies;
  VtkHdfGrid grid;
  grid.name = name;
  std::vector<double> owners;
  for (const auto& [body, surface] : surfaces) {
    const auto first = static_cast<std::int64_t>(grid.points);
    for (const auto& [a, b, c] : surface.triangles) {
      grid.add_cell({first + a, first + b, first + c}, kVtkTriangle);
      owners.push_back(static_cast<double>(body));
    }
    grid.points += surface.points.size();
  }
  /// A vector for each point, by the index of its body in lists of vectors and its rotated lever
  /// arm.
  using Visit = std::function<Vec3(std::size_t at, const Vec3& arm)>;
  const auto each_point = [&](const Visit& visit) {
    const std::vector<double> q = results.read(group + "/orientation");
    if (q.size() != results.frames() * bodies * 4)
      results.refuse("its lists of bodies do not fit each other");
    std::vector<double> list;
    for (std::size_t frame = 0; frame < results.frames(); ++frame)
      for (const auto& [body, surface] : surfaces) {
        const std::size_t at = frame * bodies + body;
        const Quat turn(q[4 * at], q[4 * at + 1], q[4 * at + 2], q[4 * at + 3]);
        for (const Vec3& p : surface.points) {
          const Vec3 x = visit(3 * at, turn.normalized() * p);
          list.insert(list.end(), {x[0], x[1], x[2]});
        }
      }
    return list;
  };
  const auto vector_at = [](const std::vector<double>& list, std::size_t at) {
    return Vec3(list[at], list[at + 1], list[at + 2]);
  };
  grid.positions = [&] {
    const std::vector<double> r = body_vectors(results, group + "/position", bodies);
    return each_point(
        [&](std::size_t at, const Vec3& arm) -> Vec3 { return vector_at(r, at) + arm; });
  };
  const auto velocities = [&] {
    const std::vector<double> v = body_vectors(results, group + "/velocity", bodies),
                              w = body_vectors(results, group + "/angular_velocity", bodies);
    return each_point([&](std::size_t at, const Vec3& arm) -> Vec3 {
      return vector_at(v, at) + vector_at(w, at).cross(arm);
    });
  };
  grid.point_data.push_back({"velocity", "m/s", 3, velocities});
  grid.fixed_cell_data.emplace_back("body", owners);
  file.add(grid);
}

/// Adds a grid for each body, or one for all if there are many.
void add_body_surfaces(VtkHdfFile& file, const io::ResultsReader& results, const Model& model) {
  const std::vector<std::string> names =
      results.names(std::string(io::results::kPackedBodies) + "/names");
  double size = 0.0;
  for (const BodySpec& a : model.bodies)
    size = std::max(size, (a.position - model.bodies[0].position).norm());
  Surfaces surfaces;
  for (io::BodyPicture& picture : io::body_pictures(model, size > 0.0 ? size : 1.0)) {
    const auto at = std::find(names.begin(), names.end(), picture.name);
    if (at != names.end() && !picture.surface.points.empty())
      surfaces.emplace_back(at - names.begin(), std::move(picture.surface));
  }
  if (surfaces.size() > static_cast<std::size_t>(io::results::kMaxNamed)) {
    add_surfaces(file, results, "bodies", surfaces, names.size());
    return;
  }
  for (const auto& surface : surfaces)
    add_surfaces(file, results, names[surface.first], {surface}, names.size());
}

}  // namespace

void write_vtkhdf(const io::ResultsReader& results, const Model* model, const std::string& path) {
  VtkHdfFile file(path, results.read(io::results::kTime));
  if (model != nullptr &&
      results.find(std::string(io::results::kPackedBodies) + "/position") != nullptr)
    add_body_surfaces(file, results, *model);
  for (const std::string& name : results.groups(io::results::kSolids))
    add_solid(file, results, name);
  for (const std::string& name : results.groups(io::results::kBeams)) {
    const std::string group = format("{}/{}", io::results::kBeams, name);
    add_line(file, results, name, group + "/nodes/position", group + "/nodes/",
             group + "/elements/");
  }
  for (const std::string& name : results.groups(io::results::kCables)) {
    const std::string group = format("{}/{}", io::results::kCables, name);
    add_line(file, results, name, group + "/position", group + "/", group + "/");
  }
  if (file.grids() == 0)
    throw InputError("vtkhdf",
                     "there are no bodies with shapes, solids, beams or cables in these results",
                     "Name results of a model with bodies");
  file.close();
}

}  // namespace polhode
