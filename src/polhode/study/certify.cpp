// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/endless.hpp>
#include <polhode/study/certify.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/results/csv_probes.hpp>

namespace polhode {

namespace {

constexpr std::size_t kMaxSamples = 1000;
/// Number of common times of automatic steps for models without output times.
constexpr int kAutomaticSamples = 100;
/// Part of the distance of common times above which automatic steps are determined by these times
/// as well as by the tolerance; and the factor by which the next run's steps are then shortened.
constexpr double kLanding = 0.125, kShorter = 1.5;
/// Difference of times, as a part of their distance, below which they are equal.
constexpr double kSameTime = 1e-9;
/// Default tolerance of automatic steps, and the smallest one of a run.
constexpr double kStandardTolerance = 1e-6, kMinTolerance = 1e-14;
/// Difference, as a part of the model's scale, below which it is due to terminated iterations.
constexpr double kNegligible = 1e-9;
/// Difference, as a part of the range of motion, above which runs that do not converge are
/// different motions.
constexpr double kMatters = 0.05;
constexpr double kMinShown = 0.5;
/// Columns of counts or flags, which are not compared.
constexpr std::array<const char*, 3> kMarks = {"points", "status", "slips"};

/// Name and unit of a column "vx [m/s]".
struct Column {
  std::string name, unit;
  std::size_t index = 0;
};

Column column_of(const std::string& head, std::size_t index) {
  const std::size_t at = head.rfind(" [");
  if (at == std::string::npos) return {head, "-", index};
  return {head.substr(0, at), head.substr(at + 2, head.size() - at - 3), index};
}

/// Groups of columns: neighbours of one unit that differ in a final x, y or z.
std::vector<std::vector<Column>> groups_of(const std::vector<std::string>& header) {
  std::vector<std::vector<Column>> groups;
  const auto stem = [](const std::string& name) {
    const bool axis = !name.empty() && name.back() >= 'x' && name.back() <= 'z';
    return axis ? name.substr(0, name.size() - 1) : name + "!";
  };
  for (std::size_t i = 1; i < header.size(); ++i) {
    Column column = column_of(header[i], i);
    if (std::find(kMarks.begin(), kMarks.end(), column.name) != kMarks.end()) continue;
    const bool more = !groups.empty() && groups.back().back().unit == column.unit &&
                      stem(groups.back().back().name) == stem(column.name);
    if (!more) groups.emplace_back();
    groups.back().push_back(std::move(column));
  }
  return groups;
}

/// The rows of probes at given times.
class Sampler {
 public:
  Sampler(const Simulation& simulation, const std::vector<double>& times, double same)
      : times_(times), same_(same) {
    for (const ProbeSpec& spec : simulation.model().output.probes)
      targets_.push_back(probe_target(simulation, spec));
    rows_.resize(targets_.size());
  }
  void look(const Simulation& simulation) {
    const double t = simulation.time();
    for (; next_ < times_.size() && times_[next_] <= t + same_; ++next_) {
      const bool here = times_[next_] >= t - same_;
      for (std::size_t k = 0; k < targets_.size(); ++k)
        rows_[k].push_back(here ? probe_row(targets_[k], simulation)
                                : std::vector<double>(targets_[k].header.size(),
                                                      std::numeric_limits<double>::quiet_NaN()));
    }
  }
  [[nodiscard]] const std::vector<ProbeTarget>& targets() const { return targets_; }
  [[nodiscard]] std::size_t count() const { return next_; }
  [[nodiscard]] Mat values(std::size_t probe, const std::vector<Column>& columns,
                           std::size_t count) const {
    Mat m(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(columns.size()));
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < columns.size(); ++c)
        m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(c)) =
            rows_[probe][i][columns[c].index];
    return m;
  }

 private:
  const std::vector<double>& times_;
  double same_;
  std::vector<ProbeTarget> targets_;
  std::vector<std::vector<std::vector<double>>> rows_;  ///< By probe and time.
  std::size_t next_ = 0;
};

/// Multiples of an interval up to the end, thinned if there are too many, and the end.
std::vector<double> common_times(double distance, double end) {
  const double count = std::floor(end / distance * (1.0 + kSameTime));
  const double stride = std::max(1.0, std::ceil(count / static_cast<double>(kMaxSamples)));
  std::vector<double> times;
  for (double k = 0.0; k * distance < end * (1.0 - kSameTime); k += stride)
    times.push_back(k * distance);
  times.push_back(end);
  return times;
}

/// Probes of the centres of moving bodies, for a model that has none.
void add_probes(Model& model, std::vector<std::string>& notes) {
  if (!model.output.probes.empty()) return;
  std::size_t moving = 0;
  for (const BodySpec& body : model.bodies) {
    if (body.fixed || ++moving > kMaxOwnProbes) continue;
    ProbeSpec probe;
    probe.name = probe.target = body.name;
    probe.kind = "body";
    model.output.probes.push_back(probe);
  }
  if (model.output.probes.empty())
    throw InputError("output.probes", "are missing, so that there is nothing to compare",
                     "Add them, such as  tip: {solid: beam, point: [1, 0, 0]}");
  notes.push_back(moving > kMaxOwnProbes
                      ? format("The model has no probes: the first {} of {} moving bodies are "
                               "compared. Give it probes.",
                               kMaxOwnProbes, moving)
                      : "The model has no probes: its moving bodies are compared.");
}

