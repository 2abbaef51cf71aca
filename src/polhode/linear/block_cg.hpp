// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseCholesky>
#include <span>
#include <vector>

#include <polhode/system/contact_springs.hpp>

namespace polhode {

/// Conjugate gradients for bodies that only springs between points couple: a symmetric positive
/// matrix of one 6×6 block a body and one spring a contact, never assembled. The inverse blocks,
/// springs included, precondition it. Friction that follows normal forces is not symmetric: GMRES
/// adds it, preconditioned by the conjugate gradients.
///
/// A few joints, springs and motors may couple bodies as well. Their rows are held by projection
/// (Gould, Hribar and Nocedal, SIAM J. Sci. Comput. 23, 2001): with M the inverse blocks' matrix
/// and D = G M⁻¹ Gᵀ, factored, every direction fulfils G z = 0. @eq{cg-rows}
///
/// Works in single precision, four numbers at a time, on a matrix scaled to blocks of size one: it
/// serves Newton iterations, which ask for a few digits of an increment and mend the rest in the
/// next one.
class BlockCg {
 public:
  /// @param blocks  By body, the symmetric part counts. @returns false if one is not positive.
  [[nodiscard]] bool set_bodies(std::span<const Mat6> blocks);
  /// Of the bodies set last. @param moving  Ascending: the others stay where they are.
  void set_springs(std::span<const ActingPoint> points, std::span<const int> moving);
  /// Other blocks for some bodies, with the scales of set_bodies().
  [[nodiscard]] bool update_bodies(std::span<const int> bodies, std::span<const Mat6> blocks);
  /// Blocks beside the diagonal, of what else couples two bodies that move; after set_springs().
  struct Tie {
    int a, b;
    Mat6 K_ab;  ///< And its transpose at (b, a).
  };
  void set_ties(std::span<const Tie> ties);
  /// G_a x_a + G_b x_b = −g, of bodies that move or the ground; after set_springs().
  struct Row {
    int a, b;
    Vec6 G_a, G_b;
    double g;
  };
  /// @returns false if a value is not finite.
  [[nodiscard]] bool set_rows(std::span<const Row> rows);
  /// Increments of the rows' multipliers, of the last solve().
  [[nodiscard]] const Vec& multipliers() const { return multipliers_; }
  /// x from zero until r·P⁻¹r is below `part` of what it was; zero for bodies that stay.
  /// @returns iterations done.
  /// @param directions  Of GMRES, at most; 0: without the friction that follows normal forces.
  int solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most, int directions);

 private:
  using Four = float __attribute__((vector_size(16)));
  /// Displacement and turn of a body, or force and moment on it; the fourth numbers are zero.
  struct Pair {
    Four moved, turned;
  };
  using Vectors = std::vector<Pair>;
  struct Spring {
    Four C[3];  ///< Columns.
    Four arm_a, arm_b;
    int a, b;  ///< Among those that move; what stays comes after them.
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
  static double dot(const Pair& x, const Pair& y);
  static void add(const Spring& spring, Four arm, Block& block);
  static bool invert(const Block& block, Block& inverse);
  void multiply();
  /// The right side, scaled to size one. @param least  Its size counts as at least that.
  /// @returns its size before; zero if it has none.
  double scale(std::span<const Vec6> rhs, double least, Vectors& b) const;
  [[nodiscard]] bool scale_body(const Mat6& from, Block& to, Block& inverse) const;
  /// Takes out of r what multipliers carry, and adds these to carried_.
  void project(Vectors& r);
  [[nodiscard]] bool factor_rows();
  /// Size of the force that lets bodies move as the rows ask, scaled.
  [[nodiscard]] double force_of_rows() const;
  /// Moves as the rows ask, from b on. @returns the move.
  Vectors fulfil_rows(double size, Vectors& b);
  void unscale(const Vectors& from, double size, std::vector<Vec6>& x) const;
  /// x_ from zero, r_ what is left of b then.
  int iterate(const Vectors& b, double part, int most);
  /// The same with friction, from basis_[0].
  int iterate_with_friction(double part, int most, int directions);
  /// y −= U p, U the friction that follows normal forces; both have what stays last.
  void subtract_friction(const Vectors& p, Vectors& y) const;

  double per_length_ = 1.0, per_turn_ = 1.0;  ///< Scales of the matrix: S A S.
  std::vector<Block> own_, own_inverse_;      ///< By body.
  std::vector<int> moving_, place_;           ///< Bodies that move; by body its place among them.
  std::vector<Block> block_, inverse_;        ///< Of bodies that move, as everything from here on.
  std::vector<Spring> springs_;
  std::vector<FrictionTerm> friction_;
  struct ScaledTie {
    Block ab, ba;
    int a, b;
  };
  std::vector<ScaledTie> ties_;
  struct ScaledRow {
    Pair on_a, on_b;        ///< Scaled so that D has a diagonal of one.
    Pair along_a, along_b;  ///< M⁻¹ times these.
    double scale;
    int a, b;
  };
  std::vector<ScaledRow> rows_;
  std::vector<int> row_bodies_;  ///< Places, ascending.
  Vec row_values_, carried_, multipliers_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> D_;
  static constexpr int kMaxDirections = 4;
  Vectors basis_[kMaxDirections + 1], found_[kMaxDirections];  ///< Of GMRES.
  Vectors x_, r_, z_, p_, y_;                                  ///< p_ and y_ have what stays last.
};

}  // namespace polhode
