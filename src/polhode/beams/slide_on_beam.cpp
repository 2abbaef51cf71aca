// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/assert.hpp>
#include <polhode/core/format.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Nodes of the System that take part in a step, at most: the point, a pair for each node of the
/// beam, and two further axes.
constexpr int kMostSlideNodes = 2 * CurveStep::kMostNodes + 3;
/// Proximal ε times the largest stiffness that a multiplier meets: increments contract by this
/// factor. Where all is at the step's end, as in statics, a larger one leaves more digits to the
/// elements.
constexpr double kSlideProximal = 1e-6, kSlideProximalEnd = 1e-3;
/// Elements on either side of the point for which the matrix has blocks, at least.
constexpr int kSlideWindow = 8;
/// Part of the beam's length by which a point may be beyond its end: rounding.
constexpr double kSlideBeyond = 1e-9;
/// Iterations of the search for the nearest place, and its accuracy as a part of an element.
constexpr int kSlideSearches = 30;
constexpr double kSlideFound = 1e-14;
/// Gap, as a part of an element, up to which the rows hold: their multipliers are then the forces.
constexpr double kSlideHolds = 1e-12;

}  // namespace

struct SlideOnBeam::History {
  double s, change;  ///< Position at t_n, and its change over the last step [m].
  double force[3];   ///< Of the last step, on the body [N].
};

struct SlideOnBeam::Scratch {
  double lambda[3], s;
  double fresh;                      ///< 1 until the first evaluation of a step.
  double along;                      ///< Q of a prescribed position: its reaction [N].
  double count;                      ///< Nodes that take part.
  double node[kMostSlideNodes];      ///< Their numbers.
  double z[4];                       ///< K_yy⁻¹ R.
  double Z[4][3 * kMostSlideNodes];  ///< K_yy⁻¹ K_yx.
};

/// Everything that an evaluation needs of the nodes that take part, in their order: the point, then
/// centre and x tip of each node of the beam, then the y and z tips of the first.
struct SlideOnBeam::Local {
  using Weight = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostSlideNodes, 1>;
  using Field = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostSlideNodes>;

  std::array<int, kMostSlideNodes> node{};
  int count = 0;
  Field x_n, x_n1, x_alpha, u;
  Weight mean, mean_s;         ///< ĉ, and its derivative by s_{n+1}.
  Weight slope, slope_s;       ///< ΔC/Δs, likewise.
  Weight end, end_s;           ///< c(s_{n+1}), likewise.
  std::array<Weight, 3> axis;  ///< d_k = Σ axis_k,i x_i.
  bool exact = false;          ///< Divided differences: the form that conserves.

