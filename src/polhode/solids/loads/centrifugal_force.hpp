// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode::solids {

/// Centrifugal force Ω² M Z (x − p) of the consistent mass of elements at rest in a turning frame,
/// in statics times the load factor. It is no load of the user's: its potential is not in any
/// energy. @eq{spin-matrices}
class CentrifugalForce final : public ElementGroup {
 public:
  /// @param elements  With mass, see make_centrifugal_force().
  CentrifugalForce(const ElementGroup& elements, const TurningFrame& frame)
      : name_(elements.name()), n_(elements.nodes_per_element()), frame_(frame) {
    const auto n = static_cast<std::size_t>(n_);
    for (int e = 0; e < elements.size(); ++e) {
      const std::span<const int> own = elements.nodes(e);
      nodes_.insert(nodes_.end(), own.begin(), own.end());
      mass_.resize(nodes_.size() * n);
      elements.mass(e, mass_.data() + mass_.size() - n * n);
    }
  }

  std::string kind() const override { return "centrifugal force"; }
  const std::string& name() const override { return name_; }
  int size() const override { return static_cast<int>(nodes_.size()) / n_; }
  int nodes_per_element() const override { return n_; }
  std::span<const int> nodes(int element) const override {
    return std::span(nodes_).subspan(static_cast<std::size_t>(element) * n_, n_);
  }
  bool external() const override { return true; }

  ElementReport evaluate(const NodeStep& step, const double* /*history*/, double* /*scratch*/,
                         const Mat3& /*turn*/, const ElementSink& sink) const override {
    const double factor = step.context.load_factor * frame_.speed * frame_.speed;
    const auto n = static_cast<std::size_t>(n_);
    const Mat3 Z = frame_.across();
    std::vector<double> f(3 * n), K(sink.tangent ? 9 * n * n : 0);
    for (int e = 0; e < size(); ++e) {
      const double* M = mass_.data() + static_cast<std::size_t>(e) * n * n;
      const std::span<const int> own = nodes(e);
      std::fill(f.begin(), f.end(), 0.0);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          Eigen::Map<Vec3>(f.data() + 3 * i) +=
              factor * M[i * n + j] * frame_.arm(step.position_alpha(own[j]));
      sink.add_force(own, f.data());
      if (!sink.tangent) continue;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j)
          for (std::size_t r = 0; r < 3; ++r)
            for (std::size_t c = 0; c < 3; ++c)
              K[(3 * i + r) * 3 * n + 3 * j + c] =
                  step.alpha_f * factor * M[i * n + j] *
                  Z(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
      sink.add_tangent(e, n_, K.data());
    }
    return {};
  }
  Work work(const NodeStep& /*step*/, const double* /*history*/,
            const double* /*scratch*/) const override {
    return {};
  }

 private:
  std::string name_;
  int n_;
  TurningFrame frame_;
  std::vector<int> nodes_;
  std::vector<double> mass_;  ///< n × n numbers for each element [kg].
};

/// Centrifugal force on a group of elements; null if the group has no mass.
[[nodiscard]] inline std::unique_ptr<ElementGroup> make_centrifugal_force(
    const ElementGroup& elements, const TurningFrame& frame) {
  const auto n = static_cast<std::size_t>(elements.nodes_per_element());
  std::vector<double> M(n * n);
  if (elements.size() == 0 || !elements.mass(0, M.data())) return nullptr;
  return std::make_unique<CentrifugalForce>(elements, frame);
}

}  // namespace polhode::solids
