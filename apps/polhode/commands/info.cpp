// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include <nlohmann/json.hpp>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/solids/elements/registry.hpp>
#include <polhode/solids/loads/registry.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>

#include "command.hpp"
#include "console.hpp"
#include "model_counts.hpp"
#include "run_report.hpp"

namespace polhode::cli {

namespace {

/// Largest number of lines in tables of a large model.
constexpr std::size_t kMaxLines = 40;

struct InfoOptions {
  ModelArguments model;
  std::string kinds;
  bool json = false;
};

/// A kind of joint, load or shape in the listing.
struct KindLine {
  std::string name, meaning, more;
  std::vector<std::string> takes;
};

std::string with_unit(const Parameter& p) {
  return p.unit == "-" ? p.name : format("{} [{}]", p.name, p.unit);
}

std::vector<KindLine> kind_lines(const std::string& kinds) {
  std::vector<KindLine> lines;
  if (kinds == "joints")
    for (const JointKind& kind : joint_kinds()) {
      KindLine line{kind.name, kind.meaning, "free: " + kind.free, {}};
      for (const Parameter& p : kind.parameters) line.takes.push_back(with_unit(p));
      lines.push_back(std::move(line));
    }
  if (kinds == "loads")
    for (const LoadKind& kind : load_kinds()) {
      KindLine line{kind.name, kind.meaning, "", {}};
      if (!kind.vector.empty()) line.takes.push_back(kind.vector);
      for (const Parameter& p : kind.parameters) line.takes.push_back(with_unit(p));
      lines.push_back(std::move(line));
    }
  if (kinds == "loads")
    for (const io::KindTable& kind : io::load_tables())
      if (kind.name == io::kJointMoment || kind.name == io::kJointForce)
        lines.push_back({kind.name,
                         kind.table.meaning.substr(0, kind.table.meaning.size() - 1),
                         "",
                         {kind.name == io::kJointMoment ? "moment" : "force", "resistance"}});
  if (kinds == "loads")
    for (const solids::SolidLoadKind& kind : solids::solid_load_kinds()) {
      KindLine line{kind.name, kind.meaning, "", {}};
      for (const auto& function : {kind.value, kind.vector})
        if (function) line.takes.push_back(function->name);
      for (const Parameter& p : kind.parameters) line.takes.push_back(with_unit(p));
      lines.push_back(std::move(line));
    }
  if (kinds == "materials")
    for (const solids::MaterialKind& kind : solids::material_kinds()) {
      KindLine line{kind.name, kind.meaning, kind.uncoupled ? "uncoupled" : "", {}};
      for (const Parameter& p : kind.parameters) line.takes.push_back(with_unit(p));
      lines.push_back(std::move(line));
    }
  if (kinds == "elements")
    for (const solids::ElementKind& kind : solids::element_kinds())
      lines.push_back({kind.name, kind.meaning, "cells: " + kind.shape, {}});
  if (kinds == "meshes")
    for (const solids::MeshGenerator& kind : solids::mesh_generators()) {
      KindLine line{kind.name, kind.meaning, "sides: " + kind.sides, {}};
      for (const solids::MeshParameter& p : kind.parameters) line.takes.push_back(p.name);
      lines.push_back(std::move(line));
    }
  if (kinds == "shapes")
    for (const geometry::ShapeKind& kind : geometry::shape_kinds()) {
      KindLine line{kind.name, kind.meaning, "", {}};
      for (const geometry::ShapeSize& size : kind.sizes) line.takes.push_back(size.name);
      lines.push_back(std::move(line));
    }
  return lines;
}

std::string joined(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : ", ") + item;
  return text;
}

void print_kinds(const InfoOptions& options) {
  const std::vector<KindLine> lines = kind_lines(options.kinds);
  if (options.json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const KindLine& line : lines)
      json.push_back({{"name", line.name}, {"meaning", line.meaning}, {"takes", line.takes}});
    print(json.dump(2) + "\n");
    return;
  }
  std::vector<std::vector<std::string>> rows;
  rows.reserve(lines.size());
  for (const KindLine& line : lines)
    rows.push_back({line.name, line.meaning, line.more, joined(line.takes)});
  print(table(rows));
}

std::string name_of(const Model& model, int body) {
  return body == kGround ? "ground" : model.bodies[static_cast<std::size_t>(body)].name;
}

