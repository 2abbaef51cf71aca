// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/loads/force_law.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/newton/rank_report.hpp>
#include <polhode/newton/tangent_check.hpp>
#include <polhode/statics/static_reach.hpp>
#include <polhode/stepping/contradiction.hpp>
#include <polhode/surface_contact/edge_contact.hpp>

#include "command.hpp"
#include "console.hpp"
#include "model_counts.hpp"
#include "run_report.hpp"

namespace polhode::cli {

namespace {

struct CheckOptions {
  ModelArguments model;
  bool tangents = false, json = false;
  double at = 0.0;  ///< Time at which tangents are compared [s].
};

/// Joints, motors and bodies whose motion follows a function of time.
std::vector<std::string> drives(const Simulation& simulation) {
  const System& system = simulation.system();
  std::vector<std::string> names;
  for (const InteractionRef& ref : system.interactions())
    if (const InteractionGroup& group = system.group(ref.group); group.traits(ref.item).prescribes)
      names.push_back(format("{} {}", group.kind(), quote(system.name(ref))));
  return names;
}

/// Joints and drives whose rows no motion satisfies from the start on, so that a run ends there.
std::vector<std::string> contradictions(const Simulation& simulation) {
  const AnalysisSpec& analysis = simulation.model().analysis;
  if (analysis.type != "dynamics") return {};
  constexpr double kStepOfDuration = 0.01;
  return contradicting(simulation.system(), simulation.state(),
                       analysis.step.value_or(kStepOfDuration * analysis.duration));
}

/// A drive that leaves the reach of the joints as the load of a static run grows.
void add_end_of_reach(const Simulation& simulation, std::vector<std::string>& list) {
  const AnalysisSpec& analysis = simulation.model().analysis;
  if (analysis.type != "statics" || analysis.history) return;
  const std::optional<ReachEnd> end = end_of_reach(simulation.system(), simulation.state());
  if (!end) return;
  list.push_back(format(
      "Beyond load factor {:.3g} these cannot all hold: {}; {} {} remains at {}. Remove one of "
      "them, or change its motion.",
      end->load_factor, name_list(end->gap.names, 12),
      end->whole ? "at the whole load" : "shortly beyond", end->gap.open.gap_text(),
      interaction_name(simulation.system(), end->gap.open.interaction)));
}

/// Jumps of the laws of a load over a rate, where it acts like dry friction.
void add_law_jumps(const LoadSpec& load, std::vector<std::string>& list) {
  const LoadKind& kind = load_kind(load.type);
  for (const LawParameter& law : kind.laws) {
    const auto given = load.laws.find(law.name);
    if (law.variable != "v" || given == load.laws.end()) continue;
    for (const LawJump& jump : jumps_of(*given->second)) {
      if (jump.size > 0.0)
        list.push_back(
            format("{} of load '{}' jumps by {:.6g} {} at {:.6g} {}: it holds there like dry "
                   "friction, to a width of {:g} {}. Give a law that rises over a larger one if "
                   "that is meant.",
                   law.name, load.name, jump.size, law.unit, jump.at, law.of, kJumpWidth, law.of));
      else
        list.push_back(
            format("{} of load '{}' falls by {:.6g} {} at {:.6g} {}: in each step the side is that "
                   "of its start. Give a law that falls over a range of rates if that is meant.",
                   law.name, load.name, -jump.size, law.unit, jump.at, law.of));
    }
  }
}

/// Length of a muscle's fibres at the start over their optimal length; nothing for other cables.
std::optional<double> fibre_length(const Simulation& simulation, std::size_t cable) {
  const CableLineSpec& spec = simulation.model().cables[cable];
  const CableReport report = simulation.cable(static_cast<int>(cable));
  if (!spec.muscle || !report.whole) return std::nullopt;
  return report.whole->fibre_length / spec.muscle->optimal_length;
}

/// Muscles whose fibres are outside of the lengths at which they can pull actively.
void add_muscle_warnings(const Simulation& simulation, std::vector<std::string>& list) {
  // Active forces there are a fortieth and an eighth of the largest: @eq{muscle-length}
  constexpr double kLeast = 0.4, kMost = 1.6;
  const std::vector<CableLineSpec>& cables = simulation.model().cables;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    const std::optional<double> length = fibre_length(simulation, i);
    if (!length || (*length >= kLeast && *length <= kMost)) continue;
    list.push_back(format(
        "The fibres of muscle '{}' start at {:.3g} of their optimal length, outside of {:g} "
        "to {:g}, beyond which they hardly pull. Check tendon_length, optimal_length and the path.",
        cables[i].name, *length, kLeast, kMost));
  }
}

/// Conspicuous findings in a model that can be run.
std::vector<std::string> warnings(const Simulation& simulation, const RankReport& rank) {
  std::vector<std::string> list;
  const StartReport& start = simulation.start_report();
  if (start.largest_move > 1e-6)
    list.push_back(
        format("The start is not assembled: the residual of the joints is {:.2g}; body '{}' was "
               "moved by {:.2g} "
               "of the mechanism's size. Check the positions of the joints.",
               start.position_residual, start.moved_body, start.largest_move));
  // Bodies of which no velocity is given take that of the drives.
  const std::vector<BodySpec>& bodies = simulation.model().bodies;
  const bool all_rest = std::all_of(bodies.begin(), bodies.end(), [](const BodySpec& b) {
    return b.velocity.isZero(0.0) && b.angular_velocity.isZero(0.0);
  });
  if (start.velocity_change > 1e-6 && (!all_rest || drives(simulation).empty()))
    list.push_back(
        format("The initial velocities violate the joints by {:.2g}; they were corrected by up to "
               "{:.2g}. Give velocities that the joints allow.",
               start.velocity_residual, start.velocity_change));
  if (rank.redundant > 0) {
    list.push_back(
        format("{} of {} constraint rows are redundant; they involve {}. The motion is unique, but "
               "the reactions are not: those of smallest norm are reported.",
               rank.redundant, rank.rows, name_list(rank.names, 12)));
  }
  if (rank.mobility == 0 && simulation.system().body_count() > 0 && simulation.solids().empty() &&
      drives(simulation).empty())
    list.emplace_back("The mobility is 0: nothing can move.");
  if (simulation.has_contacts() && simulation.model().analysis.rho_inf < 1.0)
    list.push_back(
        format("rho_inf is {:g}: numerical damping takes energy from every contact, so restitution "
               "and rebound are too small. Set rho_inf: 1.",
               simulation.model().analysis.rho_inf));
  for (const LoadSpec& load : simulation.model().loads) add_law_jumps(load, list);
  add_muscle_warnings(simulation, list);
  add_end_of_reach(simulation, list);
  for (const SolidMap& solid : simulation.solids())
    list.insert(list.end(), solid.plan.warnings.begin(), solid.plan.warnings.end());
  return list;
}

/// Description of interfaces: "base (25 nodes), plate (25 nodes)".
std::string interfaces_text(const Simulation& simulation, std::size_t solid) {
  const SolidPlan& plan = simulation.solids()[solid].plan;
  const std::vector<std::string> names = simulation.interfaces(static_cast<int>(solid));
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const auto& nodes =
        k < plan.bonded.size() ? plan.bonded[k] : plan.prescribed[k - plan.bonded.size()];
    text +=
        format("{}{} ({})", k == 0 ? "" : ", ", names[k], counted(nodes.size(), "node", "nodes"));
  }
  return text.empty() ? "nothing" : text;
}

