// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact/closed_form_point.hpp>
#include <polhode/contact/contact_point.hpp>
#include <polhode/contact/fading.hpp>
#include <polhode/contact/point_weight.hpp>
#include <polhode/contact_laws/bristle.hpp>
#include <polhode/core/assert.hpp>

namespace polhode::contact {

namespace {

/// Displacements and rotations below these have no direction: corrections along them are round-off.
constexpr double kNoTurn = 1e-6, kNoMove = 1e-6;
/// Largest shift of the common point per unit rotation, as a part of L.
constexpr double kLargestShift = 0.1;

/// A cheap point near the contact at t_n, the origin in which gaps are computed.
Vec3 near_contact(const PointData& data, const BodyStep& a) {
  const geometry::Shape& A = *data.a;
  if (is_of_corner(data.pair.kind)) return a.r_n + a.Lambda_n * A.corners[data.pair.i];
  if (data.pair.kind == GapKind::edge_edge) {
    const geometry::Shape::Edge& e = A.edges[data.pair.i];
    return a.r_n + a.Lambda_n * (0.5 * (A.corners[e.i] + A.corners[e.j]));
  }
  return a.r_n;
}

template <class T>
struct Wrenches {
  V3<T> force, moment_a, moment_b;
};

template <class T>
V3<T> average(const V3<double>& at_n, const V3<T>& at_n1, double weight) {
  return (1.0 - weight) * at_n + weight * at_n1;
}

}  // namespace

double weight_at(const PointData& data, const Placement<double>& at_a,
                 const Placement<double>& at_b) {
  if (data.pair.fade == Fade::none) return 1.0;
  const FadeDirections<double> f = fade_directions(data.pair, *data.a, *data.b, at_a, at_b);
  return fading(data.pair, dot(f.a, f.b));
}

bool is_row_at(const PointData& data, const Placement<double>& at_a,
               const Placement<double>& at_b) {
  return data.pair.kind == GapKind::extreme_plane || weight_at(data, at_a, at_b) >= kMinWeight;
}

namespace {

double with_value(double, double v) { return v; }
Dual with_value(Dual x, double v) {
  x.v = v;
  return x;
}

/// One evaluation of a contact point with scalar type T.
template <class T>
class Evaluation {
 public:
  Evaluation(const PointData& data, const BodyStep& a, const BodyStep& b,
             const StepContext& context)
      : data_(data),
        a_(a),
        b_(b),
        context_(context),
        from_(near_contact(data, a)),
        n_a_(a.r_n - from_, a.Lambda_n, 0),
        n_b_(b.r_n - from_, b.Lambda_n, 6),
        e_a_(a, from_, 0),
        e_b_(b, from_, 6),
        move_a_(a, 0),
        move_b_(b, 6) {}

  Wrenches<T> run(PointReport* report) {
    Gap<double> g_0 = gap(data_.pair, *data_.a, *data_.b, n_a_, n_b_);
    // Equal to the last bit to the end of the last step: deep in the barrier rounding would matter.
    if (data_.history.closed) g_0.distance = data_.history.gap;
    Gap<T> g_1 = gap(data_.pair, *data_.a, *data_.b, e_a_, e_b_);
    if (has_closed_form(data_))
      g_1.distance = g_0.distance + closed_form_change();
    else if (value(g_1.distance) < data_.normal.reach())
      g_1.distance = with_value(g_1.distance, fine_distance());
    end_point_ = value(g_1.point), end_normal_ = value(g_1.normal);
    kinematics(g_0, g_1);
    forces(g_0, g_1);
    closed_forms();
    alpha_corrections(g_0, g_1);

    Wrenches<T> w;
    w.force = lambda_ * N_;
    w.moment_a = cross(point_N_ - r_a_, w.force) + couple_;
    w.moment_b = -cross(point_N_ - r_b_, w.force) - couple_;
    if (report) start_report(*report, g_0, g_1);
    if (data_.friction.acts() && !data_.history.in_impact()) add_friction(w, report);
    if (report) report->force = value(w.force);
    return w;
  }

