// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/elements/kernel_templates.hpp>

namespace polhode::solids {
namespace {
constexpr KernelTable<Pack<2>> kTable;
}

extern const ElementKernels kElementsBaseline;
const ElementKernels kElementsBaseline = {"baseline", 2, kTable.kind};

}  // namespace polhode::solids
