// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/element_sample.hpp>
#include <polhode/system/node_step.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

class BarrierConstraint;
class InternalUnknowns;
class ChangingSparsity;
class SurfaceImpacts;

/// Where elements put the forces they exert on nodes, and the derivatives of these.
struct ElementSink {
  double* force;     ///< By node, three each: at t_{n+αf} [N].
  double* tangent;   ///< 3×3 blocks, row by row, of the graph of nodes; null: not wanted.
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

/// How the elements of a group fared in an evaluation.
struct ElementReport {
  double least_volume = 1.0;  ///< Smallest det F at t_{n+1} [-]; must be positive.
  int worst_element = -1;
  void take(double volume, int element) {
    if (!(volume >= least_volume)) least_volume = volume, worst_element = element;
  }
};

/// Elements of one type, material and solid, or a load on nodes: what acts on nodes meets the
/// integrator through this. One virtual call per group.
///
/// Three buffers: `history` is part of the State and holds what t_n has left; `scratch` belongs to
/// the solver and holds what lives during a step: internal unknowns such as enhanced strains, and
/// their condensation. Internal unknowns are condensed here, by element; nobody else knows of them.
class ElementGroup {
 public:
  virtual ~ElementGroup() = default;
  [[nodiscard]] virtual std::string kind() const = 0;  ///< "hex8 eas9", "pressure": for reports.
  [[nodiscard]] virtual const std::string& name() const = 0;  ///< Of the solid or load.
  [[nodiscard]] virtual int size() const = 0;                 ///< Elements.
  [[nodiscard]] virtual int nodes_per_element() const = 0;
  [[nodiscard]] virtual std::span<const int> nodes(int element) const = 0;
  [[nodiscard]] virtual bool has_tangent() const { return true; }
  [[nodiscard]] virtual bool conservative() const { return true; }  ///< Stores all it takes.
  [[nodiscard]] virtual bool dissipates() const { return false; }
  /// Acts from outside: its forces need not cancel, and the ledger counts their impulse.
  [[nodiscard]] virtual bool external() const { return false; }
  /// The functions of time that its forces follow; null where there is none.
  [[nodiscard]] virtual std::vector<TimeFunctionPtr> time_functions() const { return {}; }
  [[nodiscard]] virtual std::size_t history_size() const { return 0; }  ///< Of the whole group.
  [[nodiscard]] virtual std::size_t scratch_size() const { return 0; }

  // What a group may be besides; null where it is not.
  [[nodiscard]] virtual const BarrierConstraint* barrier_constraint() const { return nullptr; }
  [[nodiscard]] virtual const InternalUnknowns* internal_unknowns() const { return nullptr; }
  [[nodiscard]] virtual const ChangingSparsity* changing_sparsity() const { return nullptr; }
  [[nodiscard]] virtual const SurfaceImpacts* surface_impacts() const { return nullptr; }

  /// Consistent mass of element, n × n numbers (per direction), row by row; returns false if this
  /// group carries no mass. [kg]
  virtual bool mass(int /*element*/, double* /*M*/) const { return false; }

  /// History at the start, nodes at their reference positions.
  virtual void initialize(double* /*history*/) const {}
  /// Once per trial step, before the first evaluation.
  virtual void begin_step(const double* /*history*/, double* /*scratch*/) const {}
  /// Forces on the nodes at t_{n+αf}, and tangents if sink.tangent. Without tangents an element
  /// with internal unknowns uses its last condensation, turned by `turn` since it was made.
  virtual ElementReport evaluate(const NodeStep& step, const double* history, double* scratch,
                                 const Mat3& turn, const ElementSink& sink) const = 0;
  /// After the nodes moved by du (3 each): moves the internal unknowns.
  /// @returns the largest move of one [m].
  virtual double advance(const double* /*du*/, const Mat3& /*turn*/, double* /*scratch*/) const {
    return 0.0;
  }
  /// History at t_{n+1}.
  virtual void commit(const NodeStep& /*step*/, double* /*history*/,
                      const double* /*scratch*/) const {}
  /// Over the step; at an instant (x_n = x_n1) only `stored` is asked for. `scratch` may be null
  /// at an instant: internal unknowns are those of the history then.
  [[nodiscard]] virtual Work work(const NodeStep& step, const double* history,
                                  const double* scratch) const = 0;
  /// What stands at an instant, one sample an element; false if there is nothing to show.
  virtual bool sample(const NodeStep& /*instant*/, const double* /*history*/,
                      std::span<ElementSample> /*samples*/) const {
    return false;
  }
};

}  // namespace polhode
