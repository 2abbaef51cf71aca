// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/write_results.hpp>

#include <polhode/base/format.hpp>
#include <polhode/io/results_plan.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/beam_mesh.hpp>

namespace polhode {

namespace {

/// What does not change: where the nodes start and which of them an element has.
void write_mesh(Hdf5File& file, const ResultsLayout::SolidEntry& solid) {
  std::vector<std::int64_t> connectivity, offsets{0}, types;
  for (int e = 0; e < solid.mesh->element_count(); ++e) {
    for (const int node : solid.mesh->element_nodes(e)) connectivity.push_back(node);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(solid.mesh->element_shape(e).vtk);
  }
  file.vectors(part(solid.name, "nodes/reference"), solid.reference, "m");
  file.numbers(part(solid.name, "elements/connectivity"), connectivity);
  file.numbers(part(solid.name, "elements/offsets"), offsets);
  file.numbers(part(solid.name, "elements/vtk_type"), types);
}

Hdf5File create(const std::string& path, const ResultsLayout& layout) {
  FilePlan p = plan_results(layout);
  return {path, std::move(p.channels), p.views};
}

void add_quaternion(std::vector<double>& numbers, const Quat& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and −q are the same rotation.
  for (double x : {q.w(), q.x(), q.y(), q.z()}) numbers.push_back(sign * x);
}

std::string lines(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& line : list) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

int ResultsLayout::coordinates() const {
  int sum = 0;
  for (const JointEntry& joint : joints) sum += joint.coordinates;
  return sum;
}

int ResultsLayout::load_numbers() const {
  int sum = 0;
  for (const LoadEntry& load : loads) sum += load_kind(load.type).report_size();
  return sum;
}

ResultsLayout results_layout(const Simulation& simulation) {
  const Model& model = simulation.model();
  ResultsLayout layout;
  layout.title = model.title;
  for (const BodySpec& body : model.bodies) layout.bodies.push_back(body.name);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointReport joint = simulation.joint(static_cast<int>(i));
    layout.joints.push_back({model.joints[i].name, model.joints[i].type,
                             static_cast<int>(joint.coordinates.size()),
                             static_cast<int>(joint.friction.size()),
                             static_cast<int>(joint.stops.size()), !joint.power.empty()});
  }
  for (const LoadSpec& load : model.loads)
    if (load.solid < 0) layout.loads.push_back({load.name, load.type});
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidPlan& plan = simulation.solids()[i].plan;
    layout.solids.push_back(
        {model.solids[i].name, &plan.mesh, plan.start, simulation.interfaces(static_cast<int>(i))});
  }
  layout.nodes = are_nodes(model);
  for (const BeamSpec& beam : model.beams) {
    layout.beams.push_back({beam.name, {}});
    for (int k = 0; k < beam.node_count(); ++k)
      layout.beams.back().reference.push_back(model.bodies[beam.first_node + k].position);
  }
  for (const CableLineSpec& cable : model.cables)
    layout.cables.push_back({cable.name, cable.pieces.size()});
  layout.has_contacts = simulation.has_contacts();
  for (const ContactMap::Pair& pair : simulation.contact_map().pairs)
    layout.contacts.push_back(format("{}+{}", model.side_name(pair.a), model.side_name(pair.b)));
  return layout;
}

ResultsFrame results_frame(const Simulation& simulation) {
  const Model& model = simulation.model();
  ResultsFrame frame;
  frame.t = simulation.time();
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const BodyMotion motion = simulation.body(static_cast<int>(i));
    frame.position.push_back(motion.r);
    frame.orientation.push_back(motion.q);
    frame.velocity.push_back(motion.v);
    frame.angular_velocity.push_back(motion.omega());
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointReport joint = simulation.joint(static_cast<int>(i));
    frame.force.push_back(joint.force);
    frame.moment.push_back(joint.moment);
    frame.coordinates.insert(frame.coordinates.end(), joint.coordinates.begin(),
                             joint.coordinates.end());
    frame.rates.insert(frame.rates.end(), joint.rates.begin(), joint.rates.end());
    frame.friction.insert(frame.friction.end(), joint.friction.begin(), joint.friction.end());
    if (!joint.friction.empty()) frame.slips.push_back(joint.slips ? 1.0 : 0.0);
    frame.stops.insert(frame.stops.end(), joint.stops.begin(), joint.stops.end());
    frame.power.insert(frame.power.end(), joint.power.begin(), joint.power.end());
    frame.work.insert(frame.work.end(), joint.work.begin(), joint.work.end());
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    if (model.loads[i].solid >= 0) continue;
    const std::vector<double> values = simulation.load(static_cast<int>(i));
    frame.loads.insert(frame.loads.end(), values.begin(), values.end());
  }
  for (int i = 0; i < static_cast<int>(model.solids.size()); ++i) {
    frame.solids.push_back(simulation.solid(i));
    const auto count = static_cast<int>(simulation.interfaces(i).size());
    for (int k = 0; k < count; ++k) frame.interfaces.push_back(simulation.interface_reaction(i, k));
  }
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i)
    frame.beams.push_back(simulation.beam(i));
  for (int i = 0; i < static_cast<int>(model.cables.size()); ++i)
    frame.cables.push_back(simulation.cable(i));
  for (int i = 0; i < static_cast<int>(simulation.contact_map().pairs.size()); ++i)
    frame.contacts.push_back(simulation.contact(i));
  frame.losses = simulation.contact_losses();
  frame.balance = simulation.balance();
  const State& state = simulation.state();
  frame.dt = state.dt_last;
  frame.steps = state.ledger.steps;
  frame.iterations = state.ledger.iterations;
  frame.rejected = state.ledger.rejected;
  return frame;
}

