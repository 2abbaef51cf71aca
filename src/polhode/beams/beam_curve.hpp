// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Interpolation of the centre line of a chain of beam elements, by cubic Hermite polynomials
/// through its nodes with the section's normals as tangents:
///
///   X(s) = Σ h_i(s) x_i + g_i(s) t_i,   Σ h_i = 1,
///
/// s the unstressed length along the chain. It is a C¹ function of s at any deformation, and linear
/// in the positions x_i and the unit normals t_i of the nodes. Beyond its ends the polynomials of
/// the last elements go on. @eq{beam-curve}
class BeamCurve {
 public:
  BeamCurve() = default;
  /// @param lengths  Of the elements, unstressed; above zero [m].
  explicit BeamCurve(const std::vector<double>& lengths);

  [[nodiscard]] double length() const { return knots_.back(); }  ///< Of the whole chain [m].
  [[nodiscard]] int elements() const { return static_cast<int>(knots_.size()) - 1; }
  [[nodiscard]] double knot(int node) const { return knots_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] double length(int element) const { return knot(element + 1) - knot(element); }
  /// Element that contains s, the last one beyond an end.
  [[nodiscard]] int element_of(double s) const;

  /// Derivatives of (h, g) of both nodes of an element by s. @param order  0, 1 or 2.
  using Pair = Eigen::Matrix2d;  ///< A row for each node: h, g.
  [[nodiscard]] Pair at(int element, double s, int order) const;
  /// Mean slope of (h, g) over a part of an element, without cancellation: the derivative where the
  /// part has no length.
  [[nodiscard]] Pair slope(int element, double from, double to) const;

 private:
  std::vector<double> knots_{0.0};
};

/// Interpolation at two places of a beam's curve, with weights of at most four nodes.
class CurveStep {
 public:
  static constexpr int kMostNodes = 4;
  using Weights = Eigen::Matrix<double, kMostNodes, 2>;  ///< By node: h, g.

  CurveStep(const BeamCurve& curve, double from, double to);

  [[nodiscard]] int count() const { return count_; }
  [[nodiscard]] int node(int i) const { return node_[static_cast<std::size_t>(i)]; }
  /// Position of the first node of the element at `from` among these nodes.
  [[nodiscard]] int first() const { return place_of(from_element_); }
  [[nodiscard]] Weights at_start(int order) const { return at(from_element_, from_, order); }
  [[nodiscard]] Weights at_end(int order) const { return at(to_element_, to_, order); }
  /// Divided difference of the weights between both places, also where they nearly coincide.
  [[nodiscard]] Weights slope() const;
  /// Its derivative by the second place.
  [[nodiscard]] Weights slope_rate() const;

 private:
  [[nodiscard]] Weights at(int element, double s, int order) const;
  [[nodiscard]] int place_of(int node) const;
  void add(int element, const BeamCurve::Pair& pair, double factor, Weights& weights) const;

  const BeamCurve* curve_;
  double from_, to_;
  int from_element_, to_element_, count_ = 0;
  std::array<int, kMostNodes> node_{};
};

}  // namespace polhode
