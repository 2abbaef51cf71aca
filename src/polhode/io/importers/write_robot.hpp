// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/io/importers/import_model.hpp>
#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// Writes a robot as the content of a model file. Errors go to the file's diagnostics.
/// @param folder  Folder to which paths of meshes are relative in the result.
/// @param out     Its root is written, and notes are added.
/// @returns whether the robot could be arranged as a tree.
bool write_robot(const Robot& robot, const ImportOptions& options, XmlFile& xml,
                 Diagnostics& diagnostics, const std::string& folder, Imported& out);

}  // namespace polhode::io