  /// Equivalent spring at the common point, after run() with plain numbers.
  PointForce spring(const Wrenches<T>& w) const {
    PointForce f;
    f.force = value(w.force);
    f.moment_a = value(w.moment_a), f.moment_b = value(w.moment_b);
    const double k = std::max(0.0, stiffness_);
    const bool end = has_spring_of_end(data_, k, value(n_), end_normal_, context_.dt);
    f.arm_a = end ? Vec3(end_point_ - value(e_a_.position())) : value(c_ - r_a_);
    f.arm_b = end ? Vec3(end_point_ - value(e_b_.position())) : value(c_ - r_b_);
    f.normal = end ? end_normal_ : value(n_);
    f.C = k * f.normal * f.normal.transpose() + friction_C_;
    f.slide = slide_;
    f.lag = lag_;
    if (lag_ > 0.0) f.friction_slope = (k * rub_) * slide_.normalized();
    return f;
  }

 private:
  /// Common point, normal and exact relative displacement of the material points there.
  /// @eq{contact-direction}
  void kinematics(const Gap<double>& g_0, const Gap<T>& g_1) {
    change_ = g_1.distance - g_0.distance;
    c_ = 0.5 * (g_0.point + g_1.point);
    n_ = unit(g_0.normal + g_1.normal);
    r_a_ = average(n_a_.position(), e_a_.position(), 0.5);
    r_b_ = average(n_b_.position(), e_b_.position(), 0.5);
    u_ = move_a_.u + cross(move_a_.theta, c_ - r_a_) - move_b_.u - cross(move_b_.theta, c_ - r_b_);
    const V3<T> turn = move_a_.theta - move_b_.theta;
    const V3<T> w = cross(n_, turn);
    const T slope = 0.5 * (g_0.slope + g_1.slope);
    share_ = 0.5 * (g_0.share + g_1.share);
    if (data_.pair.kind == GapKind::point_surface) {
      along_the_corner(slope);
      return;
    }
    const T square = slope * dot(w, w), miss = change_ - slope * dot(n_, u_);
    const double angle = value(w).norm();
    V3<T> u = u_;
    point_N_ = c_;
    if (angle > kNoTurn && std::abs(value(miss)) < kLargestShift * data_.length * angle) {
      const V3<T> shift = (miss / square) * w;
      point_N_ = c_ + shift;
      u = u_ + cross(turn, shift);
    }
    correct(slope, u);
  }

  /// Common point and correction of a corner on a surface: the corner itself. Rotations about it do
  /// not change its distance, and all normals of the surface's features pass through it.
  void along_the_corner(const T& slope) {
    const Vec3& Z = data_.a->corners[data_.pair.i];
    point_N_ = average(n_a_.point(Z), e_a_.point(Z), 0.5);
    correct(slope, move_a_.u + cross(move_a_.theta, point_N_ - r_a_) - move_b_.u -
                       cross(move_b_.theta, point_N_ - r_b_));
  }

  /// Discrete-gradient correction of the normal along a displacement.
  void correct(const T& slope, const V3<T>& u) {
    N_ = slope * n_;
    const T length = dot(u, u);
    const double least = kNoMove * data_.length;
    if (value(length) > least * least) N_ = N_ + ((change_ - dot(N_, u)) / length) * u;
  }

