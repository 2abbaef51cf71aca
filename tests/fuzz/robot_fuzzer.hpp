// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary bytes to one importer of robots. The only accepted outcomes are the content of a
// model file, which is read again, and located errors with messages: no crash, no other exception.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/text/write_yaml.hpp>

namespace polhode::fuzz {

/// @param import  Importer of a source with options.
template <class Import>
int import_bytes(const std::uint8_t* data, std::size_t size, const char* name, Import&& import) {
  io::ImportOptions options;
  options.file = name;
  options.allow_partial = size % 2 == 1;
  std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const io::Imported imported =
        import(std::make_shared<io::SourceText>(name, std::move(text)), options);
    static_cast<void>(io::read_model_text(io::yaml_text(imported.root), "fuzz.yaml"));
  } catch (const io::ModelErrors& errors) {
    if (errors.diagnostics().empty() || errors.text().empty()) std::abort();
  }
  return 0;
}

}  // namespace polhode::fuzz
