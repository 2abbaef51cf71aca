// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/energy.hpp>
#include <polhode/loads/rotor.hpp>
#include <polhode/simulation/momentum_columns.hpp>

namespace polhode {

std::vector<int> bodies_with_momentum(const Model& model, const std::string& name,
                                      const std::string& where) {
  std::vector<int> list;
  bool fixed = false;
  const bool many = name.ends_with('*');
  const std::string_view begin = std::string_view(name).substr(0, name.size() - (many ? 1 : 0));
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodySpec& body = model.bodies[i];
    if (many ? !body.name.starts_with(begin) : body.name != name) continue;
    if (!body.node_of.empty())
      throw InputError(where,
                       format("'{}' is a node of '{}', which shares its mass with its neighbours",
                              body.name, body.node_of),
                       "Name rigid bodies only");
    fixed = fixed || body.fixed;
    if (!body.fixed) list.push_back(static_cast<int>(i));
  }
  if (list.empty())
    throw InputError(where, format("'{}' names no {}body", name, fixed ? "moving " : ""),
                     "Name a body, or the beginning of several names: arm_*");
  return list;
}

std::vector<std::string> momentum_columns() {
  return {"px [N s]",   "py [N s]",   "pz [N s]",   "lx [N m s]",
          "ly [N m s]", "lz [N m s]", "kinetic [J]"};
}

/// @eq{reported-momentum}
std::vector<double> momentum_numbers(const Simulation& simulation, const std::vector<int>& bodies,
                                     bool in_body) {
  const Model& model = simulation.model();
  double mass = 0.0, kinetic = 0.0;
  Vec3 moment = Vec3::Zero(), p = Vec3::Zero(), l = Vec3::Zero();
  // About a body, as in an orbit the moments about the origin are larger by ten digits and more.
  const BodyMotion first = simulation.body(bodies.front());
  Vec3 drift = Vec3::Zero();  // momentum relative to it
  for (const int i : bodies) {
    const BodySpec& body = model.bodies[static_cast<std::size_t>(i)];
    const BodyMotion m = simulation.body(i);
    const Mat3 J = body.point_mass ? Mat3::Zero().eval() : body.inertia;
    mass += body.mass;
    const Vec3 r = m.r - first.r, v = m.v - first.v;
    moment += body.mass * r;
    drift += body.mass * v;
    p += body.mass * m.v;
    l += body.mass * r.cross(v) + m.q * Vec3(J * m.W);
    kinetic += kinetic_energy(body.mass, J, m.v, m.W);
  }
  if (mass > 0.0) l -= moment.cross(drift) / mass;
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    const LoadSpec& load = model.loads[i];
    if (load.type != Rotor::kKind ||
        std::find(bodies.begin(), bodies.end(), load.b) == bodies.end())
      continue;
    const std::vector<double> report = simulation.load(static_cast<int>(i));
    l += Vec3(report.data() + Rotor::kReportedMomentum);
    kinetic += report[Rotor::kReportedEnergy];
  }
  if (in_body) {
    p = first.q.conjugate() * p;
    l = first.q.conjugate() * l;
  }
  return {p[0], p[1], p[2], l[0], l[1], l[2], kinetic};
}

}  // namespace polhode