  Local(const SlideOnBeamSpec& spec, const BeamCurve& curve, const NodeStep& step, double s_n,
        double s) {
    const CurveStep nodes(curve, s_n, s);
    const auto take = [&](int n) { node[static_cast<std::size_t>(count++)] = n; };
    take(spec.point);
    for (int i = 0; i < nodes.count(); ++i) {
      take(spec.nodes[static_cast<std::size_t>(nodes.node(i))][0]);
      take(spec.nodes[static_cast<std::size_t>(nodes.node(i))][1]);
    }
    const auto& first = spec.nodes[static_cast<std::size_t>(nodes.node(nodes.first()))];
    take(first[2]);
    take(first[3]);
    x_n.resize(3, count);
    x_n1.resize(3, count);
    u.resize(3, count);
    for (int i = 0; i < count; ++i) {
      const int n = node[static_cast<std::size_t>(i)];
      x_n.col(i) = NodeStep::at(step.x_n, n);
      x_n1.col(i) = NodeStep::at(step.x_n1, n);
      u.col(i) = NodeStep::at(step.u, n);
    }
    const double af = step.alpha_f;
    x_alpha = (1.0 - af) * x_n + af * x_n1;
    const auto weights = [&](const CurveStep::Weights& w) {
      Weight c = Weight::Zero(count);
      for (int i = 0; i < nodes.count(); ++i) {
        const double per_tip = w(i, 1) / spec.tip;
        c[1 + 2 * i] = w(i, 0) - per_tip;
        c[2 + 2 * i] = per_tip;
      }
      return c;
    };
    exact = step.context.conserving && af == 0.5;
    end = weights(nodes.at_end(0));
    end_s = weights(nodes.at_end(1));
    mean = weights((1.0 - af) * nodes.at_start(0) + af * nodes.at_end(0));
    mean_s = af * end_s;
    if (exact) {
      slope = weights(nodes.slope());
      slope_s = weights(nodes.slope_rate());
    } else {
      slope = weights((1.0 - af) * nodes.at_start(1) + af * nodes.at_end(1));
      slope_s = af * weights(nodes.at_end(2));
    }
    const int centre = 1 + 2 * nodes.first();
    for (int k = 0; k < 3; ++k) {
      Weight& a = axis[static_cast<std::size_t>(k)];
      a = Weight::Zero(count);
      a[centre] = -1.0 / spec.tip;
      a[k == 0 ? centre + 1 : count - 3 + k] = 1.0 / spec.tip;
    }
  }
  /// Weights of x_b − Σ c x.
  [[nodiscard]] static Weight gap(const Weight& c) {
    Weight p = -c;
    p[0] += 1.0;
    return p;
  }
  [[nodiscard]] const Weight& d(int k) const { return axis[static_cast<std::size_t>(k)]; }
  /// Force on the point, Σ λ d.
  [[nodiscard]] Vec3 force(const double* lambda) const {
    Vec3 F = Vec3::Zero();
    for (int k = 0; k < 3; ++k) F += lambda[k] * (x_alpha * d(k));
    return F;
  }
  /// Σ λ Δd, the change of the axes under the multipliers.
  [[nodiscard]] Vec3 turning(const double* lambda) const {
    Vec3 f = Vec3::Zero();
    for (int k = 0; k < 3; ++k) f += lambda[k] * (u * d(k));
    return f;
  }
  /// Σ Δc Δx over Δs, without the point: zero unless the divided differences are exact.
  [[nodiscard]] Vec3 second() const { return exact ? Vec3(u * slope) : Vec3(Vec3::Zero()); }
  /// Force along the beam, conjugate to s.
  [[nodiscard]] double along(const double* lambda) const {
    return force(lambda).dot(x_alpha * slope) + 0.25 * turning(lambda).dot(second());
  }
};

SlideOnBeam::SlideOnBeam(SlideOnBeamSpec spec) : spec_(std::move(spec)), curve_(spec_.lengths) {
  POLHODE_ASSERT(spec_.nodes.size() == spec_.lengths.size() + 1);
  reach_.push_back(spec_.point);
  for (const auto& four : spec_.nodes) reach_.insert(reach_.end(), four.begin(), four.end());
  std::sort(reach_.begin(), reach_.end());
}

std::size_t SlideOnBeam::history_size() const { return kNumbersOf<History>; }
std::size_t SlideOnBeam::scratch_size() const { return kNumbersOf<Scratch>; }

void SlideOnBeam::initialize(double* history) const {
  write_record(History{.s = spec_.start, .change = 0.0, .force = {}}, history);
}

void SlideOnBeam::begin_step(const double* history, double* scratch) const {
  Scratch s{};
  s.s = read_record<History>(history).s;
  s.fresh = 1.0;
  write_record(s, scratch);
}

Vec3 SlideOnBeam::place(const double* x, double s, int order) const {
  const int e = curve_.element_of(s);
  const BeamCurve::Pair w = curve_.at(e, s, order);
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 2; ++i) {
    const auto& four = spec_.nodes[static_cast<std::size_t>(e + i)];
    const Vec3 centre = NodeStep::at(x, four[0]), tip = NodeStep::at(x, four[1]);
    sum += w(i, 0) * centre + w(i, 1) / spec_.tip * (tip - centre);
  }
  return sum;
}

/// Place near s with a normal through a point.
double SlideOnBeam::follow(const double* x, const Vec3& point, double s) const {
  const double size = curve_.length() / curve_.elements();
  for (int i = 0; i < kSlideSearches; ++i) {
    const Vec3 gap = point - place(x, s, 0), T = place(x, s, 1);
    const double bend = gap.dot(place(x, s, 2)), stretch = T.squaredNorm();
    const double way = T.dot(gap) / std::max(stretch - bend, 0.1 * stretch);
    if (!std::isfinite(way)) return s;
    s = std::clamp(s + std::clamp(way, -size, size), -size, curve_.length() + size);
    if (std::abs(way) < kSlideFound * size) break;
  }
  return s;
}

