// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::linear {

/// Rows of a matrix whose columns belong to bodies, six each.
struct BodyRows {
  std::vector<int> bodies;  ///< Numbers from 0 on, each once.
  Mat G;                    ///< Rows by 6·bodies.
};

/// Rank of rows that are coupled by loops.
struct LoopRank {
  int rank = 0;
  /// By row, one block after the other: whether it is part of a redundancy.
  std::vector<char> dependent;
};

/// Rank of a sparse matrix of rows, and the rows that are combinations of others.
///
/// Bodies are eliminated one after the other, that with the fewest neighbours first. An orthogonal
/// transformation of the rows on a body leaves as many of them on it as its columns have rank, the
/// others on its neighbours; rows that vanish are redundancies (row merging: A. George, M. T.
/// Heath, Linear Algebra Appl. 34, 1980, 69-83). Time and memory are linear in the number of bodies
/// if fronts stay small, as along a row of loops.
///
/// A row is dependent if it has a nonzero part in the projection of a vector onto the vanishing
/// combinations; two vectors of fixed pseudo-random numbers are projected.
/// @param rows  Of about unit length.
/// @param bodies  Number of bodies.
/// @param tolerance  Smaller pivots are zero [-].
[[nodiscard]] LoopRank loop_rank(const std::vector<BodyRows>& rows, int bodies, double tolerance);

/// Part of a right-hand side r of G x = r that no x produces: its projection onto the vanishing
/// combinations of rows. It is nonzero in rows that contradict each other.
/// @param right_side  By row, one block after the other.
[[nodiscard]] Vec unreachable_part(const std::vector<BodyRows>& rows, int bodies, double tolerance,
                                   const Vec& right_side);

}  // namespace polhode::linear