ResultsFile::ResultsFile(const std::string& path, const ResultsLayout& layout,
                         const Provenance& provenance)
    : file_(create(path, layout)), solids_(layout.solids), has_contacts_(layout.has_contacts) {
  namespace r = results;
  std::vector<std::string> joints, types;
  std::vector<std::int64_t> first, count;
  std::int64_t next = 0;
  for (const auto& joint : layout.joints) {
    joints.push_back(joint.name);
    types.push_back(joint.type);
    first.push_back(next);
    count.push_back(joint.coordinates);
    next += joint.coordinates;
  }
  for (const auto& solid : layout.solids) write_mesh(file_, solid);
  for (const auto& beam : layout.beams)
    file_.vectors(format("{}/{}/nodes/reference", r::kBeams, beam.name), beam.reference, "m");
  file_.names(join(r::kPackedBodies, "names"), layout.bodies);
  file_.names(join(r::kPackedJoints, "names"), joints);
  file_.names(join(r::kPackedJoints, "types"), types);
  file_.numbers(join(r::kPackedJoints, "first"), first);
  file_.numbers(join(r::kPackedJoints, "count"), count);

  if (layout.load_numbers() > 0) name_loads(layout);
  if (!layout.contacts.empty()) file_.names(join(r::kPackedContacts, "names"), layout.contacts);

  file_.attribute("/", "format", "polhode results");
  file_.attribute("/", "format_version", r::kFormatVersion);
  file_.attribute("/", "title", layout.title);
  file_.attribute(r::kProvenance, "version", provenance.version);
  file_.attribute(r::kProvenance, "solver", provenance.solver);
  file_.attribute(r::kProvenance, "instruction_set", provenance.instruction_set);
  file_.attribute(r::kProvenance, "model_file", provenance.model_file);
  file_.attribute(r::kProvenance, "overrides", lines(provenance.overrides));
  // A list of one text: attributes hold at most 64 KB, models may be longer.
  file_.names(join(r::kProvenance, "model"), {provenance.model_text});
  file_.flush();
}

void ResultsFile::name_loads(const ResultsLayout& layout) {
  namespace r = results;
  std::vector<std::string> names, types;
  std::vector<std::int64_t> first, count;
  std::int64_t next = 0;
  for (const auto& load : layout.loads) {
    names.push_back(load.name);
    types.push_back(load.type);
    first.push_back(next);
    count.push_back(load_kind(load.type).report_size());
    next += count.back();
  }
  file_.names(join(r::kPackedLoads, "names"), names);
  file_.names(join(r::kPackedLoads, "types"), types);
  file_.numbers(join(r::kPackedLoads, "first"), first);
  file_.numbers(join(r::kPackedLoads, "count"), count);
}

ResultsFile ResultsFile::append_to(const std::string& path, const ResultsLayout& layout, double t) {
  return {Hdf5File::append_to(path, plan_results(layout).channels, t), layout};
}

