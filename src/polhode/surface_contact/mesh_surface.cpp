// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <span>

#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode::surface_contact {

void MeshPoint::add(int number, double weight) {
  if (weight == 0.0) return;
  for (int a = 0; a < count; ++a)
    if (node[a] == number) {
      N[a] += weight;
      return;
    }
  node[count] = number;
  N[count++] = weight;
}

namespace {

/// Shape functions at the centre of a face without a centre node: corners and midside nodes.
constexpr double kCorner4 = 0.25, kCorner8 = -0.25, kEdge8 = 0.5;

class Triangulation {
 public:
  void add(const std::string& shape, std::span<const int> n) {
    if (shape == "tri3") {
      triangle(n[0], n[1], n[2]);
    } else if (shape == "tri6") {
      triangle(n[0], n[3], n[5]);
      triangle(n[3], n[1], n[4]);
      triangle(n[5], n[4], n[2]);
      triangle(n[3], n[4], n[5]);
    } else if (shape == "tri7") {
      fan_of_faces({n[0], n[3], n[1], n[4], n[2], n[5]}, vertex(n[6]));
    } else if (shape == "quad4") {
      MeshSurface::Face face{4, {}, static_cast<int>(surface_.triangles.size())};
      for (std::size_t k = 0; k < 4; ++k) face.vertex[k] = vertex(n[k]);
      fan({n[0], n[1], n[2], n[3]}, middle(n));
      surface_.faces.push_back(face);
    } else {
      fan_of_faces({n[0], n[4], n[1], n[5], n[2], n[6], n[3], n[7]},
                   shape == "quad9" ? vertex(n[8]) : middle(n));
    }
  }
  MeshSurface take() { return std::move(surface_); }

 private:
  int vertex(int node) {
    const auto [it, fresh] = known_.try_emplace(node, static_cast<int>(surface_.vertices.size()));
    if (fresh) {
      surface_.vertices.emplace_back();
      surface_.vertices.back().add(node, 1.0);
    }
    return it->second;
  }
  int middle(std::span<const int> n) {
    MeshPoint m;
    const bool edges = n.size() == 8;
    for (std::size_t k = 0; k < 4; ++k) m.add(n[k], edges ? kCorner8 : kCorner4);
    for (std::size_t k = 4; edges && k < 8; ++k) m.add(n[k], kEdge8);
    surface_.vertices.push_back(m);
    return static_cast<int>(surface_.vertices.size()) - 1;
  }
  void triangle(int a, int b, int c) { face(vertex(a), vertex(b), vertex(c)); }
  void face(int a, int b, int c) {
    surface_.faces.push_back({3, {a, b, c, -1}, static_cast<int>(surface_.triangles.size())});
    surface_.triangles.push_back({a, b, c});
  }
  void fan_of_faces(const std::vector<int>& around, int centre) {
    for (std::size_t k = 0; k < around.size(); ++k)
      face(vertex(around[k]), vertex(around[(k + 1) % around.size()]), centre);
  }
  void fan(const std::vector<int>& around, int centre) {
    for (std::size_t k = 0; k < around.size(); ++k)
      surface_.triangles.push_back(
          {vertex(around[k]), vertex(around[(k + 1) % around.size()]), centre});
  }

  MeshSurface surface_;
  std::map<int, int> known_;
};

}  // namespace

MeshSurface triangulated(const std::vector<solids::LoadedFaces>& faces) {
  Triangulation t;
  for (const solids::LoadedFaces& block : faces) {
    const auto n = static_cast<std::size_t>(block.shape[block.shape.size() - 1] - '0');
    for (std::size_t first = 0; first < block.nodes.size(); first += n)
      t.add(block.shape, std::span(block.nodes).subspan(first, n));
  }
  return t.take();
}

}  // namespace polhode::surface_contact
