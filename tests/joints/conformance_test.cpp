// SPDX-License-Identifier: Apache-2.0
// Laws that every kind of joint must satisfy. Runs over the registry.
#include <Eigen/SVD>

#include <joints/joint_cases.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::test::conformance_tests {
namespace {

constexpr int kSamples = 3;

constexpr double kSpectralRadii[] = {1.0, 0.5, 0.0};

/// Gives a joint of equal turns the sign of its row at t_n.
void remember_bend(const Joint& joint, PairMotion& m) {
  if (!joint.parts().equal_turns) return;
  const BodyStep a = PairMotion::instant(m.a_n), b = PairMotion::instant(m.b_n);
  joint.initialize({a, b, m.context, m.lambda.data(), m.history.data()}, m.history.data());
}

class EveryJoint : public testing::TestWithParam<std::string> {
 protected:
  /// Calls what(case, context, random) for all choices of parameters, spectral radii and samples.
  template <class What>
  void for_cases(What&& what) {
    for (const JointCase& c : joint_cases(GetParam()))
      for (const double rho_inf : kSpectralRadii)
        for (unsigned seed = 1; seed <= kSamples; ++seed) {
          SCOPED_TRACE(c.name() + ", rho_inf " + std::to_string(rho_inf));
          Random random(seed);
          what(c, context_of(rho_inf), random);
        }
  }

