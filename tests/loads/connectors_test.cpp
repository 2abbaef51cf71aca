// SPDX-License-Identifier: Apache-2.0
// Properties of every connector over one large step: its tangent is the derivative of its wrenches,
// and their work is the one in its energy balance.
#include <cmath>
#include <vector>

#include <loads/load_samples.hpp>
#include <polhode/loads/axis_drag.hpp>
#include <polhode/loads/bushing.hpp>
#include <polhode/loads/coordinate_row.hpp>
#include <polhode/loads/drag.hpp>
#include <polhode/loads/gear.hpp>
#include <polhode/loads/joint_spring.hpp>
#include <polhode/loads/point_on_surface.hpp>
#include <polhode/loads/servo.hpp>
#include <polhode/loads/spring_damper.hpp>

namespace polhode::test::connectors_tests {
namespace {

TimeFunctionPtr law(std::function<double(double)> f) {
  return std::make_shared<Function>(std::move(f));
}

double cube(double x) { return 3.0 * x + 2.0 * x * x * x; }
double drag_law(double v) { return 1.5 * v + 0.7 * v * std::abs(v); }

/// A random pair with frames, points and both coordinates of a cylindrical joint; the axes are
/// aligned at both ends of the step.
struct Sample {
  LoadDescription d;
  PairMotion motion;
};

Sample sample(unsigned seed, const StepContext& context) {
  Random random(seed);
  const Mat3 R_a = random.frame(), R_b = random.frame();
  LoadDescription d;
  d.name = "it";
  d.bodies = {0, 1};
  d.Z_a = random.vector(0.5);
  d.Z_b = random.vector(0.5);
  d.R_a = R_a;
  d.R_b = R_b;
  d.mass_a = 2.0;
  d.mass_b = 3.0;
  d.inertia_b = random.inertia();
  d.start_length = 1.0;
  PairMotion m(random, context);
  const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
    return Lambda_a * R_a * exp_map(angle * Vec3::UnitZ()) * R_b.transpose();
  };
  m.b_n.q = Quat(b_of(m.a_n.Lambda(), 0.3)).normalized();
  m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, 1.1) * m.b_n.Lambda().transpose());
  return {d, m};
}

template <class Item>
void start(const Item& item, PairMotion& m) {
  m.at_start([&](const PairStep& s) {
    item.initialize(s, m.history.data());
    return 0;
  });
}

/// The laws of this file for any item, with `change` applied to its description.
template <class Item>
void expect_laws(const std::function<void(LoadDescription&)>& change, double scale = 1.0) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (const bool conserving : {true, false}) {
      StepContext context = context_of(rho_inf);
      context.conserving = conserving;
      auto sampled = sample(1, context);
      auto& d = sampled.d;
      auto& m = sampled.motion;
      change(d);
      const Item item(d);
      start(item, m);
      expect_derivative(
          wrench_tangent(evaluate(item, m)),
          [&](const Vec& x) -> Vec { return wrenches(evaluate(item, m, x)); }, Item::kKind);
    }
  for (unsigned seed = 1; seed <= 8; ++seed) {
    auto [d, m] = sample(seed, context_of(1.0));
    change(d);
    const Item item(d);
    start(item, m);
    const Work w = work(item, m);
    const double before = stored_at_start(item, m);
    EXPECT_NEAR(work_done(m, evaluate(item, m)), before - w.stored - w.dissipated + w.put_in,
                1e-11 * scale)
        << Item::kKind << ' ' << seed;
    EXPECT_GE(w.dissipated, 0.0) << Item::kKind;
  }
}

void hinge(LoadDescription& d) {
  d.angle = FreeAngle{d.R_a.col(0), d.R_a.col(1), d.R_b.col(0), false};
}
void slide(LoadDescription& d) { d.displacement = FreeDisplacement{d.Z_a, d.Z_b, d.R_a.col(2)}; }

}  // namespace

