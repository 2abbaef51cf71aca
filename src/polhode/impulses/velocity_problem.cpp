// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/QR>

#include <polhode/impulses/velocity_problem.hpp>

namespace polhode {

namespace {

using Eigen::Index;
using Kind = ImpulseRows::Kind;

/// Half-steps of Jacobi's method for the parts of the impulses that are impacts. A fixed number, so
/// that the order of rows has no effect.
constexpr int kParts = 8;
/// Mobility of a row beside held ones, as a part of its own, below which these carry it alone.
constexpr double kCarried = 1e-12;
/// Accuracy of the work that restitution returns, and most secants and bisections for it.
constexpr double kSameWork = 1e-13;
constexpr int kMostSections = 60;
/// Distance of a false position from both ends, as a part of their own.
constexpr double kInside = 1e-3;
/// Largest number of sub-steps of restitution, as a multiple of those of compression.
constexpr int kMostReturns = 8;
/// Rounding of velocities relative to the sum of their terms: that at which row problems end, for
/// as many of these as an impact has.
constexpr double kFloor = 1024.0 * std::numeric_limits<double>::epsilon();

/// Velocities and impulses of an impact along its course.
class Course {
 public:
  explicit Course(const VelocityProblem& problem)
      : problem_(problem), w_(problem.w), impulses_(Vec::Zero(problem.w.size())) {
    result_.report.converged = true;
    result_.work = impulses_;
  }

  void before_impact();
  void compress(int parts);
  void restore(int parts);
  void stop_slip();
  VelocityProblem::Result end();
  /// Whether any row approaches with friction, so that slip may change within the impact.
  [[nodiscard]] bool rubs() const {
    for (std::size_t i = 0; i < approach_.size(); ++i)
      if (approach_[i] > 0.0)
        return std::any_of(problem_.contacts.begin(), problem_.contacts.end(),
                           [](const ContactRows& c) {
                             return c.tangents >= 0 || c.torsion.first >= 0 || c.rolling.first >= 0;
                           });
    return false;
  }
  [[nodiscard]] bool returns() const {
    for (std::size_t i = 0; i < approach_.size(); ++i)
      if (approach_[i] > 0.0 && problem_.contacts[i].restitution > 0.0) return true;
    return false;
  }

