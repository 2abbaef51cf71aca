// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/simulation/simulation_impl.hpp>
#include <polhode/solids/even_pressure.hpp>

namespace polhode {

namespace {

/// Estimated error of a step above which the motion is not resolved [-].
constexpr double kUnresolved = 1e-2;
/// Velocities normal to the constraints, relative to the rows' terms, above which a warning is
/// given.
constexpr double kFarOff = 0.1;
/// Way that such velocities would lead in the whole run, in sizes of the model, below which nothing
/// moves [-].
constexpr double kNoWay = 1e-6;
/// Error of a solid's stress above which a warning is given [-].
constexpr double kUncertainStress = 0.1;

}  // namespace

std::vector<std::string> Simulation::Impl::warnings() const {
  std::vector<std::string> list = stepper->warnings();
  for (const SolidMap& solid : map.solids)
    for (const solids::SolidElements* elements : solid.elements) {
      const auto least = least_stretches.find(elements);
      if (least == least_stretches.end()) continue;
      const std::string text = elements->stretch_warning(least->second);
      if (!text.empty()) list.push_back(text);
    }
  warn_of_errors(list);
  for (std::size_t i = 0; i < solid_watches.size(); ++i) {
    const SolidWatch& watch = solid_watches[i];
    const double error = watch.part(watch.largest_error);
    if (error > kUncertainStress)
      list.push_back(format(
          "solids.{}: the estimated stress error is {:.0f} % (mean over the solid at {} = "
          "{:.4g}, from jumps between elements); peaks may be less accurate. Use quadratic "
          "elements, or a finer mesh.",
          model.solids[i].name, 100.0 * error, statics ? "load factor" : "t", watch.t_largest));
  }
  return list;
}

/// Nearly incompressible elements that lock carry the volume that cannot change by a pressure that
/// oscillates within them: its stiffness is that of a pressure times ∂²J/∂x∂x, which has no sign.
/// Directions that are no longer unstable with the mean pressure of each element are the mesh's.
std::vector<std::string> Simulation::Impl::mesh_instabilities(const StaticReport& report) const {
  std::vector<std::string> list;
  if (report.unstable <= 0) return list;
  const Nodes& nodes = system.nodes();
  std::vector<Vec3> X;
  for (int i = 0; i < nodes.count(); ++i) X.push_back(nodes[i].position);
  std::vector<double> blocks(9 * nodes.column().size(), 0.0);
  std::string names, kinds;
  for (const SolidMap& solid : map.solids)
    for (std::size_t k = 0; k < solid.elements.size(); ++k) {
      const solids::SolidElements& elements = *solid.elements[k];
      const solids::LinearModuli moduli = elements.material().linear();
      const double poisson = 0.5 * moduli.lame / (moduli.lame + moduli.shear);
      // Elements with enhanced strains have another pressure than that of their nodes.
      if (poisson <= elements.element().most_poisson || elements.element().sizes().modes() > 0)
        continue;
      solids::even_pressure(elements, X, state.node_x.data(), nodes.slots(solid.groups[k]), blocks);
      names += (names.empty() ? "" : ", ") + elements.name();
      kinds = elements.element().name;
    }
  if (names.empty()) return list;
  const int even = statics->newton().unstable_with(state, state.t, blocks);
  if (even < 0 || even >= report.unstable) return list;
  list.push_back(format(
      "{}: {} of the {} unstable directions are those of the mesh: the pressure oscillates within "
      "nearly incompressible {}, and with its mean in each element there {} {}. Use smaller cells, "
      "tet10, or hex8_q1p0 with an uncoupled material.",
      names, report.unstable - even, report.unstable, kinds, even == 1 ? "is" : "are",
      even == 0 ? "none" : std::to_string(even)));
  return list;
}

std::string Simulation::Impl::whose_error() const {
  const StepErrors& e = state.ledger.errors;
  if (e.body >= 0) return format("body '{}'", system.bodies()[e.body].name);
  for (std::size_t k = 0; k < map.solids.size(); ++k) {
    const int node = e.node - map.solids[k].first_node;
    if (e.node >= 0 && node >= 0 && node < map.solids[k].node_count())
      return format("node {} of solid '{}'", node, model.solids[k].name);
  }
  return e.node >= 0 ? "a beam or cable" : "";
}

void Simulation::Impl::warn_of_errors(std::vector<std::string>& list) const {
  if (statics) return;
  const StepErrors& e = state.ledger.errors;
  const std::string whose = whose_error();
  if (e.largest > kUnresolved)
    list.push_back(
        format("the steps are too long for the motion: the estimated error of {} is {:.2g} of "
               "the mechanism's size, or radians, in the step to t = {:.6g} s. Take shorter "
               "steps, or give a tolerance",
               whose.empty() ? "a body" : whose, e.largest, e.time));
  const std::int64_t without = state.ledger.steps - e.steps;
  if (!method.control.step && system.contacts() && 2 * without > state.ledger.steps)
    list.push_back(format(
        "the tolerance was watched in {} of {} steps only: while contacts of this law touch, "
        "steps have no estimate of their error. Use law: rigid if the model allows it, or "
        "compare with a run of half the step",
        e.steps, state.ledger.steps));
  const double way = velocity_residual * state.t;
  if (velocity_residual > kFarOff * velocity_scale && way > kNoWay * system.length_scale())
    list.push_back(
        format("velocities violate the joints by {:.2g} of the largest speeds at t = {:.6g} s. "
               "Take shorter steps, or rho_inf below 1",
               velocity_residual / velocity_scale, velocity_time));
  if (e.hard > 0)
    list.push_back(
        format("Newton's method only just converged in {} of {} steps, first in that "
               "to t = {:.6g} s. Take shorter steps",
               e.hard, state.ledger.steps, e.hard_time));
}

double Simulation::Impl::rounding_of_velocities() const {
  constexpr double kFewTerms = 16.0 * std::numeric_limits<double>::epsilon();
  double reach = 0.0;
  for (int b = 0; b < system.body_count(); ++b)
    reach = std::max(reach, system.motion(state, b).r.norm());
  for (const double x : state.node_x) reach = std::max(reach, std::abs(x));
  return state.dt_last > 0.0 ? kFewTerms * (reach + system.length_scale()) / state.dt_last : 0.0;
}

}  // namespace polhode
