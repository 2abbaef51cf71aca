// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/kernels.hpp>

namespace polhode::solids {

extern const MaterialKernels kMaterialsBaseline;
#if defined(__x86_64__)
extern const MaterialKernels kMaterialsAvx2;
extern const MaterialKernels kMaterialsAvx512;
#endif

const MaterialKernels& material_kernels(const std::string& isa) {
  std::vector<const MaterialKernels*> sets;  // widest first
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
    sets.push_back(&kMaterialsAvx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    sets.push_back(&kMaterialsAvx2);
#endif
  sets.push_back(&kMaterialsBaseline);
  if (isa == "automatic") return *sets.front();
  std::string names;
  for (const MaterialKernels* set : sets) {
    if (isa == set->name) return *set;
    names += (names.empty() ? "" : ", ") + std::string(set->name);
  }
  throw InputError("analysis.isa", format("'{}' is not available on this machine", isa),
                   format("Use automatic, or one of: {}", names));
}

}  // namespace polhode::solids
