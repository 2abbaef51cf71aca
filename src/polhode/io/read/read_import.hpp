// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::io {

/// The text of a model file and its name, and overrides with which it is read.
struct ModelText {
  std::string text;
  std::string file;   ///< In messages; paths are relative to its folder.
  std::string shown;  ///< Name of the text itself in messages.
  Overrides overrides;
};

/// The model file that reads a file. One of another program is imported: by the model file beside
/// it whose name ends with ".overlay.yaml" instead, by that of the override import.overlay, or by
/// nothing but its name.
/// @throws FileError
[[nodiscard]] ModelText model_text_of(const std::string& file, const Overrides& overrides);

/// Report of an import.
struct ImportReport {
  std::string format, file;  ///< "" if nothing was imported.
  std::vector<ImportNote> notes;
};

/// Replaces the key import of a model file by what it names, and takes the overrides that begin
/// with "import." out of a list.
/// @param folder  Of the model file; paths are relative to it.
/// @param mesh_folder  Folder to which paths of meshes are relative in the result.
/// @throws ModelErrors
ImportReport expand_import(SourceTree& tree, const std::string& folder,
                           const std::string& mesh_folder, Overrides& overrides,
                           Diagnostics& diagnostics);

/// A model file without imports.
struct ExpandedModel {
  std::string text;
  ImportReport report;
  Overrides overrides;  ///< Those that are still to be applied.
};
/// The text of a model file with the content of what it imports; of one that imports nothing the
/// text itself.
/// @param mesh_folder  Folder to which paths of imported meshes are relative in the result.
/// @throws ModelErrors, FileError
[[nodiscard]] ExpandedModel expanded_model(const std::string& file, const std::string& mesh_folder,
                                           const Overrides& overrides = {});
/// Import of a file, with paths relative to its folder.
[[nodiscard]] ExpandedModel expanded_model(const std::string& file,
                                           const Overrides& overrides = {});

}  // namespace polhode::io