  /// Normal force and, if the potential fades, the couple on the fading directions.
  void forces(const Gap<double>& g_0, const Gap<T>& g_1) {
    const NormalLaw& law = data_.normal;
    if constexpr (std::is_same_v<T, double>)
      stiffness_ = normal_force(data_, g_0.distance, g_1.distance, context_.dt).stiffness;
    lambda_ = law.quotient(g_0.distance, g_1.distance);
    const bool spring = law.is_spring();
    if (spring) add_share(g_1);
    if (data_.rate_damping > 0.0) {
      const T factor = 1.0 - (data_.rate_damping / context_.dt) * change_;
      lambda_ = value(factor) > 0.0 ? factor * lambda_ : T(0.0);
    }
    if (!spring) add_share(g_1);
    couple_ = constant<T>(Vec3::Zero());
    if (data_.pair.fade != Fade::none) fade(g_0, g_1);
  }

  /// Adds the part of the force taken at the end of the step. @eq{contact-plastic}
  void add_share(const Gap<T>& g_1) {
    if (data_.end_share > 0.0)
      lambda_ =
          (1.0 - data_.end_share) * lambda_ + data_.end_share * data_.normal.force(g_1.distance);
  }

  /// D(m b) = m̄ Δb + b̄ Δm, with Δm = q Δy and Δy = (θ_a − θ_b)·(ē_a × ē_b). @eq{contact-fading}
  void fade(const Gap<double>& g_0, const Gap<T>& g_1) {
    const FadeDirections<double> f_0 = fade_directions(data_.pair, *data_.a, *data_.b, n_a_, n_b_);
    const FadeDirections<T> f_1 = fade_directions(data_.pair, *data_.a, *data_.b, e_a_, e_b_);
    const double y_0 = dot(f_0.a, f_0.b);
    const T y_1 = dot(f_1.a, f_1.b);
    const T energy =
        0.5 * (data_.normal.energy(g_0.distance) + data_.normal.energy_of(g_1.distance));
    const T mean = 0.5 * (fading(data_.pair, y_0) + fading(data_.pair, y_1));
    lambda_ = mean * lambda_;
    stiffness_ *= value(mean);
    const T q = fading_quotient(data_.pair, y_0, y_1);
    couple_ = (-(energy * q)) * cross(average(f_0.a, f_1.a, 0.5), average(f_0.b, f_1.b, 0.5));
  }

  /// Closed forms of a point against a plane or a ball: N and lever arms for which N·u = Δg needs
  /// no correction. @eq{contact-point-plane} @eq{contact-sphere-sphere}
  void closed_forms() {
    if (!has_closed_form(data_)) return;
    const geometry::Shape &A = *data_.a, &B = *data_.b;
    const Vec3& Z = A.corners[data_.pair.i];
    const V3<double> p_0 = n_a_.point(Z);
    const V3<T> p_1 = e_a_.point(Z);
    point_N_ = average(p_0, p_1, 0.5);
    if (B.solid == geometry::Solid::half_space) {
      const Vec3 normal = B.axes.col(2);
      N_ = average(n_b_.vector(normal), e_b_.vector(normal), 0.5);
    } else {
      const V3<double> w_0 = p_0 - n_b_.point(B.centre);
      const V3<T> w_1 = p_1 - e_b_.point(B.centre);
      N_ = (T(1.0) / (norm(w_0) + norm(w_1))) * (w_0 + w_1);
    }
  }

  /// Δg of a closed form, from the displacements of points and normal. @eq{contact-gap-change}
  [[nodiscard]] T closed_form_change() const {
    const geometry::Shape &A = *data_.a, &B = *data_.b;
    const auto moved = [](const Motion<T>& m, const V3<double>& z_0, const V3<T>& z_1) {
      return cross(m.theta, average(z_0, z_1, 0.5));
    };
    const Vec3 &Z = A.corners[data_.pair.i], &Y = B.centre;
    const V3<T> u = move_a_.u + moved(move_a_, n_a_.vector(Z), e_a_.vector(Z)) - move_b_.u -
                    moved(move_b_, n_b_.vector(Y), e_b_.vector(Y));
    const V3<double> w_0 = n_a_.point(Z) - n_b_.point(Y);
    const V3<T> w_1 = e_a_.point(Z) - e_b_.point(Y);
    if (B.solid == geometry::Solid::ball) return dot(w_0 + w_1, u) / (norm(w_0) + norm(w_1));
    const Vec3 normal = B.axes.col(2);
    const V3<double> n_0 = n_b_.vector(normal);
    const V3<T> n_1 = e_b_.vector(normal);
    return dot(average(n_0, n_1, 0.5), u) + dot(moved(move_b_, n_0, n_1), average(w_0, w_1, 0.5));
  }

