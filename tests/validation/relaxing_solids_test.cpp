// SPDX-License-Identifier: Apache-2.0
// Solids whose stress relaxes, against closed forms of linear viscoelasticity, and against the
// convolution of the nonlinear law integrated by itself.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <support/run_text.hpp>

namespace polhode::relaxing_solids_tests {
namespace {

using test::finished;
using test::made;

constexpr double kE = 1e6;  // Young's modulus of all bars here [Pa]; their area is 0.01 m².
constexpr double kArea = 0.01;
struct Term {
  double g, tau;
};
const std::vector<Term> kSeries{{0.9, 0.3}, {0.4, 2.0}};
constexpr double kRest = 0.7;  // Factor of the part that stays.
const std::string kRelaxes =
    ", relaxation: [{modulus_ratio: 0.9, time: 0.3 s}, {modulus_ratio: 0.4, time: 2 s}], "
    "long_term_ratio: 0.7";

/// A bar of 1 m by 0.1 m by 0.1 m whose end is moved along it; its sides are free.
std::string bar(const std::string& material, const std::string& element, const std::string& end,
                const std::string& analysis, const std::string& more = "") {
  return R"(
format: 1
materials: {m: )" +
         material + R"(}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [2, 1, 1]}, position: [0.5, 0.05, 0.05]}
    element: )" +
         element + R"(
    material: m
)" + more +
         R"(    prescribed:
      end: {nodes: xmax, x: )" +
         end + R"(}
      wall: {nodes: xmin, x: 0}
      front: {nodes: ymin, y: 0}
      floor: {nodes: zmin, z: 0}
analysis: )" +
         analysis + R"(
output: {hdf5: false, every: 0.25 s}
)";
}
std::string elastic(const std::string& more = kRelaxes, double density = 1000.0) {
  return format("{{type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: {:g}{}}}",
                density, more);
}

struct Sample {
  double t, force;
};
/// Forces at the end of the bar, at the output times.
std::vector<Sample> forces(const std::string& text) {
  Simulation s = made(text);
  std::vector<Sample> list;
  const RunSummary r = s.run([&](Simulation& now) {
    list.push_back({now.time(), now.interface_reaction(0, 0).force.x()});
  });
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return list;
}

/// Stress of a ramp of the strain of size one over a time T, then held, in units of the modulus.
double after_ramp(double t, double T) {
  double stress = kRest * std::min(t, T) / T;
  for (const Term& m : kSeries) {
    const double decay = std::exp(-std::min(t, T) / m.tau);
    stress += m.g * m.tau / T * (1.0 - decay) * std::exp(-std::max(t - T, 0.0) / m.tau);
  }
  return stress;
}

/// Statics and dynamics of a light bar, with steps of any length.
const std::string kHistories[] = {"{type: statics, history: 3 s}",
                                  "{type: statics, history: 3 s, load_steps: 12}",
                                  "{type: statics, history: 3 s, load_steps: 1200}"};

}  // namespace

// A ramp of 1 s, then 2 s of relaxation, at strains so small that the material is linear. The
// memory is exact for a stress that is linear in time, so that coarse steps are exact as well.
// @tests{solid-relaxation} @tests{solid-relaxation-step}
TEST(RelaxingSolids, ABarRelaxesAfterARampAsTheConvolutionSays) {
  const std::string ramp = "{table: [[0, 0], [1, 1e-7], [3, 1e-7]], interpolation: linear}";
  for (const char* element : {"hex8_eas9", "hex20", "tet10"})
    for (const std::string& history : kHistories) {
      if (history == kHistories[2] && std::string(element) != "hex8_eas9") continue;
      const auto seen = forces(bar(elastic(), element, ramp, history));
      ASSERT_GT(seen.size(), 12u);
      for (const Sample& s : seen)
        EXPECT_NEAR(s.force / (kE * kArea * 1e-7), after_ramp(s.t, 1.0), 2e-6)
            << element << ' ' << history << " at " << s.t;
    }
}

// The displacement of the start acts at once, with the stiffness of a fast motion.
TEST(RelaxingSolids, AJumpAtTheStartRelaxesFromTheInstantaneousStiffness) {
  for (const std::string& history : kHistories) {
    const auto seen = forces(bar(elastic(), "hex8_eas9", "1e-7", history));
    for (const Sample& s : seen) {
      double stress = kRest;
      for (const Term& m : kSeries) stress += m.g * std::exp(-s.t / m.tau);
      EXPECT_NEAR(s.force / (kE * kArea * 1e-7), stress, 2e-6) << history << " at " << s.t;
    }
  }
  // Statics without time: what remains in the end.
  Simulation s = made(bar(elastic(), "hex8_eas9", "1e-7", "{type: statics}"));
  finished(s);
  EXPECT_NEAR(s.interface_reaction(0, 0).force.x() / (kE * kArea * 1e-7), kRest, 1e-6);
}

