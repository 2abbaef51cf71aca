// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode::solids {

/// Forces on nodes that do not depend on the positions of the nodes: f_i = B_i v(t), with a
/// constant matrix for each node. The work at t_{n+αf} over a step is f·u exactly.
class DeadLoad final : public ElementGroup {
 public:
  struct Share {
    int node;
    Mat3 B;  ///< Multiplied by the vector of the load.
    Vec3 X;  ///< Position of zero potential [m].
  };

  DeadLoad(std::string kind, std::string name, std::vector<Share> shares, TimeVector value)
      : kind_(std::move(kind)),
        name_(std::move(name)),
        shares_(std::move(shares)),
        value_(std::move(value)) {
    for (const TimeFunctionPtr& f : value_) constant_ = constant_ && (!f || f->is_constant());
  }

  std::string kind() const override { return kind_; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(shares_.size()); }
  int nodes_per_element() const override { return 1; }
  std::span<const int> nodes(int element) const override { return {&shares_[element].node, 1}; }
  bool has_tangent() const override { return false; }
  bool conservative() const override { return constant_; }
  bool external() const override { return true; }
  std::vector<TimeFunctionPtr> time_functions() const override {
    return {value_.begin(), value_.end()};
  }

  ElementReport evaluate(const NodeStep& step, const double* /*history*/, double* /*scratch*/,
                         const Mat3& /*turn*/, const ElementSink& sink) const override {
    const Vec3 v = value(step);
    for (const Share& s : shares_)
      Eigen::Map<Vec3>(sink.force + 3 * static_cast<std::ptrdiff_t>(s.node)) += s.B * v;
    return {};
  }

  Work work(const NodeStep& step, const double* /*history*/,
            const double* /*scratch*/) const override {
    const Vec3 v = value(step);
    double sum = 0.0;
    for (const Share& s : shares_)
      sum += (s.B * v).dot(constant_ ? Vec3(NodeStep::at(step.x_n1, s.node) - s.X)
                                     : Vec3(NodeStep::at(step.u, s.node)));
    if (constant_) return {.stored = -sum};
    return {.put_in = step.x_n == step.x_n1 ? 0.0 : sum};
  }

 private:
  [[nodiscard]] Vec3 value(const NodeStep& step) const {
    const double t = step.context.t_alpha();
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = value_[i] ? (*value_[i])(t) : 0.0;
    return step.context.load_factor * v;
  }

  std::string kind_, name_;
  std::vector<Share> shares_;
  TimeVector value_;
  bool constant_ = true;
};

/// Shares of a dead load, summed by node and ascending.
class NodeShares {
 public:
  /// @param X  Reference positions of all nodes [m], which must outlive this.
  explicit NodeShares(std::span<const Vec3> X) : X_(X) {}
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

}  // namespace polhode::solids
