// SPDX-License-Identifier: Apache-2.0
// Any x86-64 (SSE2) and arm64 (NEON): two doubles per register.
#define POLHODE_ISA lanes_baseline
#define POLHODE_WIDTH 2
#include <polhode/kernels/kernels.hpp>

namespace polhode {
extern const LaneKernels kBaselineKernels;
extern const InstantKernels kBaselineInstantKernels;
constinit const LaneKernels kBaselineKernels = lanes_baseline::make_kernels("baseline");
constinit const InstantKernels kBaselineInstantKernels = lanes_baseline::make_instant_kernels();
}  // namespace polhode
