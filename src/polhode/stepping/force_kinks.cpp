// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <polhode/stepping/force_kinks.hpp>
#include <polhode/system/history_record.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode {

namespace {

/// Equal parts of a step whose ends are compared: a piece that is passed in less is not noticed.
constexpr int kCompared = 8;
/// Width to which a passage is narrowed down, as a part of the margin.
constexpr double kNarrow = 0.25;

/// Weights of a value, and of a rate times the length, at both ends of [0, 1] in the cubic
/// polynomial, and in its derivative.
struct Cubic {
  double from, to, rate_from, rate_to;
};

Cubic cubic_at(double s) {
  const double to = s * s * (3.0 - 2.0 * s), left = 1.0 - s;
  return {1.0 - to, to, s * left * left, -s * s * left};
}

Cubic slope_at(double s) {
  const double to = 6.0 * s * (1.0 - s);
  return {-to, to, (1.0 - s) * (1.0 - 3.0 * s), s * (3.0 * s - 2.0)};
}

/// A quaternion's numbers as a vector (x, y, z, w), and the rate of these.
using Vec4 = Eigen::Vector4d;
Vec4 rate_of(const Quat& q, const Vec3& W) {
  return 0.5 * (q * Quat(0.0, W.x(), W.y(), W.z())).coeffs();
}

/// Row of the same features in a list; null if there is none.
const ClosedRow* same_row(const std::vector<ClosedRow>& rows, const ClosedRow& row) {
  const auto same = std::ranges::find(rows, row.features, &ClosedRow::features);
  return same != rows.end() ? &*same : nullptr;
}

}  // namespace

/// Two states, and what lies between them.
struct ForceKinks::Between {
  const System& system;
  const State &from, &to;
  double H;

  [[nodiscard]] BodyStep body(int b, double s) const {
    if (b == kGround) return BodyStep::ground(1.0);
    if (s == 0.0 || s == 1.0) return system.instant(s == 0.0 ? from : to, b);
    const BodyMotion m = system.motion(from, b), n = system.motion(to, b);
    const Cubic value = cubic_at(s), slope = slope_at(s);
    const auto mixed = [&](const Cubic& c, const auto& x, const auto& y, const auto& x_rate,
                           const auto& y_rate) {
      return (c.from * x + c.to * y + H * (c.rate_from * x_rate + c.rate_to * y_rate)).eval();
    };
    const Vec4 p = m.q.coeffs(), p_rate = rate_of(m.q, m.W);
    const double sign = p.dot(n.q.coeffs()) < 0.0 ? -1.0 : 1.0;
    const Vec4 q = sign * n.q.coeffs(), q_rate = sign * rate_of(n.q, n.W);
    const Vec4 at = mixed(value, p, q, p_rate, q_rate);
    const Vec4 moving = mixed(slope, p, q, p_rate, q_rate) / H;
    const double per_size = 1.0 / at.norm();
    const Quat turned(Vec4(per_size * at));
    const Quat rate(Vec4(per_size * moving));
    return BodyStep::at_instant(mixed(value, m.r, n.r, m.v, n.v), turned.toRotationMatrix(),
                                mixed(slope, m.r, n.r, m.v, n.v) / H,
                                2.0 * (turned.conjugate() * rate).vec());
  }

  /// Memories change evenly.
  [[nodiscard]] std::vector<double> history(const InteractionRef& ref, double s) const {
    const auto first = static_cast<std::size_t>(ref.first_history);
    std::vector<double> list(static_cast<std::size_t>(system.traits(ref).history_size));
    for (std::size_t k = 0; k < list.size(); ++k)
      list[k] = (1.0 - s) * from.history[first + k] + s * to.history[first + k];
    return list;
  }
};

ForceKinks::ForceKinks(const System& system) : system_(&system) {
  for (const InteractionRef& ref : system.interactions())
    if (const InteractionTraits& traits = system.traits(ref); traits.piecewise)
      items_.push_back(ref);
    else if (traits.has_barrier || traits.unilateral > 0)
      stops_.push_back(ref);
  const Nodes& nodes = system.nodes();
  for (int g = 0; g < nodes.group_count(); ++g)
    if (nodes.group(g).piecewise()) groups_.push_back(g);
  BodyContacts* const contacts = system.contacts().get();
  if (are_rows(contacts)) contacts_ = contacts->impulsive();
}

