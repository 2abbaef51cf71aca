// SPDX-License-Identifier: Apache-2.0
// Rolling wheels and points on curves over one large step: tangents, rows, work, momenta.
#include <cmath>
#include <functional>

#include <loads/load_samples.hpp>
#include <polhode/core/error.hpp>
#include <polhode/loads/curve_on_curve.hpp>
#include <polhode/loads/point_on_curve.hpp>
#include <polhode/loads/rolling.hpp>

namespace polhode::test::contact_rows_tests {
namespace {

/// Bodies anywhere, turned by about a radian in the step.
struct Sample {
  LoadDescription d;
  PairMotion motion;
};

Sample sample(unsigned seed, const StepContext& context) {
  Random random(seed);
  LoadDescription d;
  d.name = "it";
  d.bodies = {0, 1};
  d.Z_a = random.vector(0.5);
  d.Z_b = random.vector(0.5);
  d.R_a = random.frame();
  d.R_b = random.frame();
  return {d, PairMotion(random, context)};
}

/// An ellipse, with exact derivatives.
class Wave : public TimeFunction {
 public:
  Wave(double size, double phase, double middle = 0.0)
      : size_(size), phase_(phase), middle_(middle) {}
  double operator()(double s) const override { return middle_ + size_ * std::cos(s - phase_); }
  TimeRates rates(double s, TimeSide) const override {
    return {middle_ + size_ * std::cos(s - phase_), -size_ * std::sin(s - phase_),
            -size_ * std::cos(s - phase_)};
  }

 private:
  double size_, phase_, middle_;
};

void ellipse(LoadDescription& d) {
  d.laws["curve_x"] = std::make_shared<Wave>(2.0, 0.0);
  d.laws["curve_y"] = std::make_shared<Wave>(1.5, 0.5 * 3.14159265358979323846);
  d.values["roller_radius"] = 0.2;
}

template <class Item>
Vec values(const Item& item, const PairMotion& m, const Vec& x = Vec::Zero(12)) {
  return evaluate(item, m, x).g.head(item.rows());
}

template <class Item>
Mat rows_of(const Item& item, const PairTerms& t) {
  Mat G(item.rows(), 12);
  G << t.G_a.topRows(item.rows()), t.G_b.topRows(item.rows());
  return G;
}

template <class Item>
Vec values_at_start(const Item& item, const PairMotion& m) {
  return m.at_start([&](const PairStep& s) -> Vec {
    PairTerms t;
    t.set_zero();
    item.evaluate(s, t);
    return t.g.head(item.rows());
  });
}

/// Tangents, rows, columns, action and reaction at one point, work.
/// @param change  Of the description.
template <class Item>
void expect_laws(const std::function<void(LoadDescription&)>& change) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (unsigned seed = 1; seed <= 6; ++seed) {
      auto sampled = sample(seed, context_of(rho_inf));
      auto& d = sampled.d;
      auto& m = sampled.motion;
      change(d);
      const Item item(d);
      m.at_start([&](const PairStep& s) {
        item.initialize(s, m.history.data());
        return 0;
      });
      const PairTerms t = evaluate(item, m);
      const std::string what = std::string(Item::kKind) + ", seed " + std::to_string(seed);
      expect_derivative(
          wrench_tangent(t), [&](const Vec& x) -> Vec { return wrenches(evaluate(item, m, x)); },
          what + " D", 1e-6);
      expect_derivative(
          rows_of(item, t), [&](const Vec& x) -> Vec { return values(item, m, x); }, what + " G",
          1e-6);
      Displacement sum = Displacement::Zero();
      for (int k = 0; k < item.rows(); ++k) {
        sum.head<6>() += m.lambda[static_cast<std::size_t>(k)] * t.B_a.col(k);
        sum.tail<6>() += m.lambda[static_cast<std::size_t>(k)] * t.B_b.col(k);
      }
      EXPECT_LT((sum - wrenches(t)).norm(), 1e-12) << what;
      EXPECT_LT((t.wrench_a.head<3>() + t.wrench_b.head<3>()).norm(), 1e-14) << what;
      const Vec3 r_a = m.a().point(Vec3::Zero()).at_alpha, r_b = m.b().point(Vec3::Zero()).at_alpha;
      const Vec3 moment = r_a.cross(t.wrench_a.head<3>()) + t.wrench_a.tail<3>() +
                          r_b.cross(t.wrench_b.head<3>()) + t.wrench_b.tail<3>();
      EXPECT_LT(moment.norm(), 1e-12) << what;
      if (rho_inf != 1.0) continue;
      const Eigen::Map<const Vec6> lambda(m.lambda.data());
      const Vec change_of_g = t.g.head(item.rows()) - values_at_start(item, m);
      EXPECT_NEAR(work_done(m, t), lambda.head(item.rows()).dot(change_of_g), 1e-11) << what;
      for (const bool a_moves : {false, true}) {
        PairMotion one = m;
        one.a_moves = a_moves;
        one.b_moves = !a_moves;
        const PairTerms s = evaluate(item, one);
        EXPECT_TRUE((a_moves ? s.wrench_b : s.wrench_a).isZero(0.0));
        EXPECT_TRUE((a_moves ? s.G_b : s.G_a).isZero(0.0));
      }
    }
}

/// Along a motion without accelerations d/dt (G v) = γ.
template <class Item>
void expect_accelerations(const std::function<void(LoadDescription&)>& change) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    auto sampled = sample(seed, context_of(1.0));
    auto& d = sampled.d;
    auto& m = sampled.motion;
    change(d);
    const Item item(d);
    const auto at = [&](double t, auto&& what) {
      const auto side = [&](const BodyMotion& n) {
        const Mat3 L = n.Lambda() * exp_map(t * n.W);
        return BodyStep::at_instant(n.r + t * n.v, L, n.v, n.W);
      };
      const BodyStep a = side(m.a_n), b = side(m.b_n);
      return what(PairStep{a, b, m.context, m.lambda.data(), m.history.data()});
    };
    at(0.0, [&](const PairStep& s) {
      item.initialize(s, m.history.data());
      return 0;
    });
    const auto speeds = [&](double time) {
      return at(time, [&](const PairStep& s) -> Vec {
        PairTerms t;
        t.set_zero();
        item.evaluate(s, t);
        Displacement v;
        v << s.a.v_n1, s.a.Lambda_n1 * s.a.W_n1, s.b.v_n1, s.b.Lambda_n1 * s.b.W_n1;
        return rows_of(item, t) * v;
      });
    };
    Vec6 gamma = Vec6::Zero();
    at(0.0, [&](const PairStep& s) {
      item.acceleration_terms(s, gamma);
      return 0;
    });
    constexpr double kH = 1e-5;
    const Vec slope = (speeds(kH) - speeds(-kH)) / (2.0 * kH);
    EXPECT_LT((slope - gamma.head(item.rows())).norm(), 1e-6 * (1.0 + slope.norm())) << seed;
  }
}

