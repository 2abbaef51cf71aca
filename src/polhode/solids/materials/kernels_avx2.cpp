// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/materials/kernel_templates.hpp>

#if defined(__x86_64__)

namespace polhode::solids {
namespace {

using P = Pack<4>;
constexpr auto kLaws = law_table<P>(MaterialLaws{});
constexpr auto kFibres = fibre_table<P>(FibreLaws{});
constexpr VolumeTable<P> kVolumes;

}  // namespace

extern const MaterialKernels kMaterialsAvx2;
const MaterialKernels kMaterialsAvx2 = {"avx2", 4, kLaws.entry, kFibres.entry, kVolumes.entry};

}  // namespace polhode::solids

#endif
