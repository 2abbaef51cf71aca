// SPDX-License-Identifier: Apache-2.0
// Contact of crossing lines of edges over one step.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/surface_contact/edge_contact.hpp>
#include <polhode/system/nodes.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::edge_contact_tests {
namespace {

constexpr double kTolerance = 0.1;

/// A line of three pieces along x and one of two pieces above, across it.
struct Scene {
  std::vector<Vec3> X;
  surface_contact::EdgeLines first, second;
  std::vector<double> x_n, x_n1, u;
  std::vector<int> carriers;
  StepContext context = context_of(1.0);

  [[nodiscard]] NodeStep step() const {
    return {x_n.data(), x_n1.data(), u.data(), u.data(), u.data(), context, 0.5, 1.0};
  }
  [[nodiscard]] NodeStep instant(bool end) const {
    const double* x = end ? x_n1.data() : x_n.data();
    return {x, x, u.data(), u.data(), u.data(), still, 1.0, 0.0};
  }
  void move(std::size_t k, double by) {
    x_n1[k] += by;
    u[k] += by;
  }
  [[nodiscard]] surface_contact::EdgeContact contact(double mu, bool self = false) const {
    surface_contact::SurfaceLaw law;
    law.normal.tolerance = kTolerance;
    law.normal.stiffness = 30.0;
    law.mu = mu;
    law.bristle = 40.0;
    return {"c",
            {first, self ? first : second, 0.7},
            law,
            surface_contact::SolidContactStart{
                .X = X, .carriers = carriers, .edge = 3.0, .self = self}};
  }
  StepContext still = [] {
    StepContext c = context_of(1.0);
    c.dt = 0.0;
    return c;
  }();
};

surface_contact::EdgeLines line(Scene& s, const std::vector<Vec3>& at) {
  surface_contact::EdgeLines lines;
  for (std::size_t k = 0; k < at.size(); ++k) {
    lines.vertices.emplace_back();
    lines.vertices.back().add(static_cast<int>(s.X.size()), 1.0);
    s.X.push_back(at[k]);
    if (k > 0) lines.edges.push_back({static_cast<int>(k) - 1, static_cast<int>(k)});
  }
  return lines;
}

/// Two lines that cross at x of the first; `rough` is the size of random displacements of nodes.
Scene scene(double x, double rough, double way, unsigned seed = 1) {
  Scene s;
  s.first = line(s, {{-1.5, 0, 0}, {-0.5, 0, 0}, {0.5, 0, 0}, {1.5, 0, 0}});
  s.second = line(s, {{x - 0.3, -1, 0.1}, {x, 0, 0.1}, {x + 0.3, 1, 0.1}});
  Random random(seed);
  for (const Vec3& X : s.X) {
    const Vec3 at = X + random.vector(rough), d = random.vector(way);
    for (int c = 0; c < 3; ++c) {
      s.x_n.push_back(at[c]);
      s.u.push_back(d[c]);
      s.x_n1.push_back(at[c] + d[c]);
    }
    s.carriers.push_back(kFreeNode);
  }
  return s;
}

std::vector<double> history_of(const surface_contact::EdgeContact& contact) {
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  history.back() = 0.0;  // the whole band, from any initial gap
  return history;
}

Vec forces(const surface_contact::EdgeContact& contact, const Scene& s,
           const std::vector<double>& history) {
  return forces_over(s.step(), s.x_n.size(), contact, history);
}

/// Stored energy at any crossing point, at a node of either line or between nodes: it is the same.
TEST(EdgeContact, HasTheSameEnergyAlongALine) {
  double first = 0.0;
  for (const double x : {0.1, 0.2, 0.4999, 0.5, 0.5001, 0.503, 0.6, -0.5}) {
    const Scene s = scene(x, 0.0, 0.0);
    const surface_contact::EdgeContact contact = s.contact(0.0);
    const double stored = contact.work(s.instant(true), history_of(contact).data(), nullptr).stored;
    if (first == 0.0) first = stored;
    EXPECT_NEAR(stored / first, 1.0, 1e-12) << x;
  }
  EXPECT_NEAR(first, 0.7 * scene(0, 0, 0).contact(0.0).law().normal.energy(0.0), 1e-12);
}

TEST(EdgeContact, LeavesParallelEdgesToPointContact) {
  Scene s;
  s.first = line(s, {{0, 0, 0}, {1, 0, 0}});
  s.second = line(s, {{0.2, 0, 0.1}, {1.2, 0.03, 0.1}});
  for (const Vec3& X : s.X) {
    for (int c = 0; c < 3; ++c) s.x_n.push_back(X[c]), s.u.push_back(0.0), s.x_n1.push_back(X[c]);
    s.carriers.push_back(kFreeNode);
  }
  const surface_contact::EdgeContact contact = s.contact(0.3);
  const std::vector<double> history = history_of(contact);
  EXPECT_EQ(contact.candidates(history.data()), 1);
  EXPECT_EQ(contact.work(s.instant(true), history.data(), nullptr).stored, 0.0);
  EXPECT_EQ(forces(contact, s, history).norm(), 0.0);
  EXPECT_FALSE(contact.overlap(s.instant(true)));
  EXPECT_TRUE(std::isnan(contact.report(history.data()).least_gap));
}

TEST(EdgeContact, HasTheTangentOfItsForces) {
  for (const double mu : {0.0, 0.1, 10.0})
    for (const unsigned seed : {1U, 2U, 3U}) {
      SCOPED_TRACE(testing::Message() << mu << " " << seed);
      const Scene s = scene(0.52, 0.04, 0.03, seed);
      const surface_contact::EdgeContact contact = s.contact(mu);
      const std::vector<double> history = history_of(contact);
      ASSERT_GT(forces(contact, s, history).norm(), 1e-2);
      expect_derivative(
          tangent_over(s.step(), s.x_n.size(), contact, history),
          [&](const Vec& d) -> Vec {
            Scene to = s;
            for (Eigen::Index k = 0; k < d.size(); ++k) to.move(static_cast<std::size_t>(k), d[k]);
            return forces(contact, to, history);
          },
          "edges", 1e-6, 1e-6);
    }
}

/// Several steps in sequence, each with the history of the last one.
TEST(EdgeContact, BalancesWorkAndEnergyAndKeepsMomenta) {
  for (const double mu : {0.0, 0.1, 10.0})
    for (const unsigned seed : {1U, 2U, 3U, 4U}) {
      SCOPED_TRACE(testing::Message() << mu << " " << seed);
      Scene s = scene(0.45, 0.04, 0.02, seed);
      const surface_contact::EdgeContact contact = s.contact(mu);
      std::vector<double> history = history_of(contact);
      Random random(seed + 10);
      double reported = 0.0;
      for (int k = 0; k < 6; ++k) {
        const Vec f = forces(contact, s, history);
        ASSERT_GT(f.norm(), 1e-3);
        const double work = f.dot(Eigen::Map<const Vec>(s.u.data(), f.size()));
        const double before = contact.work(s.instant(false), history.data(), nullptr).stored;
        const Work w = contact.work(s.step(), history.data(), nullptr);
        EXPECT_GE(w.dissipated, 0.0);
        EXPECT_NEAR(-work, w.stored - before + w.dissipated, 1e-12);
        if (mu == 0.0) {
          EXPECT_EQ(w.dissipated, 0.0);
        }
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), on_first = Vec3::Zero();
        for (int i = 0; 3 * i < f.size(); ++i) {
          const Vec3 one = f.segment<3>(3 * i);
          sum += one;
          moment += s.step().position_alpha(i).cross(one);
          if (i < 4) on_first += one;
        }
        EXPECT_LT(sum.norm(), 1e-12);
        EXPECT_LT(moment.norm(), 1e-12);
        contact.commit(s.step(), history.data(), nullptr);
        const surface_contact::SurfaceReport r = contact.report(history.data());
        reported += w.dissipated;
        EXPECT_NEAR(r.friction_loss, reported, 1e-13);
        EXPECT_LT((r.force - on_first).norm(), 1e-12);
        EXPECT_NEAR(contact.work(s.instant(true), history.data(), nullptr).stored, w.stored, 1e-12);
        const std::vector<surface_contact::SurfacePointReport> points =
            contact.point_reports(s.instant(true), history.data());
        EXPECT_FALSE(points.empty());
        s.x_n = s.x_n1;
        for (std::size_t i = 0; i < s.u.size(); ++i) {
          s.u[i] = random.number(0.01);
          s.x_n1[i] = s.x_n[i] + s.u[i];
        }
      }
    }
}

