// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// Kernels of an instruction set: "automatic" chooses the widest of this machine; else baseline,
/// avx2 or avx512.
/// @throws InputError if the machine or the build lacks it.
[[nodiscard]] const LaneKernels& lane_kernels(const std::string& isa);
/// Instruction sets supported by this machine and build, widest first.
[[nodiscard]] std::vector<std::string> available_instruction_sets();

}  // namespace polhode