// @tests{law-mean}
TEST(Connectors, SpringsInJointsReturnTheEnergyTheyStore) {
  for (const char* acts : {"both", "tension", "compression"}) {
    expect_laws<TorsionalSpring>([&](LoadDescription& d) {
      hinge(d);
      d.values = {{"stiffness", 5.0}, {"quadratic", 3.0}, {"free_angle", 0.6}, {"damping", 0.4}};
      d.words["acts"] = acts;
      d.laws["spring_moment"] = law(cube);
      d.laws["damper_moment"] = law(drag_law);
    });
    expect_laws<TranslationalSpring>([&](LoadDescription& d) {
      slide(d);
      d.values = {{"stiffness", 5.0}, {"quadratic", 3.0}, {"free_displacement", 0.2}};
      d.words["acts"] = acts;
      d.laws["spring_force"] = law(cube);
    });
  }
}

// @tests{spring-gradient}
TEST(Connectors, SpringsBetweenPointsReturnTheEnergyTheyStore) {
  for (const char* acts : {"both", "tension", "compression"})
    expect_laws<SpringDamper>([&](LoadDescription& d) {
      d.values = {{"stiffness", 5.0}, {"quadratic", 2.0}, {"damping", 0.3}};
      d.words["acts"] = acts;
      d.laws["spring_force"] = law([](double x) { return std::sin(2.0 * x); });
      d.laws["damper_force"] = law(drag_law);
    });
  expect_laws<AxialForce>([](LoadDescription& d) {
    d.drive = "pull";
    d.function = law([](double t) { return 2.0 + t; });
  });
}

// A potential that is given as a function. @tests{law-mean}
TEST(Connectors, PotentialsReturnTheEnergyTheyStore) {
  class Potential final : public TimeFunction {
   public:
    double operator()(double l) const override { return 0.4 * l * l * l - 3.0 / l; }
    [[nodiscard]] TimeRates rates(double l, TimeSide) const override {
      return {(*this)(l), 1.2 * l * l + 3.0 / (l * l), 2.4 * l - 6.0 / (l * l * l)};
    }
  };
  expect_laws<PotentialForce>(
      [](LoadDescription& d) { d.laws["energy"] = std::make_shared<Potential>(); });
}

// @tests{attraction-gradient}
TEST(Connectors, GravityBetweenBodiesHasAPotential) {
  expect_laws<Attraction>([](LoadDescription& d) {
    d.Z_a = d.Z_b = Vec3::Zero();
    d.values = {{"strength", 2.5}};
  });
}

// @tests{bushing-cayley}
TEST(Connectors, BushingsReturnTheEnergyTheyStore) {
  const auto change = [](LoadDescription& d) {
    Mat6 L = Mat6::Zero();
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j <= i; ++j) L(i, j) = 1.0 + 0.3 * std::sin(3.0 * i + 2.0 * j);
    d.matrices["stiffness_matrix"] = L * L.transpose();
    d.matrices["damping_matrix"] = 0.1 * d.matrices["stiffness_matrix"];
    d.values = {{"stiffness.x", 3.0}, {"turning_stiffness.z", 2.0}};
    d.laws["law_y"] = law(cube);
    d.laws["law_rx"] = law(cube);
  };
  expect_laws<Bushing>(change, 100.0);
  // Small rotations are components of the rotation vector.
  auto [d, m] = sample(1, context_of(1.0));
  d.values = {{"turning_stiffness.x", 4.0}};
  d.R_a = d.R_b = Mat3::Identity();
  m.a_n.q = Quat::Identity();
  m.b_n.q = quaternion_from_rotation_vector(Vec3(1e-5, 0.0, 0.0));
  m.b_n.r = m.a_n.r = Vec3::Zero();
  const Bushing b(d);
  m.at_start([&](const PairStep& s) {
    EXPECT_NEAR(b.report(s)[3], -4e-5, 1e-14);
    return 0;
  });
}

