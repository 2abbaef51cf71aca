// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/node_system.hpp>
#include <polhode/linear/kkt.hpp>

namespace polhode {

/// One sparse matrix of all bodies, nodes and multipliers, for statics and modes:
///
///   [ s K  −Gᵀ ] [ x ]       x: (Δr, Δθ) by body, then the unknowns of nodes
///   [ −G   −C  ] [ λ̂ ]
///
/// The rows of the constraints are those of the Newton system with opposite sign, so that the
/// matrix is symmetric if K is. Nodes bonded to a body are eliminated, Δx = Δr − ẑ Δθ, entry by
/// entry.
class SaddleMatrix {
 public:
  SaddleMatrix(const System& system, const linear::KktTopology& topology);

  [[nodiscard]] int size() const { return movable_ + rows_; }
  /// Number of unknowns before the multipliers.
  [[nodiscard]] int movable() const { return movable_; }
  [[nodiscard]] int bodies() const { return topology_.bodies; }
  [[nodiscard]] int unknown(int node, int component) const {
    const int u = system_->nodes().unknown(node, component);
    return u < 0 ? -1 : 6 * system_->body_count() + u;
  }
  /// Rows and columns of all entries, the same for every set of values.
  [[nodiscard]] const std::vector<int>& row() const { return row_; }
  [[nodiscard]] const std::vector<int>& column() const { return column_; }
  /// Positions of all entries in the lower triangle.
  [[nodiscard]] const std::vector<int>& lower_row() const { return lower_row_; }
  [[nodiscard]] const std::vector<int>& lower_column() const { return lower_column_; }

  /// Sets the blocks outside the graph of nodes, see NodeSystem::moving(). @returns whether the
  /// entries have changed.
  bool set_moving(const NodeBlocks& moving);
  /// Takes the lever arms of the bonded nodes from the trial.
  void place(const Trial& trial);
  /// Takes them from another matrix of this system.
  void place_like(const SaddleMatrix& other) {
    carrier_ = other.carrier_, arm_ = other.arm_;
    set_moving(other.moving_);
  }
  /// A + factor·B, of the same system and pattern.
  void combine(const SaddleMatrix& A, double factor, const SaddleMatrix& B);
  /// @param bodies  Values and rows of bodies and joints, already scaled by s.
  /// @param blocks  3×3 blocks of the graph of nodes, row by row, then those outside it, or none.
  /// @param forces  Residual of the nodes [N], whose lever arms rotate; null: none.
  void set(const linear::KktValues& bodies, const std::vector<double>& blocks, const double* forces,
           double s);
  /// Adds stiffness against rotations of point masses, which have none of their own.
  void hold_point_masses(double stiffness);
  /// Adds the moments' part −½ R̂ that makes K of conservative systems symmetric off equilibrium:
  /// @param moments  Residual by body, of which the last three are taken, times s.
  void make_hessian(const std::vector<Vec6>& moments);
  [[nodiscard]] const std::vector<double>& values() const { return values_; }
  /// The lower triangle of ½(A + Aᵀ), entry by entry in the order of lower_row().
  [[nodiscard]] const std::vector<double>& lower_values();
  /// Relative size of A − Aᵀ: 0 for a symmetric matrix, about 1 for an arbitrary one.
  [[nodiscard]] double asymmetry() const;

  /// y = A x.
  void times(const Vec& x, Vec& y) const;
  /// y = |A| |x|.
  void magnitudes(const Vec& x, Vec& y) const;
  /// Adds Pᵀ F of forces on nodes (3 each) to the first part of a vector of unknowns.
  void gather(const std::vector<double>& F, double factor, Vec& y) const;
  /// Increments of all nodes from those of the unknowns; zero for prescribed components.
  void expand(const Vec& x, std::vector<double>& du) const;

 private:
  /// Unknowns that move a node: up to six columns of a 3×6 matrix.
  struct Carrier {
    int count = 0;
    int unknown[6];
    Eigen::Matrix<double, 3, 6> P;
  };
  void find_entries();
  template <class Put>
  void for_each(const linear::KktValues* bodies, const std::vector<double>* blocks,
                const double* forces, double s, Put&& put) const;

  const System* system_;
  linear::KktTopology topology_;
  int movable_, rows_;
  NodeBlocks moving_;
  std::vector<Carrier> carrier_;  ///< By node.
  std::vector<Vec3> arm_;         ///< By node: lever arm of a bonded node.
  std::vector<int> row_, column_, lower_row_, lower_column_;
  std::vector<double> values_, lower_;
};

}  // namespace polhode
