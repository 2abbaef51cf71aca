// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/simulation/probe.hpp>
#include <polhode/simulation/trust.hpp>
#include <polhode/study/batch.hpp>
#include <polhode/study/side_by_side.hpp>

namespace polhode {

namespace {

/// Difference of times, as a part of the output interval, below which they are equal.
constexpr double kSameFrame = 1e-9;

/// Times of the frames of every run: multiples of the output interval, and the end.
std::vector<double> frame_times(const Model& model) {
  const AnalysisSpec& a = model.analysis;
  if (a.type != "dynamics")
    throw InputError("analysis.type", format("is '{}', which has no frames in time", a.type),
                     "A batch needs type: dynamics");
  require_end(a);
  const std::optional<double> every = model.output.every ? model.output.every : a.step;
  if (!every)
    throw InputError("output.every", "is not given, and steps are automatic",
                     "Give the interval of the frames, as all runs have the same");
  if (a.step) {
    const double steps = *every / *a.step;
    if (std::abs(steps - std::round(steps)) > kSameFrame * steps)
      throw InputError("output.every", format("is {:.6g} steps", steps),
                       "Give a multiple of analysis.step, so that frames are ends of steps");
  }
  std::vector<double> times;
  for (std::int64_t k = 0; static_cast<double>(k) * *every < a.duration - kSameFrame * *every; ++k)
    times.push_back(static_cast<double>(k) * *every);
  times.push_back(a.duration);
  return times;
}

/// A batch while it is computed.
class BatchWork {
 public:
  BatchWork(const std::function<Model(std::size_t)>& model, std::size_t runs,
            const BatchOptions& options)
      : model_(model), options_(options), runs_(runs), first_(model_of(0)) {
    batch_.times = frame_times(first_);
    batch_.why_alone = why_alone(first_);
    batch_.messages.resize(runs);
    batch_.alone.assign(runs, 1);
    const std::vector<std::string> asked =
        options.channels.empty() ? usual_channels(first_) : options.channels;
    for (const std::string& text : asked) {
      channels_.push_back(batch_channel(first_, text));
      const BatchChannel& c = channels_.back();
      objects_.push_back(object_of(c.of));
      batch_.channels.push_back(
          {.text = text,
           .unit = c.unit,
           .size = c.columns.size(),
           .one = c.one,
           .numbers = std::vector<double>(runs * batch_.times.size() * c.columns.size(),
                                          std::numeric_limits<double>::quiet_NaN())});
    }
  }

  Batch take() {
    const std::size_t most =
        batch_.why_alone.empty() ? std::max<std::size_t>(1, options_.together) : 1;
    const std::size_t groups = (runs_ + most - 1) / most;
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t g = next++; g < groups && !stopped(); g = next++)
        take_group(g * most, std::min(runs_, (g + 1) * most));
    };
    std::vector<std::thread> threads;
    const std::size_t count =
        std::min(groups, static_cast<std::size_t>(std::max(1, options_.threads)));
    for (std::size_t k = 1; k < count; ++k) threads.emplace_back(work);
    work();
    for (std::thread& thread : threads) thread.join();
    batch_.stopped = stopped();
    return std::move(batch_);
  }

 private:
  /// A run of a group: its number and its model.
  struct Member {
    std::size_t run;
    Model model;
  };

  [[nodiscard]] bool stopped() const { return options_.stop && options_.stop->load(); }

  std::size_t object_of(const ProbeSpec& spec) {
    for (std::size_t i = 0; i < specs_.size(); ++i)
      if (specs_[i].kind == spec.kind && specs_[i].target == spec.target &&
          specs_[i].name == spec.name)
        return i;
    specs_.push_back(spec);
    return specs_.size() - 1;
  }

  /// The model of a run, which has one thread, as runs share the processors.
  [[nodiscard]] Model model_of(std::size_t run) const {
    Model model = model_(run);
    model.analysis.threads = 1;
    return model;
  }

  void take_group(std::size_t from, std::size_t to) {
    std::vector<Member> members;
    for (std::size_t run = from; run < to; ++run) {
      try {
        Model model = model_of(run);
        if (batch_.why_alone.empty() && same_mechanism(first_, model))
          members.push_back({run, std::move(model)});
        else
          take_alone(run, std::move(model));
      } catch (const std::exception& e) {
        batch_.messages[run] = e.what();
      }
    }
    if (members.size() > 1 && take_together(members)) return;
    for (Member& member : members) take_alone(member.run, std::move(member.model));
  }