  /// Calls what(joint, motion) for joints far off their constraint: both bodies moving, then
  /// either of them the ground.
  template <class What>
  void for_samples(What&& what) {
    for_cases([&](const JointCase& c, const StepContext& context, Random& random) {
      const Joint joint = make_joint(c, random_frames(random));
      PairMotion motion(random, context);
      remember_bend(joint, motion);
      what(joint, motion);
      motion.a_moves = false;
      what(joint, motion);
      motion.a_moves = true;
      motion.b_moves = false;
      what(joint, motion);
    });
  }
};

Eigen::Matrix<double, Eigen::Dynamic, 12> gradient(const Joint& joint, const PairTerms& t) {
  Eigen::Matrix<double, Eigen::Dynamic, 12> G(joint.rows(), 12);
  G << t.G_a.topRows(joint.rows()), t.G_b.topRows(joint.rows());
  return G;
}

/// Displacements of the ground do not exist: their columns are zero in both.
Displacement allowed(const PairMotion& m, const Vec& d) {
  Displacement out = d;
  for (int k = 0; k < 12; ++k)
    if (!m.moves(k)) out[k] = 0.0;
  return out;
}

// @tests{joint-coincident} @tests{joint-plane} @tests{joint-orthogonal} @tests{joint-distance}
// @tests{joint-equal-turns}
TEST_P(EveryJoint, HasTheGradientOfItsConstraint) {
  for_samples([](const Joint& joint, const PairMotion& m) {
    expect_derivative(
        gradient(joint, evaluate(joint, m)),
        [&](const Vec& d) -> Vec { return evaluate(joint, m, allowed(m, d)).g.head(joint.rows()); },
        joint.type() + " G");
  });
}

// @tests{ga-moment-tangent} @tests{ga-moment-arm} @tests{ga-wrench-r-tangent} @tests{ga-z-tangent}
TEST_P(EveryJoint, HasTheTangentOfItsWrench) {
  for_samples([](const Joint& joint, const PairMotion& m) {
    expect_derivative(
        wrench_tangent(evaluate(joint, m)),
        [&](const Vec& d) -> Vec { return wrenches(evaluate(joint, m, allowed(m, d))); },
        joint.type() + " D");
  });
}

TEST_P(EveryJoint, ActsByItsMultipliersTimesTheColumns) {
  for_samples([](const Joint& joint, const PairMotion& m) {
    const PairTerms t = evaluate(joint, m);
    const Eigen::Map<const Vec6> lambda(m.lambda.data());
    const int n = joint.rows();
    EXPECT_LT((t.B_a.leftCols(n) * lambda.head(n) - t.wrench_a).norm(), 1e-13);
    EXPECT_LT((t.B_b.leftCols(n) * lambda.head(n) - t.wrench_b).norm(), 1e-13);
    EXPECT_TRUE(t.B_a.rightCols(6 - n).isZero(0.0) && t.G_b.bottomRows(6 - n).isZero(0.0));
    EXPECT_TRUE(t.compliance.isZero(0.0));
  });
}

// The columns are the rows at averaged arguments, so they agree in a step without motion.
TEST_P(EveryJoint, HasTheSameRowsAndColumnsAtAnInstant) {
  for_samples([](const Joint& joint, const PairMotion& m) {
    const PairTerms t = m.at_start([&](const PairStep& step) {
      PairTerms terms;
      terms.set_zero();
      joint.evaluate(step, terms);
      return terms;
    });
    EXPECT_EQ(Mat6(t.B_a.transpose()), Mat6(t.G_a));
    EXPECT_EQ(Mat6(t.B_b.transpose()), Mat6(t.G_b));
  });
}

/// A pair that satisfies the joint at t_n: b's frame is a's after a free motion.
PairMotion assembled(const Joint& joint, Random& random, const StepContext& context) {
  PairMotion m(random, context);
  const JointFrames& f = joint.frames();
  const JointParts& parts = joint.parts();
  const Mat3 R_a = m.a_n.Lambda() * f.R_a;
  const auto turn = [&](const Vec3& axis) { return exp_map(axis * random.number(2.0)); };
  Mat3 turned = Mat3::Identity();
  if (parts.axes == 0) turned = random.frame();
  if (parts.equal_turns) {
    const Vec3 axis = random.vector();
    turned = exp_map(Vec3(axis.x(), axis.y(), 0.0));
  }
  if (parts.axes == 1) turned = turn(Vec3::UnitX()) * turn(Vec3::UnitY());
  if (parts.axes == 2) turned = turn(Vec3::UnitZ());
  m.b_n.q = Quat(Mat3(R_a * turned * f.R_b.transpose())).normalized();
  Vec3 offset = parts.coincident ? Vec3(Vec3::Zero()) : random.vector();
  if (parts.distance) offset = random.direction();
  for (int i = 0; i < parts.planes; ++i) offset[parts.plane[i].normal] = 0.0;
  if (parts.distance) offset *= parts.distance->length / offset.norm();
  m.b_n.r = m.a_n.r + m.a_n.q * f.Z_a + R_a * offset - m.b_n.q * f.Z_b;
  remember_bend(joint, m);
  return m;
}

/// Rotates b in the step so that equal turns hold at its end as well.
void end_assembled(const Joint& joint, const Vec3& bend, PairMotion& m) {
  const JointFrames& f = joint.frames();
  const Mat3 to =
      m.a().Lambda_n1 * f.R_a * exp_map(Vec3(bend.x(), bend.y(), 0.0)) * f.R_b.transpose();
  const Quat q(Mat3(to * m.b_n.Lambda().transpose()));
  m.theta_b = 2.0 / q.w() * q.vec();
}

// Off the constraint and for turns of a radian: round-off of a few products of size one. The row of
// equal turns does no work between two positions that satisfy it.
// @tests{joint-carried-difference} @tests{joint-equal-turns}
TEST_P(EveryJoint, DoesTheWorkOfItsMultipliersTimesTheChangeOfG) {
  for_samples([](const Joint& joint, const PairMotion& sample) {
    if (sample.context.ga.rho_inf != 1.0) return;
    PairMotion m = sample;
    if (joint.parts().equal_turns) {
      if (!m.a_moves || !m.b_moves) return;
      Random random(5);
      m = assembled(joint, random, sample.context);
      end_assembled(joint, random.vector(), m);
    }
    const PairTerms t = evaluate(joint, m);
    const Vec6 g_n = m.at_start([&](const PairStep& s) { return joint.residual(s); });
    const Eigen::Map<const Vec6> lambda(m.lambda.data());
    const int n = joint.rows();
    EXPECT_NEAR(lambda.head(n).dot(t.g.head(n) - g_n.head(n)), wrenches(t).dot(step_motion(m)),
                5e-14);
  });
}

TEST_P(EveryJoint, KeepsLinearAndAngularMomentumOfItsPair) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const JointFrames f = random_frames(random);
    const Joint joint = make_joint(c, f);
    PairMotion m(random, context);
    if (joint.parts().coincident) {
      // Points that are apart leave the couple u × λ, so they coincide here at both ends.
      m.b_n.r = m.a_n.r + m.a_n.q * f.Z_a - m.b_n.q * f.Z_b;
      m.u_b = m.a().point(f.Z_a).at_n1 - m.b_n.r - m.b().vector(f.Z_b).at_n1;
    }
    const PairTerms t = evaluate(joint, m);
    EXPECT_LT((t.wrench_a.head<3>() + t.wrench_b.head<3>()).norm(), 1e-14);
    const Vec3 r_a = m.a().point(Vec3::Zero()).at_alpha, r_b = m.b().point(Vec3::Zero()).at_alpha;
    const Vec3 about_origin = r_a.cross(t.wrench_a.head<3>()) + t.wrench_a.tail<3>() +
                              r_b.cross(t.wrench_b.head<3>()) + t.wrench_b.tail<3>();
    EXPECT_LT(about_origin.norm(), 3e-14);
  });
}

