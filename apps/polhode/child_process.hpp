// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace polhode::cli {

/// Path of the first of these programs that there is, by $PATH or as it stands; empty: none.
[[nodiscard]] std::string find_program(const std::vector<std::string>& names);

/// Another program that runs, with its own children, and is ended when this goes.
class ChildProcess {
 public:
  /// @param input    Where it reads from; -1: nothing.
  /// @param log      File that takes what it says.
  /// @throws FileError if it cannot be started.
  ChildProcess(const std::vector<std::string>& words, const std::string& log, int input = -1);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  /// Waits for its end. @returns its exit status; 128 if a signal ended it.
  int wait();
  /// Whether it still runs.
  [[nodiscard]] bool runs();

 private:
  pid_t id_ = -1;
  int status_ = 0;
};

}  // namespace polhode::cli
