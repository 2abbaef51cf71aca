// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/follower_loads.hpp>
#include <polhode/statics/modal_matrices.hpp>
#include <polhode/statics/modes.hpp>
#include <polhode/statics/turning_model.hpp>
#include <polhode/statics/undamped_modes.hpp>
#include <polhode/stepping/plain_motions.hpp>

namespace polhode {

namespace {

/// Asymmetry of a stiffness, as a part of its entries, up to which it counts as symmetric.
constexpr double kSymmetricPencil = 1e-7;
constexpr double kResidual = 1e-6;  ///< Residual above which a mode is reported as inaccurate.
/// Growth or decay rate, as a part of |λ|, below which it is rounding.
constexpr double kSteady = 1e-9;
/// Relative change of a model by a rotation above which it is not steady.
constexpr double kTurned = 1e-6;

double hermitian(const ModalMatrices& m, const CVec& x) {
  const Vec re = x.real(), im = x.imag();
  return re.dot(m.mass_times(re)) + im.dot(m.mass_times(im));
}

/// Residual of a mode by one inverse iteration after factor_quadratic(σ): φ − (K + σC + σ²M)⁻¹ [(σ
/// − λ) C + (σ² − λ²) M] φ, in the metric of M, constraints included. The state of an integral
/// follows from its row, λ C μ = G φ.
double residual_of(ModalMatrices& m, double sigma, const Mode& mode, double smallest) {
  const Complex lambda = mode.eigenvalue;
  const Vec zero = Vec::Zero(m.n()), &re = mode.shape;
  const Vec& im = mode.shape_imag.size() == 0 ? zero : mode.shape_imag;
  const Complex c = sigma - lambda, d = sigma * sigma - lambda * lambda;
  const Complex e = lambda != Complex(0.0) ? -c / lambda : Complex(0.0);
  const Vec C_re = m.damping_times(re), C_im = m.damping_times(im);
  const Vec M_re = m.mass_times(re), M_im = m.mass_times(im);
  const Vec G_re = m.integral_rows(re), G_im = m.integral_rows(im);
  Vec f_re(m.unknowns()), f_im(m.unknowns());
  f_re << c.real() * C_re - c.imag() * C_im + d.real() * M_re - d.imag() * M_im,
      e.real() * G_re - e.imag() * G_im;
  f_im << c.real() * C_im + c.imag() * C_re + d.real() * M_im + d.imag() * M_re,
      e.real() * G_im + e.imag() * G_re;
  const Vec left = re - m.inverse(f_re).head(m.n()), right = im - m.inverse(f_im).head(m.n());
  const double size = std::sqrt(left.dot(m.mass_times(left)) + right.dot(m.mass_times(right)));
  const double square = std::norm(lambda);
  return size * (square + sigma * sigma) / std::max(square, smallest);
}

/// Kind of motion of an eigenvalue.
ModeKind kind_of(Complex lambda) {
  const double size = std::abs(lambda);
  if (size == 0.0) return ModeKind::free;
  if (lambda.imag() > 0.0)
    return lambda.real() > 1e-7 * size ? ModeKind::flutter : ModeKind::oscillation;
  return lambda.real() > 0.0 ? ModeKind::divergence : ModeKind::overdamped;
}

/// Stores a shape, normalised, with the phase for which its largest component is real.
void put_shape(const ModalMatrices& m, CVec x, Mode& mode) {
  Eigen::Index top = 0;
  x.cwiseAbs().maxCoeff(&top);
  if (std::abs(x[top]) > 0.0) x *= std::conj(x[top]) / std::abs(x[top]);
  const double square = hermitian(m, x);
  if (square > 0.0) x /= std::sqrt(square);
  mode.shape = x.real();
  const bool real =
      x.imag().lpNorm<Eigen::Infinity>() <= kSteady * x.real().lpNorm<Eigen::Infinity>();
  if (!real) mode.shape_imag = x.imag();
}

Mode make_mode(const ModalMatrices& m, Complex lambda, const CVec& x) {
  Mode mode;
  const double size = std::abs(lambda);
  if (std::abs(lambda.real()) <= kSteady * size) lambda.real(0.0);
  mode.eigenvalue = lambda;
  mode.kind = kind_of(lambda);
  mode.rigid = mode.kind == ModeKind::free;
  mode.frequency = size / (2.0 * std::numbers::pi);
  mode.damping = size > 0.0 && lambda.real() != 0.0 ? -lambda.real() / size : 0.0;
  mode.omega_squared = mode.kind == ModeKind::divergence ? -size * size : size * size;
  put_shape(m, x, mode);
  return mode;
}

/// Modes of the symmetric problem: λ² is real.
std::vector<Mode> symmetric_modes(ModalMatrices& m, const ModeOptions& options,
                                  ModesReport& report) {
  const UndampedModes found = undamped_modes(m, options.count);
  report.freedoms = found.freedoms;
  report.shift = found.shift;
  report.below_shift = found.below_shift;
  report.complete = found.complete;
  report.counted = found.counted;
  if (!found.warning.empty()) report.warnings.push_back(found.warning);
  std::vector<Mode> modes;
  for (std::size_t i = 0; i < found.omega_squared.size(); ++i) {
    const double square = found.free[i] ? 0.0 : found.omega_squared[i];
    const double root = std::sqrt(std::abs(square));
    const Complex lambda = square >= 0.0 ? Complex(0.0, root) : Complex(root, 0.0);
    modes.push_back(make_mode(m, lambda, found.shapes[i].cast<Complex>()));
    modes.back().omega_squared = square;
  }
  return modes;
}

/// Modes of the quadratic problem. Of an undamped pair of a growing and a decaying motion the
/// growing one is returned.
std::vector<Mode> quadratic_modes(ModalMatrices& m, const ModeOptions& options,
                                  ModesReport& report) {
  constexpr int kSpare = 4;
  std::vector<EigenPair> pairs = damped_modes(m, options.count + kSpare, report.freedoms);
  std::vector<Mode> modes;
  for (const EigenPair& pair : pairs) {
    Mode mode = make_mode(m, pair.lambda, pair.shape);
    if (!m.damped() && mode.kind == ModeKind::overdamped) continue;
    modes.push_back(std::move(mode));
  }
  std::stable_sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) {
    return a.omega_squared < b.omega_squared;  // negative of divergence
  });
  return modes;
}

