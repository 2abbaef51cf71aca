// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace polhode::io {

/// Where the bytes of an output file go.
struct OutputPlace {
  std::string path;       ///< The file itself, behind all links.
  bool in_place = false;  ///< A device, FIFO or open file, which is written to, never replaced.
};

/// The place that a path names. Links are followed, also to a file that does not exist yet.
/// @throws FileError if it is a folder, or links lead nowhere.
[[nodiscard]] OutputPlace output_place(const std::string& path);

/// A file under a temporary name beside its target, which nobody else has opened; removed unless it
/// is kept. For a target that is written in place it is in the folder for temporary files.
class UnfinishedFile {
 public:
  /// @throws FileError
  explicit UnfinishedFile(const std::string& target);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;

  /// Temporary name, for libraries that open files by name.
  [[nodiscard]] const std::string& path() const { return path_; }
  void write(std::string_view bytes);  ///< @throws FileError
  /// Gives the file its name, in one moment; or copies it to a target that is written in place.
  /// @param durable  Wait until the disk has it. @throws FileError
  void keep(bool durable);

 private:
  std::string target_, path_;
  OutputPlace place_;
  int file_ = -1;
};

/// Waits until the disk has a file or folder; some file systems refuse this for folders, which is
/// no error. @throws FileError
void wait_for_disk(const std::string& path);

/// Lets the system start to write a file to the disk, without waiting.
void start_writing(const std::string& path);

/// Removes files that a killed program left under names of UnfinishedFile.
void remove_unfinished_files(const std::string& folder);

}  // namespace polhode::io