nlohmann::ordered_json solids_json(const Simulation& simulation) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < simulation.solids().size(); ++i) {
    const SolidMap& solid = simulation.solids()[i];
    nlohmann::ordered_json interfaces = nlohmann::ordered_json::object();
    const std::vector<std::string> names = simulation.interfaces(static_cast<int>(i));
    const std::size_t bonds = solid.plan.bonded.size();
    for (std::size_t k = 0; k < names.size(); ++k)
      interfaces[names[k]] =
          k < bonds ? solid.plan.bonded[k].size() : solid.plan.prescribed[k - bonds].size();
    list.push_back({{"name", simulation.model().solids[i].name},
                    {"nodes", solid.node_count()},
                    {"elements", solid.plan.mesh.element_count()},
                    {"element_kinds", element_kinds_of(solid.plan)},
                    {"mass", solid.mass},
                    {"volume", solid.plan.volume},
                    {"interfaces", interfaces},
                    {"smallest_det", solid.plan.least_jacobian},
                    {"smallest_det_element", solid.plan.least_element}});
  }
  return list;
}

nlohmann::ordered_json beams_json(const Model& model) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const BeamSpec& beam : model.beams)
    list.push_back({{"name", beam.name},
                    {"nodes", beam.node_count()},
                    {"elements", beam.mesh.size()},
                    {"section", beam.section.name},
                    {"length", beam.length()},
                    {"mass", beam.mass()}});
  return list;
}

