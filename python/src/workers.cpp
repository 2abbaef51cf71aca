// SPDX-License-Identifier: Apache-2.0
// Simulations that advance side by side in threads.
#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

#include "engine.hpp"

namespace polhode::python {

namespace {

/// Threads that share the items of one task after another; the calling thread takes part.
class Workers {
 public:
  explicit Workers(int threads) {
    for (int k = 1; k < threads; ++k) threads_.emplace_back([this] { work(); });
  }
  ~Workers() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    begins_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int size() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls what(i) for i < count; it must not throw.
  void run(std::size_t count, const std::function<void(std::size_t)>& what) {
    {
      const std::lock_guard lock(mutex_);
      what_ = &what;
      count_ = count;
      next_ = 0;
      busy_ = threads_.size();
      ++task_;
    }
    begins_.notify_all();
    take_items();
    std::unique_lock lock(mutex_);
    ends_.wait(lock, [this] { return busy_ == 0; });
  }

 private:
  void take_items() {
    for (std::size_t i = next_++; i < count_; i = next_++) (*what_)(i);
  }
  void work() {
    for (std::size_t done = 0;;) {
      {
        std::unique_lock lock(mutex_);
        begins_.wait(lock, [&] { return ended_ || task_ != done; });
        if (ended_) return;
        done = task_;
      }
      take_items();
      const std::lock_guard lock(mutex_);
      if (--busy_ == 0) ends_.notify_one();
    }
  }

  std::mutex mutex_;
  std::condition_variable begins_, ends_;
  const std::function<void(std::size_t)>* what_ = nullptr;
  std::size_t count_ = 0, busy_ = 0, task_ = 0;
  std::atomic<std::size_t> next_{0};
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

using Input = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Advances several engines to times of their own, with numbers held over the way.
/// @param held     A row for each engine.
/// @param observe  Whether q and their rates are returned.
/// @returns by engine an empty text, or why a step was not accepted; and (engines, 2 n) numbers.
nb::tuple advance_all(Workers& workers, const std::vector<Engine*>& engines,
                      const std::vector<double>& until, const Input& held, bool observe) {
  const std::size_t count = engines.size();
  if (until.size() != count || held.shape(0) != count)
    throw nb::value_error("Give one time and one row of numbers for each simulation.");
  std::vector<std::unique_ptr<Engine::Use>> uses;
  for (std::size_t i = 0; i < count; ++i) {
    const auto numbers = engines[i]->held();
    const std::size_t size = numbers ? numbers->now.size() : 0;
    if (held.shape(1) != size)
      throw nb::value_error(
          format("There are {} moments and forces, not {}.", size, held.shape(1)).c_str());
    uses.push_back(std::make_unique<Engine::Use>(*engines[i]));
    for (std::size_t k = 0; k < size; ++k) {
      const double value = held(i, k);
      if (!std::isfinite(value)) throw nb::value_error("tau is not finite");
      numbers->now[k] = value;
    }
  }
  const std::size_t n = observe && count > 0 ? engines.front()->coordinates().size() : 0;
  std::vector<double> seen(2 * n * count);
  std::vector<std::string> messages(count);
  std::vector<std::exception_ptr> errors(count);
  {
    const nb::gil_scoped_release unlocked;
    workers.run(count, [&](std::size_t i) {
      try {
        messages[i] = advance(**uses[i], until[i]);
        if (!observe) return;
        const Coordinates& of = engines[i]->coordinates();
        if (of.size() != n)
          throw InputError("coordinates", "change in number where an event switches a joint",
                           "Use step() of single simulations");
        const Simulation& simulation = **uses[i];
        const JointSpace::Motions motions = of.motions(simulation.system(), simulation.state());
        const std::vector<double> q = of.positions(simulation.system(), simulation.state(),
                                                   motions),
                                  qd = of.space().rates(motions);
        std::copy(q.begin(), q.end(), seen.data() + 2 * n * i);
        std::copy(qd.begin(), qd.end(), seen.data() + 2 * n * i + n);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    });
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  return nb::make_tuple(nb::cast(messages), array_of(std::move(seen), {count, 2 * n}));
}

}  // namespace

void bind_workers(nb::module_& m) {
  nb::class_<Workers>(m, "Workers", "Threads for simulations side by side.")
      .def(nb::init<int>(), nb::arg("threads"))
      .def_prop_ro("size", &Workers::size)
      .def("advance", &advance_all, nb::arg("engines"), nb::arg("until"), nb::arg("tau"),
           nb::arg("observe"));
}

}  // namespace polhode::python
