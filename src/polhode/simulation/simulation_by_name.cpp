// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/simulation_impl.hpp>

namespace polhode {

double Simulation::time() const { return state().t; }

BodyMotion Simulation::body(std::string_view name) const {
  const int index = model().body_index(std::string(name));
  return index == kGround ? BodyMotion{} : body(index);
}
Simulation::PointMotion Simulation::point(std::string_view name, const Vec3& Z) const {
  const int index = model().body_index(std::string(name));
  return index == kGround ? PointMotion{Z, Vec3::Zero(), Vec3::Zero()} : point(index, Z);
}
JointReport Simulation::joint(std::string_view name, bool joint_axes) const {
  return joint(model().joint_index(std::string(name)), joint_axes);
}
std::vector<double> Simulation::load(std::string_view name) const {
  return load(model().load_index(std::string(name)));
}
BeamReport Simulation::beam(std::string_view name) const {
  return beam(model().beam_index(std::string(name)));
}
CableReport Simulation::cable(std::string_view name) const {
  return cable(model().cable_index(std::string(name)));
}
std::array<double, 3> Simulation::controller(std::string_view name) const {
  return controller(model().controller_index(std::string(name)));
}
/// Target of a probe, resolved at its first use.
const ProbeTarget& Simulation::probe_target_of(std::string_view name) const {
  const int index = model().probe_index(std::string(name));
  const auto found = impl_->probes.find(index);
  if (found != impl_->probes.end()) return found->second;
  const ProbeSpec& spec = model().output.probes[static_cast<std::size_t>(index)];
  return impl_->probes.emplace(index, probe_target(*this, spec)).first->second;
}
std::vector<double> Simulation::probe(std::string_view name) const {
  return probe_row(probe_target_of(name), *this);
}
std::vector<std::string> Simulation::probe_columns(std::string_view name) const {
  return probe_target_of(name).header;
}
const SolidReport& Simulation::solid(std::string_view name) const {
  return solid(model().solid_index(std::string(name)));
}

}  // namespace polhode
