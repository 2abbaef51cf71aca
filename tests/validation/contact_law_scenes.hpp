// SPDX-License-Identifier: Apache-2.0
// Bodies over a floor for the tests of contact laws.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::contact_law_scenes {

inline constexpr double kG = 9.81;

/// Bodies over a floor.
struct Scene {
  std::string bodies;
  std::string contact;  ///< Keys of contacts.default but the law.
  double span = 0.4;    ///< [s]
  double slope = 0.0;   ///< tan of the floor's inclination, down along x.
  std::string floor = "  floor: {fixed: true, shape: {plane: z}}\n";

  [[nodiscard]] Simulation with(const std::string& law, double step, double length) const {
    const double angle = std::atan(slope);
    return Simulation(io::read_model_text(
        format("format: 1\ngravity: [{:.17g}, 0, {:.17g}]\nbodies:\n"
               "{}{}\n"
               "contacts: {{default: {{law: {}, {}}}}}\n"
               "analysis: {{type: dynamics, duration: {:.17g} s, step: {:.17g} s}}\n",
               kG * std::sin(angle), -kG * std::cos(angle), floor, bodies, law, contact, length,
               step),
        "m.yaml"));
  }
  [[nodiscard]] Simulation with(const std::string& law, double step) const {
    return with(law, step, span);
  }
};

inline const char* const kBall = "  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.15]}";
inline const char* const kBox =
    "  a: {shape: {box: [0.2, 0.2, 0.1]}, mass: 1, position: [0, 0, 0.05]}";
inline const char* const kCube =
    "  a: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.1]}";

/// Bodies at rest, one on the other from the floor upwards, of these masses.
struct Pile {
  const char* name;
  std::string bodies;
  std::vector<double> masses;
};

inline const std::vector<Pile> kPiles = {
    {"two equal boxes",
     "  a: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.1]}\n"
     "  b: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.3]}",
     {1.0, 1.0}},
    {"a ton's box on a gram",
     "  a: {shape: {box: [0.2, 0.2, 0.02]}, mass: 0.001, position: [0, 0, 0.01]}\n"
     "  b: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1000, position: [0, 0, 0.12]}",
     {1e-3, 1e3}},
    {"a ton's ball on a gram's",
     "  a: {shape: {sphere: 0.1}, mass: 0.001, position: [0, 0, 0.05]}\n"
     "  b: {shape: {sphere: 0.1}, mass: 1000, position: [0, 0, 0.15]}",
     {1e-3, 1e3}}};

}  // namespace polhode::contact_law_scenes
