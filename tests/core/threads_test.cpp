// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/threads.hpp>

#include <chrono>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace polhode::threads_tests {
namespace {

TEST(Threads, AtLeastOne) {
  EXPECT_EQ(threads_of_runs(), 0);
  set_threads_of_runs(3);
  EXPECT_EQ(threads_of_runs(), 3);
  set_threads_of_runs(-1);
  EXPECT_EQ(threads_of_runs(), 0);
}

TEST(Threads, AWorkerDoesOneTaskAfterAnother) {
  Worker worker;
  int sum = 0;
  for (int k = 1; k <= 1000; ++k) {
    worker.start([&] { sum += k; });
    worker.wait();
    ASSERT_EQ(sum, k * (k + 1) / 2);
  }
}

TEST(Threads, AWorkerWakesFromSleep) {
  Worker worker;
  for (const int pause : {0, 1, 20}) {
    std::this_thread::sleep_for(std::chrono::milliseconds(pause));
    bool slept = false;
    worker.start([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause));
      slept = true;
    });
    worker.wait();
    EXPECT_TRUE(slept);
  }
}

TEST(Threads, ExceptionsOfATaskReachTheOneThatWaits) {
  Worker worker;
  worker.start([] { throw std::runtime_error("no"); });
  EXPECT_THROW(worker.wait(), std::runtime_error);
  bool done = false;
  worker.start([&] { done = true; });
  worker.wait();
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace polhode::threads_tests
