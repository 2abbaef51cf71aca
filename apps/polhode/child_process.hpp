// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace polhode::cli {

/// Path of the first existing one of these programs, by $PATH or as given; empty: none.
[[nodiscard]] std::string find_program(const std::vector<std::string>& names);

/// A running program with its children, terminated with this object.
class ChildProcess {
 public:
  /// @param input  Its standard input; -1: none.
  /// @param log  File of its output.
  /// @throws FileError if it cannot be started.
  ChildProcess(const std::vector<std::string>& words, const std::string& log, int input = -1);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  /// Waits until it ends. @returns its exit status; 128 if a signal ended it.
  int wait();
  /// Whether it is still running.
  [[nodiscard]] bool runs();

 private:
  pid_t id_ = -1;
  int status_ = 0;
};

}  // namespace polhode::cli
