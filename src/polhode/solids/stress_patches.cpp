// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Eigenvalues>

#include <polhode/math/dense.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/stress_patches.hpp>

namespace polhode::solids {

namespace {

/// Smallest variance of a polynomial over the points of a patch for which it is determined by them.
/// Two elements side by side have 0.75 for the square of a direction, one has none.
constexpr double kMinVariance = 0.05;
/// Spread of points, as a part of the largest, below which they lie in a plane.
constexpr double kFlat = 1e-6;
/// Sine of the angle up to which a face of the boundary continues another one: faces of a circle of
/// ten elements do.
constexpr double kNewDirection = 0.6;
/// Volume of unit direction vectors below which they are nearly coplanar.
constexpr double kFlatCorner = 0.2;

/// Powers of the monomials by degree: of complete polynomials, and of all products of squares.
constexpr int kComplete[10][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0},
                                  {0, 2, 0}, {0, 0, 2}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}};
constexpr int kProducts[27][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {0, 2, 0},
                                  {0, 0, 2}, {1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {2, 1, 0}, {2, 0, 1},
                                  {1, 2, 0}, {0, 2, 1}, {1, 0, 2}, {0, 1, 2}, {1, 1, 1}, {2, 2, 0},
                                  {0, 2, 2}, {2, 0, 2}, {2, 1, 1}, {1, 2, 1}, {1, 1, 2}, {2, 2, 1},
                                  {2, 1, 2}, {1, 2, 2}, {2, 2, 2}};
/// First monomial of each degree.
constexpr int kFirstComplete[] = {0, 1, 4, 10};
constexpr int kFirstProduct[] = {0, 1, 4, 10, 17, 23, 26, 27};
/// By power: its factorial.
constexpr double kFactorial[] = {1.0, 1.0, 2.0};

/// The linear cell with the same corners.
const CellShape& linear_shape(const CellShape& shape) {
  return cell_shape(shape.corners == 8 ? "hex8" : shape.corners == 6 ? "wedge6" : "tet4");
}

/// Superconvergent points, at which the stress of an element is one order more accurate: those of
/// the rule with the fewest points without spurious modes (J. Barlow, Int. J. Numer. Methods Engrg.
/// 10 (1976) 243-251).
Quadrature best_points(const CellShape& shape) {
  if (shape.corners == 8) return hexahedron_rule(2);
  return tetrahedron_rule(shape.order == 2 ? 2 : 1);
}

/// Values at the superconvergent points from those at the nodes of another shape, points × nodes.
Mat at_best_points(const CellShape& shape, const CellShape& nodes) {
  const Quadrature rule = best_points(shape);
  Mat N(static_cast<Eigen::Index>(rule.size()), nodes.size());
  for (Eigen::Index q = 0; q < N.rows(); ++q)
    N.row(q) = shape_functions(nodes, rule[static_cast<std::size_t>(q)].xi).transpose();
  return N;
}

}  // namespace

