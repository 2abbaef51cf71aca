// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <polhode/loads/load_description.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>
#include <support/model_builder.hpp>
#include <support/random_steps.hpp>

namespace polhode::test {

/// A time function from a lambda.
class Function : public TimeFunction {
 public:
  explicit Function(std::function<double(double)> f) : f_(std::move(f)) {}
  double operator()(double t) const override { return f_(t); }

 private:
  std::function<double(double)> f_;
};

[[nodiscard]] inline TimeVector constant(const Vec3& v) {
  return {std::make_shared<Constant>(v.x()), std::make_shared<Constant>(v.y()),
          std::make_shared<Constant>(v.z())};
}

/// The item's D blocks are the derivative of its wrenches: both bodies moving, and either ground.
template <class Item>
void expect_wrench_tangent(const Item& item, PairMotion m, const std::string& what) {
  for (const auto& [a_moves, b_moves] :
       {std::pair(true, true), std::pair(false, true), std::pair(true, false)}) {
    m.a_moves = a_moves;
    m.b_moves = b_moves;
    expect_derivative(
        wrench_tangent(evaluate(item, m)),
        [&](const Vec& d) -> Vec {
          Displacement only = d;
          for (int k = 0; k < 12; ++k)
            if (!m.moves(k)) only[k] = 0.0;
          return wrenches(evaluate(item, m, only));
        },
        what);
  }
}

template <class Item>
[[nodiscard]] Work work(const Item& item, const PairMotion& m) {
  return m.with(Displacement::Zero(), [&](const PairStep& s) { return item.work(s); });
}

/// Potential at the instant t_n.
template <class Item>
[[nodiscard]] double stored_at_start(const Item& item, const PairMotion& m) {
  return m.at_start([&](const PairStep& s) { return item.work(s).stored; });
}

/// Work of the wrenches over the step, exact at ρ∞ = 1 [J].
[[nodiscard]] inline double work_done(const PairMotion& m, const PairTerms& t) {
  return wrenches(t).dot(step_motion(m));
}

}  // namespace polhode::test