ForcePieces ForceKinks::pieces(const Between& states, double s, double histories,
                               bool stops) const {
  ForcePieces found;
  StepContext still;
  still.t_n = states.from.t + s * states.H;
  still.tangents = false;
  const std::array<double, kMaxRows> no_multipliers{};
  const auto add = [&](const InteractionRef& ref) {
    const std::vector<double> history = states.history(ref, histories);
    const BodyStep a = states.body(ref.a, s), b = states.body(ref.b, s);
    system_->group(ref.group).pieces(
        ref.item, PairStep{a, b, still, no_multipliers.data(), history.data()}, found);
  };
  std::ranges::for_each(items_, add);
  if (stops) std::ranges::for_each(stops_, add);
  if (groups_.empty()) return found;
  const Cubic value = cubic_at(s), slope = slope_at(s);
  const State &from = states.from, &to = states.to;
  std::vector<double> x(from.node_x.size()), v(x.size());
  for (std::size_t k = 0; k < x.size(); ++k) {
    const auto mixed = [&](const Cubic& c) {
      return c.from * from.node_x[k] + c.to * to.node_x[k] +
             states.H * (c.rate_from * from.node_v[k] + c.rate_to * to.node_v[k]);
    };
    x[k] = mixed(value);
    v[k] = mixed(slope) / states.H;
  }
  const Nodes& nodes = system_->nodes();
  const NodeStep instant{.x_n = x.data(),
                         .x_n1 = x.data(),
                         .u = nodes.no_displacement().data(),
                         .v_n = v.data(),
                         .v_n1 = v.data(),
                         .context = still,
                         .alpha_f = 1.0,
                         .rate = 0.0};
  for (const int g : groups_)
    nodes.group(g).pieces(instant, from.element_history.data() + nodes.first_history(g), found);
  return found;
}

std::optional<double> ForceKinks::first(const State& from, const State& to,
                                        const Margins& margins) const {
  if (items_.empty() && groups_.empty()) return std::nullopt;
  const Between states{*system_, from, to, to.t - from.t};
  const auto kink = first(states, margins.kink, &ForcePieces::kinks, false);
  const auto jump = first(states, margins.jump, &ForcePieces::jumps, false);
  return kink && jump ? std::min(kink, jump) : kink ? kink : jump;
}

std::optional<double> ForceKinks::first_turn(const State& from, const State& to,
                                             double margin) const {
  if (items_.empty()) return std::nullopt;
  const Between states{*system_, from, to, to.t - from.t};
  const std::vector<double> start = pieces(states, 0.0, 0.0, false).slips;
  if (std::ranges::none_of(start, [](double x) { return std::abs(x) == 1.0; })) return std::nullopt;
  return first(states, margin, &ForcePieces::slips, true);
}

ForceKinks::Ends ForceKinks::ends(const State& from, const State& to) const {
  if (none()) return {};
  const Between states{*system_, from, to, to.t - from.t};
  Ends ends{pieces(states, 0.0, 0.0, true), pieces(states, 1.0, 1.0, true), {}, {}};
  if (!contacts_) return ends;
  ends.rows_before = contacts_->closed_rows(from);
  ends.rows_after = contacts_->closed_rows(to);
  const double still = system_->touching_gap() / states.H;  // no rotation is below rounding
  for (const ClosedRow& row : ends.rows_after) {
    const ClosedRow* const earlier = same_row(ends.rows_before, row);
    if (!earlier) continue;  // slip may jump where a row closes
    struct Motion {
      Vec3 slip, spin;
    };
    const auto at = [&](const State& state) {
      const auto motion = [&](int body) {
        return body == kGround ? BodyMotion{} : system_->motion(state, body);
      };
      const BodyMotion a = motion(row.bodies.a), b = motion(row.bodies.b);
      return Motion{a.v + a.omega().cross(row.point - a.r) - b.v - b.omega().cross(row.point - b.r),
                    system_->length_scale() * (a.omega() - b.omega())};
    };
    const Motion before = at(from), after = at(to);
    const auto about = [&](const Vec3& x) { return Vec3(row.normal.dot(x) * row.normal); };
    const auto across = [&](const Vec3& x) { return Vec3(x - about(x)); };
    const auto turns = [&](const Vec3& x, const Vec3& y) {
      if (!(x.dot(y) < 0.0) || std::min(x.norm(), y.norm()) <= still) return;
      ends.turn = std::min(ends.turn, x.norm() / (x.norm() + y.norm()));
    };
    if (row.slips)
      turns(across(before.slip), across(after.slip));
    else if (earlier->slips)
      ends.stopped = std::max(ends.stopped, across(before.slip).norm() / system_->length_scale());
    if (!about(row.turning).isZero(0.0)) turns(about(before.spin), about(after.spin));
    if (!across(row.turning).isZero(0.0)) turns(across(before.spin), across(after.spin));
  }
  return ends;
}

