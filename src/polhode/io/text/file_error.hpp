// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace polhode::io {

/// Error of reading or writing a file: full disk, missing folder, no permission.
class FileError : public std::runtime_error {
 public:
  FileError(std::string_view file, std::string_view what, std::string_view hint);
  /// Error with the system's description of errno.
  [[nodiscard]] static FileError from_errno(std::string_view file, std::string_view what);
};

/// The bytes of a file. @throws FileError, also for pipes and devices, which need not end.
[[nodiscard]] std::string read_file(const std::string& path);

/// Writes a file atomically: at no moment, not even after a crash, is there a partial file of this
/// name (temporary file, fsync, rename). Links are followed; devices and FIFOs are written to, not
/// replaced. See UnfinishedFile.
/// @param durable  Wait until the disk has it (fsync), so that it also survives a power cut; a
/// killed program leaves complete files either way.
/// @throws FileError
void write_file_atomically(const std::string& path, std::string_view bytes, bool durable = true);

/// Creates a folder and its parents. @throws FileError
void make_folder(const std::string& path);

}  // namespace polhode::io
