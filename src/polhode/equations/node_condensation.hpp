// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <vector>

#include <polhode/equations/node_system.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/linear/mumps.hpp>

namespace polhode {

/// Eliminates the nodes of deformable solids from the Newton system, so that bodies and joints
/// meet a solid as a 6×6 block for each pair of bodies it is bonded to.
///
/// A bonded node moves with its body, D x_{n+1} = P (Δr, Δθ) with P = [I, −ẑ_{n+1}]; its forces
/// reach the body by P̄ᵀ, P̄ = [I, −ẑ_{n+αf}]. With f for the free unknowns and b for bodies
///
///   A_fb = K_f· P,   A_bf = P̄ᵀ K_·f,   A_bb = P̄ᵀ K P + Σ [0 0; 0 α_f F̂ ẑ_{n+1}]
///   S = A_bb − A_bf A_ff⁻¹ A_fb
///
/// Bonded nodes whose bodies no free node connects, such as those of cables that touch one
/// another, need no elimination: their blocks are couplings of bodies as they are. Which these
/// are changes with what may meet.
///
/// A factorisation serves later iterations and steps, turned with the body the solid is bonded to:
/// K and M turn with the solid. Derivation: docs/theory/solids_and_bodies.md.
class NodeCondensation {
 public:
  explicit NodeCondensation(const System& system);

  /// The pairs of bodies that pieces couple, then those that only meet, for the topology of the
  /// bodies' linear system. The latter may change in factor(); then meetings() does.
  [[nodiscard]] const std::vector<KktPair>& pairs() const { return pairs_; }
  [[nodiscard]] int meetings() const { return meetings_; }  ///< How often they changed.
  struct FactorOptions {
    bool arms_turn = true;     ///< The tangent of arms is wanted: not for masses.
    bool same_matrix = false;  ///< Of the free unknowns: factored before, only bodies have moved.
  };
  /// @param K  3×3 blocks of the graph of nodes, row by row.
  /// @param F  Residual, three a node.
  /// @returns false if the nodes' matrix is singular.
  [[nodiscard]] bool factor(const std::vector<double>& K, const std::vector<double>& F,
                            const Trial& trial, const FactorOptions& options);
  /// The same with the blocks beside the graph: where these change, the matrix is analysed anew.
  [[nodiscard]] bool factor(const NodeSystem& nodes, const Trial& trial);
  [[nodiscard]] bool factored() const { return factored_; }
  /// Rotation of each piece since the factorisation.
  [[nodiscard]] const std::vector<Mat3>& turns(const Trial& trial);
  /// After factor() or turns(): adds P̄ᵀF times `scale` to the residuals by body.
  void gather(const std::vector<double>& F, double scale, std::vector<Vec6>& residual) const;
  /// After factor() or turns(): the bodies' share. Adds P̄ᵀF − A_bf A_ff⁻¹ F_f to the residuals by
  /// body, and S to the diagonal and to the pairs' blocks, all times `scale`.
  void condense(const std::vector<double>& F, double scale, std::vector<Vec6>& residual,
                std::vector<Mat6>& diagonal, std::span<KktValues::Pair> pairs);
  /// The first part of that alone: P̄ᵀF − A_bf A_ff⁻¹ F_f. What expand() tells follows from the
  /// forces given last.
  void press(const std::vector<double>& F, double scale, std::vector<Vec6>& residual);
  /// Increments of all nodes (3 each) from those of the bodies (6 each).
  void expand(const double* bodies, std::vector<double>& du) const;

  [[nodiscard]] const Mumps& factorisation() const { return mumps_; }

 private:
  struct Bond {
    int node, body;
    Vec3 z_n1, z_alpha;
  };
  /// A free node beside bonded ones of a body: 3×6 and 6×3 at the factorisation.
  struct Coupling {
    int node, body, place;  ///< place: of the body in its piece.
    Eigen::Matrix<double, 3, 6> fb;
    Eigen::Matrix<double, 6, 3> bf;
  };
  void analyse();
  void find_neighbours();
  void gather_moving(const std::vector<double>& K, const std::vector<const Bond*>& bond_of);
  [[nodiscard]] Coupling& coupling(int piece, int node, int body);
  /// The first piece that reaches both bodies; −1 if none does.
  [[nodiscard]] int piece_of_pair(int a, int b) const;
  void place_bonds(const Trial& trial);
  void gather_couplings(const std::vector<double>& K, const std::vector<double>& F,
                        double arm_weight);
  [[nodiscard]] int place_in(int piece, int body) const;

  const System* system_;
  Mumps mumps_;
  bool factored_ = false;
  std::vector<int> source_;  ///< Of each entry of A_ff in the nodes' tangent.
  std::vector<double> values_;
  NodeBlocks moving_;  ///< Blocks beside the graph, as analysed.
  std::vector<Bond> bonds_;
  std::vector<std::vector<Coupling>> couplings_;      ///< By piece.
  std::map<std::pair<int, int>, std::size_t> known_;  ///< Free node and body: their coupling.
  std::vector<KktPair> pairs_;
  std::size_t piece_pairs_ = 0;  ///< The first of them.
  int meetings_ = 0;
  std::map<std::pair<int, int>, std::size_t> meeting_;  ///< By two bodies.
  std::vector<Mat6> meeting_diagonal_;                  ///< By body.
  std::vector<std::array<Mat6, 2>> meeting_blocks_;     ///< By meeting: K_ab, K_ba.
  std::map<std::pair<int, int>, int> piece_of_;         ///< By two bodies, or one twice.
  std::vector<std::vector<int>> pair_of_;  ///< By piece: pair of places (i, j), i < j, row by row.
  std::vector<Eigen::MatrixXd> A_bb_, S_;  ///< By piece.
  std::vector<double> W_;  ///< A_ff⁻¹ A_fb: unknowns by 6 columns a body's place.
  int columns_ = 0;
  std::vector<Mat3> turn_, Lambda_factored_;  ///< By piece.
  std::vector<double> y_;                     ///< A_ff⁻¹ F_f in the frame of the factorisation.
};

}  // namespace polhode
