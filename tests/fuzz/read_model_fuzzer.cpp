// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to the reader of model files. The only accepted outcomes are a model and
// located errors with messages: no crash, no other exception.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <polhode/io/read/read_model.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  // Text after a line "#set" is an override, so that overrides are covered, too.
  polhode::io::Overrides overrides;
  if (const std::size_t mark = text.rfind("\n#set "); mark != std::string::npos) {
    overrides.push_back(text.substr(mark + 6));
    text.resize(mark + 1);
  }
  try {
    const polhode::Model model = polhode::io::read_model_text(text, "fuzz.yaml", overrides);
    if (model.bodies.empty()) std::abort();
  } catch (const polhode::io::ModelErrors& errors) {
    if (errors.diagnostics().empty() || errors.text().empty()) std::abort();
  }
  return 0;
}
