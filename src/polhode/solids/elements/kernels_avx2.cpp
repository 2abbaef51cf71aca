// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/elements/kernel_templates.hpp>

#if defined(__x86_64__)

namespace polhode::solids {
namespace {
constexpr KernelTable<Pack<4>> kTable;
}

extern const ElementKernels kElementsAvx2;
const ElementKernels kElementsAvx2 = {"avx2", 4, kTable.kind};

}  // namespace polhode::solids

#endif
