// SPDX-License-Identifier: Apache-2.0
// Contact of solids' surfaces with rigid surfaces over one step.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/contact/round_solids/cone.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/core/error.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/surface_contact/surface_contact.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::surface_contact_tests {
namespace {

constexpr double kTolerance = 0.6;  ///< Of the gap; the steps of the tests stay in this band.

/// Nodes that move over a step; the last four, if any, carry the rigid surface.
struct Nodes {
  std::vector<double> x_n, x_n1, u, v;
  StepContext context;
  double alpha_f = 0.5;

  void add(const Vec3& at, const Vec3& move) {
    for (int i = 0; i < 3; ++i) {
      x_n.push_back(at[i]);
      x_n1.push_back(at[i] + move[i]);
      u.push_back(move[i]);
      v.push_back(0.0);
    }
  }
  [[nodiscard]] NodeStep step() const {
    return {x_n.data(), x_n1.data(), u.data(), v.data(), v.data(), context, alpha_f, 1.0};
  }
  [[nodiscard]] std::vector<Vec3> start_positions() const {
    std::vector<Vec3> X;
    for (std::size_t k = 0; k < x_n.size(); k += 3)
      X.push_back(NodeStep::at(x_n.data(), static_cast<int>(k / 3)));
    return X;
  }
  [[nodiscard]] NodeStep start() const {
    return {x_n.data(), x_n.data(), u.data(), v.data(), v.data(), context, 1.0, 0.0};
  }
};

struct Case {
  const char* name;
  surface_contact::RigidSurface surface;
  Vec3 near;  ///< A point of its surface.
};

surface_contact::RigidSurface around(const geometry::Shape& shape) {
  return {.kind = surface_contact::RigidSurface::Kind::convex,
          .solid = std::make_shared<geometry::Shape>(shape)};
}

/// The box of the cases as a convex hull.
std::vector<Vec3> brick_corners() {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back(k & 1 ? 2.0 : -2.0, k & 2 ? 3.0 : -3.0, k & 4 ? 2.5 : -2.5);
  return corners;
}
geometry::Shape brick() { return geometry::hull("brick", brick_corners(), {}, kTolerance); }

surface_contact::RigidSurface of_triangles(const geometry::Shape& shape) {
  return {.kind = surface_contact::RigidSurface::Kind::mesh,
          .triangles = std::make_shared<surface_contact::RigidMesh>(shape)};
}

surface_contact::RigidSurface brick_of_triangles() {
  return of_triangles(
      geometry::mesh("brick", geometry::convex_hull("brick", brick_corners()), {}, kTolerance));
}

/// A valley along y between two slopes of 1:2.
surface_contact::RigidSurface valley() {
  std::vector<double> heights;
  for (int i = 0; i < 25; ++i) heights.push_back(1.5 * std::abs(i % 5 - 2));
  return of_triangles(geometry::height_field("valley", 5, 3.0, heights, {}, kTolerance));
}

std::vector<Case> cases() {
  using enum surface_contact::RigidSurface::Kind;
  return {{"plane", {.kind = plane}, Vec3(0.3, 0.2, 0.0)},
          {"sphere", {.kind = sphere, .radius = 2.0}, Vec3(1.2, 0.0, 1.6)},
          {"hollow_sphere", {.kind = hollow_sphere, .radius = 2.0}, Vec3(1.2, 0.0, 1.6)},
          {"capsule", {.kind = capsule, .radius = 2.0, .half = {0, 0, 1.0}}, Vec3(1.2, 1.6, 0.3)},
          {"cylinder_side",
           {.kind = cylinder, .radius = 3.0, .half = {0, 0, 2.0}, .rounding = kTolerance},
           Vec3(1.8, 2.4, 0.3)},
          {"cylinder_end",
           {.kind = cylinder, .radius = 3.0, .half = {0, 0, 2.0}, .rounding = kTolerance},
           Vec3(0.4, 0.3, 2.0)},
          {"box_face",
           {.kind = box, .half = {2.0, 3.0, 2.5}, .rounding = kTolerance},
           Vec3(2.0, 0.5, 0.2)},
          {"box_edge",
           {.kind = box, .half = {2.0, 3.0, 2.5}, .rounding = kTolerance},
           Vec3(1.85, 2.85, 0.2)},
          {"ellipsoid", around(contact::ellipsoid("e", {4.0, 6.0, 5.0})), Vec3(1.2, 0.0, 2.0)},
          {"cone_flank", around(contact::cone("c", 6.0, 6.0, {}, kTolerance)), Vec3(0.9, 1.2, 0.0)},
          {"cone_base", around(contact::cone("c", 6.0, 6.0, {}, kTolerance)), Vec3(0.6, 0.8, -3.0)},
          {"hull_face", around(brick()), Vec3(2.0, 0.5, 0.2)},
          {"hull_edge", around(brick()), Vec3(1.85, 2.85, 0.2)},
          {"mesh_face", brick_of_triangles(), Vec3(2.0, 0.5, 0.2)},
          {"mesh_edge", brick_of_triangles(), Vec3(1.85, 2.85, 0.2)},
          {"mesh_corner", brick_of_triangles(), Vec3(1.75, 2.75, 2.25)},
          {"valley_slope", valley(), Vec3(1.5, 0.4, 0.75)},
          {"valley_bottom", valley(), Vec3(0.02, 0.4, 0.05)}};
}

struct Scene {
  Nodes nodes;
  std::vector<Vec3> X;
  surface_contact::SurfacePlace place;
  solids::LoadedFaces faces;
};

/// A face whose nodes come close to the surface, on the ground or on a body
/// that tumbles.
Scene scene(const Case& c, const std::string& shape, bool on_body, unsigned seed,
            const StepContext& context) {
  Random random(seed);
  Scene s;
  s.nodes.context = context;
  s.nodes.alpha_f = context.ga.alpha_f;
  const Mat3 R = random.frame();
  const Vec3 origin = random.vector(), move = random.vector(0.1), theta = random.vector(0.1);
  const Mat3 R_1 = on_body ? Mat3(cay(theta) * R) : R;
  const Vec3 origin_1 = on_body ? Vec3(origin + move) : origin;
  const int n = shape == "quad4" ? 4 : shape == "rope" ? 2 : 6;
  const double corner[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
  const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int a = 0; a < n; ++a) {
    const auto& at = shape == "quad4" ? square[a] : corner[a];
    s.X.emplace_back(0.1 * at[0], 0.1 * at[1], 0.0);
    const Vec3 y = c.near + Vec3(0.1 * at[0], 0.1 * at[1], 0.0) + random.vector(0.03);
    const Vec3 x = origin + R * y, x_1 = origin_1 + R_1 * (y + random.vector(0.1));
    s.nodes.add(x, x_1 - x);
    s.faces.nodes.push_back(a);
  }
  s.faces.shape = shape;
  s.place.origin = origin;
  s.place.axes = R;
  s.place.size = 1.5;
  if (!on_body) return s;
  for (int k = 0; k < 4; ++k) {
    const Vec3 z = k == 0 ? Vec3::Zero() : Vec3(1.5 * Vec3::Unit(k - 1));
    const Vec3 x = origin + R * z, x_1 = origin_1 + R_1 * z;
    s.place.nodes[static_cast<std::size_t>(k)] = n + k;
    s.nodes.add(x, x_1 - x);
  }
  return s;
}

surface_contact::SurfaceLaw law(double mu, double end_share = 0.0) {
  return soft_law(kTolerance, mu, end_share);
}

Vec forces(const surface_contact::SurfaceContact& contact, const Nodes& nodes,
           const std::vector<double>& history) {
  return forces_over(nodes.step(), nodes.x_n.size(), contact, history);
}

/// The matrix, by blocks of (point, i, j) like the sink of the solver.
Mat tangent(const surface_contact::SurfaceContact& contact, const Nodes& nodes,
            const std::vector<double>& history) {
  const int count = static_cast<int>(nodes.x_n.size() / 3), n = contact.nodes_per_element();
  std::vector<int> slots;
  for (int e = 0; e < contact.size(); ++e)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        slots.push_back(contact.nodes(e)[static_cast<std::size_t>(i)] * count +
                        contact.nodes(e)[static_cast<std::size_t>(j)]);
  std::vector<double> blocks(static_cast<std::size_t>(9 * count * count), 0.0);
  Vec f = Vec::Zero(3 * count);
  contact.evaluate(nodes.step(), history.data(), nullptr, Mat3::Identity(),
                   ElementSink{f.data(), blocks.data(), slots.data()});
  Mat K(3 * count, 3 * count);
  for (int i = 0; i < count; ++i)
    for (int j = 0; j < count; ++j)
      for (int r = 0; r < 3; ++r)
        for (int s = 0; s < 3; ++s)
          K(3 * i + r, 3 * j + s) =
              blocks[static_cast<std::size_t>(9 * (i * count + j) + 3 * r + s)];
  return K;
}

/// Size of a point's history, and the place of the amount by which its band is lowered; the bristle
/// comes first.
constexpr std::size_t kNumbers = 14, kLowered = 11;

/// History at the start, with the whole band for points that start within it.
std::vector<double> with_whole_bands(const surface_contact::SurfaceContact& contact) {
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  for (std::size_t i = 0; i < static_cast<std::size_t>(contact.size()); ++i)
    history[kNumbers * i + kLowered] = 0.0;
  return history;
}

std::vector<double> bristles(const surface_contact::SurfaceContact& contact, unsigned seed) {
  Random random(seed);
  std::vector<double> history = with_whole_bands(contact);
  for (std::size_t i = 0; i < kNumbers * static_cast<std::size_t>(contact.size()); ++i)
    if (i % kNumbers < 3) history[i] = 0.05 * random.number();
  return history;
}

/// Contact points of the faces, or, with two nodes, of a rope between them.
surface_contact::SurfacePoints points_of(const Scene& s) {
  if (s.faces.shape != "rope") return surface_contact::surface_points("c", s.faces, s.X);
  surface_contact::SurfacePoints rope;
  rope.nodes_per_point = 2;
  rope.radius = 0.2;
  for (const double t : {0.0, 0.3, 1.0}) {
    rope.points.push_back({0.02 + 0.01 * t, {1.0 - t, t}});
    rope.nodes.insert(rope.nodes.end(), {0, 1});
  }
  return rope;
}

template <class What>
void for_scenes(const surface_contact::SurfaceLaw& l, double rho_inf, What&& what) {
  for (const Case& c : cases())
    for (const char* shape : {"quad4", "tri6", "rope"})
      for (const bool on_body : {false, true})
        for (const unsigned seed : {1U}) {
          SCOPED_TRACE(std::string(c.name) + " " + shape + (on_body ? " on a body" : ""));
          const Scene s = scene(c, shape, on_body, seed, context_of(rho_inf));
          const surface_contact::SurfaceContact contact(
              "c", points_of(s), s.nodes.start_positions(), c.surface, s.place, l);
          what(contact, s, bristles(contact, seed));
        }
}

// @tests{surface-gap} @tests{surface-action}
TEST(SurfaceContact, HasTheTangentOfItsForces) {
  for (const double rho_inf : {1.0, 0.5})
    for (const double mu : {0.0, 0.05, 5.0})
      for_scenes(
          law(mu, mu == 0.0 ? 0.5 : 0.0), rho_inf,
          [](const surface_contact::SurfaceContact& contact, const Scene& s, const auto& history) {
            // Free nodes move independently, those of the frame as a rigid body.
            const auto n = static_cast<Eigen::Index>(s.X.size());
            const Eigen::Index columns = 3 * n + (contact.external() ? 0 : 6);
            const auto moved = [&](const Vec& d) {
              Nodes to = s.nodes;
              const auto place = [&](Eigen::Index node, const Vec3& x) {
                for (int i = 0; i < 3; ++i) {
                  const auto k = static_cast<std::size_t>(3 * node + i);
                  to.x_n1[k] = x[i];
                  to.u[k] = x[i] - to.x_n[k];
                }
              };
              const auto at = [&](Eigen::Index node) {
                return Vec3(NodeStep::at(s.nodes.x_n1.data(), static_cast<int>(node)));
              };
              for (Eigen::Index a = 0; a < n; ++a) place(a, at(a) + Vec3(d.segment<3>(3 * a)));
              if (contact.external()) return to;
              const Mat3 turn = cay(Vec3(d.tail<3>()));
              const Vec3 origin = at(n);
              for (Eigen::Index k = 0; k < 4; ++k)
                place(n + k, origin + Vec3(d.segment<3>(3 * n)) + turn * (at(n + k) - origin));
              return to;
            };
            Mat motion = Mat::Identity(static_cast<Eigen::Index>(s.nodes.x_n.size()), columns);
            if (!contact.external()) {
              motion.bottomRows(12).setZero();
              const Vec3 origin = NodeStep::at(s.nodes.x_n1.data(), static_cast<int>(n));
              for (Eigen::Index k = 0; k < 4; ++k) {
                const Vec3 z = NodeStep::at(s.nodes.x_n1.data(), static_cast<int>(n + k)) - origin;
                motion.block<3, 3>(3 * (n + k), 3 * n) = Mat3::Identity();
                motion.block<3, 3>(3 * (n + k), 3 * n + 3) = -hat(z);
              }
            }
            expect_derivative(
                tangent(contact, s.nodes, history) * motion,
                [&](const Vec& d) -> Vec { return forces(contact, moved(d), history); },
                "surface contact", 1e-6, 1e-6);
          });
}

// @tests{surface-squared-distances}
TEST(SurfaceContact, BalancesWorkWithStoredAndDissipatedEnergy) {
  for (const double mu : {0.0, 0.05, 5.0})
    for_scenes(
        law(mu), 1.0,
        [](const surface_contact::SurfaceContact& contact, const Scene& s, auto history) {
          const Vec f = forces(contact, s.nodes, history);
          ASSERT_GT(f.norm(), 1e-3);
          const double work =
              f.dot(Eigen::Map<const Vec>(s.nodes.u.data(), static_cast<Eigen::Index>(f.size())));
          Nodes still = s.nodes;
          still.context.dt = 0.0;
          const double before = contact.work(still.start(), history.data(), nullptr).stored;
          const Work w = contact.work(s.nodes.step(), history.data(), nullptr);
          EXPECT_GE(w.dissipated, 0.0);
          EXPECT_NEAR(-work, w.stored - before + w.dissipated, 1e-12);
          contact.commit(s.nodes.step(), history.data(), nullptr);
          const surface_contact::SurfaceReport report = contact.report(history.data());
          EXPECT_NEAR(report.friction_loss + report.normal_loss, w.dissipated, 1e-14);
          EXPECT_NEAR(report.impulse, report.normal_force * s.nodes.context.dt, 1e-14);
          Vec3 sum = Vec3::Zero();
          for (std::size_t i = 0; i < s.X.size(); ++i)
            sum += f.segment<3>(3 * static_cast<Eigen::Index>(i));
          EXPECT_LT((report.force - sum).norm(), 1e-13) << "on the solid";
          still.x_n = s.nodes.x_n1;
          EXPECT_NEAR(contact.work(still.start(), history.data(), nullptr).stored, w.stored, 1e-12);
        });
}

TEST(SurfaceContact, KeepsMomentaOfSolidAndBody) {
  for_scenes(
      law(0.3), 0.5,
      [](const surface_contact::SurfaceContact& contact, const Scene& s, const auto& history) {
        if (contact.external()) return;
        const Vec f = forces(contact, s.nodes, history);
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        for (int i = 0; 3 * i < f.size(); ++i) {
          const Vec3 one = f.segment<3>(3 * i);
          sum += one;
          moment += s.nodes.step().position_alpha(i).cross(one);
        }
        EXPECT_LT(sum.norm(), 1e-13);
        EXPECT_LT(moment.norm(), 1e-13);
      });
}

TEST(SurfaceContact, DistributesItsAreaOverTheNodes) {
  const surface_contact::RigidSurface plane;
  const solids::LoadedFaces faces{"quad4", {0, 1, 2, 3}};
  const std::vector<Vec3> X{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
  surface_contact::SurfaceLaw l = law(0.0);
  const surface_contact::SurfaceContact contact("c", surface_contact::surface_points("c", faces, X),
                                                X, plane, {}, l);
  Nodes nodes;
  for (const Vec3& x : X) nodes.add(x, Vec3::Zero());
  std::vector<double> history = with_whole_bands(contact);
  EXPECT_EQ(contact.report(history.data()).least_gap, 0.0);
  contact.commit(nodes.step(), history.data(), nullptr);
  const surface_contact::SurfaceReport r = contact.report(history.data());
  EXPECT_NEAR(r.area, 6.0, 1e-14);
  EXPECT_NEAR(r.force[2], 6.0 * l.normal.force(0.0), 1e-12);
  EXPECT_EQ(r.least_gap, 0.0);
}

// @tests{surface-start}
TEST(SurfaceContact, StoresNoEnergyAtItsStart) {
  const std::vector<Vec3> X{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
  const surface_contact::SurfaceContact contact(
      "c", surface_contact::surface_points("c", {"quad4", {0, 1, 2, 3}}, X), X,
      surface_contact::RigidSurface{}, {}, law(0.0));
  std::vector<double> history(contact.history_size());
  contact.initialize(history.data());
  Nodes nodes;
  for (const Vec3& x : X) nodes.add(x, Vec3::Zero());
  EXPECT_EQ(contact.work(nodes.start(), history.data(), nullptr).stored, 0.0);
  contact.commit(nodes.step(), history.data(), nullptr);
  EXPECT_EQ(contact.report(history.data()).normal_force, 0.0);
}

/// Points that move through a shape, stopped before they leave it on the other side.
TEST(SurfaceContact, StopsPointsThatWouldPassThrough) {
  using enum surface_contact::RigidSurface::Kind;
  const surface_contact::RigidSurface plate{.kind = box, .half = {5, 5, 0.5}, .rounding = 0.1};
  surface_contact::SurfaceLaw l = law(0.0);
  l.normal.tolerance = 0.1;
  const std::vector<Vec3> X{{0, 0, 4}, {1, 0, 4}, {1, 1, 4}, {0, 1, 4}};
  const surface_contact::SurfaceContact contact(
      "c", surface_contact::surface_points("c", {"quad4", {0, 1, 2, 3}}, X), X, plate, {}, l);
  const auto part = [&](const Vec3& move) {
    Nodes nodes;
    for (const Vec3& x : X) nodes.add(x, move);
    return contact.free_part(nodes.start(), nodes.step(), nullptr);
  };
  EXPECT_EQ(part({0, 0, -3.0}), 1.0);
  EXPECT_EQ(part({8, 0, -1.0}), 1.0) << "past the shape";
  EXPECT_EQ(part({0, 0, 9.0}), 1.0) << "away";
  // From 4 through the plate to −4: free as far as 0.5 − 0.1 + 0.02, a tenth of the band.
  EXPECT_NEAR(part({0, 0, -8.0}), 3.58 / 8.0, 1e-3);
  EXPECT_NEAR(part({1, 0, -100.0}), 3.58 / 100.0, 1e-4);
  // Across an edge, which positions at the ends alone would not show.
  EXPECT_LT(part({8.0, 0, -8.0}), 0.5);
}

TEST(SurfaceContact, LeavesOutGivenNodes) {
  const std::vector<Vec3> X{{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}};
  const surface_contact::SurfacePoints some =
      surface_contact::surface_points("c", {"quad4", {0, 1, 2, 3}}, X, {1, 3});
  EXPECT_EQ(some.nodes, (std::vector<int>{0, 2}));
  EXPECT_NEAR(some.points[0].area, 1.5, 1e-14);
  EXPECT_THROW(static_cast<void>(
                   surface_contact::surface_points("c", {"quad4", {0, 1, 2, 3}}, X, {0, 1, 2, 3})),
               InputError);
  EXPECT_EQ(surface_contact::median_edge({"quad4", {0, 1, 2, 3}}, X), 3.0);
}

/// Gaps of hulls, cones and ellipsoids equal to those of boxes, flanks and spheres.
TEST(ConvexSurface, HasTheGapsOfEquivalentShapes) {
  using enum surface_contact::RigidSurface::Kind;
  Random random(41);
  const surface_contact::RigidSurface plate{
      .kind = box, .half = {2.0, 3.0, 2.5}, .rounding = kTolerance};
  const surface_contact::RigidSurface ball{.kind = sphere, .radius = 2.0};
  const surface_contact::RigidSurface hull = around(brick());
  const surface_contact::RigidSurface round = around(contact::ellipsoid("ball", {4.0, 4.0, 4.0}));
  const surface_contact::RigidSurface spike = around(contact::cone("spike", 4.0, 6.0, {}, 0.1));
  const auto compare = [](const surface_contact::RigidSurface& a,
                          const surface_contact::RigidSurface& b, const Vec3& y) {
    const contact::NormalLaw any;
    const surface_contact::RigidSurface::Gap g = a.gap(y, {any}), h = b.gap(y, {any});
    EXPECT_NEAR(g.value, h.value, 1e-13);
    EXPECT_LT((g.normal - h.normal).norm(), 1e-11);
    EXPECT_LT((g.curvature - h.curvature).norm(), 1e-9);
    EXPECT_NEAR(b.distance(y), h.value, 1e-14);
  };
  for (int k = 0; k < 200; ++k) {
    const Vec3 y = 4.0 * random.direction();
    compare(plate, hull, y);
    compare(ball, round, y);
    // The flank from (2, −3) to (0, 3): normal (6, 2)/√40 in the half plane of the point.
    const double part = 0.1 + 0.004 * k, out = 0.05;
    const Vec3 across = random.direction().cross(Vec3::UnitZ()).normalized();
    const double q = 2.0 * (1.0 - part) + out * 6.0 / std::sqrt(40.0);
    const double h = -3.0 + 6.0 * part + out * 2.0 / std::sqrt(40.0);
    EXPECT_NEAR(spike.distance(q * across + h * Vec3::UnitZ()), out, 1e-12);
  }
}

}  // namespace
}  // namespace polhode::test::surface_contact_tests
