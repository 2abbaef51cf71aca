// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/loads/load_function.hpp>
#include <polhode/system/free_coordinate.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// A coordinate of a gear: that of a joint, or the angle of one wheel relative to the other.
struct GearCoordinate {
  enum class Kind {
    angle,         ///< `angle`, between the bodies named.
    displacement,  ///< `displacement`, likewise.
    centres,       ///< Angle of the wheel relative to the line of centres.
    axes           ///< Angle of the wheel relative to the other wheel's axis.
  };
  Kind kind = Kind::angle;
  int from = 0, to = 0;  ///< Its bodies: 0 the ground, 1 the gear's a, 2 its b.
  FreeAngle angle{};
  FreeDisplacement displacement{};
};

/// Ratio of a gear: x_0 = ratio·x_1 + constant.
struct GearPair {
  std::array<GearCoordinate, 2> coordinate;
};

/// A coordinate of a row between free coordinates of joints.
struct CoupledCoordinate {
  std::variant<FreeAngle, FreeDisplacement> coordinate;
  Participants bodies;  ///< Of its joint.
  double factor = 1.0;  ///< f in Σ f q = c.
  double near = 0.0;    ///< Its value in the model's start, turns counted.
};

/// Input for building any kind of load: a load with its bodies numbered.
struct LoadDescription {
  std::string name;
  Participants bodies;                             ///< Single-body loads act on b.
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();     ///< Points from the centres of mass [m].
  bool body_fixed = false;                         ///< Components rotate with the body.
  TimeVector vector{};                             ///< Force [N] or moment [N m]; empty is zero.
  std::map<std::string, double> values{};          ///< Parameters by name, SI.
  std::optional<FreeAngle> angle{};                ///< Of the joint that the load acts in.
  std::optional<FreeDisplacement> displacement{};  ///< Likewise.
  TimeFunctionPtr function{};                      ///< Of a motor.
  /// Kind of that function: key of LoadKind::drives.
  std::string drive{};
  bool at_rest = false;       ///< Of statics and modes: no time passes between equilibria.
  double start_length = 0.0;  ///< Distance of the points at the start [m].
  std::map<std::string, TimeFunctionPtr> laws{};  ///< Functions of a coordinate or rate by key.
  std::map<std::string, std::string> words{};     ///< Choices by key.
  std::map<std::string, Mat6> matrices{};         ///< By key.
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();  ///< Axes of a bushing on its bodies.
  double mass_a = 0.0, mass_b = 0.0;                    ///< Of the bodies; 0 for the ground [kg].
  Mat3 inertia_b = Mat3::Zero();             ///< Of b about its centre of mass, body axes [kg m²].
  std::optional<GearPair> gear{};            ///< Of a gear.
  std::vector<CoupledCoordinate> coupled{};  ///< Of a row, the first with factor 1.
  LoadFunction of_motion{};  ///< From code, in addition to vector or function; world axes.

  /// The free coordinate of the joint that the load acts in.
  [[nodiscard]] std::variant<FreeAngle, FreeDisplacement> coordinate() const {
    if (angle) return *angle;
    return displacement.value();
  }
  [[nodiscard]] TimeFunctionPtr law(const std::string& key) const {
    const auto found = laws.find(key);
    return found == laws.end() ? nullptr : found->second;
  }
  [[nodiscard]] std::string word(const std::string& key) const {
    const auto found = words.find(key);
    return found == words.end() ? std::string() : found->second;
  }

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

/// Vector over a step: at t_{n+αf}, times the load factor of statics.
[[nodiscard]] inline Vec3 evaluate(const TimeVector& f, const StepContext& step) {
  return step.load_factor * evaluate(f, step.t_alpha());
}

/// A vector and numbers in one list, as reported by loads.
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
