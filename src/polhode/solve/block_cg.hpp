// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/assembly/contact_springs.hpp>

namespace polhode {

/// Conjugate gradients for bodies that only springs between points couple: a symmetric positive
/// matrix of one 6×6 block a body and one spring a contact, never assembled. The inverse blocks,
/// springs included, precondition it.
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
  int solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most);

 private:
  using Four = float __attribute__((vector_size(16)));
  /// Displacement and turn of a body, or force and moment on it; the fourth numbers are zero.
  struct Pair {
    Four moved, turned;
  };
  struct Spring {
    Four C[3];  ///< Columns.
    Four arm_a, arm_b;
    int a, b;  ///< Among those that move; what stays comes after them.
  };
  struct Block {
    Pair column[6];
  };

  static Four cross(Four a, Four b);
  static Pair times(const Block& block, const Pair& x);
  static double dot(const Pair& x, const Pair& y);
  static void add(const Spring& spring, Four arm, Block& block);
  static bool invert(const Block& block, Block& inverse);
  void multiply();

  double per_length_ = 1.0, per_turn_ = 1.0;  ///< Scales of the matrix: S A S.
  std::vector<Block> own_, own_inverse_;      ///< By body.
  std::vector<int> moving_, place_;           ///< Bodies that move; by body its place among them.
  std::vector<Block> block_, inverse_;        ///< Of bodies that move, as everything from here on.
  std::vector<Spring> springs_;
  std::vector<Pair> x_, r_, z_, p_, y_;  ///< p_ and y_ have what stays last.
};

}  // namespace polhode