const ClosedRow* ForceKinks::Ends::later(const ClosedRow& row) const {
  return same_row(rows_after, row);
}

bool ForceKinks::Ends::passed() const {
  const auto same_state = [](double x, double y) {
    return (std::abs(x) < 1.0 && std::abs(y) < 1.0) || x == y;
  };
  const auto row_passed = [&](const ClosedRow& row) {
    const ClosedRow* const now = later(row);
    if (!now || now->slips != row.slips) return true;
    // Friction that turns around; normals hardly change.
    return row.slips && row.impulse.dot(now->impulse) < row.pressed * now->pressed;
  };
  return turn < 1.0 || std::ranges::any_of(rows_before, row_passed) ||
         before.kinks != after.kinks || before.jumps != after.jumps ||
         !std::ranges::equal(before.slips, after.slips, same_state);
}

/// Forces of rows are means over a step, at its middle: the line through those of this step and the
/// one before. @eq{break-away}
std::optional<double> ForceKinks::break_away(const State& from, const State& to,
                                             const Ends& ends) const {
  const double H = to.t - from.t, apart = 0.5 * (H + from.dt_last);
  // Forces from before a jump have no line to those after it.
  if (none() || from.past_count == 0 || !(from.dt_last > 0.0)) return std::nullopt;
  double first = 1.0;
  const auto look = [&](double before, double now, double least, double most) {
    const double slope = (now - before) / apart;
    const double bound = slope > 0.0 ? most : least;
    if (slope == 0.0 || !std::isfinite(bound) || before <= least || before >= most) return;
    const double later = (bound - now) / slope;
    if (later > 0.0 && now > least && now < most) first = std::min(first, 0.5 + later / H);
  };
  const std::vector<double>&before = ends.before.slips, &after = ends.after.slips;
  for (std::size_t k = 0; k < std::min(before.size(), after.size()); ++k)
    if (before[k] != 0.0 && after[k] != 0.0) look(before[k], after[k], -1.0, 1.0);
  const auto look_at_rows = [&](const InteractionRef& ref) {
    const InteractionTraits& traits = system_->traits(ref);
    for (int row = 0; row < traits.unilateral; ++row) {
      const int entry = ref.first_history + traits.unilateral_entry +
                        row * static_cast<int>(kNumbersOf<UnilateralMemory>);
      look(read_record<UnilateralMemory>(from.history.data() + entry).force,
           read_record<UnilateralMemory>(to.history.data() + entry).force, 0.0,
           std::numeric_limits<double>::infinity());
    }
  };
  std::ranges::for_each(items_, look_at_rows);
  std::ranges::for_each(stops_, look_at_rows);
  for (const ClosedRow& row : ends.rows_before) {
    const ClosedRow* const now = ends.later(row);
    if (!now) continue;
    look(row.pressed / from.dt_last, now->pressed / H, 0.0,
         std::numeric_limits<double>::infinity());
    if (!row.slips && !now->slips) look(row.held, now->held, -1.0, 1.0);
  }
  if (!(first < 1.0)) return std::nullopt;
  return first;
}

std::optional<double> ForceKinks::first(const Between& states, double margin,
                                        std::vector<double> ForcePieces::*sort, bool kept) const {
  if (2.0 * margin >= 1.0) return std::nullopt;
  const double begin = kept ? 0.0 : margin;
  const auto names = [&](double s) { return pieces(states, s, kept ? 0.0 : s, false).*sort; };
  const std::vector<double> start = names(begin);
  if (start.empty()) return std::nullopt;
  double before = begin, after = begin;
  for (int k = 1; k <= kCompared; ++k) {
    before = after;
    after = begin + k * (1.0 - margin - begin) / kCompared;
    if (names(after) != start) break;
    if (k == kCompared) return std::nullopt;
  }
  while (after - before > kNarrow * margin) {
    const double middle = 0.5 * (before + after);
    if (!(middle > before && middle < after)) break;
    (names(middle) == start ? before : after) = middle;
  }
  return after;
}

}  // namespace polhode