double SlideOnBeam::nearest(const double* x, const Vec3& point) const {
  constexpr int kParts = 4;
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kParts * curve_.elements(); ++i) {
    const int e = std::min(i / kParts, curve_.elements() - 1);
    const double s = curve_.knot(e) + curve_.length(e) * (i - kParts * e) / kParts;
    const double way = (point - place(x, s, 0)).norm();
    if (way < least) least = way, best = s;
  }
  return std::clamp(follow(x, point, best), 0.0, curve_.length());
}

const SlideOnBeam::Window& SlideOnBeam::window(const double* history) const {
  const History h = read_record<History>(history);
  const double far = 2.0 * std::abs(h.change);
  const int first = std::max(curve_.element_of(h.s - far) - kSlideWindow, 0);
  const int last = std::min(curve_.element_of(h.s + far) + kSlideWindow + 1, curve_.elements());
  if (window_.first == first && window_.last == last) return window_;
  window_ = {.first = first, .last = last, .nodes = {spec_.point}, .blocks = {}};
  for (int i = first; i <= last; ++i)
    for (const int n : spec_.nodes[static_cast<std::size_t>(i)]) window_.nodes.push_back(n);
  std::sort(window_.nodes.begin(), window_.nodes.end());
  for (const int i : window_.nodes)
    for (const int j : window_.nodes) {
      window_.blocks.row.push_back(i);
      window_.blocks.column.push_back(j);
    }
  return window_;
}

const NodeBlocks& SlideOnBeam::blocks(const double* history) const {
  return window(history).blocks;
}

