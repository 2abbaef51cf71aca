// SPDX-License-Identifier: Apache-2.0
// Reports of a Simulation at its present instant.
#include <algorithm>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/assert.hpp>
#include <polhode/dynamics/point_motion.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/loads/pair_on_nodes.hpp>
#include <polhode/loads/slide_on_beam_kind.hpp>
#include <polhode/simulation/simulation_impl.hpp>

namespace polhode {

namespace {

/// Values of the channels of a point that slides along a beam, see slide_on_beam_kind().
/// @param now  With the force of its body on its node.
std::vector<double> slide_report(const System& system, State projected, const InstantSolution& now,
                                 const std::string& name) {
  bond_nodes(system, projected);
  StepContext still;
  still.t_n = projected.t;
  const NodeStep instant = node_instant(system, projected, still);
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g) {
    const SlideOnBeam* slide = as_slide(nodes.group(g));
    if (!slide || slide->name() != name) continue;
    const SlideReport r =
        slide->report(instant, projected.element_history.data() + nodes.first_history(g));
    Vec3 F = Vec3::Zero();
    if (!now.node_force.empty()) F = -NodeStep::at(now.node_force.data(), slide->spec().point);
    return {F.x(), F.y(), F.z(), r.position, r.speed, F.dot(r.tangent), r.energy};
  }
  POLHODE_ASSERT(false);
  return {};
}

}  // namespace

InstantSolver& Simulation::Impl::solver_at_instant() {
  if (!instant_solver) instant_solver = std::make_unique<InstantSolver>(system);
  return *instant_solver;
}

/// Projects velocities and computes accelerations along the tree where the steps are solved so.
/// @returns false if it does not take the system, or cannot: then it is for solver_at_instant().
bool Simulation::Impl::solve_along_tree(VelocityReport& velocities) {
  if (!instant_tree) {
    if (engine_name != "tree" || !InstantTree::takes(system)) return false;
    instant_tree = std::make_unique<InstantTree>(system, *method.kernels);
  }
  if (instant_tree->solve(projected, contacts.wrenches(), velocities, instant)) return true;
  projected = state;
  return false;
}

/// Wrenches of contacts on the bodies at the instant, with the forces of stops in `projected`:
/// those of closed rows, or of the last step where contacts are not rows or these are too many.
std::vector<Vec6> Simulation::Impl::contact_wrenches() {
  if (!has_unilateral_rows(system)) return contacts.wrenches();
  std::vector<Vec6> wrenches;
  if (!are_rows(system.contacts().get())) wrenches = contacts.wrenches();
  double rounding = rounding_of_velocities();
  if (state.dt_last > 0.0) rounding += system.touching_gap() / state.dt_last;
  ClosedRows& closed = rows_at_instants.of(model, system);
  if (closed.solve(solver_at_instant(), projected, rounding, wrenches)) return wrenches;
  return contacts.wrenches();
}

void Simulation::Impl::compute_instant() {
  seen_bodies.begin(system, state.t);
  if (statics) {
    projected = state;
    instant.r_ddot.assign(system.body_count(), Vec3::Zero());
    instant.alpha.assign(system.body_count(), Vec3::Zero());
    instant.lambda = state.lambda;
    instant.node_force = statics->newton().node_residual();
    instant_step = state.ledger.steps;
    return;
  }
  projected = state;
  VelocityReport v;
  const bool solved = solve_along_tree(v);
  if (!solved) v = solver_at_instant().project_velocities(projected);
  figures.velocity_constraint_residual_max =
      std::max(figures.velocity_constraint_residual_max, v.residual_before);
  velocity_scale = std::max(velocity_scale, v.scale);
  // Those of the start are projected, or belong to drives that contradict each other.
  if (state.ledger.steps > 0 &&
      v.residual_before > std::max(velocity_residual, rounding_of_velocities())) {
    velocity_residual = v.residual_before;
    velocity_time = state.t;
  }
  if (!solved) {
    std::vector<double> node_v = extrapolated_velocities(system, projected);
    projected.node_v.swap(node_v);
    const std::vector<Vec6> wrenches = contact_wrenches();
    instant = solver_at_instant().accelerations(projected, wrenches);
    projected.node_v.swap(node_v);
  }
  instant_step = state.ledger.steps;
}

