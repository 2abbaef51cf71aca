// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <polhode/study/batch_channel.hpp>

namespace polhode {

/// Settings of a batch.
struct BatchOptions {
  std::vector<std::string> channels{};      ///< See batch_channel(); empty: usual_channels().
  int threads = 1;                          ///< Numbers do not depend on it.
  std::size_t together = 32;                ///< Largest number of runs in one system.
  const std::atomic<bool>* stop = nullptr;  ///< Ends the batch when it becomes true.
};

/// Numbers of many runs of one mechanism.
struct Batch {
  /// A channel's numbers: (runs, frames, size), NaN where a run did not get.
  struct Channel {
    std::string text, unit;
    std::size_t size = 1;
    bool one = false;  ///< A single number, not a list of one.
    std::vector<double> numbers{};
  };
  std::vector<double> times;  ///< Of the frames [s].
  std::vector<Channel> channels;
  /// By run: why it was not finished, or is not to be trusted; empty if it was and is.
  std::vector<std::string> messages;
  std::vector<unsigned char> alone;  ///< By run: whether it was in a system of its own.
  std::string why_alone;             ///< Why all were, a phrase; empty if they need not be.
  bool stopped = false;              ///< Ended by BatchOptions::stop.
};

/// Runs one mechanism with many values of its numbers, several runs side by side in one system:
/// a forest of trees that do not interact, whose bodies share the lanes of the vector kernels and
/// the cost of a step.
///
/// Runs side by side have the steps they would have alone and equal equations; their numbers differ
/// from those of runs alone by rounding and by further Newton iterations of their neighbours. What
/// is no plain run goes alone: a run whose numbers change the mechanism, or whose neighbours' steps
/// did not converge, or whose balances do not close. So a run that fails does so with its own
/// message and disturbs no other one. Which runs are side by side depends on their order only, not
/// on the number of threads.
/// @param model  Model of a run, by number; called from several threads at a time. A run whose
/// model cannot be made, for which it throws std::exception, has that message.
/// @throws InputError if a channel is not known, or the model of the first run cannot be made.
[[nodiscard]] Batch run_batch(const std::function<Model(std::size_t)>& model, std::size_t runs,
                              const BatchOptions& options = {});

}  // namespace polhode