  /// Gap at t_{n+1} to the precision of u and θ. Deep in the barrier the rounding of positions,
  /// 1e-16 of the bodies' size, would be worth energy. @eq{contact-gap-change}
  [[nodiscard]] double fine_distance() const {
    return value(gap(data_.pair, *data_.a, *data_.b, Placement<Fine>(a_, from_, 0),
                     Placement<Fine>(b_, from_, 6))
                     .distance);
  }

  /// Force, normal and lever arms at t_{n+αf} for ρ∞ < 1.
  void alpha_corrections(const Gap<double>& g_0, const Gap<T>& g_1) {
    const double e = context_.ga.alpha_f - 0.5;
    if (e == 0.0) return;
    N_ = N_ + e * (g_1.slope * g_1.normal - g_0.slope * g_0.normal);
    const V3<T> moved = e * (g_1.point - g_0.point);
    point_N_ = point_N_ + moved;
    c_ = c_ + moved;
    lambda_ = lambda_ + e * (data_.normal.force(g_1.distance) - data_.normal.force(g_0.distance));
    r_a_ = average(n_a_.position(), e_a_.position(), context_.ga.alpha_f);
    r_b_ = average(n_b_.position(), e_b_.position(), context_.ga.alpha_f);
  }

  void add_friction(Wrenches<T>& w, PointReport* report) {
    const FrictionLaw& f = data_.friction;
    const T normal_force = value(lambda_) > 0.0 ? share_ * lambda_ : T(0.0);
    const Vec3 n = value(n_);
    const T spin = 0.5 * dot(n_, move_a_.theta + move_b_.theta);
    double dissipated = 0.0, stored = 0.0;
    if (f.mu > 0.0) {
      const Cone<T> cone =
          friction_cone((1.0 / f.stiffness) * friction_limit(data_, normal_force), f);
      const V3<T> u_T = u_ - dot(n_, u_) * n_;
      const V3<T> s_0 = start(data_.history.bristle, spin, cone);
      const V3<T> middle = s_0 + (0.5 + f.damping / (f.stiffness * context_.dt)) * u_T;
      const V3<T> F = -f.stiffness * cone.nearest(middle);
      if constexpr (std::is_same_v<T, double>) set_friction_spring(f, middle, F, normal_force);
      w.force = w.force + F;
      w.moment_a = w.moment_a + cross(c_ - r_a_, F);
      w.moment_b = w.moment_b - cross(c_ - r_b_, F);
      if (report) {
        report->friction_force = value(F);
        report->after.bristle = value(cone.nearest(s_0 + u_T));
        report->after.slips = cone.outside(value(s_0 + u_T));
        bristle_work(f.stiffness, value(F), value(u_T), data_.history.bristle,
                     report->after.bristle, stored, dissipated);
      }
    }
    if (f.rolling > 0.0 || f.torsion > 0.0) {
      const V3<T> turn = move_a_.theta - move_b_.theta;
      const T about = dot(n_, turn);
      const double k = f.turning_stiffness;
      const double part = 0.5 + f.turning_damping / (k * context_.dt);
      V3<T> M = constant<T>(Vec3::Zero());
      if (f.rolling > 0.0) {
        const Cone<T> cone{(f.rolling / k) * normal_force, 1.0, {}, {}};
        const V3<T> phi = turn - about * n_;
        const V3<T> s_0 = start(data_.history.rolling, spin, cone);
        M = M - k * cone.nearest(s_0 + part * phi);
        if (report) {
          report->after.rolling = value(cone.nearest(s_0 + phi));
          bristle_work(k, value(M), value(phi), data_.history.rolling, report->after.rolling,
                       stored, dissipated);
        }
      }
      if (f.torsion > 0.0) {
        const Cone<T> cone{(f.torsion / k) * normal_force, 1.0, {}, {}};
        const V3<T> s_0 = cone.nearest(data_.history.torsion * n_);
        const V3<T> torsion_moment = -k * cone.nearest(s_0 + (part * about) * n_);
        M = M + torsion_moment;
        if (report) {
          const Vec3 after = value(cone.nearest(s_0 + about * n_));
          report->after.torsion = after.dot(n);
          bristle_work(k, value(torsion_moment), value(about * n_), data_.history.torsion * n,
                       after, stored, dissipated);
        }
      }
      w.moment_a = w.moment_a + M;
      w.moment_b = w.moment_b - M;
    }
    if (!report) return;
    report->work.stored += stored;
    report->work.dissipated += dissipated;
    report->after.normal = n;
  }