CloudFit::CloudFit(std::span<const Vec3> points, int order, const Mat3* directions) {
  const auto count = static_cast<double>(points.size());
  for (const Vec3& X : points) mean_ += X / count;
  Mat3 spread = Mat3::Zero();
  for (const Vec3& X : points) spread += (X - mean_) * (X - mean_).transpose() / count;
  Mat3 to_axes;
  if (directions) {
    to_axes = directions->inverse();
  } else {
    to_axes = eigen_of_symmetric(spread).vectors.transpose();
  }
  const Vec3 variance = (to_axes * spread * to_axes.transpose()).diagonal().cwiseMax(0.0);
  for (int c = 0; c < 3; ++c)
    if (directions || variance[c] > kFlat * kFlat * variance.maxCoeff())
      to_own_.row(c) = to_axes.row(c) / std::sqrt(variance[c]);

  products_ = directions != nullptr;
  const int degrees = products_ ? 6 : order;
  const int* const first_of = products_ ? kFirstProduct : kFirstComplete;
  basis_.resize(first_of[degrees + 1], 0);
  Mat gram = Mat::Zero(basis_.rows(), basis_.rows());
  for (const Vec3& X : points) {
    const Vec m = monomials(X);
    gram += m * m.transpose();
  }
  for (int degree = 0; degree <= degrees; ++degree) {
    const int first = first_of[degree], columns = first_of[degree + 1] - first;
    Mat rest = Mat::Zero(basis_.rows(), columns);
    rest.middleRows(first, columns).setIdentity();
    rest -= basis_ * (basis_.transpose() * (gram * rest));
    const Eigen::SelfAdjointEigenSolver<Mat> own(Mat(rest.transpose() * gram * rest));
    for (int k = columns - 1; k >= 0; --k) {
      if (!(own.eigenvalues()[k] > kMinVariance * count)) continue;
      const Vec column = rest * own.eigenvectors().col(k) / std::sqrt(own.eigenvalues()[k]);
      basis_.conservativeResize(Eigen::NoChange, basis_.cols() + 1);
      basis_.rightCols<1>() = column;
    }
  }
}

Vec CloudFit::monomials(const Vec3& X) const {
  const Vec3 y = to_own_ * (X - mean_);
  Vec m(basis_.rows());
  for (Eigen::Index k = 0; k < m.size(); ++k) {
    const int* const powers = products_ ? kProducts[k] : kComplete[k];
    int degree = 0;
    double weight = 1.0;
    m[k] = 1.0;
    for (int c = 0; c < 3; ++c) {
      for (int power = 0; power < powers[c]; ++power) m[k] *= y[c];
      degree += powers[c];
      weight /= kFactorial[powers[c]];
    }
    // Multinomial, so that a rotation preserves the sum of squares of a degree.
    if (!products_) m[k] *= std::sqrt(weight * kFactorial[degree]);
  }
  return m;
}

bool StressPatches::suit(const Mesh& mesh) {
  return std::all_of(mesh.blocks.begin(), mesh.blocks.end(), [](const ElementBlock& block) {
    return block.type == "hex20" || block.type == "hex27" || block.type == "tet4" ||
           block.type == "tet10";
  });
}

StressPatches::StressPatches(const Mesh& mesh) : mesh_(mesh) {
  place_points();
  find_patches();
}

std::span<const int> StressPatches::corners(int element) const {
  return mesh_.element_nodes(element).first(
      static_cast<std::size_t>(mesh_.element_shape(element).corners));
}

void StressPatches::place_points() {
  std::vector<Mat> by_nodes;
  for (const ElementBlock& block : mesh_.blocks) {
    interpolation_.push_back(at_best_points(block.shape(), linear_shape(block.shape())));
    by_nodes.push_back(at_best_points(block.shape(), block.shape()));
  }
  around_.resize(mesh_.nodes.size());
  first_point_ = {0};
  for (int e = 0; e < mesh_.element_count(); ++e) {
    const Mat& N = by_nodes[static_cast<std::size_t>(mesh_.place(e).block)];
    const std::span<const int> nodes = mesh_.element_nodes(e);
    for (Eigen::Index q = 0; q < N.rows(); ++q) {
      Vec3 X = Vec3::Zero();
      for (std::size_t a = 0; a < nodes.size(); ++a)
        X += N(q, static_cast<Eigen::Index>(a)) * mesh_.nodes[static_cast<std::size_t>(nodes[a])];
      place_.push_back(X);
    }
    first_point_.push_back(static_cast<int>(place_.size()));
    for (const int corner : corners(e)) around_[static_cast<std::size_t>(corner)].push_back(e);
  }
}

