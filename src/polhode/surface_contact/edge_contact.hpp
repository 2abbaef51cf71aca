// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include <polhode/surface_contact/contact_neighbours.hpp>
#include <polhode/surface_contact/edge_lines.hpp>
#include <polhode/surface_contact/edge_pair.hpp>
#include <polhode/surface_contact/point_memory.hpp>
#include <polhode/surface_contact/surface_totals.hpp>
#include <polhode/system/barrier_constraint.hpp>
#include <polhode/system/element_group.hpp>

namespace polhode::surface_contact {

/// Contact of lines of edges: sharp edges of two solids, or of one, that may cross between their
/// nodes, and cables, which are round edges. See EdgePair for the force between two of them.
///
/// Each edge stores the friction bristle with one other edge; a pair that neither edge stores has
/// friction as well, but with a new bristle in each step. @eq{edge-potential}
class EdgeContact final : public ElementGroup,
                          public BarrierConstraint,
                          public ChangingSparsity,
                          public SurfaceContactInterface,
                          public SurfaceImpacts {
 public:
  struct Sides {
    EdgeLines first, second;  ///< One surface with itself: the same lines twice.
    double area = 1.0;        ///< Area represented by a crossing [m²].
    /// Sum of the radii of the edges; 0: sharp edges, separated by the tolerance [m].
    double radius = 0.0;
    double retreat = 0.0, behind = 0.0;  ///< Of round edges, as of EdgePairData.
    /// For round edges, by edge of the first lines: excluded ranges of edges of the second, first
    /// and last.
    std::vector<std::vector<std::array<int, 2>>> left_out = {};
  };
  EdgeContact(std::string name, Sides sides, const SurfaceLaw& law, const SolidContactStart& start);

  static constexpr const char* kKind = "contact of edges";
  static constexpr const char* kCablesKind = "contact of cables";
  std::string kind() const override { return of_cables() ? kCablesKind : kKind; }
  [[nodiscard]] bool of_cables() const { return sides_.retreat > 0.0; }  ///< Round edges.
  const std::string& name() const override { return name_; }
  int size() const override { return 0; }  // its blocks are those of ChangingSparsity
  int nodes_per_element() const override { return 1; }
  std::span<const int> nodes(int /*element*/) const override { return {}; }
  bool has_tangent() const override { return false; }
  bool dissipates() const override { return law_.mu > 0.0 || law_.end_share > 0.0; }
  bool conservative() const override { return !dissipates(); }
  const BarrierConstraint* barrier_constraint() const override { return this; }
  const ChangingSparsity* changing_sparsity() const override { return this; }
  const SurfaceImpacts* surface_impacts() const override { return this; }
  std::size_t history_size() const override;
  void initialize(double* history) const override;

  const std::vector<int>& reach() const override { return nodes_.numbers(); }
  const NodeBlocks& blocks(const double* history) const override {
    return search(history).blocks.blocks;
  }
  void renew(const NodeStep& step, double* history) const override { nodes_.renew(step, history); }
  void clearances(const NodeStep& step, const double* history,
                  std::vector<double>& list) const override;
  double free_part(const NodeStep& from, const NodeStep& to, const double* history) const override;

  ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                         const Mat3& turn, const ElementSink& sink) const override;
  void commit(const NodeStep& step, double* history, const double* scratch) const override;
  Work work(const NodeStep& step, const double* history, const double* scratch) const override;

  const SurfaceLaw& law() const override { return law_; }
  std::size_t places() const override { return sides_.first.edges.size(); }
  /// Number of candidate pairs of edges.
  [[nodiscard]] int candidates(const double* history) const;
  void begin_at(const NodeStep& instant, double* history) const override;
  [[nodiscard]] SurfaceReport report(const double* history) const override;
  [[nodiscard]] std::vector<SurfacePointReport> point_reports(const NodeStep& instant,
                                                              const double* history) const override;
  [[nodiscard]] std::optional<SurfaceOverlap> overlap(const NodeStep& instant) const override;

  void impacts(const NodeStep& step, const double* history,
               std::vector<SurfaceImpact>& list) const override;
  double turn(const SurfaceImpact& impact, double held, double* history) const override;
  void settled(const SurfaceImpact& impact, const ResolvedImpact& settled, double dt,
               double* history) const override;

 private:
  /// History behind that of the edges.
  struct Totals {
    SurfaceTotals sums;
    double lowered;  ///< Distance by which the common band ends lower: a pair started in it [m].
  };
  struct Search {
    std::vector<double> key;  ///< Part of the history that determines the result.
    std::vector<std::pair<int, int>> pairs;
    ContactNeighbours::Blocks blocks;
  };
  /// A pair that is active over a step.
  struct Touch;

  [[nodiscard]] const Search& search(const double* history) const;
  void find(Search& s) const;
  [[nodiscard]] bool may_meet(int e, int f) const;
  /// Ends 0 and 1 of edge e of the first lines, 2 and 3 of f of the second.
  [[nodiscard]] const MeshPoint& end(int e, int f, int k) const;
  [[nodiscard]] EdgePairData data(int e, int f) const;
  [[nodiscard]] std::size_t place_of(int slot) const {
    return nodes_.key_size() + EdgeMemory::kCount * static_cast<std::size_t>(slot);
  }
  [[nodiscard]] EdgeMemory memory_of(const double* history, int slot) const {
    return read_record<EdgeMemory>(history + place_of(slot));
  }
  [[nodiscard]] std::size_t totals() const { return place_of(slots()); }
  [[nodiscard]] int slots() const;
  [[nodiscard]] int slot_of_second(int f) const;
  [[nodiscard]] std::vector<Touch> touches(const NodeStep& step, const double* history,
                                           bool tangent) const;
  [[nodiscard]] Touch touch(const NodeStep& step, const double* history, int e, int f) const;
  [[nodiscard]] double taken_by_pressure(const NodeStep& step, const Touch& touch) const;
  void four_ends(int e, int f, const double* x, Vec3 (&at)[4]) const;
  [[nodiscard]] double lowered(const double* history) const {
    return read_record<Totals>(history + totals()).lowered;
  }
  /// Phase of a pair by its slot; its own band may end lower still.
  [[nodiscard]] PointPhase phase_of(const double* history, int slot) const {
    PointPhase phase = slot < 0 ? PointPhase{} : memory_of(history, slot).phase;
    phase.lowered = std::max(phase.lowered, lowered(history));
    return phase;
  }
  /// Smallest gap of all terms of the potential; ∞ if none is near [m].
  [[nodiscard]] double least_of_terms(const double* x, const double* history) const;
  void write_start(double* history) const;
  [[nodiscard]] double least_gap(const double* x, const double* history) const;
  /// Lower bound of the clearance of two edges; ∞ if they are not in reach where they are.
  [[nodiscard]] double clearance(int e, int f, const Vec3 (&x)[4]) const;

  std::string name_;
  Sides sides_;
  SurfaceLaw law_;
  bool self_ = false;
  double centre_ = 0.0;                               ///< Distance at which the gap is zero [m].
  std::vector<double> shared_first_, shared_second_;  ///< By vertex.
  std::vector<double> square_first_, square_second_;  ///< |e|² at the start, by edge [m²].
  ContactNeighbours nodes_;
  mutable Search search_;  ///< For the last history queried.
};

}  // namespace polhode::surface_contact