void ResultsFile::append(const ResultsFrame& frame) {
  numbers_.clear();
  const auto scalar = [this](double x) { numbers_.push_back(x); };
  const auto vector = [&](const Vec3& x) {
    for (int i = 0; i < 3; ++i) scalar(x[i]);
  };
  const auto vectors = [&](const std::vector<Vec3>& list) {
    for (const Vec3& x : list) vector(x);
  };
  scalar(frame.t);
  vectors(frame.position);
  for (const Quat& q : frame.orientation) add_quaternion(numbers_, q);
  vectors(frame.velocity);
  vectors(frame.angular_velocity);
  vectors(frame.force);
  vectors(frame.moment);
  for (double x : frame.coordinates) scalar(x);
  for (const auto* list : {&frame.rates, &frame.friction, &frame.slips, &frame.stops, &frame.power,
                           &frame.work, &frame.loads})
    for (double x : *list) scalar(x);
  const Balance& b = frame.balance;
  for (double x : {b.kinetic, b.potential, b.put_in, b.dissipated, b.kinetic + b.potential})
    scalar(x);
  vector(b.linear_momentum);
  vector(b.angular_momentum);
  scalar(frame.dt);
  for (std::int64_t x : {frame.steps, frame.iterations, frame.rejected})
    scalar(static_cast<double>(x));
  if (has_contacts_) add_contacts(frame);
  add_solids(frame);
  add_lines(frame);
  file_.append(numbers_);
}

void ResultsFile::add_contacts(const ResultsFrame& frame) {
  numbers_.push_back(frame.losses.impacts);
  numbers_.push_back(frame.losses.friction);
  const auto each = [&](auto&& value) {
    for (const ContactReport& c : frame.contacts) numbers_.push_back(value(c));
  };
  each([](const ContactReport& c) { return c.gap; });
  each([](const ContactReport& c) { return c.normal_force; });
  each([](const ContactReport& c) { return c.impulse; });
  each([](const ContactReport& c) { return c.energy_lost; });
  each([](const ContactReport& c) { return static_cast<double>(c.points); });
  each([](const ContactReport& c) { return static_cast<double>(c.status); });
  for (const auto member : {&ContactReport::force, &ContactReport::friction, &ContactReport::point})
    for (const ContactReport& c : frame.contacts)
      numbers_.insert(numbers_.end(), (c.*member).begin(), (c.*member).end());
}

void ResultsFile::add_solids(const ResultsFrame& frame) {
  const auto vector = [&](const Vec3& x) { numbers_.insert(numbers_.end(), x.begin(), x.end()); };
  const auto tensor = [&](const Mat3& T) {
    numbers_.insert(numbers_.end(), {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)});
  };
  std::size_t next = 0;
  for (std::size_t s = 0; s < solids_.size(); ++s) {
    const SolidReport& report = frame.solids[s];
    const NodalFields& nodal = report.nodal;
    for (const Vec3& x : report.displacement) vector(x);
    for (const Vec3& x : report.velocity) vector(x);
    for (const Mat3& T : nodal.cauchy) tensor(T);
    numbers_.insert(numbers_.end(), nodal.von_mises.begin(), nodal.von_mises.end());
    numbers_.insert(numbers_.end(), nodal.strain_energy_density.begin(),
                    nodal.strain_energy_density.end());
    for (const ElementSample& e : report.elements) tensor(e.cauchy);
    for (const ElementSample& e : report.elements) numbers_.push_back(von_mises(e.cauchy));
    for (const ElementSample& e : report.elements) vector(e.principal_stretches);
    for (const ElementSample& e : report.elements) numbers_.push_back(e.strain_energy_density);
    numbers_.insert(numbers_.end(), nodal.stress_error.begin(), nodal.stress_error.end());
    for (std::size_t k = 0; k < solids_[s].interfaces.size(); ++k) {
      vector(frame.interfaces[next].force);
      vector(frame.interfaces[next++].moment);
    }
  }
}

void ResultsFile::add_lines(const ResultsFrame& frame) {
  const auto vectors = [&](const std::vector<Vec3>& list) {
    for (const Vec3& x : list) numbers_.insert(numbers_.end(), x.begin(), x.end());
  };
  const auto halves = [&](const std::vector<Vec6>& list) {
    for (const Eigen::Index first : {0, 3})
      for (const Vec6& x : list)
        numbers_.insert(numbers_.end(), x.data() + first, x.data() + first + 3);
  };
  for (const BeamReport& beam : frame.beams) {
    vectors(beam.position);
    for (const Quat& q : beam.orientation) add_quaternion(numbers_, q);
    vectors(beam.velocity);
    halves(beam.forces);
    halves(beam.strains);
  }
  for (const CableReport& cable : frame.cables) {
    vectors(cable.position);
    numbers_.insert(numbers_.end(), cable.tension.begin(), cable.tension.end());
    numbers_.insert(numbers_.end(), cable.length.begin(), cable.length.end());
  }
}

}  // namespace polhode
