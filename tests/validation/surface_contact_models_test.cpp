// SPDX-License-Identifier: Apache-2.0
// Contact of solids' surfaces, from model files.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::surface_contact_models_tests {
namespace {

/// A block of hexahedra as nodes and elements of a model file.
/// @param place  From (i, j, k) / cells to a node.
template <class Place>
std::string inline_block(const std::array<int, 3>& cells, Place&& place) {
  std::string nodes, elements;
  const int nx = cells[0], ny = cells[1], nz = cells[2];
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) {
        const Vec3 x = place(i, j, k);
        nodes +=
            format("{}[{:.17g}, {:.17g}, {:.17g}]", nodes.empty() ? "" : ", ", x[0], x[1], x[2]);
      }
  const auto at = [&](int i, int j, int k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        elements +=
            format("{}[{}, {}, {}, {}, {}, {}, {}, {}]", elements.empty() ? "" : ", ", at(i, j, k),
                   at(i + 1, j, k), at(i + 1, j + 1, k), at(i, j + 1, k), at(i, j, k + 1),
                   at(i + 1, j, k + 1), at(i + 1, j + 1, k + 1), at(i, j + 1, k + 1));
  return format("{{nodes: [{}], elements: [{}]}}", nodes, elements);
}

/// A distorted mesh between a plane below and a dead pressure above.
TEST(SurfaceContactModel, PassesThePatchTest) {
  const double p = 30.0;
  const std::string mesh = inline_block({3, 3, 3}, [](int i, int j, int k) {
    Vec3 x(i / 3.0, 0.4 * j, 0.8 * k / 3.0);
    if (i % 3 != 0 && j % 3 != 0) x += 0.04 * Vec3(std::sin(9.0 * j), std::cos(7.0 * i), 0.0);
    if (k % 3 != 0) x[2] += 0.04 * std::sin(8.0 * i + 5.0 * j);
    return x;
  });
  Simulation simulation(io::read_model_text(R"(
format: 1
bodies: {floor: {fixed: true, shape: {plane: z}}}
materials: {m: {type: st_venant_kirchhoff, youngs_modulus: 2000, poisson_ratio: 0.3, density: 1}}
solids:
  block:
    mesh: )" + mesh + R"(
    element: hex8_standard
    material: m
    contact: {surface: {plane: {axis: z, at: min}}}
    prescribed: {x: {nodes: {plane: {axis: x, at: min}}, x: 0}, y: {nodes: {plane: {axis: y, at: min}}, y: 0}}
loads: {p: {type: pressure, solid: block, surface: {plane: {axis: z, at: max}}, pressure: 30, follower: false}}
contacts: {default: {gap_tolerance: 1 mm}}
analysis: {type: statics}
)",
                                            "patch.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const std::vector<surface_contact::SurfacePointReport> points = simulation.surface_points(0);
  ASSERT_EQ(points.size(), 16U);
  for (const surface_contact::SurfacePointReport& point : points)
    EXPECT_NEAR(point.pressure / p, 1.0, 1e-10);
  const ContactReport contact = simulation.contact(0);
  EXPECT_NEAR(contact.force[2] / (1.2 * p), 1.0, 1e-10);
  const SolidReport solid = simulation.solid(0);
  for (const ElementSample& s : solid.elements) {
    const double area = s.principal_stretches[0] * s.principal_stretches[1];
    EXPECT_NEAR(s.cauchy(2, 2) * area / p, -1.0, 1e-10);  // the pressure is per undeformed area
    EXPECT_LT(std::abs(s.cauchy(0, 0)) / p, 1e-10);
  }
}

/// A hammer with a head of rubber and a free ball, in space, which collide while both rotate.
TEST(SurfaceContactModel, KeepsEnergyAndMomentaOfASolidThatIsBondedToABody) {
  Simulation simulation(io::read_model_text(R"(
format: 1
bodies:
  hammer: {shape: {box: [0.3, 0.1, 0.1]}, density: 1000, position: [-0.2, 0.01, 0], velocity: [1.5, 0, 0], angular_velocity: [0.5, 0.4, 3]}
  ball: {shape: {sphere: 0.2}, density: 700, position: [0.21, 0.03, 0.01], velocity: [-1, 0, 0.1], angular_velocity: [0, 5, 0]}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.35, density: 1100}}
solids:
  head:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0.01, 0]}
    material: rubber
    bonded: {hammer: xmin}
contacts:
  default: {restitution: 1}
  exclude: [[hammer, ball]]
analysis: {duration: 0.4 s, step: 0.5 ms}
)",
                                            "hammer.yaml"));
  double touched = 0.0;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    if (s.contact(0).points > 0) touched += 5e-4;
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_GT(touched, 2e-3);
  EXPECT_LT(summary.energy_drift, 1e-10);
  EXPECT_LT(summary.linear_momentum_drift, 1e-10);
  EXPECT_LT(summary.angular_momentum_drift, 1e-10);
  EXPECT_NEAR(summary.contacts->lost_in_impacts, 0.0, 1e-15);
  EXPECT_GT(summary.contacts->least_gap, -5e-5);
}

