// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/load_step.hpp>
#include <polhode/loads/force_law.hpp>
#include <polhode/math/gauss_rule.hpp>

namespace polhode {

namespace {

/// Number of halvings after which an interval is round-off.
constexpr int kMaxHalvings = 44;
/// Part of the largest value below which two estimates agree.
constexpr double kAgree = 4e-16;
/// Length of steps, as a part of x, below which difference quotients are inaccurate.
constexpr double kShort = 1e-6;

/// Displacement, as a part of x, below which the mean of V' replaces the quotient of V.
constexpr double kShortWay = 1e-4;

/// Largest rate at which jumps are looked for [m/s or rad/s].
constexpr double kFastest = 0x1p20;
/// Distance from a jump, as a part of the rate, at which its limits are taken.
constexpr double kBesideJump = 0x1p-40;
/// Rounding of a multiplier that has its bound, as a part of the jump.
constexpr double kBoundRounding = 0x1p-40;
/// Rate whose displacement in a step measures the value of a row that has its bound.
constexpr double kUnitRate = 1.0;

double near_jump(double v) { return kBesideJump * std::max(std::abs(v), 1.0); }

/// V'(x) of a potential.
class SlopeFunction final : public TimeFunction {
 public:
  explicit SlopeFunction(TimeFunctionPtr V) : V_(std::move(V)) {}
  [[nodiscard]] double operator()(double x) const override {
    return V_->rates(x, TimeSide::kAfter).rate;
  }
  [[nodiscard]] TimeRates rates(double x, TimeSide side) const override {
    const TimeRates r = V_->rates(x, side);
    return {r.rate, r.second, 0.0};
  }
  [[nodiscard]] TimeBreak next_break(double x, double until) const override {
    TimeBreak b = V_->next_break(x, until);
    b.derivative = std::max(0, b.derivative - 1);
    return b;
  }