BodyMotion Simulation::body(int body) const {
  const int index = impl_->map.body[body];
  if (index != kGround) {
    impl_->at_instant();
    return impl_->system.motion(impl_->projected, index);
  }
  const BodySpec& fixed = impl_->model.bodies[body];
  BodyMotion m;
  m.r = fixed.position;
  m.q = fixed.orientation;
  return m;
}

Simulation::PointMotion Simulation::point(int body, const Vec3& Z) const {
  const BodyMotion m = this->body(body);
  const int index = impl_->map.body[body];
  const Pose pose{m.r, m.Lambda()};
  if (index == kGround) return {point_position(pose, Z), Vec3::Zero(), Vec3::Zero()};
  const InstantSolution& now = impl_->at_instant();
  const Velocities rates{m.v, m.omega()};
  return {point_position(pose, Z), point_velocity(pose, rates, Z),
          point_acceleration(pose, rates, {now.r_ddot[index], now.alpha[index]}, Z)};
}

Vec3 Simulation::angular_acceleration(int body) const {
  const int index = impl_->map.body[body];
  return index == kGround ? Vec3::Zero()
                          : impl_->at_instant().alpha[static_cast<std::size_t>(index)];
}

JointReport Simulation::joint(int joint, bool joint_axes) const {
  const System& system = impl_->system;
  const int interaction = impl_->map.joint[joint];
  const InteractionRef& ref = system.interactions()[interaction];
  const PairStep step = impl_->seen(ref);
  const Joint& item = joint_at(system, interaction);
  const JointCoordinates free = item.coordinates(step);
  const Reaction reaction = item.reaction(step, joint_axes);
  JointReport report;
  report.coordinates.assign(free.value.begin(), free.value.begin() + free.count);
  report.rates.assign(free.rate.begin(), free.rate.begin() + free.count);
  report.force = reaction.force;
  report.moment = reaction.moment;
  report.residual =
      item.rows() > 0 ? item.residual(step).head(item.rows()).lpNorm<Eigen::Infinity>() : 0.0;
  if (item.frame_moves()) {
    report.power = {item.drive_power(step)};
    report.work = {item.drive_work(step)};
  }
  if (item.records_impulses()) {
    const Reaction sums = item.impulses(step);
    report.impulses = {sums.force, sums.moment};
  }
  if (!item.resistance()) return report;
  const ResistanceReport resistance = item.resistance_report(step);
  report.friction.assign(resistance.friction.begin(),
                         resistance.friction.begin() + resistance.count);
  report.slips = resistance.slips;
  if (item.resistance()->data().slide) report.stops.push_back(resistance.slide);
  if (item.resistance()->data().turn) report.stops.push_back(resistance.turn);
  if (system.is_off(impl_->state, interaction)) {
    std::fill(report.friction.begin(), report.friction.end(), 0.0);
    std::fill(report.stops.begin(), report.stops.end(), 0.0);
    report.slips = false;
  }
  return report;
}

std::vector<double> Simulation::load(int load) const {
  const InstantSolution& now = impl_->at_instant();
  const System& system = impl_->system;
  if (acts_on_beam(load_kind(model().loads[load].type)))
    return slide_report(system, impl_->projected, now, model().loads[load].name);
  if (const auto found = impl_->map.load_on_nodes.find(load);
      found != impl_->map.load_on_nodes.end()) {
    State projected = impl_->projected;
    bond_nodes(system, projected);
    StepContext still;
    still.t_n = impl_->state.t;
    const bool grows = impl_->statics && !model().analysis.history;
    if (grows) still.load_factor = impl_->state.t;
    return found->second->report(node_instant(system, projected, still));
  }
  const InteractionRef& ref = system.interactions()[impl_->map.load[load]];
  const LoadKind& kind = load_kind(model().loads[load].type);
  std::vector<double> report = kind.report(system.group(ref.group), ref.item, impl_->seen(ref));
  const bool off = system.is_off(impl_->state, impl_->map.load[load]);
  if (!off && !impl_->statics) return report;
  // Interactions that are switched off neither act nor store energy; statics has no time.
  auto at = report.begin();
  for (const LoadChannel& channel : kind.channels) {
    const bool acts = channel.unit == "N" || channel.unit == "N m" || channel.unit == "W" ||
                      channel.name == "energy";
    if ((off && acts) || (impl_->statics && channel.name == "impulse"))
      std::fill_n(at, channel.size, 0.0);
    at += channel.size;
  }
  return report;
}

