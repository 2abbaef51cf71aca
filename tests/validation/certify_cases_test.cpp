// SPDX-License-Identifier: Apache-2.0
// Error bars of published cases against what is known: the true error lies within the bar, and the
// bar is at most ten times as wide. Definitions and references are those of published_cases.hpp;
// docs/validation.md has the figures.
#include <cmath>
#include <functional>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/study/certify.hpp>
#include <support/known_solutions/free_symmetric_top.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::certify_cases_tests {
namespace {

/// Exact value of a quantity at a time; an empty vector where it is not known.
using Exact = std::function<Vec(double t)>;

/// The rows of a reference as values at its times.
Exact rows_of(const std::string& name, const std::function<Vec(const Vec&)>& value) {
  return [reference = Reference::read(name), value](double t) -> Vec {
    for (std::size_t i = 0; i < reference.t.size(); ++i)
      if (std::abs(reference.t[i] - t) < 1e-9) return value(reference.values[i]);
    return {};
  };
}

/// A probe of a point of a body.
ProbeSpec point_probe(const Model& model, int body, const Vec3& Z) {
  ProbeSpec probe;
  probe.kind = "body";
  probe.name = "p";
  probe.target = model.bodies[static_cast<std::size_t>(body)].name;
  probe.point = Z;
  return probe;
}

/// A model, its run, and the exact values of its quantities.
struct CertifiedCase {
  std::string name;
  Model model;
  std::vector<std::pair<std::string, Exact>> known;

  CertifiedCase& steps_of(double step, double duration, std::optional<int> order = {}) {
    model.analysis.step = step;
    model.analysis.duration = duration;
    model.analysis.order = order;
    return *this;
  }
  CertifiedCase& automatic(double tolerance, double duration, double every) {
    name += "_automatic";
    model.analysis.step.reset();
    model.analysis.tolerance = tolerance;
    model.analysis.duration = duration;
    model.output.every = every;
    return *this;
  }
};

std::ostream& operator<<(std::ostream& out, const CertifiedCase& c) { return out << c.name; }

CertifiedCase of_point(const std::string& name, Model model, int body, const Vec3& Z,
                       const std::string& data, const std::function<Vec(const Vec&)>& value) {
  model.output.probes = {point_probe(model, body, Z)};
  return {name, std::move(model), {{"p x y z", rows_of(data, value)}}};
}

Vec planar(const Vec& row) { return Vec3(row[0], row[1], 0.0); }

CertifiedCase pendulum() {
  return of_point("A01", planar_pendulum(), 0, Vec3::Zero(), "planar_pendulum", planar);
}
CertifiedCase four_bars(int N) {
  const std::string n = std::to_string(N);
  return of_point("A02_" + n, n_four_bar(N), 0, kFourBarB0, "n_four_bar_" + n, planar);
}
CertifiedCase squeezer() {
  CertifiedCase c{"A03", andrews_squeezer(), {}};
  for (std::size_t k = 0; k < andrews_angles().size(); ++k) {
    ProbeSpec probe;
    probe.kind = "joint";
    probe.name = probe.target = andrews_angles()[k];
    c.model.output.probes.push_back(probe);
    const auto row = static_cast<Eigen::Index>(k);
    c.known.emplace_back(probe.name + " rz", rows_of("andrews_squeezer", [row](const Vec& v) {
                           return Vec(v.segment(row, 1));
                         }));
  }
  return c;
}
CertifiedCase loop_of_bricard() {
  return of_point("A04", bricard(), 1, kBricardP3, "bricard",
                  [](const Vec& row) { return Vec(row.head(3)); });
}
CertifiedCase governor() {
  return of_point("A05", flyball_governor(), 1, Vec3::Zero(), "flyball_governor",
                  [](const Vec& row) { return Vec3(0.0, 0.0, row[0]); });
}
CertifiedCase top() {
  return of_point("HT", heavy_top(), 0, Vec3::Zero(), "heavy_top",
                  [](const Vec& row) { return Vec(row.head(3)); });
}
CertifiedCase slider_crank() {
  return of_point("SC3D", spatial_slider_crank(), 2, Vec3::Zero(), "spatial_slider_crank",
                  [](const Vec& row) { return Vec3(row[0], 0.0, 0.0); });
}
CertifiedCase tumbling() {
  const Vec3 Z(1.0, 0.5, 0.2);
  return of_point("FreeTop", free_asymmetric_top(), 0, Z, "free_asymmetric_top",
                  [Z](const Vec& row) { return Vec3(Quat(row[3], row[4], row[5], row[6]) * Z); });
}
CertifiedCase symmetric() {
  const Vec3 W(0.3, 0.0, 4.0), Z(1.0, 0.5, 0.2);
  Model model = free_symmetric_top(W);
  model.output.probes = {point_probe(model, 0, Z)};
  const FreeSymmetricTop known{1.0, 2.0, W};
  return {"SymmetricTop",
          model,
          {{"p x y z", [=](double t) { return Vec3(known.orientation(t) * Z); }}}};
}

/// A mass on a spring with a damper, released at rest: closed form of textbooks on vibrations.
CertifiedCase damped_oscillator() {
  Model model = io::read_model_text(R"(format: 1
bodies:
  mass: {mass: 2, inertia: [1, 1, 1], position: [1.3, 0, 0], hold: [y, z, rx, ry, rz]}
loads:
  spring: {type: spring_damper, bodies: [ground, mass], at: [[0, 0, 0], [1.3, 0, 0]], stiffness: 50, damping: 1.5, free_length: 1}
analysis: {duration: 5 s, step: 20 ms}
output: {probes: {p: {body: mass}}}
)",
                                    "oscillator.yaml");
  const double d = 1.5 / 4.0, w = std::sqrt(25.0 - d * d);
  return {"Oscillator",
          model,
          {{"p x y z",
            [=](double t) {
              const double x = 0.3 * std::exp(-d * t) * (std::cos(w * t) + d / w * std::sin(w * t));
              return Vec3(1.0 + x, 0.0, 0.0);
            }},
           {"p vx vy vz", [=](double t) {
              return Vec3(-0.3 * std::exp(-d * t) * (w + d * d / w) * std::sin(w * t), 0.0, 0.0);
            }}}};
}

