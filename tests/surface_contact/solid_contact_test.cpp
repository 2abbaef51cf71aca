// SPDX-License-Identifier: Apache-2.0
// Contact between surfaces of solids over one step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/system/nodes.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::solid_contact_tests {
namespace {

constexpr double kTolerance = 0.3;

/// Nodes of two moving plates of faces: the upper one has the contact points, the lower one the
/// triangles.
struct Scene : MovingNodes {
  std::vector<solids::LoadedFaces> lower, upper;
  std::vector<int> carriers;
  [[nodiscard]] surface_contact::SolidContact contact(const surface_contact::SurfaceLaw& law,
                                                      double edge = 3.0, bool cells = false) const {
    const surface_contact::MeshSurface below = surface_contact::triangulated(lower);
    return {"c", surface_contact::contact_points("c", upper, X, cells ? &below : nullptr), below,
            law, surface_contact::SolidContactStart{.X = X, .carriers = carriers, .edge = edge}};
  }
};

/// n × n quadrilaterals of a square of the size 2 in the plane z.
solids::LoadedFaces plate(Scene& s, int n, double z, bool up, const Vec3& shift = Vec3::Zero()) {
  solids::LoadedFaces faces{"quad4", {}};
  const int first = static_cast<int>(s.X.size());
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      s.X.emplace_back(Vec3(2.0 * i / n - 1.0, 2.0 * j / n - 1.0, z) + shift);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = first + j * (n + 1) + i;
      if (up)
        faces.nodes.insert(faces.nodes.end(), {a, a + 1, a + n + 2, a + n + 1});
      else
        faces.nodes.insert(faces.nodes.end(), {a, a + n + 1, a + n + 2, a + 1});
    }
  return faces;
}

void settle(Scene& s, Random& random, double rough, double way) {
  for (const Vec3& x : s.X) {
    const Vec3 at = x + random.vector(rough), d = random.vector(way);
    for (int c = 0; c < 3; ++c) {
      s.x_n.push_back(at[c]);
      s.u.push_back(d[c]);
      s.x_n1.push_back(at[c] + d[c]);
    }
    s.carriers.push_back(kFreeNode);
  }
}

Scene scene(unsigned seed, double rho_inf, double way = 0.12) {
  Random random(seed);
  Scene s;
  s.context = context_of(rho_inf);
  s.alpha_f = s.context.ga.alpha_f;
  s.lower = {plate(s, 2, 0.0, true)};
  s.upper = {plate(s, 1, 0.35, false, Vec3(0.15, 0.1, 0.0))};
  settle(s, random, 0.05, way);
  return s;
}

surface_contact::SurfaceLaw law(double mu, double end_share = 0.0) {
  return soft_law(kTolerance, mu, end_share);
}

// @tests{patch-force} @tests{mesh-friction}
TEST(SolidContact, HasTheTangentOfItsForces) {
  for (const double rho_inf : {1.0, 0.5})
    for (const double mu : {0.0, 0.05, 5.0})
      for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(testing::Message() << rho_inf << " " << mu << " " << seed);
        const Scene s = scene(seed, rho_inf);
        const surface_contact::SolidContact contact = s.contact(law(mu, mu == 0.0 ? 0.5 : 0.0));
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
            "contact of solids", 1e-6, 1e-6);
      }
}

// Continuity of the force where a point slides from one triangle to the next: along a path of half
// a plate its changes between positions halve with their distance.
// @tests{mesh-friction}
TEST(SolidContact, HasContinuousFrictionAcrossTriangles) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Scene s = scene(seed, 1.0);
    const surface_contact::SolidContact contact = s.contact(law(0.5));
    const std::vector<double> history = bristles(contact, s, seed);
    const auto first = 3 * static_cast<std::size_t>(s.upper.front().nodes.front());
    const auto at = [&](double part) {
      Scene to = s;
      for (std::size_t k = first; k < to.X.size() * 3; k += 3) to.move(k, 0.6 * part);
      return forces(contact, to, history);
    };
    const auto largest_change = [&](int places) {
      double most = 0.0;
      Vec before = at(0.0);
      for (int i = 1; i <= places; ++i) {
        const Vec here = at(static_cast<double>(i) / places);
        most = std::max(most, (here - before).norm());
        before = here;
      }
      return most;
    };
    EXPECT_LT(largest_change(3200), 0.6 * largest_change(1600)) << seed;
  }
}