// g along a motion with constant accelerations and angular velocities; h = 1e-3 leaves a
// truncation of h²/12 of the fourth derivative (ω⁴ g ~ 1e2) and a rounding of 1e-16/h².
TEST_P(EveryJoint, HasTheAccelerationTermsOfItsConstraint) {
  for_samples([](const Joint& joint, const PairMotion& sample) {
    if (sample.context.ga.rho_inf != 1.0) return;
    // The row of equal turns is normalised: its second derivative is that where it vanishes.
    Random random(3);
    PairMotion m = sample;
    if (joint.parts().equal_turns && m.a_moves && m.b_moves)
      m = assembled(joint, random, sample.context);
    else if (joint.parts().equal_turns)
      return;
    const auto pair_at = [&](double t, auto&& what) {
      const auto side = [&](const BodyMotion& body, bool moves) {
        if (!moves) return BodyStep::ground(1.0);
        const Vec3 omega = body.omega();
        return BodyStep::at_instant(body.r + t * body.v + 0.5 * t * t * body.a,
                                    exp_map(t * omega) * body.Lambda(), body.v + t * body.a,
                                    body.W);
      };
      const BodyStep a = side(m.a_n, m.a_moves), b = side(m.b_n, m.b_moves);
      return what(PairStep{a, b, m.context, m.lambda.data(), m.history.data()});
    };
    const auto g = [&](double t) {
      return pair_at(t, [&](const PairStep& s) { return joint.residual(s); });
    };
    constexpr double kH = 1e-3;
    const Vec6 g_ddot = (g(kH) - 2.0 * g(0.0) + g(-kH)) / (kH * kH);
    Vec6 gamma = Vec6::Zero();
    const PairTerms t = pair_at(0.0, [&](const PairStep& s) {
      PairTerms terms;
      terms.set_zero();
      joint.evaluate(s, terms);
      joint.acceleration_terms(s, gamma);
      return terms;
    });
    Displacement q_ddot = Displacement::Zero();
    q_ddot.segment<3>(0) = m.a_n.a;
    q_ddot.segment<3>(6) = m.b_n.a;
    const Vec expected = gradient(joint, t) * q_ddot + gamma.head(joint.rows());
    EXPECT_LT((expected - g_ddot.head(joint.rows())).norm(), 1e-4) << joint.type();
  });
}

