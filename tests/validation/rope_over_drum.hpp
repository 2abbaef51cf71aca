// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// A rope over a fixed drum, half around it, with weights at its ends: straight pieces whose
/// middles touch the drum at the start. The light weight is 1 kg.
struct Drum {
  static constexpr double kRadius = 0.1, kRope = 4e-3, kPerLength = 0.01, g = 9.81;
  Model model;
  int light = 0, heavy = 1;
  double rope_mass = 0.0;

  /// @param shape  Of the drum, about z.
  Drum(int pieces_over, double heavy_mass, double mu, double duration,
       const std::string& shape = "{cylinder: [0.2, 0.1]}") {
    const double turn = std::numbers::pi / pieces_over, rho = kRadius + kRope + 2e-6;
    const double corner = rho / std::cos(0.5 * turn), piece = 2.0 * rho * std::tan(0.5 * turn);
    const int leg = static_cast<int>(std::ceil(0.25 / piece));
    std::vector<Vec3> path;
    for (int k = 0; k < leg; ++k) path.emplace_back(-corner, 0.0, (k - leg) * piece);
    for (int k = 0; k <= pieces_over; ++k)
      path.emplace_back(-corner * std::cos(k * turn), 0.0, corner * std::sin(k * turn));
    for (int k = 1; k <= leg; ++k) path.emplace_back(corner, 0.0, -k * piece);
    const double length = piece * static_cast<double>(path.size() - 1);
    rope_mass = kPerLength * length;
    model = io::read_model_text(format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  light: {{mass: 1, inertia: [1e-3, 1e-3, 1e-3], position: [{0:.17g}, 0, {1:.17g}]}}
  heavy: {{mass: {2:.17g}, inertia: [1e-3, 1e-3, 1e-3], position: [{3:.17g}, 0, {1:.17g}]}}
  drum: {{fixed: true, shape: {9}, orientation: {{axis: x, angle: 90 deg}}}}
cables:
  rope: {{through: [[light], [heavy]], stiffness: 1e5, mass_per_length: {4:g}, damping: 200,
         contact: {{radius: 4 mm}}, free_length: {5:.17g}, elements: {6}}}
contacts: {{default: {{friction: {7:g}, restitution: 1}}}}
analysis: {{step: 0.5 ms, duration: {8:g}}}
)",
                                       -corner, -leg * piece, heavy_mass, corner, kPerLength,
                                       length, path.size() - 1, mu, duration, shape),
                                "drum.yaml");
    const int first = model.body_index("rope.0");  // the rope of the file is straight
    for (std::size_t k = 0; k < path.size(); ++k)
      model.bodies[static_cast<std::size_t>(first) + k].position = path[k];
  }

  /// Downward, of the heavy weight, from 0.1 s to the end.
  [[nodiscard]] double acceleration(Simulation& s) const {
    double t_1 = 0.0, v_1 = 0.0;
    const RunSummary r = s.run({}, [&](Simulation& now) {
      if (now.time() < 0.1 + 1e-9) t_1 = now.time(), v_1 = now.body(heavy).v.z();
    });
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_LT(r.energy_drift, 1e-9);
    return -(s.body(heavy).v.z() - v_1) / (s.time() - t_1);
  }
};

}  // namespace polhode::test
