// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/loads/pair_on_nodes.hpp>
#include <polhode/loads/spring_damper.hpp>

namespace polhode {

namespace {

template <class Item>
std::unique_ptr<PairOnNodes> make_item_on_nodes(const LoadDescription& load,
                                                std::array<NodePoint, 2> points) {
  return std::make_unique<ItemOnNodes<Item>>(load, std::move(points));
}

}  // namespace

MakeOnNodes make_on_nodes(std::string_view type) {
  if (type == SpringDamper::kKind) return make_item_on_nodes<SpringDamper>;
  if (type == PotentialForce::kKind) return make_item_on_nodes<PotentialForce>;
  if (type == AxialForce::kKind) return make_item_on_nodes<AxialForce>;
  return nullptr;
}

void refuse_rows_on_nodes(const std::string& load) {
  throw InputError(
      format("loads.{}", load), "has a damper that jumps, and an end on a solid",
      "Let the force of the damper rise over a short range of rates, or end on bodies");
}

PointPair::PointPair(std::array<NodePoint, 2> points) : points_(std::move(points)) {
  for (std::size_t p = 0; p < 2; ++p)
    for (std::size_t k = 0; k < points_[p].nodes.size(); ++k) {
      const int node = points_[p].nodes[k];
      const auto found = std::find(nodes_.begin(), nodes_.end(), node);
      const auto place = static_cast<std::size_t>(found - nodes_.begin());
      if (found == nodes_.end()) {
        nodes_.push_back(node);
        weights_.push_back({});
      }
      weights_[place][p] += points_[p].weights[k];
    }
}

BodyStep PointPair::motion(const NodeStep& step, int point) const {
  BodyStep s;
  s.alpha_f = step.alpha_f;
  s.rate = step.rate;
  const NodePoint& p = points_[static_cast<std::size_t>(point)];
  for (std::size_t k = 0; k < p.nodes.size(); ++k) {
    const int node = p.nodes[k];
    const double w = p.weights[k];
    s.r_n += w * NodeStep::at(step.x_n, node);
    s.r_n1 += w * NodeStep::at(step.x_n1, node);
    s.u += w * NodeStep::at(step.u, node);
    s.v_n += w * NodeStep::at(step.v_n, node);
    s.v_n1 += w * NodeStep::at(step.v_n1, node);
  }
  return s;
}

void PointPair::add(const PairTerms& terms, const ElementSink& sink) const {
  const std::array<Vec3, 2> F{terms.wrench_a.head<3>(), terms.wrench_b.head<3>()};
  const std::array<std::array<Mat3, 2>, 2> D{
      {{terms.D_aa.topLeftCorner<3, 3>(), terms.D_ab.topLeftCorner<3, 3>()},
       {terms.D_ba.topLeftCorner<3, 3>(), terms.D_bb.topLeftCorner<3, 3>()}}};
  const std::size_t n = nodes_.size();
  std::vector<double> force(3 * n);
  for (std::size_t i = 0; i < n; ++i)
    Eigen::Map<Vec3>(force.data() + 3 * i) = weights_[i][0] * F[0] + weights_[i][1] * F[1];
  sink.add_force(nodes_, force.data());
  if (sink.tangent == nullptr) return;
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto size = static_cast<Eigen::Index>(3 * n);
  Matrix K = Matrix::Zero(size, size);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t p = 0; p < 2; ++p)
        for (std::size_t q = 0; q < 2; ++q)
          K.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) +=
              weights_[i][p] * weights_[j][q] * D[p][q];
  sink.add_tangent(0, static_cast<int>(n), K.data());
}

}  // namespace polhode