std::string numbers(const Vec3& x) { return format("{:.4g} {:.4g} {:.4g}", x[0], x[1], x[2]); }

/// Adds a line for each item, at most kMaxLines of them.
template <class Items, class Line>
std::string section(const std::string& heading, const std::vector<std::string>& columns,
                    const Items& items, Line line) {
  if (items.empty()) return "";
  std::vector<std::vector<std::string>> rows{columns};
  for (std::size_t i = 0; i < items.size() && i < kMaxLines; ++i) rows.push_back(line(items[i]));
  std::string text = format("\n{}: {}\n", heading, items.size()) + table(rows);
  if (items.size() > kMaxLines) text += format("  and {} more\n", items.size() - kMaxLines);
  return text;
}

std::string contact_text(const Simulation& simulation) {
  if (!simulation.has_contacts()) return "none";
  const ContactsSpec& contacts = simulation.model().contacts;
  const auto sensors = static_cast<std::size_t>(
      std::count_if(contacts.pairs.begin(), contacts.pairs.end(),
                    [](const ContactPairSpec& pair) { return pair.sensor; }));
  const std::size_t surfaces = simulation.contact_map().surfaces.size();
  std::string text = surfaces > 0 ? counted(surfaces, "surface", "surfaces") + ", " : "";
  text += format("{} shapes, law {}, friction {:g}, restitution {:g}",
                 simulation.contact_map().body.size(), contacts.standard.potential,
                 contacts.standard.friction, contacts.standard.restitution);
  if (contacts.pairs.size() > sensors)
    text += ", " + counted(contacts.pairs.size() - sensors, "pair", "pairs") +
            " with a law of their own";
  if (sensors > 0) text += ", " + counted(sensors, "sensor", "sensors");
  return text;
}

std::string describe(const Simulation& simulation) {
  const Model& model = simulation.model();
  double mass = 0.0;
  for (const BodySpec& body : model.bodies) mass += body.fixed ? 0.0 : body.mass;
  const RunSummary summary = simulation.summary();
  std::string text =
      table({{"title", model.title},
             {"gravity", numbers(model.gravity) + " m/s^2"},
             {"moving bodies", format("{}", moving_bodies(simulation.model())),
              format("{:.6g} kg together", mass)},
             {"constraint rows", format("{}", simulation.system().rows())},
             {"contact", contact_text(simulation)},
             {"analysis", model.analysis.type,
              is_endless(model.analysis) ? "without an end"
                                         : format("{:.6g} s", model.analysis.duration)},
             {"solver", summary.solver, summary.instruction_set},
             {"order", format("{}", summary.order)}},
            "", false);
  if (!summary.narration.empty()) text += "\n" + summary.narration + "\n";
  std::vector<BodySpec> bodies;  // without the nodes of beams and cables
  const std::vector<bool> nodes = are_nodes(model);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!nodes[i]) bodies.push_back(model.bodies[i]);
  text += section("Bodies", {"name", "mass [kg]", "inertia xx yy zz [kg m^2]", "position [m]"},
                  bodies, [](const BodySpec& b) -> std::vector<std::string> {
                    if (b.fixed) return {b.name, "fixed", "", numbers(b.position)};
                    return {b.name, format("{:.6g}", b.mass), numbers(b.inertia.diagonal()),
                            numbers(b.position)};
                  });
  text += section("Joints", {"name", "type", "bodies"}, model.joints, [&](const JointSpec& j) {
    return std::vector<std::string>{j.name, j.type,
                                    name_of(model, j.a) + " - " + name_of(model, j.b)};
  });
  text += section("Loads", {"name", "type", "acts on"}, model.loads, [&](const LoadSpec& l) {
    if (l.solid >= 0)
      return std::vector<std::string>{
          l.name, l.type, "solid " + model.solids[static_cast<std::size_t>(l.solid)].name};
    std::string on = name_of(model, l.b);
    if (l.a != kGround) on = name_of(model, l.a) + " - " + on;
    if (!l.joint.empty()) on = "joint " + l.joint;
    return std::vector<std::string>{l.name, l.type, on};
  });
  std::size_t next = 0;
  text += section("Solids", {"name", "elements", "nodes", "mass [kg]", "material", "stress"},
                  model.solids, [&](const SolidSpec& spec) -> std::vector<std::string> {
                    const SolidMap& solid = simulation.solids()[next++];
                    return {spec.name,
                            format("{} {}", solid.plan.mesh.element_count(),
                                   joined(element_kinds_of(solid.plan))),
                            format("{}", solid.node_count()),
                            format("{:.6g}", solid.mass),
                            spec.material,
                            spec.stress};
                  });
  text += section("Beams", {"name", "elements", "section", "mass [kg]"}, model.beams,
                  [](const BeamSpec& beam) -> std::vector<std::string> {
                    return {beam.name, format("{}", beam.mesh.size()), beam.section.name,
                            format("{:.6g}", beam.mass())};
                  });
  text += section("Cables", {"name", "pieces", "free length [m]", "stiffness [N]", "mass [kg]"},
                  model.cables, [](const CableLineSpec& cable) -> std::vector<std::string> {
                    return {cable.name, format("{}", cable.pieces.size()),
                            format("{:.6g}", cable.length()), format("{:.6g}", cable.stiffness),
                            format("{:.6g}", cable.mass())};
                  });
  return text;
}

