// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <polhode/loads/load_description.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode {

/// A point that moves as the weighted sum of nodes: a material point of a solid, or one node that
/// is bonded to a body or fixed.
struct NodePoint {
  std::vector<int> nodes;       ///< Of the System.
  std::vector<double> weights;  ///< Their sum is 1.
};

/// A load along the line between two points of solids or bodies, as an element on their nodes.
///
/// It is the item that acts between two bodies, with the points as bodies that do not turn: forces,
/// energies and their tangents are those of @eq{spring-gradient}. A point's force F acts on its
/// nodes as w_i F, which does the same work.
class PairOnNodes : public ElementGroup {
 public:
  /// Report of its item at an instant, see the kind of load.
  [[nodiscard]] virtual std::vector<double> report(const NodeStep& instant) const = 0;
};

/// Throws for a damper that jumps, whose rows nodes do not have.
[[noreturn]] void refuse_rows_on_nodes(const std::string& load);

/// Motion of the points over a step.
class PointPair {
 public:
  PointPair(std::array<NodePoint, 2> points);  // NOLINT(google-explicit-constructor)

  [[nodiscard]] const std::vector<int>& nodes() const { return nodes_; }
  [[nodiscard]] BodyStep motion(const NodeStep& step, int point) const;
  /// Adds the forces, and their tangents if there is a place for them.
  void add(const PairTerms& terms, const ElementSink& sink) const;

 private:
  std::array<NodePoint, 2> points_;
  std::vector<int> nodes_;                      ///< Of both, once each.
  std::vector<std::array<double, 2>> weights_;  ///< By node: of each point.
};

/// An item on points, such as a SpringDamper, as an element.
template <class Item>
class ItemOnNodes final : public PairOnNodes {
 public:
  ItemOnNodes(const LoadDescription& load, std::array<NodePoint, 2> points)
      : item_(load), points_(std::move(points)) {
    if (item_.rows() > 0) refuse_rows_on_nodes(load.name);
  }

  [[nodiscard]] std::string kind() const override { return Item::kKind; }
  [[nodiscard]] const std::string& name() const override { return item_.name; }
  [[nodiscard]] int size() const override { return 1; }
  [[nodiscard]] int nodes_per_element() const override {
    return static_cast<int>(points_.nodes().size());
  }
  [[nodiscard]] std::span<const int> nodes(int) const override { return points_.nodes(); }
  [[nodiscard]] bool conservative() const override { return item_.conservative(); }
  [[nodiscard]] bool dissipates() const override { return item_.dissipates(); }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const override {
    return item_.time_functions();
  }

  [[nodiscard]] bool piecewise() const override { return item_.piecewise(); }
  void pieces(const NodeStep& instant, const double*, ForcePieces& pieces) const override {
    seen(instant, false, [&](const PairStep& pair) { item_.pieces(pair, pieces); });
  }

  ElementReport evaluate(const NodeStep& step, const double*, double*, const Mat3&,
                         const ElementSink& sink) const override {
    PairTerms terms;
    terms.set_zero();
    seen(step, sink.tangent != nullptr, [&](const PairStep& pair) { item_.evaluate(pair, terms); });
    points_.add(terms, sink);
    return {};
  }
  [[nodiscard]] Work work(const NodeStep& step, const double*, const double*) const override {
    Work w;
    seen(step, false, [&](const PairStep& pair) { w = item_.work(pair); });
    return w;
  }
  [[nodiscard]] std::vector<double> report(const NodeStep& instant) const override {
    std::vector<double> values;
    seen(instant, false, [&](const PairStep& pair) { values = item_.report(pair); });
    return values;
  }

 private:
  template <class Use>
  void seen(const NodeStep& step, bool tangents, const Use& use) const {
    StepContext context = step.context;
    context.tangents = tangents;
    const BodyStep a = points_.motion(step, 0), b = points_.motion(step, 1);
    use(PairStep{a, b, context, nullptr, nullptr});
  }

  Item item_;
  PointPair points_;
};

/// Maker of the item of a kind of load on points.
using MakeOnNodes = std::unique_ptr<PairOnNodes> (*)(const LoadDescription&,
                                                     std::array<NodePoint, 2>);

/// That of a type of load; null if it acts on bodies only.
[[nodiscard]] MakeOnNodes make_on_nodes(std::string_view type);

}  // namespace polhode
