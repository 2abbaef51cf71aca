// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/beams/beam_curve.hpp>
#include <polhode/core/assert.hpp>

namespace polhode {

namespace {

/// Part of an element below which two places are near each other: differences of weights would lose
/// more digits than their split at the node between them.
constexpr double kNear = 1e-3;

/// Coefficients of ξ⁰ ... ξ³ of h and g/L of the first node, then of the second.
constexpr std::array<std::array<double, 4>, 4> kHermite{
    {{1.0, 0.0, -3.0, 2.0}, {0.0, 1.0, -2.0, 1.0}, {0.0, 0.0, 3.0, -2.0}, {0.0, 0.0, -1.0, 1.0}}};

/// Σ coefficient · power of the four polynomials, as h, g by node.
BeamCurve::Pair combined(const std::array<double, 4>& powers, double length) {
  BeamCurve::Pair pair;
  for (int p = 0; p < 4; ++p) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) sum += kHermite[static_cast<std::size_t>(p)][k] * powers[k];
    pair(p / 2, p % 2) = p % 2 == 0 ? sum : length * sum;
  }
  return pair;
}

}  // namespace

BeamCurve::BeamCurve(const std::vector<double>& lengths) {
  for (const double l : lengths) {
    POLHODE_ASSERT(l > 0.0);
    knots_.push_back(knots_.back() + l);
  }
}

int BeamCurve::element_of(double s) const {
  const auto after = std::upper_bound(knots_.begin(), knots_.end(), s);
  return std::clamp(static_cast<int>(after - knots_.begin()) - 1, 0, elements() - 1);
}

BeamCurve::Pair BeamCurve::at(int element, double s, int order) const {
  const double L = length(element), x = (s - knot(element)) / L;
  if (order == 0) return combined({1.0, x, x * x, x * x * x}, L);
  if (order == 1) return combined({0.0, 1.0 / L, 2.0 * x / L, 3.0 * x * x / L}, L);
  return combined({0.0, 0.0, 2.0 / (L * L), 6.0 * x / (L * L)}, L);
}

BeamCurve::Pair BeamCurve::slope(int element, double from, double to) const {
  const double L = length(element), a = (from - knot(element)) / L, b = (to - knot(element)) / L;
  return combined({0.0, 1.0 / L, (a + b) / L, (a * a + a * b + b * b) / L}, L);
}

CurveStep::CurveStep(const BeamCurve& curve, double from, double to)
    : curve_(&curve),
      from_(from),
      to_(to),
      from_element_(curve.element_of(from)),
      to_element_(curve.element_of(to)) {
  const auto [low, high] = std::minmax(from_element_, to_element_);
  for (const int n : {low, low + 1, high, high + 1})
    if (count_ == 0 || n > node_[static_cast<std::size_t>(count_ - 1)])
      node_[static_cast<std::size_t>(count_++)] = n;
}

int CurveStep::place_of(int node) const {
  const auto found = std::find(node_.begin(), node_.begin() + count_, node);
  return static_cast<int>(found - node_.begin());
}

void CurveStep::add(int element, const BeamCurve::Pair& pair, double factor,
                    Weights& weights) const {
  for (int i = 0; i < 2; ++i) weights.row(place_of(element + i)) += factor * pair.row(i);
}

CurveStep::Weights CurveStep::at(int element, double s, int order) const {
  Weights w = Weights::Zero();
  add(element, curve_->at(element, s, order), 1.0, w);
  return w;
}

CurveStep::Weights CurveStep::slope() const {
  Weights w = Weights::Zero();
  const double way = to_ - from_;
  const int apart = to_element_ - from_element_;
  if (apart == 0) {
    add(from_element_, curve_->slope(from_element_, from_, to_), 1.0, w);
  } else if (std::abs(apart) == 1 && std::abs(way) < kNear * curve_->length(from_element_)) {
    const double between = curve_->knot(std::max(from_element_, to_element_));
    add(from_element_, curve_->slope(from_element_, from_, between), (between - from_) / way, w);
    add(to_element_, curve_->slope(to_element_, between, to_), (to_ - between) / way, w);
  } else {
    w = (at_end(0) - at_start(0)) / way;
  }
  return w;
}

CurveStep::Weights CurveStep::slope_rate() const {
  const double way = to_ - from_;
  if (std::abs(way) < kNear * curve_->length(to_element_)) return 0.5 * at_end(2);
  return (at_end(1) - slope()) / way;
}

}  // namespace polhode
