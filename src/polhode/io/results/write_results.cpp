// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/write_results.hpp>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/results/results_plan.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode::io {

namespace {

/// Longest text of warnings that an attribute takes [bytes]: HDF5 stores up to 64 KiB in one.
constexpr std::size_t kMostWarnings = 32768;

Hdf5File create(const std::string& path, const ResultsLayout& layout) {
  FilePlan p = plan_results(layout);
  return {path, std::move(p.channels), p.views};
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
    layout.impulses = !joint.impulses.empty();  // all joints alike
  }
  for (const LoadSpec& load : model.loads)
    if (load.reports()) layout.loads.push_back({load.name, load.type});
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidPlan& plan = simulation.solids()[i].plan;
    layout.solids.push_back({model.solids[i].name, &plan.mesh, plan.start,
                             simulation.interfaces(static_cast<int>(i)),
                             has_contact_fields(simulation, static_cast<int>(i))});
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
  for (auto* list : {&frame.position, &frame.velocity, &frame.angular_velocity})
    list->reserve(model.bodies.size());
  frame.orientation.reserve(model.bodies.size());
  for (auto* list : {&frame.force, &frame.moment}) list->reserve(model.joints.size());
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
    if (joint.impulses.empty()) continue;
    frame.impulse.push_back(joint.impulses[0]);
    frame.angular_impulse.push_back(joint.impulses[1]);
  }
  for (std::size_t i = 0; i < model.loads.size(); ++i) {
    if (!model.loads[i].reports()) continue;
    const std::vector<double> values = simulation.load(static_cast<int>(i));
    frame.loads.insert(frame.loads.end(), values.begin(), values.end());
  }
  for (int i = 0; i < static_cast<int>(model.solids.size()); ++i) {
    frame.solids.push_back(simulation.solid(i));
    frame.solid_contacts.emplace_back();
    if (has_contact_fields(simulation, i))
      frame.solid_contacts.back() = solid_contact_fields(simulation, i);
    const auto count = static_cast<int>(simulation.interfaces(i).size());
    frame.interfaces.emplace_back();
    for (int k = 0; k < count; ++k)
      frame.interfaces.back().push_back(simulation.interface_reaction(i, k));
  }
  for (int i = 0; i < static_cast<int>(model.beams.size()); ++i)
    frame.beams.push_back(simulation.beam(i));
  for (int i = 0; i < static_cast<int>(model.cables.size()); ++i)
    frame.cables.push_back(simulation.cable(i));
  for (int i = 0; i < static_cast<int>(simulation.contact_map().pairs.size()); ++i)
    frame.contacts.push_back(simulation.contact(i));
  frame.has_contacts = simulation.has_contacts();
  frame.losses = simulation.contact_losses();
  frame.balance = simulation.balance();
  const State& state = simulation.state();
  frame.energy_drift = drifts(state.ledger).energy;
  frame.dt = state.dt_last;
  frame.steps = state.ledger.steps;
  frame.iterations = state.ledger.iterations;
  frame.rejected = state.ledger.rejected;
  frame.between_steps = simulation.between_steps();
  return frame;
}

ResultsFile::ResultsFile(const std::string& path, const ResultsLayout& layout,
                         const Provenance& provenance)
    : file_(create(path, layout)) {
  namespace r = results;
  const FixedData fixed = fixed_data(layout);
  for (const auto& [where, rows] : fixed.vectors) file_.vectors(where, rows, "m");
  for (const auto& [where, list] : fixed.names) file_.names(where, list);
  for (const auto& [where, list] : fixed.numbers) file_.numbers(where, list);

  file_.attribute("/", "format", "polhode results");
  file_.attribute("/", "format_version", r::kFormatVersion);
  file_.attribute("/", "title", layout.title);
  file_.attribute(r::kProvenance, "version", provenance.version);
  file_.attribute(r::kProvenance, "solver", provenance.solver);
  file_.attribute(r::kProvenance, "instruction_set", provenance.instruction_set);
  file_.attribute(r::kProvenance, "model_file", provenance.model_file);
  file_.attribute(r::kProvenance, "overrides", lines(provenance.overrides));
  // The verdict is known at the end of the run. Its place is kept here: a part of the header that
  // is added later lies behind all frames, and a file cut short would lose the whole group.
  conclude_with("", {}, {});
  // A list of one text: attributes are limited to 64 KB, models may be longer.
  file_.names(join(r::kProvenance, "model"), {provenance.model_text});
}

ResultsFile ResultsFile::append_to(const std::string& path, const ResultsLayout& layout, double t) {
  ResultsFile file(Hdf5File::append_to(path, plan_results(layout).channels, t));
  file.conclude_with("", {}, {});  // The verdict of the run that is continued is none on this one.
  return file;
}

void ResultsFile::conclude(const std::vector<std::string>& distrust,
                           const std::vector<std::string>& warnings) {
  conclude_with(distrust.empty() ? "yes" : "no", distrust, warnings);
}

void ResultsFile::conclude_with(const char* trusted, const std::vector<std::string>& distrust,
                                std::vector<std::string> warnings) {
  while (lines(warnings).size() > kMostWarnings) warnings.pop_back();
  file_.attribute(results::kProvenance, "trusted", trusted);
  file_.attribute(results::kProvenance, "distrust", lines(distrust));
  file_.attribute(results::kProvenance, "warnings", lines(warnings));
}

void ResultsFile::append(const ResultsFrame& frame) {
  numbers_.clear();
  list_numbers(frame, numbers_);
  file_.append(numbers_);
}

}  // namespace polhode::io