// @tests{servo-law}
TEST(Connectors, ServosSupplyTheWorkOfTheirForces) {
  for (const char* drive : {"angle", "speed"})
    for (const double limit : {0.0, 0.5})
      expect_laws<RotaryServo>([&](LoadDescription& d) {
        hinge(d);
        d.drive = drive;
        d.function = law([](double t) { return 0.4 + 0.2 * t; });
        d.values = {{"stiffness", 3.0}, {"damping", 0.5}, {"integral", 1.2}};
        if (limit > 0.0) d.values["max_moment"] = limit;
      });
  expect_laws<LinearServo>([&](LoadDescription& d) {
    slide(d);
    d.drive = "displacement";
    d.function = law([](double t) { return 0.4 + 0.2 * t; });
    d.values = {{"stiffness", 3.0}, {"damping", 0.5}};
  });
}

// @tests{drag-law}
TEST(Connectors, DragAndDampersDissipateTheWorkOfTheirForces) {
  const auto change = [](LoadDescription& d) {
    d.values = {{"linear", 0.4}, {"quadratic", 0.3}, {"turning", 0.2}, {"per_mass", 0.5}};
    d.values["damping"] = 0.7;
    d.values["turning_damping"] = 0.6;
  };
  expect_laws<Drag>(change);
  expect_laws<VectorDamper>(change);
}

// @tests{axis-drag-law}
TEST(Connectors, DragByAxesDissipatesTheWorkOfItsForces) {
  expect_laws<AxisDrag>([](LoadDescription& d) {
    double value = 0.2;
    for (const char* key : {"linear", "quadratic", "turning", "quadratic_turning"})
      for (const char* axis : {".x", ".y", ".z"}) d.values[std::string(key) + axis] = value += 0.1;
  });
}

namespace {

/// Two wheels on an imaginary carrier: turned about their axes from one pose of the carrier, or of
/// a hinge between them, at both ends of the step.
struct GearSample {
  LoadDescription d;
  PairMotion motion;
};

GearSample gear_sample(unsigned seed, const StepContext& context, GearCoordinate::Kind kind) {
  using Kind = GearCoordinate::Kind;
  auto [d, m] = sample(seed, context);
  Random random(seed + 100);
  const Vec3 c_1 = random.vector(0.4), c_2 = random.vector(0.4);  // wheel centres in the bodies
  const Mat3 R_1 = d.R_a, R_2 = d.R_b;
  const double tilt = kind == Kind::axes ? 1.1 : 0.0;
  const auto place = [&](const Mat3& carrier, const Vec3& at, double turn_1, double turn_2,
                         Mat3& L_1, Mat3& L_2, Vec3& r_1, Vec3& r_2) {
    const Mat3 second = carrier * exp_map(tilt * Vec3::UnitX());
    L_1 = carrier * exp_map(turn_1 * Vec3::UnitZ()) * R_1.transpose();
    L_2 = second * exp_map(turn_2 * Vec3::UnitZ()) * R_2.transpose();
    r_1 = at - L_1 * c_1;
    r_2 = at + carrier * Vec3(1.3, 0.2, 0.1) - L_2 * c_2;
  };
  Mat3 L_1, L_2;
  Vec3 r_1, r_2, r_1n, r_2n;
  place(random.frame(), random.vector(), 0.4, -0.7, L_1, L_2, r_1n, r_2n);
  m.a_n.q = Quat(L_1).normalized();
  m.b_n.q = Quat(L_2).normalized();
  m.a_n.r = r_1n;
  m.b_n.r = r_2n;
  const Mat3 L_1n = m.a_n.Lambda(), L_2n = m.b_n.Lambda();
  const Mat3 base = L_1n * R_1 * exp_map(-0.4 * Vec3::UnitZ());
  const Vec3 turn = random.vector(0.5), way = random.vector(0.5);
  place(exp_map(turn) * base, m.a_n.r + m.a_n.Lambda() * c_1 + way, 1.2, -0.2, L_1, L_2, r_1, r_2);
  m.theta_a = cayley_vector(L_1 * L_1n.transpose());
  m.theta_b = cayley_vector(L_2 * L_2n.transpose());
  m.u_a = r_1 - r_1n;
  m.u_b = r_2 - r_2n;
  GearPair pair;
  for (int i = 0; i < 2; ++i) {
    GearCoordinate& c = pair.coordinate[static_cast<std::size_t>(i)];
    const Mat3 &own = i == 0 ? R_1 : R_2, &other = i == 0 ? R_2 : R_1;
    c.kind = kind;
    c.angle = FreeAngle{own.col(0), own.col(1), other.col(kind == Kind::axes ? 2 : 0), false};
    c.displacement = FreeDisplacement{i == 0 ? c_1 : c_2, i == 0 ? c_2 : c_1, own.col(0)};
    c.from = i == 0 ? 1 : 2;
    c.to = i == 0 ? 2 : 1;
  }
  d.gear = pair;
  d.values = {{"ratio", -1.7}};
  return {d, m};
}

}  // namespace

