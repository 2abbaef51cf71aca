// SPDX-License-Identifier: Apache-2.0
#include <fuzz/surface_fuzzer.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return polhode::fuzz::read("fuzz.dae", data, size);
}
