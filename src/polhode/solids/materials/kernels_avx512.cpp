// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/materials/kernel_templates.hpp>

#if defined(__x86_64__)

namespace polhode::solids {
namespace {

using P = Pack<8>;
constexpr auto kLaws = law_table<P>(MaterialLaws{});
constexpr auto kFibres = fibre_table<P>(FibreLaws{});
constexpr VolumeTable<P> kVolumes;

}  // namespace

extern const MaterialKernels kMaterialsAvx512;
const MaterialKernels kMaterialsAvx512 = {"avx512", 8, kLaws.entry, kFibres.entry, kVolumes.entry};

}  // namespace polhode::solids

#endif
