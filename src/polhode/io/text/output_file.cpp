// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/output_file.hpp>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

namespace fs = std::filesystem;

/// Links that are followed one after another, as many as Linux follows.
constexpr int kMostLinks = 40;
/// Temporary names that are tried before giving up.
constexpr int kMostNames = 100;
constexpr std::string_view kEnding = ".unfinished";

void write_all_to(int file, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw FileError::from_errno(name, "cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// Closes a descriptor at the end of a block.
struct Descriptor {
  int number = -1;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Opens a device, FIFO or open file without changing what it is.
int open_in_place(const std::string& path, const std::string& name) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
  if (file < 0) throw FileError::from_errno(name, "cannot be written");
  struct stat what {};
  // Redirected output: what the shell or others wrote there stays.
  if (::fstat(file, &what) == 0 && S_ISREG(what.st_mode)) ::fcntl(file, F_SETFL, O_APPEND);
  return file;
}

/// Whether a link is one of /proc, which leads to an open file and not to a name.
bool leads_to_open_file(const fs::path& link) {
  std::error_code ignored;
  const fs::path parent = link.has_parent_path() ? link.parent_path() : fs::path(".");
  return fs::canonical(parent, ignored).string().starts_with("/proc/");
}

}  // namespace

OutputPlace output_place(const std::string& path) {
  fs::path place = path;
  for (int k = 0; k < kMostLinks; ++k) {
    struct stat what {};
    if (::lstat(place.c_str(), &what) != 0) return {place.string(), false};  // a new file
    if (S_ISDIR(what.st_mode)) throw FileError(path, "is a folder", "Name a file");
    if (S_ISREG(what.st_mode)) return {place.string(), false};
    if (!S_ISLNK(what.st_mode) || leads_to_open_file(place)) return {place.string(), true};
    std::error_code error;
    const fs::path next = fs::read_symlink(place, error);
    if (error) throw FileError(path, "is a link that cannot be read", "Name another file");
    place = next.is_absolute() ? next : place.parent_path() / next;
  }
  errno = ELOOP;
  throw FileError::from_errno(path, "cannot be written");
}

UnfinishedFile::UnfinishedFile(const std::string& target)
    : target_(target), place_(output_place(target)) {
  if (place_.in_place) {
    path_ = (fs::temp_directory_path() / "polhode-XXXXXX").string();
    file_ = ::mkostemp(path_.data(), O_CLOEXEC);
  } else {
    // The access rights of a file that is replaced stay.
    struct stat old {};
    const bool replaces = ::lstat(place_.path.c_str(), &old) == 0;
    for (int k = 0; k < kMostNames && file_ < 0; ++k) {
      path_ = format("{}.{}-{}{}", place_.path, ::getpid(), k, kEnding);
      file_ =
          ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode_t{0644});
      if (file_ < 0 && errno != EEXIST) break;
    }
    if (file_ >= 0 && replaces) (void)::fchmod(file_, old.st_mode & mode_t{0777});
  }
  if (file_ < 0) throw FileError::from_errno(target_, "cannot be written");
}

UnfinishedFile::~UnfinishedFile() {
  if (file_ >= 0) ::close(file_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

void UnfinishedFile::write(std::string_view bytes) { write_all_to(file_, bytes, target_); }

void UnfinishedFile::keep(bool durable) {
  if (place_.in_place) {
    const Descriptor target{open_in_place(place_.path, target_)};
    write_all_to(target.number, read_file(path_), target_);
    return;
  }
  if (durable && ::fsync(file_) != 0)
    throw FileError::from_errno(target_, "cannot be written to the disk");
  if (::close(std::exchange(file_, -1)) != 0)
    throw FileError::from_errno(target_, "cannot be closed");
  if (std::rename(path_.c_str(), place_.path.c_str()) != 0)
    throw FileError::from_errno(target_, "cannot be replaced");
  path_.clear();
  if (!durable) return;
  // So that the new name survives a power cut.
  const std::string folder = fs::path(place_.path).parent_path().string();
  wait_for_disk(folder.empty() ? "." : folder);
}

void write_file_atomically(const std::string& path, std::string_view bytes, bool durable) {
  const OutputPlace place = output_place(path);
  if (place.in_place) {
    const Descriptor target{open_in_place(place.path, path)};
    write_all_to(target.number, bytes, path);
    return;
  }
  UnfinishedFile file(path);
  file.write(bytes);
  file.keep(durable);
}

void wait_for_disk(const std::string& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) throw FileError::from_errno(path, "cannot be opened");
  if (::fsync(file.number) == 0) return;
  if (errno == EIO || errno == ENOSPC || errno == EDQUOT)
    throw FileError::from_errno(path, "cannot be written to the disk");
}

void start_writing([[maybe_unused]] const std::string& path) {
#ifdef __linux__
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number >= 0) (void)::sync_file_range(file.number, 0, 0, SYNC_FILE_RANGE_WRITE);
#endif
}

void remove_unfinished_files(const std::string& folder) {
  std::vector<fs::path> left;
  std::error_code missing;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, missing)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(kEnding)) continue;
    // "<name>.<process>-<number>.unfinished"
    const std::string stem = name.substr(0, name.size() - kEnding.size());
    const std::size_t dot = stem.rfind('.');
    if (dot == std::string::npos) continue;
    const std::string tail = stem.substr(dot + 1);
    const bool ours = std::count(tail.begin(), tail.end(), '-') == 1 &&
                      std::all_of(tail.begin(), tail.end(),
                                  [](unsigned char c) { return std::isdigit(c) != 0 || c == '-'; });
    if (ours) left.push_back(entry.path());
  }
  for (const fs::path& path : left) fs::remove(path, missing);
}

}  // namespace polhode::io