/// Whether motions jump or slide, which lowers the order in time to one.
bool has_impacts(const Simulation& simulation) {
  const std::vector<JointSpec>& joints = simulation.model().joints;
  return simulation.has_contacts() || std::any_of(joints.begin(), joints.end(), [](const auto& j) {
           return j.friction || j.limits || j.angle_limits;
         });
}

/// Scales of each unit, from the model's size, weight and time.
std::map<std::string, double> model_scales(const Simulation& simulation, double duration) {
  double mass = 0.0;
  for (const BodySpec& body : simulation.model().bodies) mass += body.fixed ? 0.0 : body.mass;
  for (const SolidMap& solid : simulation.solids()) mass += solid.mass;
  const double length = simulation.system().length_scale(), rate = 1.0 / duration;
  const double acceleration = std::max(simulation.model().gravity.norm(), length * rate * rate);
  const double force = mass * acceleration;
  return {{"m", length},       {"m/s", length * rate},   {"m/s^2", acceleration},
          {"N", force},        {"N m", force * length},  {"J", force * length},
          {"rad", 1.0},        {"rad/s", rate},          {"-", 1.0},
          {"1/m", 1 / length}, {"N s", force * duration}};
}

/// Diagonal of the bounding box of values.
double range_of(const Mat& values) {
  double square = 0.0;
  for (Eigen::Index c = 0; c < values.cols(); ++c) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double x : values.col(c)) {
      if (std::isnan(x)) continue;
      low = std::min(low, x);
      high = std::max(high, x);
    }
    if (high > low) square += (high - low) * (high - low);
  }
  return std::sqrt(square);
}

double largest_size(const Mat& values) {
  double most = 0.0;
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    if (const double size = values.row(i).norm(); size > most) most = size;
  return most;
}

/// Values of the probes in the results of a model with automatic steps, if these are extrapolated:
/// the runs that are compared have one order. Nothing otherwise, or if its run does not finish.
std::optional<Sampler> own_samples(Model model, const std::vector<double>& times, double distance,
                                   const std::atomic<bool>* stop, std::string& scheme) {
  model.output.every = distance;
  Simulation simulation(std::move(model));
  scheme = simulation.summary().scheme;
  if (scheme.find("extrapolation") == std::string::npos) return std::nullopt;
  Sampler sampler(simulation, times, kSameTime * distance);
  const RunSummary summary =
      simulation.run([&](const Simulation& s) { sampler.look(s); }, {}, stop);
  if (summary.end != RunEnd::finished || sampler.count() < times.size()) return std::nullopt;
  return sampler;
}

}  // namespace

void check_certifiable(const Model& model) {
  const AnalysisSpec& a = model.analysis;
  if (a.type != "dynamics")
    throw InputError("analysis.type", format("is {}, which takes no steps in time", a.type),
                     "Certify a model of type dynamics; refine a mesh by hand");
  require_end(a);
  if (!a.step && a.tolerance.value_or(kStandardTolerance) < 99.9 * kMinTolerance)
    throw InputError(
        "analysis.tolerance",
        format("is {:g}; certify also runs with a hundredth of it, which is below the round-off",
               *a.tolerance),
        format("Write {:g} or more", 100.0 * kMinTolerance));
}

std::string CertifiedQuantity::name() const {
  std::string text = probe;
  for (const std::string& column : columns) text += " " + column;
  return text;
}

std::string CertifiedQuantity::order_text() const {
  constexpr double kMaxShown = 10.0;
  if (report.noise) return "rounding";
  if (!report.order) return "none";
  if (*report.order < kMinShown) return format("below {}", kMinShown);
  if (*report.order > kMaxShown) return format("above {}", kMaxShown);
  return format("{:.2f}", *report.order);
}

std::optional<double> CertifiedQuantity::unresolved_at() const {
  std::optional<double> at;
  double most = std::max(scale, negligible);
  for (std::size_t i = 0; i < series.t.size(); ++i)
    if (std::isfinite(report.bar[i]) && report.bar[i] > most) {
      most = report.bar[i];
      at = series.t[i];
    }
  return at;
}

bool Certificate::finished() const {
  return std::all_of(runs.begin(), runs.end(), [](const CertifiedRun& run) {
    return run.summary.end == RunEnd::finished && run.summary.steps > 0;
  });
}

bool Certificate::trusted() const {
  return std::all_of(runs.begin(), runs.end(),
                     [](const CertifiedRun& run) { return run.summary.trusted(); });
}

bool Certificate::converges() const {
  return finished() && std::none_of(quantities.begin(), quantities.end(),
                                    [](const auto& q) { return q.report.lost_from.has_value(); });
}

