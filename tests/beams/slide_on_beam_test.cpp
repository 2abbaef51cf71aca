// SPDX-License-Identifier: Apache-2.0
// Curve of a beam, and the forces of a point that slides along it over one step.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/time_function.hpp>

namespace polhode::test::slide_on_beam_step_tests {
namespace {

constexpr int kElements = 5;
constexpr double kTip = 0.7;

class Constant final : public TimeFunction {
 public:
  explicit Constant(double value) : value_(value) {}
  double operator()(double) const override { return value_; }

 private:
  double value_;
};

/// A step of all nodes of a bent beam of five elements and of a point on it.
struct Scene {
  std::vector<double> x_n, x_n1, u, v_n, v_n1;
  StepContext context;
  SlideOnBeamSpec spec;
  double s_n = 0.0, s = 0.0;
  double lambda[3] = {3.0, -5.0, 4.0};

  Scene(double from, double to, double rho_inf) : s_n(from), s(to) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-0.1, 0.1);
    int count = 0;
    for (int i = 0; i <= kElements; ++i)
      spec.nodes.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}), count += 4;
    spec.point = count++;
    for (int i = 0; i < kElements; ++i) spec.lengths.push_back(0.8 + 0.1 * i);
    spec.tip = kTip;
    spec.element_stiffness = 1e-5;  // a large ε, so that no term hides behind 1/ε
    spec.start = from;
    for (std::vector<double>* x : {&x_n, &x_n1}) {
      double along = 0.0;
      for (int i = 0; i <= kElements; ++i) {
        const Vec3 centre(along, number(random), number(random));
        for (int k = 0; k < 4; ++k)
          for (int c = 0; c < 3; ++c)
            x->push_back(centre[c] + (k == c + 1 ? kTip : 0.0) + (k > 0 ? number(random) : 0.0));
        if (i < kElements) along += spec.lengths[static_cast<std::size_t>(i)];
      }
      x->resize(3 * static_cast<std::size_t>(count), 0.0);
    }
    context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
    context.dt = 0.1;
    context.conserving = rho_inf == 1.0;
    v_n.assign(x_n.size(), 0.0);
    v_n1 = v_n;
    put_point(x_n, from);
    put_point(x_n1, to);
    follow();
  }
  /// The point is on the curve.
  void put_point(std::vector<double>& x, double at) {
    SlideOnBeamSpec copy = spec;
    const Vec3 X = SlideOnBeam(std::move(copy)).place(x.data(), at, 0);
    for (int c = 0; c < 3; ++c) x[3 * static_cast<std::size_t>(spec.point) + c] = X[c];
  }
  void follow() {
    u = x_n1;
    for (std::size_t k = 0; k < u.size(); ++k) u[k] -= x_n[k];
  }
  [[nodiscard]] NodeStep step() const {
    return {.x_n = x_n.data(),
            .x_n1 = x_n1.data(),
            .u = u.data(),
            .v_n = v_n.data(),
            .v_n1 = v_n1.data(),
            .context = context,
            .alpha_f = context.ga.alpha_f,
            .rate = context.ga.c / context.dt};
  }
};

/// One evaluation with given unknowns.
struct Evaluation {
  std::vector<double> force, tangent, scratch;

  Evaluation(const SlideOnBeam& slide, const Scene& scene) {
    std::vector<double> history(slide.history_size());
    slide.initialize(history.data());
    scratch.assign(slide.scratch_size(), 0.0);
    slide.begin_step(history.data(), scratch.data());
    const std::size_t n = scene.x_n.size();
    tangent.assign(n * n, 0.0);
    for (int i = 0; i < 2; ++i) {  // the first one begins the search
      const double y[4] = {scene.lambda[0], scene.lambda[1], scene.lambda[2], scene.s};
      if (i == 1) slide.set_unknowns(y, scratch.data());
      force.assign(n, 0.0);
      std::fill(tangent.begin(), tangent.end(), 0.0);
      slide.evaluate(scene.step(), history.data(), scratch.data(), Mat3::Identity(),
                     {force.data(), tangent.data(), nullptr});
    }
  }
  [[nodiscard]] double block(int i, int j, int r, int c, int nodes) const {
    return tangent[9 * static_cast<std::size_t>(i * nodes + j) + 3 * r + c];
  }
};

/// Force along the beam for which the multipliers of a scene are in balance.
double balance(Scene scene) {
  SlideOnBeamSpec copy = scene.spec;
  copy.position = std::make_shared<Constant>(scene.s);
  const SlideOnBeam slide(std::move(copy));
  const Evaluation e(slide, scene);
  std::vector<double> history(slide.history_size());
  slide.initialize(history.data());
  return slide.work(scene.step(), history.data(), e.scratch.data()).put_in / (scene.s - scene.s_n);
}

}  // namespace