void knife_edge(LoadDescription& d) { d.values = {{"radius", 0.7}}; }
void torus(LoadDescription& d) { d.values = {{"radius", 0.7}, {"edge_radius", 0.3}}; }
void ball(LoadDescription& d) { d.values = {{"radius", 0.7}, {"edge_radius", 0.7}}; }
void groove(LoadDescription& d) {
  ellipse(d);
  d.words["holds"] = "point";
  d.words["side"] = "left";
}

/// An ellipse of this size about a point of its plane; the prefix "other_" is for the curve of b.
void add_ellipse(LoadDescription& d, const std::string& prefix, double x, double y, double a,
                 double b) {
  d.laws[prefix + "curve_x"] = std::make_shared<Wave>(a, 0.0, x);
  d.laws[prefix + "curve_y"] = std::make_shared<Wave>(b, 0.5 * 3.14159265358979323846, y);
}
/// Curves side by side, and the small one within the large one.
void outside(LoadDescription& d) {
  add_ellipse(d, "", 6.0, 1.0, 2.0, 1.5);
  add_ellipse(d, "other_", 0.2, -0.1, 0.8, 0.5);
}
void inside(LoadDescription& d) {
  add_ellipse(d, "", 6.0, 1.0, 11.0, 12.0);
  add_ellipse(d, "other_", 0.2, -0.1, 0.8, 0.5);
  d.words["side"] = "left";
}

}  // namespace

// @tests{rolling-height} @tests{rolling-slip}
TEST(Rolling, DoesNoWorkAndHasItsTangents) {
  expect_laws<Rolling>(knife_edge);
  expect_laws<Rolling>(torus);
  expect_laws<Rolling>(ball);
}

TEST(Rolling, HasTheAccelerationTermsOfItsConstraint) {
  expect_accelerations<Rolling>(knife_edge);
  expect_accelerations<Rolling>(torus);
  expect_accelerations<Rolling>(ball);
}

