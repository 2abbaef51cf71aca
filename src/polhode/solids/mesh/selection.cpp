// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/selection.hpp>

namespace polhode::solids {
namespace {

using Kind = Selection::Kind;
using Level = Selection::Level;

constexpr double kTolerance = 1e-6;  // of the mesh's extent

std::string point_text(const Vec3& x) {
  return format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

std::string extent_text(const Mesh& mesh) {
  const Extent box = extent(mesh);
  return format("The mesh reaches from {} to {} m", point_text(box.least), point_text(box.most));
}

std::string description(const Selection& s) {
  switch (s.kind) {
    case Kind::kAll:
      return "the whole mesh";
    case Kind::kSet:
      return format("the set '{}'", s.set);
    case Kind::kPlane:
      return s.level == Level::kValue
                 ? format("the plane with normal {} at {:.6g} m", point_text(s.normal), s.value)
                 : format("the plane with normal {} at the {}", point_text(s.normal),
                          s.level == Level::kMin ? "smallest extent" : "largest extent");
    case Kind::kBox:
      return format("the box from {} to {} m", point_text(s.least), point_text(s.most));
    case Kind::kSphere:
      return format("the sphere about {} of radius {:.6g} m", point_text(s.centre), s.radius);
    case Kind::kNodes:
      return "the list of nodes";
  }
  return {};
}

[[noreturn]] void refuse_unknown_set(std::string_view where, const Mesh& mesh,
                                     const std::string& set) {
  std::set<std::string> names;
  for (const auto& [name, nodes] : mesh.node_sets) names.insert(name);
  for (const auto& [name, surface] : mesh.surfaces) names.insert(name);
  for (const auto& [name, elements] : mesh.element_sets) names.insert(name);
  const std::vector<std::string> list(names.begin(), names.end());
  throw InputError(
      where, format("the mesh has no set '{}'", set),
      list.empty() ? "It has no sets at all; select by plane, box or sphere. " + extent_text(mesh)
                   : did_you_mean(set, list) + "Sets: " + name_list(list));
}

std::vector<char> marked(const Mesh& mesh, const std::vector<int>& nodes) {
  std::vector<char> in(mesh.nodes.size(), 0);
  for (int node : nodes) in[node] = 1;
  return in;
}

std::vector<char> nodes_of_set(std::string_view where, const Mesh& mesh, const std::string& set) {
  if (const auto found = mesh.node_sets.find(set); found != mesh.node_sets.end())
    return marked(mesh, found->second);
  if (const auto found = mesh.surfaces.find(set); found != mesh.surfaces.end())
    return marked(mesh, found->second.nodes());
  const auto found = mesh.element_sets.find(set);
  if (found == mesh.element_sets.end()) refuse_unknown_set(where, mesh, set);
  std::vector<char> in(mesh.nodes.size(), 0);
  for (int element : found->second)
    for (int node : mesh.element_nodes(element)) in[node] = 1;
  return in;
}

/// Nodes of a selection by coordinates.
template <class Holds>
std::vector<char> nodes_where(const Mesh& mesh, const Holds& holds) {
  std::vector<char> in(mesh.nodes.size());
  std::transform(mesh.nodes.begin(), mesh.nodes.end(), in.begin(),
                 [&](const Vec3& X) { return static_cast<char>(holds(X)); });
  return in;
}

/// Nodes in a plane. At an extent: that of the nodes of elements.
std::vector<char> nodes_at_plane(std::string_view where, const Mesh& mesh, const Selection& s,
                                 double tolerance) {
  if (!(std::abs(s.normal.norm() - 1.0) < 1e-6))
    throw InputError(where, format("{} is no unit normal", point_text(s.normal)),
                     "Give a vector that is not zero");
  double level = s.value;
  if (s.level != Level::kValue) {
    const bool least = s.level == Level::kMin;
    level = std::numeric_limits<double>::infinity() * (least ? 1.0 : -1.0);
    for (const ElementBlock& block : mesh.blocks)
      for (int node : block.nodes) {
        const double height = s.normal.dot(mesh.nodes[node]);
        level = least ? std::min(level, height) : std::max(level, height);
      }
  }
  return nodes_where(mesh,
                     [&](const Vec3& X) { return std::abs(s.normal.dot(X) - level) <= tolerance; });
}

std::vector<char> nodes_of(std::string_view where, const Mesh& mesh, const Selection& s) {
  const double tolerance = s.tolerance > 0.0 ? s.tolerance : kTolerance * extent(mesh).size();
  switch (s.kind) {
    case Kind::kAll:
      return std::vector<char>(mesh.nodes.size(), 1);
    case Kind::kSet:
      return nodes_of_set(where, mesh, s.set);
    case Kind::kPlane:
      return nodes_at_plane(where, mesh, s, tolerance);
    case Kind::kBox:
      return nodes_where(mesh, [&](const Vec3& X) {
        return ((X - s.least).array() >= -tolerance).all() &&
               ((s.most - X).array() >= -tolerance).all();
      });
    case Kind::kSphere:
      return nodes_where(mesh, [&](const Vec3& X) {
        const double depth = s.radius - (X - s.centre).norm();
        return s.on_surface ? std::abs(depth) <= tolerance : depth >= -tolerance;
      });
    case Kind::kNodes:
      for (int node : s.nodes)
        if (node < 0 || node >= static_cast<int>(mesh.nodes.size()))
          throw InputError(where, format("node {} does not exist", node),
                           format("The mesh has {} nodes; the first is 0", mesh.nodes.size()));
      return marked(mesh, s.nodes);
  }
  return {};
}

/// Distance by which a selection misses, where that helps.
std::string miss(const Mesh& mesh, const Selection& s) {
  if (s.kind == Kind::kSet || s.kind == Kind::kNodes) return {};
  const auto distance = [&](const Vec3& X) {
    if (s.kind == Kind::kPlane) return std::abs(s.normal.dot(X) - s.value);
    if (s.kind == Kind::kBox) return (X - X.cwiseMax(s.least).cwiseMin(s.most)).norm();
    const double depth = s.radius - (X - s.centre).norm();
    return s.on_surface ? std::abs(depth) : std::max(-depth, 0.0);
  };
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& X : mesh.nodes) least = std::min(least, distance(X));
  return format("; the nearest node is {:.3g} m away", least);
}

}  // namespace

std::vector<int> select_nodes(std::string_view where, const Mesh& mesh,
                              const std::vector<Selection>& selections) {
  const std::vector<Selection> all{Selection{}};
  std::vector<char> in(mesh.nodes.size(), 0);
  for (const Selection& selection : selections.empty() ? all : selections) {
    const std::vector<char> one = nodes_of(where, mesh, selection);
    if (std::count(one.begin(), one.end(), 1) == 0)
      throw InputError(
          where,
          format("{} holds no node of the mesh{}", description(selection), miss(mesh, selection)),
          extent_text(mesh));
    for (std::size_t i = 0; i < in.size(); ++i) in[i] |= one[i];
  }
  std::vector<int> nodes;
  for (int i = 0; i < static_cast<int>(in.size()); ++i)
    if (in[i]) nodes.push_back(i);
  return nodes;
}

std::vector<int> select_elements(std::string_view where, const Mesh& mesh,
                                 const std::vector<Selection>& selections) {
  std::set<int> taken;
  for (const Selection& selection : selections) {
    if (selection.kind == Kind::kSet && !mesh.node_sets.contains(selection.set)) {
      const auto found = mesh.element_sets.find(selection.set);
      if (found != mesh.element_sets.end()) {
        taken.insert(found->second.begin(), found->second.end());
        continue;
      }
    }
    const std::vector<int> nodes = select_nodes(where, mesh, {selection});
    const std::vector<char> in = marked(mesh, nodes);
    int element = 0;
    bool any = false;
    for (const ElementBlock& block : mesh.blocks) {
      const std::size_t n = block.shape().nodes.size();
      for (std::size_t e = 0; e < block.nodes.size(); e += n, ++element) {
        const auto own = std::span<const int>(block.nodes).subspan(e, n);
        if (!std::all_of(own.begin(), own.end(), [&](int node) { return in[node]; })) continue;
        taken.insert(element);
        any = true;
      }
    }
    if (!any)
      throw InputError(
          where,
          format("{} holds {} {} of the mesh, but no whole element", description(selection),
                 nodes.size(), nodes.size() == 1 ? "node" : "nodes"),
          extent_text(mesh));
  }
  return {taken.begin(), taken.end()};
}

Surface select_faces(std::string_view where, const Mesh& mesh,
                     const std::vector<Selection>& selections) {
  const std::vector<Selection> all{Selection{}};
  std::set<std::vector<int>> taken;  // nodes of the faces, ascending
  Surface result;
  const auto take = [&](const Surface& faces, const std::vector<char>* in) {
    int count = 0;
    for (const FaceBlock& block : faces.blocks) {
      const std::size_t n = block.shape().nodes.size();
      for (std::size_t f = 0; f < block.owners.size(); ++f) {
        const auto nodes = std::span<const int>(block.nodes).subspan(n * f, n);
        if (in && !std::all_of(nodes.begin(), nodes.end(), [&](int node) { return (*in)[node]; }))
          continue;
        ++count;
        std::vector<int> key(nodes.begin(), nodes.end());
        std::sort(key.begin(), key.end());
        if (taken.insert(std::move(key)).second) result.add(block.type, nodes, block.owners[f]);
      }
    }
    return count;
  };
  const Surface outside = boundary(mesh);
  for (const Selection& selection : selections.empty() ? all : selections) {
    if (selection.kind == Kind::kSet) {
      const auto found = mesh.surfaces.find(selection.set);
      if (found != mesh.surfaces.end()) {
        take(found->second, nullptr);
        continue;
      }
    }
    const std::vector<int> nodes = select_nodes(where, mesh, {selection});
    const std::vector<char> in = marked(mesh, nodes);
    if (take(outside, &in) == 0)
      throw InputError(
          where,
          format("{} holds {} {} of the mesh, but no whole face of its boundary",
                 description(selection), nodes.size(), nodes.size() == 1 ? "node" : "nodes"),
          extent_text(mesh));
  }
  return result;
}

}  // namespace polhode::solids
