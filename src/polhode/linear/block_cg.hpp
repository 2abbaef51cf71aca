// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include <polhode/system/contact_springs.hpp>

namespace polhode::linear {

/// Conjugate gradient solver for bodies coupled only by springs between points: a symmetric
/// positive definite matrix of one 6×6 block per body and one spring per contact, never assembled.
/// It is preconditioned by a forward and a backward sweep over the bodies, (D + L) D⁻¹ (D + Lᵀ)
/// with L the blocks below the diagonal and D the pivots of an elimination without fill (Meurant,
/// Computer Solution of Large Linear Systems, 1999, section 8.5). It is exact if each body touches
/// at most one that is swept after it, at one point. Friction that follows normal forces is
/// unsymmetric: GMRES adds it, preconditioned by the conjugate gradients.
///
/// Joints, springs and motors may couple bodies as well. Their rows are enforced by projection
/// (Gould, Hribar and Nocedal, SIAM J. Sci. Comput. 23, 2001): bodies connected by rows are swept
/// together, last and group by group, with Q = G M⁻¹ Gᵀ, factored, and M the pivots of these
/// bodies, so that every direction satisfies G z = 0. @eq{cg-rows}
///
/// Works in single precision, four numbers at a time, on a matrix scaled to blocks of size one:
/// Newton iterations need only a few digits of an increment and correct the rest in the next one.
class BlockCg {
 public:
  /// @param blocks  By body, of which the symmetric part is used. @returns false if one is not
  /// positive definite.
  [[nodiscard]] bool set_bodies(std::span<const Mat6> blocks);
  /// Sets the springs of the bodies set last. @param moving  Ascending: the others are fixed.
  void set_springs(std::span<const ActingPoint> points, std::span<const int> moving);
  /// Replaces blocks of some bodies, with the scales of set_bodies().
  [[nodiscard]] bool update_bodies(std::span<const int> bodies, std::span<const Mat6> blocks);
  /// Off-diagonal block of another coupling of two moving bodies; after set_springs().
  struct Tie {
    int a, b;
    Mat6 K_ab;  ///< And its transpose at (b, a).
  };
  void set_ties(std::span<const Tie> ties);
  /// Row G_a x_a + G_b x_b = −g, of moving bodies or the ground; once after set_springs().
  struct Row {
    int a, b;
    Vec6 G_a, G_b;
    double g;
  };
  /// @returns false if a value is not finite.
  [[nodiscard]] bool set_rows(std::span<const Row> rows);
  /// Increments of the rows' multipliers in the last solve().
  [[nodiscard]] const Vec& multipliers() const { return multipliers_; }
  /// Solves for x from zero until r·P⁻¹r is below `part` of its initial value; zero for fixed
  /// bodies. @returns the number of iterations.
  /// @param directions  Largest number of GMRES directions; 0: without the friction that follows
  /// normal forces.
  int solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most, int directions);

 private:
  using Four = float __attribute__((vector_size(16)));
  /// Displacement and rotation of a body, or force and moment on it; the fourth numbers are zero.
  struct Pair {
    Four moved, turned;
  };
  using Vectors = std::vector<Pair>;
  struct Spring {
    Four C[3];  ///< Columns.
    Four arm_a, arm_b;
    int a, b;  ///< Among moving bodies; fixed ones come after them.
  };
  struct Block {
    Pair column[6];
  };
  /// Friction that follows a normal force.
  struct FrictionTerm {
    Four force, normal, arm_a, arm_b;
    int a, b;
  };

