// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>

#include <polhode/statics/modal_matrices.hpp>

#include "engine.hpp"
#include "parts.hpp"

namespace polhode::python {

namespace {

nb::dict mode(const ModalAnalysis& analysis, int index) {
  const Mode& m = analysis.report().modes[static_cast<std::size_t>(index)];
  nb::dict result;
  result["frequency"] = m.frequency;
  result["damping_ratio"] = m.damping;
  result["kind"] = kind_name(m.kind);
  result["eigenvalue"] = nb::cast(std::pair{m.eigenvalue.real(), m.eigenvalue.imag()});
  result["omega_squared"] = m.omega_squared;
  result["motion"] = m.motion;
  result["participation"] = array_of(m.participation);
  result["effective_mass"] = array_of(m.effective_mass);
  result["residual"] = m.residual;
  result["whirl"] = whirl_name(m.whirl);
  result["world_frequency"] = m.world_frequency;
  nb::dict shapes;
  for (std::size_t b = 0; b < analysis.model().bodies.size(); ++b) {
    std::vector<double> parts;
    for (const bool imaginary : {false, true}) {
      const Vec6 shape = analysis.body_shape(index, static_cast<int>(b), imaginary);
      parts.insert(parts.end(), shape.begin(), shape.end());
    }
    shapes[analysis.model().bodies[b].name.c_str()] = array_of(std::move(parts), {2, 6});
  }
  result["shapes"] = shapes;
  return result;
}

nb::dict report_of(const ModalAnalysis& analysis) {
  nb::list list;
  for (std::size_t i = 0; i < analysis.report().modes.size(); ++i)
    list.append(mode(analysis, static_cast<int>(i)));
  nb::dict result;
  result["message"] = analysis.message();
  result["modes"] = list;
  result["total_mass"] = analysis.report().total_mass;
  result["warnings"] = nb::cast(analysis.report().warnings);
  result["held"] = nb::cast(analysis.report().held);
  result["spin"] = analysis.spin();
  return result;
}

Model changed_model(const CompiledModel& compiled, std::optional<int> count,
                    std::optional<std::string> about) {
  Model changed = compiled.model;
  changed.analysis.count = count.value_or(compiled.model.analysis.count);
  changed.analysis.about = about.value_or(compiled.model.analysis.about);
  return changed;
}

/// Modes at each speed of a spin; texts as in a model file, empty ones are those of the model.
nb::list spin_modes(const CompiledModel& compiled, std::optional<int> count,
                    std::optional<std::string> about, std::string spin, std::string axis,
                    std::string through, std::string ground) {
  Model changed = changed_model(compiled, count, std::move(about));
  std::vector<ModalAnalysis> analyses;
  {
    const nb::gil_scoped_release unlocked;
    analyses = located(io::ModelPlaces(compiled.model), [&] {
      io::set_spin({std::move(spin), std::move(axis), std::move(through), std::move(ground)},
                   changed.analysis);
      return spin_analyses(changed);
    });
  }
  nb::list list;
  for (const ModalAnalysis& analysis : analyses) list.append(report_of(analysis));
  return list;
}

nb::dict modes(const CompiledModel& compiled, std::optional<int> count,
               std::optional<std::string> about) {
  Model changed = changed_model(compiled, count, std::move(about));
  std::unique_ptr<ModalAnalysis> analysis;
  {
    const nb::gil_scoped_release unlocked;
    analysis = located(io::ModelPlaces(compiled.model),
                       [&] { return std::make_unique<ModalAnalysis>(std::move(changed)); });
  }
  return report_of(*analysis);
}

Array matrix(const Mat& A) {
  std::vector<double> numbers(static_cast<std::size_t>(A.size()));
  Eigen::Map<Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(numbers.data(), A.rows(), A.cols()) =
      A;
  return array_of(std::move(numbers),
                  {static_cast<std::size_t>(A.rows()), static_cast<std::size_t>(A.cols())});
}

/// M, C, K and G of a state, as for modes.
nb::tuple matrices(Engine& engine) {
  const Engine::Use simulation = engine.use();
  ModalMatrices m(simulation->system(), simulation->state(), {});
  if (const StaticRows* rows = m.statics().rows();
      rows && simulation->model().analysis.type == "dynamics")
    if (const std::vector<std::string> touching = rows->touching(); !touching.empty())
      throw InputError("contacts",
                       format("{} is closed in this motion, and what it holds follows from an "
                              "equilibrium",
                              touching.front()),
                       "Use type: statics, or a state in which nothing touches");
  const ModalMatrices::Dense d = m.dense();
  return nb::make_tuple(matrix(d.M), matrix(d.C), matrix(d.K), matrix(d.Gt.transpose()));
}

}  // namespace

/// Contacts and stops that touch, of rows that only push.
std::vector<std::string> touching(Engine& engine) {
  const Engine::Use simulation = engine.use();
  ModalMatrices m(simulation->system(), simulation->state(), {});
  const StaticRows* rows = m.statics().rows();
  return rows ? rows->touching() : std::vector<std::string>();
}

void bind_modes(nb::module_& m) {
  m.def("touching", &touching, nb::arg("engine"));
  m.def("modes", &modes, nb::arg("model"), nb::arg("count").none(), nb::arg("about").none());
  m.def("spin_modes", &spin_modes, nb::arg("model"), nb::arg("count").none(),
        nb::arg("about").none(), nb::arg("spin"), nb::arg("axis"), nb::arg("through"),
        nb::arg("ground"));
  m.def("matrices", &matrices, nb::arg("engine"));
}

}  // namespace polhode::python
