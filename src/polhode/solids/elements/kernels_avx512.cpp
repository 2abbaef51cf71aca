// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/elements/kernel_templates.hpp>

#if defined(__x86_64__)

namespace polhode::solids {
namespace {
constexpr KernelTable<Pack<8>> kTable;
}

extern const ElementKernels kElementsAvx512;
const ElementKernels kElementsAvx512 = {"avx512", 8, kTable.kind};

}  // namespace polhode::solids

#endif