BeamReport Simulation::beam(int beam) const {
  const auto k = static_cast<std::size_t>(beam);
  return beam_report(*this, impl_->model.beams.at(k), impl_->map.beam.at(k));
}

CableReport Simulation::cable(int cable) const {
  const auto k = static_cast<std::size_t>(cable);
  const CableLineSpec& spec = impl_->model.cables.at(k);
  if (const SystemMap::Running& running = impl_->map.running_cable.at(k); running.cable)
    return running_cable_report(*this, spec, *running.cable, running.group);
  return cable_report(*this, spec, impl_->map.cable.at(k));
}

std::array<double, 3> Simulation::controller(int controller) const {
  (void)impl_->model.controllers.at(static_cast<std::size_t>(controller));
  return impl_->controllers->report(controller, *this);
}

bool Simulation::stopped() const { return impl_->stopped(); }

Balance Simulation::balance() const { return impl_->stepper->balance(impl_->state); }

const std::vector<SolidMap>& Simulation::solids() const { return impl_->map.solids; }

/// Velocity of a node; for a bonded one that of its body, without Newmark's error of order Δt².
Vec3 Simulation::node_velocity(int node) const {
  const int body = impl_->system.nodes()[node].body;
  if (body == kFreeNode) return at_node(impl_->state.node_v, node);
  if (body == kGround) return Vec3::Zero();
  impl_->at_instant();
  const BodyMotion m = impl_->system.motion(impl_->projected, body);
  return m.v + m.omega().cross(at_node(impl_->state.node_x, node) - m.r);
}

std::array<Vec3, 3> Simulation::solid_point(int solid, const SolidPoint& point) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  std::array<Vec3, 3> sum{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (std::size_t k = 0; k < point.nodes.size(); ++k) {
    const int node = map.first_node + point.nodes[k];
    const Vec3 x = at_node(impl_->state.node_x, node);
    sum[0] += point.weights[k] * x;
    sum[1] += point.weights[k] * (x - map.plan.start[static_cast<std::size_t>(point.nodes[k])]);
    sum[2] += point.weights[k] * node_velocity(node);
  }
  return sum;
}

const SolidReport& Simulation::solid(int solid) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  const Nodes& nodes = impl_->system.nodes();
  const State& state = impl_->state;
  Impl::SolidWatch& watch = impl_->solid_watch(solid);
  SolidReport& report = watch.report;
  if (watch.step == state.ledger.steps) return report;
  watch.step = state.ledger.steps;
  report = {};
  for (int k = 0; k < map.node_count(); ++k) {
    const Vec3 x = at_node(state.node_x, map.first_node + k);
    report.position.push_back(x);
    report.displacement.emplace_back(x - map.plan.start[static_cast<std::size_t>(k)]);
    report.velocity.push_back(node_velocity(map.first_node + k));
  }
  StepContext still;
  still.t_n = state.t;
  const NodeStep instant = node_instant(impl_->system, state, still);
  for (const int g : map.groups) {
    const ElementGroup& group = nodes.group(g);
    std::vector<ElementSample> samples(static_cast<std::size_t>(group.size()));
    group.sample(instant, state.element_history.data() + nodes.first_history(g), samples);
    report.elements.insert(report.elements.end(), samples.begin(), samples.end());
  }
  report.nodal = watch.recovery.fields(report.elements);
  return report;
}

Mat3 Simulation::solid_stress(int solid, const SolidPoint& point) const {
  return point.value(this->solid(solid).nodal.cauchy);
}

