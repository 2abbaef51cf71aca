// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include <polhode/core/threads.hpp>

namespace polhode {

namespace {

/// Looks at the state before a thread sleeps: some 20 microseconds, a few times what it takes to
/// wake one.
constexpr int kLooks = 4000;

std::atomic<int>& number_of_threads() {
  static std::atomic<int> number{0};
  return number;
}

/// Hint that the thread waits actively.
void rest() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

int threads_of_runs() { return number_of_threads(); }

void set_threads_of_runs(int threads) { number_of_threads() = std::max(0, threads); }

Worker::Worker() : thread_([this] { work(); }) {}

Worker::~Worker() {
  state_ = ended;
  state_.notify_all();
  thread_.join();
}

void Worker::start(std::function<void()> task) {
  task_ = std::move(task);
  state_ = working;
  state_.notify_all();
}

void Worker::wait() {
  leaves(working);
  state_ = idle;
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

int Worker::leaves(int state) {
  for (int k = 0; k < kLooks; ++k) {
    if (const int now = state_.load(std::memory_order_acquire); now != state) return now;
    rest();
  }
  state_.wait(state, std::memory_order_acquire);
  return state_.load(std::memory_order_acquire);
}

void Worker::work() {
  for (;;) {
    int now = state_.load(std::memory_order_acquire);
    while (now == idle || now == done) now = leaves(now);
    if (now == ended) return;
    try {
      task_();
    } catch (...) {
      error_ = std::current_exception();
    }
    state_ = done;
    state_.notify_all();
  }
}

}  // namespace polhode
