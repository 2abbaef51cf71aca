// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/xacro.hpp>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/io/importers/xml_file.hpp>
#include <polhode/io/text/file_error.hpp>

extern char** environ;

namespace polhode::io {

namespace {

struct Said {
  bool ran = false;  ///< Whether there was such a program.
  int status = 0;
  bool too_long = false;
  std::string text;
  std::string complaint;  ///< Last line that it writes to its standard error.
};

/// The last line of a file that is not empty, shortened.
std::string last_line(std::FILE* file) {
  constexpr std::size_t kMostBytes = 400;
  std::string text(1 << 14, '\0');
  if (std::fseek(file, 0, SEEK_END) != 0) return {};
  const long end = std::ftell(file);
  if (end <= 0) return {};
  const long from = std::max(0L, end - static_cast<long>(text.size()));
  if (std::fseek(file, from, SEEK_SET) != 0) return {};
  text.resize(std::fread(text.data(), 1, text.size(), file));
  text.erase(text.find_last_not_of(" \t\r\n") + 1);
  const std::size_t start = text.find_last_of('\n');
  return text.substr(start == std::string::npos ? 0 : start + 1, kMostBytes);
}

/// Runs a program and takes what it writes to its standard output.
Said run_program(const std::vector<std::string>& words) {
  Said said;
  int ends[2];
  if (::pipe(ends) != 0) throw FileError::from_errno("xacro", "cannot be run");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors(std::tmpfile(), &std::fclose);
  if (errors) posix_spawn_file_actions_adddup2(&actions, ::fileno(errors.get()), STDERR_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  std::vector<std::string> copies = words;
  std::vector<char*> pointers;
  for (std::string& word : copies) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  said.ran = ::posix_spawnp(&child, pointers[0], &actions, nullptr, pointers.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  char buffer[1 << 14];
  while (said.ran) {
    const ssize_t count = ::read(ends[0], buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    if (said.text.size() <= kMostXmlBytes)
      said.text.append(buffer, static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  said.too_long = said.text.size() > kMostXmlBytes;
  if (said.ran)
    while (::waitpid(child, &said.status, 0) < 0 && errno == EINTR) {
    }
  if (errors) said.complaint = last_line(errors.get());
  return said;
}

}  // namespace

std::string expanded_by_xacro(const std::string& file,
                              const std::map<std::string, std::string>& arguments) {
  static_cast<void>(read_file(file));  // A missing file is reported as such.
  std::vector<std::string> rest{file};
  for (const auto& [name, value] : arguments) rest.push_back(format("{}:={}", name, value));
  for (const std::vector<std::string>& program :
       {std::vector<std::string>{"xacro"}, std::vector<std::string>{"python3", "-m", "xacro"}}) {
    std::vector<std::string> words = program;
    words.insert(words.end(), rest.begin(), rest.end());
    const Said said = run_program(words);
    if (!said.ran) continue;
    if (said.too_long)
      throw FileError(file, format("xacro makes more than {} bytes of it", kMostXmlBytes),
                      "Build a model of this size in code.");
    if (WIFEXITED(said.status) && WEXITSTATUS(said.status) == 0) return said.text;
    if (program.size() > 1 || (WIFEXITED(said.status) && WEXITSTATUS(said.status) != 127))
      throw FileError(
          file,
          "xacro is missing or failed" + (said.complaint.empty() ? "" : ": " + said.complaint),
          "Install the Python package xacro, or expand the file and give the URDF.");
  }
  throw FileError(file, "needs xacro, which is not there",
                  "Install the Python package xacro, or expand the file and give the URDF.");
}

}  // namespace polhode::io