/// Sorts modes: up to `count` that are not overdamped, by |λ|, then at most as many overdamped ones
/// below the last of them. Viscous materials have an overdamped mode for each motion that they
/// overdamp, all near -1/τ.
void put_overdamped_last(std::vector<Mode>& modes, int count) {
  const auto decays = [](const Mode& mode) { return mode.kind == ModeKind::overdamped; };
  const auto most = static_cast<std::ptrdiff_t>(count);
  const auto behind = std::stable_partition(modes.begin(), modes.end(), std::not_fn(decays));
  const std::ptrdiff_t others = behind - modes.begin(), kept = std::min(others, most);
  if (kept == most)
    modes.erase(
        std::remove_if(behind, modes.end(),
                       [size = std::abs(modes[static_cast<std::size_t>(kept - 1)].eigenvalue)](
                           const Mode& mode) { return std::abs(mode.eigenvalue) > size; }),
        modes.end());
  modes.erase(modes.begin() + kept, modes.begin() + others);
  if (static_cast<std::ptrdiff_t>(modes.size()) > kept + most)
    modes.resize(static_cast<std::size_t>(kept + most));
}

/// Replaces the computed free motions by translations and rotations that span the same space.
void name_free(const System& system, const State& state, ModalMatrices& m,
               std::vector<Mode>& modes) {
  std::vector<Vec> motions;
  for (const Mode& mode : modes)
    if (mode.rigid && mode.shape_imag.size() == 0) motions.push_back(mode.shape);
  // For a double eigenvalue the same motion may have been found twice.
  std::vector<Vec> apart;
  for (Vec x : motions) {
    const Vec before = x;
    for (const Vec& other : apart) x -= m.mass_times(other).dot(x) * other;
    const double square = x.dot(m.mass_times(x));
    if (square > 1e-12 * before.dot(m.mass_times(before))) apart.push_back(x / std::sqrt(square));
  }
  std::vector<PlainMotion> plain = plain_motions(system, state, m.K(), apart);
  std::vector<Vec> found;
  std::size_t next = 0;
  std::vector<Mode> kept;
  for (Mode& mode : modes) {
    if (!mode.rigid) {
      kept.push_back(std::move(mode));
      continue;
    }
    if (next == plain.size()) continue;
    Vec x = plain[next].x;
    for (const Vec& other : found) x -= m.mass_times(other).dot(x) * other;
    put_shape(m, x.cast<Complex>(), mode);
    mode.motion = plain[next++].text;
    found.push_back(mode.shape);
    kept.push_back(std::move(mode));
  }
  modes = std::move(kept);
}

