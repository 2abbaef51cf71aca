// SPDX-License-Identifier: Apache-2.0
// The program of docs/tour.md: a model made in code, run, and compared with what is known of it.
#include <iostream>
#include <numbers>

#include <polhode/polhode.hpp>

using namespace polhode;

/// A rod of 1 m, hinged at one end, at a small angle from hanging.
Model pendulum(double angle) {
  Model model;
  model.gravity = Vec3(0.0, 0.0, -9.81);

  const double sizes[] = {0.02, 0.02, 1.0};
  const MassProperties rod = shape_mass_properties("rod", *find_shape_kind("box"), sizes, 2700.0);
  BodySpec body;
  body.name = "rod";
  body.mass = rod.mass;
  body.inertia = rod.inertia;
  body.orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitY()));
  body.position = body.orientation * Vec3(0.0, 0.0, -0.5);
  model.bodies.push_back(body);

  JointSpec hinge;
  hinge.name = "hinge";
  hinge.type = "revolute";
  hinge.b = model.body_index("rod");  // on the ground, at its origin
  hinge.Z_b = Vec3(0.0, 0.0, 0.5);    // at the upper end of the rod
  hinge.R_a = hinge.R_b = Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitY()).matrix();  // axis y
  model.joints.push_back(hinge);

  model.analysis.step = 1e-3;
  model.analysis.order = 4;
  return model;
}

int main() {
  Simulation simulation(pendulum(1e-3));
  const double half_period = std::numbers::pi * std::sqrt(2.0 / 3.0 / 9.81);  // linear pendulum
  while (simulation.time() < half_period) simulation.step(half_period);

  const double angle = simulation.joint("hinge").coordinates[0];
  const double x = simulation.body("rod").r.x();
  std::cout << "angle " << angle << " rad, x " << x << " m, carried "
            << simulation.joint("hinge").force.z() << " N, moves with "
            << simulation.balance().kinetic << " J\n";
  // The tour ends here. The test also checks the force of the hinge where the rod turns back, at
  // rest.
  const double weight = 9.81 * 2700.0 * 4e-4;
  bool refused = false;
  try {
    (void)simulation.body("rood");
  } catch (const InputError& error) {
    refused = std::string(error.what()).find("Did you mean 'rod'?") != std::string::npos;
  }
  const bool right = std::abs(angle + 1e-3) < 1e-8 && std::abs(x - 0.5 * std::sin(1e-3)) < 1e-8 &&
                     std::abs(simulation.joint("hinge").force.z() - weight) < 1e-4 &&
                     simulation.balance().kinetic < 1e-9;
  return right && refused ? 0 : 1;
}