/// Forces of the step, and of an instant those along the beam: rows() has the others.
/// @eq{slide-rows} @eq{slide-along}
ElementReport SlideOnBeam::evaluate(const NodeStep& step, const double* history, double* scratch,
                                    const Mat3&, const ElementSink& sink) const {
  const History h = read_record<History>(history);
  const StepContext& c = step.context;
  if (c.dt == 0.0) {
    add_present_force(step, h.s, sink);
    return {};
  }
  Scratch y = read_record<Scratch>(scratch);
  if (y.fresh != 0.0) begin_search(step, h, y);
  const Local l(spec_, curve_, step, h.s, y.s);
  const int n = l.count, n3 = 3 * n;
  const Local::Weight p_mean = Local::gap(l.mean), p_end = Local::gap(l.end);
  const Vec3 F = l.force(y.lambda), turning = l.turning(y.lambda), S = l.second();
  const Vec3 gap_mean = l.x_alpha * p_mean, gap = l.x_n1 * p_end, T = l.x_alpha * l.slope;
  Local::Weight phi = Local::Weight::Zero(n);
  for (int k = 0; k < 3; ++k) phi += y.lambda[k] * l.d(k);
  const double af = step.alpha_f;
  const bool free = !spec_.position;
  const Along Q = along(step, h.s, y.s, l);

  // Residual of λ and s.
  Eigen::Vector4d R;
  for (int k = 0; k < 3; ++k) R[k] = (l.x_n1 * l.d(k)).dot(gap);
  y.along = F.dot(T) + 0.25 * turning.dot(S);
  R[3] = free ? y.along - Q.value : y.s - position_at(step);

  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 4, 0, 3 * kMostSlideNodes, 4>;
  using Rows = Eigen::Matrix<double, 4, Eigen::Dynamic, 0, 4, 3 * kMostSlideNodes>;
  Columns K_xy(n3, 4);
  Rows K_yx(4, n3);
  Eigen::Matrix4d K_yy = Eigen::Matrix4d::Zero();
  const Vec3 T_end = l.x_n1 * l.end_s, gap_s = -(l.x_alpha * l.mean_s);
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = l.x_alpha * l.d(k), d_n1 = l.x_n1 * l.d(k);
    for (int i = 0; i < n; ++i) {
      K_xy.block<3, 1>(3 * i, k) = p_mean[i] * d + l.d(k)[i] * gap_mean;
      K_yx.block<1, 3>(k, 3 * i) = (p_end[i] * d_n1 + l.d(k)[i] * gap).transpose();
    }
    K_yy(k, k) = proximal(step);
    K_yy(k, 3) = -d_n1.dot(T_end);
    if (free) K_yy(3, k) = d.dot(T) + 0.25 * (l.u * l.d(k)).dot(S);
  }
  for (int i = 0; i < n; ++i) {
    K_xy.block<3, 1>(3 * i, 3) = -l.mean_s[i] * F + phi[i] * gap_s;
    Vec3 by = Vec3::Zero();
    if (free) {
      by = af * l.slope[i] * F + af * phi[i] * T - Q.by_velocity * p_mean[i] * T;
      if (l.exact) by += 0.25 * (phi[i] * S + l.slope[i] * turning);
    }
    K_yx.block<1, 3>(3, 3 * i) = by.transpose();
  }
  K_yy(3, 3) = 1.0;
  if (free) {
    K_yy(3, 3) = F.dot(l.x_alpha * l.slope_s) - Q.by_s;
    if (l.exact) K_yy(3, 3) += 0.25 * turning.dot(l.u * l.slope_s);
  }

  const Eigen::PartialPivLU<Eigen::Matrix4d> lu(K_yy);
  const Eigen::Vector4d z = lu.solve(R);
  const Rows Z = lu.solve(K_yx);
  y.count = n;
  for (int i = 0; i < n; ++i) y.node[i] = l.node[static_cast<std::size_t>(i)];
  for (int k = 0; k < 4; ++k) {
    y.z[k] = z[k];
    for (int i = 0; i < n3; ++i) y.Z[k][i] = Z(k, i);
  }
  write_record(y, scratch);

  // For the ledger, too: rounding of a closed gap over ε is no force.
  const double open = sink.tangent || gap.norm() > kSlideHolds * spec_.tip ? 1.0 : 0.0;
  const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3 * kMostSlideNodes, 1> inner = open * K_xy * z;
  for (int i = 0; i < n; ++i) {
    const Vec3 f = p_mean[i] * F + phi[i] * gap_mean - inner.segment<3>(3 * i);
    double* at = sink.force + 3 * static_cast<std::ptrdiff_t>(l.node[static_cast<std::size_t>(i)]);
    for (int k = 0; k < 3; ++k) at[k] += f[k];
  }
  if (!sink.tangent) return {};
  const Window& w = window(history);
  const auto place = [&](int i) -> std::ptrdiff_t {
    const int node = l.node[static_cast<std::size_t>(i)];
    const auto found = std::lower_bound(w.nodes.begin(), w.nodes.end(), node);
    return found != w.nodes.end() && *found == node ? found - w.nodes.begin() : -1;
  };
  const auto width = static_cast<std::ptrdiff_t>(w.nodes.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const std::ptrdiff_t row = place(i), column = place(j);
      if (row < 0 || column < 0) continue;
      Mat3 K = -K_xy.middleRows<3>(3 * i) * Z.middleCols<3>(3 * j);
      K.diagonal().array() += af * (p_mean[i] * phi[j] + phi[i] * p_mean[j]);
      double* block = sink.tangent + 9 * (row * width + column);
      for (int r = 0; r < 3; ++r)
        for (int q = 0; q < 3; ++q) block[3 * r + q] += K(r, q);
    }
  return {};
}

/// First values of λ and s in a step: the force of the last step, and the place of the predicted
/// point.
void SlideOnBeam::begin_search(const NodeStep& step, const History& h, Scratch& y) const {
  y.fresh = 0.0;
  y.s = spec_.position ? position_at(step)
                       : follow(step.x_n1, NodeStep::at(step.x_n1, spec_.point), h.s);
  const Local l(spec_, curve_, step, h.s, y.s);
  const Eigen::Map<const Vec3> F(h.force);
  for (int k = 0; k < 3; ++k) y.lambda[k] = F.dot(l.x_n * l.d(k));
}

double SlideOnBeam::position(const double* history) { return read_record<History>(history).s; }

double SlideOnBeam::position_at(const NodeStep& step) const {
  return (*spec_.position)(step.context.t_n1());
}

/// ε: a small part of the flexibility that a multiplier meets at least.
double SlideOnBeam::proximal(const NodeStep& step) const {
  const double dt = step.context.dt, part = step.alpha_f < 1.0 ? kSlideProximal : kSlideProximalEnd;
  return part / (spec_.element_stiffness + 4.0 * spec_.node_mass / (dt * dt));
}

