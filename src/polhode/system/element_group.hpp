// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/element_sample.hpp>
#include <polhode/system/force_pieces.hpp>
#include <polhode/system/node_step.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

class BarrierConstraint;
class InternalUnknowns;
class ChangingSparsity;
class SurfaceImpacts;

/// Output arrays of elements: forces on nodes, and their derivatives.
struct ElementSink {
  double* force;     ///< By node, three each: at t_{n+αf} [N].
  double* tangent;   ///< 3×3 blocks, row by row, of the graph of nodes; null: not needed.
  const int* slots;  ///< Of this group: block of (element, i, j) is slots[(element·n + i)·n + j].

  void add_force(std::span<const int> nodes, const double* f) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) force[3 * nodes[i] + c] += f[3 * i + c];
  }
  /// @param K  D force / D x_{n+1}, 3n × 3n, row by row. [N/m]
  void add_tangent(int element, int n, const double* K) const {
    const int* slot = slots + static_cast<std::ptrdiff_t>(element) * n * n;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        double* block = tangent + 9 * static_cast<std::ptrdiff_t>(slot[i * n + j]);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) block[3 * r + c] += K[(3 * i + r) * 3 * n + 3 * j + c];
      }
  }
};

/// Outcome of an evaluation of the elements of a group.
struct ElementReport {
  double least_volume = 1.0;  ///< Smallest det F at t_{n+1} [-]; must be positive.
  int worst_element = -1;
  void take(double volume, int element) {
    if (!(volume >= least_volume)) least_volume = volume, worst_element = element;
  }
};

/// Interface of elements of one type, material and solid, or of a load on nodes, to the integrator.
/// One virtual call per group.
///
/// Three buffers: `history` is part of the State and holds what was committed at t_n; `scratch`
/// belongs to the solver and holds data of a step: internal unknowns such as enhanced strains, and
/// their condensation. Internal unknowns are condensed here, by element; they are not visible
/// elsewhere.
class ElementGroup {
 public:
  virtual ~ElementGroup() = default;
  [[nodiscard]] virtual std::string kind() const = 0;  ///< "hex8 eas9", "pressure": for reports.
  [[nodiscard]] virtual const std::string& name() const = 0;  ///< Of the solid or load.
  [[nodiscard]] virtual int size() const = 0;                 ///< Elements.
  [[nodiscard]] virtual int nodes_per_element() const = 0;
  [[nodiscard]] virtual std::span<const int> nodes(int element) const = 0;
  [[nodiscard]] virtual bool has_tangent() const { return true; }
  [[nodiscard]] virtual bool conservative() const { return true; }  ///< Stores all its work.
  [[nodiscard]] virtual bool dissipates() const { return false; }
  /// Whether it is an external load: its forces need not cancel, and the ledger counts their
  /// impulse.
  [[nodiscard]] virtual bool external() const { return false; }
  /// Functions of time of its forces; null entries are ignored.
  [[nodiscard]] virtual std::vector<TimeFunctionPtr> time_functions() const { return {}; }
  [[nodiscard]] virtual std::size_t history_size() const { return 0; }  ///< Of the whole group.
  [[nodiscard]] virtual std::size_t scratch_size() const { return 0; }

  // Further interfaces of a group; null if not available.
  [[nodiscard]] virtual const BarrierConstraint* barrier_constraint() const { return nullptr; }
  [[nodiscard]] virtual const InternalUnknowns* internal_unknowns() const { return nullptr; }
  [[nodiscard]] virtual const ChangingSparsity* changing_sparsity() const { return nullptr; }
  [[nodiscard]] virtual const SurfaceImpacts* surface_impacts() const { return nullptr; }

  /// Consistent mass of element, n × n numbers (per direction), row by row; returns false if this
  /// group has no mass. [kg]
  virtual bool mass(int /*element*/, double* /*M*/) const { return false; }

  /// History at the start, nodes at their reference positions.
  virtual void initialize(double* /*history*/) const {}
  /// Once per trial step, before the first evaluation.
  virtual void begin_step(const double* /*history*/, double* /*scratch*/) const {}
  /// Forces on the nodes at t_{n+αf}, and tangents if sink.tangent. Without tangents an element
  /// with internal unknowns uses its last condensation, rotated by `turn` since then.
  virtual ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                                 const Mat3& turn, const ElementSink& sink) const = 0;
  /// Updates the internal unknowns after the nodes moved by du (3 each).
  /// @returns the largest change [m].
  virtual double advance(const double* /*du*/, const Mat3& /*turn*/, double* /*scratch*/) const {
    return 0.0;
  }
  /// History at t_{n+1}.
  virtual void commit(const NodeStep& /*step*/, double* /*history*/,
                      const double* /*scratch*/) const {}
  /// Work over the step; at an instant (x_n = x_n1) only `stored` is used. `scratch` may be null at
  /// an instant: internal unknowns are then those of the history.
  [[nodiscard]] virtual Work work(const NodeStep& step, const double* history,
                                  const double* scratch) const = 0;
  /// Whether its forces have kinks at positions or rates, as in InteractionItem.
  [[nodiscard]] virtual bool piecewise() const { return false; }
  /// Adds the smooth pieces of its forces at an instant.
  virtual void pieces(const NodeStep& /*instant*/, const double* /*history*/,
                      ForcePieces& /*pieces*/) const {}
  /// Samples fields at an instant, one sample per element; false if there are none.
  virtual bool sample(const NodeStep& /*instant*/, const double* /*history*/,
                      std::span<ElementSample> /*samples*/) const {
    return false;
  }
};

}  // namespace polhode
