// SPDX-License-Identifier: Apache-2.0
// Forces given by code as functions of the motion: tangents, work, parts at other poses.
#include <cmath>

#include <loads/load_samples.hpp>
#include <polhode/loads/moment.hpp>
#include <polhode/loads/motor.hpp>
#include <polhode/loads/point_force.hpp>
#include <polhode/loads/spring_damper.hpp>

namespace polhode::test::load_function_tests {
namespace {

/// A function that depends nonlinearly on all of its arguments.
PointFunction anything(bool with_derivative) {
  PointFunction f;
  f.value = [](const PointReading& x) -> Vec3 {
    return std::cos(x.t) * x.position.squaredNorm() * x.position - x.velocity.cross(x.position) +
           x.orientation * Vec3(1.0, 2.0, x.angular_velocity.squaredNorm());
  };
  if (with_derivative)
    f.derivative = [](const PointReading& x) {
      PointDerivative d;
      const Vec3& r = x.position;
      d.position = std::cos(x.t) * (r.squaredNorm() * Mat3::Identity() + 2.0 * r * r.transpose()) -
                   hat(x.velocity);
      d.velocity = hat(r);
      d.turn = -hat(x.orientation * Vec3(1.0, 2.0, x.angular_velocity.squaredNorm()));
      d.angular_velocity = 2.0 * (x.orientation * Vec3::UnitZ()) * x.angular_velocity.transpose();
      return d;
    };
  return f;
}

CoordinateFunction along(bool with_derivative) {
  CoordinateFunction f;
  f.value = [](const CoordinateReading& x) {
    return std::sin(3.0 * x.value) - 0.4 * x.rate * x.rate * x.rate + x.t;
  };
  if (with_derivative)
    f.derivative = [](const CoordinateReading& x) {
      return CoordinateDerivative{3.0 * std::cos(3.0 * x.value), -1.2 * x.rate * x.rate};
    };
  return f;
}

struct Sample {
  LoadDescription d;
  PairMotion motion;
};

/// A load on b, or between points or in a hinge whose axes are aligned at both ends of the step.
Sample sample(unsigned seed, const StepContext& context) {
  Random random(seed);
  LoadDescription d;
  d.name = "it";
  d.bodies = {0, 1};
  d.Z_a = random.vector(0.5);
  d.Z_b = random.vector(0.5);
  d.mass_b = 3.0;
  d.inertia_b = random.inertia();
  const Mat3 R_a = random.frame(), R_b = random.frame();
  PairMotion m(random, context);
  const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
    return Lambda_a * R_a * exp_map(angle * Vec3::UnitZ()) * R_b.transpose();
  };
  m.b_n.q = Quat(b_of(m.a_n.Lambda(), 0.3)).normalized();
  m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, 1.1) * m.b_n.Lambda().transpose());
  d.angle = FreeAngle{R_a.col(0), R_a.col(1), R_b.col(0), false};
  return {d, m};
}

/// Tangents at several spectral radii; work at ρ∞ = 1 is what is put in.
/// @param tolerance  Of tangents; those by differences are about 1e-7 off.
template <class Item>
void expect_laws(const std::function<void(LoadDescription&)>& change, bool on_b_alone,
                 double tolerance) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (unsigned seed = 1; seed <= 3; ++seed) {
      auto sampled = sample(seed, context_of(rho_inf));
      auto& d = sampled.d;
      auto& m = sampled.motion;
      change(d);
      m.a_moves = !on_b_alone;
      const Item item(d);
      if constexpr (std::is_base_of_v<Motor, Item>)
        m.at_start([&](const PairStep& s) {
          item.initialize(s, m.history.data());
          return 0;
        });
      expect_derivative(
          wrench_tangent(evaluate(item, m)),
          [&](const Vec& x) -> Vec {
            Displacement only = x;
            for (int k = 0; k < 12; ++k)
              if (!m.moves(k)) only[k] = 0.0;
            return wrenches(evaluate(item, m, only));
          },
          Item::kKind, tolerance);
      if (rho_inf < 1.0) continue;
      const Work w = work(item, m);
      EXPECT_NEAR(work_done(m, evaluate(item, m)), w.put_in, 1e-11) << Item::kKind << ' ' << seed;
      EXPECT_EQ(w.stored, 0.0);
      EXPECT_EQ(w.dissipated, 0.0);
    }
}

}  // namespace

// @tests{callable-force}
TEST(LoadFunction, OfAPointHasItsTangentAndReportsItsWork) {
  for (const bool body_fixed : {false, true})
    for (const bool with_derivative : {true, false}) {
      const auto change = [&](LoadDescription& d) {
        d.of_motion = anything(with_derivative);
        d.vector = constant({0.5, -1.0, 2.0});
        d.body_fixed = body_fixed;
      };
      const double tolerance = with_derivative ? 1e-7 : 2e-6;
      expect_laws<PointForce>(change, true, tolerance);
      expect_laws<Moment>(change, true, tolerance);
    }
}

