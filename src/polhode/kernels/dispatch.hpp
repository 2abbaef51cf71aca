// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// "automatic" takes the widest this machine has; else baseline, avx2 or avx512.
/// @throws InputError if the machine or the build lacks it.
[[nodiscard]] const LaneKernels& lane_kernels(const std::string& isa);
/// The sets this machine and build offer, widest first.
[[nodiscard]] std::vector<std::string> available_instruction_sets();

}  // namespace polhode
