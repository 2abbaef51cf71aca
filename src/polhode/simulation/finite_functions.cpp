// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/finite_functions.hpp>

#include <cmath>
#include <limits>
#include <optional>

#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Samples of a step; what a step evaluates are its start, its end and times between.
constexpr int kSamples = 64;
/// Halvings after which two times are neighbours.
constexpr int kHalvings = 60;

/// First time in [from, to] found at which a function is not finite.
std::optional<double> gap_in(const TimeFunction& f, double from, double to) {
  double good = from;
  for (int k = 0; k <= kSamples; ++k) {
    double bad = from + (to - from) * k / kSamples;
    if (std::isfinite(f(bad))) {
      good = bad;
      continue;
    }
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (good + bad);
      (std::isfinite(f(middle)) ? good : bad) = middle;
    }
    return bad;
  }
  return std::nullopt;
}

}  // namespace

std::string not_finite_in(const Model& model, double from, double to) {
  std::string text;
  double earliest = std::numeric_limits<double>::infinity();
  const auto look = [&](const TimeFunctionPtr& f, const char* kind, const std::string& name) {
    if (!f || f->controller() >= 0) return;
    const std::optional<double> gap = gap_in(*f, from, to);
    if (!gap || *gap >= earliest) return;
    earliest = *gap;
    text = format("the {} '{}' is not a finite number at t = {:.9g} s. Correct its function.", kind,
                  name, *gap);
  };
  for (const LoadSpec& load : model.loads) {
    look(load.value, "load", load.name);
    if (load.vector)
      for (const TimeFunctionPtr& f : *load.vector) look(f, "load", load.name);
  }
  for (const JointSpec& joint : model.joints) {
    if (!joint.motion) continue;
    for (const TimeFunctionPtr& f : joint.motion->displacement)
      look(f, "motion of the joint", joint.name);
    for (const TimeFunctionPtr& f : joint.motion->parameters)
      look(f, "motion of the joint", joint.name);
  }
  for (const SolidSpec& solid : model.solids)
    for (const PrescribedSpec& p : solid.prescribed)
      for (const TimeFunctionPtr& f : p.displacement) look(f, "prescribed displacement", p.name);
  return text;
}

}  // namespace polhode
