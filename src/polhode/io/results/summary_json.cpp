// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/summary_json.hpp>

#include <cmath>

#include <nlohmann/json.hpp>

namespace polhode::io {

std::string summary_json(const RunSummary& s, const RunPlace& place) {
  nlohmann::ordered_json phases = nlohmann::ordered_json::object();
  for (const auto& [name, value] : s.phases) phases[name] = value;
  nlohmann::ordered_json json = {
      {"end", place.end},
      {"exit_code", place.exit_code},
      {"message", s.message},
      {"t", s.t},
      {"steps", s.steps},
      {"rejected_steps", s.rejected_steps},
      {"newton_iterations", s.newton_iterations},
      {"trusted", s.trusted()},
      {"distrust", s.distrust},
      {"energy_drift", s.energy_drift},
      {"linear_momentum_drift", s.linear_momentum_drift},
      {"angular_momentum_drift", s.angular_momentum_drift},
      {"constraint_residual_max", s.constraint_residual_max},
      {"velocity_constraint_residual_max", s.velocity_constraint_residual_max},
      {"step_error", s.errors ? nlohmann::ordered_json{{"largest", s.errors->largest},
                                                       {"time", s.errors->time},
                                                       {"whose", s.errors->whose},
                                                       {"sum", s.errors->sum},
                                                       {"steps", s.errors->steps}}
                              : nlohmann::ordered_json(nullptr)},
      {"wall_time_s", s.wall_time_s},
      {"cpu_time_s", s.cpu_time_s},
      {"phases", phases},
      {"result_hash", s.result_hash},
      {"order", s.order},
      {"scheme", s.scheme},
      {"solver", s.solver},
      {"instruction_set", s.instruction_set},
      {"version", s.version},
      {"narration", s.narration},
      {"warnings", s.warnings},
      {"results", place.folder},
      {"frames", place.frames},
  };
  if (s.statics) {
    json["load_factor"] = s.statics->load_factor;
    json["strain_energy"] = s.strain_energy;
    json["residual"] = s.statics->residual;
    json["largest_force"] = s.statics->force;
    json["unstable_directions"] = s.statics->unstable;
    json["free_motions"] = s.statics->free_motions;
    json["limit_points"] = nlohmann::ordered_json::array();
    for (const LimitPoint& p : s.statics->limit_points)
      json["limit_points"].push_back({{"load_factor", p.load_factor},
                                      {"unstable_directions", p.unstable},
                                      {"motion", p.motion},
                                      {"jump", p.jump},
                                      {"distance", p.distance}});
    json["slack"] = s.statics->slack;
    json["relaxed"] = s.statics->relaxations > 0;
  }
  if (!s.events.empty()) {
    json["events"] = nlohmann::ordered_json::array();
    for (const RunSummary::Event& e : s.events)
      json["events"].push_back(
          {{"event", e.name},
           {"count", e.count},
           {"time", e.count > 0 ? nlohmann::ordered_json(e.time) : nlohmann::ordered_json(nullptr)},
           {"lost", e.lost},
           {"impulse", e.impulse}});
  }
  if (!s.solids.empty()) {
    json["solids"] = nlohmann::ordered_json::array();
    for (const RunSummary::SolidStress& solid : s.solids)
      json["solids"].push_back({{"solid", solid.solid},
                                {"stress_error", solid.error},
                                {"stress_error_max", solid.error_max},
                                {"stress_error_max_at", solid.t_max}});
  }
  if (s.contacts) {
    const RunSummary::Contacts& c = *s.contacts;
    json["contacts"] = {
        {"shapes", c.shapes},
        {"surfaces", c.surfaces},
        {"touching", c.touching},
        {"least_gap", std::isfinite(c.least_gap) ? nlohmann::ordered_json(c.least_gap)
                                                 : nlohmann::ordered_json(nullptr)},
        {"lost_in_impacts", c.lost_in_impacts},
        {"lost_by_friction", c.lost_by_friction},
        {"numerical", c.numerical}};
    if (c.sweeps) {
      json["contacts"]["sweeps_a_step"] = c.sweeps->first;
      json["contacts"]["unconverged_steps"] = c.sweeps->second;
    }
  }
  return json.dump(2);
}

}  // namespace polhode::io
