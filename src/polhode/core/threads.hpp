// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <thread>

namespace polhode {

/// Number of threads of a run that begins from now on and whose model names none, for all runs of
/// the program; 0, as at first: chosen by the size of the model. Results have the same bits with
/// any number.
[[nodiscard]] int threads_of_runs();
/// @param threads  At least 0.
void set_threads_of_runs(int threads);

/// A thread that does one task after another. It waits for the next one actively for some
/// microseconds, so that tasks of a tenth of a millisecond gain by it, then asleep.
class Worker {
 public:
  Worker();
  /// Ends the thread; no task may be running.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Starts a task; the one before must have been awaited.
  void start(std::function<void()> task);
  /// Waits until the task has ended, and rethrows its exception.
  void wait();

 private:
  enum State : int { idle, working, done, ended };
  void work();
  /// Waits until the state is another one.
  int leaves(int state);

  std::atomic<int> state_{idle};
  std::function<void()> task_;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace polhode
