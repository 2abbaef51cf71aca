// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/io/importers/import_model.hpp>

namespace polhode::io {

/// Reads an FEBio 4.0 file. @throws ModelErrors as import_model() does.
[[nodiscard]] Imported import_feb(std::shared_ptr<const SourceText> source,
                                  const ImportOptions& options, const std::string& folder);

}  // namespace polhode::io
