// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/kernels/elimination.hpp>
#include <polhode/kernels/instant_solve.hpp>

namespace polhode::POLHODE_ISA {

constexpr LaneKernels make_kernels(const char* name) {
  return {name, predict, commit, sums, up, down, ground, check};
}

}  // namespace polhode::POLHODE_ISA