void Simulation::watch_stress() {
  for (int i = 0; i < static_cast<int>(impl_->map.solids.size()); ++i) {
    const solids::NodalFields& nodal = solid(i).nodal;
    impl_->solid_watch(i).see(nodal, impl_->state.t);
  }
}

std::vector<std::string> Simulation::interfaces(int solid) const {
  const Model& model = impl_->model;
  const SolidSpec& spec = model.solids.at(static_cast<std::size_t>(solid));
  std::vector<std::string> names;
  for (const BondSpec& bond : spec.bonded) names.push_back(model.body_name(bond.body));
  for (const PrescribedSpec& prescribed : spec.prescribed) names.push_back(prescribed.name);
  return names;
}

InterfaceReport Simulation::interface_reaction(int solid, int k) const {
  const SolidMap& map = impl_->map.solids.at(static_cast<std::size_t>(solid));
  const auto bonds = static_cast<int>(map.plan.bonded.size());
  const std::vector<int>& nodes = k < bonds
                                      ? map.plan.bonded.at(static_cast<std::size_t>(k))
                                      : map.plan.prescribed.at(static_cast<std::size_t>(k - bonds));
  const Nodes& all = impl_->system.nodes();
  const InstantSolution& now = impl_->at_instant();
  InterfaceReport report;
  if (now.node_force.empty()) return report;
  for (const int k_node : nodes) {
    const int node = map.first_node + k_node;
    Vec3 force = at_node(now.node_force, node);
    // Free components of a prescribed node are balanced up to round-off.
    for (int c = 0; c < 3; ++c)
      if (!all.bonded(node) && all.unknown(node, c) >= 0) force[c] = 0.0;
    Vec3 arm = at_node(impl_->state.node_x, node);
    if (all[node].body >= 0) arm -= impl_->system.motion(impl_->state, all[node].body).r;
    report.force += force;
    report.moment += arm.cross(force);
  }
  return report;
}

const contact::ContactSet* Simulation::contact_set() const { return impl_->map.contacts.get(); }

const ContactMap& Simulation::contact_map() const { return impl_->map.contact; }

bool Simulation::has_contacts() const {
  return impl_->map.contacts || !impl_->map.contact.surfaces.empty();
}

ContactReport Simulation::contact(int pair) const {
  const ContactMap& map = impl_->map.contact;
  const ContactMap::Pair& sides = map.pairs.at(static_cast<std::size_t>(pair));
  if (!sides.a.is_body() || !sides.b.is_body())
    return surface_report(impl_->system, impl_->state, map, sides);
  return impl_->contacts.report(pair);
}

int Simulation::contact_pair(const Side& a, const Side& b) const {
  const std::vector<ContactMap::Pair>& pairs = contact_map().pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (std::minmax(pairs[k].a, pairs[k].b) == std::minmax(a, b)) return static_cast<int>(k);
  throw InputError("contacts",
                   format("results of '{}' and '{}' are not recorded", model().side_name(a),
                          model().side_name(b)),
                   "Name the pair in contacts.pairs or a probe, or set contacts.record: true");
}

ContactLosses Simulation::contact_losses() const {
  ContactLosses sum = impl_->contacts.losses();
  const ContactLosses more = surface_losses(impl_->system, impl_->state, impl_->map.contact);
  sum.impacts += more.impacts;
  sum.friction += more.friction;
  return sum;
}

std::vector<surface_contact::SurfacePointReport> Simulation::surface_points(int surface) const {
  const ContactMap::Surface& s = impl_->map.contact.surfaces.at(static_cast<std::size_t>(surface));
  const Nodes& nodes = impl_->system.nodes();
  StepContext still;
  still.t_n = impl_->state.t;
  return s.touching->point_reports(
      node_instant(impl_->system, impl_->state, still),
      impl_->state.element_history.data() + nodes.first_history(s.group));
}

const std::vector<contact::TouchingPoint>& Simulation::contact_points() const {
  return impl_->contacts.points();
}

const std::vector<SensorEvent>& Simulation::sensor_events() const {
  return impl_->contacts.events();
}

}  // namespace polhode
