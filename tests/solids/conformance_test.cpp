// SPDX-License-Identifier: Apache-2.0
// Laws that every element of the registry obeys with every material of the registry.
#include <cmath>

#include <gtest/gtest.h>

#include <solids/solid_step.hpp>

#include <polhode/core/error.hpp>

namespace polhode::test::conformance_tests {
namespace {

enum class Stress { kConserving, kMidpoint, kViscous, kRelaxing };

struct Case {
  std::string element;
  double rho_inf;  // 1: α_f = 0.5; 0.25: α_f = 0.8
  Stress stress;
};

int kernel_width() { return solids::element_kernels("automatic").width; }

std::string label_of(const Case& c) {
  return c.element + (c.rho_inf == 1.0 ? "" : "_dissipative") +
         (c.stress == Stress::kMidpoint   ? "_midpoint"
          : c.stress == Stress::kViscous  ? "_viscous"
          : c.stress == Stress::kRelaxing ? "_relaxing"
                                          : "");
}

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const solids::ElementKind& kind : solids::element_kinds())
    for (const double rho_inf : {1.0, 0.25})
      for (const Stress stress :
           {Stress::kConserving, Stress::kMidpoint, Stress::kViscous, Stress::kRelaxing})
        all.push_back({kind.name, rho_inf, stress});
  return all;
}

/// One element of one material in a large step.
struct Example {
  Random random{7};
  const solids::ElementKind& kind;
  Case with;
  std::vector<Vec3> X;
  std::shared_ptr<const solids::Material> material;
  std::unique_ptr<solids::SolidElements> group;
  SolidStep step;
  double force;  ///< Of strains of order one [N].

  Example(const Case& c, const solids::MaterialDescription& d)
      : kind(solids::element_kind(c.element)),
        with(c),
        X(distorted_element(kind, random)),
        material(c.stress == Stress::kRelaxing ? relaxing_material(d)
                                               : example_material(d, c.stress == Stress::kViscous)),
        group(make("automatic")),
        step(X, context_of(c.rho_inf)),
        force(material->bulk_modulus() * std::pow(group->volume(), 2.0 / 3.0)) {
    step.begin(*group);
    // The mean of two distant states is a collapsed one, for which midpoint stress is not defined.
    step.move_at_random(random, 0.06 * closeness(kind.cell()),
                        c.stress == Stress::kMidpoint ? 0.2 : 1.0);
    // Arbitrary modes of the previous step, and memory of arbitrary stresses.
    const std::size_t modes = own_history();
    for (std::size_t k = 0; k < step.history.size(); ++k)
      step.history[k] = k < modes ? random.number(0.02) : random.number(2e4);
    if (kind.sizes().mean_dilatation) step.history[0] = 0.0;
    group->begin_step(step.history.data(), step.scratch.data());
  }
  /// Numbers of history other than memory.
  [[nodiscard]] std::size_t own_history() const {
    return static_cast<std::size_t>(kind.sizes().history());
  }
  [[nodiscard]] std::unique_ptr<solids::SolidElements> make(const std::string& isa) const {
    return one_element(kind, X, material, with.stress != Stress::kMidpoint, isa);
  }
};

class EveryElement : public testing::TestWithParam<Case> {
 protected:
  template <class Check>
  void with_each_material(const Check& check) const {
    for (const solids::MaterialDescription& material : example_materials()) {
      if (!suits(solids::element_kind(GetParam().element), material)) continue;
      SCOPED_TRACE(label(material));
      Example example(GetParam(), material);
      check(example);
    }
  }
};

/// At rho_inf = 1 and without midpoint stress.
class EveryConservingElement : public EveryElement {};

// @tests{solid-tangent} @tests{solid-condensation} @tests{solid-stress-alpha}
TEST_P(EveryElement, HasTheTangentOfItsForces) {
  with_each_material([](Example& s) {
    const SolidStep::Result r = s.step.evaluate_balanced(*s.group);
    const double h = 1e-5 * closeness(s.kind.cell());
    for (int j = 0; j < 4; ++j) {
      Vec direction(r.force.size());
      for (double& d : direction) d = s.random.number();
      Vec side[2];
      for (const int k : {0, 1}) {
        SolidStep other = s.step;
        other.x_n1 += (k == 0 ? h : -h) * direction;
        side[k] = other.evaluate_balanced(*s.group).force;
      }
      const Vec numeric = (side[0] - side[1]) / (2.0 * h);
      // Truncation 1e-10 of third derivatives; a switch of fibres within the stencil makes it
      // larger.
      const double tolerance = s.material->has_fibres() ? 1e-5 : 2e-8;
      EXPECT_LT((r.tangent * direction - numeric).norm(),
                tolerance * r.tangent.norm() * direction.norm());
    }
  });
}