// @tests{beam-curve}
TEST(BeamCurve, IsSmoothAndPartsUnity) {
  const BeamCurve curve({0.5, 0.8, 1.1});
  EXPECT_EQ(curve.element_of(-1.0), 0);
  EXPECT_EQ(curve.element_of(0.5), 1);
  EXPECT_EQ(curve.element_of(9.0), 2);
  for (const double s : {-0.1, 0.2, 0.5, 1.2, 2.4}) {
    const BeamCurve::Pair w = curve.at(curve.element_of(s), s, 0);
    EXPECT_NEAR(w.col(0).sum(), 1.0, 1e-15);
    EXPECT_NEAR(curve.at(curve.element_of(s), s, 1).col(0).sum(), 0.0, 1e-14);
  }
  // At the border the slopes of both elements are the unit normal of the node.
  EXPECT_NEAR(curve.at(0, 0.5, 1)(1, 1), 1.0, 1e-14);
  EXPECT_NEAR(curve.at(1, 0.5, 1)(0, 1), 1.0, 1e-14);
  EXPECT_NEAR(curve.at(0, 0.5, 1)(1, 0), 0.0, 1e-14);
}

// Divided differences within an element, across a border near by, and far apart.
TEST(BeamCurve, HasExactDividedDifferences) {
  const BeamCurve curve({0.5, 0.8, 1.1, 0.9});
  for (const auto& [from, to] : {std::pair(0.1, 0.4),
                                 {0.7, 0.6999},
                                 {0.49999, 0.50002},
                                 {0.2, 3.0},
                                 {1.3, 0.3},
                                 {0.6, 0.6}}) {
    const CurveStep step(curve, from, to);
    const CurveStep::Weights change = (to - from) * step.slope();
    EXPECT_LT((change - (step.at_end(0) - step.at_start(0))).cwiseAbs().maxCoeff(), 3e-16 + 1e-15);
    EXPECT_NEAR(step.slope().col(0).sum(), 0.0, 1e-13);
  }
}

// The condensed tangent is the derivative of the condensed force where all equations hold.
TEST(SlideOnBeam, HasTheTangentOfItsForce) {
  for (const double rho_inf : {1.0, 0.5})
    for (const auto& [from, to] : {std::pair(1.1, 1.4), {0.7, 1.0}, {0.3, 3.5}}) {
      Scene scene(from, to, rho_inf);
      scene.spec.force = std::make_shared<Constant>(balance(scene));
      SlideOnBeamSpec spec = scene.spec;
      const SlideOnBeam slide(std::move(spec));
      const Evaluation base(slide, scene);
      const int nodes = scene.spec.point + 1;
      double largest = 0.0;
      for (const double k : base.tangent) largest = std::max(largest, std::abs(k));
      const double step = 1e-6;
      for (int j = 0; j < nodes; ++j)
        for (int c = 0; c < 3; ++c) {
          const auto moved = [&](double way) {
            Scene other = scene;
            other.x_n1[3 * static_cast<std::size_t>(j) + c] += way;
            other.follow();
            return Evaluation(slide, other).force;
          };
          const std::vector<double> plus = moved(step), minus = moved(-step);
          for (int i = 0; i < nodes; ++i)
            for (int r = 0; r < 3; ++r) {
              const std::size_t at = 3 * static_cast<std::size_t>(i) + r;
              EXPECT_NEAR((plus[at] - minus[at]) / (2.0 * step), base.block(i, j, r, c, nodes),
                          2e-8 * largest)
                  << rho_inf << ' ' << from << ' ' << i << ' ' << j;
            }
        }
    }
}

// The forces have no sum and no moment at the mean positions, and their work over the step is that
// of the force along the beam. @tests{slide-rows} @tests{slide-along}
TEST(SlideOnBeam, ActsWithoutMomentaAndWithTheWorkAlongIt) {
  for (const auto& [from, to] : {std::pair(1.1, 1.4), {0.7, 1.0}, {0.3, 3.5}, {0.9, 0.900001}}) {
    Scene scene(from, to, 1.0);
    const double Q = balance(scene);
    scene.spec.force = std::make_shared<Constant>(Q);
    SlideOnBeamSpec spec = scene.spec;
    const SlideOnBeam slide(std::move(spec));
    const Evaluation e(slide, scene);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    double work = 0.0;
    const NodeStep step = scene.step();
    for (int i = 0; i <= scene.spec.point; ++i) {
      const Eigen::Map<const Vec3> f(e.force.data() + 3 * i);
      sum += f;
      moment += step.position_alpha(i).cross(f);
      work += f.dot(NodeStep::at(step.u, i));
    }
    EXPECT_LT(sum.norm(), 1e-12);
    EXPECT_LT(moment.norm(), 1e-12);
    EXPECT_NEAR(work, Q * (to - from), 2e-12 * std::max(1.0, std::abs(Q)));
    EXPECT_GT(std::abs(Q), 0.01);
  }
}

}  // namespace polhode::test::slide_on_beam_step_tests
