// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <span>

#include <polhode/core/error.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/elements/reference_data.hpp>
#include <polhode/solids/mesh/shapes.hpp>
#include <polhode/surface_contact/surface_points.hpp>

namespace polhode::surface_contact {

namespace {

double area_of(const Mat3& J) { return J.col(0).cross(J.col(1)).norm(); }

bool has(const std::vector<int>& ascending, int node) {
  return std::binary_search(ascending.begin(), ascending.end(), node);
}

/// Calls visit(nodes of the face, shape functions, dA) at every Gauss point.
template <class Visit>
void for_gauss_points(const solids::LoadedFaces& faces, const std::vector<Vec3>& X, Visit&& visit) {
  const solids::CellShape& shape = solids::cell_shape(faces.shape);
  const auto n = static_cast<std::size_t>(shape.size());
  for (std::size_t first = 0; first < faces.nodes.size(); first += n) {
    const std::span<const int> own = std::span(faces.nodes).subspan(first, n);
    for (const solids::QuadraturePoint& q : solids::face_rule(faces.shape)) {
      const Vec N = solids::shape_functions(shape, q.xi);
      visit(own, N,
            q.weight *
                area_of(solids::reference_jacobian(solids::shape_gradients(shape, q.xi), own, X)));
    }
  }
}

void add_nodes(SurfacePoints& s, const solids::LoadedFaces& faces, const std::vector<Vec3>& X,
               const std::vector<int>& left_out) {
  std::map<int, double> area;
  for_gauss_points(faces, X, [&](std::span<const int> own, const Vec& N, double dA) {
    for (std::size_t a = 0; a < own.size(); ++a)
      area[own[a]] += N[static_cast<Eigen::Index>(a)] * dA;
  });
  for (const auto& [node, share] : area) {
    if (has(left_out, node)) continue;
    SurfacePoints::Point p;
    p.area = share;
    p.N[0] = 1.0;
    s.points.push_back(p);
    s.nodes.push_back(node);
  }
}

void add_gauss_points(SurfacePoints& s, const solids::LoadedFaces& faces,
                      const std::vector<Vec3>& X, const std::vector<int>& left_out) {
  s.nodes_per_point = solids::cell_shape(faces.shape).size();
  for_gauss_points(faces, X, [&](std::span<const int> own, const Vec& N, double dA) {
    if (std::all_of(own.begin(), own.end(), [&](int node) { return has(left_out, node); })) return;
    SurfacePoints::Point p;
    p.area = dA;
    for (std::size_t a = 0; a < own.size(); ++a) p.N[a] = N[static_cast<Eigen::Index>(a)];
    s.points.push_back(p);
    s.nodes.insert(s.nodes.end(), own.begin(), own.end());
  });
}

}  // namespace

SurfacePoints surface_points(const std::string& where, const solids::LoadedFaces& faces,
                             const std::vector<Vec3>& X, const std::vector<int>& left_out) {
  SurfacePoints s;
  const bool straight = faces.shape == "tri3" || faces.shape == "quad4";
  straight ? add_nodes(s, faces, X, left_out) : add_gauss_points(s, faces, X, left_out);
  if (s.points.empty())
    throw InputError(where, "there are no faces to touch", "Choose faces of the solid's boundary");
  return s;
}

double median_edge(const solids::LoadedFaces& faces, const std::vector<Vec3>& X) {
  const auto n = static_cast<std::size_t>(solids::cell_shape(faces.shape).size());
  const std::size_t corners = faces.shape.starts_with("tri") ? 3 : 4;
  std::vector<double> lengths;
  for (std::size_t first = 0; first < faces.nodes.size(); first += n)
    for (std::size_t k = 0; k < corners; ++k) {
      const auto corner = [&](std::size_t i) -> const Vec3& {
        return X[static_cast<std::size_t>(faces.nodes[first + i % corners])];
      };
      lengths.push_back((corner(k + 1) - corner(k)).norm());
    }
  if (lengths.empty()) return 0.0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

}  // namespace polhode::surface_contact