 private:
  /// Velocities after a sub-step, with the work of its impulses on the bodies.
  struct Part {
    Vec w, p;
    double work = 0.0;         ///< Of all rows [J].
    double normal_work = 0.0;  ///< Of normal rows alone.
  };
  [[nodiscard]] Part part(const Vec& targets, double carried, const Vec& guess);
  void take(const Part& part) {
    result_.work += 0.5 * part.p.cwiseProduct(w_ + part.w);
    w_ = part.w;
    impulses_ += part.p;
    work_ += part.work;
  }
  void apply(const std::vector<Index>& rows, const Vec& p) {
    const Vec before = w_;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const double impulse = p[static_cast<Index>(k)];
      impulses_[rows[k]] += impulse;
      w_ += impulse * problem_.A.col(rows[k]);
    }
    for (std::size_t k = 0; k < rows.size(); ++k)
      result_.work[rows[k]] += 0.5 * p[static_cast<Index>(k)] * (before[rows[k]] + w_[rows[k]]);
  }
  [[nodiscard]] std::vector<Index> held() const;
  /// Row problem of these velocities, with the bounds of all friction.
  /// @param carried  Normal impulse of a contact besides that of its row.
  template <class Carried>
  [[nodiscard]] RowProblem rows(const Vec& velocities, const Carried& carried) const;
  /// Rounding of a row's velocity after the impulses of the step and of this instant, to which
  /// row problems are solved.
  [[nodiscard]] double floor_of(Index row) const {
    double terms =
        problem_.A.row(row).cwiseAbs().dot(impulses_.cwiseAbs()) + std::abs(problem_.w[row]);
    for (const ContactRows& c : problem_.contacts)
      terms += std::abs(problem_.A(row, c.normal)) * c.impulse;
    return std::max(problem_.noise, problem_.rounding + kFloor * terms);
  }
  const VelocityProblem& problem_;
  Vec w_, impulses_;
  std::vector<double> approach_;  ///< By contact: speed before the impact of a closing row, or 0.
  std::vector<double> carried_;   ///< By contact: normal impulse for friction besides the impact's.
  std::vector<double> work_of_;   ///< By contact: normal work absorbed in compression [J].
  double work_ = 0.0;             ///< Of all rows on the bodies since the state before the impact.
  VelocityProblem::Result result_;
};

/// Rows that neither the closing impulses nor anything else moves: normals closed at t_n that touch
/// still, or would without these impulses, and the tangents of those that stuck.
std::vector<Index> Course::held() const {
  std::vector<Index> rows;
  for (const ContactRows& c : problem_.contacts) {
    if (!c.was_closed) continue;
    double without = problem_.w[c.normal];
    for (const ContactRows& other : problem_.contacts)
      if (other.closes()) without -= problem_.A(c.normal, other.normal) * other.impulse;
    if (!c.touches && !(without <= problem_.rounding)) continue;
    rows.push_back(c.normal);
    if (c.stuck && c.tangents >= 0) {
      rows.push_back(c.tangents);
      rows.push_back(c.tangents + 1);
    }
    if (c.torsion.stuck) rows.push_back(c.torsion.first);
    for (Index k = 0; k < 2 && c.rolling.stuck; ++k) rows.push_back(c.rolling.first + k);
  }
  return rows;
}

template <class Carried>
RowProblem Course::rows(const Vec& velocities, const Carried& carried) const {
  RowProblem rows(velocities.size());
  rows.A = problem_.A;
  rows.b = velocities;
  if (problem_.lengths.size() > 0) rows.lengths = problem_.lengths;
  for (std::size_t i = 0; i < problem_.contacts.size(); ++i) {
    const ContactRows& c = problem_.contacts[i];
    rows.blocks.push_back({.kind = Kind::normal, .first = c.normal});
    const auto bound = [&](Index first, Index size, const Vec3& half_axes, double used) {
      if (first < 0) return;
      rows.blocks.push_back({.kind = Kind::friction,
                             .first = first,
                             .size = size,
                             .normal = c.normal,
                             .half_axes = half_axes,
                             .carried = carried(i, used)});
    };
    bound(c.tangents, 2, c.half_axes, c.friction);
    bound(c.torsion.first, 1, {c.torsion.length, 0.0, 0.0}, c.torsion.used);
    bound(c.rolling.first, 2, {c.rolling.length, c.rolling.length, 0.0}, c.rolling.used);
  }
  return rows;
}

/// @eq{velocity-problem}
void Course::before_impact() {
  const std::vector<ContactRows>& contacts = problem_.contacts;
  const Mat& A = problem_.A;
  std::vector<Index> C;
  double stored = problem_.projected;
  for (const ContactRows& c : contacts)
    if (c.closes()) {
      C.push_back(c.normal);
      stored += std::max(0.0, c.absorbed);
    }
  const std::vector<Index> H = held();
  const auto n = static_cast<Index>(C.size());
  Mat A_CC = A(C, C), back(static_cast<Index>(H.size()), n);
  if (!H.empty()) {
    Eigen::CompleteOrthogonalDecomposition<Mat> of_held;
    of_held.setThreshold(kCarried);  // before the factors, whose rank it determines
    of_held.compute(A(H, H));
    const Vec stop = -of_held.solve(Vec(w_(H)));
    back = of_held.solve(Mat(A(H, C)));
    stored += 0.5 * stop.dot(A(H, H) * stop);
    apply(H, stop);
    A_CC -= A(C, H) * back;
  }
  A_CC = 0.5 * (A_CC + A_CC.transpose()).eval();

  Vec s(n), p(n), D(n);
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    if (contacts[i].closes()) of.push_back(i);
  for (Index i = 0; i < n; ++i) {
    p[i] = contacts[of[static_cast<std::size_t>(i)]].impulse;
    D[i] = std::max(0.0, contacts[of[static_cast<std::size_t>(i)]].absorbed);
  }
  s = p;
  const Vec w_C = w_(C);
  for (int k = 0; k < kParts; ++k) {
    const Vec now = s;
    for (Index i = 0; i < n; ++i) {
      const double a = A_CC(i, i);
      double next = 0.0;
      if (a > kCarried * A(C[static_cast<std::size_t>(i)], C[static_cast<std::size_t>(i)])) {
        const double beta = w_C[i] - 0.5 * (A_CC.row(i).dot(now) - a * now[i]),
                     root = std::sqrt(beta * beta + 2.0 * a * D[i]);
        next = beta >= 0.0         ? (beta + root) / a
               : root - beta > 0.0 ? 2.0 * D[i] / (root - beta)
                                   : 0.0;
      }
      s[i] = 0.5 * now[i] + 0.5 * std::clamp(next, 0.0, p[i]);
    }
  }
  const double a = s.dot(A_CC * s), b = s.dot(w_C), most = p.dot(A(C, C) * p);
  double sigma = 0.0;
  if (a > kCarried * most) {
    const double root = std::sqrt(b * b + 2.0 * a * stored);
    sigma = b >= 0.0 ? (b + root) / a : 2.0 * stored / (root - b);
  }
  const Vec taken = -sigma * s;
  apply(C, taken);
  if (!H.empty()) apply(H, -(back * taken));

  approach_.assign(contacts.size(), 0.0);
  carried_.assign(contacts.size(), 0.0);
  work_of_.assign(contacts.size(), 0.0);
  for (Index k = 0; k < n; ++k) {
    const std::size_t i = of[static_cast<std::size_t>(k)];
    const double speed = w_[contacts[i].normal];
    if (speed < -floor_of(contacts[i].normal)) approach_[i] = -speed;
    // The load of the step after the impact, less the flight that follows.
    const double per_part = A_CC.row(k).dot(s),
                 flight = per_part > 0.0
                              ? 2.0 * contacts[i].restitution * approach_[i] * s[k] / per_part
                              : 0.0;
    carried_[i] = std::max(0.0, p[k] - sigma * s[k] - flight);
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (!contacts[i].closes()) carried_[i] = contacts[i].impulse;
  }
}

/// A row problem from the present velocities. @param carried  Part of the carried impulses.
/// @param guess  Impulses of a similar part; empty: none.
Course::Part Course::part(const Vec& targets, double carried, const Vec& guess) {
  const RowProblem problem = rows(w_ - targets, [&](std::size_t i, double used) {
    return carried * std::max(0.0, carried_[i] - used);
  });
  Part done{.w = {}, .p = Vec::Zero(w_.size())};
  const RowReport report =
      problem.solve(done.p, problem_.rounding, guess.size() > 0 ? &guess : nullptr);
  result_.report.iterations += report.iterations;
  result_.report.sweeps += report.sweeps;
  if (!report.converged && !(report.error <= result_.report.error)) {
    result_.report.converged = false;
    result_.report.error = report.error;
    result_.report.worst = report.worst;
  }
  done.w = w_ + problem_.A * done.p;
  const Vec mean = 0.5 * (w_ + done.w);
  done.work = done.p.dot(mean);
  for (const ContactRows& c : problem_.contacts)
    done.normal_work += done.p[c.normal] * mean[c.normal];
  return done;
}

void Course::compress(int parts) {
  const std::vector<ContactRows>& contacts = problem_.contacts;
  Vec before;  // impulses of the last part
  for (int j = 1; j <= parts; ++j) {
    Vec targets = Vec::Zero(w_.size());
    for (std::size_t i = 0; i < contacts.size(); ++i)
      targets[contacts[i].normal] = -approach_[i] * (1.0 - static_cast<double>(j) / parts);
    Part next = part(targets, 1.0 / parts, before);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Index k = contacts[i].normal;
      work_of_[i] -= 0.5 * next.p[k] * (w_[k] + next.w[k]);
    }
    take(next);
    before = std::move(next.p);
  }
}

