// SPDX-License-Identifier: Apache-2.0
// Newton predictor for bodies in contact.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/QR>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Maximum number of Gauss-Seidel sweeps over all points. They end when no gap changes by more than
/// this part of its depth or clearance, and no friction force by more than this part of its bound.
constexpr int kSweeps = 100, kMaxIterations = 30;
constexpr double kAgreed = 0.03;
/// Motion of a point's bodies since its last update, as a part of its depth or clearance, below
/// which a sweep leaves it out.
constexpr double kUnmoved = 0.03;
/// Depth, as a part of the tolerance, below which its changes are compared with this.
constexpr double kLeastDepth = 0.1;
constexpr double kExactEnough = 1e-2;  ///< Part of the clearance that remains.
/// Displacement over distance above which balls may pass each other: then the gap along the line of
/// centres counts.
constexpr double kFar = 0.5;
/// Maximum number of linearisations about the moved bodies.
constexpr int kLinearisations = 2;
/// Bound of the displacements after collisions, as a multiple of the largest one before.
constexpr double kPushed = 2.0;

/// A body's motion and its response to forces.
struct PredictedBody {
  Vec6 about = Vec6::Zero();  ///< Increment about which rows are linear.
  Vec6 free = Vec6::Zero();   ///< Increment without contacts and multipliers.
  Vec6 increment = Vec6::Zero();
  double inverse_mass = 0.0;            ///< [1/kg]
  Mat3 inverse_inertia = Mat3::Zero();  ///< World [1/(kg m²)].
  const Mat6* response = nullptr;  ///< With loads instead of both: increment by a wrench over K.
  double reach = 0.0;              ///< Distance of its points from the centre of mass [m].
  double moved = 0.0;              ///< Bound of the path of its points by all forces [m].

  void move(const Vec3& u, const Vec3& theta) {
    increment.head<3>() += u;
    increment.tail<3>() += theta;
    moved += u.norm() + reach * theta.norm();
  }
};

/// A body at a point of contact.
struct BodyAtPoint {
  PredictedBody* body = nullptr;
  Vec3 arm = Vec3::Zero();  ///< From the centre of mass to the point, world [m].

  [[nodiscard]] Vec3 displacement() const {
    return body->increment.head<3>() - arm.cross(Vec3(body->increment.tail<3>()));
  }
  /// Moves the body by a force over K at the point.
  void push(const Vec3& force) const {
    PredictedBody& b = *body;
    if (b.response) {
      const Vec6 change = *b.response * wrench(force);
      b.move(change.head<3>(), change.tail<3>());
    } else {
      b.move(b.inverse_mass * force, b.inverse_inertia * arm.cross(force));
    }
  }
  /// Displacement of the point along t by a unit force along s.
  [[nodiscard]] double mobility(const Vec3& t, const Vec3& s) const {
    const PredictedBody& b = *body;
    if (b.response) return wrench(t).dot(*b.response * wrench(s));
    return b.inverse_mass * t.dot(s) + arm.cross(t).dot(b.inverse_inertia * arm.cross(s));
  }

 private:
  [[nodiscard]] Vec6 wrench(const Vec3& force) const {
    Vec6 w;
    w << force, arm.cross(force);
    return w;
  }
};

/// A point of contact and its force over K.
struct PredictedContact {
  const PointData* data = nullptr;
  const SpherePairCache* balls = nullptr;
  Vec3 normal_n, place_n;  ///< At t_n; the normal is from b to a.
  Vec3 normal;             ///< Of the force.
  BodyAtPoint a, b;
  double correction = 0.0;           ///< Of the linear gap [m].
  double mobility = 0.0;             ///< Along the normal [1/kg].
  double tangential_mobility = 0.0;  ///< The largest one across it [1/kg].
  double normal_force = 0.0;         ///< Over K [kg m].
  double seen = 0.0;                 ///< Path of both bodies at the last update [m].
  double unmoved = -1.0;             ///< Further path without a new update [m].
  bool has_friction = false;     ///< Outside impacts, whose friction is an impulse at their end.
  Vec3 bristle = Vec3::Zero();   ///< At t_n, in the tangent plane [m].
  Vec3 friction = Vec3::Zero();  ///< On a, over K [kg m].