/// A bar that hits a wall end on: a wave of the stress ρcv runs to its free end and back, for 2L/c
/// (St Venant's rod; Goldsmith, Impact, 1960, section 3.2).
TEST(SurfaceContactModel, AnElasticBarRestsOnAWallWhileAWaveRunsThroughIt) {
  const double density = 100.0, c = 10.0, area = 0.1, v = 0.01, length = 1.0;
  Simulation simulation(io::read_model_text(R"(
format: 1
bodies: {wall: {fixed: true, shape: {plane: x}}}
materials: {m: {type: elastic, youngs_modulus: 10 kPa, poisson_ratio: 0, density: 100}}
solids:
  bar:
    mesh: {block: {size: [1, 0.25, 0.4], cells: [40, 1, 1]}, position: [0.50002, 0, 0]}
    material: m
    velocity: [-0.01, 0, 0]
    contact: {surface: {plane: {axis: x, at: min}}}
contacts: {default: {restitution: 1, gap_tolerance: 5e-6}}
analysis: {duration: 0.3 s, step: 1 ms}
)",
                                            "bar.yaml"));
  const double plateau = density * c * v * area;
  double first = 0.0, last = 0.0, sum = 0.0;
  int steps = 0;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    const double force = s.contact(0).force[0], t = s.time();
    if (std::abs(force) > 0.01 * plateau) {
      if (first == 0.0) first = t - 1e-3;
      last = t;
    }
    if (t > 0.03 && t < 0.18) sum += std::abs(force), ++steps;
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_NEAR(last - first, 2.0 * length / c, 0.01 * 2.0 * length / c + 1e-3);  // and one step
  EXPECT_NEAR(sum / steps, plateau, 0.01 * plateau);
  EXPECT_LT(summary.energy_drift, 1e-10);
}

/// The end of a ball of radius 1 pressed on a plane. Hertz: with the force F and E* = E/(1 − ν²)
/// the radius of contact is (3 F R/(4 E*))^(1/3), the pressure in the middle 3 F/(2π a²)
/// (K. L. Johnson, Contact Mechanics, 1985, section 4.2).
TEST(SurfaceContactModel, CarriesTheEndOfABallByHertz) {
  constexpr int kAcross = 14, kDeep = 12;
  const double E = 1e6, nu = 0.3;
  const auto graded = [](int i, double first, int even, double growth) {
    if (i <= even) return first * i;
    return first * (even + growth * (std::pow(growth, i - even) - 1.0) / (growth - 1.0));
  };
  const double first = 0.01 / 6.0;  // six elements over the radius of contact
  const std::string mesh = inline_block({kAcross, kAcross, kDeep}, [&](int i, int j, int k) {
    const double x = graded(i, first, 7, 1.5), y = graded(j, first, 7, 1.5);
    const double z = graded(k, first, 6, 1.6), depth = graded(kDeep, first, 6, 1.6);
    const double cap = 1.0 - std::sqrt(1.0 - x * x - y * y);
    return Vec3(x, y, cap + (depth + 0.02 - cap) * z / depth);
  });
  Simulation simulation(io::read_model_text(R"(
format: 1
variables: {T: 1 s}
bodies: {wall: {fixed: true, shape: {plane: z}}}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  ball:
    mesh: )" + mesh + R"(
    material: m
    contact: {surface: {sphere: {centre: [0, 0, 1], radius: 1, surface: true}}}
    prescribed:
      x: {nodes: {plane: {axis: x, at: min}}, x: 0}
      y: {nodes: {plane: {axis: y, at: min}}, y: 0}
      top: {nodes: {plane: {axis: z, at: max}}, z: "-1e-4*t/T"}
contacts: {default: {law: linear, gap_tolerance: 1e-6, reference_pressure: 20 kPa}}
analysis: {type: statics}
)",
                                            "hertz.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const double F = 4.0 * simulation.contact(0).normal_force;  // two planes of symmetry
  const double E_star = E / (1.0 - nu * nu);
  const double a = std::cbrt(0.75 * F / E_star), p_0 = 1.5 * F / (std::numbers::pi * a * a);
  EXPECT_LT(a, 0.011);
  EXPECT_GT(a, 0.009);
  double pressure = 0.0, farthest = 0.0;
  for (const surface_contact::SurfacePointReport& point : simulation.surface_points(0)) {
    const double r = std::hypot(point.point[0], point.point[1]);
    farthest = std::max(farthest, r);
    if (r < 1e-6) pressure = point.pressure;
    if (r < 0.8 * a) {
      EXPECT_NEAR(point.pressure / p_0, std::sqrt(1.0 - r * r / (a * a)), 0.03) << "at " << r / a;
    }
  }
  EXPECT_NEAR(pressure / p_0, 1.0, 0.03);
  EXPECT_NEAR(farthest, a, 1.5 * first);
}

/// The same with an octant of the whole ball, cells graded towards the pole: six of them over the
/// radius of contact, a/R = 0.04. The remaining error is mostly that of the finite size of the ball
/// and of the mesh.
TEST(SurfaceContactModel, CarriesAnOctantOfABallByHertz) {
  constexpr double kModulus = 1e6, kPoisson = 0.3;
  Simulation simulation(io::read_model_text(R"(
format: 1
variables: {T: 1 s}
bodies: {wall: {fixed: true, shape: {plane: z}}}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  ball:
    mesh: {sphere: {diameter: 2, octants: 1, cells: [14, 8], grading: [0.02, 100]}, position: [0, 0, 1], orientation: {axis: x, angle: 180 deg}}
    material: m
    contact: {surface: outer}
    prescribed:
      x: {nodes: xmid, x: 0}
      y: {nodes: ymid, y: 0}
      middle: {nodes: zmid, z: "-1.55e-3*t/T"}
contacts: {default: {law: linear, gap_tolerance: 5e-7, reference_pressure: 20 kPa}}
analysis: {type: statics}
)",
                                            "octant.yaml"));
  const RunSummary summary = simulation.run();
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const double F = 4.0 * simulation.contact(0).normal_force;  // two planes of symmetry
  const double a = std::cbrt(0.75 * F * (1.0 - kPoisson * kPoisson) / kModulus);
  const double p_0 = 1.5 * F / (std::numbers::pi * a * a);
  EXPECT_NEAR(a, 0.04, 1e-3);
  double pressure = 0.0, farthest = 0.0;
  int along = 0;
  for (const surface_contact::SurfacePointReport& point : simulation.surface_points(0)) {
    const double r = std::hypot(point.point[0], point.point[1]);
    if (r < 1e-6) pressure = point.pressure;
    if (point.pressure <= 0.0) continue;
    farthest = std::max(farthest, r);
    if (std::abs(point.point[1]) < 1e-9) ++along;
  }
  EXPECT_GE(along, 6) << "points over the radius";
  EXPECT_NEAR(pressure / p_0, 1.0, 0.03);
  EXPECT_NEAR(farthest / a, 1.0, 0.1);
}

