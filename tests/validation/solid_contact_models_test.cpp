// SPDX-License-Identifier: Apache-2.0
// Contact between solids and of a solid with itself, from model files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <string>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/scratch.hpp>

namespace polhode::test::solid_contact_models_tests {
namespace {

Model two_cubes(const std::string& law, const std::string& analysis) {
  return io::read_model_text(R"(
format: 1
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  a:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}, position: [-0.06, 0, 0]}
    material: rubber
    velocity: [0.5, 0, 0]
    angular_velocity: [1, 2, 3]
  b:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0.06, 0.02, 0.01], orientation: {axis: [1, 2, 0], angle: 20 deg}}
    material: rubber
    velocity: [-0.5, 0, 0]
contacts: {default: {)" + law +
                                 R"(}}
analysis: )" + analysis,
                             "cubes.yaml");
}

/// Three by three elements below, four by four above, pressed by a dead load while the sides are
/// held: numerical damping brings them to rest. The stress is uniform.
TEST(SolidContactModel, PassesThePatchTestWithMeshesThatDoNotMatch) {
  const double p = 30.0;
  Simulation simulation(io::read_model_text(R"(
format: 1
materials: {m: {type: st_venant_kirchhoff, youngs_modulus: 2000, poisson_ratio: 0.3, density: 1}}
solids:
  lower:
    mesh: {block: {size: [1, 1, 0.5], cells: [3, 3, 2]}, position: [0.5, 0.5, 0.25]}
    element: hex8_standard
    material: m
    contact: {surface: zmax}
    prescribed: {x: {nodes: [xmin, xmax], x: 0}, y: {nodes: [ymin, ymax], y: 0}, z: {nodes: zmin, z: 0}}
  upper:
    mesh: {block: {size: [1, 1, 0.5], cells: [4, 4, 2]}, position: [0.5, 0.5, 0.751]}
    element: hex8_standard
    material: m
    contact: {surface: zmin}
    prescribed: {x: {nodes: [xmin, xmax], x: 0}, y: {nodes: [ymin, ymax], y: 0}}
loads: {p: {type: pressure, solid: upper, surface: zmax, pressure: 30, follower: false}}
contacts: {default: {gap_tolerance: 1 mm}}
analysis: {duration: 4 s, step: 0.05 s, rho_inf: 0}
)",
                                            "patch.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  double worst = 0.0;
  for (int s = 0; s < 2; ++s) {
    double area = 0.0;
    for (const surface_contact::SurfacePointReport& point : simulation.surface_points(s)) {
      worst = std::max(worst, std::abs(point.pressure / p - 1.0));
      area += point.force.norm() / p;
    }
    EXPECT_NEAR(area, 0.5, 1e-10) << "each side carries half";
  }
  EXPECT_LT(worst, 1e-10) << "pressure of points";
  EXPECT_NEAR(simulation.contact(0).normal_force / p, 1.0, 1e-10);
  worst = 0.0;
  for (int s = 0; s < 2; ++s)
    for (const ElementSample& e : simulation.solid(s).elements) {
      const double area = 1.0;  // the sides are held
      worst =
          std::max({worst, std::abs(-e.cauchy(2, 2) * area / p - 1.0), std::abs(e.cauchy(0, 2)) / p,
                    std::abs(e.cauchy(0, 0) - e.cauchy(1, 1)) / p});
    }
  EXPECT_LT(worst, 1e-10) << "stress of elements";
}

/// Results of a bar of 1 m and 10 kg at 0.01 m/s that hits another one at rest, end on.
struct Blow {
  double duration = 0.0;  ///< [s]
  double impulse = 0.0;   ///< As a part of the momentum of the first.
};

Blow blow_of_bars(double other_length, int cells, const std::string& step, int restitution) {
  Model model =
      io::read_model_text(format(R"(
format: 1
materials: {{m: {{type: elastic, youngs_modulus: 10 kPa, poisson_ratio: 0, density: 100}}}}
solids:
  struck:
    mesh: {{block: {{size: [{0:g}, 0.25, 0.4], cells: [{1:d}, 1, 1]}}, position: [{2:g}, 0, 0]}}
    material: m
    contact: {{surface: {{plane: {{axis: x, at: min}}}}}}
  striking:
    mesh: {{block: {{size: [1, 0.25, 0.4], cells: [{3:d}, 1, 1]}}, position: [-0.5, 0, 0]}}
    material: m
    velocity: [0.01, 0, 0]
    contact: {{surface: {{plane: {{axis: x, at: max}}}}}}
contacts: {{default: {{restitution: {4:d}, gap_tolerance: 5e-6}}}}
analysis: {{duration: 0.25 s, step: {5}}}
output: {{hdf5: false}}
)",
                                 other_length, static_cast<int>(std::lround(other_length * cells)),
                                 0.5 * other_length + 2e-5, cells, restitution, step),
                          "bars.yaml");
  Simulation simulation(std::move(model));
  Blow blow;
  double first = -1.0, last = 0.0, before = 0.0;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    if (std::abs(s.contact(0).normal_force) > 0.005) {  // a hundredth of ρ c A v/2
      if (first < 0.0) first = before;
      last = s.time();
    }
    before = s.time();
  });
  EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_LT(summary.energy_drift, 1e-11);
  EXPECT_LT(summary.linear_momentum_drift, 1e-11);
  blow.duration = last - first;
  blow.impulse = std::abs(simulation.contact(0).impulse) / 0.1;
  return blow;
}