// @tests{mesh-contact} @tests{patch-force}
TEST(SolidContact, BalancesWorkAndEnergyAndKeepsMomenta) {
  for (const double way : {0.02, 0.12, 0.5})
    for (const double mu : {0.0, 0.05, 5.0})
      for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        SCOPED_TRACE(testing::Message() << way << " " << mu << " " << seed);
        const Scene s = scene(seed, 1.0, way);
        const surface_contact::SolidContact contact = s.contact(law(mu));
        std::vector<double> history = bristles(contact, s, seed);
        const Vec f = forces(contact, s, history);
        ASSERT_GT(f.norm(), 1e-3);
        const double work = f.dot(Eigen::Map<const Vec>(s.u.data(), f.size()));
        Scene still = s;
        still.context.dt = 0.0;
        const double before = contact.work(still.start(), history.data(), nullptr).stored;
        const Work w = contact.work(s.step(), history.data(), nullptr);
        EXPECT_GE(w.dissipated, 0.0);
        EXPECT_NEAR(-work, w.stored - before + w.dissipated, 1e-11);
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        for (int i = 0; 3 * i < f.size(); ++i) {
          const Vec3 one = f.segment<3>(3 * i);
          sum += one;
          moment += s.step().position_alpha(i).cross(one);
        }
        EXPECT_LT(sum.norm(), 1e-12);
        EXPECT_LT(moment.norm(), 1e-12);
        contact.commit(s.step(), history.data(), nullptr);
        const surface_contact::SurfaceReport report = contact.report(history.data());
        EXPECT_NEAR(report.friction_loss + report.normal_loss, w.dissipated, 1e-13);
        Vec3 on_upper = Vec3::Zero();
        for (int i = 9; i < 13; ++i) on_upper += f.segment<3>(3 * i);
        EXPECT_LT((report.force - on_upper).norm(), 1e-12);
        still.x_n = s.x_n1;
        EXPECT_NEAR(contact.work(still.start(), history.data(), nullptr).stored, w.stored, 1e-12);
      }
}

TEST(SolidContact, KeepsMomentaWithNumericalDamping) {
  const Scene s = scene(5, 0.5);
  const surface_contact::SolidContact contact = s.contact(law(0.3, 0.5));
  const Vec f = forces(contact, s, bristles(contact, s, 5));
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; 3 * i < f.size(); ++i) {
    const Vec3 one = f.segment<3>(3 * i);
    sum += one;
    moment += s.step().position_alpha(i).cross(one);
  }
  EXPECT_GT(f.norm(), 1e-2);
  EXPECT_LT(sum.norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-12);
}

/// Plates of three and of four elements, parallel: a uniform gap loads every node with its part of
/// the pressure.
TEST(SolidContact, LoadsMeshesThatDoNotMatchEvenly) {
  Scene s;
  s.context = context_of(1.0);
  s.lower = {plate(s, 3, 0.0, true)};
  s.upper = {plate(s, 4, 0.05, false)};
  Random random(1);
  settle(s, random, 0.0, 0.0);
  const surface_contact::SolidContact contact = s.contact(law(0.0), 0.5, true);
  const Vec f = forces(contact, s, with_whole_bands(contact, s));
  const double p = law(0.0).normal.force(0.05 - kTolerance);
  double area = 0.0;
  for (const surface_contact::MeshPoint& point : contact.points()) area += point.area;
  EXPECT_NEAR(area, 4.0, 1e-13);
  const auto expect = [&](int first, int n, double sign) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        const double share = (i % n == 0 ? 0.5 : 1.0) * (j % n == 0 ? 0.5 : 1.0) * 4.0 / (n * n);
        EXPECT_NEAR(f[3 * (first + j * (n + 1) + i) + 2], sign * p * share, 1e-12 * p);
      }
  };
  expect(0, 3, -1.0);
  expect(16, 4, 1.0);
}

