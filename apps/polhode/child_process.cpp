// SPDX-License-Identifier: Apache-2.0
#include "child_process.hpp"

#include <csignal>
#include <cstdlib>
#include <sstream>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <polhode/io/text/file_error.hpp>

extern char** environ;

namespace polhode::cli {

std::string find_program(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    if (name.empty()) continue;
    if (name.find('/') != std::string::npos) {
      if (::access(name.c_str(), X_OK) == 0) return name;
      continue;
    }
    std::istringstream folders(path == nullptr ? "" : path);
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const std::string file = folder + "/" + name; ::access(file.c_str(), X_OK) == 0)
        return file;
  }
  return "";
}

ChildProcess::ChildProcess(const std::vector<std::string>& words, const std::string& log,
                           int input) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  if (input < 0)
    posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
  else
    posix_spawn_file_actions_adddup2(&files, input, 0);
  posix_spawn_file_actions_addopen(&files, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, 1, 2);
  posix_spawnattr_t how;
  posix_spawnattr_init(&how);
  posix_spawnattr_setflags(&how, POSIX_SPAWN_SETPGROUP);
  const int fault = posix_spawn(&id_, words[0].c_str(), &files, &how, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  posix_spawnattr_destroy(&how);
  if (fault != 0) {
    id_ = -1;
    throw io::FileError(words[0], "cannot be started", "Name another program");
  }
}

ChildProcess::~ChildProcess() {
  if (!runs()) return;
  ::kill(-id_, SIGTERM);
  for (int k = 0; k < 100 && runs(); ++k) ::usleep(20000);
  if (!runs()) return;
  ::kill(-id_, SIGKILL);
  wait();
}

int ChildProcess::wait() {
  if (id_ >= 0) ::waitpid(id_, &status_, 0);
  id_ = -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128;
}

bool ChildProcess::runs() {
  if (id_ >= 0 && ::waitpid(id_, &status_, WNOHANG) == id_) id_ = -1;
  return id_ >= 0;
}

}  // namespace polhode::cli
