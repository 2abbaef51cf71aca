// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/elements/kernels.hpp>

namespace polhode::solids {

extern const ElementKernels kElementsBaseline;
#if defined(__x86_64__)
extern const ElementKernels kElementsAvx2;
extern const ElementKernels kElementsAvx512;
#endif

const ElementKernels& element_kernels(const std::string& isa) {
  std::vector<const ElementKernels*> sets;  // widest first
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
    sets.push_back(&kElementsAvx512);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    sets.push_back(&kElementsAvx2);
#endif
  sets.push_back(&kElementsBaseline);
  if (isa == "automatic") return *sets.front();
  std::string names;
  for (const ElementKernels* set : sets) {
    if (isa == set->name) return *set;
    names += (names.empty() ? "" : ", ") + std::string(set->name);
  }
  throw InputError("analysis.isa", format("'{}' is not available on this machine", isa),
                   format("Use automatic, or one of: {}", names));
}

}  // namespace polhode::solids
