// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/io/read/read_model.hpp>

namespace polhode::io {
namespace {

/// Rejects entries without meaning in an analysis of this type.
void check_type(Section& section, const std::string& type) {
  const auto refuse = [&](const char* key, const std::string& goes_with) {
    if (section.has(key))
      section.fault(key, "cannot be combined with type " + type, "It requires " + goes_with + ".");
  };
  if (type != "dynamics")
    for (const char* key : {"duration", "step", "tolerance", "rho_inf", "order", "method",
                            "momentum_rate", "min_step", "max_step", "smooth_multipliers"})
      refuse(key, "type dynamics");
  if (type == "dynamics") refuse("load_steps", "type statics or modes");
  if (type != "statics") refuse("history", "type statics");
  if (type != "modes")
    for (const char* key : {"count", "about", "spin", "spin_axis", "spin_through", "spin_ground"})
      refuse(key, "type modes");
}

/// Largest number of speeds of a range.
constexpr double kMostSpeeds = 10000.0;

/// Reads first:last:step, with one unit behind them or one each; the end is included to rounding.
std::optional<std::vector<double>> read_range(ReadContext& context, const SourceNode& node,
                                              const std::string& path, const Field& field) {
  std::vector<std::string> parts{""};
  for (const char c : node.text)
    if (c == ':')
      parts.emplace_back();
    else
      parts.back() += c;
  const auto refuse = [&](const std::string& what) {
    context.fault(node, path, what,
                  "Write first:last:step with a step that leads from first to last, such as "
                  "0:300:50 rad/s.");
    return std::nullopt;
  };
  if (parts.size() != 3)
    return refuse(format("expects three parts between colons, but {} has {}", quote(node.text),
                         parts.size()));
  // The unit behind the last number is that of all without one.
  const std::size_t unit = parts[2].find_first_not_of("0123456789.+-eE ");
  std::vector<double> values;
  for (std::size_t k = 0; k < 3; ++k) {
    SourceNode part = node;
    part.text = parts[k];
    if (k < 2 && unit != std::string::npos &&
        parts[k].find_first_not_of("0123456789.+-eE ") == std::string::npos)
      part.text += " " + parts[2].substr(unit);
    const auto value = read_number(context, part, path, field);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  const double count = (values[1] - values[0]) / values[2];
  if (!(count >= 0.0 && count < kMostSpeeds))
    return refuse(format("{} has no end, or more than {:g} speeds", quote(node.text), kMostSpeeds));
  std::vector<double> speeds;
  for (int k = 0; k <= static_cast<int>(count + 1e-9); ++k)
    speeds.push_back(values[0] + k * values[2]);
  return speeds;
}

void read_spin(ReadContext& context, Section& section, AnalysisSpec& analysis) {
  const SourceNode* node = section.find("spin");
  if (!node) {
    for (const char* key : {"spin_axis", "spin_through", "spin_ground"})
      if (section.has(key)) section.fault(key, "belongs to a spin", "Give the speed as spin.");
    return;
  }
  const bool range = node->is_text() && node->text.find(':') != std::string::npos;
  if (auto speeds =
          range ? read_range(context, *node, section.path("spin"), analysis_fields().at("spin"))
                : section.number_list("spin"))
    analysis.spin = std::move(*speeds);
}

/// Reads the duration: a time, or none for steps without an end.
void read_duration(Section& section, AnalysisSpec& analysis) {
  const SourceNode* node = section.find("duration");
  if (node && node->is_text() && node->text == "none") {
    analysis.duration = std::numeric_limits<double>::infinity();
    if (!analysis.step && analysis.type == "dynamics")
      section.fault("duration", "none requires a fixed step",
                    "Give a step: automatic steps share their tolerance over the duration.");
  } else if (const auto time = section.number("duration")) {
    analysis.duration = *time;
  }
}

}  // namespace

void read_analysis(ReadContext& context, const SourceNode& node, const SourceLocation& place) {
  AnalysisSpec& analysis = context.model.analysis;
  analysis.place = place;
  Section section(context, node, place, "analysis", analysis_fields());
  if (!node.is_map()) return;
  section.read_into(analysis, {"spin", "duration"});
  read_duration(section, analysis);
  read_spin(context, section, analysis);
  check_type(section, analysis.type);
  if (analysis.step && analysis.tolerance)
    section.fault("tolerance",
                  "cannot be combined with a fixed step of " + shown(*analysis.step) + " s",
                  "A tolerance chooses the steps: leave 'step' out, write 'step: auto', or leave "
                  "out 'tolerance'.");
  const bool extrapolated = analysis.method == "extrapolation";
  if (analysis.order == 4 && !analysis.step && analysis.method == "composition")
    section.fault("order",
                  "a composition of order 4 has no error estimate, so it cannot choose its steps",
                  "Leave out method: composition, give a step, or use order 2, 6 or 8.");
  if (analysis.order.value_or(2) > 2 && analysis.rho_inf < 1.0 && !extrapolated)
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

/// The four entries are read by the table of an analysis, from a map of them alone.
void set_spin(const SpinText& text, AnalysisSpec& analysis) {
  if (text.empty()) return;
  std::string entries;
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) entries += format("{}{}: {}", entries.empty() ? "" : ", ", key, value);
  };
  add("spin", text.spin);
  add("spin_axis", text.axis);
  add("spin_through", text.through);
  add("spin_ground", text.ground);
  const SourceTree tree = SourceTree::parse("{" + entries + "}", "the spin asked for");
  Diagnostics diagnostics(tree.source());
  ReadContext context{.tree = tree, .diagnostics = diagnostics};
  Section section(context, tree.root(), {}, "analysis", analysis_fields());
  section.read_into(analysis, {"spin"});
  if (!text.spin.empty()) read_spin(context, section, analysis);
  diagnostics.throw_if_any();
  if (analysis.spin.empty())
    throw InputError("analysis.spin", "is missing, but its axis, point or ground is given",
                     "Give the speed of the spin");
}

namespace {

const std::vector<std::string> kRecorded = {"body",  "joint",   "load",       "solid",   "beam",
                                            "cable", "contact", "controller", "momentum"};

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