int rank(const Mat& G) {
  Eigen::JacobiSVD<Mat> svd(G);
  return static_cast<int>((svd.singularValues().array() > 1e-9).count());
}

TEST_P(EveryJoint, HasIndependentRows) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const Joint joint = make_joint(c, random_frames(random));
    const PairMotion m = assembled(joint, random, context);
    const PairTerms t = m.at_start([&](const PairStep& s) {
      PairTerms terms;
      terms.set_zero();
      joint.evaluate(s, terms);
      return terms;
    });
    EXPECT_LT(t.g.norm(), 3e-15) << "the sample is not assembled";
    EXPECT_EQ(rank(gradient(joint, t)), joint.rows());
    EXPECT_EQ(rank(gradient(joint, t).leftCols<6>()), joint.rows()) << "from one side alone";
  });
}

/// Rows of a MotionBasis written out from its definition, at one time: g and (a, b) rows.
struct BasisRows {
  Vec6 g = Vec6::Zero();
  Mat6 a = Mat6::Zero(), b = Mat6::Zero();
};

BasisRows basis_rows(const MotionBasis& m, const Vec3& r_a, const Mat3& L_a, const Vec3& r_b,
                     const Mat3& L_b) {
  BasisRows out;
  const Vec3 z_a = L_a * m.Z_a, z_b = L_b * m.Z_b, u = r_b + z_b - r_a - z_a;
  int row = 0;
  const auto add = [&](double g, const Vec3& ar, const Vec3& at, const Vec3& br, const Vec3& bt) {
    out.g[row] = g;
    out.a.row(row) << ar.transpose(), at.transpose();
    out.b.row(row++) << br.transpose(), bt.transpose();
  };
  if (m.coincident)
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = Vec3::Unit(i);
      add(u[i], -e, -z_a.cross(e), e, z_b.cross(e));
    }
  else
    for (int i = 0; i < m.slides; ++i) {
      const Vec3 d = L_a * m.slide[i];
      add(d.dot(u), -d, d.cross(u + z_a), d, z_b.cross(d));
    }
  const Mat3 A = L_a * m.R_a, B = L_b * m.R_b;
  const auto right_angle = [&](int i, int j) {
    const Vec3 c = A.col(i).cross(B.col(j));
    add(A.col(i).dot(B.col(j)), Vec3::Zero(), c, Vec3::Zero(), -c);
  };
  if (m.directions == 1) right_angle(0, 1);
  if (m.directions >= 2) {
    right_angle(2, 0);
    right_angle(2, 1);
  }
  if (m.directions == 3) right_angle(0, 1);
  return out;
}

TEST_P(EveryJoint, HasTheRowsOfItsMotionBasis) {
  for_samples([](Joint joint, const PairMotion& m) {
    for (const bool reversed : {false, true}) {
      if (reversed && !joint.reversible()) return;
      if (reversed) joint.reverse();
      const std::optional<MotionBasis> basis = joint.motion_basis();
      if (!basis) {
        EXPECT_TRUE(joint.rows() < 3 || joint.parts().equal_turns);
        return;
      }
      EXPECT_EQ(basis->rows(), joint.rows());
      const PairTerms t = evaluate(joint, m);
      const BodyStep a = m.a(), b = m.b();
      BasisRows at_n1 = basis_rows(*basis, a.r_n1, a.Lambda_n1, b.r_n1, b.Lambda_n1);
      const auto mean = [&](const auto& x_n, const auto& x_n1) {
        return ((1.0 - a.alpha_f) * x_n + a.alpha_f * x_n1).eval();
      };
      // Averages of quadratic g are not g of averages; gradients are linear in the rotations of one
      // side, so gradients are those at averaged positions and matrices.
      BasisRows alpha = basis_rows(*basis, mean(a.r_n, a.r_n1), mean(a.Lambda_n, a.Lambda_n1),
                                   mean(b.r_n, b.r_n1), mean(b.Lambda_n, b.Lambda_n1));
      for (BasisRows* rows : {&at_n1, &alpha}) {
        if (!m.a_moves) rows->a.setZero();
        if (!m.b_moves) rows->b.setZero();
      }
      EXPECT_LT((t.g - at_n1.g).norm(), 5e-15);
      EXPECT_LT((t.G_a - at_n1.a).norm() + (t.G_b - at_n1.b).norm(), 1e-14);
      EXPECT_LT((t.B_a - alpha.a.transpose()).norm() + (t.B_b - alpha.b.transpose()).norm(), 1e-14);
    }
  });
}