/// Number of independent normals of the boundary faces at each node: 0 inside, 1 on a
/// face, 2 on an edge, 3 at a corner.
std::vector<int> StressPatches::boundary_ranks() const {
  std::vector<std::vector<Vec3>> kept(mesh_.nodes.size());  // orthonormal directions
  for (const FaceBlock& block : boundary(mesh_).blocks) {
    const auto size = static_cast<std::size_t>(block.shape().size());
    const auto count = static_cast<std::size_t>(block.shape().corners);
    for (std::size_t f = 0; f + size <= block.nodes.size(); f += size) {
      const auto X = [&](std::size_t k) {
        return mesh_.nodes[static_cast<std::size_t>(block.nodes[f + k])];
      };
      const Vec3 normal =
          (count == 4 ? (X(2) - X(0)).cross(X(3) - X(1)) : (X(1) - X(0)).cross(X(2) - X(0)))
              .normalized();
      for (std::size_t k = 0; k < count; ++k) {
        std::vector<Vec3>& directions = kept[static_cast<std::size_t>(block.nodes[f + k])];
        Vec3 rest = normal;
        for (const Vec3& d : directions) rest -= d.dot(rest) * d;
        if (rest.norm() > kNewDirection) directions.push_back(rest.normalized());
      }
    }
  }
  std::vector<int> ranks;
  for (const auto& directions : kept) ranks.push_back(static_cast<int>(directions.size()));
  return ranks;
}

/// Directions of the edges at a vertex, if all elements around it are hexahedra that form a
/// lattice: of edges that continue straight beyond the vertex, the one through it.
std::optional<Mat3> StressPatches::directions(int vertex) const {
  const std::vector<int>& elements = around_[static_cast<std::size_t>(vertex)];
  std::map<int, std::vector<int>> neighbours;  // by node, with the elements they share
  for (const int e : elements) {
    const CellShape& shape = mesh_.element_shape(e);
    if (shape.corners != 8) return std::nullopt;
    const std::span<const int> nodes = corners(e);
    for (const CellEdge& edge : shape.edges) {
      const int a = nodes[static_cast<std::size_t>(edge.begin)];
      const int b = nodes[static_cast<std::size_t>(edge.end)];
      if (a == vertex) neighbours[b].push_back(e);
      if (b == vertex) neighbours[a].push_back(e);
    }
  }
  const auto X = [&](int node) { return mesh_.nodes[static_cast<std::size_t>(node)]; };
  std::vector<Vec3> found;
  std::size_t pairs = 0;
  for (const auto& [node, own] : neighbours) {
    Vec3 from = X(vertex);
    bool first = true;
    int opposite = 0;
    for (const auto& [other, theirs] : neighbours) {
      if (other == node ||
          std::find_first_of(own.begin(), own.end(), theirs.begin(), theirs.end()) != own.end())
        continue;
      from = X(other);
      first = node < other;
      ++opposite;
    }
    if (opposite > 1) return std::nullopt;
    if (!first) continue;
    pairs += static_cast<std::size_t>(opposite);
    found.emplace_back((X(node) - from).normalized());
  }
  if (found.size() != 3 || elements.size() != std::size_t{1} << pairs) return std::nullopt;
  Mat3 result;
  for (int c = 0; c < 3; ++c) result.col(c) = found[static_cast<std::size_t>(c)];
  if (std::abs(result.determinant()) < kFlatCorner) return std::nullopt;
  return result;
}

/// Vertices whose polynomials are used at a vertex: itself, or those of its neighbours deepest
/// inside the solid, among these the ones with which it shares most elements.
std::vector<int> StressPatches::donors(int vertex, const std::vector<int>& rank) const {
  std::map<int, int> shared;
  for (const int e : around_[static_cast<std::size_t>(vertex)])
    for (const int v : corners(e)) ++shared[v];
  int least = rank[static_cast<std::size_t>(vertex)], most = 0;
  std::vector<int> found{vertex};
  for (const auto& [v, count] : shared) {
    const int own = rank[static_cast<std::size_t>(v)];
    if (own > least || (own == least && (most == 0 || count < most))) continue;
    if (own < least || count > most) found.clear();
    least = own;
    most = count;
    found.push_back(v);
  }
  return found;
}

