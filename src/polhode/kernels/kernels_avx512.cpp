// SPDX-License-Identifier: Apache-2.0
// x86-64 with AVX-512 (F, DQ, VL): eight doubles per register.
#if defined(__AVX512F__)
#define POLHODE_ISA lanes_avx512
#define POLHODE_WIDTH 8
#include <polhode/kernels/kernels.hpp>

namespace polhode {
extern const LaneKernels kAvx512Kernels;
extern const InstantKernels kAvx512InstantKernels;
constinit const LaneKernels kAvx512Kernels = lanes_avx512::make_kernels("avx512");
constinit const InstantKernels kAvx512InstantKernels = lanes_avx512::make_instant_kernels();
}  // namespace polhode
#endif
