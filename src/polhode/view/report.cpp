// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/report.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/core/xml_text.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/view/chunk.hpp>
#include <polhode/view/scene_parts.hpp>

namespace polhode {

namespace {

/// Most curves of a panel, see panels_svg().
constexpr std::size_t kMostCurves = 8;

/// A table of a report: a title, a heading, and rows of as many cells.
struct Table {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// A report before it is written as a page or as Markdown.
struct Draft {
  std::string title, verdict, model;
  bool trusted = true;
  std::vector<std::string> reasons, warnings;
  std::vector<Table> tables;
  std::vector<std::pair<std::string, std::string>> plots;  ///< Names and SVG pictures.
};

/// Numbers below are noise of sums that vanish [-].
constexpr double kNoise = 1e-30;

std::string number(double value) {
  return !std::isfinite(value) ? "-" : format("{:.5g}", std::abs(value) < kNoise ? 0.0 : value);
}

/// Whether a column holds impulses of which there were none.
bool without_impulse(const ChannelColumn& column) {
  return column.name.find("impulse") != std::string::npos &&
         std::all_of(column.values.begin(), column.values.end(), [](double v) { return v == 0.0; });
}

std::vector<std::string> row_of(const std::vector<double>& t, const ChannelColumn& column) {
  const Extremes e = extremes_of(t, column.values);
  return {column.name,          column.unit,        number(e.least),
          number(e.least_time), number(e.greatest), number(e.greatest_time),
          number(e.mean),       number(e.rms)};
}

Table extremes_table(const std::string& title, const std::string& time_label) {
  const std::string at = "at " + time_label;
  return {title, {"quantity", "unit", "minimum", at, "maximum", at, "mean", "RMS"}, {}};
}

/// Columns of one unit each, at most kMostCurves.
std::vector<CurvePanel> panels_of(const ReportTable& probe) {
  std::vector<CurvePanel> panels;
  for (const ChannelColumn& column : probe.columns) {
    if (panels.empty() || panels.back().columns.back().unit != column.unit ||
        panels.back().columns.size() == kMostCurves)
      panels.push_back({probe.name, probe.t, {}});
    panels.back().columns.push_back(column);
  }
  return panels;
}

/// Number of the last frame; NaN if there is none.
double last_of(const io::ResultsReader& results, const char* path) {
  if (!results.has(path) || results.frames() == 0) return std::numeric_limits<double>::quiet_NaN();
  return results.read(path).back();
}

Table ledger_of(const io::ResultsReader& results, const ReportRequest& request) {
  const std::string group = io::results::kProvenance;
  const std::vector<double> t = results.read(io::results::kTime);
  Table table{"Run", {"", ""}, {}};
  const auto row = [&](const char* name, std::string value) {
    table.rows.push_back({name, std::move(value)});
  };
  if (!t.empty()) row(request.time_label.c_str(), format("{:.6g} to {:.6g}", t.front(), t.back()));
  row("frames", format("{}", t.size()));
  for (const auto& [name, path] :
       {std::pair("steps", "/solver/steps"), std::pair("rejected steps", "/solver/rejected"),
        std::pair("Newton iterations", "/solver/iterations")})
    row(name, format("{:.0f}", last_of(results, path)));
  row("energy drift", format("{:.1e} of the largest energy", last_of(results, "/energy/drift")));
  row("energy dissipated [J]", number(last_of(results, "/energy/dissipated")));
  row("energy put in [J]", number(last_of(results, "/energy/put_in")));
  row("solver", results.attribute(group, "solver"));
  row("instruction set", results.attribute(group, "instruction_set"));
  row("Polhode", results.attribute(group, "version"));
  row("model file", results.attribute(group, "model_file"));
  std::string overrides = results.attribute(group, "overrides");
  std::replace(overrides.begin(), overrides.end(), '\n', ' ');
  if (!overrides.empty()) row("changed by --set", overrides);
  return table;
}

Draft draft_of(const io::ResultsReader& results, const ReportRequest& request) {
  const std::string group = io::results::kProvenance;
  Draft draft;
  draft.title = results.attribute("/", "title");
  if (draft.title.empty()) draft.title = results.attribute(group, "model_file");
  draft.reasons = lines_of(results.attribute(group, "distrust"));
  // Reasons not to trust the run are among its warnings, with a word before them.
  for (std::string& warning : lines_of(results.attribute(group, "warnings")))
    if (std::none_of(draft.reasons.begin(), draft.reasons.end(),
                     [&](const std::string& reason) { return warning.ends_with(reason); }))
      draft.warnings.push_back(std::move(warning));
  const std::string trusted = results.attribute(group, "trusted");
  draft.trusted = trusted == "yes";
  draft.verdict =
      draft.trusted ? "Trusted: no balance and no constraint is off by more than the method allows."
      : trusted == "no" ? "Not trusted:"
                        : "Not judged: the run has not ended.";
  const std::vector<std::string> text = results.names(group + "/model");
  if (!text.empty()) draft.model = text.front();
  draft.tables.push_back(ledger_of(results, request));

  Table probes = extremes_table("Probes", request.time_label);
  for (const ReportTable& probe : request.probes) {
    for (ChannelColumn& column : with_sizes(probe.columns)) {
      if (without_impulse(column)) continue;
      column.name = probe.name + "." + column.name;
      probes.rows.push_back(row_of(probe.t, column));
    }
    const std::vector<CurvePanel> panels = panels_of(probe);
    if (!panels.empty())
      draft.plots.emplace_back(probe.name, panels_svg(panels, request.time_label));
  }
  if (!probes.rows.empty()) draft.tables.push_back(std::move(probes));

  const std::vector<double> t = results.read(io::results::kTime);
  const std::vector<std::pair<const char*, const char*>> parts = {
      {"joints.", "Joints"}, {"loads.", "Loads"}, {"contacts.", "Contacts"}, {"energy.", "Energy"}};
  const std::vector<ChannelColumn> columns = with_sizes(all_columns(results));
  for (const auto& [head, title] : parts) {
    Table table = extremes_table(title, request.time_label);
    for (const ChannelColumn& column : columns)
      if (column.name.starts_with(head) && !without_impulse(column))
        table.rows.push_back(row_of(t, column));
    if (!table.rows.empty()) draft.tables.push_back(std::move(table));
  }
  CurvePanel energy{"energy", t, {}};
  for (const char* name : {"kinetic", "potential", "total"})
    for (const ChannelColumn& column : columns)
      if (column.name == std::string("energy.") + name) energy.columns.push_back(column);
  if (!energy.columns.empty())
    draft.plots.emplace_back("energy", panels_svg({energy}, request.time_label));
  return draft;
}

constexpr const char* kStyle = R"(
body { font: 15px/1.45 system-ui, sans-serif; color: #1c2126; background: #fff; max-width: 1000px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; } h2 { font-size: 1.2em; margin-top: 1.8em; }
table { border-collapse: collapse; font-size: 0.9em; } .wide { overflow-x: auto; }
th, td { text-align: left; padding: 0.2em 0.9em 0.2em 0; border-bottom: 1px solid #e3e6e9; white-space: nowrap; }
td.n { font-variant-numeric: tabular-nums; text-align: right; } th.n { text-align: right; }
.yes { color: #1d6b3a; } .no { color: #b3261e; font-weight: 600; }
img, svg { max-width: 100%; height: auto; } pre { background: #f5f6f7; padding: 0.8em; overflow-x: auto; }
@media print { body { margin: 0; max-width: none; } table, svg { break-inside: avoid; } }
)";

std::string html_of(const Table& table) {
  std::string out = format("<h2>{}</h2>\n<div class=\"wide\"><table>\n", xml_text(table.title));
  const bool heading = !table.head.front().empty();
  const auto number_class = [&](std::size_t k) { return heading && k >= 2 ? " class=\"n\"" : ""; };
  if (heading) {
    out += "<tr>";
    for (std::size_t k = 0; k < table.head.size(); ++k)
      out += format("<th{}>{}</th>", number_class(k), xml_text(table.head[k]));
    out += "</tr>\n";
  }
  for (const std::vector<std::string>& row : table.rows) {
    out += "<tr>";
    for (std::size_t k = 0; k < row.size(); ++k)
      out += format("<td{}>{}</td>", number_class(k), xml_text(row[k]));
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

/// Text of a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|' || c == '*' || c == '_' || c == '<' || c == '\\') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string markdown_of(const Table& table) {
  std::string out = format("## {}\n\n", table.title);
  const auto line = [&](const std::vector<std::string>& cells) {
    out += "|";
    for (const std::string& text : cells) out += " " + cell(text) + " |";
    out += "\n";
  };
  line(table.head);
  out += "|";
  for (std::size_t k = 0; k < table.head.size(); ++k) out += k < 2 ? " --- |" : " ---: |";
  out += "\n";
  for (const std::vector<std::string>& row : table.rows) line(row);
  return out + "\n";
}

}  // namespace

Extremes extremes_of(const std::vector<double>& t, const std::vector<double>& values) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Extremes e{kNone, kNone, kNone, kNone, kNone, kNone};
  double length = 0.0, sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  const std::size_t size = std::min(t.size(), values.size());
  for (std::size_t k = 0; k < size; ++k) {
    const double v = values[k];
    if (!std::isfinite(v)) continue;
    ++count;
    if (!(v >= e.least)) e.least = v, e.least_time = t[k];
    if (!(v <= e.greatest)) e.greatest = v, e.greatest_time = t[k];
    if (k == 0 || !std::isfinite(values[k - 1])) continue;
    const double dt = t[k] - t[k - 1], before = values[k - 1];
    length += dt;
    sum += 0.5 * dt * (before + v);
    squares += dt * (before * before + before * v + v * v) / 3.0;
  }
  if (count == 0) return e;
  e.mean = length > 0.0 ? sum / length : e.least;
  e.rms = length > 0.0 ? std::sqrt(squares / length) : std::abs(e.least);
  return e;
}

std::string report_page(const io::ResultsReader& results, const ReportRequest& request) {
  const Draft draft = draft_of(results, request);
  std::string out = format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}</title>\n<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n",
      xml_text(draft.title), kStyle);
  out += format("<p class=\"{}\">{}</p>\n", draft.trusted ? "yes" : "no", xml_text(draft.verdict));
  const auto list = [&](const std::vector<std::string>& entries) {
    if (entries.empty()) return;
    out += "<ul>\n";
    for (const std::string& entry : entries) out += format("<li>{}</li>\n", xml_text(entry));
    out += "</ul>\n";
  };
  list(draft.reasons);
  if (!draft.warnings.empty()) out += "<p>Warnings:</p>\n";
  list(draft.warnings);
  if (!request.picture.empty())
    out += format("<img alt=\"The model at its start\" src=\"data:image/png;base64,{}\">\n",
                  base64(request.picture));
  for (const Table& table : draft.tables) {
    out += html_of(table);
    if (&table != &draft.tables.front()) continue;
    out += "<h2>Plots</h2>\n";
    for (const auto& [name, svg] : draft.plots) {
      const std::size_t begin = svg.find("<svg");
      out += "<figure>\n" + svg.substr(begin == std::string::npos ? 0 : begin) + "\n</figure>\n";
    }
  }
  out += "<h2>Model</h2>\n<details><summary>Text of the model file</summary>\n<pre>" +
         xml_text(draft.model) + "</pre></details>\n</body>\n</html>\n";
  return out;
}

MarkdownReport report_markdown(const io::ResultsReader& results, const ReportRequest& request,
                               const std::string& folder) {
  const Draft draft = draft_of(results, request);
  MarkdownReport report;
  std::string& out = report.text;
  out = format("# {}\n\n{}\n", cell(draft.title), draft.verdict);
  for (const std::string& reason : draft.reasons) out += format("\n* {}", cell(reason));
  out += "\n";
  if (!draft.warnings.empty()) out += "\nWarnings:\n";
  for (const std::string& warning : draft.warnings) out += format("\n* {}", cell(warning));
  if (!draft.warnings.empty()) out += "\n";
  out += "\n";
  const auto picture = [&](const std::string& name, const std::string& file, std::string bytes) {
    out += format("![{}]({}/{})\n\n", cell(name), folder, file);
    report.pictures[file] = std::move(bytes);
  };
  if (!request.picture.empty()) picture("The model at its start", "model.png", request.picture);
  for (const Table& table : draft.tables) {
    out += markdown_of(table);
    if (&table != &draft.tables.front()) continue;
    out += "## Plots\n\n";
    for (const auto& [name, svg] : draft.plots) picture(name, name + ".svg", svg);
  }
  std::string fence = "```";
  while (draft.model.find(fence) != std::string::npos) fence += "`";
  out += format("## Model\n\n{0}yaml\n{1}{2}{0}\n", fence, draft.model,
                draft.model.ends_with('\n') ? "" : "\n");
  return report;
}

}  // namespace polhode
