// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/compile/cable_pairs.hpp>

namespace polhode {

namespace {

/// Distance along a cable, in radii, within which its parts belong to one bend and are not paired.
constexpr double kNearOnItself = std::numbers::pi;
/// Retractions in tolerances: of the points, so that they are inactive at crossing edges, and of
/// parallel edges, so that these are inactive. Points end three tolerances below the sum of the
/// radii, and straight segments sag between them by one.
constexpr double kBehind = 2.0, kRetreat = 6.0;
/// Sine of the angle up to which only points are in contact.
constexpr double kAlong = 0.0523;
/// Depth, as a part of the tolerance, below which segments do not overlap.
constexpr double kOverlap = 0.5;

using Range = std::array<int, 2>;

class Sides {
 public:
  Sides(const Model& model, const CableSide& a, const CableSide& b, const std::vector<Vec3>& X,
        double tolerance)
      : model_(model),
        a_(a),
        b_(b),
        X_(X),
        tolerance_(tolerance),
        radius_(std::min(a.line.radius, b.line.radius)),
        least_(a.line.radius + b.line.radius - kOverlap * tolerance) {}

  surface_contact::EdgeContact::Sides take() {
    surface_contact::EdgeContact::Sides sides;
    sides.first = edges(a_.line);
    sides.second = edges(b_.line);
    sides.area = 4.0 * radius_ * radius_;
    sides.radius = a_.line.radius + b_.line.radius;
    sides.retreat = kRetreat * tolerance_;
    sides.behind = kBehind * tolerance_;
    left_out_.resize(sides.first.edges.size());
    if (self()) leave_out_bends();
    leave_out_attachments();
    sides.left_out = std::move(left_out_);
    return sides;
  }

 private:
  [[nodiscard]] bool self() const { return &a_.cable == &b_.cable; }
  [[nodiscard]] static int pieces(const CableLine& line) {
    return static_cast<int>(line.nodes.size()) - 1;
  }

  /// Edges of a cable with points at such distances that segments sag between them by a tolerance
  /// at the smallest crossing angle.
  [[nodiscard]] surface_contact::EdgeLines edges(const CableLine& line) const {
    const double both = a_.line.radius + b_.line.radius;
    const double spacing = 2.0 * std::sqrt(2.0 * both * tolerance_) / kAlong;
    surface_contact::EdgeLines lines;
    for (const int node : line.nodes) {
      lines.vertices.emplace_back();
      lines.vertices.back().add(node, 1.0);
    }
    for (int k = 0; k < pieces(line); ++k) {
      const auto at = static_cast<std::size_t>(k);
      const double length = line.arc[at + 1] - line.arc[at];
      const int parts = std::max(1, static_cast<int>(std::ceil(length / spacing)));
      lines.edges.push_back({k, k + 1});
      // The points of both cables share the area.
      lines.points.push_back({parts, 0.5 * 2.0 * radius_ * length / parts});
    }
    return lines;
  }

  [[nodiscard]] bool overlap(int e, int f) const {
    Vec3 x[4];
    for (int k = 0; k < 4; ++k) {
      const CableLine& line = k < 2 ? a_.line : b_.line;
      const int node = line.nodes[static_cast<std::size_t>((k < 2 ? e : f) + k % 2)];
      x[k] = X_[static_cast<std::size_t>(node)];
    }
    return surface_contact::nearest_of_edges(x).distance < least_;
  }

  void leave_out_bends() {
    const std::vector<double>& arc = a_.line.arc;
    const int count = pieces(a_.line);
    for (int e = 0; e < count; ++e) {
      int last = e;
      while (last + 1 < count) {
        const double between =
            arc[static_cast<std::size_t>(last + 1)] - arc[static_cast<std::size_t>(e + 1)];
        if (between >= kNearOnItself * a_.line.radius && !overlap(e, last + 1)) break;
        ++last;
      }
      left_out_[static_cast<std::size_t>(e)].push_back({e, last});
    }
  }

  /// Segments that begin nearer to a node of the line than half a turn.
  [[nodiscard]] static Range around(const CableLine& line, std::size_t node) {
    Range r{static_cast<int>(node), static_cast<int>(node) - 1};
    const double near = kNearOnItself * line.radius, at = line.arc[node];
    while (r[1] + 1 < pieces(line) && line.arc[static_cast<std::size_t>(r[1] + 1)] - at < near)
      ++r[1];
    while (r[0] > 0 && at - line.arc[static_cast<std::size_t>(r[0])] < near) --r[0];
    return r;
  }

  void leave_out_attachments() {
    const auto place = [](const CableSide& side, std::size_t k) {
      return k * (side.line.nodes.size() - 1) / (side.cable.through.size() - 1);
    };
    for (std::size_t i = 0; i < a_.cable.through.size(); ++i)
      for (std::size_t j = self() ? i + 1 : 0; j < b_.cable.through.size(); ++j)
        if (is_fastened_to(model_, a_.cable.through[i], b_.cable.through[j].body))
          leave_out(around(a_.line, place(a_, i)), around(b_.line, place(b_, j)));
  }

  /// Excludes pairs of ranges, which grow as long as the next segment overlaps the other range.
  void leave_out(Range of_a, Range of_b) {
    const auto meets_b = [&](int e) {
      if (e < 0 || e >= pieces(a_.line) || (self() && e >= of_b[0] && e <= of_b[1])) return false;
      for (int f = of_b[0]; f <= of_b[1]; ++f)
        if (overlap(e, f)) return true;
      return false;
    };
    const auto meets_a = [&](int f) {
      if (f < 0 || f >= pieces(b_.line) || (self() && f >= of_a[0] && f <= of_a[1])) return false;
      for (int e = of_a[0]; e <= of_a[1]; ++e)
        if (overlap(e, f)) return true;
      return false;
    };
    for (bool more = true; more;) {
      more = false;
      if (meets_b(of_a[0] - 1)) --of_a[0], more = true;
      if (meets_b(of_a[1] + 1)) ++of_a[1], more = true;
      if (meets_a(of_b[0] - 1)) --of_b[0], more = true;
      if (meets_a(of_b[1] + 1)) ++of_b[1], more = true;
    }
    for (int e = of_a[0]; e <= of_a[1]; ++e) left_out_[static_cast<std::size_t>(e)].push_back(of_b);
    if (!self()) return;
    for (int f = of_b[0]; f <= of_b[1]; ++f) left_out_[static_cast<std::size_t>(f)].push_back(of_a);
  }

  const Model& model_;
  const CableSide &a_, &b_;
  const std::vector<Vec3>& X_;
  double tolerance_, radius_, least_;
  std::vector<std::vector<Range>> left_out_;
};

}  // namespace

surface_contact::EdgeContact::Sides cable_sides(const Model& model, const CableSide& a,
                                                const CableSide& b, const std::vector<Vec3>& X,
                                                double tolerance) {
  return Sides(model, a, b, X, tolerance).take();
}

double mean_piece(const CableLine& line) {
  return line.arc.back() / static_cast<double>(line.nodes.size() - 1);
}

}  // namespace polhode
