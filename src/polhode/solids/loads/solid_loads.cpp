// SPDX-License-Identifier: Apache-2.0
#include <map>

#include <Eigen/LU>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/elements/reference_data.hpp>
#include <polhode/solids/loads/dead_load.hpp>
#include <polhode/solids/loads/follower_pressure.hpp>
#include <polhode/solids/loads/solid_loads.hpp>

namespace polhode {
namespace {

/// Accumulated shares of nodes, ascending by node.
class Shares {
 public:
  explicit Shares(std::span<const Vec3> X) : X_(X) {}
  void add(int node, const Mat3& B) {
    const auto [at, is_new] = sum_.try_emplace(node, B);
    if (!is_new) at->second += B;
  }
  [[nodiscard]] std::vector<DeadLoad::Share> all() const {
    std::vector<DeadLoad::Share> shares;
    for (const auto& [node, B] : sum_) shares.push_back({node, B, X_[node]});
    return shares;
  }

 private:
  std::span<const Vec3> X_;
  std::map<int, Mat3> sum_;
};

void check_faces(const std::string& name, std::span<const LoadedFaces> faces) {
  std::size_t count = 0;
  for (const LoadedFaces& f : faces) {
    (void)face_rule(f.shape);
    if (f.nodes.size() % static_cast<std::size_t>(cell_shape(f.shape).size()) != 0)
      throw InputError(name,
                       format("{} node numbers do not form faces {}", f.nodes.size(), f.shape),
                       "Give all nodes of each face");
    count += f.nodes.size();
  }
  if (count == 0)
    throw InputError(name, "there are no faces to load",
                     "Choose faces on the boundary of the solid");
}

/// Calls use(node, N_a w, outward vector area) for the points of undeformed faces.
template <class Use>
void each_point(std::span<const LoadedFaces> faces, std::span<const Vec3> X, const Use& use) {
  for (const LoadedFaces& f : faces) {
    const CellShape& shape = cell_shape(f.shape);
    const int n = shape.size();
    for (const QuadraturePoint& q : face_rule(f.shape)) {
      const Vec N = shape_functions(shape, q.xi);
      const Mat D = shape_gradients(shape, q.xi);
      for (std::size_t first = 0; first < f.nodes.size(); first += n) {
        const Mat3 J = reference_jacobian(D, std::span(f.nodes).subspan(first, n), X);
        const Vec3 area = J.col(0).cross(J.col(1));
        for (int a = 0; a < n; ++a) use(f.nodes[first + a], N[a] * q.weight, area);
      }
    }
  }
}

}  // namespace

std::unique_ptr<ElementGroup> make_nodal_force(std::string name, const std::vector<int>& nodes,
                                               std::span<const Vec3> X, TimeVector force) {
  if (nodes.empty())
    throw InputError(name, "there are no nodes to load", "Choose at least one node");
  Shares shares(X);
  for (const int node : nodes) shares.add(node, Mat3::Identity());
  return std::make_unique<DeadLoad>("force on nodes", std::move(name), shares.all(),
                                    std::move(force));
}

std::unique_ptr<ElementGroup> make_traction(std::string name, std::span<const LoadedFaces> faces,
                                            std::span<const Vec3> X, TimeVector traction) {
  check_faces(name, faces);
  Shares shares(X);
  each_point(faces, X, [&](int node, double w, const Vec3& area) {
    shares.add(node, w * area.norm() * Mat3::Identity());
  });
  return std::make_unique<DeadLoad>("traction", std::move(name), shares.all(), std::move(traction));
}

std::unique_ptr<ElementGroup> make_dead_pressure(std::string name,
                                                 std::span<const LoadedFaces> faces,
                                                 std::span<const Vec3> X,
                                                 TimeFunctionPtr pressure) {
  check_faces(name, faces);
  Shares shares(X);
  each_point(faces, X, [&](int node, double w, const Vec3& area) {
    // The value is in the first component of the vector.
    Mat3 B = Mat3::Zero();
    B.col(0) = -w * area;
    shares.add(node, B);
  });
  return std::make_unique<DeadLoad>("pressure", std::move(name), shares.all(),
                                    TimeVector{std::move(pressure), nullptr, nullptr});
}

std::vector<std::unique_ptr<ElementGroup>> make_follower_pressure(
    const std::string& name, std::span<const LoadedFaces> faces, const TimeFunctionPtr& pressure,
    FollowerRule rule) {
  check_faces(name, faces);
  std::vector<std::unique_ptr<ElementGroup>> groups;
  for (const LoadedFaces& f : faces)
    if (!f.nodes.empty())
      groups.push_back(std::make_unique<FollowerPressure>(name, f, pressure, rule));
  return groups;
}

std::unique_ptr<ElementGroup> make_body_force(std::string name, const std::string& element,
                                              std::span<const int> connectivity,
                                              std::span<const Vec3> X, TimeVector force,
                                              double factor) {
  const ElementKind& kind = element_kind(element);
  const CellShape& shape = kind.cell();
  const std::size_t n = static_cast<std::size_t>(shape.size());
  if (connectivity.empty() || connectivity.size() % n != 0)
    throw InputError(name, "there are no whole elements to load", "Give all nodes of each element");
  std::map<int, double> weights;
  for (const QuadraturePoint& q : kind.mass) {
    const Vec N = shape_functions(shape, q.xi);
    const Mat D = shape_gradients(shape, q.xi);
    for (std::size_t first = 0; first < connectivity.size(); first += n) {
      const std::span<const int> own = connectivity.subspan(first, n);
      const double volume = q.weight * reference_jacobian(D, own, X).determinant();
      for (std::size_t a = 0; a < n; ++a)
        weights[own[a]] += factor * volume * N[static_cast<Eigen::Index>(a)];
    }
  }
  Shares shares(X);
  for (const auto& [node, w] : weights) shares.add(node, w * Mat3::Identity());
  return std::make_unique<DeadLoad>("body force", std::move(name), shares.all(), std::move(force));
}

}  // namespace polhode
