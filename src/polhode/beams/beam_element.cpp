// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <polhode/beams/beam_element.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/dense.hpp>
#include <polhode/system/mass_coupling.hpp>

namespace polhode {

namespace {

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;
using Mat15x9 = Eigen::Matrix<double, 15, 9>;
using HistoryVec = Eigen::Map<const Vec6>;

/// Σ w Δι² below which Δe would be lost in round-off. The gradient is then averaged along Δι by
/// Gauss's rule, whose error, of the fifth order in Δι, is smaller.
constexpr double kLittleChange = 1e-8;
constexpr std::array<double, 2> kGaussPoints{0.21132486540518711775, 0.78867513459481288225};
constexpr std::array<double, 2> kMiddle{0.5, 0.5};

Mat3 averaged(double alpha, const Mat3& n, const Mat3& n1) {
  return (1.0 - alpha) * n + alpha * n1;
}
Vec3 averaged(double alpha, const Vec3& n, const Vec3& n1) {
  return (1.0 - alpha) * n + alpha * n1;
}

/// Ends of the element over the step.
struct Ends {
  Carried z_1, z_2;  ///< Lever arms of the end points.
  BeamFrames n, alpha, n1;

  Ends(const BeamEnd& end_1, const BeamEnd& end_2, const PairStep& step) {
    const BodyStep &a = step.a, &b = step.b;
    z_1 = a.vector(end_1.Z);
    z_2 = b.vector(end_2.Z);
    n = {(b.r_n - a.r_n) + (z_2.at_n - z_1.at_n), a.Lambda_n * end_1.Q, b.Lambda_n * end_2.Q};
    n1 = {(b.r_n1 - a.r_n1) + (z_2.at_n1 - z_1.at_n1), a.Lambda_n1 * end_1.Q,
          b.Lambda_n1 * end_2.Q};
    const double af = step.context.ga.alpha_f;
    alpha = {averaged(af, n.offset, n1.offset), averaged(af, n.D_1, n1.D_1),
             averaged(af, n.D_2, n1.D_2)};
  }
};

/// ∂ι by (δΔp, δθ_1, δθ_2): products of the frames `at` with the variation of frames `of`.
Mat15x9 invariants_by_motion(const BeamFrames& at, const BeamFrames& of) {
  Mat15x9 D;
  D.setZero();
  D.block<3, 3>(0, 0) = at.D_1.transpose();
  D.block<3, 3>(3, 0) = at.D_2.transpose();
  for (int i = 0; i < 3; ++i) {
    D.block<1, 3>(i, 3) = of.D_1.col(i).cross(at.offset).transpose();
    D.block<1, 3>(3 + i, 6) = of.D_2.col(i).cross(at.offset).transpose();
    for (int j = 0; j < 3; ++j) {
      D.block<1, 3>(6 + 3 * j + i, 3) = of.D_1.col(i).cross(at.D_2.col(j)).transpose();
      D.block<1, 3>(6 + 3 * j + i, 6) = of.D_2.col(j).cross(at.D_1.col(i)).transpose();
    }
  }
  return D;
}

/// Derivative of invariants_by_motion(alpha, alpha)ᵀ p by the motion at constant p: geometric
/// stiffness.
Mat9 frames_turned(const BeamFrames& alpha, const BeamFrames& n1, const Vec15& p) {
  const Vec3 p_a = p.segment<3>(0), p_b = p.segment<3>(3);
  const Eigen::Map<const Mat3> P(p.data() + 6);
  const Mat3 f_1 = hat(n1.D_1 * p_a), f_2 = hat(n1.D_2 * p_b);
  Mat9 K = Mat9::Zero();
  K.block<3, 3>(0, 3) = -f_1;
  K.block<3, 3>(0, 6) = -f_2;
  // u × y with u = D_1 p_a, y = Δp
  K.block<3, 3>(3, 0) = hat(alpha.D_1 * p_a);
  K.block<3, 3>(3, 3) = hat_hat(alpha.offset, n1.D_1 * p_a);
  K.block<3, 3>(6, 0) = hat(alpha.D_2 * p_b);
  K.block<3, 3>(6, 6) = hat_hat(alpha.offset, n1.D_2 * p_b);
  // τ = Σ P_ij d_1i × d_2j on end 1, −τ on end 2
  Mat3 by_1 = n1.D_1 * P * alpha.D_2.transpose();
  by_1.diagonal().array() -= by_1.trace();
  Mat3 by_2 = n1.D_2 * P.transpose() * alpha.D_1.transpose();
  by_2.diagonal().array() -= by_2.trace();
  K.block<3, 3>(3, 3) += by_1;
  K.block<3, 3>(3, 6) -= by_2;
  K.block<3, 3>(6, 3) -= by_1;
  K.block<3, 3>(6, 6) += by_2;
  return K;
}

/// Weights that turn all invariants into lengths over L.
Vec15 metric(double L) {
  Vec15 w = Vec15::Ones();
  w.head<6>().setConstant(1.0 / (L * L));
  return w;
}

/// Tangents of the wrenches from those of (f_2, m_1, m_2) by (Δp, θ_1, θ_2).
void put_tangents(const Mat9& K, const Ends& ends, double alpha_f, const Vec3& f_2, PairTerms& t) {
  using Mat9x6 = Eigen::Matrix<double, 9, 6>;
  const auto by_offset = K.leftCols<3>();
  Mat9x6 by_1, by_2;
  by_1 << -by_offset, by_offset * hat(ends.z_1.at_n1) + K.middleCols<3>(3);
  by_2 << by_offset, K.rightCols<3>() - by_offset * hat(ends.z_2.at_n1);
  const Mat3 z_1 = hat(ends.z_1.at_alpha), z_2 = hat(ends.z_2.at_alpha);
  const auto on_1 = [&](const Mat9x6& by, Mat6& D) {
    D << by.topRows<3>(), z_1 * by.topRows<3>() - by.middleRows<3>(3);
  };
  const auto on_2 = [&](const Mat9x6& by, Mat6& D) {
    D << -by.topRows<3>(), -z_2 * by.topRows<3>() - by.bottomRows<3>();
  };
  on_1(by_1, t.D_aa);
  on_1(by_2, t.D_ab);
  on_2(by_1, t.D_ba);
  on_2(by_2, t.D_bb);
  // The lever arms rotate: @eq{ga-moment-tangent}
  t.D_aa.bottomRightCorner<3, 3>() += alpha_f * hat_hat(f_2, ends.z_1.at_n1);
  t.D_bb.bottomRightCorner<3, 3>() -= alpha_f * hat_hat(f_2, ends.z_2.at_n1);
}

/// δ(Δp, θ_1, θ_2) for increments (Δr, Δθ) of both bodies.
Vec9 relative_motion(const Vec6& of_1, const Vec6& of_2, const Vec3& z_1, const Vec3& z_2) {
  Vec9 y;
  y << of_2.head<3>() + of_2.tail<3>().cross(z_2) - of_1.head<3>() - of_1.tail<3>().cross(z_1),
      of_1.tail<3>(), of_2.tail<3>();
  return y;
}

}  // namespace

/// @eq{beam-residual-flexibility}
Mat6 with_residual_flexibility(const Mat6& C, double L) {
  Mat6 S = inverse(C);
  const Eigen::Matrix2d bending = S.bottomRightCorner<2, 2>() * (L * L / 12.0);
  S(1, 1) += bending(1, 1);  // M_z varies with V_y, M_y with −V_z
  S(2, 2) += bending(0, 0);
  S(1, 2) -= bending(0, 1);
  S(2, 1) -= bending(1, 0);
  const Mat6 stiffened = inverse(S);
  return 0.5 * (stiffened + stiffened.transpose());
}

void set_reference(BeamElementSpec& spec, const BodyStep& body_1, const BodyStep& body_2) {
  const std::string where = format("beam '{}'", spec.name);
  StepContext context;
  const Ends ends(spec.end_1, spec.end_2, {body_1, body_2, context, nullptr, nullptr});
  const Vec15 iota = beam_invariants(ends.n1);
  if (!(ends.n1.offset.norm() > 0.0))
    throw InputError(where, "has an element of zero length", "Give it distinct points");
  if (const double angle = beam_angle(iota); angle > kLargestBeamAngle)
    throw InputError(
        where,
        format("turns by {:.3g} rad within one element, more than {:g}", angle, kLargestBeamAngle),
        "Use more elements");
  const Vec6 e = beam_strain_values(iota, 1.0);
  spec.length = e.head<3>().norm();
  spec.reference_strain = e / spec.length;
}

BeamElement::BeamElement(const BeamElementSpec& spec)
    : end_1_(spec.end_1),
      end_2_(spec.end_2),
      C_(spec.residual_bending_flexibility ? with_residual_flexibility(spec.stiffness, spec.length)
                                           : spec.stiffness),
      L_(spec.length),
      e_ref_(spec.reference_strain),
      coupled_mass_(spec.coupled_mass),
      tau_(spec.relaxation_time) {
  name = spec.name;
  bodies = spec.bodies;
  const std::string where = format("beam '{}'", name);
  if (!(L_ > 0.0)) throw InputError(where, "has no length", "Give it two distinct points");
  if (!is_positive_definite(spec.stiffness))
    throw InputError(where, "has a section stiffness that is not positive definite",
                     "Give it positive stiffnesses, and couplings that are not too large");
  if (coupled_mass_ != 0.0 && (!end_1_.Z.isZero(0.0) || !end_2_.Z.isZero(0.0)))
    throw InputError(where, "has a consistent mass, but its ends are not at the centres of mass",
                     "Put its ends at the centres of mass, or lump its mass");
}

Vec15 BeamElement::invariants_n(const PairStep& step) const {
  return beam_invariants(Ends(end_1_, end_2_, step).n);
}
Vec15 BeamElement::invariants_n1(const PairStep& step) const {
  return beam_invariants(Ends(end_1_, end_2_, step).n1);
}

bool BeamElement::acceptable(const PairStep& step) const {
  return beam_angle(invariants_n1(step)) <= kLargestBeamAngle;
}

Vec6 BeamElement::section_forces(const PairStep& step) const { return C_ * strains(step); }
Vec6 BeamElement::strains(const PairStep& step) const {
  return beam_strain_values(invariants_n1(step), L_) - e_ref_;
}

/// ė at t_{n+1} from the bodies' velocities.
Vec6 BeamElement::strain_rate_now(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  const Ends ends(end_1_, end_2_, step);
  Vec6 of_1, of_2;
  of_1 << a.v_n1, a.Lambda_n1 * a.W_n1;
  of_2 << b.v_n1, b.Lambda_n1 * b.W_n1;
  return beam_strains(beam_invariants(ends.n1), L_).by_iota *
         (invariants_by_motion(ends.n1, ends.n1) *
          relative_motion(of_1, of_2, ends.z_1.at_n1, ends.z_2.at_n1));
}

/// Strain rate by Newmark's formulas: second order for every ρ∞, and Δe/Δt at ρ∞ = 1.
/// @eq{beam-strain-rate}
Vec6 BeamElement::strain_rate(const PairStep& step, const Vec6& De) const {
  const StepContext& c = step.context;
  if (c.dt == 0.0) return strain_rate_now(step);
  const HistoryVec rate_n(step.history + 6), rate_of_rate_n(step.history + 12);
  const Vec6 rate_n1 =
      c.ga.c / c.dt * De + (1.0 - c.ga.c) * rate_n + c.dt * c.ga.c_A * rate_of_rate_n;
  return (1.0 - c.ga.alpha_f) * rate_n + c.ga.alpha_f * rate_n1;
}

/// Force of an element conjugate to its invariants, and the data of its tangent.
struct BeamElement::Forces {
  Vec15 p;  ///< Work-conjugate to Δι [N or N m].
  /// Part on which the rotation of the frames acts: p, except in mixed-point iterations.
  Vec15 p_geo;
  Mat15 by_alpha, by_n1;  ///< ∂p by ι_{n+αf} and by ι_{n+1}; by_alpha only if not conserving.
  bool has_n1 = false;
};

/// Discrete gradient: that at the averaged invariants, corrected along Δι so that p·Δι = σ·Δe.
/// @eq{beam-gradient}
void BeamElement::conserving_forces(const PairStep& step, const Vec15& iota_n, const Vec15& iota_n1,
                                    Forces& f) const {
  const StepContext& c = step.context;
  const double af = c.ga.alpha_f;
  const BeamStrains e_n1 = beam_strains(iota_n1, L_);
  const Vec6 e_n = beam_strain_values(iota_n, L_), De = e_n1.e - e_n;
  Vec6 e_alpha = e_n + af * De - e_ref_;
  if (viscous()) e_alpha += tau_ * strain_rate(step, De);
  const Vec6 sigma = L_ * (C_ * e_alpha);

  const Vec15 D_iota = iota_n1 - iota_n, w = metric(L_), w_D = w.cwiseProduct(D_iota);
  const double change = w_D.dot(D_iota);
  const bool little = change < kLittleChange;
  Mat6x15 D = Mat6x15::Zero();
  f.by_n1.setZero();
  for (const double at : little ? kGaussPoints : kMiddle) {
    const double part = little ? 0.5 : 1.0;
    const Vec15 iota = iota_n + at * D_iota;
    D += part * beam_strains(iota, L_).by_iota;
    if (c.tangents) f.by_n1 += part * at * beam_strain_hessian(iota, L_, sigma);
    if (!little) break;
  }
  const Vec15 gradient = D.transpose() * sigma;
  const Vec6 left = De - D * D_iota;
  const double part = little ? 0.0 : 1.0 / change, s = part * sigma.dot(left);
  f.p = f.p_geo = gradient + s * w_D;
  if (!c.tangents) return;
  const Mat6x15 D_sigma = (stiffening(c) * L_) * (C_ * e_n1.by_iota);
  const Vec15 D_s = part * (D_sigma.transpose() * left + e_n1.by_iota.transpose() * sigma -
                            f.by_n1 * D_iota - gradient - 2.0 * s * w_D);
  f.by_n1.noalias() += D.transpose() * D_sigma;
  f.by_n1.diagonal() += s * w;
  f.by_n1.noalias() += w_D * D_s.transpose();
  f.has_n1 = true;
}

void BeamElement::plain_forces(const PairStep& step, const Vec15& iota_n, const Vec15& iota_n1,
                               const Vec15& iota, Forces& f) const {
  const StepContext& c = step.context;
  const BeamStrains e = beam_strains(iota, L_);
  Vec6 e_alpha = e.e - e_ref_;
  if (viscous())
    e_alpha +=
        tau_ * strain_rate(step, beam_strain_values(iota_n1, L_) - beam_strain_values(iota_n, L_));
  const Vec6 sigma = L_ * (C_ * e_alpha);
  f.p = f.p_geo = e.by_iota.transpose() * sigma;
  if (!c.tangents) return;
  const Vec6 sigma_geo = c.mixed_point ? Vec6(L_ * HistoryVec(step.history)) : sigma;
  if (c.mixed_point) f.p_geo = e.by_iota.transpose() * sigma_geo;
  f.by_alpha = beam_strain_hessian(iota, L_, sigma_geo);
  f.by_alpha.noalias() += e.by_iota.transpose() * (L_ * (C_ * e.by_iota));
  f.has_n1 = viscous() && c.dt != 0.0;
  if (f.has_n1)
    f.by_n1 = e.by_iota.transpose() *
              (((stiffening(c) - c.ga.alpha_f) * L_) * (C_ * beam_strains(iota_n1, L_).by_iota));
}

/// Derivative of σ/(C L) by a strain at t_{n+1}.
double BeamElement::stiffening(const StepContext& c) const {
  const double rate = viscous() && c.dt != 0.0 ? tau_ * c.ga.c / c.dt : 0.0;
  return c.ga.alpha_f * (1.0 + rate);
}

/// @eq{beam-wrench}
void BeamElement::evaluate(const PairStep& step, PairTerms& t) const {
  const StepContext& c = step.context;
  const double af = c.ga.alpha_f;
  const Ends ends(end_1_, end_2_, step);
  const Vec15 iota_n = beam_invariants(ends.n), iota_n1 = beam_invariants(ends.n1);
  Forces f;
  if (c.conserving)
    conserving_forces(step, iota_n, iota_n1, f);
  else
    plain_forces(step, iota_n, iota_n1, beam_invariants(ends.alpha), f);

  const Mat15x9 by_motion = invariants_by_motion(ends.alpha, ends.alpha);
  const Vec9 F = by_motion.transpose() * f.p;  // (f_2, m_1, m_2): forces that deform the element
  const Vec3 f_2 = F.head<3>();
  const Vec3 &z_1 = ends.z_1.at_alpha, &z_2 = ends.z_2.at_alpha;
  t.wrench_a << f_2, z_1.cross(f_2) - F.segment<3>(3);
  t.wrench_b << -f_2, -z_2.cross(f_2) - F.segment<3>(6);
  if (c.tangents) {
    Mat9 K = af * frames_turned(ends.alpha, ends.n1, f.p_geo);
    if (f.has_n1)
      K.noalias() += by_motion.transpose() * (f.by_n1 * invariants_by_motion(ends.n1, ends.n1));
    if (!c.conserving)
      K.noalias() +=
          by_motion.transpose() * (af * (f.by_alpha * invariants_by_motion(ends.alpha, ends.n1)));
    put_tangents(K, ends, af, f_2, t);
  }
  add_mass_coupling(step, coupled_mass_, t);
  clear_ground_sides(step, t);
}

Work BeamElement::work(const PairStep& step) const {
  const Vec6 e = beam_strain_values(invariants_n1(step), L_), strain = e - e_ref_;
  Work w;
  w.stored = 0.5 * L_ * strain.dot(C_ * strain);
  if (viscous() && step.context.dt != 0.0) {
    const Vec6 rate = strain_rate(step, e - beam_strain_values(invariants_n(step), L_));
    w.dissipated = step.context.dt * tau_ * L_ * rate.dot(C_ * rate);
  }
  return w;
}

void BeamElement::initialize(const PairStep& step, double* history) const {
  Eigen::Map<Vec6>{history} = section_forces(step);
  if (!viscous()) return;
  Eigen::Map<Vec6>{history + 6} = strain_rate_now(step);
  Eigen::Map<Vec6>{history + 12}.setZero();
}

void BeamElement::commit(const PairStep& step, double* history) const {
  const StepContext& c = step.context;
  const Vec6 e = beam_strain_values(invariants_n1(step), L_);
  Eigen::Map<Vec6>{history} = C_ * (e - e_ref_);
  if (!viscous() || c.dt == 0.0) return;
  const Vec6 De = e - beam_strain_values(invariants_n(step), L_);
  Eigen::Map<Vec6> rate(history + 6), rate_of_rate(history + 12);
  const Vec6 rate_n1 = c.ga.c / c.dt * De + (1.0 - c.ga.c) * rate + c.dt * c.ga.c_A * rate_of_rate;
  rate_of_rate =
      (De / c.dt - rate) / (c.ga.beta * c.dt) + (1.0 - 0.5 / c.ga.beta) * Vec6(rate_of_rate);
  rate = rate_n1;
}

void BeamElement::extrapolate(const PairStep& step, const Vec6& of_1, const Vec6& of_2,
                              double* history) const {
  const Ends ends(end_1_, end_2_, step);
  const BeamStrains e = beam_strains(beam_invariants(ends.n1), L_);
  const Vec15 D_iota = invariants_by_motion(ends.n1, ends.n1) *
                       relative_motion(of_1, of_2, ends.z_1.at_n1, ends.z_2.at_n1);
  Eigen::Map<Vec6>{history} = C_ * (e.e - e_ref_ + e.by_iota * D_iota);
}

}  // namespace polhode
