// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include <polhode/equations/node_system.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/linear/mumps.hpp>

namespace polhode {

/// Static condensation of the nodes of deformable solids, so that for bodies and joints a solid is
/// a 6×6 block for each pair of bodies it is bonded to.
///
/// A bonded node moves with its body, D x_{n+1} = P (Δr, Δθ) with P = [I, −ẑ_{n+1}]; its forces are
/// transmitted to the body by P̄ᵀ, P̄ = [I, −ẑ_{n+αf}]. With f for the free unknowns and b for
/// bodies
///
///   A_fb = K_f· P,   A_bf = P̄ᵀ K_·f,   A_bb = P̄ᵀ K P + Σ [0 0; 0 α_f F̂ ẑ_{n+1}]
///   S = A_bb − A_bf A_ff⁻¹ A_fb
///
/// Bonded nodes of bodies that no free node connects, such as those of cables in contact, need no
/// elimination: their blocks couple the bodies directly. Which nodes these are changes with the
/// neighbour list.
///
/// A factorisation is reused in later iterations and steps, rotated with the body the solid is
/// bonded to: K and M rotate with the solid. Derivation: docs/theory/solids_and_bodies.md.
class NodeCondensation {
 public:
  explicit NodeCondensation(const System& system);

  /// Pairs of bodies coupled by connected components, then those coupled by contact alone, for the
  /// topology of the bodies' linear system. The latter may change in factor(), which meetings()
  /// shows.
  [[nodiscard]] const std::vector<linear::KktPair>& pairs() const { return pairs_; }
  [[nodiscard]] int meetings() const { return meetings_; }  ///< Number of their changes.
  struct FactorOptions {
    bool arms_turn = true;  ///< Include the tangent of rotating lever arms: not for masses.
    /// The matrix of the free unknowns was factored before; only bodies have moved.
    bool same_matrix = false;
  };
  /// @param K  3×3 blocks of the graph of nodes, row by row.
  /// @param F  Residual, three per node.
  /// @returns false if the nodes' matrix is singular.
  [[nodiscard]] bool factor(const std::vector<double>& K, const std::vector<double>& F,
                            const Trial& trial, const FactorOptions& options);
  /// Factors the matrix with the blocks outside the graph; if their pattern changes, the matrix is
  /// analysed again.
  [[nodiscard]] bool factor(const NodeSystem& nodes, const Trial& trial);
  [[nodiscard]] bool factored() const { return factored_; }
  /// Rotation of each connected component since the factorisation.
  [[nodiscard]] const std::vector<Mat3>& turns(const Trial& trial);
  /// After factor() or turns(): adds P̄ᵀF times `scale` to the residuals by body.
  void gather(const std::vector<double>& F, double scale, std::vector<Vec6>& residual) const;
  /// Adds the condensed terms to the bodies, after factor() or turns(): P̄ᵀF − A_bf A_ff⁻¹ F_f to
  /// the residuals by body, and S to the diagonal and to the pairs' blocks, all times `scale`.
  void condense(const std::vector<double>& F, double scale, std::vector<Vec6>& residual,
                std::vector<Mat6>& diagonal, std::span<linear::KktValues::Pair> pairs);
  /// Adds only the condensed residual, P̄ᵀF − A_bf A_ff⁻¹ F_f. expand() uses the forces given last.
  void press(const std::vector<double>& F, double scale, std::vector<Vec6>& residual);
  /// Increments of all nodes (3 each) from those of the bodies (6 each).
  void expand(const double* bodies, std::vector<double>& du) const;

  [[nodiscard]] const linear::Mumps& factorisation() const { return mumps_; }

 private:
  struct Bond {
    int node, body;
    Vec3 z_n1, z_alpha;
  };
  /// A free node with bonded neighbours of a body: 3×6 and 6×3 blocks at the factorisation.
  struct Coupling {
    int node, body, place;  ///< place: of the body in its piece.
    Eigen::Matrix<double, 3, 6> fb;
    Eigen::Matrix<double, 6, 3> bf;
  };
  void analyse();
  void find_neighbours();
  void gather_moving(const std::vector<double>& K, const std::vector<const Bond*>& bond_of);
  [[nodiscard]] Coupling& coupling(int piece, int node, int body);
  /// First connected component that couples both bodies; −1 if none does.
  [[nodiscard]] int piece_of_pair(int a, int b) const;
  void place_bonds(const Trial& trial);
  void gather_couplings(const std::vector<double>& K, const std::vector<double>& F,
                        double arm_weight);
  [[nodiscard]] int place_in(int piece, int body) const;

  const System* system_;
  linear::Mumps mumps_;
  bool factored_ = false;
  std::vector<int> source_;  ///< Positions of the entries of A_ff in the nodes' tangent.
  std::vector<double> values_;
  NodeBlocks moving_;  ///< Blocks outside the graph, as analysed.
  std::vector<Bond> bonds_;
  std::vector<std::vector<Coupling>> couplings_;      ///< By connected component.
  std::map<std::pair<int, int>, std::size_t> known_;  ///< Free node and body: their coupling.
  std::vector<linear::KktPair> pairs_;
  std::size_t piece_pairs_ = 0;  ///< Number of pairs coupled by components, which come first.
  int meetings_ = 0;
  std::map<std::pair<int, int>, std::size_t> meeting_;  ///< By two bodies.
  std::vector<Mat6> meeting_diagonal_;                  ///< By body.
  std::vector<std::array<Mat6, 2>> meeting_blocks_;     ///< By contact pair: K_ab, K_ba.
  std::map<std::pair<int, int>, int> piece_of_;         ///< By two bodies, or one twice.
  /// By connected component: pair of positions (i, j), i < j, row by row.
  std::vector<std::vector<int>> pair_of_;
  std::vector<Eigen::MatrixXd> A_bb_, S_;  ///< By connected component.
  std::vector<double> W_;                  ///< A_ff⁻¹ A_fb: unknowns by 6 columns per body.
  int columns_ = 0;
  std::vector<Mat3> turn_, Lambda_factored_;  ///< By connected component.
  std::vector<double> y_;                     ///< A_ff⁻¹ F_f in the frame of the factorisation.
};

}  // namespace polhode