nlohmann::ordered_json cables_json(const Simulation& simulation) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const std::vector<CableLineSpec>& cables = simulation.model().cables;
  for (std::size_t i = 0; i < cables.size(); ++i) {
    list.push_back({{"name", cables[i].name},
                    {"pieces", cables[i].pieces.size()},
                    {"free_length", cables[i].length()},
                    {"mass", cables[i].mass()}});
    if (const auto length = fibre_length(simulation, i))
      list.back()["fibre_over_optimal"] = *length;
    if (!cables[i].around.empty())
      list.back()["length"] = simulation.cable(static_cast<int>(i)).whole->length;
  }
  return list;
}

void add_line_rows(const Simulation& simulation, std::vector<std::vector<std::string>>& rows) {
  const Model& model = simulation.model();
  for (const BeamSpec& beam : model.beams)
    rows.push_back(
        {format("beam {}", beam.name), counted(beam.mesh.size(), "element", "elements"),
         format("section {}, {:.6g} m, {:.6g} kg", beam.section.name, beam.length(), beam.mass())});
  for (std::size_t i = 0; i < model.cables.size(); ++i) {
    const CableLineSpec& cable = model.cables[i];
    const std::optional<double> length = fibre_length(simulation, i);
    std::string text =
        length ? format("fibres at {:.3g} of their optimal length", *length)
               : format("{:.6g} m free length, {:.6g} kg", cable.length(), cable.mass());
    if (!cable.around.empty()) {
      text += format(", {:.6g} m long around", simulation.cable(static_cast<int>(i)).whole->length);
      for (const ObstacleSpec& obstacle : cable.around) text += format(" '{}'", obstacle.name);
    }
    rows.push_back({format("{} {}", length ? "muscle" : "cable", cable.name),
                    counted(cable.pieces.size(), "piece", "pieces"), text});
  }
}

/// Contact of a surface of a solid, or of a cable, with a shape or another surface.
struct TouchingGroup {
  std::string name;
  const surface_contact::SurfaceLaw& law;
  std::size_t places;
  bool edges;
};

TouchingGroup touching_group(const Simulation& simulation, const ContactMap::Surface& s) {
  const ElementGroup& group = simulation.system().nodes().group(s.group);
  return {group.name(), s.touching->law(), s.touching->places(),
          group.kind() == surface_contact::EdgeContact::kKind};
}

/// Contacts of surfaces of solids and cables, and their laws.
nlohmann::ordered_json surfaces_json(const Simulation& simulation) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const Model& model = simulation.model();
  for (const ContactMap::Surface& s : simulation.contact_map().surfaces) {
    const TouchingGroup group = touching_group(simulation, s);
    list.push_back({{s.own.is_cable() ? "cable" : "solid", model.side_name(s.own)},
                    {s.side.is_solid() ? "on_solid" : "body", model.side_name(s.side)},
                    {group.edges ? "edges" : "points", group.places},
                    {"gap_tolerance", group.law.normal.tolerance},
                    {"stiffness_per_area", group.law.normal.stiffness},
                    {"friction", group.law.mu}});
  }
  return list;
}

