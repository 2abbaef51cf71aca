// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/system/contact_springs.hpp>

namespace polhode {

/// Conjugate gradients for bodies that only springs between points couple: a symmetric positive
/// matrix of one 6×6 block a body and one spring a contact, never assembled. The inverse blocks,
/// springs included, precondition it. Friction that follows normal forces is not symmetric: GMRES
/// adds it, preconditioned by the conjugate gradients.
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
  struct Rub {
    Four force, normal, arm_a, arm_b;
    int a, b;
  };

  static Four cross(Four a, Four b);
  static Pair times(const Block& block, const Pair& x);
  static double dot(const Pair& x, const Pair& y);
  static void add(const Spring& spring, Four arm, Block& block);
  static bool invert(const Block& block, Block& inverse);
  void multiply();
  /// The right side, scaled to size one. @returns its size before; zero if it has none.
  double scale(std::span<const Vec6> rhs, Vectors& b) const;
  void unscale(const Vectors& from, double size, std::vector<Vec6>& x) const;
  /// x_ from zero, r_ what is left of b then.
  int iterate(const Vectors& b, double part, int most);
  /// The same with friction, from basis_[0].
  int iterate_rubbing(double part, int most, int directions);
  /// y −= U p, U the friction that follows normal forces; both have what stays last.
  void subtract_rubs(const Vectors& p, Vectors& y) const;

  double per_length_ = 1.0, per_turn_ = 1.0;  ///< Scales of the matrix: S A S.
  std::vector<Block> own_, own_inverse_;      ///< By body.
  std::vector<int> moving_, place_;           ///< Bodies that move; by body its place among them.
  std::vector<Block> block_, inverse_;        ///< Of bodies that move, as everything from here on.
  std::vector<Spring> springs_;
  std::vector<Rub> rubs_;
  static constexpr int kMostDirections = 4;
  Vectors basis_[kMostDirections + 1], found_[kMostDirections];  ///< Of GMRES.
  Vectors x_, r_, z_, p_, y_;  ///< p_ and y_ have what stays last.
};

}  // namespace polhode
