// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode {
namespace {

/// Sets a value that is given in the file, and leaves the default otherwise.
template <class Target, class Value>
void assign(Target& target, const std::optional<Value>& value) {
  if (value) target = *value;
}

/// A time, or auto.
void read_step(ReadContext& context, Section& section, AnalysisSpec& analysis) {
  const SourceNode* value = section.find("step");
  if (!value || (value->is_text() && value->text == "auto")) return;
  if (const std::string guess = value->is_text() ? closest(value->text, {"auto", "automatic"}) : "";
      !guess.empty()) {
    context.fault(*value, section.path("step"), quote(value->text) + " is not known",
                  "Did you mean 'auto'? Give auto or a time.");
    return;
  }
  analysis.step = section.number("step");
}

/// Rejects entries without meaning in an analysis of this type.
void check_type(Section& section, const std::string& type) {
  const auto refuse = [&](const char* key, const std::string& goes_with) {
    if (section.has(key))
      section.fault(key, "cannot be combined with type " + type, "It requires " + goes_with + ".");
  };
  if (type != "dynamics")
    for (const char* key : {"duration", "step", "tolerance", "rho_inf", "order", "momentum_rate",
                            "min_step", "max_step", "smooth_multipliers"})
      refuse(key, "type dynamics");
  if (type == "dynamics") refuse("load_steps", "type statics or modes");
  if (type != "modes")
    for (const char* key : {"count", "about"}) refuse(key, "type modes");
}

}  // namespace

void read_analysis(ReadContext& context, const SourceNode& node, const SourceLocation& place) {
  AnalysisSpec& analysis = context.model.analysis;
  analysis.place = place;
  Section section(context, node, place, "analysis", analysis_fields());
  if (!node.is_map()) return;
  assign(analysis.type, section.choice("type"));
  assign(analysis.duration, section.number("duration"));
  read_step(context, section, analysis);
  analysis.tolerance = section.number("tolerance");
  assign(analysis.rho_inf, section.number("rho_inf"));
  if (const auto order = section.choice("order")) analysis.order = std::stoi(*order);
  assign(analysis.momentum_rate, section.choice("momentum_rate"));
  assign(analysis.solver, section.choice("solver"));
  assign(analysis.jacobian, section.choice("jacobian"));
  assign(analysis.isa, section.choice("isa"));
  assign(analysis.conserving, section.boolean("conserving"));
  assign(analysis.newton_tolerance, section.number("newton_tolerance"));
  if (const auto most = section.integer("max_iterations")) analysis.max_iterations = *most;
  if (const auto parts = section.integer("load_steps")) analysis.load_steps = *parts;
  assign(analysis.count, section.integer("count"));
  assign(analysis.about, section.choice("about"));
  assign(analysis.line_search, section.boolean("line_search"));
  assign(analysis.max_step_rotation, section.number("max_step_rotation"));
  assign(analysis.assembly_tolerance, section.number("assembly_tolerance"));
  analysis.min_step = section.number("min_step");
  analysis.max_step = section.number("max_step");
  assign(analysis.smooth_multipliers, section.boolean("smooth_multipliers"));
  assign(analysis.checkpoint_every, section.number("checkpoint_every"));

  check_type(section, analysis.type);
  if (analysis.step && analysis.tolerance)
    section.fault("tolerance",
                  "cannot be combined with a fixed step of " + shown(*analysis.step) + " s",
                  "A tolerance chooses the steps: leave 'step' out, write 'step: auto', or leave "
                  "out 'tolerance'.");
  if (analysis.order == 4 && !analysis.step)
    section.fault("order", "order 4 has no error estimate, so it cannot choose its steps",
                  "Give a step, or use order 2, 6 or 8.");
  if (analysis.order.value_or(2) > 2 && analysis.rho_inf < 1.0)
    section.fault("order",
                  format("order {} cannot be combined with rho_inf {}", *analysis.order,
                         shown(analysis.rho_inf)),
                  "Orders above 2 contain stages backward in time, where numerical damping would "
                  "add energy: use rho_inf 1 or order 2.");
  if (analysis.min_step && analysis.max_step && *analysis.min_step > *analysis.max_step)
    section.fault("min_step",
                  format("is above max_step: {} s > {} s", shown(*analysis.min_step),
                         shown(*analysis.max_step)),
                  "Give a smaller min_step.");
}

namespace {

const std::vector<std::string> kRecorded = {"body", "joint", "load",    "solid",
                                            "beam", "cable", "contact", "controller"};

}  // namespace

void read_output(ReadContext& context, const SourceNode& node, const SourceLocation& place) {
  OutputSpec& output = context.model.output;
  Section section(context, node, place, "output", output_fields());
  if (!node.is_map()) return;
  output.every = section.number("every");
  assign(output.hdf5, section.boolean("hdf5"));
  assign(output.csv, section.boolean("csv"));
  assign(output.paraview, section.boolean("paraview"));
  const SourceNode* probes = section.find("probes");
  if (!probes || probes->kind == SourceNode::Kind::kEmpty) return;
  if (!probes->is_map()) {
    context.fault(*probes, section.path("probes"),
                  "expects a map from names to probes, but is " + probes->description(),
                  "Write 'name: {body: ...}'.");
    return;
  }
  for (std::size_t k = 0; k < probes->keys.size(); ++k) {
    const SourceNode::Key& key = probes->keys[k];
    if (!check_name(context, key, probes->children[k], "output.probes")) continue;
    ProbeSpec probe;
    probe.name = key.name;
    probe.place = context.tree.place_of(key, probes->children[k]);
    Section columns(context, probes->children[k], probe.place, "output.probes." + probe.name,
                    probe_fields());
    if (probes->children[k].is_map() &&
        read_recorded(context, columns, kRecorded, "to record", probe))
      probe.every = columns.number("every");
    output.probes.push_back(std::move(probe));
  }
}

}  // namespace polhode
