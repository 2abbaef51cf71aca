// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <polhode/equations/line_search.hpp>
#include <polhode/impulses/row_problem.hpp>

namespace polhode {

namespace {

using Eigen::Index;
using Kind = ImpulseRows::Kind;

constexpr double kEndless = std::numeric_limits<double>::infinity();
/// Rounding of a velocity relative to the sum of its terms.
constexpr double kRounding = 64.0 * std::numeric_limits<double>::epsilon();
/// Mobility of rows, as a part of the largest one, below which no impulse moves them.
constexpr double kHeld = 1e-13;
constexpr int kMostIterations = 120;
/// Number of iterations without an error below this part of the smallest one, which end the search.
constexpr int kPatience = 30;
constexpr double kProgress = 0.9;
/// Halvings of a step that exceeds the merits of previous iterates.
constexpr LineSearchRule kHalveRows{0.0, 8, 0.5, 0.5, 0.5};
/// Number of previous iterates whose merit must not be exceeded; it may rise above the last one.
constexpr std::size_t kLookBack = 5;
/// Initial proximal parameters ε, parts of the diagonal of A: of the first search and of restarts.
constexpr std::array kProximalParts{1e-3, 1e-1};
/// Initial proximal parameter of a search from a guess, most of whose rows act as those of the
/// solution.
constexpr double kProximalOfGuess = 1e-6;
/// Factor of that part after an iteration that leaves more than this of the error, and the part at
/// which they end: below the rounding of velocities.
constexpr double kLessProximal = 0.1, kLeastProximal = 1e-14;
/// Part of the error of the initial impulses that may be left, see RowProblem::exact_below.
constexpr double kLooseness = 1e-3;
/// Sweeps between two searches by Newton's method, of which each round doubles the number.
constexpr int kSweeps = 25;
constexpr int kRounds = 6, kRoundsOfMany = 2;  ///< The latter beyond kMostDenseRows.

/// Matrices whose rows are taken one by one.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Velocities of a problem and the natural map of its impulses.
class Search {
 public:
  Search(const RowProblem& problem, const Vec& start, double tolerance)
      : problem_(problem),
        A_(problem.A),
        sizes_(A_.cwiseAbs()),
        start_(start),
        best_(start),
        p_(start),
        tolerance_(tolerance) {
    d_.setZero(start.size());
    const double most = start.size() > 0 ? problem.A.diagonal().maxCoeff() : 0.0;
    for (const ImpulseRows& block : problem.blocks) {
      const double d = mobility(block);
      if (!(d > kHeld * most)) continue;
      // The projection along a ray is the nearest point of an ellipse in the metric in which that
      // is a circle: there the velocity is against the impulse, and normal to the ellipse here.
      const auto axes = block.half_axes.head(block.size);
      const bool round = block.kind != Kind::friction || !(axes.minCoeff() > 0.0);
      for (Index k = 0; k < block.size; ++k) {
        const double part = round ? 1.0 : axes.maxCoeff() / axes[k];
        d_[block.first + k] = part * part * d;
      }
    }
    weight_ = d_;
    if (problem.even)
      for (double& w : weight_)
        if (w > 0.0) w = most;
  }

  RowReport run(Vec& p, const Vec* guess) {
    bool found = start_.size() == 0 || (accept() && !problem_.even);
    if (report_.error > problem_.exact_below)
      tolerance_ = std::max(tolerance_, kLooseness * report_.error);
    if (guess && !found) {
      p_ = *guess;
      found = newton(start_, problem_.even ? kProximalParts.front() : kProximalOfGuess, true);
    }
    for (const double part : kProximalParts) {
      if (found) break;
      p_ = best_;
      found = newton(start_, part);
    }
    const int rounds = start_.size() > kMostDenseRows ? kRoundsOfMany : kRounds;
    for (int round = 0; round < rounds && !found; ++round) {
      p_ = best_;
      found = sweep(kSweeps << round) || newton(best_, kProximalParts.back());
    }
    p = best_;
    report_.converged = found || least_ <= 1.0;
    return report_;
  }