TEST(EdgeContact, LimitsADisplacementThatWouldCross) {
  Scene s = scene(0.2, 0.0, 0.0);
  const surface_contact::EdgeContact contact = s.contact(0.0);
  const std::vector<double> history = history_of(contact);
  Scene to = s;
  for (std::size_t i = 4; i < 7; ++i) to.x_n1[3 * i + 2] -= 0.4;  // 0.3 beyond the other line
  const double part = contact.free_part(s.instant(true), to.instant(true), history.data());
  EXPECT_LT(part, 0.25);
  EXPECT_GT(part, 0.2);  // a tenth of the gap remains
  for (std::size_t i = 4; i < 7; ++i) to.x_n1[3 * i + 2] = 0.5;
  EXPECT_EQ(contact.free_part(s.instant(true), to.instant(true), history.data()), 1.0);
}

TEST(EdgeContact, OfOneLineLeavesOutNeighbours) {
  Scene s;  // a loop that crosses itself
  s.first = line(s, {{-1, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0.5}, {0, -1, 0.5}});
  for (const Vec3& X : s.X) {
    for (int c = 0; c < 3; ++c) s.x_n.push_back(X[c]), s.u.push_back(0.0);
    s.carriers.push_back(kFreeNode);
  }
  s.x_n1 = s.x_n;
  const surface_contact::EdgeContact contact = s.contact(0.0, true);
  const std::vector<double> history = history_of(contact);
  EXPECT_EQ(contact.candidates(history.data()), 2);  // three pairs are neighbours, one is far away
  s.x_n1[3 * 3 + 2] = s.x_n1[3 * 4 + 2] = 0.1;
  EXPECT_NEAR(contact.work(s.instant(true), history.data(), nullptr).stored,
              0.7 * contact.law().normal.energy(0.0), 1e-12);
}

