// SPDX-License-Identifier: Apache-2.0
// Deformable solids against rigid surfaces: conservation in impacts, patch test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include <polhode/engines/sparse_engine.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/solids/loads/pressure.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/statics.hpp>
#include <polhode/stepping/start.hpp>
#include <polhode/stepping/stepper.hpp>
#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode::test::surface_contact_tests {
namespace {

/// A block of solid elements whose faces towards −z may touch a rigid surface.
struct Block {
  System system;
  State state;
  solids::Mesh mesh;
  std::vector<Vec3> X;
  int contact = -1;
  std::unique_ptr<Stepper> stepper;

  /// @param place  Initial position and velocity from a node of the block centred at the origin.
  template <class Place>
  Block(const std::vector<double>& size, const std::vector<double>& cells,
        const std::vector<double>& grading, Place&& place) {
    mesh = solids::make_mesh("block", "block",
                             {{"size", size}, {"cells", cells}, {"grading", grading}}, "hex8");
    for (const Vec3& own : mesh.nodes) {
      const NodeData node = place(own);
      X.push_back(node.position);
      system.add_node(node);
    }
  }

  void add_elements(const char* element, double modulus, double nu, double density,
                    const char* kind = "neo_hookean") {
    solids::MaterialDescription material;
    material.kind = kind;
    material.values = {{"youngs_modulus", modulus}, {"poisson_ratio", nu}};
    solids::SolidElementsDescription d;
    d.name = "solids.block";
    d.element = element;
    d.material = solids::make_material("materials.m", material);
    d.density = density;
    d.connectivity = mesh.blocks.at(0).nodes;
    d.X = X;
    system.add_elements(solids::make_solid_elements(std::move(d)));
  }