void add_surface_rows(const Simulation& simulation, std::vector<std::vector<std::string>>& rows) {
  for (const ContactMap::Surface& s : simulation.contact_map().surfaces) {
    const TouchingGroup group = touching_group(simulation, s);
    rows.push_back({format("surface {}", group.name),
                    group.edges ? counted(group.places, "edge", "edges")
                                : counted(group.places, "point", "points"),
                    format("gap tolerance {:.3g} m, stiffness {:.3g} Pa/m, friction {:g}",
                           group.law.normal.tolerance, group.law.normal.stiffness, group.law.mu)});
  }
}

nlohmann::ordered_json contacts_json(const Simulation& simulation) {
  if (!simulation.has_contacts()) return nullptr;
  return {{"surfaces", surfaces_json(simulation)},
          {"shapes", simulation.contact_map().body.size()},
          {"pairs_kept", simulation.contact_map().pairs.size()},
          {"every_pair_kept", simulation.contact_map().all_pairs}};
}

/// Compares tangents at a time, or as late as the model can be run.
TangentReport tangents_of(Simulation& simulation, double at) {
  while (simulation.time() < at) simulation.step(at);
  const AnalysisSpec& analysis = simulation.model().analysis;
  const double dt = analysis.step.value_or(1e-3 * analysis.duration);
  TangentReport report = check_tangents(simulation.system(), simulation.state(), dt,
                                        analysis.rho_inf, momentum_rate(analysis.momentum_rate));
  if (analysis.type != "dynamics")
    report.left_out.push_back(
        format("terms of {} alone: the tangent of a dynamic step was compared", analysis.type));
  return report;
}

/// Adds rows of a table: the largest error of each part, and parts that were not compared.
void add_tangent_rows(const TangentReport& report, std::vector<std::vector<std::string>>& rows) {
  const bool failed = !(report.error() <= kTangentTolerance);
  rows.push_back({"tangents", format("{:.1e}", report.error()),
                  failed ? "WRONG: " + report.text() : "against central differences"});
  for (const TangentPart& part : report.parts)
    rows.push_back({"  " + part.kind, format("{:.1e}", part.worst.error),
                    format("{} of {} compared", part.compared, part.of)});
  for (const std::string& what : report.left_out) rows.push_back({"  left out", "", what});
}

nlohmann::ordered_json tangents_json(const TangentReport& report) {
  nlohmann::ordered_json parts = nlohmann::ordered_json::array();
  for (const TangentPart& part : report.parts)
    parts.push_back({{"kind", part.kind},
                     {"error", part.worst.error},
                     {"compared", part.compared},
                     {"of", part.of}});
  return {{"error", report.error()},
          {"of", report.worst.of},
          {"row", report.worst.row},
          {"column", report.worst.column},
          {"passed", report.error() <= kTangentTolerance},
          {"parts", parts},
          {"left_out", report.left_out}};
}