  /// Friction spring k_T (½ + c_T/(k_T Δt)) in the tangent plane; sliding: less, none along F.
  void set_friction_spring(const FrictionLaw& f, const V3<T>& middle, const V3<T>& F,
                           double normal_force) {
    const Vec3 n = value(n_), s = value(middle);
    const double k = f.stiffness * (0.5 + f.damping / (f.stiffness * context_.dt));
    friction_C_ = Mat3::Identity() - n * n.transpose();
    const double length = s.norm(), part = value(F).norm() / std::max(f.stiffness * length, 1e-300);
    const bool sticks = length == 0.0 || !(part < 1.0 - 1e-12);
    friction_C_ *= sticks ? k : k * part;
    if (sticks) return;
    slide_ = s;
    lag_ = k * part;
    friction_C_ -= lag_ * s * s.transpose() / (length * length);
    if (normal_force > 0.0) rub_ = share_ * friction_slope(data_, normal_force);
  }

  static void bristle_work(double k, const Vec3& F, const Vec3& u, const Vec3& before,
                           const Vec3& after, double& stored, double& dissipated) {
    stored += 0.5 * k * after.squaredNorm();
    dissipated += -F.dot(u) - 0.5 * k * (after.squaredNorm() - before.squaredNorm());
  }

  /// Bristle at the start of the step, projected into the tangent plane and into the cone.
  V3<T> start(const Vec3& bristle, const T& spin, const Cone<T>& cone) const {
    return cone.nearest(transported(bristle, data_.history.normal, n_, spin));
  }

  Cone<T> friction_cone(const T& radius, const FrictionLaw& f) const {
    Cone<T> cone{radius, 1.0, {}, {}};
    if (f.mu_across <= 0.0 || f.mu_across == f.mu) return cone;
    const V3<T> d = average(n_a_.vector(f.direction), e_a_.vector(f.direction), 0.5);
    const V3<T> across = d - dot(n_, d) * n_;
    if (value(dot(across, across)) < 1e-12) return cone;  // the direction is the normal
    cone.ratio = f.mu_across / f.mu;
    cone.e = unit(across);
    cone.f = cross(n_, cone.e);
    return cone;
  }

  void start_report(PointReport& r, const Gap<double>& g_0, const Gap<T>& g_1) const {
    r.gap_n = g_0.distance;
    r.gap_n1 = value(g_1.distance);
    r.normal_force = value(lambda_);
    r.normal = value(n_);
    POLHODE_ASSERT(!(std::abs(r.normal.squaredNorm() - 1.0) > 1e-9));
    r.point = from_ + value(c_);
    r.after = data_.history.without_bristles();
    const Placement<double> end_a(a_, from_, 0), end_b(b_, from_, 6);
    const double m_0 = weight_at(data_, n_a_, n_b_), m_1 = weight_at(data_, end_a, end_b);
    r.work = {};
    r.work.stored = m_1 * data_.normal.energy(r.gap_n1);
    // Work of the normal force beyond the change of the potential.
    const double elastic = 0.5 * (m_0 + m_1) * data_.normal.quotient(r.gap_n, r.gap_n1);
    r.work.dissipated = (r.normal_force - elastic) * (r.gap_n - r.gap_n1);
    r.normal_loss = r.work.dissipated;
  }