TEST_P(EveryJoint, IsEquivalentWithItsSidesExchanged) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const Joint joint = make_joint(c, random_frames(random));
    if (!joint.reversible()) return;
    Joint reversed = joint;
    reversed.reverse();
    EXPECT_EQ(reversed.bodies.a, joint.bodies.b);
    EXPECT_EQ(reversed.rows(), joint.rows());
    const PairMotion m = assembled(joint, random, context);
    const BodyStep a = PairMotion::instant(m.a_n), b = PairMotion::instant(m.b_n);
    PairTerms t, t_reversed;
    t.set_zero();
    t_reversed.set_zero();
    joint.evaluate({a, b, m.context, m.lambda.data(), m.history.data()}, t);
    reversed.evaluate({b, a, m.context, m.lambda.data(), m.history.data()}, t_reversed);
    // A pose that satisfies one satisfies the other, and both prevent the same motions.
    EXPECT_LT(t_reversed.g.norm(), 5e-15);
    Mat both(2 * joint.rows(), 12);
    both << gradient(joint, t), t_reversed.G_b.topRows(joint.rows()),
        t_reversed.G_a.topRows(joint.rows());
    EXPECT_EQ(rank(both), joint.rows());
    reversed.reverse();
    PairTerms twice;
    twice.set_zero();
    reversed.evaluate({a, b, m.context, m.lambda.data(), m.history.data()}, twice);
    EXPECT_LT((twice.G_a - t.G_a).cwiseAbs().maxCoeff(), 1e-15) << "exchanged twice";
  });
}

// Coordinates do not depend on the order of sides in the solver, and their rates are their
// derivatives.
TEST_P(EveryJoint, ReportsTheSameCoordinatesWithItsSidesExchanged) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const Joint joint = make_joint(c, random_frames(random));
    const PairMotion m = assembled(joint, random, context);
    const BodyStep a = PairMotion::instant(m.a_n), b = PairMotion::instant(m.b_n);
    const PairStep step{a, b, m.context, m.lambda.data(), m.history.data()};
    const JointCoordinates q = joint.coordinates(step);
    EXPECT_EQ(q.count, static_cast<int>(joint.coordinate_names().size()));
    if (!joint.parts().distance) {
      EXPECT_EQ(q.count, 6 - joint.rows());
    }
    if (!joint.reversible()) return;
    Joint reversed = joint;
    reversed.reverse();
    const JointCoordinates d =
        reversed.coordinates({b, a, m.context, m.lambda.data(), m.history.data()});
    for (int i = 0; i < q.count; ++i) {
      EXPECT_NEAR(q.value[i], d.value[i], 1e-14) << joint.coordinate_names()[i];
      EXPECT_NEAR(q.rate[i], d.rate[i], 1e-14) << joint.coordinate_names()[i];
    }
    EXPECT_EQ(reversed.coordinate_names(), joint.coordinate_names());
  });
}

