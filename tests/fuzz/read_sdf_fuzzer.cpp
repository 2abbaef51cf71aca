// SPDX-License-Identifier: Apache-2.0
#include <fuzz/robot_fuzzer.hpp>
#include <polhode/io/importers/sdf.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return polhode::fuzz::import_bytes(data, size, "robot.sdf", [](auto source, const auto& options) {
    return polhode::io::import_sdf(std::move(source), options, "");
  });
}