int check(const CheckOptions& options) {
  Simulation simulation(load_model(options.model));
  RankReport rank = rank_report(simulation.system(), simulation.state());
  for (const BodySpec& body : simulation.model().bodies)
    // rotations of a point mass are no motions
    if (body.point_mass && !body.fixed) rank.mobility -= 3;
  const std::vector<std::string> notes = warnings(simulation, rank);
  const StartReport& start = simulation.start_report();
  const std::vector<std::string> impossible = contradictions(simulation);
  bool failed = !impossible.empty();

  if (options.json) {
    nlohmann::ordered_json json = {{"valid", impossible.empty()},
                                   {"bodies", given_bodies(simulation.model())},
                                   {"moving_bodies", moving_bodies(simulation.model())},
                                   {"joints", simulation.model().joints.size()},
                                   {"loads", simulation.model().loads.size()},
                                   {"solids", solids_json(simulation)},
                                   {"beams", beams_json(simulation.model())},
                                   {"cables", cables_json(simulation)},
                                   {"contacts", contacts_json(simulation)},
                                   {"constraint_rows", rank.rows},
                                   {"rank", rank.rank},
                                   {"redundant_rows", rank.redundant},
                                   {"redundant", rank.names},
                                   {"mobility", rank.mobility},
                                   {"prescribed_by", drives(simulation)},
                                   {"contradicting", impossible},
                                   {"start",
                                    {{"position_residual", start.position_residual},
                                     {"largest_move", start.largest_move},
                                     {"moved_body", start.moved_body},
                                     {"velocity_residual", start.velocity_residual},
                                     {"velocity_change", start.velocity_change}}},
                                   {"warnings", notes}};
    if (options.tangents) {
      const TangentReport tangents = tangents_of(simulation, options.at);
      failed = failed || !(tangents.error() <= kTangentTolerance);
      json["tangents"] = tangents_json(tangents);
    }
    print(json.dump(2) + "\n");
  } else {
    std::vector<std::vector<std::string>> rows{
        {"bodies", format("{}", given_bodies(simulation.model())),
         format("{} of them move", moving_bodies(simulation.model()))},
        {"joints", format("{}", simulation.model().joints.size())},
        {"loads", format("{}", simulation.model().loads.size())},
        {"mobility", format("{}", rank.mobility),
         drives(simulation).empty()
             ? "independent motions at the start"
             : format("independent motions at the start, besides those of {}",
                      name_list(drives(simulation), 3))},
        {"constraint rows", format("{}", rank.rows),
         format("rank {}, {} redundant", rank.rank, rank.redundant)},
        {"position residual", format("{:.1e}", start.position_residual),
         format("at the start; bodies were moved by up to {:.1e}", start.largest_move)},
        {"velocity residual", format("{:.1e}", start.velocity_residual),
         format("at the start; velocities were corrected by up to {:.1e}", start.velocity_change)},
        {"solver", simulation.summary().solver}};
    if (is_endless(simulation.model().analysis))
      rows.push_back({"duration", "none", "steps from Python or C++; a run needs --duration"});
    for (std::size_t i = 0; i < simulation.solids().size(); ++i) {
      const SolidMap& solid = simulation.solids()[i];
      rows.push_back(
          {format("solid {}", simulation.model().solids[i].name),
           counted(static_cast<std::size_t>(solid.node_count()), "node", "nodes"),
           format("{} {}, {:.6g} kg, {:.6g} m^3, held by {}; smallest Jacobian "
                  "determinant {:.3g} m^3 in "
                  "element {}",
                  solid.plan.mesh.element_count(), name_list(element_kinds_of(solid.plan)),
                  solid.mass, solid.plan.volume, interfaces_text(simulation, i),
                  solid.plan.least_jacobian, solid.plan.least_element)});
    }
    add_line_rows(simulation, rows);
    add_surface_rows(simulation, rows);
    if (simulation.has_contacts())
      rows.push_back({"contact", counted(simulation.contact_map().body.size(), "shape", "shapes"),
                      format("no overlaps at the start; results of {} are recorded",
                             counted(simulation.contact_map().pairs.size(), "pair", "pairs"))});
    if (options.tangents) {  // last: the model may have to be run for it
      const TangentReport tangents = tangents_of(simulation, options.at);
      failed = failed || !(tangents.error() <= kTangentTolerance);
      add_tangent_rows(tangents, rows);
    }
    print(table(rows));
    for (const std::string& note : notes) say("warning: " + note);
  }
  if (!impossible.empty())
    say(
        format("These cannot all hold from the start on: {}. Remove one of them, or change "
               "its motion.",
               name_list(impossible, 12)));
  return failed ? kCheckFailed : kOk;
}

}  // namespace

Action add_check(CLI::App& command) {
  const auto options = std::make_shared<CheckOptions>();
  command.add_option("MODEL", options->model.file, "Model file (YAML or JSON)")->required();
  add_set_option(command, options->model);
  command.add_flag("--tangents", options->tangents,
                   "Compare tangents with central differences: assembled, and part by part");
  command.add_option("--at", options->at, "Run until this time first [s]")
      ->check(CLI::NonNegativeNumber)
      ->needs("--tangents");
  command.add_flag("--json", options->json, "Print the findings as one JSON object");
  return [options] { return check(*options); };
}

}  // namespace polhode::cli
