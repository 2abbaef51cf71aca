// SPDX-License-Identifier: Apache-2.0
#include "run_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <polhode/core/format.hpp>
#include <polhode/core/version.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/results/summary_json.hpp>
#include <polhode/io/text/file_error.hpp>

#include "command.hpp"
#include "console.hpp"

namespace polhode::cli {

std::string end_name(int exit_code) {
  switch (exit_code) {
    case kOk:
    case kCheckFailed:  // finished, but not trusted
      return "finished";
    case kNotConverged:
      return "not_converged";
    case kLimit:
      return "limit";
    default:
      return "interrupted";
  }
}

io::Provenance provenance_of(const ModelArguments& model, const RunSummary& summary) {
  io::ExpandedModel source = io::expanded_model(model.file, model.overrides);
  return {.version = version(),
          .solver = summary.solver,
          .instruction_set = summary.instruction_set,
          .model_file = std::filesystem::path(model.file).filename().string(),
          .model_text = std::move(source.text),
          .overrides = std::move(source.overrides)};
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return format("{} {}", count, count == 1 ? one : many);
}

std::string summary_json(const RunSummary& s, int exit_code, const std::string& folder,
                         std::size_t frames) {
  return polhode::io::summary_json(
      s, {.end = end_name(exit_code), .exit_code = exit_code, .folder = folder, .frames = frames});
}

/// Adds rows about the quality of the stress in solids on their meshes.
void add_stress_rows(std::vector<std::vector<std::string>>& rows, const RunSummary& s) {
  for (const RunSummary::SolidStress& solid : s.solids)
    rows.push_back(
        {format("stress error, {}", solid.solid), format("{:.2g} %", 100.0 * solid.error),
         format("of the energy norm, estimated from jumps between elements; largest {:.2g} %",
                100.0 * solid.error_max)});
}

std::string statics_table(const RunSummary& s) {
  const StaticReport& r = *s.statics;
  std::vector<std::vector<std::string>> rows{
      r.history > 0.0 ? std::vector<std::string>{"time", format("{:.6g} s", r.load_factor),
                                                 format("of {:.6g} s", r.history)}
                      : std::vector<std::string>{"load carried", format("{:.6g}", r.load_factor),
                                                 "of the whole"},
      {"load steps", format("{}", s.steps), format("{} cut", s.rejected_steps)},
      {"Newton iterations", format("{}", r.iterations)},
      {"unbalanced force", format("{:.1e} N", r.residual),
       format("the largest force is {:.3g} N", r.force)},
      {"strain energy", format("{:.6g} J", s.strain_energy)},
      {"stable", r.unstable < 0 ? "not known"
                 : r.unstable == 0
                     ? "yes"
                     : format("no, in {}", counted(static_cast<std::size_t>(r.unstable),
                                                   "direction", "directions"))}};
  add_stress_rows(rows, s);
  rows.push_back({"wall time", seconds(s.wall_time_s)});
  rows.push_back({"solver", s.solver});
  std::string text = table(rows);
  for (const std::string& motion : r.free_motions) text += format("  Free motion: {}.\n", motion);
  for (const std::string& cable : r.slack)
    text += format("  {}. Shorten its free_length if it should be taut.\n", cable);
  if (r.relaxations > 0)
    text += "  An equilibrium was found by relaxation, as Newton's method did not converge.\n";
  for (const LimitPoint& p : r.limit_points)
    text += p.jump ? format(
                         "  Limit point at load factor {:.6g}, where {}: equilibria beyond it lie "
                         "on another branch, {:.2g} times the size of the model away. Compute the "
                         "motion between them with type: dynamics.\n",
                         p.load_factor, p.motion.empty() ? "it ends" : p.motion, p.distance)
                   : format("  Limit point or bifurcation at load factor {:.6g}: {} there.\n",
                            p.load_factor, p.motion.empty() ? "stability changes" : p.motion);
  return text;
}

/// Number of shapes and surfaces: "5 shapes", "5 shapes and 2 surfaces".
std::string parties_text(const RunSummary::Contacts& c) {
  std::string surfaces = counted(static_cast<std::size_t>(c.surfaces), "surface", "surfaces");
  if (c.shapes == 0) return surfaces;
  return format("{} shapes", c.shapes) + (c.surfaces > 0 ? " and " + surfaces : "");
}

std::string summary_table(const RunSummary& s, bool colour) {
  const auto small = [](double x) { return format("{:.1e}", x); };
  const double steps = static_cast<double>(std::max<std::int64_t>(s.steps, 1));
  std::vector<std::vector<std::string>> rows{
      {"time reached", format("{:.6g} s", s.t)},
      {"steps", format("{}", s.steps), format("{} rejected, {}", s.rejected_steps, s.scheme)},
      {"Newton iterations", format("{}", s.newton_iterations),
       format("{:.2f} a step", static_cast<double>(s.newton_iterations) / steps)},
      {"energy drift", small(s.energy_drift),
       s.trusted() ? "of the largest energy"
                   : "of the largest energy; not trusted, see the warnings"},
      {"linear momentum drift", small(s.linear_momentum_drift), "of the largest momentum"},
      {"angular momentum drift", small(s.angular_momentum_drift), "of the largest"},
      {"constraint residual", small(s.constraint_residual_max), "largest of the run"},
      {"velocity constraint residual", small(s.velocity_constraint_residual_max),
       "largest of the run"},
  };
  if (s.errors) {
    const RunSummary::Errors& e = *s.errors;
    rows.push_back(
        {"error of a step", small(e.largest),
         format(
             "largest, {}in the step to t = {:.6g} s; estimate, relative to the size or in radians",
             e.whose.empty() ? "" : e.whose + " ", e.time)});
    rows.push_back(
        {"  of all steps", small(e.sum),
         e.steps == s.steps ? "their sum" : format("sum of the {} with an estimate", e.steps)});
  }
  add_stress_rows(rows, s);
  if (s.contacts) {
    const RunSummary::Contacts& c = *s.contacts;
    rows.push_back(
        {"contact", counted(static_cast<std::size_t>(c.touching), "pair", "pairs"),
         "touch now, of " + parties_text(c) +
             (std::isfinite(c.least_gap) ? format("; smallest gap of the run {:.2e} m", c.least_gap)
                                         : "")});
    rows.push_back({"  lost in impacts", format("{:.6g} J", c.lost_in_impacts)});
    rows.push_back({"  lost by friction", format("{:.6g} J", c.lost_by_friction)});
    rows.push_back({"  numerical", format("{:.1e} J", c.numerical),
                    "remainder of the energy balance at the end"});
    if (c.sweeps)
      rows.push_back({"  sweeps", format("{:.1f} a step", c.sweeps->first),
                      format("{} of the steps ended above sweep_tolerance", c.sweeps->second)});
  }
  for (const RunSummary::Event& e : s.events) {
    if (e.count == 0) {
      rows.push_back({"event " + e.name, "did not occur"});
      continue;
    }
    std::string more = e.count > 1 ? format("the last of {}", e.count) : "";
    if (e.lost > 0.0 || e.impulse > 0.0)
      more += format("{}lost {:.6g} J, largest impulse {:.6g}", more.empty() ? "" : "; ", e.lost,
                     e.impulse);
    rows.push_back({"event " + e.name, format("{:.9g} s", e.time), more});
  }
  rows.push_back({"time", seconds(s.wall_time_s),
                  format("{} of one processor, {} a step", seconds(s.cpu_time_s),
                         seconds(s.cpu_time_s / steps))});
  for (const auto& [name, value] : s.phases) rows.push_back({"  " + name, seconds(value)});
  rows.push_back({"solver", s.solver, s.instruction_set});
  rows.push_back({"result hash", s.result_hash.substr(0, 16)});
  const std::string text = table(rows);
  if (!colour || s.energy_drift <= kBadDrift) return text;
  const std::size_t begin = text.find("energy drift"), end = text.find('\n', begin);
  return text.substr(0, begin) + "\033[31m" + text.substr(begin, end - begin) + "\033[0m" +
         text.substr(end);
}

}  // namespace polhode::cli