// @tests{curve-distance} @tests{curve-gradient}
TEST(PointOnCurve, DoesNoWorkAndHasItsTangents) {
  expect_laws<PointOnCurve>(ellipse);
  expect_laws<PointOnCurve>(groove);
}

TEST(PointOnCurve, HasTheAccelerationTermsOfItsConstraint) {
  expect_accelerations<PointOnCurve>(ellipse);
  expect_accelerations<PointOnCurve>(groove);
}

// A circle of 2 m, counter-clockwise: |P| − 2 to the right, 2 − |P| to the left.
TEST(PointOnCurve, HasDistancesOfACircleByThoseOfItsCentre) {
  const auto x = std::make_shared<Wave>(2.0, 0.0);
  const auto y = std::make_shared<Wave>(2.0, 0.5 * 3.14159265358979323846);
  for (const double side : {1.0, -1.0}) {
    const PlanarCurve circle(x, y, 2.0 * 3.14159265358979323846, false, side);
    for (const double r : {1.2, 2.0, 3.7})
      for (const double phi : {0.1, 2.0, 4.5}) {
        const PlanarCurve::Vec2 P(r * std::cos(phi), r * std::sin(phi));
        const auto d = circle.distance(P, circle.nearest(P));
        EXPECT_NEAR(d.value, side * (r - 2.0), 1e-13);
        EXPECT_NEAR(std::remainder(d.foot - phi, 2.0 * 3.14159265358979323846), 0.0, 1e-12);
        EXPECT_LT((d.normal - side * P / r).norm(), 1e-12);
        EXPECT_NEAR(d.curvature, side / r, 1e-12);
      }
  }
}

// @tests{curves-distance} @tests{curves-derivatives} @tests{curves-gradient}
TEST(CurveOnCurve, DoesNoWorkAndHasItsTangents) {
  expect_laws<CurveOnCurve>(outside);
  expect_laws<CurveOnCurve>(inside);
}

TEST(CurveOnCurve, HasTheAccelerationTermsOfItsConstraint) {
  expect_accelerations<CurveOnCurve>(outside);
  expect_accelerations<CurveOnCurve>(inside);
}

// Two circles are apart by the distance of their centres less both radii, and the first search
// finds the same pair of places from any side.
TEST(CurveOnCurve, HasDistancesOfCirclesByThoseOfTheirCentres) {
  const auto circle = [](double r, double x, double side) {
    return PlanarCurve(std::make_shared<Wave>(r, 0.0, x),
                       std::make_shared<Wave>(r, 0.5 * 3.14159265358979323846),
                       2.0 * 3.14159265358979323846, false, side);
  };
  const CurvePair beside(circle(2.0, 0.5, 1.0), circle(0.7, 0.3, 1.0));
  const CurvePair within(circle(2.0, 0.5, -1.0), circle(0.7, 0.3, 1.0));
  for (const double phi : {0.1, 2.0, 4.5})
    for (const double turn : {0.0, 1.0, 4.0}) {
      const double c = std::cos(turn), s = std::sin(turn);
      const auto at = [&](double r) {
        return CurvePair::Vec4(0.5 + r * std::cos(phi) - 0.3 * c, r * std::sin(phi) - 0.3 * s, c,
                               s);
      };
      const CurvePair::Vec4 far = at(2.9), near = at(1.1);
      const auto d = beside.distance(far, beside.first(far));
      EXPECT_NEAR(d.value, 0.2, 1e-13);
      EXPECT_NEAR(std::remainder(d.at.a - phi, 2.0 * 3.14159265358979323846), 0.0, 1e-7);
      EXPECT_TRUE(d.touches);
      const auto i = within.distance(near, within.first(near));
      EXPECT_NEAR(i.value, 0.2, 1e-13);
      EXPECT_TRUE(i.touches);
    }
}

TEST(Rolling, RefusesAnEdgeRadiusAboveThatOfTheWheel) {
  System system;
  LoadDescription d;
  d.name = "tyre";
  d.bodies = {kGround, system.add_body({.name = "wheel"}, {})};
  d.values = {{"radius", 0.2}, {"edge_radius", 0.3}};
  try {
    add_rolling(system, d);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "loads.tyre.edge_radius: is 0.3 m, larger than the radius of 0.2 m. Give a "
                 "smaller one; for a sphere both are equal.");
  }
}

}  // namespace polhode::test::contact_rows_tests
