// SPDX-License-Identifier: Apache-2.0
// A round bar of an FEBio file, twisted between rigid grips. Of an incompressible material with the
// energy mu/2 (I1 - 3) the exact solution is a pure twist psi per length at every angle, also where
// grips hold it: moment mu psi pi R^4/2, axial force -mu psi^2 pi R^4/4 (Rivlin).
#include <cmath>
#include <map>
#include <numbers>

#include "feb_fixture.hpp"

namespace polhode::feb_twist_tests {
namespace {

using namespace feb_tests;

constexpr double kPi = std::numbers::pi;
constexpr double kBulk = 2000.0;  ///< Per shear modulus.
constexpr double kShear = 3e3;    ///< [Pa]
constexpr double kRadius = 0.5;   ///< [m]
constexpr double kLength = 1.0;   ///< [m]
constexpr double kInner = 0.55;   ///< Half diagonal of the inner part of the section, per radius.

/// A mesh of hex20 for a round bar along z, whose nodes have numbers from 1.
struct Bar {
  std::vector<Vec3> nodes;
  std::map<std::array<long, 3>, int> numbers;
  std::string elements;
  int count = 0;

  int node(const Vec3& x) {
    std::array<long, 3> key{};
    for (int k = 0; k < 3; ++k) key[static_cast<std::size_t>(k)] = std::lround(x[k] * 1e7);
    const auto [entry, is_new] = numbers.try_emplace(key, static_cast<int>(nodes.size()) + 1);
    if (is_new) nodes.push_back(x);
    return entry->second;
  }
};

/// Point of the section: of the inner square (part 4), or of a part between it and the circle.
/// @param u  Along the square's side, -1 to 1.  @param v  Outward, 0 to 1; in the square -1 to 1.
Vec3 section(int part, double u, double v) {
  const double half = kInner * kRadius / std::sqrt(2.0);
  if (part == 4) return {half * u, half * v, 0.0};
  const double angle = 0.25 * kPi * u;
  const Vec3 on_square(half, half * u, 0.0);
  const Vec3 on_circle(kRadius * std::cos(angle), kRadius * std::sin(angle), 0.0);
  return Eigen::AngleAxisd(0.5 * kPi * part, Vec3::UnitZ()) *
         ((1.0 - v) * on_square + v * on_circle);
}

/// @param n  Elements along a side of the square and outward; twice as many along the bar.
Bar bar(int n) {
  Bar mesh;
  static const int corner[20][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 0, 2},
                                    {2, 0, 2}, {2, 2, 2}, {0, 2, 2}, {1, 0, 0}, {2, 1, 0},
                                    {1, 2, 0}, {0, 1, 0}, {1, 0, 2}, {2, 1, 2}, {1, 2, 2},
                                    {0, 1, 2}, {0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
  for (int part = 0; part < 5; ++part)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < 2 * n; ++k) {
          std::string list;
          for (const auto& c : corner) {
            const double a = (2 * i + c[0]) / (2.0 * n), b = (2 * j + c[1]) / (2.0 * n);
            // Outward and along the side, so that the element's first two directions and z are
            // right-handed.
            Vec3 x = part == 4 ? section(4, 2 * a - 1, 2 * b - 1) : section(part, 2 * b - 1, a);
            x.z() = kLength * (2 * k + c[2]) / (4.0 * n);
            list += format("{}{}", list.empty() ? "" : ",", mesh.node(x));
          }
          mesh.elements += tag("elem", list, format("id='{}'", ++mesh.count));
        }
  return mesh;
}

/// @param angle  Of the grip at z = L, at the end [rad].
/// @param bulk   Bulk modulus per shear modulus.
std::string twisted(int n, double angle, double bulk, int steps) {
  const Bar mesh = bar(n);
  std::string nodes, bottom, top;
  for (std::size_t k = 0; k < mesh.nodes.size(); ++k) {
    const Vec3& x = mesh.nodes[k];
    nodes += tag("node", format("{},{},{}", x.x(), x.y(), x.z()), format("id='{}'", k + 1));
    if (x.z() == 0.0) bottom += format("{}{}", bottom.empty() ? "" : ",", k + 1);
    if (x.z() == kLength) top += format("{}{}", top.empty() ? "" : ",", k + 1);
  }
  const auto grip = [](const std::string& set, const std::string& body) {
    return tag("bc", tag("rb", body), "type='rigid' node_set='" + set + "'");
  };
  return feb(
      control("STATIC", steps, 1.0 / steps) +
      tag("Material", tag("material",
                          tag("density", "1000") + tag("c1", format("{}", 0.5 * kShear)) +
                              tag("c2", "0") + tag("k", format("{}", bulk * kShear)),
                          "id='1' name='soft' type='Mooney-Rivlin'") +
                          rigid(2, "held") + rigid(3, "turned")) +
      tag("Mesh", tag("Nodes", nodes) + tag("Elements", mesh.elements, "type='hex20' name='part'") +
                      block(100001, "foot", Vec3(-1, -1, -1), Vec3(1, 1, 0)) +
                      block(200001, "hand", Vec3(-1, -1, kLength), Vec3(1, 1, kLength + 1)) +
                      tag("NodeSet", bottom, "name='bottom'") + tag("NodeSet", top, "name='top'")) +
      tag("MeshDomains",
          domain("part", "soft") + domain("foot", "held") + domain("hand", "turned")) +
      tag("Boundary", grip("bottom", "held") + grip("top", "turned")) +
      tag("Rigid", fixed("held", "111111") + fixed("turned", "111110") +
                       typed("rigid_bc", "rigid_rotation",
                             tag("rb", "turned") + tag("dof", "Rw") +
                                 tag("value", format("{}", angle), "lc='1'"))) +
      tag("LoadData", curve(1, "0,0;1,1")));
}

class FebTwist : public FebFixture {
 protected:
  /// Moment and axial force of the grip that turns on the bar.
  std::array<double, 2> reaction(const std::string& text) {
    Simulation s(read(text));
    const RunSummary done = s.run();
    EXPECT_EQ(done.end, RunEnd::finished) << done.message;
    const std::vector<std::string> names = s.interfaces(0);
    for (std::size_t k = 0; k < names.size(); ++k)
      if (names[k] == "turned") {
        const auto on_bar = s.interface_reaction(0, static_cast<int>(k));
        return {on_bar.moment.z(), on_bar.force.z()};
      }
    ADD_FAILURE() << "no interface of the grip";
    return {};
  }
};

TEST_F(FebTwist, ABarTwistedBetweenRigidGripsHasRivlinsMomentAndForce) {
  const double angle = 0.5, twist = angle / kLength, polar = 0.5 * kPi * std::pow(kRadius, 4);
  const double moment = kShear * twist * polar, force = -0.5 * kShear * twist * twist * polar;
  std::array<double, 2> before{};
  for (int n = 1; n <= 2; ++n) {
    const auto [m, f] = reaction(twisted(n, angle, kBulk, 2));
    const std::array<double, 2> error{std::abs(m / moment - 1.0), std::abs(f / force - 1.0)};
    EXPECT_LT(error[0], n == 1 ? 0.03 : 0.003) << m;
    EXPECT_LT(error[1], n == 1 ? 0.2 : 0.03) << f;
    if (n == 2) {
      EXPECT_GT(before[0] / error[0], 6.0);  // Nearly the third order.
      EXPECT_GT(before[1] / error[1], 4.0);
    }
    before = error;
  }
}

// Independence of an elastic bar of the load steps.
TEST_F(FebTwist, LoadStepsChangeNothing) {
  const auto one = reaction(twisted(1, 0.5, kBulk, 1)), four = reaction(twisted(1, 0.5, kBulk, 4));
  EXPECT_NEAR(one[0], four[0], 1e-6 * std::abs(one[0]));
  EXPECT_NEAR(one[1], four[1], 1e-6 * std::abs(one[0]));
}

}  // namespace
}  // namespace polhode::feb_twist_tests