  /// Displacement of the point of a relative to that of b.
  [[nodiscard]] Vec3 relative() const { return a.displacement() - b.displacement(); }
  /// Moves both bodies by a force over K on a.
  void push(const Vec3& force) const {
    a.push(force);
    b.push(-force);
  }
  /// Gap at the end of the step [m].
  [[nodiscard]] double gap() const {
    if (balls->holds) {
      const Vec3 moved = a.body->increment.head<3>() - b.body->increment.head<3>();
      if (balls->distance == 0.0 || moved.norm() <= kFar * balls->distance)
        return balls->gap_after(moved);
    }
    return balls->gap_n + normal.dot(relative()) + correction;
  }
  [[nodiscard]] Vec3 slip() const {
    const Vec3 u = relative();
    return u - normal.dot(u) * normal;
  }
  [[nodiscard]] double path() const { return a.body->moved + b.body->moved; }
  void find_mobilities() {
    const auto along = [&](const Vec3& t, const Vec3& s) {
      return a.mobility(t, s) + b.mobility(t, s);
    };
    mobility = along(normal, normal);
    if (!has_friction) return;
    const Vec3 t = normal.unitOrthogonal(), s = normal.cross(t);
    const double tt = along(t, t), ss = along(s, s);
    tangential_mobility = 0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), along(t, s));
  }
};

/// Constraint rows between two bodies.
struct PredictedRows {
  PointwiseContacts::FreeRows* rows = nullptr;
  PredictedBody *a = nullptr, *b = nullptr;
  Eigen::Matrix<double, 6, kMaxRows> by_a, by_b;  ///< Increments by the multipliers over K.
  Eigen::Matrix<double, kMaxRows, kMaxRows> inverse;
};

/// Gap at the end of the step if only this contact acts additionally: the root of K(g − free) =
/// λ(g_0, g), whose sides increase and decrease with g.
/// @param free  Gap without this contact's force [m]. @param now  First guess [m].
/// @param K  Of both masses [N/m].
double gap_with(const PredictedContact& m, double free, double now, double K, double dt) {
  const double reach = m.balls->reach, least = m.balls->least_gap, gap_n = m.balls->gap_n;
  if (free >= reach) return free;
  double low = std::max(least, free), high = std::max(reach, low);
  double g = now > low && now < high ? now : 0.5 * (low + std::clamp(gap_n, low, high));
  for (int k = 0; k < kMaxIterations; ++k) {
    const double enough = kExactEnough * std::min(g - least, m.data->normal.tolerance);
    const NormalForce f = normal_force(*m.data, gap_n, g, dt);
    const double rest = K * (g - free) - f.lambda;
    (rest < 0.0 ? low : high) = g;
    const double next = g - rest / (K + std::max(0.0, f.stiffness));
    if (std::abs(next - g) < enough) return next > low && next < high ? next : g;
    g = next > low && next < high ? next : 0.5 * (low + high);
  }
  return g;
}

/// Friction force over K on a, if only this contact acts additionally. @eq{contact-bristle}
/// @param free  Slip without this contact's friction [m].
Vec3 friction_with(const PredictedContact& m, const Vec3& free, double K, double dt) {
  const FrictionLaw& f = m.data->friction;
  const double limit = friction_limit(*m.data, K * m.normal_force), k = f.stiffness;
  const double factor = 0.5 + f.damping / (k * dt);
  Vec3 bristle = m.bristle;
  if (const double size = k * bristle.norm(); size > limit) bristle *= limit / size;
  const Vec3 force =
      -k * (bristle + factor * free) / (1.0 + k * factor * m.tangential_mobility / K);
  const double size = force.norm();
  return (size > limit ? limit / size : 1.0) / K * force;
}

/// Gauss-Seidel iteration over rows and points of contact.
class Sweeps {
 public:
  Sweeps(std::vector<PredictedRows>& rows, std::vector<PredictedContact>& contacts, double K,
         double dt)
      : rows_(rows), contacts_(contacts), K_(K), dt_(dt) {
    for (const PredictedContact& m : contacts)
      tolerance_ = std::min(tolerance_, m.data->normal.tolerance);
  }