  static Four cross(Four a, Four b);
  static Pair times(const Block& block, const Pair& x);
  static void narrow(const Mat6& from, Block& to);
  static Mat6 widened(const Block& block);
  static double dot(const Pair& x, const Pair& y);
  static double dot(const Vec6& x, const Pair& y);
  static void add(const Pair& x, Pair& to);
  static void add(const Spring& spring, Four arm, Block& block);
  static bool invert(const Block& block, Mat6& inverse);
  static bool invert(const Block& block, Block& inverse);
  void multiply();
  Mat6 invert_pivot(std::size_t body);
  void sort_neighbours();
  [[nodiscard]] Block pivot(std::size_t body) const;
  void eliminate();
  /// z = M⁻¹ r with the preconditioner M. @returns r·z.
  double precondition(const Vectors& r, Vectors& z);
  /// Right-hand side scaled to size one. @param least  Lower bound of its size.
  /// @returns its size before; zero if it is zero.
  double scale(std::span<const Vec6> rhs, double least, Vectors& b) const;
  [[nodiscard]] bool scale_body(const Mat6& from, Block& to, Block& inverse) const;
  /// Bodies that rows connect, and these rows.
  struct Group {
    std::vector<int> bodies;         ///< Positions, ascending.
    int first = 0, last = 0;         ///< Of rows_, half-open.
    bool touches_later_one = false;  ///< By a spring.
    std::vector<Mat6> inverses;      ///< Blocks of M⁻¹.
    /// Blocks of M⁻¹ − M⁻¹ Gᵀ Q⁻¹ G M⁻¹, by rows; empty in groups of many bodies.
    std::vector<Block> inverse;
  };
  void add_solution(const Group& group, Vectors& z);
  void invert_group(Group& group);
  void find_groups();
  /// Removes the part of r carried by multipliers of a group. @param carried  Adds these, if given.
  void project(const Group& group, Vectors& r, Vec* carried);
  void solve_rows(const Group& group, Vec& w) const;
  /// Removes the part of r carried by all multipliers, and adds these to carried_.
  void project(Vectors& r);
  [[nodiscard]] Eigen::SparseMatrix<double> matrix_of_rows() const;
  [[nodiscard]] bool factor_rows();
  /// Scaled size of the force that moves bodies onto the rows.
  [[nodiscard]] double force_of_rows() const;
  /// Moves bodies onto the rows, starting from b. @returns the displacement.
  Vectors fulfil_rows(double size, Vectors& b);
  void unscale(const Vectors& from, double size, std::vector<Vec6>& x) const;
  /// Iterates x_ from zero; r_ is the remaining residual.
  int iterate(const Vectors& b, double part, int most);
  /// Iterates with friction, from basis_[0].
  int iterate_with_friction(double part, int most, int directions);
  /// y −= U p, with U the friction that follows normal forces; fixed bodies are last in both.
  void subtract_friction(const Vectors& p, Vectors& y) const;

  double per_length_ = 1.0, per_turn_ = 1.0;  ///< Scales of the matrix: S A S.
  std::vector<Block> own_, own_inverse_;      ///< By body.
  std::vector<int> moving_, place_;           ///< Moving bodies; by body its position among them.
  std::vector<Block> block_;                  ///< Of moving bodies, as all that follows.
  std::vector<Block> diagonal_;               ///< With springs.
  std::vector<Block> inverse_;                ///< Of the pivots of the sweeps.
  bool eliminated_ = false;                   ///< inverse_ is up to date.
  std::vector<int> group_of_;                 ///< Number of a body's group, or -1.
  std::vector<Group> groups_;
  std::vector<Spring> springs_;
  /// A spring as one of its bodies sees it.
  struct Neighbour {
    Four C[3], arm, other_arm;
    int other;
  };
  std::vector<Neighbour> neighbours_;  ///< By body; those that are swept before it first.
  std::vector<int> first_, later_;     ///< Of each body; the first that is swept after it.
  std::vector<FrictionTerm> friction_;
  struct ScaledTie {
    Block ab, ba;
    int a, b;
  };
  std::vector<ScaledTie> ties_;
  /// In double precision: with stiff contacts Q is badly conditioned.
  struct ScaledRow {
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();        ///< Scaled so that Q has a unit diagonal.
    Vec6 along_a = Vec6::Zero(), along_b = Vec6::Zero();  ///< M⁻¹ times these.
    double scale = 0.0, value = 0.0;
    int a = 0, b = 0;
    int number = 0;  ///< In set_rows().
  };
  [[nodiscard]] int group_of(const ScaledRow& row) const;
  std::vector<ScaledRow> rows_;  ///< By group, and in the order of elimination.
  Vec row_values_, carried_, multipliers_;
  Vec work_;  ///< Of project().
  Mat V_;     ///< Of invert_group().
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> Q_;
  static constexpr int kMaxDirections = 4;
  Vectors basis_[kMaxDirections + 1], found_[kMaxDirections];  ///< Of GMRES.
  /// p_ and y_ have the fixed bodies last.
  Vectors x_, r_, z_, p_, y_;
  Vectors left_;  ///< Right-hand sides of groups in the sweeps.
};

}  // namespace polhode::linear
