// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/contact/contact_point.hpp>
#include <polhode/contact/feature_pairs.hpp>

#include "contact/shapes_for_tests.hpp"
#include "support/derivative.hpp"

namespace polhode::contact_point_tests {
namespace {

using namespace contact;
using namespace test;

/// A step in which two shapes come within the search radius, and their feature pairs.
struct Encounter {
  PairMotion motion;
  std::vector<OrderedPair> pairs;
};

/// Moves b towards a from a random side until a feature pair is within the search radius; then a
/// random step.
Encounter encounter(const geometry::Shape& a, const geometry::Shape& b, const StepContext& context,
                    Random& random, double reach) {
  Encounter e{PairMotion(random, context), {}};
  PairMotion& m = e.motion;
  m.a_n.r.setZero();
  const Vec3 way = b.bounded() ? random.direction() : Vec3(m.b_n.Lambda() * b.axes.col(2));
  const auto nearest = [&](double s, double within) {
    m.b_n.r =
        b.bounded()
            ? Vec3(m.a_n.Lambda() * a.bound_centre - m.b_n.Lambda() * b.bound_centre + s * way)
            : Vec3(m.a_n.Lambda() * a.bound_centre - s * way);
    const Mat3 L_a = m.a_n.Lambda(), L_b = m.b_n.Lambda();
    const Placement<double> at_a(m.a_n.r, L_a, 0), at_b(m.b_n.r, L_b, 6);
    std::vector<OrderedPair> found;
    near_feature_pairs(a, b, at_a, at_b, within, found);
    double least = 1e9;
    for (const OrderedPair& p : found)
      if (p.pair.fade != Fade::flat)
        least = std::min(least, p.swapped ? gap(p.pair, b, a, at_b, at_a).distance
                                          : gap(p.pair, a, b, at_a, at_b).distance);
    e.pairs = found;
    return least;
  };
  double s = 3.0;
  for (double within = 1000.0 * reach; within >= reach; within *= 0.1)
    while (s > -3.0 && nearest(s, within) > 0.2 * within) s -= 0.15 * within;
  m.u_a = random.vector(0.1 * reach);
  m.u_b = random.vector(0.1 * reach);
  m.theta_a = random.vector(0.1 * reach);
  m.theta_b = random.vector(0.1 * reach);
  return e;
}

PointData data_of(const OrderedPair& p, const geometry::Shape& a, const geometry::Shape& b,
                  const NormalLaw& law) {
  PointData d;
  d.pair = p.pair;
  d.a = p.swapped ? &b : &a;
  d.b = p.swapped ? &a : &b;
  d.normal = law;
  return d;
}

PairTerms evaluate_point(const PointData& d, bool swapped, const PairMotion& m,
                         const Displacement& by = Displacement::Zero(),
                         PointReport* report = nullptr) {
  const BodyStep a = m.a(by), b = m.b(by);
  PairTerms t;
  t.set_zero();
  swapped ? add_contact(d, b, a, m.context, t, report) : add_contact(d, a, b, m.context, t, report);
  if (!swapped) return t;
  PairTerms s = t;
  std::swap(s.wrench_a, s.wrench_b);
  std::swap(s.D_aa, s.D_bb);
  std::swap(s.D_ab, s.D_ba);
  return s;
}

double work_of(const PairTerms& t, const PairMotion& m) { return wrenches(t).dot(step_motion(m)); }

class EveryPairOfShapes : public testing::TestWithParam<std::tuple<int, int>> {
 protected:
  EveryPairOfShapes()
      : all_(every_shape()),
        a_(all_[std::get<0>(GetParam())].shape),
        b_(all_[std::get<1>(GetParam())].shape) {}
  const std::vector<NamedShape>& all_;
  const geometry::Shape &a_, &b_;
};

constexpr double kReach = 2e-4;  // shapes of a metre with a rounding of about 3e-4

std::vector<NormalLaw> laws() {
  return {{NormalPotential::barrier, 1e5, kReach, {}, {}, {}},
          {NormalPotential::linear, 1e5, 0.0, {}, {}, {}},
          {NormalPotential::hertz, 1e7, 0.0, {}, {}, {}}};
}

// @tests{contact-quotient} @tests{contact-direction} @tests{contact-wrench} @tests{contact-fading}
// @tests{contact-point-plane} @tests{contact-sphere-sphere} @tests{contact-round-support}
// @tests{contact-sum-of-features}
TEST_P(EveryPairOfShapes, DoesExactlyTheWorkItStoresAndNothingElse) {
  Random random(11);
  int met = 0;
  for (int trial = 0; trial < 3; ++trial)
    for (const NormalLaw& law : laws()) {
      const Encounter e = encounter(a_, b_, context_of(1.0, 0.01), random, kReach);
      for (const OrderedPair& p : e.pairs) {
        const PointData d = data_of(p, a_, b_, law);
        PointReport report;
        const PairTerms t = evaluate_point(d, p.swapped, e.motion, Displacement::Zero(), &report);
        if (report.gap_n1 < law.floor() || report.gap_n < law.floor()) continue;
        if (report.normal_force == 0.0) continue;
        ++met;
        const BodyStep a = e.motion.a(), b = e.motion.b();
        BodyStep a_0 = a, b_0 = b;  // the instant t_n
        a_0.r_n1 = a.r_n, a_0.Lambda_n1 = a.Lambda_n, a_0.u.setZero(), a_0.theta.setZero();
        b_0.r_n1 = b.r_n, b_0.Lambda_n1 = b.Lambda_n, b_0.u.setZero(), b_0.theta.setZero();
        PointData at_n = d;
        at_n.history.gap = report.gap_n;
        const double before = p.swapped ? stored_at(at_n, b_0, a_0) : stored_at(at_n, a_0, b_0);
        const double scale = law.energy(0.0) + std::abs(report.work.stored) + std::abs(before) +
                             std::abs(report.normal_force) * 0.1 * kReach;
        EXPECT_NEAR(work_of(t, e.motion), before - report.work.stored, 1e-10 * scale)
            << static_cast<int>(p.pair.kind) << " " << p.pair.i << " " << p.pair.j;
        EXPECT_NEAR(report.work.dissipated, 0.0, 1e-12 * scale);
        const double F = t.wrench_a.head<3>().norm();
        EXPECT_LT((t.wrench_a + t.wrench_b).head<3>().norm(), 1e-15 * F);
        const Vec3 r_a = a.r_n + 0.5 * a.u, r_b = b.r_n + 0.5 * b.u;
        const Vec3 moment = r_a.cross(Vec3(t.wrench_a.head<3>())) + t.wrench_a.tail<3>() +
                            r_b.cross(Vec3(t.wrench_b.head<3>())) + t.wrench_b.tail<3>();
        EXPECT_LT(moment.norm(), 1e-14 * F * (1.0 + r_b.norm()));
      }
    }
  EXPECT_GE(met, 2);
}

/// A gap in double-double numbers follows a displacement of 1e-13 to 1e-5 of it; doubles resolve it
/// to a tenth only.
// @tests{contact-gap-change}
TEST_P(EveryPairOfShapes, HasGapsInDoubleDoublePrecision) {
  Random random(14);
  int followed = 0;
  for (int trial = 0; trial < 9; ++trial) {
    const Encounter e = encounter(a_, b_, context_of(1.0, 0.01), random, kReach);
    for (const OrderedPair& p : e.pairs) {
      const geometry::Shape &x = p.swapped ? b_ : a_, &y = p.swapped ? a_ : b_;
      const auto moved = [&](double more) {
        BodyStep first = e.motion.a();
        const BodyStep second = e.motion.b();
        first.u.x() += more;
        const Vec3 from = first.r_n;
        const Placement<Fine> on_first(first, from, 0), on_second(second, from, 6);
        return p.swapped ? gap(p.pair, x, y, on_second, on_first)
                         : gap(p.pair, x, y, on_first, on_second);
      };
      const auto gap_after = [&](double more) { return moved(more).distance; };
      // Cores that overlap, which no law allows, have several depths; in its mouth a tube's outer
      // side is out of reach, and its gap an estimate.
      if (gap_after(0.0) < 1e-12 - (x.rounding + y.rounding)) continue;
      if (is_of_hull(p.pair.kind) && moved(0.0).feature == kInMouth) continue;
      const double u = e.motion.a().u.x();
      std::vector<Fine> way, change;
      for (int k = 0; k <= 8; ++k) {
        way.push_back(Fine(u + k * 1e-13) - Fine(u));
        change.push_back(gap_after(k * 1e-13) - gap_after(0.0));
      }
      const Fine slope = change.back() / way.back();
      double worst = 0.0;
      for (std::size_t k = 0; k < way.size(); ++k)
        worst = std::max(worst, std::abs(value(change[k] - slope * way[k])));
      EXPECT_LT(worst, 1e-18) << static_cast<int>(p.pair.kind) << " " << p.pair.i << " "
                              << p.pair.j;
      ++followed;
    }
  }
  EXPECT_GE(followed, 1);
}

// @tests{contact-plastic} @tests{contact-bristle}
TEST_P(EveryPairOfShapes, HasTheTangentOfItsWrench) {
  Random random(12);
  int checked = 0;
  for (const double rho : {1.0, 0.6})
    for (int trial = 0; trial < 3; ++trial) {
      const Encounter e = encounter(a_, b_, context_of(rho, 0.01), random, kReach);
      int of_this = 0;
      for (const OrderedPair& p : e.pairs) {
        for (const bool has_friction : {false, true}) {
          NormalLaw law{NormalPotential::barrier, 1e5, kReach, {}, {}, {}};
          PointData d = data_of(p, a_, b_, law);
          d.end_share = trial % 2 == 1 ? 0.5 : 0.0;
          if (has_friction) {
            d.friction.mu = 0.4;
            d.friction.mu_across = trial % 3 == 0 ? 0.2 : 0.0;
            d.friction.rolling = 0.01;
            d.friction.torsion = 0.02;
            d.friction.stiffness = 2e4;
            d.friction.damping = 3.0;
            d.friction.turning_stiffness = 10.0;
            d.history.normal = random.direction();
            d.history.bristle = random.vector(1e-5);
          }
          PointReport report;
          const PairTerms t = evaluate_point(d, p.swapped, e.motion, Displacement::Zero(), &report);
          if (report.normal_force < 1e-3) continue;
          if (std::min(report.gap_n, report.gap_n1) < -0.8 * kReach) continue;
          const Mat analytic = wrench_tangent(t);
          PairMotion still = e.motion;
          still.context.tangents = false;
          // The step of the difference is small relative to the band and to the rounding radius.
          const double h = 2e-8, scale = std::max(analytic.cwiseAbs().maxCoeff(), 1.0);
          const Mat numeric = central_difference(
              [&](const Vec& by) -> Vec {
                return wrenches(evaluate_point(d, p.swapped, still, by));
              },
              12, h);
          EXPECT_LT((analytic - numeric).cwiseAbs().maxCoeff() / scale, 3e-5)
              << static_cast<int>(p.pair.kind) << " i " << p.pair.i << " j " << p.pair.j << " rubs "
              << has_friction << " gaps " << report.gap_n << " " << report.gap_n1;
          ++checked;
          if (++of_this > 6) break;
        }
        if (of_this > 6) break;
      }
    }
  EXPECT_GT(checked, 1);
}

std::string pair_name(const testing::TestParamInfo<std::tuple<int, int>>& info) {
  const auto& all = every_shape();
  return all[std::get<0>(info.param)].name + "_" + all[std::get<1>(info.param)].name;
}

// Planes and height fields are fixed in all models; every other shape is tested with all shapes.
const int kShapes = static_cast<int>(every_shape().size());
INSTANTIATE_TEST_SUITE_P(All, EveryPairOfShapes,
                         testing::Combine(testing::Range(0, 8), testing::Range(0, kShapes)),
                         pair_name);
INSTANTIATE_TEST_SUITE_P(TubesAndLater, EveryPairOfShapes,
                         testing::Combine(testing::Range(10, kShapes), testing::Range(0, kShapes)),
                         pair_name);

}  // namespace
}  // namespace polhode::contact_point_tests
