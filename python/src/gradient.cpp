// SPDX-License-Identifier: Apache-2.0
#include <polhode/gradient/gradient.hpp>
#include <polhode/io/read/gradient_parameter.hpp>
#include <polhode/io/read/model_places.hpp>
#include <polhode/io/read/read_outcome.hpp>

#include "engine.hpp"

namespace polhode::python {

namespace {

struct Differentiated {
  GradientRequest request;
  RunGradient run;
  std::vector<std::vector<double>> bars;
};

Differentiated gradient_of(const io::ModelText& source, const std::vector<std::string>& of,
                           const std::vector<std::string>& wrt, bool forward, bool bars,
                           bool only_last_adjoint, const std::vector<double>& weights) {
  Differentiated d;
  const Model model = io::read_model_text(source.text, source.file, source.overrides);
  d.request.forward = forward;
  d.request.only_last_adjoint = only_last_adjoint;
  d.request.weights = weights;
  for (const std::string& path : wrt)
    d.request.parameters.push_back(io::gradient_parameter(source, path));
  for (const std::string& outcome : of) d.request.outcomes.push_back(io::read_outcome(outcome));
  d.run = located(io::ModelPlaces(model), [&] { return differentiate(model, d.request); });
  if (!bars) return d;
  d.bars = error_bars(d.run, differentiate_halves(model, d.request, d.run));
  return d;
}

/// Parameters as (path, value, unit), then for each outcome (text, value, unit, time, gradient,
/// error bars, growth, tangent against adjoint, warnings); with weights, one for each outcome, only
/// that of their weighted sum.
nb::tuple gradient(const std::string& text, const std::string& name,
                   const std::vector<std::string>& overrides, const std::vector<std::string>& of,
                   const std::vector<std::string>& wrt, bool forward, bool bars,
                   bool only_last_adjoint, const std::vector<double>& weights) {
  Differentiated d;
  {
    const nb::gil_scoped_release unlocked;
    d = gradient_of({text, name, name, overrides}, of, wrt, forward, bars, only_last_adjoint,
                    weights);
  }
  nb::list parameters, outcomes;
  for (const GradientParameter& p : d.request.parameters)
    parameters.append(nb::make_tuple(p.path, p.value, p.unit));
  for (std::size_t k = 0; k < d.run.outcomes.size(); ++k) {
    const OutcomeGradient& g = d.run.outcomes[k];
    const std::vector<double> bar = bars ? d.bars[k] : std::vector<double>{};
    outcomes.append(nb::make_tuple(g.outcome, g.value, g.unit, g.time, nb::cast(g.by),
                                   nb::cast(bar), g.growth, g.spot_check,
                                   nb::cast(gradient_doubts(d.run, k, d.request, bar))));
  }
  return nb::make_tuple(parameters, outcomes);
}

}  // namespace

void bind_gradient(nb::module_& m) {
  m.def("gradient", &gradient, nb::arg("text"), nb::arg("name"), nb::arg("overrides"),
        nb::arg("of"), nb::arg("wrt"), nb::arg("forward"), nb::arg("bars"),
        nb::arg("only_last_adjoint") = false, nb::arg("weights") = std::vector<double>{});
}

}  // namespace polhode::python
