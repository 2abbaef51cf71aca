// SPDX-License-Identifier: Apache-2.0
#include <fuzz/robot_fuzzer.hpp>
#include <polhode/io/importers/feb.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return polhode::fuzz::import_bytes(data, size, "model.feb", [](auto source, const auto& options) {
    return polhode::io::import_feb(std::move(source), options, "");
  });
}
