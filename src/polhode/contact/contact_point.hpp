// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/gap.hpp>
#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode::contact {

/// Friction law of a contact point: an elastic bristle that sticks, and slides when its force would
/// exceed the friction cone; likewise for rolling and torsional (spin) friction.
struct FrictionLaw {
  double mu = 0.0;                 ///< Coefficient [-]; along `direction` if anisotropic.
  double mu_static = 0.0;          ///< Static, while it stuck at t_n; 0: equal to mu [-].
  double mu_across = 0.0;          ///< Across `direction`; 0: isotropic [-].
  Vec3 direction = Vec3::UnitX();  ///< Of mu, body-a components.
  double rolling = 0.0;            ///< Rolling friction: moment over normal force [m].
  double torsion = 0.0;    ///< Torsional friction about the normal: moment over normal force [m].
  double stiffness = 1.0;  ///< Of the bristle, k_T [N/m].
  double damping = 0.0;    ///< c_T [N s/m], only inside the cone.
  double turning_stiffness = 1.0;  ///< k_R [N m/rad].
  double turning_damping = 0.0;    ///< c_R [N m s/rad].

  [[nodiscard]] bool acts() const { return mu > 0.0 || rolling > 0.0 || torsion > 0.0; }
};

/// State of a contact point that is carried from step to step.
struct PointHistory {
  Vec3 bristle = Vec3::Zero();  ///< World, in the tangent plane [m].
  Vec3 normal = Vec3::Zero();   ///< Of the step that left the bristles, or of a row; zero: no step.
  Vec3 rolling = Vec3::Zero();  ///< World, in the tangent plane [rad].
  double torsion = 0.0;         ///< [rad]
  double approach = 0.0;        ///< w_pre: normal velocity at closing [m/s], negative.
  double restitution = 0.0;     ///< e of the impact; 0 where the rebound would be too short [-].
  double stiffness = 0.0;       ///< k of the normal law, constant while closed.
  double reach = 0.0, floor = 0.0;  ///< Activation distance and lower end of the normal law's band,
                                    ///< likewise constant [m].
  double force = 0.0;               ///< λ of a closed point in the last step [N].
  double bristle_stiffness = 0.0;   ///< k_T, constant while closed [N/m].
  double gap = 0.0;                 ///< Of a closed point at t_n, as the last step computed it [m].
  /// Impulse of the non-smooth law on a in the last step, world [N s].
  Vec3 impulse = Vec3::Zero();
  Vec3 turning = Vec3::Zero();  ///< Likewise, of rolling and torsional friction [N m s].
  double kept = 0.0;            ///< Of a row: gap at the start of the run, if negative [m].
  Vec3 point = Vec3::Zero();    ///< Of a row [m].
  double pressed = 0.0;         ///< Of a row: normal part of the impulse [N s].
  double held = 0.0;    ///< Of a row: friction, as a part of that under which it sticks [-].
  bool closed = false;  ///< The gap was within the activation distance at t_n.
  ContactPhase phase = ContactPhase::rest;
  bool slips = false;

  /// Whether the point is in an impact; friction then acts as an impulse at the end of the step.
  [[nodiscard]] bool in_impact() const {
    return phase == ContactPhase::compression || phase == ContactPhase::restitution;
  }
  /// Whether there is something to carry to the next step.
  [[nodiscard]] bool remembers() const { return closed || !impulse.isZero(0.0) || kept < 0.0; }
  /// Copy of the history with relaxed bristles.
  [[nodiscard]] PointHistory without_bristles() const {
    PointHistory h = *this;
    h.bristle = h.normal = h.rolling = Vec3::Zero();
    h.torsion = 0.0;
    h.slips = false;
    return h;
  }
};

/// Friction bound of a point as part of its patch: μ λ plus what the point already holds, as long
/// as it is under normal force. @eq{contact-patch}
struct FrictionShare {
  double mu = -1.0;     ///< Negative: the law's own [-].
  double held = 0.0;    ///< [N]
  double load = 0.0;    ///< Normal force; below a part of it `held` fades [N].
  bool slides = false;  ///< The patch was sliding at t_n.
};

/// Data of a contact point in a step: features, laws, history.
struct PointData {
  FeaturePair pair;
  const geometry::Shape* a = nullptr;
  const geometry::Shape* b = nullptr;
  NormalLaw normal;
  FrictionLaw friction;
  double rate_damping = 0.0;  ///< c of λ·max(0, 1 − c Δg/Δt) [s/m].
  /// Part of the normal force that is evaluated at the end of the step [-].
  double end_share = 0.0;
  double length = 1.0;  ///< L of the pair [m].
  double mass = 0.0;    ///< Reduced mass of both bodies [kg].
  FrictionShare share;  ///< In this step.
  PointHistory history;
};