std::vector<CertifiedCase> cases() {
  return {
      pendulum().steps_of(10e-3, 10.0),
      four_bars(1).steps_of(10e-3, 10.0),
      four_bars(2).steps_of(10e-3, 10.0),
      four_bars(10).steps_of(10e-3, 10.0),
      four_bars(40).steps_of(10e-3, 10.0),
      squeezer().steps_of(50e-6, 0.03),
      loop_of_bricard().steps_of(10e-3, 10.0),
      governor().steps_of(10e-3, 10.0),
      top().steps_of(1e-3, 2.0),
      slider_crank().steps_of(4e-3, 5.0),
      tumbling().steps_of(10e-3, 50.0),
      symmetric().steps_of(20e-3, 10.0),
      damped_oscillator(),
  };
}

std::vector<CertifiedCase> other_orders() {
  std::vector<CertifiedCase> list{pendulum().steps_of(50e-3, 10.0, 4),
                                  squeezer().steps_of(0.5e-3, 0.03, 6),
                                  top().steps_of(5e-3, 2.0, 4),
                                  loop_of_bricard().steps_of(50e-3, 10.0, 4),
                                  slider_crank().steps_of(10e-3, 5.0, 4),
                                  tumbling().steps_of(50e-3, 50.0, 4),
                                  pendulum().automatic(1e-5, 10.0, 0.1),
                                  four_bars(1).automatic(1e-5, 10.0, 0.1),
                                  squeezer().automatic(1e-4, 0.03, 0.5e-3),
                                  slider_crank().automatic(1e-4, 5.0, 0.5),
                                  governor().automatic(1e-4, 10.0, 0.05),
                                  top().automatic(1e-4, 2.0, 0.1)};
  for (std::size_t k = 0; k < 6; ++k)
    list[k].name += "_order_" + std::to_string(*list[k].model.analysis.order);
  return list;
}

/// True error and bar of a certified quantity.
struct Finding {
  std::string quantity;
  double error = 0.0, bar = 0.0;
  double inside = 0.0;  ///< Part of the compared times at which the bar holds the error.
  double order = 0.0;
  int samples = 0;
};

Finding compare(const Certificate& certificate, const std::string& name, const Exact& exact) {
  Finding f{.quantity = name};
  for (const CertifiedQuantity& q : certificate.quantities) {
    if (q.name() != name) continue;
    f.order = q.report.order.value_or(std::nan(""));
    for (std::size_t i = 0; i < q.series.t.size(); ++i) {
      const Vec known = exact(q.series.t[i]);
      if (known.size() == 0 || std::isinf(q.report.bar[i])) continue;
      const double error =
          (q.series.values[2].row(static_cast<Eigen::Index>(i)).transpose() - known).norm();
      f.error = std::max(f.error, error);
      f.bar = std::max(f.bar, q.report.bar[i]);
      f.inside += error <= q.report.bar[i] ? 1.0 : 0.0;
      ++f.samples;
    }
  }
  f.inside /= std::max(1, f.samples);
  return f;
}

class Certified : public testing::TestWithParam<CertifiedCase> {};

TEST_P(Certified, ErrorBarContainsTheTrueErrorAndIsNotTenTimesAsWide) {
  const CertifiedCase& c = GetParam();
  const Certificate certificate = certify(c.model);
  EXPECT_TRUE(certificate.converges());
  for (const auto& [name, exact] : c.known) {
    const Finding f = compare(certificate, name, exact);
    RecordProperty(name, format("error {:.2e}, bar {:.2e}, order {:.2f}", f.error, f.bar, f.order));
    SCOPED_TRACE(format("{}: error {:.2e}, bar {:.2e}, inside {:.3f} of the time, order {:.2f}",
                        name, f.error, f.bar, f.inside, f.order));
    EXPECT_GE(f.samples, certificate.automatic ? 10 : 50);
    EXPECT_LE(f.error, f.bar);
    EXPECT_LE(f.bar, 10.0 * f.error);
    EXPECT_GE(f.inside, 0.95);
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Certified, testing::ValuesIn(cases()),
                         [](const auto& p) { return p.param.name; });
INSTANTIATE_TEST_SUITE_P(OtherOrders, Certified, testing::ValuesIn(other_orders()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test::certify_cases_tests
