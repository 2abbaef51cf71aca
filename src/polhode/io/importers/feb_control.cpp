// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// Steps that an analysis may have; more are an error of the file.
constexpr double kMostSteps = 1e9;
/// Difference of intervals that are equal, over their length.
constexpr double kEqual = 1e-9;

/// A number that must be above zero; 1 after an error.
double positive(FebFile& file, const Element& section, const char* tag) {
  const auto value = file.number(section, tag);
  if (value && *value > 0.0) return *value;
  if (value || file.child(section, tag) == nullptr)
    file.xml.fault(section,
                   format("<{}> of <Control> is {}", tag, value ? format("{}", *value) : "missing"),
                   "Give a number above 0.");
  return 1.0;
}

/// Spectral radius of FEBio's time integration.
double spectral_radius(FebFile& file, const Element& solver) {
  const auto rho = file.number(solver, "rhoi");
  const double alpha = file.number(solver, "alpha").value_or(1.0);
  const double beta = file.number(solver, "beta").value_or(0.25);
  const double gamma = file.number(solver, "gamma").value_or(0.5);
  if (rho && *rho >= 0.0 && *rho <= 1.0) return *rho;
  if (rho && *rho == -1.0) {
    file.approximated(solver, "rhoi -1, the implicit Euler rule, becomes rho_inf 0");
    return 0.0;
  }
  if (alpha != 1.0 || beta != 0.25 || gamma != 0.5)
    file.approximated(
        solver, format("alpha {}, beta {} and gamma {} become rho_inf 1", alpha, beta, gamma));
  return 1.0;
}

/// Equal interval of the must points of a load curve up to an end; 0 if they differ.
double equal_interval(const std::vector<std::array<double, 2>>& points, double end) {
  double last = 0.0, interval = 0.0;
  for (const auto& p : points) {
    if (p[0] <= 0.0) continue;
    if (p[0] > end * (1.0 + kEqual)) break;
    if (interval == 0.0) interval = p[0];
    if (std::abs(p[0] - last - interval) > kEqual * end) return 0.0;
    last = p[0];
  }
  return interval;
}

/// Settings of one <Control>.
struct Asked {
  double step = 1.0;       ///< [s]
  double every = 0.0;      ///< Interval of output [s]; 0: none.
  bool automatic = false;  ///< A time stepper chooses the steps.
  double longest = 0.0;    ///< Of the time stepper [s]; 0: none.
  double radius = 1.0;     ///< Spectral radius.
  bool operator==(const Asked&) const = default;
};

Asked asked_by(FebModel& model, const Element& section) {
  FebFile& file = model.file;
  Asked asked;
  asked.step = file.number(section, "step_size").value_or(1.0);
  asked.every = model.dynamic ? 0.0 : asked.step;
  if (const Element* stepper = file.child(section, "time_stepper")) {
    const FebValue most = file.value(*stepper, "dtmax", 0.1);
    asked.automatic = true;
    asked.longest = most.factor;
    if (!most.is_constant()) {
      const auto points = model.curves.points(*most.controller);
      asked.longest = 0.0;
      for (const auto& p : points) asked.longest = std::max(asked.longest, p[1]);
      asked.every = equal_interval(points, model.duration);
      if (asked.every == 0.0 && !points.empty())
        file.approximated(*stepper,
                          "must points at different intervals are no output times: steps end "
                          "at kinks of the loads in any case");
    }
    file.ignored.attributes(*stepper, {"type"});
    file.skip_all(*stepper,
                  {"dtmin", "max_retries", "opt_iter", "aggressiveness", "cutback", "dtforce"});
    if (model.dynamic)
      file.approximated(
          *stepper, "the time stepper becomes automatic steps by their error, of at most dtmax");
  }
  if (const Element* solver = file.child(section, "solver")) {
    asked.radius = spectral_radius(file, *solver);
    file.ignored.attributes(*solver, {"type"});
    file.skip_all(*solver, {"symmetric_stiffness",
                            "equation_scheme",
                            "equation_order",
                            "optimize_bw",
                            "lstol",
                            "lsmin",
                            "lsiter",
                            "ls_check_jacobians",
                            "max_refs",
                            "check_zero_diagonal",
                            "zero_diagonal_tol",
                            "force_partition",
                            "reform_each_time_step",
                            "reform_augment",
                            "diverge_reform",
                            "min_residual",
                            "max_residual",
                            "dtol",
                            "etol",
                            "rtol",
                            "logSolve",
                            "arc_length",
                            "arc_length_scale",
                            "qn_method",
                            "linear_solver",
                            "use_lumped_mass",
                            "mass_lumping",
                            "print_level"});
    file.ignored.add(*solver, "<solver> with its tolerances", "is FEBio's");
  }
  file.skip_all(section,
                {"plot_level", "plot_range", "plot_stride", "plot_zero_state", "output_level",
                 "output_stride", "adaptor_re_solve", "print_level", "optimize_bw", "restart",
                 "integration", "symmetric_stiffness", "analysis", "time_steps", "step_size"});
  return asked;
}