/// Largest friction force of a point under a normal force [N].
template <class T>
[[nodiscard]] T friction_limit(const PointData& data, const T& normal_force) {
  constexpr double kFades = 0.1;  // as a part of the load
  const FrictionLaw& f = data.friction;
  const FrictionShare& s = data.share;
  if (s.mu < 0.0)
    return (!data.history.slips && f.mu_static > 0.0 ? f.mu_static : f.mu) * normal_force;
  if (s.held == 0.0) return s.mu * normal_force;
  const double full = kFades * s.load;
  if (value(normal_force) >= full) return s.mu * normal_force + s.held;
  return (s.mu + s.held / full) * normal_force;
}

/// Derivative of friction_limit() by the normal force [-].
[[nodiscard]] inline double friction_slope(const PointData& data, double normal_force) {
  const double more = 1e-6 * normal_force;  // linear except at a distant kink
  return (friction_limit(data, normal_force + more) - friction_limit(data, normal_force)) / more;
}

/// Results of a contact point over a step.
struct PointReport {
  double gap_n = 0.0, gap_n1 = 0.0;  ///< [m]
  double normal_force = 0.0;         ///< λ, weight included [N].
  Vec3 force = Vec3::Zero();         ///< On a, at t_{n+αf} [N].
  Vec3 normal = Vec3::Zero();        ///< From b to a, at the middle of the step.
  Vec3 point = Vec3::Zero();         ///< World [m].
  Vec3 friction_force = Vec3::Zero();
  Work work;                 ///< stored at t_{n+1}, dissipated over the step.
  double normal_loss = 0.0;  ///< The part of it due to the normal force [J].
  PointHistory after;        ///< History at t_{n+1}: new bristles, unchanged flags.
};

/// Adds the wrenches of a contact point on bodies a and b and, if StepContext::tangents is set, the
/// tangents to terms.
///
/// The work over the step is exactly −(b(g_{n+1}) − b(g_n)) at ρ∞ = 1; the forces on a and b are
/// opposite and act at one common point. @eq{contact-direction} @eq{contact-wrench}
void add_contact(const PointData& data, const BodyStep& a, const BodyStep& b,
                 const StepContext& context, PairTerms& terms, PointReport* report = nullptr);

/// Force of a contact point and its equivalent spring, for solvers that represent contacts as
/// springs at points.
struct PointForce {
  Vec3 force = Vec3::Zero();                              ///< On a, at t_{n+αf} [N].
  Vec3 moment_a = Vec3::Zero(), moment_b = Vec3::Zero();  ///< About the centres of mass [N m].
  /// From the centres of mass to the point [m].
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();
  Mat3 C = Mat3::Zero();       ///< Symmetric stiffness between the points of a and b there [N/m].
  Vec3 normal = Vec3::Zero();  ///< Unit, from b to a.
  Vec3 slide = Vec3::Zero();   ///< Deflection of a sliding bristle [m]; zero if it sticks.
  Vec3 friction_slope =
      Vec3::Zero();  ///< Derivative of its force on a by the displacement along the normal [N/m].
  /// Lagged stiffness, force over deflection, which C lacks along the slide [N/m].
  double lag = 0.0;
};

/// Whether the spring of a point has the normal and arms of the end of the step, along which the
/// gap changes, instead of the mean ones of the force: where tangential increments that leave the
/// mean gap would change the force by more than inertia does. @eq{contact-spring}
/// @param stiffness  Along the normal [N/m].
[[nodiscard]] inline bool has_spring_of_end(const PointData& data, double stiffness,
                                            const Vec3& mean_normal, const Vec3& end_normal,
                                            double dt) {
  return stiffness * (end_normal - mean_normal).norm() * dt * dt > 2.0 * data.mass;
}

/// Force of the point, equal to that of add_contact(), and the spring that approximates its
/// tangent.
[[nodiscard]] PointForce point_force(const PointData& data, const BodyStep& a, const BodyStep& b,
                                     const StepContext& context);

/// Normal force of a point without fading: potential, damper, share of the end of the step, weight.
struct NormalForce {
  double lambda = 0.0;     ///< [N]
  double stiffness = 0.0;  ///< −dλ/dg_{n+1} [N/m].
  double elastic = 0.0;    ///< From the potential alone [N].
};
/// @eq{contact-quotient} @eq{contact-plastic} @eq{contact-damped}
[[nodiscard]] NormalForce normal_force(const PointData& data, double gap_n, double gap_n1,
                                       double dt);

/// Whether force and change of the gap have closed forms: a point against a ball or a half space.
[[nodiscard]] bool has_closed_form(const PointData& data);

/// Gap at the end of the step, without derivatives. @param gap_n  At its start [m].
[[nodiscard]] double gap_n1(const PointData& data, double gap_n, const BodyStep& a,
                            const BodyStep& b);

/// Potential energy of a closed point at an instant, fading included [J]. The gap is the stored
/// one: computed again from world positions it would differ in the last digit, which matters deep
/// in the barrier.
[[nodiscard]] double stored_at(const PointData& data, const BodyStep& a, const BodyStep& b);

}  // namespace polhode::contact
