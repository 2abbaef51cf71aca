// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/folder_lock.hpp>

#include <array>
#include <cerrno>
#include <string_view>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

constexpr const char* kLockName = ".polhode.lock";

/// Whether an open file is still the one of that name: the run before removes it at its end.
bool is_still(const std::string& path, int file) {
  struct stat open {
  }, named{};
  return ::fstat(file, &open) == 0 && ::lstat(path.c_str(), &named) == 0 &&
         open.st_ino == named.st_ino && open.st_dev == named.st_dev;
}

std::string holder_of(int file) {
  std::array<char, 512> text{};
  const ssize_t count = ::pread(file, text.data(), text.size(), 0);
  return {text.data(), static_cast<std::size_t>(count > 0 ? count : 0)};
}

}  // namespace

FolderLock::FolderLock(const std::string& folder, const std::string& model)
    : path_(folder + "/" + kLockName) {
  make_folder(folder);
  while (true) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (file_ < 0) throw FileError::from_errno(folder, "cannot be written");
    if (::flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string holder = holder_of(file_);
      ::close(file_);
      throw InputError(
          folder,
          format("another run{} is writing into it", holder.empty() ? "" : " (" + holder + ")"),
          "Wait for its end, or name another folder for the results with -o");
    }
    if (is_still(path_, file_)) break;
    ::close(file_);
  }
  const std::string holder =
      format("process {}{}", ::getpid(), model.empty() ? "" : ", model '" + model + "'");
  // Only a text for others: the lock holds without it.
  if (::ftruncate(file_, 0) == 0) (void)!::pwrite(file_, holder.data(), holder.size(), 0);
}

bool FolderLock::is_held(const std::string& folder) {
  const int file = ::open((folder + "/" + kLockName).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return false;
  const bool held = ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  return held;
}

FolderLock::~FolderLock() {
  ::unlink(path_.c_str());
  // Not only closed: a process that was forked meanwhile has the file, too.
  ::flock(file_, LOCK_UN);
  ::close(file_);
}

}  // namespace polhode::io
