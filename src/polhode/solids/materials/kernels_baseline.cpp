// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/materials/kernel_templates.hpp>

namespace polhode::solids {
namespace {

using P = Pack<2>;
constexpr auto kLaws = law_table<P>(MaterialLaws{});
constexpr auto kFibres = fibre_table<P>(FibreLaws{});
constexpr VolumeTable<P> kVolumes;

}  // namespace

extern const MaterialKernels kMaterialsBaseline;
const MaterialKernels kMaterialsBaseline = {"baseline", 2, kLaws.entry, kFibres.entry,
                                            kVolumes.entry};

}  // namespace polhode::solids
