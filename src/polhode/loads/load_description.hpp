// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/assembly/free_coordinate.hpp>
#include <polhode/assembly/system.hpp>
#include <polhode/base/time_function.hpp>

namespace polhode {

/// A load with its bodies numbered: what a kind of load is built from.
struct LoadDescription {
  std::string name;
  Participants bodies;                             ///< Single-body loads act on b.
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();     ///< Points from the centres of mass [m].
  bool body_fixed = false;                         ///< Components turn with the body.
  TimeVector vector{};                             ///< Force [N] or moment [N m]; empty is zero.
  std::map<std::string, double> values{};          ///< Parameters by name, SI.
  std::optional<FreeAngle> angle{};                ///< Of the joint that the load acts in.
  std::optional<FreeDisplacement> displacement{};  ///< Likewise.
  TimeFunctionPtr function{};                      ///< Of a motor.
  std::string drive{};                             ///< What that is: key of LoadKind::drives.
  double start_length = 0.0;                       ///< Distance of the points at the start [m].

  [[nodiscard]] double value(const std::string& key, double otherwise) const {
    const auto found = values.find(key);
    return found == values.end() ? otherwise : found->second;
  }
};

/// The vector at time t; components left empty are zero.
[[nodiscard]] inline Vec3 evaluate(const TimeVector& f, double t) {
  Vec3 v = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (const auto& component = f[static_cast<std::size_t>(i)]) v[i] = (*component)(t);
  return v;
}

/// The vector over a step: at t_{n+αf}, times the load factor of statics.
[[nodiscard]] inline Vec3 evaluate(const TimeVector& f, const StepContext& step) {
  return step.load_factor * evaluate(f, step.t_alpha());
}

/// A vector and numbers in one list: what loads report.
[[nodiscard]] inline std::vector<double> numbers(const Vec3& v,
                                                 std::initializer_list<double> more = {}) {
  std::vector<double> list(v.data(), v.data() + 3);
  list.insert(list.end(), more);
  return list;
}

[[nodiscard]] inline bool is_constant(const TimeVector& f) {
  for (const TimeFunctionPtr& component : f)
    if (component && !component->is_constant()) return false;
  return true;
}

}  // namespace polhode