/// Ends where the normal work returned is that of the restitution, or where all rows together have
/// returned what they took.
void Course::restore(int parts) {
  const std::vector<ContactRows>& contacts = problem_.contacts;
  double left = 0.0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    left += contacts[i].restitution * contacts[i].restitution * std::max(0.0, work_of_[i]);
  const auto targets = [&](double share) {
    Vec t = Vec::Zero(w_.size());
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (approach_[i] > 0.0)
        t[contacts[i].normal] = std::max(0.0, w_[contacts[i].normal]) +
                                share * contacts[i].restitution * approach_[i] / parts;
    return t;
  };
  const double rounding = kSameWork * std::abs(work_);
  Vec before;  // impulses of the last part
  for (int j = 0; j < kMostReturns * parts && left > 0.0; ++j) {
    const Part next = part(targets(1.0), 0.0, before);
    if (!(next.normal_work > 0.0)) return;
    if (next.normal_work < left * (1.0 - kSameWork) && work_ + next.work <= rounding) {
      left -= next.normal_work;
      take(next);
      before = next.p;
      continue;
    }
    // The last sub-step is shortened: its work is found by false positions, of which an end that
    // stays counts half (the Illinois method).
    const auto excess = [&](const Part& some) {
      return std::max(some.normal_work - left, work_ + some.work - rounding);
    };
    double low = 0.0, high = 1.0, below = -left, above = excess(next);
    double share = parts == 1 && left < next.normal_work ? std::sqrt(left / next.normal_work)
                                                         : std::min(1.0, left / next.normal_work);
    Part last = next;
    for (int k = 0, side = 0; k < kMostSections; ++k) {
      last = part(targets(share), 0.0, last.p);
      const double error = excess(last);
      if (std::abs(error) <= kSameWork * left || high - low <= kSameWork) break;
      const int now = error > 0.0 ? 1 : -1;
      (now > 0 ? high : low) = share;
      (now > 0 ? above : below) = error;
      if (now == side) (now > 0 ? below : above) *= 0.5;
      side = now;
      const double width = high - low;
      share = std::clamp(low - below * width / (above - below), low + kInside * width,
                         high - kInside * width);
    }
    take(last);
    return;
  }
}

