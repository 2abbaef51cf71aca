// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <polhode/core/threads.hpp>
#include <polhode/stepping/single_step.hpp>

namespace polhode {

/// End of a member of an extrapolated step.
struct MemberEnd {
  NewtonReport report;
  bool met_stop = false;  ///< A joint stop was met; the rest of its steps were not taken.
};

/// Takes the equal steps of a member. @param member  In: the start; out: the end.
/// @param fresh  Predict the first step from the velocities at t_n.
/// @param useless  Asked before each step: whether the member is of no use any more, which ends it.
[[nodiscard]] MemberEnd take_member(State& member, int steps, double H, SingleStep& single,
                                    const NewtonOptions& newton, bool fresh,
                                    const std::function<bool()>& useless = {});

/// Members of an extrapolated step in several threads, as equally divided as their numbers of steps
/// allow. A member does not depend on the others, so its bits are those of one thread.
class MemberThreads {
 public:
  /// @returns null if there is one thread only, or the engine cannot be had twice.
  [[nodiscard]] static std::unique_ptr<MemberThreads> make(const SingleStep& single, int threads);

  /// A member that fails ends those after it, which are of no use then.
  /// @param members  In: the start, in each; out: their ends. @param steps  Of each member.
  /// @param hopeless  Asked once all but the last member have ended, in any thread: whether the
  /// last one is of no use.
  [[nodiscard]] std::vector<MemberEnd> take(std::span<State> members, const std::vector<int>& steps,
                                            double H, SingleStep& single,
                                            const NewtonOptions& newton, bool fresh,
                                            const std::function<bool()>& hopeless);
  [[nodiscard]] double waited() const { return waited_; }

 private:
  MemberThreads() = default;
  std::vector<std::unique_ptr<SingleStep>> singles_;  ///< Of the other threads.
  std::vector<std::unique_ptr<Worker>> workers_;
  double waited_ = 0.0;  ///< [s]
};

}  // namespace polhode
