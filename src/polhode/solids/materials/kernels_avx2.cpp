// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/materials/kernel_templates.hpp>

#if defined(__x86_64__)

namespace polhode::solids {
namespace {

using P = Pack<4>;
constexpr auto kLaws = law_table<P>(MaterialLaws{});
constexpr auto kFibres = fibre_table<P>(FibreLaws{});

}  // namespace

extern const MaterialKernels kMaterialsAvx2;
const MaterialKernels kMaterialsAvx2 = {
    "avx2", 4, kLaws.entry, kFibres.entry, {volume_pressure<P>, volume_energy<P>}};

}  // namespace polhode::solids

#endif
