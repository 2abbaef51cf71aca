// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/simulation_details.hpp>

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
const SolidReport& Simulation::solid(std::string_view name) const {
  return solid(model().solid_index(std::string(name)));
}

}  // namespace polhode
