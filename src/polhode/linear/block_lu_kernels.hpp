// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/linear/block_lu.hpp>

namespace polhode::linear {

/// Whether the processor supports the fused kernels below (AVX2 and FMA).
[[nodiscard]] bool has_fused_kernels();

/// Block LU in place: diagonal blocks become P L U with reciprocal pivots, upper blocks D⁻¹ A.
/// @returns false if a pivot is zero or not finite.
[[nodiscard]] bool factor_blocks(const BlockPlan& plan, double* values, int* pivots, bool fused);
/// x: padded vector, padding zero; right-hand side in, solution out.
void solve_blocks(const BlockPlan& plan, const double* values, const int* pivots, double* x,
                  bool fused);
void solve_blocks_transposed(const BlockPlan& plan, const double* values, const int* pivots,
                             double* x);

}  // namespace polhode::linear