/// A deformable cube that hits a free spinning body.
TEST(SurfaceContactModel, KeepsEnergyAndMomentaOnConesEllipsoidsAndHulls) {
  for (const std::string shape :
       {"{cone: [0.12, 0.15]}", "{ellipsoid: [0.1, 0.14, 0.2]}",
        "{hull: {points: [[0.08, 0, 0], [-0.04, 0.07, 0], [-0.04, -0.07, 0], [0, 0, 0.1], "
        "[0.02, 0.01, -0.08]]}}"}) {
    Simulation simulation(io::read_model_text(R"(
format: 1
bodies:
  stone: {density: 500, position: [0.16, 0.01, 0.02], velocity: [-1, 0, 0], angular_velocity: [2, 3, 1], shape: )" +
                                                  shape + R"(}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  cube:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [3, 3, 3]}}
    material: rubber
    velocity: [0.5, 0, 0]
contacts: {default: {restitution: 1}}
analysis: {duration: 0.15 s, step: 0.5 ms}
)",
                                              "stone.yaml"));
    const RunSummary summary = simulation.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << shape << summary.message;
    EXPECT_GT(simulation.contact(0).impulse, 0.1) << shape;
    EXPECT_LT(summary.energy_drift, 1e-11) << shape;
    EXPECT_LT(summary.linear_momentum_drift, 1e-12) << shape;
    EXPECT_LT(summary.angular_momentum_drift, 1e-12) << shape;
  }
}

/// A cube of rubber that hits a plate at a speed at which it would pass it in a twentieth of a
/// step.
TEST(SurfaceContactModel, NothingPassesThroughAThinPlate) {
  for (const char* shape : {"{box: [1, 1, 0.005]}", "{cylinder: [1, 0.005]}"}) {
    Simulation simulation(io::read_model_text(std::string(R"(
format: 1
bodies: {plate: {fixed: true, shape: )") + shape +
                                                  R"(}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 1 ms}}}
solids:
  cube:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0.02, 0.01, 0.33], orientation: {axis: [1, 2, 0], angle: 20 deg}}
    material: rubber
    velocity: [0.3, 0, -20]
contacts: {default: {friction: 0.3}}
analysis: {duration: 40 ms, step: 5 ms}
)",
                                              "shot.yaml"));
    double energy = simulation.balance().kinetic, rise = 0.0;
    const RunSummary summary = simulation.run({}, [&](Simulation& s) {
      const Balance b = s.balance();
      rise = std::max(rise, b.kinetic + b.potential - energy);
      energy = b.kinetic + b.potential;
      for (const Vec3& x : s.solid(0).position) EXPECT_GT(x[2], 0.0024) << "at " << s.time();
    });
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_GT(simulation.contact(0).impulse, 20.0) << "it was stopped";
    EXPECT_LT(rise, 1e-9 * 200.0);
  }
}

}  // namespace
}  // namespace polhode::test::surface_contact_models_tests
