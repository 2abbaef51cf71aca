// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Follower pressure, always normal to faces of one shape.
class FollowerPressure final : public ElementGroup {
 public:
  FollowerPressure(std::string name, const LoadedFaces& faces, TimeFunctionPtr pressure,
                   FollowerRule rule);

  std::string kind() const override { return "follower pressure"; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(nodes_.size()) / n_; }
  int nodes_per_element() const override { return n_; }
  std::span<const int> nodes(int element) const override {
    return std::span(nodes_).subspan(static_cast<std::size_t>(element) * n_, n_);
  }
  bool conservative() const override { return false; }
  bool external() const override { return true; }
  std::vector<TimeFunctionPtr> time_functions() const override { return {pressure_}; }

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  Work work(const NodeStep& step, const double* history, const double* scratch) const override;

 private:
  static constexpr int kMaxNodes = 9;
  using Forces = Eigen::Matrix<double, 3, kMaxNodes>;

  /// A point of the face: weight, shape functions and their derivatives.
  struct Point {
    double weight;
    double N[kMaxNodes], N_xi[kMaxNodes], N_eta[kMaxNodes];
  };

  [[nodiscard]] double pressure(const NodeStep& step) const;
  /// Adds −p ∫ N_a x_ξ × x_η at positions (1 − τ) x_n + τ x_{n+1}, times `weight`, and to K (n×n
  /// blocks) its derivative by x_{n+1}. @eq{solid-follower-pressure}
  void add(const NodeStep& step, int face, double tau, double p, Forces& f, double* K) const;
  void add_step(const NodeStep& step, int face, double p, Forces& f, double* K) const;

  std::string name_;
  int n_;
  std::vector<int> nodes_;
  TimeFunctionPtr pressure_;
  FollowerRule rule_;
  std::vector<Point> points_;
};

/// Pressure against the present outward normals and areas [Pa]: one group for each shape of face.
/// @param name  Path of the load in the user's model.
/// @throws InputError if there are no faces, or faces of an unknown shape.
[[nodiscard]] ElementGroups make_follower_pressure(const std::string& name,
                                                   std::span<const LoadedFaces> faces,
                                                   const TimeFunctionPtr& pressure,
                                                   FollowerRule rule = FollowerRule::kMomentum);

}  // namespace polhode::solids
