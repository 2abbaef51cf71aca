// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

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
  if (type != "statics") refuse("history", "type statics");
  if (type != "modes")
    for (const char* key : {"count", "about"}) refuse(key, "type modes");
}

}  // namespace

void read_analysis(ReadContext& context, const SourceNode& node, const SourceLocation& place) {
  AnalysisSpec& analysis = context.model.analysis;
  analysis.place = place;
  Section section(context, node, place, "analysis", analysis_fields());
  if (!node.is_map()) return;
  section.read_into(analysis);
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
  section.read_into(output);
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

}  // namespace polhode::io