// @tests{solid-enhanced-gradient} @tests{solid-mean-dilatation} @tests{solid-viscosity}
// @tests{solid-relaxation-energy}
TEST_P(EveryConservingElement, DoesWorkEqualToItsLossOfEnergy) {
  with_each_material([](Example& s) {
    const Vec force = s.step.evaluate_balanced(*s.group).force;
    const Work work = s.step.work(*s.group);
    const double given = force.dot(s.step.x_n1 - s.step.x_n);
    const double lost = s.step.stored_at_start(*s.group) - work.stored - work.dissipated;
    // Rounding: of forces, and of strains, times positions.
    EXPECT_NEAR(given, lost, 2e-15 * s.force * s.step.x_n.norm() + 1e-14 * work.dissipated);
    if (s.material->viscous()) {
      EXPECT_GT(work.dissipated, 0.0);
    } else if (s.material->relaxation().empty()) {
      EXPECT_EQ(work.dissipated, 0.0);
    }
  });
}

TEST_P(EveryElement, ExertsNoForceOrMomentAsAWhole) {
  with_each_material([](Example& s) {
    const Vec force = s.step.evaluate_balanced(*s.group).force;
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (int i = 0; i < s.step.nodes(); ++i) {
      const Vec3 f = force.segment<3>(3 * i);
      sum += f;
      moment += ((1.0 - s.step.alpha_f) * s.step.x_n + s.step.alpha_f * s.step.x_n1)
                    .segment<3>(3 * i)
                    .cross(f);
    }
    // Rounding; the moment of enhanced modes is that of their residual.
    EXPECT_LT(sum.norm(), 1e-14 * s.force);
    EXPECT_LT(moment.norm(), 1e-14 * s.force * s.step.x_n.norm());
  });
}

TEST_P(EveryElement, ComputesTheSameForcesWithAndWithoutTangents) {
  with_each_material([](Example& s) {
    const SolidStep::Result with = s.step.evaluate(*s.group);
    const SolidStep::Result without = s.step.evaluate(*s.group, false);
    EXPECT_LT((with.force - without.force).norm(), 1e-14 * s.force);
    EXPECT_NEAR(with.report.least_volume, without.report.least_volume, 1e-14);
  });
}

TEST_P(EveryElement, ComputesTheSameWithEveryInstructionSet) {
  with_each_material([](Example& s) {
    const SolidStep::Result widest = s.step.evaluate(*s.group);
    for (const char* isa : {"baseline", "avx2"}) {
      try {
        (void)solids::material_kernels(isa);
      } catch (const InputError&) {
        continue;
      }
      const auto narrow = s.make(isa);
      SolidStep other = s.step;
      other.scratch.assign(narrow->scratch_size(), 0.0);
      narrow->begin_step(other.history.data(), other.scratch.data());
      const SolidStep::Result result = other.evaluate(*narrow);
      EXPECT_LT((widest.force - result.force).norm(), 1e-13 * s.force);
      EXPECT_LT((widest.tangent - result.tangent).norm(), 1e-12 * widest.tangent.norm());
    }
  });
}

TEST_P(EveryElement, IsObjectiveAlsoWithOldCondensedModes) {
  with_each_material([](Example& s) {
    s.step.evaluate(*s.group);
    SolidStep turned = s.step;
    const Mat3 Q = s.random.frame();
    const auto turn = [&](auto&& numbers) {
      for (int i = 0; i + 2 < static_cast<int>(numbers.size()); i += 3)
        Eigen::Map<Vec3>(numbers.data() + i) = (Q * Eigen::Map<Vec3>(numbers.data() + i)).eval();
    };
    for (Vec* v : {&turned.x_n, &turned.x_n1, &turned.v_n, &turned.free_velocity}) turn(*v);
    const int width = kernel_width(), modes = s.kind.sizes().modes();
    // Scratch memory begins with the modes, each in a SIMD pack.
    const auto modes_of = [&](const SolidStep& of) {
      Vec v(modes);
      for (int k = 0; k < modes; ++k) v[k] = of.scratch[k * width];
      return v;
    };
    if (modes > 0) {
      turn(std::span(turned.history).first(s.own_history()));
      Vec v = modes_of(turned);
      turn(v);
      for (int k = 0; k < modes; ++k)
        for (int l = 0; l < width; ++l) turned.scratch[k * width + l] = v[k];
    }
    Vec expected = s.step.evaluate(*s.group, false).force;
    turn(expected);
    const Vec after = turned.evaluate(*s.group, false, Q).force;
    EXPECT_LT((after - expected).norm(), 1e-13 * s.force);
    // The modes are equal, too.
    Vec du(s.step.x_n.size());
    for (double& d : du) d = s.random.number(0.01);
    Vec turned_du = du;
    turn(turned_du);
    s.group->advance(du.data(), Mat3::Identity(), s.step.scratch.data());
    s.group->advance(turned_du.data(), Q, turned.scratch.data());
    Vec v = modes_of(s.step);
    turn(v);
    EXPECT_LT((modes_of(turned) - v).norm(), 1e-12 * (1.0 + v.norm()));
  });
}

TEST_P(EveryElement, HasASymmetricTangentAtAnInstant) {
  with_each_material([](Example& s) {
    s.step.begin(*s.group);
    s.step.stand_still();
    const Mat K = s.step.evaluate_balanced(*s.group).tangent;
    EXPECT_LT((K - K.transpose()).norm(), 1e-12 * K.norm());
  });
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryElement, testing::ValuesIn(cases()),
                         [](const auto& test) { return label_of(test.param); });