  /// Runs of one group in one system. @returns false if some of them are no plain runs.
  bool take_together(const std::vector<Member>& members) {
    try {
      std::vector<Model> models;
      std::vector<std::size_t> runs;
      std::vector<ProbeSpec> specs;
      for (std::size_t k = 0; k < members.size(); ++k) {
        models.push_back(members[k].model);
        runs.push_back(members[k].run);
        for (ProbeSpec spec : specs_of(members[k].model)) {
          spec.target = name_side_by_side(k, spec.target);
          if (spec.seen_from != kGround)
            spec.seen_from += static_cast<int>(k * first_.bodies.size());
          specs.push_back(std::move(spec));
        }
      }
      Simulation simulation(side_by_side(std::move(models)));
      const RunSummary summary = observe(simulation, runs, specs);
      if (stopped()) return true;
      // A drift of one run is a part of the whole system's energy or momentum.
      const double allowed =
          allowed_drift(simulation.model()) / static_cast<double>(members.size());
      if (summary.end != RunEnd::finished || summary.rejected_steps > 0 || !summary.trusted() ||
          summary.energy_drift > allowed)
        return false;
      for (const std::size_t run : runs) batch_.alone[run] = 0;
      return true;
    } catch (const std::exception&) {
      return false;  // which run, and why, each alone will say
    }
  }

  void take_alone(std::size_t run, Model model) {
    if (stopped()) return;
    try {
      const std::vector<ProbeSpec> specs = specs_of(model);
      Simulation simulation(std::move(model));
      const RunSummary summary = observe(simulation, {run}, specs);
      if (summary.end == RunEnd::not_converged) batch_.messages[run] = summary.message;
      for (const std::string& reason : summary.distrust)
        batch_.messages[run] += (batch_.messages[run].empty() ? "not trusted: " : " ") + reason;
    } catch (const std::exception& e) {
      batch_.messages[run] = e.what();
    }
  }

  /// Objects that are read of a run: probes are those of its own model, as their points may vary.
  [[nodiscard]] std::vector<ProbeSpec> specs_of(const Model& model) const {
    std::vector<ProbeSpec> specs = specs_;
    for (ProbeSpec& spec : specs)
      if (!spec.name.empty())
        spec = model.output.probes[static_cast<std::size_t>(model.probe_index(spec.name))];
    return specs;
  }

  /// @param specs  What is read of each run, one run after the other.
  RunSummary observe(Simulation& simulation, const std::vector<std::size_t>& runs,
                     const std::vector<ProbeSpec>& specs) {
    std::vector<ProbeTarget> targets;
    for (const ProbeSpec& spec : specs)
      targets.push_back(probe_target(simulation, spec, "the channel"));
    forget(runs);
    return simulation.run(
        [&](const Simulation& s) {
          const std::size_t frame = frame_at(s.time());
          if (frame == batch_.times.size()) return;
          for (std::size_t k = 0; k < runs.size(); ++k) {
            std::vector<std::vector<double>> rows;
            for (std::size_t i = 0; i < specs_.size(); ++i)
              rows.push_back(probe_row(targets[k * specs_.size() + i], s));
            for (std::size_t c = 0; c < channels_.size(); ++c) {
              const std::vector<std::size_t>& columns = channels_[c].columns;
              double* to = place(c, runs[k], frame);
              for (std::size_t i = 0; i < columns.size(); ++i)
                to[i] = rows[objects_[c]][1 + columns[i]];
            }
          }
        },
        {}, options_.stop);
  }

  double* place(std::size_t channel, std::size_t run, std::size_t frame) {
    Batch::Channel& c = batch_.channels[channel];
    return c.numbers.data() + (run * batch_.times.size() + frame) * c.size;
  }

  /// Numbers of an earlier trial with others.
  void forget(const std::vector<std::size_t>& runs) {
    for (std::size_t c = 0; c < channels_.size(); ++c)
      for (const std::size_t run : runs)
        std::fill_n(place(c, run, 0), batch_.times.size() * batch_.channels[c].size,
                    std::numeric_limits<double>::quiet_NaN());
  }

  /// Frame of a time; the number of frames for the end of a run that an event has stopped between
  /// them.
  [[nodiscard]] std::size_t frame_at(double t) const {
    const std::vector<double>& times = batch_.times;
    const double same = kSameFrame * times[1];
    const auto at = std::lower_bound(times.begin(), times.end(), t - same);
    return at != times.end() && *at <= t + same ? static_cast<std::size_t>(at - times.begin())
                                                : times.size();
  }

  const std::function<Model(std::size_t)>& model_;
  const BatchOptions& options_;
  std::size_t runs_;
  Model first_;
  Batch batch_;
  std::vector<BatchChannel> channels_;
  std::vector<ProbeSpec> specs_;      ///< What is read, each object once; of the first run.
  std::vector<std::size_t> objects_;  ///< By channel.
};

}  // namespace

Batch run_batch(const std::function<Model(std::size_t)>& model, std::size_t runs,
                const BatchOptions& options) {
  if (runs == 0)
    throw InputError("the batch", "has no runs", "Give at least one value of each parameter");
  return BatchWork(model, runs, options).take();
}

}  // namespace polhode