// @tests{surface-start}
TEST(SolidContact, StoresNoEnergyAtItsStartUntilItHasOpened) {
  Scene s;
  s.context = context_of(1.0);
  s.lower = {plate(s, 3, 0.0, true)};
  s.upper = {plate(s, 4, 0.4, false)};  // a third of its tolerance above the middle of the band
  Random random(1);
  settle(s, random, 0.0, 0.0);
  const surface_contact::SolidContact contact = s.contact(law(0.0), 3.0, true);
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  const auto stored = [&] {
    Scene still = s;
    still.context.dt = 0.0;
    return contact.work(still.start(), history.data(), nullptr).stored;
  };
  // Step to another height; returns the force on the upper plate.
  const auto go = [&](double z) {
    s.x_n = s.x_n1;
    std::fill(s.u.begin(), s.u.end(), 0.0);
    for (std::size_t i = 16; i < s.X.size(); ++i) s.move(3 * i + 2, z - s.x_n[3 * i + 2]);
    const Vec f = forces(contact, s, history);
    const double before = stored(), up = -f[3 * 16 + 2] / law(0.0).normal.force(0.1);
    double work = 0.0;
    for (Eigen::Index k = 0; k < f.size(); ++k) work += f[k] * s.u[static_cast<std::size_t>(k)];
    EXPECT_NEAR(contact.work(s.step(), history.data(), nullptr).stored - before, -work, 1e-12);
    contact.commit(s.step(), history.data(), nullptr);
    s.x_n = s.x_n1;
    return std::abs(up);
  };
  EXPECT_EQ(stored(), 0.0);
  EXPECT_EQ(forces(contact, s, history).norm(), 0.0);
  EXPECT_GT(go(0.3), 0.0);
  EXPECT_GT(stored(), 0.0);
  EXPECT_GT(go(0.4), 0.0) << "while opening";
  EXPECT_EQ(stored(), 0.0);
  EXPECT_EQ(go(0.59), 0.0) << "still within the band of others";
  EXPECT_EQ(go(0.4), 0.0);
  EXPECT_EQ(go(0.61), 0.0);
  EXPECT_GT(go(0.4), 0.0) << "closed again after opening";
  EXPECT_NEAR(stored(), 4.0 * law(0.0).normal.energy(0.1), 1e-12);
}

TEST(SolidContact, StopsPointsThatWouldPassThrough) {
  Scene s = scene(1, 1.0, 0.0);
  surface_contact::SurfaceLaw l = law(0.0);
  l.normal.tolerance = 0.01;
  const surface_contact::SolidContact contact = s.contact(l, 1000.0);
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  const auto part = [&](const Vec3& way) {
    Scene to = s;
    for (std::size_t i = 9; i < 13; ++i)
      for (std::size_t c = 0; c < 3; ++c) to.move(3 * i + c, way[static_cast<int>(c)]);
    return contact.free_part(to.start(), to.step(), history.data());
  };
  EXPECT_EQ(part({0, 0, 5.0}), 1.0);
  EXPECT_EQ(part({0.3, 0, -0.1}), 1.0);
  const double most = part({0, 0, -100.0});
  EXPECT_GT(most, 0.002);
  EXPECT_LT(most, 0.0045);
  // A displacement beyond the search radius of triangles.
  const surface_contact::SolidContact near = s.contact(l, 1.0);
  std::vector<double> short_sight(near.history_size());
  near.initialize(short_sight.data());
  Scene to = s;
  for (std::size_t i = 9; i < 13; ++i) to.move(3 * i, 10.0);
  EXPECT_LT(near.free_part(to.start(), to.step(), short_sight.data()), 0.03);
}

TEST(SolidContact, ReportsOverlaps) {
  for (const double z : {0.5, 0.05, 0.0, -0.02}) {
    Scene s;
    s.context = context_of(1.0);
    s.lower = {plate(s, 2, 0.0, true)};
    s.upper = {plate(s, 1, z, false)};
    Random random(1);
    settle(s, random, 0.0, 0.0);
    surface_contact::SurfaceLaw l = law(0.0);
    l.normal.tolerance = 0.01;
    const std::optional<surface_contact::SurfaceOverlap> found = s.contact(l).overlap(s.start());
    ASSERT_EQ(found.has_value(), z < 0.01) << z;
    if (!found) continue;
    EXPECT_NEAR(found->depth, -z, 1e-12);
    EXPECT_LT((found->out - Vec3::UnitZ()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace polhode::test::solid_contact_tests
