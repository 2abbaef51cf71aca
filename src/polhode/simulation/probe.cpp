// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/probe.hpp>

#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/body_columns.hpp>
#include <polhode/simulation/momentum_columns.hpp>
#include <polhode/simulation/probe_columns.hpp>

namespace polhode {

namespace {

void extend(std::vector<double>& list, const Vec3& x) {
  list.insert(list.end(), x.begin(), x.end());
}

void add_stress(std::vector<double>& row, const Mat3& stress) {
  row.insert(row.end(), {stress(0, 0), stress(1, 1), stress(2, 2), stress(0, 1), stress(1, 2),
                         stress(0, 2), solids::von_mises(stress)});
}

ProbeTarget find_solid_target(const Simulation& simulation, const ProbeSpec& spec,
                              const std::string& where) {
  ProbeTarget target{.spec = spec, .index = simulation.model().solid_index(spec.target)};
  const solids::Mesh& mesh = simulation.solids()[static_cast<std::size_t>(target.index)].plan.mesh;
  if (!spec.reaction_of.empty()) {
    const std::vector<std::string> names = simulation.interfaces(target.index);
    const auto found = std::find(names.begin(), names.end(), spec.reaction_of);
    if (found == names.end())
      throw InputError(where + ".interface",
                       format("'{}' has no interface '{}'", spec.target, spec.reaction_of),
                       "Name a body it is bonded to, or nodes it prescribes");
    target.interface = static_cast<int>(found - names.begin());
  } else if (spec.node) {
    if (*spec.node < 0 || *spec.node >= static_cast<int>(mesh.nodes.size()))
      throw InputError(where + ".node", format("node {} does not exist", *spec.node),
                       format("The solid has {} nodes; the first is 0", mesh.nodes.size()));
    target.point = {{*spec.node}, {1.0}};
  } else {
    target.point = solid_point(where + ".point", mesh, spec.point);
  }
  return target;
}

/// Target of a probe at an element of a beam or a segment of a cable.
ProbeTarget find_line_target(const Model& model, const ProbeSpec& spec, const std::string& where) {
  const bool beam = spec.kind == "beam";
  const int index = beam ? model.beam_index(spec.target) : model.cable_index(spec.target);
  const auto k = static_cast<std::size_t>(index);
  const std::size_t count = beam ? model.beams[k].mesh.size() : model.cables[k].pieces.size();
  if (spec.element < 0 || static_cast<std::size_t>(spec.element) >= count)
    throw InputError(
        where + ".element",
        format("{} {} does not exist", beam ? "element" : "piece", spec.element),
        format("'{}' has {} {}; the first is 0", spec.target, count, beam ? "elements" : "pieces"));
  return {.spec = spec, .index = index};
}

ProbeTarget find_target(const Simulation& simulation, const ProbeSpec& spec,
                        const std::string& where) {
  const Model& model = simulation.model();
  if (spec.kind == "beam" || spec.kind == "cable") return find_line_target(model, spec, where);
  if (spec.kind == "solid") return find_solid_target(simulation, spec, where);
  if (spec.kind == "controller")
    return {.spec = spec, .index = model.controller_index(spec.target)};
  if (spec.kind == "contact")
    return {.spec = spec, .index = simulation.contact_pair(spec.pair[0], spec.pair[1])};
  if (spec.kind == "load") {
    const int load = model.load_index(spec.target);
    if (!model.loads[static_cast<std::size_t>(load)].reports())
      throw InputError(where, format("records '{}', a load on a solid", spec.target),
                       "Record an interface or a point of the solid, or a load on bodies");
    return {.spec = spec, .index = load};
  }
  if (spec.kind == "momentum") {
    ProbeTarget target{.spec = spec};
    target.bodies = bodies_with_momentum(model, spec.target, where + ".momentum");
    if (spec.axes == "body" && target.bodies.size() > 1)
      throw InputError(where + ".axes", format("'{}' has several bodies", spec.target),
                       "Name one of them, or leave axes out");
    return target;
  }
  const bool body = spec.kind == "body";
  if (!body && spec.kind != "joint")
    throw InputError(
        where, format("records a '{}', which is not known", spec.kind),
        "Name a body, a joint, a load, a solid, a beam, a cable, a contact, a controller or a "
        "momentum");
  const int index = body ? model.body_index(spec.target) : model.joint_index(spec.target);
  if (body && index == kGround && spec.seen_from == kGround)
    throw InputError(where, "records the ground, which does not move",
                     "Name a body, or the one that it is seen from");
  return {.spec = spec, .index = index};
}

}  // namespace

ProbeTarget probe_target(const Simulation& simulation, const ProbeSpec& spec,
                         const std::string& where) {
  ProbeTarget target =
      find_target(simulation, spec, where.empty() ? format("output.probes.{}", spec.name) : where);
  target.header = probe_columns(simulation.model(), spec);
  target.header.insert(target.header.begin(), "t [s]");
  return target;
}

ProbeClock::ProbeClock(const ProbeSpec& spec, const OutputSpec& output, std::optional<double> last)
    : every_(spec.every.value_or(output.every.value_or(0.0))), last_(last) {
  if (every_ > 0.0 && last_)
    next_ = static_cast<std::int64_t>(std::floor(*last_ / every_ * (1 + 1e-12))) + 1;
}

bool ProbeClock::strikes(double t, bool last) {
  if (last_ && *last_ >= t) return false;
  if (every_ > 0.0 && !last) {
    // A step that ends within rounding of the due time counts as ending at it.
    if (t * (1 + 1e-12) < static_cast<double>(next_) * every_) return false;
    next_ = static_cast<std::int64_t>(std::floor(t / every_ * (1 + 1e-12))) + 1;
  }
  last_ = t;
  return true;
}

namespace {

/// Adds the columns of a contact; forces are those on the first body of the probe.
void add_contact(std::vector<double>& row, const Simulation& simulation, const ProbeTarget& probe) {
  const ContactReport c = simulation.contact(probe.index);
  const ContactMap::Pair& pair =
      simulation.contact_map().pairs[static_cast<std::size_t>(probe.index)];
  const double sign = pair.a == probe.spec.pair[0] ? 1.0 : -1.0;
  row.insert(row.end(), {c.gap, c.normal_force});
  for (const Vec3& x : {Vec3(sign * c.force), Vec3(sign * c.friction), c.point}) extend(row, x);
  row.insert(row.end(), {static_cast<double>(c.points), static_cast<double>(c.status), c.impulse,
                         c.energy_lost});
}

}  // namespace

std::vector<double> probe_row(const ProbeTarget& probe, const Simulation& simulation) {
  std::vector<double> row{simulation.time()};
  if (probe.spec.kind == "body") {
    const std::vector<double> numbers = body_numbers(simulation, probe.spec, probe.index);
    row.insert(row.end(), numbers.begin(), numbers.end());
  } else if (probe.spec.kind == "solid" && probe.interface >= 0) {
    const InterfaceReport reaction = simulation.interface_reaction(probe.index, probe.interface);
    extend(row, reaction.force);
    extend(row, reaction.moment);
  } else if (probe.spec.kind == "momentum") {
    const std::vector<double> numbers =
        momentum_numbers(simulation, probe.bodies, probe.spec.axes == "body");
    row.insert(row.end(), numbers.begin(), numbers.end());
  } else if (probe.spec.kind == "contact") {
    add_contact(row, simulation, probe);
  } else if (probe.spec.kind == "controller") {
    const std::array<double, 3> values = simulation.controller(probe.index);
    row.insert(row.end(), values.begin(), values.end());
  } else if (probe.spec.kind == "load") {
    const std::vector<double> values = simulation.load(probe.index);
    row.insert(row.end(), values.begin(), values.end());
  } else if (probe.spec.kind == "beam") {
    const BeamReport beam = simulation.beam(probe.index);
    const auto k = static_cast<std::size_t>(probe.spec.element);
    row.insert(row.end(), beam.forces[k].begin(), beam.forces[k].end());
    row.insert(row.end(), beam.strains[k].begin(), beam.strains[k].end());
  } else if (probe.spec.kind == "cable") {
    const CableReport cable = simulation.cable(probe.index);
    const auto k = static_cast<std::size_t>(probe.spec.element);
    if (const auto& whole = cable.whole) {
      row.insert(row.end(), {cable.tension[k], whole->length, whole->rate, whole->energy});
      if (simulation.model().cables[static_cast<std::size_t>(probe.index)].muscle)
        row.insert(row.end(), {whole->fibre_length, whole->activation, whole->passive});
    } else {
      row.insert(row.end(), {cable.tension[k], cable.length[k]});
    }
  } else if (probe.spec.kind == "solid") {
    for (const Vec3& x : simulation.solid_point(probe.index, probe.point)) extend(row, x);
    if (probe.spec.stress) add_stress(row, simulation.solid_stress(probe.index, probe.point));
  } else {
    const JointReport joint = simulation.joint(probe.index, probe.spec.axes == "joint");
    extend(row, joint.force);
    extend(row, joint.moment);
    row.insert(row.end(), joint.coordinates.begin(), joint.coordinates.end());
    row.insert(row.end(), joint.rates.begin(), joint.rates.end());
    row.insert(row.end(), joint.friction.begin(), joint.friction.end());
    if (!joint.friction.empty()) row.push_back(joint.slips ? 1.0 : 0.0);
    row.insert(row.end(), joint.stops.begin(), joint.stops.end());
    row.insert(row.end(), joint.power.begin(), joint.power.end());
    row.insert(row.end(), joint.work.begin(), joint.work.end());
    for (const Vec3& impulse : joint.impulses) extend(row, impulse);
  }
  return row;
}

}  // namespace polhode
