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

}  // namespace

void read_feb_control(FebModel& model, const Element& section) {
  FebFile& file = model.file;
  const std::string kind = lower_case(file.text(section, "analysis"));
  model.dynamic = kind == "dynamic" || kind == "1" || kind == "2";
  if (!model.dynamic && !kind.empty() && kind != "static" && kind != "0" && kind != "steady-state")
    file.refuse(*file.child(section, "analysis"),
                format("the analysis {} is not read", quote(kind)), "Use STATIC or DYNAMIC.");
  const double steps = std::round(positive(file, section, "time_steps"));
  const double step = positive(file, section, "step_size");
  model.duration = steps * step;
  if (!(steps >= 1.0 && steps <= kMostSteps && std::isfinite(model.duration) &&
        model.duration > 0.0)) {
    file.xml.fault(section, format("the analysis has {} steps of {}", steps, step),
                   format("Give 1 to {} steps of a finite length.", kMostSteps));
    model.duration = 1.0;
  }
}

void write_feb_control(FebModel& model, const Element& section, SourceNode probes,
                       SourceNode& root) {
  FebFile& file = model.file;
  const NodeBuilder make = file.make(section);
  const double step = file.number(section, "step_size").value_or(1.0);
  const double steps = std::round(file.number(section, "time_steps").value_or(1.0));
  SourceNode analysis = make.map(), output = make.map();
  make.put(analysis, "type", make.text(model.dynamic ? "dynamics" : "statics"));
  make.put(analysis, model.dynamic ? "duration" : "history", make.number(model.duration));
  double every = model.dynamic ? 0.0 : step;
  const Element* stepper = file.child(section, "time_stepper");
  if (stepper != nullptr) {
    const FebValue most = file.value(*stepper, "dtmax", 0.1);
    double longest = most.factor;
    if (!most.is_constant()) {
      const auto points = model.curves.points(*most.controller);
      longest = 0.0;
      for (const auto& p : points) longest = std::max(longest, p[1]);
      every = equal_interval(points, model.duration);
      if (every == 0.0 && !points.empty())
        file.approximated(*stepper,
                          "must points at different intervals are no output times: steps end "
                          "at kinks of the loads in any case");
    }
    file.xml.skip(*stepper);
    if (model.dynamic) {
      make.put(analysis, "step", make.text("auto"));
      if (longest > 0.0) make.put(analysis, "max_step", make.number(longest));
      file.approximated(
          *stepper, "the time stepper becomes automatic steps by their error, of at most dtmax");
    }
  } else if (model.dynamic) {
    make.put(analysis, "step", make.number(step));
  }
  if (!model.dynamic) make.put(analysis, "load_steps", make.number(std::clamp(steps, 1.0, 1e5)));
  if (const Element* solver = file.child(section, "solver")) {
    const double radius = spectral_radius(file, *solver);
    if (model.dynamic && radius != 1.0) make.put(analysis, "rho_inf", make.number(radius));
    file.xml.skip(*solver);
    file.ignored.add(*solver, "<solver> with its tolerances", "is FEBio's");
  }
  for (const Element* e : file.children(section)) file.xml.skip(*e);
  make.put(root, "analysis", std::move(analysis));
  if (every > 0.0) make.put(output, "every", make.number(every));
  if (!probes.keys.empty()) make.put(output, "probes", std::move(probes));
  if (!output.keys.empty()) make.put(root, "output", std::move(output));
}

}  // namespace polhode::io
