// SPDX-License-Identifier: Apache-2.0
#include <fuzz/mesh_fuzzer.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return polhode::fuzz::read(polhode::solids::parse_gmsh, data, size);
}