  void run() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      change_ = 0.0;
      for (PredictedRows& rows : rows_) fulfil(rows);
      for (PredictedContact& contact : contacts_) update(contact);
      if (change_ < kAgreed) break;
    }
  }

  /// Linearises anew about the moved bodies, with the normals and arms of the middle of the step.
  /// @returns the largest change of a gap or, where friction acts, of a slip, as a part of the
  /// clearance.
  double linearise(std::span<const BodyStep> steps, std::vector<PredictedBody>& bodies) {
    double largest = 0.0;
    std::vector<BodyStep> moved;
    for (PredictedContact& m : contacts_) {
      const double linear = m.gap();
      if (m.normal_force == 0.0 && linear > m.balls->reach) continue;
      m.unmoved = -1.0;
      if (m.balls->holds) {
        if (m.balls->distance > 0.0) largest = std::max(largest, turn(m) / clearance(m, linear));
        continue;
      }
      if (moved.empty()) moved = at_increments(steps, bodies);
      const Vec3 slip = m.slip();
      const double gap = linearise(m, moved[m.balls->a], moved[m.balls->b]);
      double change = std::abs(gap - linear);
      if (m.has_friction) change = std::max(change, (m.slip() - slip).norm());
      largest = std::max(largest, change / clearance(m, linear));
    }
    if (largest == 0.0) return 0.0;
    for (PredictedBody& body : bodies) body.increment = body.free;
    for (const PredictedRows& r : rows_) {
      r.a->increment += r.by_a * (r.rows->change / K_);
      r.b->increment += r.by_b * (r.rows->change / K_);
    }
    for (const PredictedContact& m : contacts_) m.push(m.normal_force * m.normal + m.friction);
    return largest;
  }

 private:
  static std::vector<BodyStep> at_increments(std::span<const BodyStep> steps,
                                             std::span<const PredictedBody> bodies) {
    std::vector<BodyStep> moved(steps.begin(), steps.end());
    for (std::size_t b = 0; b + 1 < moved.size(); ++b) {
      BodyStep& s = moved[b];
      s.u = bodies[b].increment.head<3>();
      s.theta = bodies[b].increment.tail<3>();
      s.r_n1 = s.r_n + s.u;
      s.Lambda_n1 = cay(s.theta) * s.Lambda_n;
    }
    return moved;
  }
  /// Turns the normal of two balls to that of the whole step, along which its force acts.
  /// @returns the displacement by the change of the force [m]. @eq{contact-gap-change}
  static double turn(PredictedContact& m) {
    const Vec3 apart =
        m.balls->offset + m.a.body->increment.head<3>() - m.b.body->increment.head<3>();
    const Vec3 normal = (m.balls->offset + apart) / (m.balls->distance + apart.norm());
    const double turned = (normal - m.normal).norm();
    m.normal = normal;
    m.a.arm = -m.a.arm.norm() * normal;
    m.b.arm = m.b.arm.norm() * normal;
    m.friction -= normal.dot(m.friction) * normal;
    return m.mobility * m.normal_force * turned;
  }
  /// @returns the gap at the end of the step [m].
  static double linearise(PredictedContact& m, const BodyStep& a, const BodyStep& b) {
    const PointData& d = *m.data;
    const Gap<double> end =
        polhode::contact::gap(d.pair, *d.a, *d.b, Placement<double>(a.r_n1, a.Lambda_n1, 0),
                              Placement<double>(b.r_n1, b.Lambda_n1, 6));
    const Vec3 place = 0.5 * (m.place_n + value(end.point));
    m.normal = (m.normal_n + value(end.normal)).normalized();
    m.a.arm = place - a.r_n - 0.5 * a.u;
    m.b.arm = place - b.r_n - 0.5 * b.u;
    m.friction -= m.normal.dot(m.friction) * m.normal;
    m.find_mobilities();
    m.correction = 0.0;
    const double gap = gap_n1(d, m.balls->gap_n, a, b);
    m.correction = gap - m.gap();
    return gap;
  }
  /// Depth of a gap within the law's band, or its clearance if that is less [m].
  static double clearance(const PredictedContact& m, double gap) {
    const double tolerance = m.data->normal.tolerance, reach = m.balls->reach;
    return std::min({std::min(gap, reach) - m.balls->least_gap, tolerance,
                     std::max(reach - gap, kLeastDepth * tolerance)});
  }

  void fulfil(PredictedRows& r) {
    const PointwiseContacts::FreeRows& of = *r.rows;
    const Vec6 g =
        of.g + of.G_a * (r.a->increment - r.a->about) + of.G_b * (r.b->increment - r.b->about);
    const Vec6 change = -(r.inverse * g), on_a = r.by_a * change, on_b = r.by_b * change;
    r.a->move(on_a.head<3>(), on_a.tail<3>());
    r.b->move(on_b.head<3>(), on_b.tail<3>());
    r.rows->change += K_ * change;
    change_ =
        std::max({change_, on_a.head<3>().norm() / tolerance_, on_b.head<3>().norm() / tolerance_});
  }

  void update(PredictedContact& m) {
    if (!(m.mobility > 0.0) || m.path() - m.seen <= m.unmoved) return;
    const double now = m.gap(), gap_without = now - m.mobility * m.normal_force;
    m.seen = m.path();
    m.unmoved = now - m.balls->reach;
    if (m.normal_force == 0.0 && m.unmoved >= 0.0) return;
    const double gap = gap_with(m, gap_without, now, K_ / m.mobility, dt_);
    const double normal = (gap - gap_without) / m.mobility, more = normal - m.normal_force;
    change_ = std::max(change_, m.mobility * std::abs(more) / clearance(m, gap));
    m.normal_force = normal;
    m.push(more * m.normal);
    m.unmoved = kUnmoved * clearance(m, gap);
    if (m.has_friction) update_friction(m);
    m.seen = m.path();
  }
  void update_friction(PredictedContact& m) {
    const Vec3 free = m.slip() - m.tangential_mobility * m.friction;
    const Vec3 friction = friction_with(m, free, K_, dt_), change = friction - m.friction;
    if (m.normal_force > 0.0)
      change_ =
          std::max(change_, K_ * change.norm() / friction_limit(*m.data, K_ * m.normal_force));
    m.friction = friction;
    m.push(change);
  }

  std::vector<PredictedRows>& rows_;
  std::vector<PredictedContact>& contacts_;
  double K_, dt_;
  double tolerance_ = std::numeric_limits<double>::infinity();  ///< The smallest [m].
  double change_ = 0.0;                                         ///< The largest in a sweep [-].
};

