// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/file_error.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <fcntl.h>
#include <unistd.h>

#include <polhode/core/format.hpp>

namespace polhode::io {

FileError::FileError(std::string_view file, std::string_view what, std::string_view hint)
    : std::runtime_error(format("{}: {}. {}.", file, what, hint)) {}

FileError FileError::from_errno(std::string_view file, std::string_view what) {
  const int code = errno;
  const char* hint = code == ENOSPC || code == EDQUOT ? "Free some space, or name another folder"
                     : code == ENOENT                 ? "Name a file or folder that exists"
                                      : "Check its permissions, or name another place";
  return {file, format("{} ({})", what, std::strerror(code)), hint};
}

std::string read_file(const std::string& path) {
  if (std::error_code ignored; std::filesystem::is_directory(path, ignored))
    throw FileError(path, "is a folder", "Name a file");
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw FileError::from_errno(path, "cannot be opened");
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad()) throw FileError::from_errno(path, "cannot be read");
  return std::move(text).str();
}

void write_file_atomically(const std::string& path, std::string_view bytes, bool durable) {
  const std::string temporary = path + ".tmp";
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file < 0) throw FileError::from_errno(temporary, "cannot be written");
  const auto fail = [&](const char* what) {
    FileError error = FileError::from_errno(temporary, what);
    ::close(file);
    ::unlink(temporary.c_str());
    return error;
  };
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw fail("cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  if (durable && ::fsync(file) != 0) throw fail("cannot be written to the disk");
  if (::close(file) != 0) throw FileError::from_errno(temporary, "cannot be closed");
  if (std::rename(temporary.c_str(), path.c_str()) != 0)
    throw FileError::from_errno(path, "cannot be replaced");
  if (!durable) return;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  const int directory = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_CLOEXEC);
  if (directory >= 0) {
    ::fsync(directory);  // So that the new name survives a power cut; some file systems refuse.
    ::close(directory);
  }
}

void make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw FileError(path, format("cannot be made ({})", error.message()), "Name another folder");
}

}  // namespace polhode::io