// @tests{gear-row} @tests{gear-angle}
TEST(Connectors, GearsDoNoWorkAndHaveTheirTangents) {
  using Kind = GearCoordinate::Kind;
  for (const Kind kind : {Kind::centres, Kind::axes})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      for (const double rho_inf : {1.0, 0.5, 0.0}) {
        auto sampled = gear_sample(seed, context_of(rho_inf), kind);
        auto& d = sampled.d;
        auto& m = sampled.motion;
        const Gear gear(d);
        start(gear, m);
        m.lambda[0] = 1.3;
        expect_derivative(
            wrench_tangent(evaluate(gear, m)),
            [&](const Vec& x) -> Vec { return wrenches(evaluate(gear, m, x)); }, "gear");
        const PairTerms t = evaluate(gear, m);
        Mat G(1, 12);
        G << t.G_a.row(0), t.G_b.row(0);
        expect_derivative(
            G, [&](const Vec& x) -> Vec { return evaluate(gear, m, x).g.head<1>(); }, "gear row");
        if (rho_inf != 1.0) continue;
        // λ times the change of the row.
        EXPECT_NEAR(work_done(m, t), 1.3 * t.g[0], 1e-12) << seed;
        // Wheels turned by 0.8 and by 0.5 against the carrier.
        EXPECT_NEAR(t.g[0], 0.8 + 1.7 * 0.5, 1e-12) << seed;
      }
    }
}

// @tests{coupling-row}
TEST(Connectors, CoupledCoordinatesDoNoWorkAndHaveTheirTangents) {
  for (const bool slides : {false, true})
    for (unsigned seed = 1; seed <= 4; ++seed)
      for (const double rho_inf : {1.0, 0.5, 0.0}) {
        auto sampled = sample(seed, context_of(rho_inf));
        auto& d = sampled.d;
        auto& m = sampled.motion;
        slides ? slide(d) : hinge(d);
        d.coupled = {{d.coordinate(), d.bodies, -1.7, 0.3}};
        const CoordinateRow row(d, 0);
        start(row, m);
        m.lambda[0] = 1.3;
        expect_derivative(
            wrench_tangent(evaluate(row, m)),
            [&](const Vec& x) -> Vec { return wrenches(evaluate(row, m, x)); }, "coupling");
        const PairTerms t = evaluate(row, m);
        Mat G(1, 12);
        G << t.G_a.row(0), t.G_b.row(0);
        expect_derivative(
            G, [&](const Vec& x) -> Vec { return evaluate(row, m, x).g.head<1>(); },
            "coupling row");
        if (rho_inf != 1.0) continue;
        EXPECT_NEAR(work_done(m, t), 1.3 * t.g[0], 1e-12) << seed;
        if (slides) continue;
        EXPECT_NEAR(t.g[0], -1.7 * 0.8, 1e-12) << seed;  // from 0.3 to 1.1
      }
}