TEST_P(EveryJoint, RatesAreTheSlopesOfTheCoordinates) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const Joint joint = make_joint(c, random_frames(random));
    if (!joint.parts().turns() && !joint.parts().distance)
      return;  // Rotation vector: angular velocity by definition.
    PairMotion m = assembled(joint, random, context);
    // A relative motion that the joint allows: project random velocities onto G v = 0.
    PairTerms t;
    t.set_zero();
    const BodyStep a_0 = PairMotion::instant(m.a_n), b_0 = PairMotion::instant(m.b_n);
    joint.evaluate({a_0, b_0, m.context, m.lambda.data(), m.history.data()}, t);
    const Mat G = gradient(joint, t);
    Vec v(12);
    v << m.a_n.v, m.a_n.omega(), m.b_n.v, m.b_n.omega();
    v -= G.transpose() * (G * G.transpose()).ldlt().solve(G * v);
    const auto coordinates = [&](double t_shift) {
      const auto side = [&](const BodyMotion& n, int at) {
        const Vec3 r = n.r + t_shift * v.segment<3>(at), omega = v.segment<3>(at + 3);
        const Mat3 L = exp_map(t_shift * omega) * n.Lambda();
        return BodyStep::at_instant(r, L, v.segment<3>(at), L.transpose() * omega);
      };
      const BodyStep a = side(m.a_n, 0), b = side(m.b_n, 6);
      return joint.coordinates({a, b, m.context, m.lambda.data(), m.history.data()});
    };
    constexpr double kH = 1e-5;  // Truncation and rounding 1e-10.
    const JointCoordinates before = coordinates(-kH), now = coordinates(0.0),
                           after = coordinates(kH);
    for (int i = 0; i < now.count; ++i)
      EXPECT_NEAR(now.rate[i], (after.value[i] - before.value[i]) / (2.0 * kH), 1e-8)
          << joint.coordinate_names()[i];
  });
}

TEST_P(EveryJoint, ReportsWhatAExertsOnB) {
  for_cases([](const JointCase& c, const StepContext& context, Random& random) {
    const JointFrames f = random_frames(random);
    Joint joint = make_joint(c, f);
    const PairMotion m = assembled(joint, random, context);
    const BodyStep a = PairMotion::instant(m.a_n), b = PairMotion::instant(m.b_n);
    const double* l = m.lambda.data();
    PairTerms t;
    t.set_zero();
    joint.evaluate({a, b, m.context, l, nullptr}, t);
    const Reaction r = joint.reaction({a, b, m.context, l, nullptr}, false);
    const Vec3 z_b = b.Lambda_n1 * f.Z_b;
    EXPECT_LT((t.wrench_b.head<3>() - r.force).norm(), 1e-14);
    EXPECT_LT((t.wrench_b.tail<3>() - r.moment - z_b.cross(r.force)).norm(), 1e-14);
    const Reaction in_axes = joint.reaction({a, b, m.context, l, nullptr}, true);
    const Mat3 R = a.Lambda_n1 * f.R_a;
    EXPECT_LT((R * in_axes.force - r.force).norm() + (R * in_axes.moment - r.moment).norm(), 1e-14);
    if (!joint.reversible()) return;
    // With exchanged sides and its own multipliers the wrench on the user's b differs, and the
    // report is of that wrench.
    joint.reverse();
    t.set_zero();
    joint.evaluate({b, a, m.context, l, nullptr}, t);
    const Reaction s = joint.reaction({b, a, m.context, l, nullptr}, false);
    EXPECT_LT((t.wrench_a.head<3>() - s.force).norm(), 1e-14);
    EXPECT_LT((t.wrench_a.tail<3>() - s.moment - z_b.cross(s.force)).norm(), 2e-14);
  });
}

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  // A link with slack has no rows; resistance_test.cpp tests its stops.
  for (const JointKind& kind : joint_kinds())
    if (kind.name != "slack_link") names.push_back(kind.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Registry, EveryJoint, testing::ValuesIn(kinds()),
                         [](const auto& kind) { return kind.param; });

}  // namespace
}  // namespace polhode::test::conformance_tests