Certificate certify(const Model& original, const CertifyHooks& hooks) {
  check_certifiable(original);
  Model model = original;
  Certificate certificate;
  certificate.title = model.title;
  add_probes(model, certificate.notes);
  AnalysisSpec& a = model.analysis;
  certificate.automatic = !a.step;
  // Errors are compared at one order.
  const std::string method = a.method;
  if (certificate.automatic && !a.order && a.method == "automatic") a.method = "composition";
  certificate.duration = a.duration;
  const double first = a.step ? *a.step : a.tolerance.value_or(kStandardTolerance);
  const double part = certificate.automatic ? 0.1 : 0.5;
  double distance = a.step.value_or(0.0);
  if (certificate.automatic) {
    distance = model.output.every.value_or(a.duration / kAutomaticSamples);
    model.output.every = distance;
    model.output.between_steps = false;  // an interpolant's error has an order of its own
  }
  const std::vector<double> times = common_times(distance, a.duration);
  std::string scheme;
  const auto of_run = [&]() -> std::optional<Sampler> {
    if (a.method == method) return std::nullopt;
    Model as_given = model;
    as_given.analysis.method = method;
    as_given.output.between_steps = original.output.between_steps;
    return own_samples(std::move(as_given), times, distance, hooks.stop, scheme);
  };
  const std::optional<Sampler> own = of_run();
  if (own)
    certificate.notes.push_back(
        format("'polhode run' takes {}. Its results are compared with the finest of three runs by "
               "one order.",
               scheme));
  const std::optional<double> max_step = a.max_step;
  double most_step = distance;

  std::vector<Sampler> samplers;
  std::map<std::string, double> scales;
  for (int k = 0; k < 3; ++k) {
    CertifiedRun& run = certificate.runs[static_cast<std::size_t>(k)];
    run.setting = first * std::pow(part, k);
    if (certificate.automatic) {
      a.tolerance = run.setting;
      a.max_step = std::min(max_step.value_or(a.duration), most_step);
    } else {
      a.step = run.setting;
    }
    Simulation simulation(model);
    if (hooks.begin) hooks.begin(k, simulation);
    Sampler& sampler = samplers.emplace_back(simulation, times, kSameTime * distance);
    sampler.look(simulation);
    run.summary = simulation.run(
        [&](Simulation& s) {
          if (hooks.frame) hooks.frame(k, s);
        },
        [&](Simulation& s) {
          sampler.look(s);
          if (hooks.step) hooks.step(k, s);
        },
        hooks.stop);
    if (hooks.end) hooks.end(k, simulation);
    run.mean_step =
        run.summary.t / static_cast<double>(std::max<std::int64_t>(run.summary.steps, 1));
    if (run.mean_step > kLanding * distance || run.mean_step > 0.9 * a.max_step.value_or(1e300))
      most_step = run.mean_step / kShorter;
    if (k == 0) {
      scales = model_scales(simulation, a.duration);
      const double order = run.summary.order;
      certificate.orders =
          has_impacts(simulation) ? std::vector<double>{1.0, order} : std::vector<double>{order};
    }
    if (run.summary.end == RunEnd::interrupted) return certificate;
  }

  std::map<std::string, double> ranges = scales;
  std::size_t count = times.size();
  for (const Sampler& sampler : samplers) count = std::min(count, sampler.count());
  for (std::size_t p = 0; p < model.output.probes.size(); ++p)
    for (const std::vector<Column>& columns : groups_of(samplers[0].targets()[p].header)) {
      CertifiedQuantity q;
      q.probe = model.output.probes[p].name;
      q.unit = columns[0].unit;
      for (const Column& column : columns) q.columns.push_back(column.name);
      q.series.t.assign(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(count));
      for (std::size_t k = 0; k < 3; ++k)
        q.series.values[k] = samplers[k].values(p, columns, count);
      if (own) q.series.own = own->values(p, columns, count);
      q.scale = largest_size(q.series.values[2]);
      ranges[q.unit] = std::max(ranges[q.unit], range_of(q.series.values[2]));
      scales[q.unit] = std::max(scales[q.unit], q.scale);
      certificate.quantities.push_back(std::move(q));
    }
  RefinementRule rule;
  for (std::size_t k = 0; k < 3; ++k) {
    const CertifiedRun& run = certificate.runs[k];
    rule.h[k] = certificate.automatic ? run.mean_step : run.setting;
  }
  rule.orders = certificate.orders;
  const double rounding = std::numeric_limits<double>::epsilon() *
                          static_cast<double>(certificate.runs[2].summary.steps);
  for (CertifiedQuantity& q : certificate.quantities) {
    rule.floor = rounding * scales[q.unit];
    rule.negligible = q.negligible = kNegligible * scales[q.unit];
    rule.matters = kMatters * ranges[q.unit];
    q.report = estimate_error(q.series, rule);
  }
  return certificate;
}

}  // namespace polhode