// @tests{surface-row}
TEST(Connectors, SurfacesDoNoWorkAndHaveTheirTangents) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (const double c : {0.0, 0.6}) {
      auto sampled = sample(3, context_of(rho_inf));
      auto& d = sampled.d;
      auto& m = sampled.motion;
      d.values = {{"semi_axes.x", 0.9}, {"semi_axes.y", 1.4}, {"semi_axes.z", c}};
      const PointOnSurface surface(d);
      m.lambda[0] = 1.3;
      expect_derivative(
          wrench_tangent(evaluate(surface, m)),
          [&](const Vec& x) -> Vec { return wrenches(evaluate(surface, m, x)); }, "surface");
      const PairTerms t = evaluate(surface, m);
      Mat G(1, 12);
      G << t.G_a.row(0), t.G_b.row(0);
      expect_derivative(
          G, [&](const Vec& x) -> Vec { return evaluate(surface, m, x).g.head<1>(); }, "row");
      if (rho_inf != 1.0) continue;
      const double before = m.at_start([&](const PairStep& s) {
        PairTerms now;
        now.set_zero();
        surface.evaluate(s, now);
        return now.g[0];
      });
      EXPECT_NEAR(work_done(m, t), 1.3 * (t.g[0] - before), 1e-12);
    }
}

// Second derivative of the row by differences along a free motion.
TEST(Connectors, GearsHaveTheirAccelerationTerms) {
  using Kind = GearCoordinate::Kind;
  for (const Kind kind : {Kind::centres, Kind::axes, Kind::angle, Kind::displacement}) {
    auto sampled = gear_sample(2, context_of(0.0), kind);
    auto& d = sampled.d;
    auto& m = sampled.motion;
    const Gear gear(d);
    start(gear, m);
    const auto at = [&](double t, auto&& what) {
      BodyStep a = PairMotion::instant(m.a_n), b = PairMotion::instant(m.b_n);
      for (auto [s, n] : {std::pair(&a, &m.a_n), std::pair(&b, &m.b_n)}) {
        const Mat3 L = n->Lambda() * exp_map(t * n->W);  // constant spin and speed
        *s = BodyStep::at_instant(n->r + t * n->v, L, n->v, n->W);
      }
      StepContext still = m.context;
      still.conserving = false;
      return what(PairStep{a, b, still, m.lambda.data(), m.history.data()});
    };
    const auto row = [&](double t) {
      return at(t, [&](const PairStep& s) {
        PairTerms terms;
        terms.set_zero();
        gear.evaluate(s, terms);
        return terms.g[0];
      });
    };
    const double h = 1e-3;
    const double second = (row(h) - 2.0 * row(0.0) + row(-h)) / (h * h);
    const double gamma = at(0.0, [&](const PairStep& s) {
      Vec6 g = Vec6::Zero();
      gear.acceleration_terms(s, g);
      return g[0];
    });
    EXPECT_NEAR(gamma, second, 1e-3 * (1.0 + std::abs(second))) << static_cast<int>(kind);
  }
}

// Gauss's rule on halves finds kinks to round-off.
TEST(ForceLaw, MeansOfFunctionsWithKinksAreExact) {
  const Function kinked([](double x) { return std::abs(x - 0.31); });
  EXPECT_NEAR(mean_value(kinked, 0.0, 1.0), 0.5 * (0.31 * 0.31 + 0.69 * 0.69), 1e-14);
  const Function smooth([](double x) { return std::exp(3.0 * x); });
  EXPECT_NEAR(mean_value(smooth, -2.0, 2.0), (std::exp(6.0) - std::exp(-6.0)) / 12.0, 1e-12);
}

}  // namespace polhode::test::connectors_tests
