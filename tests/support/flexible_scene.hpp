// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>

namespace polhode::test {

/// A bar of solid elements along x, from 0.5 on, one end on a tumbling hub, the other free or on a
/// second body.
struct FlexibleScene {
  struct Options {
    std::string element = "hex8_eas9", cell = "hex8";
    std::string material = "neo_hookean";
    std::map<std::string, double> moduli{{"youngs_modulus", 2000.0}, {"poisson_ratio", 0.3}};
    double relaxation_time = 0.0;  ///< Kelvin-Voigt [s].
    std::vector<solids::Relaxation> relaxation = {};
    std::vector<double> cells{6, 1, 1};
    bool conserving = true, two_bodies = false, hinge = false;
    Vec3 gravity = Vec3::Zero();
    Vec3 omega = Vec3(0.7, -1.1, 2.95);
    double step = 0.02, rho_inf = 1.0;
    int order = 2;
    NodeFactor factor = NodeFactor::every_iteration;
    std::vector<solids::FibreDescription> fibres = {};
    std::vector<Vec3> directions = {};  ///< Of the fibres.
  };

  explicit FlexibleScene(const Options& o) : options(o) {
    const Vec3 size(6.0, 0.5, 0.5), centre(0.5 + 0.5 * size[0], 0, 0);
    solids::Mesh mesh = solids::make_mesh(
        "bar", "block", {{"size", {size[0], size[1], size[2]}}, {"cells", o.cells}}, o.cell);
    system.set_gravity(o.gravity);
    const Vec3 tip_at(size[0] + 1.0, 0, 0);
    // No total momentum, since a growing distance would only add round-off.
    const double bar_mass = 0.5 * size.prod(), hub_mass = 2.0;
    const double mass = bar_mass + hub_mass + (o.two_bodies ? hub_mass : 0.0);
    const Vec3 com = (bar_mass * centre + (o.two_bodies ? hub_mass : 0.0) * tip_at) / mass;
    const Vec3 pivot = o.hinge ? Vec3(-0.4, 0.1, 0.0) : com;
    const auto velocity = [&](const Vec3& x) { return Vec3(o.omega.cross(x - pivot)); };
    const auto body = [&](const Vec3& r, const char* name) {
      BodyData data{.name = name, .mass = hub_mass, .inertia = Vec3(0.3, 0.4, 0.55).asDiagonal()};
      BodyMotion start;
      start.r = r;
      start.v = velocity(r);
      start.W = o.omega;
      return system.add_body(data, start);
    };
    const int hub = body(Vec3::Zero(), "hub");
    const int tip = o.two_bodies ? body(tip_at, "tip") : kGround;
    std::vector<Vec3> X;
    for (const Vec3& own : mesh.nodes) {
      const Vec3 x = own + centre;
      X.push_back(x);
      NodeData node{.position = x, .velocity = velocity(x)};
      if (x[0] < 0.5 + 1e-9) {
        node.body = hub;
        node.Z = x;
      } else if (o.two_bodies && x[0] > 0.5 + size[0] - 1e-9) {
        node.body = tip;
        node.Z = x - tip_at;
      }
      system.add_node(node);
    }
    solids::MaterialDescription material;
    material.kind = o.material;
    material.values = {o.moduli.begin(), o.moduli.end()};
    material.relaxation_time = o.relaxation_time;
    material.relaxation = o.relaxation;
    material.fibres = o.fibres;
    solids::SolidElementsDescription d;
    d.name = "solids.bar";
    d.element = o.element;
    d.material = solids::make_material("materials.m", material);
    d.density = 0.5;
    d.conserving = o.conserving;
    d.connectivity = mesh.blocks.at(0).nodes;
    d.X = X;
    d.fibres = o.directions;
    system.add_elements(solids::make_solid_elements(std::move(d)));
    if (o.hinge)
      system.group<Joint>().add("pin", "revolute", Participants{kGround, hub},
                                joint_kind("revolute").recipe({.Z_a = pivot, .Z_b = pivot}, {}));
    if (o.hinge && o.two_bodies) {  // the second joint: a link from the tip to a third body
      const Vec3 at = tip_at + Vec3(0.5, 0, 0), r = tip_at + Vec3(1.0, 0, 0);
      const int link = body(r, "link");
      system.group<Joint>().add(
          "elbow", "spherical", Participants{tip, link},
          joint_kind("spherical").recipe({.Z_a = at - tip_at, .Z_b = at - r}, {}));
    }
    system.finish();
    const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(o.rho_inf);
    state = system.initial_state();
    start_report = start(system, state, ga, o.step);
    auto made =
        std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum, o.factor);
    engine = made.get();
    StepControl control;
    control.step = o.step;
    control.order = o.order;
    control.newton.max_iterations = 30;
    control.newton.tolerance = 1e-6;
    if (o.order > 2) control.newton.tolerance = 1e-7;
    stepper =
        std::make_unique<Stepper>(system, std::move(made), ga, control, lane_kernels("automatic"));
    stepper->begin(state);
  }

  void run(int steps) {
    for (int i = 0; i < steps; ++i) {
      const StepReport r = stepper->advance(state, state.t + options.step);
      ASSERT_TRUE(r.accepted) << r.message;
    }
  }
  [[nodiscard]] double energy_drift() const {
    return state.ledger.energy_drift / state.ledger.energy_scale;
  }
  [[nodiscard]] double momentum_drift() const {
    return state.ledger.l_drift / state.ledger.l_scale;
  }

  Options options;
  System system;
  State state;
  StartReport start_report;
  SparseEngine* engine = nullptr;
  std::unique_ptr<Stepper> stepper;
};

}  // namespace polhode::test