  /// Faces of the boundary all of whose nodes satisfy the condition.
  template <class Condition>
  [[nodiscard]] solids::LoadedFaces faces(Condition&& on) const {
    static constexpr int kFace[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                        {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    solids::LoadedFaces list{"quad4", {}};
    const std::vector<int>& nodes = mesh.blocks.at(0).nodes;
    std::map<std::vector<int>, int> count;  // of boundary faces: 1
    const auto of = [&](std::size_t e, const int(&face)[4]) {
      std::vector<int> own;
      for (int k : face) own.push_back(nodes[e + static_cast<std::size_t>(k)]);
      return own;
    };
    const auto sorted = [](std::vector<int> own) {
      std::sort(own.begin(), own.end());
      return own;
    };
    for (std::size_t e = 0; e < nodes.size(); e += 8)
      for (const auto& face : kFace) ++count[sorted(of(e, face))];
    for (std::size_t e = 0; e < nodes.size(); e += 8)
      for (const auto& face : kFace) {
        const std::vector<int> own = of(e, face);
        bool all = count[sorted(own)] == 1;
        for (int k : own) all = all && on(mesh.nodes[static_cast<std::size_t>(k)]);
        if (all) list.nodes.insert(list.nodes.end(), own.begin(), own.end());
      }
    return list;
  }

  void touch(const solids::LoadedFaces& faces, const surface_contact::RigidSurface& surface,
             const surface_contact::SurfacePlace& place, const surface_contact::SurfaceLaw& law) {
    contact = system.add_elements(std::make_unique<surface_contact::SurfaceContact>(
        "contacts.c", surface_contact::surface_points("contacts.c", faces, X), X, surface, place,
        law));
  }
  [[nodiscard]] surface_contact::SurfaceReport report() const {
    const auto& group =
        dynamic_cast<const surface_contact::SurfaceContact&>(system.nodes().group(contact));
    return group.report(state.element_history.data() + system.nodes().first_history(contact));
  }

  void start_run(double step) {
    system.finish();
    const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(1.0);
    state = system.initial_state();
    start(system, state, ga, step);
    StepControl control;
    control.step = step;
    control.newton.max_iterations = 30;
    control.newton.tolerance = 1e-6;
    stepper = std::make_unique<Stepper>(
        system,
        std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum,
                                       NodeFactor::every_iteration),
        ga, control, lane_kernels("automatic"));
    stepper->begin(state);
  }
  void advance(double step) {
    const StepReport r = stepper->advance(state, state.t + step);
    ASSERT_TRUE(r.accepted) << r.message;
  }
};

surface_contact::SurfaceLaw stiff(double tolerance, double k, double mu) {
  surface_contact::SurfaceLaw law;
  law.normal.tolerance = tolerance;
  law.normal.stiffness = k;
  law.mu = mu;
  law.bristle = k;
  return law;
}

const auto kAll = [](const Vec3&) { return true; };

/// A spinning block thrown obliquely on a plane: it bounces, vibrates, tumbles.
Block thrown(double mu, double step) {
  const Vec3 omega(0.6, 1.0, -0.4);
  const Mat3 turned =
      Quat(Eigen::AngleAxisd(0.3, Vec3(1.0, 0.5, 0.0).normalized())).toRotationMatrix();
  Block b({1.0, 1.0, 1.0}, {2, 2, 2}, {1, 1, 1}, [&](const Vec3& own) {
    const Vec3 z = turned * own;
    return NodeData{.position = Vec3(0.0, 0.0, 1.0) + z,
                    .velocity = Vec3(0.8, 0.3, -1.5) + omega.cross(z)};
  });
  b.add_elements("hex8_standard", 2e5, 0.3, 1000.0);
  b.touch(b.faces(kAll), {}, {}, stiff(5e-3, 5e7, mu));
  b.system.set_gravity({0.0, 0.0, -9.81});
  b.start_run(step);
  return b;
}

TEST(SurfaceContact, ABlockThatBouncesKeepsItsEnergy) {
  const double step = 4e-3;
  Block b = thrown(0.0, step);
  double touched = 0.0;
  for (int k = 0; k < 150; ++k) {
    b.advance(step);
    if (b.report().area > 0.0) touched += step;
    ASSERT_GT(b.report().least_gap, -5e-3);
  }
  EXPECT_GT(touched, 0.02);
  EXPECT_LT(b.state.ledger.energy_drift / b.state.ledger.energy_scale, 1e-9);
  EXPECT_LT(b.state.ledger.p_drift / b.state.ledger.p_scale, 1e-11);
}

TEST(SurfaceContact, FrictionOnlyDissipatesEnergyOfABlock) {
  const double step = 4e-3;
  Block b = thrown(0.4, step);
  double energy = b.state.ledger.initial_energy, rise = 0.0;
  for (int k = 0; k < 150; ++k) {
    b.advance(step);
    const Balance e = b.stepper->balance(b.state);
    rise = std::max(rise, e.kinetic + e.potential - energy);
    energy = e.kinetic + e.potential;
  }
  EXPECT_LT(rise / b.state.ledger.energy_scale, 1e-9);
  EXPECT_GT(b.state.ledger.dissipated.value(), 1.0);
  EXPECT_LT(b.state.ledger.energy_drift / b.state.ledger.energy_scale, 1e-9);
}

/// A block and a free rigid ball collide in space.
// @tests{surface-squared-distances}
TEST(SurfaceContact, ABlockAndABallKeepEnergyAndMomenta) {
  const double step = 2e-3, l = 0.6;
  Block b({1.0, 1.0, 1.0}, {2, 2, 2}, {1, 1, 1}, [&](const Vec3& own) {
    return NodeData{.position = own + Vec3(0.0, 0.0, 1.2), .velocity = Vec3(0.1, 0.0, -1.0)};
  });
  b.add_elements("hex8_standard", 2e5, 0.3, 1000.0);
  BodyData ball{.name = "ball", .mass = 400.0, .inertia = Vec3(30, 40, 50).asDiagonal()};
  BodyMotion still;
  still.v = Vec3(0.0, 0.05, 0.5);
  still.W = Vec3(0.5, -0.3, 1.0);
  const int body = b.system.add_body(ball, still);
  surface_contact::SurfacePlace place;
  place.size = l;
  for (int k = 0; k < 4; ++k) {
    const Vec3 Z = k == 0 ? Vec3::Zero() : Vec3(l * Vec3::Unit(k - 1));
    place.nodes[static_cast<std::size_t>(k)] =
        b.system.add_node(NodeData{.position = Z, .body = body, .Z = Z});
    b.X.push_back(Z);
  }
  const surface_contact::RigidSurface sphere{.kind = surface_contact::RigidSurface::Kind::sphere,
                                             .radius = 0.6};
  b.touch(b.faces([](const Vec3& x) { return x[2] < -0.49; }), sphere, place,
          stiff(5e-3, 5e7, 0.3));
  b.start_run(step);
  double touched = 0.0;
  for (int k = 0; k < 150; ++k) {
    b.advance(step);
    if (b.report().area > 0.0) touched += step;
  }
  EXPECT_GT(touched, 0.005);
  EXPECT_LT(b.state.ledger.energy_drift / b.state.ledger.energy_scale, 1e-9);
  EXPECT_LT(b.state.ledger.p_drift / b.state.ledger.p_scale, 1e-11);
  EXPECT_LT(b.state.ledger.l_drift / b.state.ledger.l_scale, 1e-11);
}

class Zero final : public TimeFunction {
 public:
  [[nodiscard]] double operator()(double) const override { return 0.0; }
  [[nodiscard]] bool is_constant() const override { return true; }
};

class Pressure final : public TimeFunction {
 public:
  explicit Pressure(double p) : p_(p) {}
  [[nodiscard]] double operator()(double) const override { return p_; }
  [[nodiscard]] bool is_constant() const override { return true; }

