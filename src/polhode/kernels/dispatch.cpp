// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/kernels/instant_data.hpp>

namespace polhode {

extern const LaneKernels kBaselineKernels;
extern const InstantKernels kBaselineInstantKernels;
#if defined(__x86_64__)
extern const LaneKernels kAvx2Kernels;
extern const LaneKernels kAvx512Kernels;
extern const InstantKernels kAvx2InstantKernels;
extern const InstantKernels kAvx512InstantKernels;
#endif

namespace {

/// Kernel sets that this machine supports, widest first.
std::vector<const LaneKernels*> available() {
  std::vector<const LaneKernels*> sets;
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("fma"))
    sets.push_back(&kAvx512Kernels);
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    sets.push_back(&kAvx2Kernels);
#endif
  sets.push_back(&kBaselineKernels);
  return sets;
}

}  // namespace

const LaneKernels& lane_kernels(const std::string& wanted) {
  const auto sets = available();
  if (wanted == "automatic") return *sets.front();
  std::string names;
  for (const LaneKernels* set : sets) {
    if (wanted == set->name) return *set;
    names += (names.empty() ? "" : ", ") + std::string(set->name);
  }
  throw InputError("analysis.isa", format("'{}' is not available on this machine", wanted),
                   format("Use automatic, or one of: {}", names));
}

const InstantKernels& instant_kernels(const LaneKernels& kernels) {
#if defined(__x86_64__)
  if (&kernels == &kAvx512Kernels) return kAvx512InstantKernels;
  if (&kernels == &kAvx2Kernels) return kAvx2InstantKernels;
#endif
  POLHODE_ASSERT(&kernels == &kBaselineKernels);
  return kBaselineInstantKernels;
}

std::vector<std::string> available_instruction_sets() {
  std::vector<std::string> names;
  for (const LaneKernels* set : available()) names.emplace_back(set->name);
  return names;
}

}  // namespace polhode
