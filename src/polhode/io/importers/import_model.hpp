// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/source_tree.hpp>

namespace polhode::io {

/// Options of the import of another program's file: the keys of `import` in a model file.
struct ImportOptions {
  std::string file;                                  ///< Path, as seen from here.
  std::string base = "fixed";                        ///< fixed | floating: the first link.
  std::string fixed_joints = "weld";                 ///< weld | merge.
  std::string shapes = "visual";                     ///< visual | collision | none.
  bool limits = true;                                ///< Whether joints have stops.
  bool friction = true;                              ///< Whether joints have dry friction.
  bool actuators = true;                             ///< Whether there are motors and servos.
  std::string keyframe;                              ///< Of an MJCF: "": the first one, none: none.
  bool contacts = false;                             ///< Whether the model has contacts.
  bool contact_friction = false;                     ///< Whether it gives them a friction.
  bool allow_partial = false;                        ///< Whether parts may be left out.
  std::vector<std::string> package_paths;            ///< Folders that contain packages.
  std::map<std::string, std::vector<double>> start;  ///< Coordinates at the start by joint, SI.
  /// Units that they were given with, a letter each: r an angle, m a length, - none.
  std::map<std::string, std::string> start_units;
  std::map<std::string, std::string> arguments;  ///< Of xacro.
};

/// Something that an import changed or left out.
struct ImportNote {
  enum class Kind : unsigned char {
    approximated,  ///< Represented by something close to it.
    ignored,       ///< Has no influence on the motion, or is unknown.
    left_out,      ///< Could not be represented; only with allow_partial.
  };
  Kind kind = Kind::ignored;
  SourceLocation place;
  std::string what;  ///< One sentence.
};

/// A model of another program as the content of a model file.
struct Imported {
  std::string format;                        ///< "URDF", "MJCF", "SDFormat", "FEBio".
  std::shared_ptr<const SourceText> source;  ///< For messages.
  SourceNode root;                           ///< Lines are those of the source.
  std::vector<ImportNote> notes;
};

/// Whether a file name is one of another program's format.
[[nodiscard]] bool is_importable(const std::string& file);

/// Reads a file of another program.
/// @param folder  Folder to which paths of meshes are relative in the result.
/// @throws ModelErrors with all errors of the file, among them all that cannot be represented
/// unless allow_partial is set.
/// @throws FileError if the file cannot be read.
[[nodiscard]] Imported import_model(const ImportOptions& options, const std::string& folder);

/// The word of a kind of note: "approximated", "ignored", "left out".
[[nodiscard]] const char* word_of(ImportNote::Kind kind);

}  // namespace polhode::io
