// SPDX-License-Identifier: Apache-2.0
// A cable on the surface of a solid over one step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/math/cayley.hpp>
#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/system/nodes.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::cable_on_mesh_tests {
namespace {

constexpr double kTolerance = 0.2, kRadius = 0.6;

/// Nodes of 2 × 2 quadrilaterals with a valley along the middle line, followed by three nodes of a
/// cable along that line.
struct Scene : MovingNodes {
  solids::LoadedFaces faces{"quad4", {}};
};

/// @param depth   Of the valley; below zero it is a ridge.
/// @param height  Of the cable above its bottom.
Scene scene(unsigned seed, double rho_inf, double depth, double height, double way) {
  Random random(seed);
  Scene s;
  s.context = context_of(rho_inf);
  s.alpha_f = s.context.ga.alpha_f;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) s.X.emplace_back(i - 1.0, j - 1.0, j == 1 ? -depth : 0.0);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 2; ++i) {
      const int a = 3 * j + i;
      s.faces.nodes.insert(s.faces.nodes.end(), {a, a + 1, a + 4, a + 3});
    }
  for (const double x : {-0.9, -0.1, 0.8}) s.X.emplace_back(x, 0.05, height - depth);
  for (const Vec3& x : s.X) {
    const Vec3 at = x + random.vector(0.03), d = random.vector(way);
    for (int c = 0; c < 3; ++c) {
      s.x_n.push_back(at[c]);
      s.u.push_back(d[c]);
      s.x_n1.push_back(at[c] + d[c]);
    }
  }
  return s;
}

surface_contact::SolidContact contact_of(const Scene& s, double mu, double end_share = 0.0) {
  std::vector<surface_contact::MeshPoint> points;
  surface_contact::RoundLine line;
  line.radius = kRadius;
  for (int k = 0; k < 5; ++k) {
    surface_contact::MeshPoint& p = points.emplace_back();
    const int piece = 9 + std::min(k / 2, 1);
    const double part = 0.5 * (k - 2 * (piece - 9));
    p.add(piece, 1.0 - part);
    p.add(piece + 1, part);
    p.area = 0.3 + 0.1 * k;
    line.spans.push_back({piece, piece + 1, 0.5});
  }
  const std::vector<int> carriers(s.X.size(), kFreeNode);
  return {"c",
          std::move(points),
          surface_contact::triangulated({s.faces}),
          soft_law(kTolerance, mu, end_share),
          surface_contact::SolidContactStart{.X = s.X, .carriers = carriers, .edge = 3.0},
          std::move(line)};
}

struct Place {
  double depth, height;
};
/// Depth and height of the cable: over a ridge, over a nearly flat surface, in a shallow and in a
/// steep valley, where both slopes act.
const Place kPlaces[] = {{-0.5, 0.55}, {0.02, 0.55}, {0.1, 0.6}, {0.6, 0.75}};

// @tests{cable-on-mesh} @tests{cable-mesh-friction} @tests{four-point-distance}
// @tests{central-gap}
TEST(CableOnMesh, HasTheTangentOfItsForces) {
  for (const Place& place : kPlaces)
    for (const double rho_inf : {1.0, 0.5})
      for (const double mu : {0.0, 0.05, 5.0})
        for (const unsigned seed : {1U, 2U, 3U}) {
          SCOPED_TRACE(testing::Message()
                       << place.depth << " " << rho_inf << " " << mu << " " << seed);
          const Scene s = scene(seed, rho_inf, place.depth, place.height, 0.03);
          const surface_contact::SolidContact contact = contact_of(s, mu, mu == 0.0 ? 0.5 : 0.0);
          const std::vector<double> history = bristles(contact, s, seed);
          ASSERT_GT(forces(contact, s, history).norm(), 1e-2);
          expect_derivative(
              tangent(contact, s, history),
              [&](const Vec& d) -> Vec {
                Scene to = s;
                for (Eigen::Index k = 0; k < d.size(); ++k)
                  to.move(static_cast<std::size_t>(k), d[k]);
                return forces(contact, to, history);
              },
              "cable on a mesh", 1e-6, 1e-6);
        }
}

// @tests{cable-on-mesh} @tests{cable-mesh-friction}
TEST(CableOnMesh, BalancesWorkAndEnergyAndKeepsMomenta) {
  int valleys = 0;
  for (const Place& place : kPlaces)
    for (const double way : {0.02, 0.1, 0.3})
      for (const double mu : {0.0, 0.05, 5.0})
        for (const unsigned seed : {1U, 2U, 3U, 4U}) {
          SCOPED_TRACE(testing::Message() << place.depth << " " << way << " " << mu << " " << seed);
          const Scene s = scene(seed, 1.0, place.depth, place.height, way);
          const surface_contact::SolidContact contact = contact_of(s, mu);
          std::vector<double> history = bristles(contact, s, seed);
          std::vector<double> clearances;
          contact.clearances(s.step(), history.data(), clearances);
          if (*std::min_element(clearances.begin(), clearances.end()) <= 0.0) continue;
          const Vec f = forces(contact, s, history);
          const double work = f.dot(Eigen::Map<const Vec>(s.u.data(), f.size()));
          Scene still = s;
          still.context.dt = 0.0;
          const double before = contact.work(still.start(), history.data(), nullptr).stored;
          const Work w = contact.work(s.step(), history.data(), nullptr);
          const double size = 1.0 + before + w.stored;
          EXPECT_GE(w.dissipated, 0.0);
          EXPECT_NEAR(-work, w.stored - before + w.dissipated, 1e-11 * size);
          Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), on_cable = Vec3::Zero();
          for (int i = 0; 3 * i < f.size(); ++i) {
            const Vec3 one = f.segment<3>(3 * i);
            sum += one;
            moment += s.step().position_alpha(i).cross(one);
            if (i >= 9) on_cable += one;
          }
          EXPECT_LT(sum.norm(), 1e-12 * (1.0 + f.norm()));
          EXPECT_LT(moment.norm(), 1e-12 * (1.0 + f.norm()));
          contact.commit(s.step(), history.data(), nullptr);
          const surface_contact::SurfaceReport report = contact.report(history.data());
          EXPECT_NEAR(report.friction_loss + report.normal_loss, w.dissipated, 1e-12 * size);
          EXPECT_LT((report.force - on_cable).norm(), 1e-12 * (1.0 + f.norm()));
          still.x_n = s.x_n1;
          EXPECT_NEAR(contact.work(still.start(), history.data(), nullptr).stored, w.stored,
                      1e-12 * size);
          if (place.depth > 0.05) ++valleys;
        }
  EXPECT_GT(valleys, 20);
}

}  // namespace
}  // namespace polhode::test::cable_on_mesh_tests