/// St Venant's bars: a wave of the force ρ c A v/2 runs to both free ends and back. Equal bars
/// separate after 2L/c with exchanged velocities; a bar half as long stops the motion in half the
/// time with all of its momentum (Goldsmith, Impact, 1960, section 3.2). None of this depends on
/// the restitution. Errors are smaller with finer meshes. Points under the border of the other bar
/// used to slip off it (6 of 18), which made the impulse larger by 8e-4.
TEST(SolidContactModel, ElasticBarsExchangeTheirVelocities) {
  const double period = 0.2;  // 2L/c
  for (const int restitution : {0, 1}) {
    for (const auto& [step, h] : {std::pair("10 ms", 0.01), {"2 ms", 0.002}, {"0.5 ms", 0.0005}}) {
      const Blow equal = blow_of_bars(1.0, 20, step, restitution);
      EXPECT_NEAR(equal.duration, period, 0.025 * period + h) << step << ' ' << restitution;
      EXPECT_NEAR(equal.impulse, 1.0, h > 0.005 ? 0.04 : 0.02) << step << ' ' << restitution;
    }
    EXPECT_NEAR(blow_of_bars(0.5, 20, "1 ms", restitution).impulse, 0.5, 0.015) << restitution;
  }
  const double coarse = blow_of_bars(1.0, 10, "1 ms", 0).impulse;
  const double fine = blow_of_bars(1.0, 50, "1 ms", 0).impulse;
  EXPECT_NEAR(fine, 1.0, 0.01);
  EXPECT_LT(std::abs(fine - 1.0), 0.5 * std::abs(coarse - 1.0));
}

TEST(SolidContactModel, KeepsEnergyAndMomentaOfCubesThatCollide) {
  Simulation simulation(two_cubes("restitution: 1", "{duration: 0.15 s, step: 0.5 ms}"));
  double touched = 0.0;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    if (s.contact(0).points > 0) touched += 5e-4;
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(touched, 5e-3);
  EXPECT_GT(simulation.contact(0).impulse, 0.3);
  EXPECT_LT(summary.energy_drift, 1e-12);
  EXPECT_LT(summary.linear_momentum_drift, 1e-12);
  EXPECT_LT(summary.angular_momentum_drift, 1e-12);
  EXPECT_EQ(summary.contacts->lost_in_impacts, 0.0);
  EXPECT_GT(summary.contacts->least_gap, 0.0);
}

TEST(SolidContactModel, FrictionOnlyDissipatesEnergyAndKeepsMomenta) {
  Simulation simulation(
      two_cubes("restitution: 1, friction: 0.5", "{duration: 0.1 s, step: 0.5 ms}"));
  double lost = 0.0;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    EXPECT_GE(s.contact_losses().friction, lost);
    lost = s.contact_losses().friction;
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(lost, 1e-4);
  EXPECT_LT(summary.energy_drift, 1e-12);
  EXPECT_LT(summary.linear_momentum_drift, 1e-12);
  EXPECT_LT(summary.angular_momentum_drift, 1e-12);
}