// @tests{callable-force}
TEST(LoadFunction, OfACoordinateHasItsTangentAndReportsItsWork) {
  for (const bool with_derivative : {true, false}) {
    const double tolerance = with_derivative ? 1e-7 : 2e-6;
    expect_laws<RotaryMotor>(
        [&](LoadDescription& d) {
          d.of_motion = along(with_derivative);
          d.drive = "moment";
        },
        false, tolerance);
    expect_laws<AxialForce>(
        [&](LoadDescription& d) {
          d.of_motion = along(with_derivative);
          d.drive = "pull";
        },
        false, tolerance);
  }
}

TEST(LoadFunction, ReadsTheMeanOfTheStepAndDependsOnNothingElse) {
  auto [d, m] = sample(4, context_of(1.0));
  m.a_moves = false;
  PointReading seen;
  PointFunction f;
  f.value = [&](const PointReading& x) -> Vec3 {
    seen = x;
    return Vec3::Zero();
  };
  d.of_motion = f;
  m.context.tangents = false;
  (void)evaluate(PointForce(d), m);
  const BodyStep b = m.b();
  const Vec3 x_n = b.r_n + b.Lambda_n * d.Z_b, x_n1 = b.r_n1 + b.Lambda_n1 * d.Z_b;
  EXPECT_NEAR(seen.t, m.context.t_n + 0.5 * m.context.dt, 1e-15);
  EXPECT_LT((seen.position - 0.5 * (x_n + x_n1)).norm(), 1e-14);
  // At ρ∞ = 1 the mean velocity is the displacement of the point over the time.
  EXPECT_LT((seen.velocity - (x_n1 - x_n) / m.context.dt).norm(), 1e-13);
  EXPECT_LT((seen.angular_velocity - b.theta / m.context.dt).norm(), 1e-13);
  // Halfway between the orientations: the same turn leads to it and from it.
  const Mat3 mean = seen.orientation.toRotationMatrix();
  EXPECT_LT((mean * b.Lambda_n.transpose() - b.Lambda_n1 * mean.transpose()).norm(), 1e-13);
}

TEST(LoadFunction, OfAPartUsesTheAxesOfThePart) {
  Random random(5);
  for (const bool mirrored : {false, true})
    for (const bool axial : {false, true})
      for (const bool body_fixed : {false, true}) {
        PartAxes part;
        const Mat3 S = mirrored ? Mat3(Vec3(1.0, -1.0, 1.0).asDiagonal()) : Mat3::Identity();
        part.origin = random.vector();
        part.axes = random.frame() * S;
        part.body_axes = S;
        const PointFunction f = anything(true);
        const auto g = std::get<PointFunction>(placed(f, part, body_fixed, axial));
        // A motion in the part's axes and the same in the whole model's: mirror images of a body's
        // axes are mirrored along the same axis of the body.
        PointReading x{0.3, random.vector(), random.vector(), random.orientation(),
                       random.vector()};
        const double sign = mirrored ? -1.0 : 1.0;
        PointReading y{x.t, part.origin + part.axes * x.position, part.axes * x.velocity,
                       Quat(Mat3(part.axes * x.orientation.toRotationMatrix() * S)),
                       sign * part.axes * x.angular_velocity};
        const Vec3 expected = (axial ? sign : 1.0) * (body_fixed ? S : part.axes) * f.value(x);
        EXPECT_LT((g.value(y) - expected).norm(), 1e-13);
        Mat analytic(3, 12);
        const PointDerivative d = g.derivative(y);
        analytic << d.position, d.velocity, d.turn, d.angular_velocity;
        expect_derivative(
            analytic,
            [&](const Vec& move) -> Vec {
              PointReading moved = y;
              moved.position += move.segment<3>(0);
              moved.velocity += move.segment<3>(3);
              moved.orientation = Quat(exp_map(move.segment<3>(6))) * y.orientation;
              moved.angular_velocity += move.segment<3>(9);
              return g.value(moved);
            },
            "placed function");
      }
  PartAxes reversed;
  reversed.sense = -1.0;
  const auto g = std::get<CoordinateFunction>(placed(along(true), reversed, false, false));
  const CoordinateReading x{0.2, 0.7, -1.3}, y{0.2, -0.7, 1.3};
  EXPECT_EQ(g.value(y), -along(true).value(x));
  EXPECT_EQ(g.derivative(y).value, along(true).derivative(x).value);
}

// The pose of a part in a part is the composition of both poses.
TEST(LoadFunction, OfANestedPartUsesTheAxesOfThatPart) {
  Random random(6);
  PartAxes inner, outer;
  inner.origin = random.vector();
  inner.axes = random.frame();
  outer.origin = random.vector();
  outer.axes = random.frame();
  const PointFunction f = anything(false);
  const auto twice =
      std::get<PointFunction>(placed(placed(f, inner, false, false), outer, false, false));
  const auto once = std::get<PointFunction>(placed(f, inner.within(outer), false, false));
  const PointReading x{0.1, random.vector(), random.vector(), random.orientation(),
                       random.vector()};
  EXPECT_LT((twice.value(x) - once.value(x)).norm(), 1e-13);
}

}  // namespace polhode::test::load_function_tests