/// Rows with the effect of their multipliers; redundant ones share.
std::vector<PredictedRows> with_effects(std::span<PointwiseContacts::FreeRows> list,
                                        std::vector<PredictedBody>& bodies) {
  std::vector<PredictedRows> all;
  for (PointwiseContacts::FreeRows& of : list) {
    PredictedRows& r = all.emplace_back();
    r.rows = &of;
    r.a = of.a == kGround ? &bodies.back() : &bodies[of.a];
    r.b = of.b == kGround ? &bodies.back() : &bodies[of.b];
    r.by_a.setZero();
    r.by_b.setZero();
    if (of.a != kGround) r.by_a = *r.a->response * of.G_a.transpose();
    if (of.b != kGround) r.by_b = *r.b->response * of.G_b.transpose();
    const Eigen::Matrix<double, kMaxRows, kMaxRows> S = of.G_a * r.by_a + of.G_b * r.by_b;
    r.inverse = S.completeOrthogonalDecomposition().pseudoInverse();
  }
  return all;
}

}  // namespace

/// Predictor by Gauss-Seidel iteration over points of contact and constraint rows, with the laws of
/// the step itself. Gaps of balls are exact, others are linear. Without it the fastest pair would
/// limit the step of all bodies, and Newton's method would find in many iterations which points
/// slide. @eq{contact-predictor}
void ContactSet::predict(std::span<const BodyStep> steps, const StepContext& context,
                         std::span<const FreeMotion> free, std::span<FreeRows> free_rows,
                         std::vector<Vec6>& increments) const {
  const double K = context.ga.alpha_m / (context.ga.beta * context.dt * context.dt);
  const auto ground = static_cast<int>(steps.size()) - 1;
  std::vector<PredictedBody> bodies(steps.size());
  std::vector<Mat6> responses;
  responses.reserve(free.size());
  double farthest = 0.0;
  for (int b = 0; b < ground; ++b) {
    PredictedBody& body = bodies[b];
    body.about = increments[b];
    body.reach = reach_of_body_[b];
    body.free = body.increment = free[b].increment;
    if (free[b].has_loads) {
      body.response = &responses.emplace_back(K * free[b].response);
    } else {
      body.inverse_mass = 1.0 / system_->bodies()[b].mass;
      body.inverse_inertia =
          steps[b].Lambda_n * inverse_inertia_[b] * steps[b].Lambda_n.transpose();
    }
    farthest = std::max(farthest, body.increment.head<3>().norm() +
                                      reach_of_body_[b] * body.increment.tail<3>().norm());
  }
  std::vector<PredictedContact> contacts;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const SpherePairCache& balls = balls_[i];
    const Point& p = points_[i];
    if (p.sensor) continue;
    if (balls.gap_n > balls.reach + 2.0 * kPushed * farthest) continue;
    const PointHistory& h = p.data.history;
    PredictedContact& m = contacts.emplace_back();
    m.data = &p.data;
    m.balls = &balls;
    m.normal = m.normal_n = p.normal_n;
    m.place_n = p.place_n;
    m.a = {&bodies[balls.a], p.place_n - steps[balls.a].r_n};
    m.b = {&bodies[balls.b], p.place_n - steps[balls.b].r_n};
    m.has_friction = p.data.friction.mu > 0.0 && !h.in_impact();
    m.find_mobilities();
    if (!h.closed) continue;
    m.normal_force = h.force / K;
    if (m.has_friction) {
      m.bristle = h.bristle - m.normal.dot(h.bristle) * m.normal;
      m.friction = -p.data.friction.stiffness / K * m.bristle;
    }
    m.push(m.normal_force * m.normal + m.friction);
  }
  std::vector<PredictedRows> rows = with_effects(free_rows, bodies);
  Sweeps sweeps(rows, contacts, K, context.dt);
  sweeps.run();
  for (int k = 0; k < kLinearisations && sweeps.linearise(steps, bodies) > kAgreed; ++k)
    sweeps.run();
  for (int b = 0; b < ground; ++b)
    if (bodies[b].increment.allFinite()) increments[b] = bodies[b].increment;
}

}  // namespace polhode::contact