/// Loads that change with a free motion: "; force 'main' turns with it".
std::string loads_that_turn(const System& system, const std::vector<FollowerLoad>& loads,
                            const Vec& motion) {
  std::vector<std::string> names;
  for (const FollowerLoad& load : loads) {
    if (load.interaction < 0) continue;
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(load.interaction)];
    Eigen::Matrix<double, 12, 1> x = Eigen::Matrix<double, 12, 1>::Zero();
    if (ref.a != kGround) x.head<6>() = motion.segment<6>(6 * ref.a);
    if (ref.b != kGround) x.tail<6>() = motion.segment<6>(6 * ref.b);
    const double terms = (load.change.cwiseAbs() * x.cwiseAbs()).maxCoeff();
    if ((load.change * x).cwiseAbs().maxCoeff() > kTurned * terms) names.push_back(load.name);
  }
  if (names.empty()) return {};
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "; " : ", ") + name;
  return text + (names.size() == 1 ? " turns with it" : " turn with it");
}

/// Checks that a model about a rotating body is steady: after a small rotation stiffness and mass
/// must be unchanged. @eq{modes-gyroscopic}
void check_steady(const System& system, const State& state, const ModeOptions& options,
                  ModalMatrices& m, ModesReport& report) {
  double fastest = 0.0;
  for (const Vec3& W : options.spin) fastest = std::max(fastest, W.norm());
  if (!(fastest > 0.0)) return;
  State turned = state;
  for (int b = 0; b < system.body_count(); ++b) {
    BodyMotion motion = system.motion(state, b);
    const Vec3& W = options.spin[static_cast<std::size_t>(b)];
    const Vec3 moment = W.cross(system.bodies()[b].inertia * W);
    if (moment.norm() > kTurned * system.bodies()[b].inertia.norm() * W.squaredNorm())
      report.warnings.push_back(format(
          "body '{}' does not rotate about a principal axis: modes hold for this instant only",
          system.bodies()[b].name));
    motion.q = (motion.q *
                Quat(Eigen::AngleAxisd(W.norm() / fastest,
                                       W.isZero(0.0) ? Vec3(Vec3::UnitX()) : Vec3(W.normalized()))))
                   .normalized();
    turned.set_motion(system.slot(b), motion);
  }
  for (const InteractionRef& ref : system.interactions()) {
    Vec x = Vec::Zero(m.K().size()), rates;
    for (const int body : {ref.a, ref.b})
      if (body != kGround)
        x.segment<3>(6 * body + 3) =
            system.motion(state, body).q * options.spin[static_cast<std::size_t>(body)];
    if (ref.rows == 0 || x.isZero(0.0)) continue;
    m.K().times(x, rates);
    if (rates.segment(m.n() + ref.first_row, ref.rows).norm() > kTurned * x.norm())
      report.warnings.push_back(
          format("{} '{}' does not allow the given angular velocities. Give its bodies angular "
                 "velocities that differ only about its free axes",
                 system.group(ref.group).kind(), system.name(ref)));
  }
  ModalMatrices later(system, turned, options);
  // Each stiffness has a scale of its own, the inverse of its largest entry, which rounding
  // changes.
  const auto apart = [&](const SaddleMatrix& A, double s_A, const SaddleMatrix& B, double s_B) {
    double most = 0.0, size = 0.0;
    for (std::size_t e = 0; e < A.values().size(); ++e) {
      if (A.row()[e] >= m.n() || A.column()[e] >= m.n()) continue;
      most = std::max(most, std::abs(A.values()[e] / s_A - B.values()[e] / s_B));
      size = std::max(size, std::abs(A.values()[e] / s_A));
    }
    return size > 0.0 ? most / size : 0.0;
  };
  if (apart(later.M(), 1.0, m.M(), 1.0) > kTurned ||
      apart(later.K(), later.s(), m.K(), m.s()) > kTurned)
    report.warnings.push_back(
        "the model changes as its bodies rotate, so modes hold for this instant only. Mass and "
        "constraints of a rotating body must be symmetric about its axis");
}

