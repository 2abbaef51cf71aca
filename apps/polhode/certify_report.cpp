// SPDX-License-Identifier: Apache-2.0
#include "certify_report.hpp"

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/results/csv_probes.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/study/certificate_picture.hpp>

#include "command.hpp"
#include "console.hpp"
#include "run_report.hpp"
#include "stop_signal.hpp"

namespace polhode::cli {

namespace {

using Json = nlohmann::ordered_json;

/// Number of times with orders and bars in certificate.json; tables have all.
constexpr std::size_t kToldTimes = 20;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json row_of(const Mat& m, Eigen::Index row) {
  Json list = Json::array();
  for (const double x : m.row(row)) list.push_back(number(x));
  return list;
}

/// Text of a setting: "1.25 ms", or "1e-08" for a tolerance.
std::string setting(const Certificate& c, std::size_t run) {
  return c.automatic ? format("{:.3g}", c.runs[run].setting) : seconds(c.runs[run].setting);
}

Json run_json(const Certificate& c, const CertifiedRun& run) {
  const RunSummary& s = run.summary;
  const int code = s.end == RunEnd::finished        ? kOk
                   : s.end == RunEnd::not_converged ? kNotConverged
                                                    : kInterrupted;
  return {{c.automatic ? "tolerance" : "step", run.setting},
          {"end", end_name(code)},
          {"message", s.message},
          {"t", s.t},
          {"steps", s.steps},
          {"rejected_steps", s.rejected_steps},
          {"energy_drift", s.energy_drift},
          {"distrust", s.distrust},
          {"wall_time_s", s.wall_time_s},
          {"cpu_time_s", s.cpu_time_s},
          {"result_hash", s.result_hash}};
}

Json quantity_json(const CertifiedQuantity& q) {
  const ConvergenceReport& r = q.report;
  const Eigen::Index last = q.series.values[2].rows() - 1;
  const std::optional<double> unresolved = q.unresolved_at();
  Json times = Json::array(), bars = Json::array(), orders = Json::array();
  const std::size_t n = q.series.t.size();
  for (std::size_t k = 1; k <= std::min(kToldTimes, n); ++k) {
    const std::size_t i = k * n / std::min(kToldTimes, n) - 1;
    times.push_back(q.series.t[i]);
    bars.push_back(number(r.bar[i]));
    orders.push_back(number(r.order_at[i]));
  }
  return {{"probe", q.probe},
          {"columns", q.columns},
          {"unit", q.unit},
          {"size", q.scale},
          {"order", r.order ? number(*r.order) : Json(nullptr)},
          {"as_expected", r.as_expected},
          {"rounding_only", r.noise},
          {"converges", !r.lost_from.has_value()},
          {"lost_from", r.lost_from ? Json(*r.lost_from) : Json(nullptr)},
          {"unresolved_at", unresolved ? Json(*unresolved) : Json(nullptr)},
          {"error_bar", r.largest_bar},
          {"own_error", r.largest_own},
          {"at_end",
           {{"t", q.series.t.back()},
            {"value", row_of(q.series.values[2], last)},
            {"extrapolated", row_of(r.extrapolated, last)},
            {"error_bar", number(r.bar.back())}}},
          {"in_time", {{"t", times}, {"error_bar", bars}, {"order", orders}}}};
}

/// Writes a table of a quantity over time: values of the finest run, extrapolated ones, bar, order.
void write_table(const std::string& path, const CertifiedQuantity& q) {
  std::vector<std::string> header{"t [s]"};
  for (const char* what : {"", " extrapolated"})
    for (const std::string& column : q.columns)
      header.push_back(format("{}{} [{}]", column, what, q.unit));
  header.push_back(format("error bar [{}]", q.unit));
  header.emplace_back("order [-]");
  io::CsvTable table(path, header);
  for (std::size_t i = 0; i < q.series.t.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    std::vector<double> cells{q.series.t[i]};
    for (const Mat* m : {&q.series.values[2], &q.report.extrapolated})
      for (const double x : m->row(row)) cells.push_back(x);
    cells.insert(cells.end(), {q.report.bar[i], q.report.order_at[i]});
    table.append(cells);
  }
  table.flush();
}

/// File name of a table: "tip_x_y_z.csv".
std::string table_name(const CertifiedQuantity& q) {
  std::string name = q.name();
  std::replace(name.begin(), name.end(), ' ', '_');
  return name + ".csv";
}

/// Quantities with a bar of more than that part of their size, or that do not converge.
std::vector<std::string> too_wide(const Certificate& c, double within) {
  std::vector<std::string> names;
  for (const CertifiedQuantity& q : c.quantities)
    if (q.report.lost_from || q.report.largest_bar > within * q.scale + q.negligible)
      names.push_back(q.name());
  return names;
}

int exit_code(const Certificate& c, const CertifyRequest& request, bool limit_reached) {
  for (const CertifiedRun& run : c.runs) {
    if (run.summary.end == RunEnd::not_converged) return kNotConverged;
    if (run.summary.end == RunEnd::interrupted) return limit_reached ? kLimit : kInterrupted;
  }
  if (!c.converges() || !c.trusted()) return kCheckFailed;
  return request.within && !too_wide(c, *request.within).empty() ? kCheckFailed : kOk;
}

void tell(const Certificate& c, const CertifyRequest& request, int code) {
  for (const CertifiedRun& run : c.runs)
    if (run.summary.end == RunEnd::not_converged) say(run.summary.message);
  for (std::size_t k = 0; k < c.runs.size(); ++k)
    for (const std::string& reason : c.runs[k].summary.distrust)
      say(format("warning: nothing is certified, as run {} is not trusted: {}", k + 1, reason));
  for (const CertifiedQuantity& q : c.quantities)
    if (q.report.lost_from)
      say(
          format("warning: '{}' does not converge from t = {:.4g} s on: no number after that is "
                 "certain. Take a shorter step, or trust its statistics only.",
                 q.name(), *q.report.lost_from));
  if (code == kCheckFailed && request.within)
    for (const std::string& name : too_wide(c, *request.within))
      say(
          format("warning: the error bar of '{}' is more than {:g} of its size. Take a shorter "
                 "step or a smaller tolerance.",
                 name, *request.within));
  if (code == kLimit) say("Stopped at the wall-time limit; nothing is certified.");
  if (code == kInterrupted) say("Stopped; nothing is certified.");
}

Json certificate_json(const Certificate& c, int code, const std::string& folder) {
  Json runs = Json::array(), quantities = Json::array();
  for (const CertifiedRun& run : c.runs)
    if (run.setting > 0.0) runs.push_back(run_json(c, run));
  for (const CertifiedQuantity& q : c.quantities) quantities.push_back(quantity_json(q));
  return {{"exit_code", code},      {"converges", c.converges()},
          {"trusted", c.trusted()}, {"refines", c.automatic ? "tolerance" : "step"},
          {"orders", c.orders},     {"notes", c.notes},
          {"runs", runs},           {"quantities", quantities},
          {"results", folder},      {"version", version()}};
}

void write_files(const Certificate& c, const std::string& folder, const Json& json) {
  io::make_folder(folder);
  io::write_file_atomically(folder + "/certificate.svg", certificate_svg(c));
  io::write_file_atomically(folder + "/certificate.json", json.dump(2) + "\n");
  io::make_folder(folder + "/certificate");
  for (const CertifiedQuantity& q : c.quantities)
    write_table(folder + "/certificate/" + table_name(q), q);
}

/// Text of values: "0.5, -1.25, 0".
std::string values_text(const Mat& m, Eigen::Index row) {
  std::string text;
  for (const double x : m.row(row)) text += format("{}{:.7g}", text.empty() ? "" : ", ", x);
  return text;
}

}  // namespace

CertifyOutcome certify_model(const Model& model, const CertifyRequest& request) {
  const double start = wall_clock();
  bool limit_reached = false;
  catch_stop_signals();
  Progress progress(!request.quiet, model.analysis.duration);
  CertifyHooks hooks;
  hooks.stop = &stop_wanted;
  hooks.begin = [&](int run, Simulation& s) {
    progress.clear();
    if (!request.quiet) {
      const AnalysisSpec& a = s.model().analysis;
      say(a.step ? format("Run {} of 3: step {}.", run + 1, seconds(*a.step))
                 : format("Run {} of 3: tolerance {:.3g}.", run + 1, *a.tolerance));
    }
    if (run == 2 && request.begin) request.begin(s);
  };
  hooks.frame = [&](int run, Simulation& s) {
    if (run == 2 && request.frame) request.frame(s);
  };
  hooks.end = [&](int run, Simulation& s) {
    if (run == 2 && request.end) request.end(s);
  };
  hooks.step = [&](int run, Simulation& s) {
    if (run == 2 && request.step) request.step(s);
    progress.show(s);
    if (request.wall_limit && wall_clock() - start >= *request.wall_limit) {
      limit_reached = true;
      stop_wanted = true;
    }
  };
  CertifyOutcome outcome;
  outcome.certificate = certify(model, hooks);
  progress.clear();
  const Certificate& c = outcome.certificate;
  outcome.exit_code = exit_code(c, request, limit_reached);
  outcome.json = certificate_json(c, outcome.exit_code, request.folder);
  if (!c.quantities.empty()) write_files(c, request.folder, outcome.json);
  if (!request.quiet)
    for (const std::string& note : c.notes) say(note);
  tell(c, request, outcome.exit_code);
  return outcome;
}

std::string with_certificate(const std::string& summary, const CertifyOutcome& outcome) {
  Json json = Json::parse(summary);
  json["exit_code"] = outcome.exit_code;
  json["certificate"] = outcome.json;
  return json.dump(2);
}

std::string certificate_table(const Certificate& c) {
  std::vector<std::vector<std::string>> runs, rows;
  for (std::size_t k = 0; k < 3; ++k)
    runs.push_back({c.automatic ? "tolerance" : "step", setting(c, k),
                    counted(static_cast<std::size_t>(c.runs[k].summary.steps), "step", "steps"),
                    seconds(c.runs[k].summary.wall_time_s)});
  rows.push_back({"quantity", "order", "error bar", "of the model's own step",
                  "extrapolated, at the end", ""});
  for (const CertifiedQuantity& q : c.quantities) {
    const ConvergenceReport& r = q.report;
    const bool some = !r.lost_from || *r.lost_from > q.series.t.front();
    rows.push_back({format("{} [{}]", q.name(), q.unit),
                    q.order_text() + (r.order && !r.as_expected ? " !" : ""),
                    some ? format("{:.1e}", r.largest_bar) : "none",
                    some ? format("{:.1e}", r.largest_own) : "none",
                    r.lost_from ? "-" : values_text(r.extrapolated, r.extrapolated.rows() - 1),
                    r.lost_from ? format("does not converge from {:.4g} s on", *r.lost_from)
                    : q.unresolved_at()
                        ? format("error bar as large as the value at {:.4g} s", *q.unresolved_at())
                        : ""});
  }
  std::string orders;
  for (const double order : c.orders)
    orders += format("{}{:g}", orders.empty() ? "" : " or ", order);
  return table(runs) + "\n" + table(rows, "  ", false) +
         format("\n  {}: the largest over the time that converges. Order of the method: {}{}.\n",
                "Error bars", orders,
                std::any_of(c.quantities.begin(), c.quantities.end(),
                            [](const auto& q) { return q.report.order && !q.report.as_expected; })
                    ? "; '!': the observed order differs, so the bar is wider"
                    : "");
}

}  // namespace polhode::cli
