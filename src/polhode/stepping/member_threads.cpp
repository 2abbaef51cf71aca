// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>

#include <polhode/core/clock.hpp>
#include <polhode/stepping/member_threads.hpp>
#include <polhode/stepping/step_control.hpp>

namespace polhode {

namespace {

/// Members by thread: the longest first, each to the thread with the fewest steps so far. A thread
/// begins with its shortest one, which is the first to show that others are of no use.
std::vector<std::vector<std::size_t>> divided(const std::vector<int>& steps, std::size_t count,
                                              std::size_t threads) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return steps[a] > steps[b]; });
  std::vector<std::vector<std::size_t>> parts(threads);
  std::vector<int> sums(threads, 0);
  for (const std::size_t member : order) {
    const auto least = std::min_element(sums.begin(), sums.end());
    parts[static_cast<std::size_t>(least - sums.begin())].push_back(member);
    *least += steps[member];
  }
  for (std::vector<std::size_t>& part : parts) std::sort(part.begin(), part.end());
  return parts;
}

}  // namespace

MemberEnd take_member(State& member, int steps, double H, SingleStep& single,
                      const NewtonOptions& newton, bool fresh,
                      const std::function<bool()>& useless) {
  MemberEnd end;
  int iterations = 0;
  bool hard = false;
  double rounding = 0.0;
  single.ledger().forget();
  for (int k = 0; k < steps && !(useless && useless()); ++k) {
    SingleStep::Predictor predictor;
    predictor.degree = fresh && k == 0 ? -1 : step_control::kMemberDegree;
    predictor.watch_stops = true;
    end.report = single.take(member, H / steps, newton, predictor);
    iterations += end.report.iterations;
    hard = hard || end.report.hard;
    rounding = std::max(rounding, end.report.rounding);
    end.met_stop = end.report.converged && (single.stopped() || single.jumped());
    if (!end.report.converged || end.met_stop) break;
  }
  end.report.iterations = iterations;
  end.report.hard = hard;
  end.report.rounding = rounding;
  return end;
}

std::unique_ptr<MemberThreads> MemberThreads::make(const SingleStep& single, int threads) {
  std::unique_ptr<MemberThreads> made(new MemberThreads);
  for (int k = 1; k < threads; ++k) {
    std::unique_ptr<SingleStep> other = single.another();
    if (!other) return nullptr;
    made->singles_.push_back(std::move(other));
    made->workers_.push_back(std::make_unique<Worker>());
  }
  return made->singles_.empty() ? nullptr : std::move(made);
}

std::vector<MemberEnd> MemberThreads::take(std::span<State> members, const std::vector<int>& steps,
                                           double H, SingleStep& single,
                                           const NewtonOptions& newton, bool fresh,
                                           const std::function<bool()>& hopeless) {
  std::vector<MemberEnd> ends(members.size());
  const auto parts = divided(steps, members.size(), workers_.size() + 1);
  std::atomic<std::size_t> useful{members.size()};    // members from here on are of no use
  std::atomic<std::size_t> left{members.size() - 1};  // members that have not ended, but the last
  const auto end_from = [&](std::size_t j) {
    std::size_t now = useful;
    while (j < now && !useful.compare_exchange_weak(now, j)) {
    }
  };
  const auto take_part = [&](std::size_t part, SingleStep& by) {
    for (const std::size_t j : parts[part]) {
      const auto useless = [&, j] { return j >= useful.load(std::memory_order_relaxed); };
      ends[j] = take_member(members[j], steps[j], H, by, newton, fresh, useless);
      if (useless()) continue;
      if (!ends[j].report.converged || ends[j].met_stop)
        end_from(j + 1);
      else if (j + 1 < members.size() && left.fetch_sub(1) == 1 && hopeless())
        end_from(members.size() - 1);
    }
  };
  std::size_t started = 0;
  for (; started < workers_.size() && !parts[started + 1].empty(); ++started) {
    singles_[started]->hold_to_round_off(single.holds_to_round_off());
    workers_[started]->start([&, k = started] { take_part(k + 1, *singles_[k]); });
  }
  std::exception_ptr error;
  try {
    take_part(0, single);
  } catch (...) {
    error = std::current_exception();
  }
  const double begin = wall_clock();
  for (std::size_t k = 0; k < started; ++k) {
    try {
      workers_[k]->wait();
    } catch (...) {
      if (!error) error = std::current_exception();
    }
  }
  waited_ += wall_clock() - begin;
  if (error) std::rethrow_exception(error);
  return ends;
}

}  // namespace polhode