TEST(EdgeLines, AreSharpEdgesOfACubeAndTheBorderOfAPlate) {
  std::vector<Vec3> X;
  for (int k = 0; k < 8; ++k) X.emplace_back(k & 1, (k >> 1) & 1, k >> 2);
  const surface_contact::MeshSurface cube = surface_contact::triangulated(
      {{"quad4", {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5}}});
  const surface_contact::EdgeLines edges = surface_contact::sharp_edges(cube, X);
  EXPECT_EQ(edges.edges.size(), 12U);
  EXPECT_EQ(edges.vertices.size(), 8U);
  for (const double part : edges.shared()) EXPECT_DOUBLE_EQ(part, 2.0 / 3.0);
  EXPECT_EQ(
      surface_contact::sharp_edges(surface_contact::triangulated({{"quad4", {0, 2, 3, 1}}}), X)
          .edges.size(),
      4U);
  // With reversed orientation the cube is a cavity without convex edges.
  const surface_contact::MeshSurface hollow = surface_contact::triangulated(
      {{"quad4", {1, 3, 2, 0, 6, 7, 5, 4, 4, 5, 1, 0, 3, 7, 6, 2, 2, 6, 4, 0, 5, 7, 3, 1}}});
  EXPECT_TRUE(surface_contact::sharp_edges(hollow, X).edges.empty());
}

}  // namespace
}  // namespace polhode::test::edge_contact_tests
