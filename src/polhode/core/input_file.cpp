// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <polhode/core/format.hpp>
#include <polhode/core/input_file.hpp>

namespace polhode {
namespace {

/// Bytes that are read at once beyond the length that the file states.
constexpr std::size_t kPiece = 65536;

/// Descriptor, closed by its destructor.
struct OpenFile {
  int descriptor;
  ~OpenFile() {
    if (descriptor >= 0) ::close(descriptor);
  }
};

InputFault of_errno(const char* what) {
  const int code = errno;
  return {format("{} ({})", what, std::strerror(code)),
          code == ENOENT ? "Name a file or folder that exists"
                         : "Check its permissions, or name another place"};
}

}  // namespace

std::optional<InputFault> read_input(const std::string& path, std::string& bytes,
                                     std::uint64_t most) {
  bytes.clear();
  // A pipe without a writer would otherwise hold the program at its opening.
  const OpenFile file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY)};
  if (file.descriptor < 0) return of_errno("cannot be opened");
  struct stat status {};
  if (::fstat(file.descriptor, &status) != 0) return of_errno("cannot be read");
  if (S_ISDIR(status.st_mode)) return InputFault{"is a folder", "Name a file"};
  if (!S_ISREG(status.st_mode))
    return InputFault{"is a pipe or a device, not a file",
                      "Write its content into a file, and name that"};
  const auto refuse_longer = [&](std::uint64_t length) -> std::optional<InputFault> {
    if (length <= most) return std::nullopt;
    return InputFault{format("has {} bytes, more than {}", length, most), "Name a smaller file"};
  };
  const auto stated = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
  if (auto fault = refuse_longer(stated)) return fault;
  std::size_t length = 0;
  for (;;) {  // Files of the system state no length, and others may grow.
    if (auto fault = refuse_longer(length)) return fault;
    if (bytes.size() <= length) bytes.resize(std::max<std::size_t>(stated + 1, length + kPiece));
    const ssize_t count = ::read(file.descriptor, bytes.data() + length, bytes.size() - length);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return of_errno("cannot be read");
    if (count == 0) break;
    length += static_cast<std::size_t>(count);
  }
  bytes.resize(length);
  return std::nullopt;
}

}  // namespace polhode