void StressPatches::find_patches() {
  const std::vector<int> rank = boundary_ranks();
  std::vector<int> patch_of(mesh_.nodes.size(), -1);
  const auto patch = [&](int vertex) {
    int& index = patch_of[static_cast<std::size_t>(vertex)];
    if (index >= 0) return index;
    index = static_cast<int>(patches_.size());
    const std::vector<int>& elements = around_[static_cast<std::size_t>(vertex)];
    std::vector<Vec3> cloud;
    int order = 1;
    for (const int e : elements) {
      order = std::max(order, mesh_.element_shape(e).order);
      cloud.insert(cloud.end(), place_.begin() + first_point_[static_cast<std::size_t>(e)],
                   place_.begin() + first_point_[static_cast<std::size_t>(e) + 1]);
    }
    const std::optional<Mat3> along = directions(vertex);
    // On edges of tetrahedra squares would follow the errors of one-sided elements.
    if (!along && rank[static_cast<std::size_t>(vertex)] > 1) order = 1;
    patches_.push_back({elements, CloudFit(cloud, order, along ? &*along : nullptr)});
    return index;
  };
  std::vector<std::vector<int>> known(mesh_.nodes.size());
  const auto donors_of = [&](int vertex) -> const std::vector<int>& {
    std::vector<int>& list = known[static_cast<std::size_t>(vertex)];
    if (list.empty()) list = donors(vertex, rank);
    return list;
  };
  shares_.resize(mesh_.nodes.size());
  for (int e = 0; e < mesh_.element_count(); ++e) {
    const CellShape& shape = mesh_.element_shape(e);
    const std::span<const int> nodes = mesh_.element_nodes(e);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      std::vector<Share>& shares = shares_[static_cast<std::size_t>(nodes[a])];
      if (!shares.empty()) continue;
      // A node between vertices takes their interpolated values.
      const Vec N = shape_functions(linear_shape(shape), shape.nodes[a]);
      std::map<int, double> sum;
      for (int c = 0; c < shape.corners; ++c) {
        if (std::abs(N[c]) < 1e-9) continue;
        const std::vector<int>& from = donors_of(nodes[static_cast<std::size_t>(c)]);
        for (const int v : from) sum[patch(v)] += N[c] / static_cast<double>(from.size());
      }
      for (const auto& [index, weight] : sum) shares.push_back({index, weight});
    }
  }
}

RecoveredValues StressPatches::at_nodes(const RecoveredValues& at_corners) const {
  RecoveredValues at_points(static_cast<Eigen::Index>(place_.size()), kRecovered);
  Eigen::Index corner = 0;
  for (int e = 0; e < mesh_.element_count(); ++e) {
    const Mat& N = interpolation_[static_cast<std::size_t>(mesh_.place(e).block)];
    at_points.middleRows(first_point_[static_cast<std::size_t>(e)], N.rows()) =
        N * at_corners.middleRows(corner, N.cols());
    corner += N.cols();
  }
  std::vector<CloudFit::Coefficients> polynomials;
  polynomials.reserve(patches_.size());
  for (const Patch& patch : patches_) {
    CloudFit::Coefficients moments = CloudFit::Coefficients::Zero(patch.fit.size(), kRecovered);
    for (const int e : patch.elements)
      for (int q = first_point_[static_cast<std::size_t>(e)];
           q < first_point_[static_cast<std::size_t>(e) + 1]; ++q)
        moments += patch.fit.monomials(place_[static_cast<std::size_t>(q)]) * at_points.row(q);
    polynomials.push_back(patch.fit.coefficients(moments));
  }
  RecoveredValues values =
      RecoveredValues::Zero(static_cast<Eigen::Index>(mesh_.nodes.size()), kRecovered);
  for (std::size_t i = 0; i < shares_.size(); ++i)
    for (const Share& share : shares_[i]) {
      const auto p = static_cast<std::size_t>(share.patch);
      values.row(static_cast<Eigen::Index>(i)) +=
          share.weight * patches_[p].fit.monomials(mesh_.nodes[i]).transpose() * polynomials[p];
    }
  return values;
}

}  // namespace polhode::solids