  const PointData& data_;
  const BodyStep &a_, &b_;
  const StepContext& context_;
  Vec3 from_;                    ///< Origin of positions.
  Placement<double> n_a_, n_b_;  ///< At t_n.
  Placement<T> e_a_, e_b_;       ///< At t_{n+1}.
  Motion<T> move_a_, move_b_;
  T change_{}, lambda_{}, share_{1.0};
  double stiffness_ = 0.0;
  Vec3 end_point_, end_normal_;  ///< At t_{n+1}.
  Mat3 friction_C_ = Mat3::Zero();
  Vec3 slide_ = Vec3::Zero();
  double lag_ = 0.0, rub_ = 0.0;  ///< Of a sliding point, as in PointForce.
  V3<T> c_, n_, u_, N_, point_N_, r_a_, r_b_, couple_;
};

void put(const V3<Dual>& x, int row, Mat6& by_a, Mat6& by_b) {
  const Dual* rows[3] = {&x.x, &x.y, &x.z};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j) {
      by_a(row + i, j) += rows[i]->d[j];
      by_b(row + i, j) += rows[i]->d[6 + j];
    }
}

template <class T>
void add_values(const Wrenches<T>& w, PairTerms& terms) {
  const Vec3 F = value(w.force);
  terms.wrench_a.head<3>() += F;
  terms.wrench_a.tail<3>() += value(w.moment_a);
  terms.wrench_b.head<3>() -= F;
  terms.wrench_b.tail<3>() += value(w.moment_b);
}

}  // namespace

void add_contact(const PointData& data, const BodyStep& a, const BodyStep& b,
                 const StepContext& context, PairTerms& terms, PointReport* report) {
  if (!context.tangents) {
    add_values(Evaluation<double>(data, a, b, context).run(report), terms);
    return;
  }
  const Wrenches<Dual> w = Evaluation<Dual>(data, a, b, context).run(report);
  add_values(w, terms);
  put(w.force, 0, terms.D_aa, terms.D_ab);
  put(w.moment_a, 3, terms.D_aa, terms.D_ab);
  put(-w.force, 0, terms.D_ba, terms.D_bb);
  put(w.moment_b, 3, terms.D_ba, terms.D_bb);
}

PointForce point_force(const PointData& data, const BodyStep& a, const BodyStep& b,
                       const StepContext& context) {
  Evaluation<double> evaluation(data, a, b, context);
  return evaluation.spring(evaluation.run(nullptr));
}

bool has_closed_form(const PointData& data) {
  return data.pair.kind == GapKind::point_solid &&
         (data.b->solid == geometry::Solid::half_space || data.b->solid == geometry::Solid::ball);
}

double gap_n1(const PointData& data, double gap_n, const BodyStep& a, const BodyStep& b) {
  if (has_closed_form(data)) return closed_form_gap_n1(data, gap_n, a, b);
  const Vec3 from = near_contact(data, a);
  return gap(data.pair, *data.a, *data.b, Placement<double>(a, from, 0),
             Placement<double>(b, from, 6))
      .distance;
}

double stored_at(const PointData& data, const BodyStep& a, const BodyStep& b) {
  const Vec3 from = near_contact(data, a);
  return weight_at(data, Placement<double>(a.r_n1 - from, a.Lambda_n1, 0),
                   Placement<double>(b.r_n1 - from, b.Lambda_n1, 6)) *
         data.normal.energy(data.history.gap);
}

}  // namespace polhode::contact