 private:
  /// Largest eigenvalue of the block of these rows.
  [[nodiscard]] double mobility(const ImpulseRows& block) const {
    const Index i = block.first;
    if (block.size == 1) return problem_.A(i, i);
    const Mat own = problem_.A.block(i, i, block.size, block.size);
    return Eigen::SelfAdjointEigenSolver<Mat>(own, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  }

  /// The natural map F at p_, and its derivative if wanted.
  /// @param y  Velocities at p_. @param D  Their derivative.
  void evaluate(const Vec& y, const Rows& D, Vec& F, Rows* J) {
    const Index n = p_.size();
    F = p_ - start_;  // rows that no impulse moves keep theirs
    pressed_ = (problem_.given + p_).cwiseMax(0.0);
    if (J) J->setIdentity(n, n);
    for (const ImpulseRows& block : problem_.blocks) {
      const Index i = block.first;
      if (block.kind == Kind::friction || d_[i] == 0.0) continue;
      const double total = problem_.given[i] + p_[i], z = total - y[i] / d_[i];
      const bool acts = block.kind == Kind::equality || z > 0.0;
      F[i] = acts ? y[i] / d_[i] : total;
      pressed_[i] = acts ? z : 0.0;
      if (J && acts) J->row(i) = D.row(i) / d_[i];
    }
    for (const ImpulseRows& block : problem_.blocks)
      if (block.kind == Kind::friction && d_[block.first] > 0.0) friction(block, y, D, F, J);
  }

  /// Friction by its projection onto the cone along a ray.
  void friction(const ImpulseRows& block, const Vec& y, const Rows& D, Vec& F, Rows* J) const {
    const Index t = block.first, k = block.size, n = block.normal;
    const auto axes = block.half_axes.head(k);
    F.segment(t, k) = problem_.given.segment(t, k) + p_.segment(t, k);
    const double bound = bound_of(block, pressed_);
    if (bound == 0.0) return;
    const Few d = d_.segment(t, k);
    const auto over_d = [&] { return (D.middleRows(t, k).array().colwise() / d.array()).matrix(); };
    const Few z = F.segment(t, k) - y.segment(t, k).cwiseQuotient(d);
    const double size = z.cwiseQuotient(axes).norm();
    if (size <= bound) {
      F.segment(t, k) = y.segment(t, k).cwiseQuotient(d);
      if (J) J->middleRows(t, k) = over_d();
      return;
    }
    F.segment(t, k) -= bound / size * z;
    if (!J) return;
    const Few weighted = z.cwiseQuotient(axes).cwiseQuotient(axes);
    FewByFew turn = -bound / (size * size * size) * z * weighted.transpose();
    turn.diagonal().array() += bound / size;
    J->middleRows(t, k) += turn * over_d();
    J->block(t, t, k, k) -= turn;
    if (n < 0 || d_[n] == 0.0 || !(pressed_[n] > 0.0)) return;
    J->middleRows(t, k) += z / size * (D.row(n) / d_[n]);
    J->block(t, n, k, 1) -= z / size;
  }

  /// Normal impulse that bounds the friction of these rows; 0 where they have none.
  [[nodiscard]] static double bound_of(const ImpulseRows& block, const Vec& normal) {
    if (!(block.half_axes.head(block.size).minCoeff() > 0.0)) return 0.0;
    return std::max(0.0, block.carried + (block.normal >= 0 ? normal[block.normal] : 0.0));
  }

  /// Largest error of a row's velocity, as a part of what is allowed. @param worst  Its row.
  [[nodiscard]] double excess(const Vec& F, Index* worst = nullptr) const {
    double largest = 0.0;
    const Vec terms = sizes_ * p_.cwiseAbs() + problem_.b.cwiseAbs();
    for (Index i = 0; i < F.size(); ++i) {
      const double error = std::abs(F[i]) * d_[i] * problem_.lengths[i];
      const double rounding = kRounding * problem_.lengths[i] * terms[i];
      const double part = error > 0.0         ? error / (tolerance_ + rounding)
                          : std::isnan(error) ? kEndless
                                              : 0.0;
      if (!(part <= largest)) {
        largest = part;
        if (worst) *worst = i;
      }
    }
    return largest;
  }

  /// Keeps p_ if it is the best so far. @returns whether it solves the problem.
  bool accept() {
    y_exact_.noalias() = A_ * p_;
    y_exact_ += problem_.b;
    evaluate(y_exact_, A_, F_exact_, nullptr);
    Index worst = -1;
    const double error = excess(F_exact_, &worst);
    if (error < least_) {
      least_ = error;
      best_ = p_;
      report_.worst = worst;
      report_.error =
          worst < 0 ? 0.0 : std::abs(F_exact_[worst]) * d_[worst] * problem_.lengths[worst];
    }
    return error <= 1.0;
  }

  /// Newton's method inside proximal iterations, which add ε_i d times the change of an impulse
  /// since the last one to its velocity. @param guessed  p_ is not near the centre, and no solution
  /// before the first iteration. @returns whether it solves the problem.
  bool newton(const Vec& centre, double part, bool guessed = false) {
    Vec middle = centre, y, F;
    Rows D = A_, J;
    D.diagonal() += part * weight_;
    const auto merit = [&](Rows* derivative) {
      y.noalias() = D * p_;
      y += problem_.b - part * weight_.cwiseProduct(middle);
      evaluate(y, D, F, derivative);
      const double error =
          F.cwiseProduct(d_).cwiseProduct(problem_.lengths).lpNorm<Eigen::Infinity>();
      return error * error;
    };
    std::array<double, kLookBack> merits{};
    merits.fill(kEndless);
    double least = kEndless, left = kEndless;
    for (int it = 0, last = 0; it < kMostIterations && it - last < kPatience; ++it) {
      const double now = merit(&J);
      if (!std::isfinite(now)) return false;
      const bool begins = guessed && it == 0;
      const bool solved_here = !begins && accept(), near_centre = !begins && excess(F) <= 1.0;
      if (solved_here && near_centre) best_ = p_;
      if (solved_here && (near_centre || !problem_.even)) return true;
      if (near_centre) {  // solved, with the proximal terms
        middle = p_;
        // A smaller part also multiplies rounding where rows share a load.
        if (least_ > kLessProximal * left) {
          if (part < kLeastProximal) return false;
          D.diagonal() -= (1.0 - kLessProximal) * part * weight_;
          part *= kLessProximal;
        }
        left = least_;
        merits.fill(kEndless);
        least = kEndless;
        last = it;
        continue;
      }
      if (now < kProgress * kProgress * least) {
        least = now;
        last = it;
      }
      merits[static_cast<std::size_t>(it) % kLookBack] = now;
      const Vec step = solved(J, F), from = p_;
      ++report_.iterations;
      if (!step.allFinite()) return false;
      const auto apply = [&](double whole) {
        p_ = from + whole * step;
        return whole;
      };
      search_along(kHalveRows, *std::max_element(merits.begin(), merits.end()), 1.0, apply,
                   [&] { return merit(nullptr); });
    }
    return false;
  }

  /// Newton step −J⁻¹ F. Rows without an impulse, whose part of J is that of the identity, are
  /// not factored, and others not anew where all stick as before.
  [[nodiscard]] Vec solved(const Rows& J, const Vec& F) {
    std::vector<Index> acts;
    for (Index i = 0; i < F.size(); ++i)
      if (J(i, i) != 1.0 || J.row(i).cwiseAbs().sum() != 1.0) acts.push_back(i);
    Vec step = -F;
    if (acts.empty()) return step;
    step(acts).setZero();
    const Vec right = -F - J * step;
    Rows own = J(acts, acts);
    if (own.rows() != factored_.rows() || own != factored_) {
      factors_.compute(own);
      factored_.swap(own);
    }
    const Vec of_own = factors_.solve(Vec(right(acts)));
    for (std::size_t k = 0; k < acts.size(); ++k) step[acts[k]] = of_own[static_cast<Index>(k)];
    return step;
  }

  /// Projected Gauss-Seidel sweeps, forwards and backwards in turn.
  /// @returns whether they solve the problem.
  bool sweep(int count) {
    Vec y = problem_.A * p_ + problem_.b;
    Vec total = problem_.given + p_;
    const auto change = [&](Index i, double next) {
      const double more = next - total[i];
      if (more == 0.0) return;
      y += more * problem_.A.col(i);
      p_[i] += more;
      total[i] = next;
    };
    const auto blocks = static_cast<Index>(problem_.blocks.size());
    for (int s = 0; s < count; ++s, ++report_.sweeps)
      for (Index k = 0; k < blocks; ++k) {
        const ImpulseRows& block =
            problem_.blocks[static_cast<std::size_t>(s % 2 == 0 ? k : blocks - 1 - k)];
        const Index i = block.first;
        if (d_[i] == 0.0) continue;
        if (block.kind != Kind::friction) {
          const double z = total[i] - y[i] / d_[i];
          change(i, block.kind == Kind::equality ? z : std::max(0.0, z));
          continue;
        }
        Few z = total.segment(i, block.size) -
                y.segment(i, block.size).cwiseQuotient(d_.segment(i, block.size));
        const double bound = bound_of(block, total);
        const double size =
            bound > 0.0 ? z.cwiseQuotient(block.half_axes.head(block.size)).norm() : kEndless;
        if (!(bound > 0.0))
          z.setZero();
        else if (size > bound)
          z *= bound / size;
        for (Index j = 0; j < block.size; ++j) change(i + j, z[j]);
      }
    return accept();
  }

  using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  using FewByFew = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

  const RowProblem& problem_;
  const Rows A_, sizes_;  ///< A of the problem, and its entries' magnitudes.
  Vec start_, best_, p_;
  double tolerance_, least_ = kEndless;
  Vec weight_;   ///< Of the change of each impulse in proximal iterations, over ε.
  Vec d_;        ///< Mobility of each row, that of its block; 0: no impulse moves it.
  Vec pressed_;  ///< Normal impulses, projected.
  Vec y_exact_, F_exact_;
  Rows factored_;  ///< Matrix of the factors.
  Eigen::PartialPivLU<Rows> factors_;
  RowReport report_;
};

}  // namespace

RowProblem::RowProblem(Eigen::Index rows)
    : A(Mat::Zero(rows, rows)),
      b(Vec::Zero(rows)),
      given(Vec::Zero(rows)),
      lengths(Vec::Ones(rows)) {}

/// @eq{row-problem}
RowReport RowProblem::solve(Vec& p, double tolerance, const Vec* guess) const {
  return Search(*this, p, tolerance).run(p, guess);
}

}  // namespace polhode
