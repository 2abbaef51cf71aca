// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include <polhode/compile/solid_mass.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/model/whole_mass.hpp>
#include <polhode/newton/rank_report.hpp>

#include "command.hpp"
#include "console.hpp"
#include "model_counts.hpp"
#include "run_report.hpp"

namespace polhode::cli {

namespace {

struct ImportCommand {
  ModelArguments model;
  bool report = false, json = false;
};

/// Notes of one kind, as JSON.
nlohmann::ordered_json notes_json(const io::ImportReport& report, io::ImportNote::Kind kind) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const io::ImportNote& n : report.notes)
    if (n.kind == kind)
      list.push_back({{"file", n.place.file}, {"line", n.place.line}, {"what", n.what}});
  return list;
}

nlohmann::ordered_json three_json(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// Mass, its centre and inertia of all bodies and solids at the start.
geometry::MassProperties total_mass(const Simulation& simulation) {
  std::vector<geometry::MassProperties> parts;
  if (const geometry::MassProperties bodies = whole_mass(simulation.model()); bodies.mass > 0.0)
    parts.push_back(bodies);
  for (const SolidMap& solid : simulation.solids())
    if (solid.mass > 0.0) parts.push_back(solid_mass(solid));
  return parts.empty() ? geometry::MassProperties{} : geometry::composed(parts);
}

/// Sizes of the deformable part of a model.
struct SolidCounts {
  std::size_t elements = 0, nodes = 0, interfaces = 0;
};
SolidCounts solid_counts(const Simulation& simulation) {
  SolidCounts counts;
  for (const SolidMap& solid : simulation.solids()) {
    counts.elements += static_cast<std::size_t>(solid.plan.mesh.element_count());
    counts.nodes += static_cast<std::size_t>(solid.node_count());
  }
  for (const SolidSpec& solid : simulation.model().solids)
    counts.interfaces += solid.bonded.size() + solid.prescribed.size();
  return counts;
}

nlohmann::ordered_json report_json(const io::ImportReport& report, const Simulation& simulation,
                                   const RankReport& rank) {
  const geometry::MassProperties whole = total_mass(simulation);
  const SolidCounts solids = solid_counts(simulation);
  const Mat3& J = whole.inertia;
  using Kind = io::ImportNote::Kind;
  return {{"format", report.format},
          {"file", report.file},
          {"bodies", simulation.model().bodies.size()},
          {"moving_bodies", moving_bodies(simulation.model())},
          {"joints", simulation.model().joints.size()},
          {"loops", loop_count(simulation.model())},
          {"freedoms", rank.mobility},
          {"solids", simulation.solids().size()},
          {"elements", solids.elements},
          {"nodes", solids.nodes},
          {"materials", simulation.model().materials.size()},
          {"interfaces", solids.interfaces},
          {"contact_pairs", simulation.model().contacts.pairs.size()},
          {"mass", whole.mass},
          {"center_of_mass", three_json(whole.com)},
          {"inertia", {three_json(J.row(0)), three_json(J.row(1)), three_json(J.row(2))}},
          {"constraint_rows", rank.rows},
          {"redundant_rows", rank.redundant},
          {"redundant", rank.names},
          {"approximated", notes_json(report, Kind::approximated)},
          {"ignored", notes_json(report, Kind::ignored)},
          {"left_out", notes_json(report, Kind::left_out)}};
}

std::string three_numbers(const Vec3& x) {
  return format("{:.9g} {:.9g} {:.9g}", x[0], x[1], x[2]);
}

std::string report_text(const io::ImportReport& report, const Simulation& simulation,
                        const RankReport& rank) {
  const geometry::MassProperties whole = total_mass(simulation);
  const SolidCounts solids = solid_counts(simulation);
  const Mat3& J = whole.inertia;
  std::vector<std::vector<std::string>> of_solids;
  if (!simulation.solids().empty())
    of_solids = {{"solids", format("{}", simulation.solids().size()),
                  format("{} elements, {} nodes", solids.elements, solids.nodes)},
                 {"materials", format("{}", simulation.model().materials.size())},
                 {"interfaces", format("{}", solids.interfaces),
                  "bonds to bodies and conditions on displacements"}};
  if (!simulation.model().contacts.pairs.empty())
    of_solids.push_back(
        {"contacts", format("{}", simulation.model().contacts.pairs.size()), "pairs"});
  std::vector<std::vector<std::string>> rows = {
      {"format", report.format},
      {"bodies", format("{}", simulation.model().bodies.size()),
       format("{} of them move", moving_bodies(simulation.model()))},
      {"joints", format("{}", simulation.model().joints.size()),
       counted(static_cast<std::size_t>(loop_count(simulation.model())), "loop", "loops")},
      {"freedoms", format("{}", rank.mobility), "independent motions at the start"},
      {"constraint rows", format("{}", rank.rows),
       rank.redundant == 0
           ? "none redundant"
           : format("{} redundant, of {}", rank.redundant, name_list(rank.names, 12))},
      {"mass", format("{:.12g}", whole.mass), "kg"},
      {"centre of mass", three_numbers(whole.com), "m, at the start"},
      {"inertia about it", three_numbers(J.diagonal()), "kg m^2, xx yy zz"},
      {"", three_numbers({J(0, 1), J(0, 2), J(1, 2)}), "kg m^2, xy xz yz"}};
  rows.insert(rows.begin() + 3, of_solids.begin(), of_solids.end());
  std::string text = table(rows, "", false);
  using Kind = io::ImportNote::Kind;
  for (const Kind kind : {Kind::left_out, Kind::approximated, Kind::ignored}) {
    std::string list;
    for (const io::ImportNote& n : report.notes)
      if (n.kind == kind) list += format("  line {}: {}\n", n.place.line, n.what);
    if (!list.empty()) text += format("\n{}:\n{}", io::word_of(kind), list);
  }
  return text;
}

int report_import(const ImportCommand& options) {
  const io::ExpandedModel expanded =
      io::expanded_model(options.model.file, options.model.overrides);
  if (expanded.report.format.empty())
    throw InputError("polhode import", quote(options.model.file) + " imports nothing",
                     "Give a file of another program (.urdf, .xacro, .xml, .sdf, .feb), or a model "
                     "file with the key import");
  const Simulation simulation(load_model(options.model));
  const RankReport rank = rank_report(simulation.system(), simulation.state());
  print(options.json ? report_json(expanded.report, simulation, rank).dump(2) + "\n"
                     : report_text(expanded.report, simulation, rank));
  return kOk;
}

}  // namespace

Action add_import(CLI::App& command) {
  const auto options = std::make_shared<ImportCommand>();
  command
      .add_option("FILE", options->model.file,
                  "URDF, xacro, MJCF, SDFormat or FEBio file, or a model that imports one")
      ->required();
  command.add_flag("--report", options->report, "Print the report, which is the default");
  command.add_flag("--json", options->json, "Print it as one JSON object");
  add_set_option(command, options->model);
  return [options] { return report_import(*options); };
}

}  // namespace polhode::cli
