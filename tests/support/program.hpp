// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <support/scratch.hpp>

namespace polhode::test {

/// How a program ended.
struct ProgramResult {
  int code = -1;  ///< Exit code; −1 if a signal killed it.
  std::string out, err;
  double cpu_seconds = 0.0;
};

inline std::string text_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

/// A program that was started in a folder; wait() returns its result.
class Program {
 public:
  Program(const std::vector<std::string>& words, const std::string& folder) {
    process_ = fork();
    if (process_ != 0) return;
    alarm(100);  // A program that hangs ends by itself; the alarm outlives execv.
    const auto redirect = [](const std::string& file, int descriptor) {
      const int target = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      dup2(target, descriptor);
    };
    redirect(scratch_ / "out", STDOUT_FILENO);
    redirect(scratch_ / "err", STDERR_FILENO);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    if (chdir(folder.c_str()) == 0) execv(arguments[0], arguments.data());
    _exit(127);
  }

  void signal(int number) const { kill(process_, number); }

  ProgramResult wait() {
    int status = 0;
    rusage usage{};
    wait4(process_, &status, 0, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return {.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            .out = text_of(scratch_ / "out"),
            .err = text_of(scratch_ / "err"),
            .cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime)};
  }

 private:
  Scratch scratch_;
  pid_t process_ = -1;
};

}  // namespace polhode::test