 private:
  TimeFunctionPtr V_;
};

struct Estimate {
  double mean = 0.0, size = 0.0;
};

Estimate gauss(const TimeFunction& f, double p, double q) {
  Estimate e;
  for (const auto& [place, weight] : kGauss) {
    const double value = f(p + place * (q - p));
    e.mean += weight * value;
    e.size = std::max(e.size, std::abs(value));
  }
  return e;
}

/// @param part  Of the whole interval: the weight of errors here.
double refine(const TimeFunction& f, double p, double q, const Estimate& whole, double part,
              double size, int halvings) {
  const double m = 0.5 * (p + q);
  const Estimate left = gauss(f, p, m), right = gauss(f, m, q);
  const double both = 0.5 * (left.mean + right.mean);
  size = std::max({size, left.size, right.size});
  const bool agree = std::abs(both - whole.mean) * part <= kAgree * size;
  // Without a value at a place, halves never agree.
  if (agree || !std::isfinite(both) || halvings == 0 || !(m != p && m != q)) return both;
  return 0.5 * (refine(f, p, m, left, 0.5 * part, size, halvings - 1) +
                refine(f, m, q, right, 0.5 * part, size, halvings - 1));
}

double sign_of(double x) { return x < 0.0 ? -1.0 : 1.0; }

/// Largest number of kinks of a law that are looked at one by one.
constexpr std::size_t kMostKinks = 4096;

/// Highest derivative of a law whose jumps end a smooth piece: beyond a jump of f'' the error of a
/// step of length H is H⁴ in positions, which its estimate shows.
constexpr int kRoughest = 2;

/// First kink of a law above x, where a smooth piece ends.
TimeBreak next_kink(const TimeFunction& law, double x) {
  TimeBreak b = law.next_break(x, kFastest);
  for (std::size_t k = 0; k < kMostKinks && b.exists() && b.derivative > kRoughest; ++k)
    b = law.next_break(b.t, kFastest);
  return b.derivative > kRoughest ? TimeBreak{} : b;
}

bool has_kinks(const TimeFunctionPtr& law) { return law && next_kink(*law, -kFastest).exists(); }

/// Whether a law jumps at one of its first kinks.
bool has_jumps(const TimeFunctionPtr& law) {
  if (!law) return false;
  TimeBreak b = next_kink(*law, -kFastest);
  for (std::size_t k = 0; k < kMostKinks && b.exists(); ++k, b = next_kink(*law, b.t))
    if (b.derivative == 0) return true;
  return false;
}

}  // namespace

double mean_value(const TimeFunction& f, double p, double q) {
  if (p == q || f.is_constant()) return f(q);
  const double low = std::min(p, q), high = std::max(p, q);
  // A kink near the end of an interval lies between Gauss points: intervals end at kinks.
  double sum = 0.0;
  for (double from = low; from < high;) {
    const TimeBreak kink = f.next_break(from, high);
    const double to = kink.exists() && kink.t > from && kink.t < high ? kink.t : high;
    const Estimate whole = gauss(f, from, to);
    sum += (to - from) / (high - low) * refine(f, from, to, whole, 1.0, whole.size, kMaxHalvings);
    from = to;
  }
  return sum;
}

ForceLaw::ForceLaw(const LoadDescription& load, const std::string& law)
    : k_(load.value("stiffness", 0.0)),
      k_2_(load.value("quadratic", 0.0)),
      K_(load.value("inverse_square", 0.0)),
      f_(load.law(law)),
      V_(load.law("energy")) {
  if (V_) f_ = std::make_shared<SlopeFunction>(V_);
  const std::string acts = load.word("acts");
  acts_ = acts == "tension"       ? Acts::tension
          : acts == "compression" ? Acts::compression
                                  : Acts::both;
  kinks_ = has_kinks(f_);
  jumps_ = has_jumps(f_);
  jumps_at_zero_ = acts_ != Acts::both && f_ && (*f_)(0.0) != 0.0;
}

/// k (p + q)/2 + k₂ (p² + pq + q²)/3 + K/(pq): between points of the same sign.
double ForceLaw::mean_on_one_side(double p, double q) const {
  const double x = p + q;
  if (!acts_on(x)) return 0.0;
  double mean = 0.5 * k_ * x + sign_of(x) * k_2_ * (p * p + p * q + q * q) / 3.0;
  if (K_ != 0.0) mean += K_ / (p * q);
  if (V_ && std::abs(q - p) > kShortWay * std::max(std::abs(p), std::abs(q)))
    mean += ((*V_)(q) - (*V_)(p)) / (q - p);
  else if (f_)
    mean += mean_value(*f_, p, q);
  return mean;
}

double ForceLaw::mean(double p, double q) const {
  if (!has_sides() || p * q >= 0.0) return mean_on_one_side(p, q);
  const double part = std::abs(p) / (std::abs(p) + std::abs(q));
  return part * mean_on_one_side(p, 0.0) + (1.0 - part) * mean_on_one_side(0.0, q);
}

LawValue ForceLaw::at(double x) const {
  if (!acts_on(x)) return {};
  LawValue v{k_ * x + k_2_ * std::abs(x) * x, k_ + 2.0 * k_2_ * std::abs(x)};
  if (K_ != 0.0) {
    v.value += K_ / (x * x);
    v.slope -= 2.0 * K_ / (x * x * x);
  }
  if (!f_) return v;
  const TimeRates r = f_->rates(x, TimeSide::kAfter);
  v.value += (*f_)(x);
  v.slope += r.rate;
  return v;
}

LawValue ForceLaw::over_step(double x_n, double x_n1, double alpha_f) const {
  const double shift = 2.0 * alpha_f - 1.0;  // of the lower end, by x_{n+1}
  const double low = x_n + shift * (x_n1 - x_n);
  const LawValue end = at(x_n1);
  if (low == x_n1) return {end.value, 0.5 * (1.0 + shift) * end.slope};
  const double m = mean(low, x_n1), way = x_n1 - low;
  if (std::abs(way) <= kShort * (std::abs(low) + std::abs(x_n1)))
    return {m, 0.5 * (1.0 + shift) * end.slope};
  return {m, (end.value - m + shift * (m - at(low).value)) / way};
}

void ForceLaw::piece(double x, ForcePieces& pieces) const {
  if (has_sides()) pieces.add(x > 0.0 ? 1.0 : 0.0, jumps_at_zero_);
  if (kinks_) pieces.add(acts_on(x) ? next_kink(*f_, x).t : 0.0, jumps_);
}

double ForceLaw::energy(double x) const {
  double energy = 0.0;
  if (acts_on(x)) {
    energy = (0.5 * k_ + k_2_ * std::abs(x) / 3.0) * x * x;
    if (K_ != 0.0) energy -= K_ / x;
    if (V_)
      energy += (*V_)(x);
    else if (f_)
      energy += x * mean_value(*f_, 0.0, x);
  }
  return energy;
}

std::vector<LawJump> jumps_of(const TimeFunction& law) {
  std::vector<LawJump> list;
  for (TimeBreak b = law.next_break(-kFastest, kFastest); b.exists();
       b = law.next_break(b.t, kFastest)) {
    if (b.derivative != 0) continue;
    const double near = near_jump(b.t), below = law(b.t - near), above = law(b.t + near);
    LawJump jump{b.t, above - below, 0.5 * (above - below)};
    // Bodies at rest are not moved by a resistance.
    if (std::abs(b.t) <= near && below <= 0.0 && above >= 0.0) jump = {0.0, jump.size, -below};
    list.push_back(jump);
    if (list.size() > kMostJumps) break;
  }
  return list;
}

ResistanceLaw::ResistanceLaw(const LoadDescription& load, const std::string& law)
    : c_(load.value("damping", 0.0)), f_(load.law(law)), kinks_(has_kinks(f_)) {
  if (!f_ || load.at_rest) return;
  jumps_ = jumps_of(*f_);
  if (jumps_.size() > kMostJumps)
    throw InputError(format("loads.{}.{}", load.name, law),
                     format("jumps at more than {} rates, which are not followed", kMostJumps),
                     "Give a law with fewer jumps, or one that rises over a range of rates");
  for (const LawJump& jump : jumps_) (jump.size > 0.0 ? rows_ : drops_).push_back(jump);
  if (rows_.size() <= static_cast<std::size_t>(kMaxRows)) return;
  // Those nearest to rest hold.
  std::stable_sort(rows_.begin(), rows_.end(), [](const LawJump& x, const LawJump& y) {
    return std::abs(x.at) < std::abs(y.at);
  });
  drops_.insert(drops_.end(), rows_.begin() + kMaxRows, rows_.end());
  rows_.resize(kMaxRows);
}

void ResistanceLaw::piece(double v, const double* memory, ForcePieces& pieces) const {
  if (kinks_ && rows_.empty()) pieces.add(next_kink(*f_, v).t, jumps());
  for (int k = 0; k < rows(); ++k) {
    const double size = rows_[static_cast<std::size_t>(k)].size, held = memory[kHeld + k];
    const double rounding = kBoundRounding * size;
    const double at = rows_[static_cast<std::size_t>(k)].at;
    const bool sticks = held > rounding && held < size - rounding;
    pieces.slips.push_back(sticks ? 2.0 * held / size - 1.0 : held <= rounding ? -1.0 : 1.0);
    pieces.slips.push_back(sticks ? 0.0 : v < at ? -1.0 : 1.0);
  }
}

LawValue ResistanceLaw::smooth(const StepRates& v) const {
  LawValue value{c_ * v.at_alpha, c_};
  if (!f_) return value;
  double at = v.at_alpha;
  for (const LawJump& jump : jumps_)
    if (std::abs(at - jump.at) <= near_jump(jump.at)) at = jump.at - near_jump(jump.at);
  value.value += (*f_)(at);
  value.slope += f_->rates(at, TimeSide::kAfter).rate;
  for (const LawJump& jump : jumps_)
    if (at > jump.at) value.value -= jump.size;
  for (const LawJump& jump : drops_)
    if (v.at_n > jump.at) value.value += jump.size;
  return value;
}

double ResistanceLaw::held(int row, double v, const double* memory) const {
  const LawJump& jump = rows_[static_cast<std::size_t>(row)];
  if (v > jump.at + kJumpWidth) return jump.size;
  return v < jump.at - kJumpWidth ? 0.0 : memory[kHeld + row];
}

double ResistanceLaw::of_rows(const StepRates& v, const double* lambda,
                              const double* memory) const {
  double force = 0.0;
  for (int k = 0; k < rows(); ++k) force += v.dt == 0.0 ? held(k, v.at_n, memory) : -lambda[k];
  return force;
}

/// The equation of a row at its multiplier and rate: an active set, of which neither bound is left
/// for the other without the rate of the jump between them. @eq{law-jump}
Vec6 ResistanceLaw::put_rows(const StepRates& v, const double* lambda, PairTerms& terms) const {
  Vec6 by_rate = Vec6::Zero();
  for (int k = 0; k < rows(); ++k) {
    const LawJump& jump = rows_[static_cast<std::size_t>(k)];
    if (v.dt == 0.0) {  // the force is given
      terms.compliance[k] = 1.0;
      continue;
    }
    const double force = -lambda[k], above = v.at_n1() - jump.at;
    const double rounding = kBoundRounding * jump.size;
    const bool whole = force >= jump.size - rounding && above >= 0.0;
    const bool none = force <= rounding && above <= 0.0;
    const double per_rate = v.alpha_f * v.dt;
    if (whole || none) {
      terms.compliance[k] = per_rate * kUnitRate / jump.size;
      terms.g[k] = whole ? per_rate * kUnitRate : 0.0;
      continue;
    }
    terms.compliance[k] = per_rate * kJumpWidth / jump.size;
    terms.g[k] = per_rate * above + terms.compliance[k] * jump.rest;
    by_rate[k] = v.dt;
  }
  return by_rate;
}

StepRates ResistanceLaw::rates(const PairStep& step, double now, double at_alpha,
                               const double* memory) const {
  if (is_load_step(step.context)) return {.at_n = 0.0, .at_alpha = at_alpha};
  const double offset = rows_.empty() ? 0.0 : memory[kOffset];
  if (step.context.dt == 0.0) return {.at_n = at_alpha + offset, .at_alpha = at_alpha};
  return {now + offset, at_alpha, step.a.alpha_f, step.context.dt};
}

void ResistanceLaw::initialize(double now, double* memory) const {
  if (rows_.empty()) return;
  memory[kOffset] = 0.0;
  for (int k = 0; k < rows(); ++k) {
    memory[kHeld + k] = rows_[static_cast<std::size_t>(k)].rest;
    memory[kHeld + k] = held(k, now, memory);
  }
}

void ResistanceLaw::commit(const StepRates& v, double now, const double* lambda,
                           double* memory) const {
  if (rows_.empty()) return;
  memory[kOffset] = v.at_n1() - now;
  for (int k = 0; k < rows(); ++k) memory[kHeld + k] = -lambda[k];
}

}  // namespace polhode
