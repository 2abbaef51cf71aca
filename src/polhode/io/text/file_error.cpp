// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/file_error.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <polhode/core/format.hpp>
#include <polhode/core/input_file.hpp>

namespace polhode::io {

FileError::FileError(std::string_view file, std::string_view what, std::string_view hint)
    : std::runtime_error(format("{}: {}. {}.", file, what, hint)) {}

FileError FileError::from_errno(std::string_view file, std::string_view what) {
  const int code = errno;
  const char* hint = code == ENOSPC || code == EDQUOT ? "Free some space, or name another folder"
                     : code == ENOENT                 ? "Name a file or folder that exists"
                     : code == EFBIG ? "Raise the limit of the length of files (ulimit -f)"
                                     : "Check its permissions, or name another place";
  return {file, format("{} ({})", what, std::strerror(code)), hint};
}

std::string read_file(const std::string& path) {
  std::string bytes;
  if (const auto fault = read_input(path, bytes)) throw FileError(path, fault->what, fault->hint);
  return bytes;
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw FileError(path, format("cannot be made ({})", error.message()), "Name another folder");
}

}  // namespace polhode::io
