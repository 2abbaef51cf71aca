// SPDX-License-Identifier: Apache-2.0
// x86-64 with AVX2 and FMA: four doubles per register.
#if defined(__AVX2__)
#define POLHODE_ISA lanes_avx2
#define POLHODE_WIDTH 4
#include <polhode/kernels/kernels.hpp>

namespace polhode {
extern const LaneKernels kAvx2Kernels;
extern const InstantKernels kAvx2InstantKernels;
constinit const LaneKernels kAvx2Kernels = lanes_avx2::make_kernels("avx2");
constinit const InstantKernels kAvx2InstantKernels = lanes_avx2::make_instant_kernels();
}  // namespace polhode
#endif