/// Q over the step: at ρ∞ = 1 that of the mean position and of the mean speed Δs/Δt.
SlideOnBeam::Along SlideOnBeam::along(const NodeStep& step, double s_n, double s,
                                      const Local& l) const {
  Along Q;
  if (spec_.position) return Q;
  const StepContext& c = step.context;
  const double af = step.alpha_f;
  Q.value = -spec_.stiffness * ((1.0 - af) * s_n + af * s - spec_.free_position);
  Q.by_s = -af * spec_.stiffness;
  if (spec_.force) Q.value += c.load_factor * (*spec_.force)(c.t_alpha());
  if (spec_.damping == 0.0) return Q;
  if (l.exact) {
    Q.value -= spec_.damping * (s - s_n) / c.dt;
    Q.by_s -= spec_.damping / c.dt;
    return Q;
  }
  const Local::Weight p = Local::gap(l.mean);
  Vec3 v = Vec3::Zero();
  for (int i = 0; i < l.count; ++i)
    v += p[i] * step.velocity_alpha(l.node[static_cast<std::size_t>(i)]);
  const Vec3 T = l.x_alpha * l.slope;
  Q.value -= spec_.damping * T.dot(v) / T.squaredNorm();
  Q.by_velocity = -spec_.damping * af * step.rate / T.squaredNorm();
  return Q;
}

double SlideOnBeam::advance(const double* du, const Mat3&, double* scratch) const {
  Scratch y = read_record<Scratch>(scratch);
  const int n = static_cast<int>(y.count);
  double change[4];
  for (int k = 0; k < 4; ++k) {
    change[k] = -y.z[k];
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c)
        change[k] -= y.Z[k][3 * i + c] * du[3 * static_cast<std::ptrdiff_t>(y.node[i]) + c];
  }
  for (int k = 0; k < 3; ++k) y.lambda[k] += change[k];
  const double size = curve_.length() / curve_.elements();
  y.s = std::clamp(y.s + change[3], -size, curve_.length() + size);
  write_record(y, scratch);
  return std::abs(change[3]);
}

void SlideOnBeam::commit(const NodeStep& step, double* history, const double* scratch) const {
  History h = read_record<History>(history);
  const Scratch y = read_record<Scratch>(scratch);
  if (step.context.dt == 0.0 || y.fresh != 0.0) return;
  const Local l(spec_, curve_, step, h.s, y.s);
  set(h.force, l.force(y.lambda));
  h.change = y.s - h.s;
  h.s = y.s;
  write_record(h, history);
}

Work SlideOnBeam::work(const NodeStep& step, const double* history, const double* scratch) const {
  const History h = read_record<History>(history);
  const auto energy = [&](double s) {
    return 0.5 * spec_.stiffness * std::pow(s - spec_.free_position, 2);
  };
  if (step.context.dt == 0.0 || !scratch) return {.stored = energy(h.s)};
  const Scratch y = read_record<Scratch>(scratch);
  const double change = y.s - h.s;
  Work work{.stored = energy(y.s)};
  const Local l(spec_, curve_, step, h.s, y.s);
  if (spec_.position) {
    work.put_in = l.along(y.lambda) * change + energy(y.s) - energy(h.s);
    return work;
  }
  if (spec_.force)
    work.put_in = step.context.load_factor * (*spec_.force)(step.context.t_alpha()) * change;
  if (spec_.damping > 0.0) work.dissipated = spec_.damping * change * change / step.context.dt;
  return work;
}

void SlideOnBeam::get_unknowns(const double* scratch, double* unknowns) const {
  const Scratch y = read_record<Scratch>(scratch);
  std::copy(y.lambda, y.lambda + 3, unknowns);
  unknowns[3] = y.s;
}

void SlideOnBeam::set_unknowns(const double* unknowns, double* scratch) const {
  Scratch y = read_record<Scratch>(scratch);
  std::copy(unknowns, unknowns + 3, y.lambda);
  y.s = unknowns[3];
  write_record(y, scratch);
}

double SlideOnBeam::difference(const double* history, const double* other) const {
  return std::abs(read_record<History>(history).s - read_record<History>(other).s);
}

std::string SlideOnBeam::refusal(const double* scratch) const {
  const double s = read_record<Scratch>(scratch).s, beyond = kSlideBeyond * curve_.length();
  if (s >= -beyond && s <= curve_.length() + beyond) return {};
  return format(
      "slide_on_beam '{}': the point leaves beam '{}' at its {}; make the beam longer, hold the "
      "body with a spring, or end the run before",
      spec_.name, spec_.beam, s < 0.0 ? "start" : "end");
}

}  // namespace polhode
