// SPDX-License-Identifier: Apache-2.0
// Contacts that are rows and break away, turn around, stop or lift off within automatic steps,
// against closed forms of the motion, at tolerances from coarse to fine.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::contact_passages_tests {
namespace {

constexpr double kG = 10.0;

/// A body on a plane, and where it is at the end.
struct Passage {
  std::string name{};
  std::string body{}, loads{}, gravity{}, contact{};
  double end = 1.0;           ///< [s]
  double x = 0.0, z = 0.0;    ///< Of its centre [m].
  double angle = 0.0;         ///< Rotation about z since the start [rad].
  Vec3 v = Vec3::Zero();      ///< [m/s]
  double of_tolerance = 1.0;  ///< Allowed error of positions.
};

constexpr const char* kBox = "mass: 2, shape: {box: [0.2, 0.2, 0.1]}, position: [0, 0, 0.05]";
constexpr const char* kBall = "mass: 2, shape: {sphere: 0.2}, position: [0, 0, 0.1]";

/// Pushed by 5 sin 3t N at the floor against 3 N of friction.
Passage breaks_away() {
  const double begins = std::asin(0.6) / 3.0, t = 1.0 - begins, T = 1.0, m = 2.0;
  Passage p{.name = "breaks away", .body = kBox};
  p.loads = "  f: {type: force, body: it, force: [5*sin(3*t), 0, 0], at_body: [0, 0, -0.05]}\n";
  p.contact = "friction: 0.15";
  p.end = T;
  p.x = 5.0 / (3.0 * m) * (0.8 * t - (std::sin(3.0 * T) - 0.6) / 3.0) - 1.5 / m * t * t;
  p.v.x() = 5.0 / (3.0 * m) * (0.8 - std::cos(3.0 * T)) - 3.0 / m * t;
  p.z = 0.05;
  return p;
}

/// Shot up an incline of 25 degrees, down again; or with more friction, where it stays.
Passage on_an_incline(double mu, double T) {
  const double slope = 25.0 * std::numbers::pi / 180.0, v = 2.0,
               up = kG * (std::sin(slope) + mu * std::cos(slope));
  const double down = std::max(0.0, kG * (std::sin(slope) - mu * std::cos(slope)));
  const double turns = v / up;
  Passage p{.name = down > 0.0 ? "turns around" : "stops on an incline",
            .body = format("{}, velocity: [{}, 0, 0]", kBox, v)};
  p.gravity = format("[{:.17g}, 0, {:.17g}]", -kG * std::sin(slope), -kG * std::cos(slope));
  p.contact = format("friction: {}", mu);
  p.end = T;
  p.x = 0.5 * v * turns - 0.5 * down * (T - turns) * (T - turns);
  p.v.x() = -down * (T - turns);
  p.z = 0.05;
  return p;
}

/// Lifted by 11 t N against its weight of 20 N.
Passage lifts_off() {
  const double t = 2.5 - 20.0 / 11.0;
  Passage p{.name = "lifts off", .body = kBall};
  p.loads = "  f: {type: force, body: it, force: [0, 0, 11*t]}\n";
  p.end = 2.5;
  p.z = 0.1 + 11.0 / 12.0 * t * t * t;
  p.v.z() = 11.0 / 4.0 * t * t;
  return p;
}

/// A ball that spins about z, against torsional friction of 2 mm.
Passage stops_spinning() {
  const double rate = 6.0, slows = 0.002 * 2.0 * kG / (0.4 * 2.0 * 0.01);
  Passage p{.name = "stops spinning",
            .body = format("{}, angular_velocity: [0, 0, {}]", kBall, rate)};
  p.contact = "friction: 0.5, torsional_friction: 2 mm";
  p.end = 1.5;
  p.angle = 0.5 * rate * rate / slows;
  p.z = 0.1;
  p.of_tolerance = 3.0;
  return p;
}

/// A ball that rolls, against rolling friction of 10 mm.
Passage stops_rolling() {
  const double v = 1.0, slows = 0.01 * kG / 0.1 / 1.4;
  Passage p{
      .name = "stops rolling",
      .body = format("{}, velocity: [{}, 0, 0], angular_velocity: [0, {}, 0]", kBall, v, v / 0.1)};
  p.contact = "friction: 0.5, rolling_friction: 10 mm";
  p.end = 2.0;
  p.x = 0.5 * v * v / slows;
  p.z = 0.1;
  p.of_tolerance = 3.0;
  return p;
}

std::vector<Passage> passages() {
  return {breaks_away(), on_an_incline(0.3, 1.2), on_an_incline(0.6, 1.2),
          lifts_off(),   stops_spinning(),        stops_rolling()};
}

std::string model(const Passage& p, double tolerance) {
  return format(
      "format: 1\ngravity: {}\nbodies:\n  floor: {{fixed: true, shape: {{plane: z}}}}\n  it: "
      "{{{}}}\n{}{}contacts: {{default: {{{}}}}}\nanalysis: {{duration: {}, tolerance: {}}}\n"
      "output: {{hdf5: false}}\n",
      p.gravity.empty() ? format("[0, 0, {}]", -kG) : p.gravity, p.body,
      p.loads.empty() ? "" : "loads:\n", p.loads, p.contact, p.end, tolerance);
}

}  // namespace

// @tests{break-away} @tests{force-kink}
TEST(ContactPassages, CostNoMoreThanTheTolerance) {
  for (const Passage& p : passages())
    for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
      Simulation s = made(model(p, tolerance));
      const RunSummary r = finished(s);
      const BodyMotion end = s.body(1);
      const std::string what = format("{}, {}, {} steps", p.name, tolerance, r.steps);
      const double angle = 2.0 * std::atan2(end.q.z(), end.q.w());
      EXPECT_LT(std::abs(end.r.x() - p.x), p.of_tolerance * tolerance) << what;
      EXPECT_LT(std::abs(end.r.z() - p.z), p.of_tolerance * tolerance) << what;
      EXPECT_LT(std::abs(std::remainder(angle - p.angle, 2.0 * std::numbers::pi)),
                p.of_tolerance * tolerance)
          << what;
      EXPECT_LT((end.v - p.v).norm(), 10.0 * p.of_tolerance * tolerance) << what;
      EXPECT_LT(r.rejected_steps, 120) << what;
    }
}

}  // namespace polhode::test::contact_passages_tests