// Storage and loss modulus of the series, from the last of sixteen periods: second order in the
// step, from 24 steps a period on.
TEST(RelaxingSolids, HarmonicStrainMeetsStorageAndLossModulus) {
  const double omega = 2.0 * std::numbers::pi / 1.5;
  double storage = kRest, loss = 0.0;
  for (const Term& m : kSeries) {
    const double wt = omega * m.tau;
    storage += m.g * wt * wt / (1.0 + wt * wt);
    loss += m.g * wt / (1.0 + wt * wt);
  }
  std::vector<double> errors;
  for (const int steps : {96, 192, 960}) {
    const std::string text =
        bar(elastic(), "hex8_standard", format("\"1e-7*sin({:.17g}*t)\"", omega),
            format("{{type: statics, history: 24 s, load_steps: {}}}", 4 * steps));
    const auto seen = forces(text);
    double in_phase = 0.0, out = 0.0;
    int count = 0;
    for (const Sample& s : seen) {
      if (s.t < 22.5 - 1e-9 || s.t > 24.0 - 1e-9) continue;  // a period of 1.5 s, six samples
      in_phase += 2.0 * s.force * std::sin(omega * s.t);
      out += 2.0 * s.force * std::cos(omega * s.t);
      ++count;
    }
    ASSERT_EQ(count, 6) << steps;
    const double scale = kE * kArea * 1e-7 * count;
    errors.push_back(std::hypot(in_phase / scale - storage, out / scale - loss));
  }
  EXPECT_LT(errors[0], 5e-3);
  EXPECT_LT(errors[1], 0.28 * errors[0]);
  EXPECT_LT(errors[2], 0.05 * errors[1]);
  EXPECT_GT(loss, 0.3);  // a case in which the loss counts
}

// Stretch by a quarter within 0.5 s and back to a tenth at 2 s, free sides: the sides follow from
// S_22 = 0 at every time. The convolution is integrated here with the midpoint rule of its own, in
// steps of 0.1 ms.
TEST(RelaxingSolids, LargeUniaxialStretchIsTheConvolutionOfTheNonlinearLaw) {
  struct Case {
    const char *material, *element;
    solids::MaterialDescription law;
  };
  const Case all[] = {
      {"{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000",
       "hex8_eas9",
       {.kind = "neo_hookean", .values = {{"youngs_modulus", 1e6}, {"poisson_ratio", 0.3}}}},
      {"{type: mooney_rivlin_uncoupled, c1: 150 kPa, c2: 30 kPa, bulk_modulus: 40 MPa, "
       "density: 1000",
       "hex8_q1p0",
       {.kind = "mooney_rivlin_uncoupled",
        .values = {{"c1", 1.5e5}, {"c2", 3e4}, {"bulk_modulus", 4e7}}}},
      {"{type: ogden_uncoupled, c1: 200 kPa, m1: 5, bulk_modulus: 40 MPa, density: 1000",
       "hex20",
       {.kind = "ogden_uncoupled", .values = {{"c1", 2e5}, {"m1", 5.0}, {"bulk_modulus", 4e7}}}}};
  const auto stretch = [](double t) {
    return t < 0.5 ? 1.0 + 0.5 * t : t < 2.0 ? 1.25 - 0.1 * (t - 0.5) : 1.1;
  };
  for (const Case& c : all) {
    const auto material = solids::make_material("m", c.law);
    const auto strain = [](double l, double side) {
      Vec6 E = Vec6::Zero();
      E << 0.5 * (l * l - 1.0), 0.5 * (side * side - 1.0), 0.5 * (side * side - 1.0), 0, 0, 0;
      return E;
    };
    const auto part = [&](const Vec6& E, bool whole) -> Vec6 {
      return solids::discrete_stress(*material, E, E, Vec3::UnitX(), whole).S;
    };
    const bool uncoupled = material->uncoupled();
    // Elastic part that remembers, and what does not: the pressure of an uncoupled material.
    std::array<Vec6, 2> Q{Vec6::Zero(), Vec6::Zero()};
    const auto total = [&](const Vec6& E, const std::array<Vec6, 2>& memory) -> Vec6 {
      const Vec6 own = part(E, !uncoupled);
      Vec6 S = kRest * own;
      if (uncoupled) S += part(E, true) - own;
      for (std::size_t k = 0; k < 2; ++k) S += kSeries[k].g * (own - memory[k]);
      return S;
    };
    // Secant method for the side at a time.
    const auto side_at = [&](double l, const std::array<Vec6, 2>& memory, double guess) {
      double a = guess, b = guess + 1e-6;
      double f_a = total(strain(l, a), memory)[1];
      for (int i = 0; i < 30; ++i) {
        const double f_b = total(strain(l, b), memory)[1];
        if (std::abs(f_b) < 1e-8 * kE || f_b == f_a) break;
        const double next = b - f_b * (b - a) / (f_b - f_a);
        a = b, f_a = f_b, b = next;
      }
      return b;
    };
    const double h = 1e-4;
    std::vector<double> force{0.0};
    double side = 1.0;
    for (int n = 0; n < 30000; ++n) {
      // Midpoint rule: half a step by Euler's rule, then a whole one with the middle's rates.
      const double t = n * h;
      const auto rates = [&](const std::array<Vec6, 2>& memory, double l, double x) {
        std::array<Vec6, 2> rate;
        const Vec6 own = part(strain(l, x), !uncoupled);
        for (std::size_t k = 0; k < 2; ++k) rate[k] = (own - memory[k]) / kSeries[k].tau;
        return rate;
      };
      std::array<Vec6, 2> middle = Q;
      const auto first = rates(Q, stretch(t), side);
      for (std::size_t k = 0; k < 2; ++k) middle[k] += 0.5 * h * first[k];
      const double l_m = stretch(t + 0.5 * h);
      side = side_at(l_m, middle, side);
      const auto second = rates(middle, l_m, side);
      for (std::size_t k = 0; k < 2; ++k) Q[k] += h * second[k];
      const double l = stretch(t + h);
      side = side_at(l, Q, side);
      if ((n + 1) % 2500 == 0) force.push_back(kArea * l * total(strain(l, side), Q)[0]);
    }
    const std::string path =
        "{table: [[0, 0], [0.5, 0.25], [2, 0.1], [3, 0.1]], interpolation: linear}";
    std::vector<double> errors;
    for (const int steps : {60, 120, 600}) {
      const auto seen =
          forces(bar(c.material + kRelaxes + "}", c.element, path,
                     format("{{type: statics, history: 3 s, load_steps: {}}}", steps)));
      ASSERT_EQ(seen.size(), force.size());
      double most = 0.0, largest = 0.0;
      for (std::size_t i = 0; i < seen.size(); ++i) {
        most = std::max(most, std::abs(seen[i].force - force[i]));
        largest = std::max(largest, std::abs(force[i]));
      }
      errors.push_back(most / largest);
    }
    EXPECT_LT(errors[0], 2e-3) << c.material;
    EXPECT_LT(errors[1], 0.3 * errors[0]) << c.material;
    EXPECT_LT(errors[2], 0.06 * errors[1]) << c.material;
  }
}

