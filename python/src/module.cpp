// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/threads.hpp>
#include <polhode/core/version.hpp>

#include "parts.hpp"

NB_MODULE(_native, m) {
  m.doc() = "Engine of the package polhode. Use that package.";
  m.attr("version") = polhode::version();
  m.def("set_threads", &polhode::set_threads_of_runs, nanobind::arg("threads"));
  polhode::python::bind_errors(m);
  polhode::python::bind_model(m);
  polhode::python::bind_held_loads(m);
  polhode::python::bind_recording(m);
  polhode::python::bind_engine(m);
  polhode::python::bind_results_reader(m);
  polhode::python::bind_rotations(m);
  polhode::python::bind_modes(m);
  polhode::python::bind_equations(m);
  polhode::python::bind_gradient(m);
  polhode::python::bind_workers(m);
  polhode::python::bind_batch(m);
}