 private:
  double p_;
};

/// A distorted mesh pressed on a plane: the contact pressure is uniform.
TEST(SurfaceContact, PassesThePatchTest) {
  const double p = 30.0;
  Block b({1.0, 1.2, 0.8}, {3, 3, 3}, {1, 1, 1}, [&](const Vec3& own) {
    Vec3 x = own;
    const bool inner = std::abs(own[0]) < 0.4 && std::abs(own[1]) < 0.5;
    if (inner) x += 0.05 * Vec3(std::sin(9 * own[1]), std::cos(7 * own[0]), 0.0);
    if (std::abs(own[2]) < 0.3) x[2] += 0.04 * std::sin(8 * own[0] + 5 * own[1]);
    return NodeData{.position = x + Vec3(0.0, 0.0, 0.4)};
  });
  b.add_elements("hex8_standard", 2000.0, 0.3, 1.0, "st_venant_kirchhoff");
  b.touch(b.faces([](const Vec3& x) { return x[2] < -0.39; }), {}, {}, stiff(1e-3, 1e5, 0.0));
  const solids::LoadedFaces top[] = {b.faces([](const Vec3& x) { return x[2] > 0.39; })};
  b.system.add_elements(
      solids::make_dead_pressure("loads.p", top, b.X, std::make_shared<Pressure>(p)));
  const auto zero = std::make_shared<Zero>();
  for (int i = 0; i < static_cast<int>(b.mesh.nodes.size()); ++i) {
    if (b.mesh.nodes[static_cast<std::size_t>(i)][0] < -0.49) b.system.prescribe(i, 0, zero);
    if (b.mesh.nodes[static_cast<std::size_t>(i)][1] < -0.59) b.system.prescribe(i, 1, zero);
  }
  b.system.finish();
  b.state = b.system.initial_state();
  const StaticReport report = solve_statics(b.system, b.state);
  ASSERT_TRUE(report.converged) << report.message;
  EXPECT_NEAR(b.report().largest_pressure / p, 1.0, 1e-10);
  EXPECT_NEAR(b.report().force[2] / (1.2 * p), 1.0, 1e-10);
  std::vector<ElementSample> samples(27);
  StepContext still;
  b.system.nodes().group(0).sample(node_instant(b.system, b.state, still),
                                   b.state.element_history.data(), samples);
  double area = 1.0;  // lateral stretches: dead pressure is per undeformed area
  for (const ElementSample& s : samples) {
    area = s.principal_stretches[0] * s.principal_stretches[1];
    EXPECT_NEAR(s.cauchy(2, 2) * area / p, -1.0, 1e-10);
    EXPECT_LT(std::abs(s.cauchy(0, 0)) / p, 1e-10);
  }
}

}  // namespace
}  // namespace polhode::test::surface_contact_tests
