// SPDX-License-Identifier: Apache-2.0
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

nb::dict modes(const CompiledModel& compiled, std::optional<int> count,
               std::optional<std::string> about) {
  Model changed = compiled.model;
  changed.analysis.count = count.value_or(compiled.model.analysis.count);
  changed.analysis.about = about.value_or(compiled.model.analysis.about);
  std::unique_ptr<ModalAnalysis> analysis;
  {
    const nb::gil_scoped_release unlocked;
    analysis = located(io::ModelPlaces(compiled.model),
                       [&] { return std::make_unique<ModalAnalysis>(std::move(changed)); });
  }
  nb::list list;
  for (std::size_t i = 0; i < analysis->report().modes.size(); ++i)
    list.append(mode(*analysis, static_cast<int>(i)));
  nb::dict result;
  result["message"] = analysis->message();
  result["modes"] = list;
  result["total_mass"] = analysis->report().total_mass;
  result["warnings"] = nb::cast(analysis->report().warnings);
  return result;
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
  const ModalMatrices::Dense d = m.dense();
  return nb::make_tuple(matrix(d.M), matrix(d.C), matrix(d.K), matrix(d.Gt.transpose()));
}

}  // namespace

void bind_modes(nb::module_& m) {
  m.def("modes", &modes, nb::arg("model"), nb::arg("count").none(), nb::arg("about").none());
  m.def("matrices", &matrices, nb::arg("engine"));
}

}  // namespace polhode::python