std::string describe_json(const Simulation& simulation) {
  const Model& model = simulation.model();
  const RunSummary summary = simulation.summary();
  nlohmann::ordered_json bodies = nlohmann::ordered_json::array();
  for (const BodySpec& b : model.bodies)
    bodies.push_back({{"name", b.name},
                      {"fixed", b.fixed},
                      {"mass", b.mass},
                      {"position", {b.position[0], b.position[1], b.position[2]}}});
  nlohmann::ordered_json joints = nlohmann::ordered_json::array();
  for (const JointSpec& j : model.joints)
    joints.push_back({{"name", j.name},
                      {"type", j.type},
                      {"bodies", {name_of(model, j.a), name_of(model, j.b)}}});
  nlohmann::ordered_json loads = nlohmann::ordered_json::array();
  for (const LoadSpec& l : model.loads) loads.push_back({{"name", l.name}, {"type", l.type}});
  nlohmann::ordered_json solids = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const SolidMap& solid = simulation.solids()[i];
    solids.push_back({{"name", model.solids[i].name},
                      {"material", model.solids[i].material},
                      {"elements", element_kinds_of(solid.plan)},
                      {"nodes", solid.node_count()},
                      {"mass", solid.mass}});
  }
  nlohmann::ordered_json beams = nlohmann::ordered_json::array();
  for (const BeamSpec& beam : model.beams)
    beams.push_back(
        {{"name", beam.name}, {"section", beam.section.name}, {"elements", beam.mesh.size()}});
  nlohmann::ordered_json cables = nlohmann::ordered_json::array();
  for (const CableLineSpec& cable : model.cables)
    cables.push_back({{"name", cable.name}, {"pieces", cable.pieces.size()}});
  const nlohmann::ordered_json json = {{"title", model.title},
                                       {"moving_bodies", moving_bodies(simulation.model())},
                                       {"constraint_rows", simulation.system().rows()},
                                       {"solver", summary.solver},
                                       {"instruction_set", summary.instruction_set},
                                       {"order", summary.order},
                                       {"bodies", bodies},
                                       {"joints", joints},
                                       {"loads", loads},
                                       {"solids", solids},
                                       {"beams", beams},
                                       {"cables", cables},
                                       {"contact_shapes", simulation.contact_map().body.size()}};
  return json.dump(2) + "\n";
}

}  // namespace

Action add_info(CLI::App& command) {
  const auto options = std::make_shared<InfoOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)");
  add_set_option(command, options->model);
  command
      .add_option("--kinds", options->kinds,
                  "List what exists: joints, loads, shapes, materials, elements or meshes")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"joints", "loads", "shapes", "materials", "elements", "meshes"}));
  command.add_flag("--json", options->json, "Print it as JSON");
  return [options] {
    if (!options->kinds.empty()) {
      print_kinds(*options);
      return kOk;
    }
    if (options->model.file.empty()) {
      say("polhode info: names no model. Give a MODEL, or --kinds and joints, loads, shapes, "
          "materials, "
          "elements or meshes.");
      return kUsage;
    }
    const Simulation simulation(load_model(options->model));
    print(options->json ? describe_json(simulation) : describe(simulation));
    return kOk;
  };
}

}  // namespace polhode::cli