/// Computes participation factors along x, y, z, and the moving mass.
void put_participation(const System& system, ModalMatrices& m, ModesReport& report) {
  const int n = m.n();
  Mat e = Mat::Zero(n, 3);
  for (int b = 0; b < system.body_count(); ++b) e.block<3, 3>(6 * b, 0).setIdentity();
  for (int i = 0; i < system.nodes().count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (const int u = m.K().unknown(i, c); u >= 0) e(u, c) = 1.0;
  Mat M_e(n, 3);
  for (int c = 0; c < 3; ++c) M_e.col(c) = m.mass_times(e.col(c));
  report.total_mass = e.col(0).dot(M_e.col(0));
  for (Mode& mode : report.modes) {
    mode.participation = M_e.transpose() * mode.shape;
    if (mode.shape_imag.size() > 0) {
      const Vec3 other = M_e.transpose() * mode.shape_imag;
      for (int c = 0; c < 3; ++c)
        mode.participation[c] = std::hypot(mode.participation[c], other[c]);
    }
    for (int c = 0; c < 3; ++c) {
      const double all = e.col(c).dot(M_e.col(c));
      if (all > 0.0) mode.effective_mass[c] = mode.participation[c] * mode.participation[c] / all;
    }
  }
}

}  // namespace

const char* kind_name(ModeKind kind) {
  switch (kind) {
    case ModeKind::oscillation:
      return "oscillation";
    case ModeKind::flutter:
      return "flutter";
    case ModeKind::divergence:
      return "divergence";
    case ModeKind::overdamped:
      return "overdamped";
    case ModeKind::free:
      return "free";
  }
  return "";
}