/// Whether the analysis of a step is dynamic.
bool is_dynamic(FebFile& file, const Element& control) {
  const std::string kind = lower_case(file.text(control, "analysis"));
  const bool dynamic = kind == "dynamic" || kind == "1" || kind == "2";
  if (!dynamic && !kind.empty() && kind != "static" && kind != "0" && kind != "steady-state")
    file.refuse(*file.child(control, "analysis"),
                format("the analysis {} is not read", quote(kind)), "Use STATIC or DYNAMIC.");
  return dynamic;
}

}  // namespace

void read_feb_control(FebModel& model) {
  FebFile& file = model.file;
  for (FebStep& s : model.steps) {
    const bool dynamic = is_dynamic(file, *s.control);
    if (&s == &model.steps.front())
      model.dynamic = dynamic;
    else if (dynamic != model.dynamic)
      file.xml.fault(*s.control, "some steps are STATIC and others DYNAMIC",
                     "Give all steps one analysis, or run them as two models.");
    const double steps = std::round(positive(file, *s.control, "time_steps"));
    const double length = positive(file, *s.control, "step_size");
    s.begin = model.duration;
    s.end = model.duration + steps * length;
    if (!(steps >= 1.0 && steps <= kMostSteps && std::isfinite(s.end) && s.end > s.begin)) {
      file.xml.fault(*s.control, format("the analysis has {} steps of {}", steps, length),
                     format("Give 1 to {} steps of a finite length.", kMostSteps));
      s.end = s.begin + 1.0;
    }
    model.duration = s.end;
  }
}

void write_feb_control(FebModel& model, SourceNode probes, SourceNode& root) {
  FebFile& file = model.file;
  const Element& first = *model.steps.front().control;
  const NodeBuilder make = file.make(first);
  Asked all = asked_by(model, first);
  bool differ = false;
  const Element* last = &first;
  for (const FebStep& s : model.steps) {
    if (s.control == last) continue;
    last = s.control;
    const Asked own = asked_by(model, *s.control);
    differ = differ || own != all;
    all.step = std::min(all.step, own.step);
    if (own.every > 0.0) all.every = all.every > 0.0 ? std::min(all.every, own.every) : own.every;
    all.automatic = all.automatic || own.automatic;
    if (own.longest > 0.0)
      all.longest = all.longest > 0.0 ? std::min(all.longest, own.longest) : own.longest;
  }
  if (differ)
    file.approximated(*last,
                      "steps with different settings all have the shortest length of a step, and "
                      "the damping of the first");
  const double steps = std::round(model.duration / all.step);
  SourceNode analysis = make.map(), output = make.map();
  make.put(analysis, "type", make.text(model.dynamic ? "dynamics" : "statics"));
  make.put(analysis, model.dynamic ? "duration" : "history", make.number(model.duration));
  if (!model.dynamic) {
    make.put(analysis, "load_steps", make.number(std::clamp(steps, 1.0, 1e5)));
  } else if (all.automatic) {
    make.put(analysis, "step", make.text("auto"));
    if (all.longest > 0.0) make.put(analysis, "max_step", make.number(all.longest));
  } else {
    make.put(analysis, "step", make.number(all.step));
  }
  if (model.dynamic && all.radius != 1.0) make.put(analysis, "rho_inf", make.number(all.radius));
  make.put(root, "analysis", std::move(analysis));
  if (model.frames && all.every == 0.0 && !all.automatic) all.every = all.step;
  if (all.every > 0.0) make.put(output, "every", make.number(all.every));
  if (!probes.keys.empty()) make.put(output, "probes", std::move(probes));
  if (!output.keys.empty()) make.put(root, "output", std::move(output));
}

}  // namespace polhode::io