/// Friction of rows that began to stick ends their slip, with total impulses as unknowns so that
/// normal ones may also decrease.
void Course::stop_slip() {
  RowProblem problem = rows(w_, [](std::size_t, double used) { return -used; });
  for (const ContactRows& c : problem_.contacts) problem.given[c.normal] = c.impulse;
  Vec p = Vec::Zero(w_.size());
  result_.report = problem.solve(p, problem_.rounding);
  const Vec change = problem_.A * p;
  result_.work += p.cwiseProduct(w_ + 0.5 * change);
  w_ += change;
  impulses_ += p;
}

VelocityProblem::Result Course::end() {
  for (const ContactRows& c : problem_.contacts) {
    const bool closed = c.touches && !(w_[c.normal] > floor_of(c.normal));
    const bool sticks =
        closed && (c.tangents < 0 || (std::abs(w_[c.tangents]) <= floor_of(c.tangents) &&
                                      std::abs(w_[c.tangents + 1]) <= floor_of(c.tangents + 1)));
    result_.closed.push_back(closed ? 1 : 0);
    result_.sticks.push_back(sticks ? 1 : 0);
  }
  result_.impulses = std::move(impulses_);
  return std::move(result_);
}

}  // namespace

/// @eq{velocity-problem}
VelocityProblem::Result VelocityProblem::impact() const {
  Course course(*this);
  course.before_impact();
  const int parts = course.rubs() ? kImpactSubsteps : 1;
  course.compress(parts);
  if (course.returns()) course.restore(parts);
  return course.end();
}

VelocityProblem::Result VelocityProblem::stop_slip() const {
  Course course(*this);
  course.stop_slip();
  return course.end();
}

}  // namespace polhode