namespace {

/// A body of 3 kg on a light bar without lateral contraction, pulled by a constant force; the same
/// by the exponential of its linear equations.
constexpr double kMass = 3.0, kForce = 1e-5, kSpring = 3e3 * kArea;

std::string hung_body(const std::string& analysis) {
  return R"(
format: 1
materials: {m: {type: elastic, youngs_modulus: 3 kPa, poisson_ratio: 0, density: 1e-6)" +
         kRelaxes + R"(}}
bodies: {weight: {mass: 3, inertia: [1, 1, 1], position: [1, 0, 0]}}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [1, 1, 1]}, position: [0.5, 0, 0]}
    element: hex8_standard
    material: m
    bonded: {ground: xmin, weight: xmax}
loads: {f: {type: force, body: weight, force: [1e-5, 0, 0]}}
analysis: )" +
         analysis + "\noutput: {hdf5: false, every: 0.1 s}\n";
}
/// Displacements every 0.1 s, by the series of the exponential in small steps of the linear system
/// m x'' = F − k (g₀ x + Σ g h), h' = x' − h/τ.
std::vector<double> linear_creep(int count) {
  Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Zero();  // x, v, h₁, h₂, 1
  A(0, 1) = 1.0;
  A(1, 0) = -kSpring * kRest / kMass;
  A(1, 4) = kForce / kMass;
  for (int i = 0; i < 2; ++i) {
    const Term& m = kSeries[static_cast<std::size_t>(i)];
    A(1, 2 + i) = -kSpring * m.g / kMass;
    A(2 + i, 1) = 1.0;
    A(2 + i, 2 + i) = -1.0 / m.tau;
  }
  Eigen::Matrix<double, 5, 1> y;
  y << 0, 0, 0, 0, 1;
  std::vector<double> x;
  for (int n = 0; n <= 10 * count; ++n) {
    if (n % 10 == 0) x.push_back(y[0]);
    Eigen::Matrix<double, 5, 1> term = y;
    for (int j = 1; j < 14; ++j) {
      term = A * term * (0.01 / j);
      y += term;
    }
  }
  return x;
}

}  // namespace

