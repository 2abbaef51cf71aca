// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/simulation/simulation.hpp>

namespace polhode::io {

/// Options of the export of a model to another program's file.
struct ExportOptions {
  std::string file;            ///< Path of the file; its ending chooses the format.
  bool allow_partial = false;  ///< Whether parts that the format cannot represent may be left out.
};

/// Difference between a model and the file that was written of it.
struct ExportNote {
  enum class Kind : unsigned char {
    left_out,  ///< Cannot be represented; only with allow_partial.
    differs,   ///< Is in the file, and the programs that read it treat it in another way.
    elsewhere  ///< Belongs to no file of this format: it is given where the file is read.
  };
  Kind kind = Kind::differs;
  std::string path;  ///< In the model, e.g. joints.B.limits.
  std::string what;  ///< One sentence, without a full stop.
};

/// Text of another program's file.
struct Exported {
  std::string format;  ///< "URDF", "MJCF".
  std::string text;
  std::vector<ExportNote> notes;
};

/// Whether a file name has the ending of a format that can be written.
[[nodiscard]] bool is_exportable(const std::string& file);

/// A model at its start as another program's file, in which paths of meshes are relative to its
/// folder. Nothing is written to the disk.
/// @param simulation  The model with its bodies at the present state, which is the start.
/// @throws ModelErrors with all that the format cannot represent, unless allow_partial is set, and
/// names that no file may have.
/// @throws InputError if no format has the ending of the file.
[[nodiscard]] Exported export_model(const Simulation& simulation, const ExportOptions& options);

/// Words of a kind of note: "left out", "differs", "not in the file".
[[nodiscard]] const char* word_of(ExportNote::Kind kind);

}  // namespace polhode::io