/// @eq{modes-saddle} @eq{modes-damped}
ModesReport find_modes(const System& system, const State& equilibrium, const ModeOptions& options) {
  ModesReport report;
  for (int g = 0; g < system.nodes().group_count(); ++g)
    if (const solids::SolidElements* solid = solids::as_solid(system.nodes().group(g));
        solid && !solid->material().relaxation().empty())
      throw InputError(solid->name(),
                       "the stress of its material relaxes, so that its stiffness depends on the "
                       "frequency, which modes have not",
                       "Leave 'relaxation' out for the modes of the long-term stiffness, or "
                       "multiply its moduli by 1 and the modulus ratios for those of fast motions");
  if (6 * system.body_count() + system.nodes().unknowns() == 0) {
    report.freedoms = 0;
    report.warnings.push_back("every degree of freedom is constrained: there are no modes");
    return report;
  }
  ModalMatrices m(system, equilibrium, options);
  StaticStep balance_of_forces;
  m.statics().measure(balance_of_forces);
  report.unbalanced =
      balance_of_forces.force > 0.0 ? balance_of_forces.residual / balance_of_forces.force : 0.0;
  if (const StaticRows* rows = m.statics().rows()) report.held = rows->held();
  report.asymmetry = m.asymmetry();
  report.symmetric = !m.damped() && report.asymmetry <= kSymmetricPencil;
  std::vector<FollowerLoad> followers;
  if (report.asymmetry > kSymmetricPencil)
    followers = follower_loads(system, equilibrium, options.load_factor);
  // In a turning frame Coriolis forces couple rigid motions with others.
  if (!options.frame) m.let_turn(equilibrium, followers, options.load_factor);
  for (const FollowerLoad& load : followers)
    report.warnings.push_back(
        format("{} acts here with {:.4g} N and has no potential, as it follows its body or is a "
               "moment: vibrations may flutter for this reason alone. Switch it off for the modes "
               "without it",
               load.name, load.force));
  if (!options.spin.empty()) check_steady(system, equilibrium, options, m, report);
  std::vector<Mode> modes =
      report.symmetric ? symmetric_modes(m, options, report) : quadratic_modes(m, options, report);
  for (const Mode& mode : modes)
    if (!std::isfinite(std::abs(mode.eigenvalue)))
      throw SolveError("modes: a frequency is not a finite number",
                       "Look for a mass, inertia or stiffness that is far too small or too large");
  if (options.frame) find_whirl(system, equilibrium, *options.frame, m, modes);
  name_free(system, equilibrium, m, modes);
  for (Mode& mode : modes)
    if (mode.rigid) mode.motion += loads_that_turn(system, followers, mode.shape);
  const bool asked = options.count != ModeOptions{}.count;  // otherwise the default count
  if (modes.empty() || (asked && static_cast<int>(modes.size()) < options.count))
    report.warnings.push_back(
        report.freedoms == 0
            ? std::string("every degree of freedom is constrained: there are no modes")
            : format("{} modes were requested, but the model has {} only", options.count,
                     modes.size()));
  put_overdamped_last(modes, options.count);
  report.modes = std::move(modes);
  put_participation(system, m, report);
  if (report.modes.empty()) return report;

  double highest = 0.0;
  for (const Mode& mode : report.modes) highest = std::max(highest, std::abs(mode.eigenvalue));
  const double sigma = highest > 0.0 ? 0.1 * highest : 1.0;
  if (m.factor_quadratic(sigma))
    for (Mode& mode : report.modes) {
      mode.residual = residual_of(m, sigma, mode, (mode.rigid ? 1.0 : 1e-4) * sigma * sigma);
      if (mode.residual > kResidual)
        report.warnings.push_back(format(
            "the mode of {:.6g} Hz is accurate to {:.1g} only. Look for bodies with almost no "
            "mass or inertia",
            mode.frequency, mode.residual));
    }
  return report;
}

std::vector<double> node_shape(const System& system, const State& equilibrium, const Vec& shape) {
  const Nodes& nodes = system.nodes();
  std::vector<double> d(3 * static_cast<std::size_t>(nodes.count()), 0.0);
  const int first = 6 * system.body_count();
  for (int i = 0; i < nodes.count(); ++i) {
    Eigen::Map<Vec3> at(d.data() + 3 * i);
    if (nodes[i].body >= 0) {
      const Vec6 x = shape.segment<6>(6 * nodes[i].body);
      const Vec3 z = system.motion(equilibrium, nodes[i].body).q * nodes[i].Z;
      at = x.head<3>() + x.tail<3>().cross(z);
    }
    for (int c = 0; c < 3; ++c)
      if (nodes.unknown(i, c) >= 0) at[c] = shape[first + nodes.unknown(i, c)];
  }
  return d;
}

}  // namespace polhode