// Creep with oscillations over four periods, at a coarse, the usual and a hundredfold finer step:
// second order, with and without numerical damping.
TEST(RelaxingSolids, ABodyCreepsAndSwingsAsTheLinearEquationsSay) {
  const std::vector<double> exact = linear_creep(60);
  const double size = *std::max_element(exact.begin(), exact.end());
  for (const char* rho : {"1", "0.8", "0"}) {
    std::vector<double> errors;
    for (const double step : {0.1, 0.05, 0.01, 0.001}) {
      Simulation s =
          made(hung_body(format("{{duration: 6 s, step: {:g}, rho_inf: {}}}", step, rho)));
      double most = 0.0;
      std::size_t seen = 0;
      const RunSummary r = s.run([&](Simulation& now) {
        most = std::max(most, std::abs(now.body(0).r.x() - 1.0 - exact.at(seen)) / size);
        ++seen;
      });
      EXPECT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_EQ(seen, exact.size());
      errors.push_back(most);
      // Displacements are 1e-6 of the positions, whose rounding the forces have.
      if (std::string(rho) == "1") {
        EXPECT_LT(r.energy_drift, 1e-9) << step;
      }
    }
    EXPECT_LT(errors[0], 0.2) << rho;
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), 2.0, 0.35) << rho;
    EXPECT_NEAR(std::log(errors[1] / errors[2]) / std::log(5.0), 2.0, 0.2) << rho;
    EXPECT_NEAR(std::log10(errors[2] / errors[3]), 2.0, 0.1) << rho;
  }
}

// A relaxing half behind an elastic one: the strain of the first has the longer relaxation time
// τ (1 + g E₁/(g₀ E₁ + E₂)).
TEST(RelaxingSolids, ARegionRelaxesAgainstAnElasticOne) {
  const double g = 1.5, tau = 0.4, stiff = 3.0 * kE, jump = 1e-7;
  const auto force = [&](double t) {
    const double both = 2.0 * jump;  // strain of the halves together
    const double start = stiff * both / (kE * (1.0 + g) + stiff);
    const double slow = tau * (1.0 + g * kE / (kE + stiff));
    const double h = start * std::exp(-t / slow);
    return kArea * stiff * (both - (stiff * both - kE * g * h) / (kE + stiff));
  };
  const std::string more =
      "    regions: {tip: {material: hard, within: {box: {from: [0, -1, -1], to: [2, 1, 1]}}}}\n";
  for (const char* element : {"hex8_standard", "wedge6"}) {
    std::vector<double> errors;
    for (const int steps : {30, 60, 600}) {
      std::string text =
          bar("{type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0, "
              "density: 1000, relaxation: {modulus_ratio: 1.5, time: 0.4 s}}, "
              "hard: {type: elastic, youngs_modulus: 3 MPa, poisson_ratio: 0, "
              "density: 2000}",
              element, "1e-7", format("{{type: statics, history: 1.5 s, load_steps: {}}}", steps),
              more);
      double most = 0.0;
      for (const Sample& s : forces(text))
        most = std::max(most, std::abs(s.force / force(s.t) - 1.0));
      errors.push_back(most);
    }
    EXPECT_LT(errors[0], 2e-3) << element;
    EXPECT_LT(errors[1], 0.3 * errors[0]) << element;
    EXPECT_LT(errors[2], 0.05 * errors[1] + 1e-6) << element;
  }
}

// Names of the analyses and parts that such a material is not combined with.
TEST(RelaxingSolids, WhatTheyAreNotCombinedWithIsRefusedByName) {
  const std::string still = "0";
  const auto with = [&](const std::string& analysis) {
    return bar(elastic(), "hex8_standard", still, analysis);
  };
  test::expect_fault(with("{duration: 1 s, step: 10 ms, order: 4}"),
                     "the stress of 'solids.bar' relaxes");
  test::expect_fault(with("{duration: 1 s, step: 10 ms, method: extrapolation}"),
                     "the stress of 'solids.bar' relaxes");
  test::expect_fault(with("{duration: 1 s, step: 10 ms, order: 4, method: composition}"),
                     "cannot be combined with the relaxation of 'm'");
  test::expect_fault(
      bar(elastic(), "hex8_standard\n    stress: midpoint", still, "{duration: 1 s, step: 10 ms}"),
      "'stress' is midpoint");
  test::expect_fault(bar(elastic(", long_term_ratio: 0.5"), "hex8_standard", still,
                         "{duration: 1 s, step: 10 ms}"),
                     "'long_term_ratio' is given without 'relaxation'");
}

// A tolerance chooses order 2 and says why.
TEST(RelaxingSolids, AutomaticStepsAreOfOrderTwo) {
  const Simulation s = made(
      bar(elastic(), "hex8_standard", "\"1e-3*sin(3*t)\"", "{duration: 0.1 s, tolerance: 1e-6}"));
  EXPECT_EQ(s.summary().order, 2);
}

}  // namespace polhode::relaxing_solids_tests
