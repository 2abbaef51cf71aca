// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/import_model.hpp>

namespace polhode::io {

/// Content of a model file for a model or world given as SDFormat: docs/reference/sdf.md lists what
/// becomes of each tag.
/// @param source  The text, with its file name.
/// @param folder  Folder to which paths of meshes are relative in the result.
/// @throws ModelErrors
[[nodiscard]] Imported import_sdf(std::shared_ptr<const SourceText> source,
                                  const ImportOptions& options, const std::string& folder);

}  // namespace polhode::io