TEST(SolidContactModel, ContinuesFromACheckpointInTheSameBits) {
  const Model model =
      two_cubes("restitution: 0.5, friction: 0.5", "{duration: 60 ms, step: 0.5 ms}");
  const Scratch folder;
  const std::string file = folder / "checkpoint.pst";
  Simulation straight(model);
  int touched = 0;
  const RunSummary summary = straight.run({}, [&](Simulation& s) {
    if (s.contact(0).points == 0 || ++touched != 3) return;
    io::write_checkpoint(file, model, s.system(), s.state());
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  ASSERT_GT(touched, 3);
  Simulation continued(model, io::read_checkpoint(file, model, straight.system()));
  EXPECT_LT(continued.time(), straight.time());
  ASSERT_EQ(continued.run().end, RunEnd::finished);
  EXPECT_EQ(continued.state_hash(), straight.state_hash());
}

/// A cube that would pass a sheet of rubber in two steps.
TEST(SolidContactModel, NothingPassesThroughASheet) {
  Simulation simulation(io::read_model_text(R"(
format: 1
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 1 ms}}}
solids:
  sheet:
    mesh: {block: {size: [0.4, 0.4, 0.02], cells: [4, 4, 1]}}
    material: rubber
    prescribed: {rim: {nodes: [xmin, xmax, ymin, ymax], x: 0, y: 0, z: 0}}
  cube:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}, position: [0.02, 0.01, 0.11], orientation: {axis: [1, 2, 0], angle: 20 deg}}
    material: rubber
    velocity: [0.3, 0, -6]
contacts: {default: {friction: 0.3}}
analysis: {duration: 30 ms, step: 2 ms}
)",
                                            "shot.yaml"));
  const RunSummary summary = simulation.run({}, [](Simulation& s) {
    // The node of the sheet below the cube, on its upper face: the middle of 5 × 5.
    const Vec3 sheet = s.solid(0).position[25 + 12];
    double above = 1.0;
    for (const Vec3& x : s.solid(1).position) above = std::min(above, x[2] - sheet[2]);
    EXPECT_GT(above, -0.02) << "at " << s.time();
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(simulation.contact(0).impulse, 4.0) << "1 kg at 6 m/s was stopped";
  EXPECT_GT(summary.contacts->least_gap, 0.0);
}

/// A ring so soft that it collapses under its own weight: its top falls on its bottom.
Simulation ring(const std::string& contact, const std::string& contacts) {
  return Simulation(io::read_model_text(R"(
format: 1
gravity: [0, -150, 0]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 2 ms}}}
solids:
  ring:
    mesh: {tube: {outer: 0.1, inner: 0.092, length: 0.01, cells: [1, 24, 1]}}
    material: rubber
    contact: )" + contact + R"(
    prescribed: {bottom: {nodes: {box: {from: [-0.014, -1, -1], to: [0.014, 0, 1]}}, x: 0, y: 0, z: 0}}
contacts: )" + contacts + R"(
analysis: {duration: 70 ms, step: 1 ms}
)",
                                        "ring.yaml"));
}

/// The inner node at the top over that at the bottom [m].
double opening(Simulation& s) {
  double top = -1.0, bottom = 1.0;
  const std::vector<Vec3> now = s.solid(0).position;
  static const std::vector<Vec3> start = now;
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (std::abs(start[k].head<2>().norm() - 0.046) > 1e-3 || std::abs(start[k][0]) > 1e-3)
      continue;
    (start[k][1] > 0.0 ? top : bottom) = now[k][1];
  }
  return top - bottom;
}

TEST(SolidContactModel, ARingThatCollapsesDoesNotPassThroughItself) {
  double least[2] = {1.0, 1.0};
  for (const bool self : {true, false}) {
    Simulation simulation =
        ring(self ? "{self: true}" : "{}", self ? "{default: {friction: 0.2}}" : "{}");
    double& most = least[self ? 0 : 1];
    const RunSummary summary =
        simulation.run({}, [&](Simulation& s) { most = std::min(most, opening(s)); });
    if (!self) continue;  // after it passed through itself, a run need not continue for long
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_GT(simulation.contact(0).impulse, 0.0);
    EXPECT_TRUE(simulation.contact(0).force.isZero(0.0)) << "of a surface on itself";
    EXPECT_LT(summary.energy_drift, 1e-11);
  }
  EXPECT_GT(least[0], 0.0);
  EXPECT_LT(least[0], 0.01) << "the ring collapsed";
  EXPECT_LT(least[1], 0.0) << "without self: true it passes through itself";
}