INSTANTIATE_TEST_SUITE_P(Registry, EveryConservingElement, testing::ValuesIn([] {
                           std::vector<Case> all = cases();
                           std::erase_if(all, [](const Case& c) {
                             return c.stress == Stress::kMidpoint || c.rho_inf != 1.0;
                           });
                           return all;
                         }()),
                         [](const auto& test) { return label_of(test.param); });

class EveryElementKind : public testing::TestWithParam<std::string> {
 protected:
  Random random_{3};
  const solids::ElementKind& kind_ = solids::element_kind(GetParam());
  std::vector<Vec3> X_ = distorted_element(kind_, random_);
  std::shared_ptr<const solids::Material> material_ = example_material(
      {.kind = "mooney_rivlin_uncoupled",
       .values = example_values(solids::material_kind("mooney_rivlin_uncoupled"))});
  std::unique_ptr<solids::SolidElements> group_ = one_element(kind_, X_, material_);
};

TEST_P(EveryElementKind, HasSixMotionsWithoutStiffness) {
  SolidStep step(X_, context_of(1.0));
  step.begin(*group_);
  step.stand_still();
  const Mat K = -step.evaluate_balanced(*group_).tangent;
  const Vec values = Eigen::SelfAdjointEigenSolver<Mat>(0.5 * (K + K.transpose())).eigenvalues();
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(values[i]), 1e-12 * values[values.size() - 1]);
  EXPECT_GT(values[6], 1e-4 * values[values.size() - 1]);
}

TEST_P(EveryElementKind, HasTheMassOfItsVolumeAndThatOfRigidMotion) {
  const int n = kind_.sizes().nodes;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> M(n, n);
  ASSERT_TRUE(group_->mass(0, M.data()));
  EXPECT_LT((M - M.transpose()).norm(), 1e-15 * M.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat>(M).eigenvalues()[0], 1e-4 * M.maxCoeff());
  // Mass, first and second moments by a rule of many points.
  const solids::Quadrature fine = kind_.shape.substr(0, 3) == "hex" ? solids::hexahedron_rule(5)
                                  : kind_.shape == "wedge6"         ? solids::wedge_rule()
                                  : kind_.shape == "wedge15"        ? solids::collapsed_wedge_rule()
                                                                    : solids::tetrahedron_rule(8);
  double mass = 0.0;
  Vec3 first = Vec3::Zero();
  for (const solids::QuadraturePoint& p : fine) {
    const double w = 1100.0 * p.weight * solids::jacobian(kind_.cell(), X_.data(), p.xi);
    const Vec N = solids::shape_functions(kind_.cell(), p.xi);
    for (int a = 0; a < n; ++a) first += w * N[a] * X_[static_cast<std::size_t>(a)];
    mass += w;
  }
  Vec3 moment = Vec3::Zero();
  for (int a = 0; a < n; ++a) moment += M.row(a).sum() * X_[static_cast<std::size_t>(a)];
  // Corners displaced by 0.06 add terms of high degree; a rule of few points omits their cubes.
  EXPECT_NEAR(M.sum(), mass, 2e-4 * mass);
  EXPECT_LT((moment - first).norm(), 1e-3 * mass);
  EXPECT_NEAR(group_->volume(), mass / 1100.0, 2e-3 * group_->volume());
}

TEST_P(EveryElementKind, ReportsAHomogeneousStateExactly) {
  SolidStep step(X_, context_of(1.0));
  step.begin(*group_);
  Mat3 F;
  F << 1.1, 0.05, 0.02, -0.03, 0.95, 0.04, 0.01, -0.02, 1.0;
  const Mat3 Q = random_.frame();
  for (int i = 0; i < step.nodes(); ++i)
    step.x_n.segment<3>(3 * i) = Q * F * X_[static_cast<std::size_t>(i)];
  step.stand_still();
  ElementSample s;
  step.with([&](const NodeStep& instant) {
    return group_->sample(instant, step.history.data(), std::span(&s, 1));
  });
  const Vec3 expected = Eigen::JacobiSVD<Mat3>(F).singularValues();
  EXPECT_LT((s.principal_stretches - expected).norm(), 1e-13);
  EXPECT_NEAR(s.strain_energy_density * s.volume, step.work(*group_).stored,
              1e-12 * material_->bulk_modulus());
  // Pressure: K ln J/J on average; the rest of the stress has no trace.
  EXPECT_NEAR(s.cauchy.trace() / 3.0,
              material_->bulk_modulus() * std::log(F.determinant()) / F.determinant(),
              1e-12 * material_->bulk_modulus());
  EXPECT_NEAR(step.with([&](const NodeStep& instant) {
                    return group_->least_stretch(instant, step.history.data());
                  })
                  .value,
              expected[2], 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryElementKind, testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const solids::ElementKind& kind : solids::element_kinds())
                             names.push_back(kind.name);
                           return names;
                         }()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace polhode::test::conformance_tests