/// Two bars of one element, each standing on an edge, that cross in their middles, where neither
/// has a node.
Model crossing_edges(const std::string& law, const std::string& spin) {
  return io::read_model_text(R"(
format: 1
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  below:
    mesh: {block: {size: [0.4, 0.1, 0.1], cells: [1, 1, 1]}, position: [0, 0, 0], orientation: {axis: x, angle: 45 deg}}
    material: rubber
    velocity: [0, 0, 0.5]
  above:
    mesh: {block: {size: [0.1, 0.4, 0.1], cells: [1, 1, 1]}, position: [0.01, 0.03, 0.1454], orientation: {axis: y, angle: 45 deg}}
    material: rubber
    velocity: [0.05, 0.1, -0.5]
    angular_velocity: )" + spin +
                                 R"(
contacts: {default: {)" + law +
                                 R"(}}
analysis: {duration: 0.2 s, step: 0.5 ms}
)",
                             "edges.yaml");
}

/// The highest edge of the lower bar and the lowest one of the upper bar at the start.
struct Crossing {
  std::size_t ends[4];

  explicit Crossing(const Simulation& s) {
    for (int solid = 0; solid < 2; ++solid) {
      const std::vector<Vec3> at = s.solid(solid).position;
      std::vector<std::size_t> order(at.size());
      std::iota(order.begin(), order.end(), 0U);
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return solid == 0 ? at[a].z() > at[b].z() : at[a].z() < at[b].z();
      });
      std::copy_n(order.begin(), 2, ends + 2 * solid);
    }
  }
  /// Height of the second above the first one.
  [[nodiscard]] double height(const Simulation& s) const {
    const std::vector<Vec3> below = s.solid(0).position, above = s.solid(1).position;
    const Vec3 &a = below[ends[0]], &c = above[ends[2]];
    const Vec3 n = (below[ends[1]] - a).cross(above[ends[3]] - c).normalized();
    return (n.z() < 0.0 ? -n : n).dot(c - a);
  }
};

// @tests{edge-potential}
TEST(SolidContactModel, CrossedEdgesDoNotPassBetweenTheirNodes) {
  for (const std::string law :
       {"restitution: 1", "restitution: 1, friction: 0.4", "restitution: 0"}) {
    SCOPED_TRACE(law);
    Simulation simulation(crossing_edges(law, law == "restitution: 1" ? "[0, 0, 3]" : "[0, 0, 0]"));
    const Crossing edges(simulation);
    double least = 1.0, energy = 1e9, rise = 0.0;
    const RunSummary summary = simulation.run({}, [&](Simulation& s) {
      least = std::min(least, edges.height(s));
      const Balance held = s.balance();
      const double now = held.kinetic + held.potential;
      rise = std::max(rise, now - energy);
      energy = now;
    });
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_GT(least, 0.0);
    EXPECT_LT(least, 2e-4) << "there was contact";
    EXPECT_GT(simulation.contact(0).impulse, 1.0);
    EXPECT_LT(summary.energy_drift, 1e-11);
    EXPECT_LT(rise, 1e-11);
    EXPECT_LT(summary.linear_momentum_drift, 1e-12);
    EXPECT_LT(summary.angular_momentum_drift, 1e-11);
    EXPECT_EQ(summary.contacts->lost_in_impacts > 1e-3, law == "restitution: 0");
    EXPECT_EQ(simulation.contact_losses().friction > 1e-4, law.ends_with("0.4"));
  }
}

TEST(SolidContactModel, NamesSolidsThatTouchAtTheStart) {
  const auto stacked = [](double z) {
    return io::read_model_text(R"(
format: 1
variables: {z: )" + std::to_string(z) +
                                   R"( m}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  lower: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, material: rubber}
  upper: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}, position: [0, 0, z]}, material: rubber}
contacts: {}
analysis: {duration: 1 ms, step: 1 ms}
)",
                               "stack.yaml");
  };
  const auto error_of = [&](double z) -> std::string {
    try {
      Simulation(stacked(z)).run();
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_NE(error_of(0.1).find("lower touches upper"), std::string::npos) << error_of(0.1);
  EXPECT_NE(error_of(0.095).find("lower in upper by 0.005 m"), std::string::npos)
      << error_of(0.095);
  EXPECT_EQ(error_of(0.1002), "");
}

}  // namespace
}  // namespace polhode::test::solid_contact_models_tests
