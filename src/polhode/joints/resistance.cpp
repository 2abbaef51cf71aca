// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact_laws/bristle.hpp>
#include <polhode/contact_laws/stop_force.hpp>
#include <polhode/dynamics/load_step.hpp>
#include <polhode/joints/parts.hpp>
#include <polhode/joints/parts/link_length.hpp>
#include <polhode/joints/resistance_coordinates.hpp>

namespace polhode {

namespace {

using contact::Cone;

/// Rounding of a bristle that slips, as a part of its cone.
constexpr double kOnCone = 1e-9;

/// Force of a stop at t_{n+αf} and its slope by the gap at t_{n+1}.
contact::ForceAndSlope stop_force(const Stop& stop, const PairStep& step) {
  return contact::stop_force(stop.law(), {.at_n = stop.gap_n(),
                                          .at_n1 = stop.gap_n1(),
                                          .alpha_f = step.a.alpha_f,
                                          .conserving = step.context.conserving,
                                          .end_share = stop.end_share()});
}

/// x/√y, or 0 where y is zero: zero forces have no direction.
Vec3 over_root(const Vec3& x, double y) { return y > 0.0 ? Vec3(x / std::sqrt(y)) : Vec3::Zero(); }

const Mat3& axes_at(const Configuration& q) { return q.R_a; }

/// Slope of an angle at t_{n+1}: ∂φ = gradient·(∂θ_b − ∂θ_a).
Vec3 angle_gradient(const FreeAngle& x, const PairStep& step) {
  const Mat3& base = x.on_b ? step.b.Lambda_n1 : step.a.Lambda_n1;
  const Mat3& other = x.on_b ? step.a.Lambda_n1 : step.b.Lambda_n1;
  const Vec3 e = base * x.E, f = base * x.F, d = other * x.D;
  const double C = e.dot(d), S = f.dot(d);
  return (x.on_b ? -1.0 : 1.0) / (C * C + S * S) * d.cross(C * f - S * e);
}

/// Body at t_n, as an instant.
BodyStep start_of(const BodyStep& s) {
  BodyStep start = BodyStep::at_instant(s.r_n, s.Lambda_n, s.v_n, s.W_n);
  start.moves = s.moves;
  return start;
}

/// d/dt of the slide z·u, or of the distance |u|, at an instant.
double slide_rate(const Configuration& q, const BodyStep& a, const BodyStep& b, bool distance) {
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega_b = b.Lambda_n1 * b.W_n1;
  const Vec3 u_dot = b.v_n1 + omega_b.cross(q.z_b) - a.v_n1 - omega_a.cross(q.z_a);
  if (distance) return q.u.norm() > 0.0 ? q.u.normalized().dot(u_dot) : 0.0;
  const Vec3 z = axes_at(q).col(kZ);
  return z.dot(u_dot) + omega_a.cross(z).dot(q.u);
}

}  // namespace

/// Slip force, the cone radius of the bristle times its stiffness, with its derivatives.
struct Resistance::Slip {
  double force = 0.0;
  Vec6 by_lambda = Vec6::Zero();
  Vec3 by_theta_a = Vec3::Zero(), by_theta_b = Vec3::Zero();
};

/// The bristle over the step.
struct Resistance::Bristle {
  Vec3 at_n = Vec3::Zero();   ///< Transported to this step.
  Vec3 moved = Vec3::Zero();  ///< Increment of the coordinates, including levers.
  Vec3 acting = Vec3::Zero(), at_n1 = Vec3::Zero();  ///< Inside the cone or on it.
  Mat3 D_acting = Mat3::Zero();                      ///< By the increment.
  Vec3 D_radius = Vec3::Zero();                      ///< By the radius of its cone.
  bool slips = false;
};

std::optional<Resistance::Kind> Resistance::kind_of(const std::string& type) {
  if (type == "revolute") return Kind::revolute;
  if (type == "prismatic") return Kind::prismatic;
  if (type == "cylindrical") return Kind::cylindrical;
  if (type == "spherical") return Kind::spherical;
  if (type == "universal") return Kind::universal;
  if (type == "slack_link") return Kind::link;
  return std::nullopt;
}

Resistance::Place Resistance::place(const View& v, bool slides) const {
  if (!slides) return {v.angle_n[0], v.angle[0].at_n1(v.step.a, v.step.b, v.angle_n[0])};
  if (kind_ == Kind::link) {
    const LinkLength length(v.q_n, v.q_n1);
    return {length.at_n, length.at_n1};
  }
  return {axes_at(v.q_n).col(kZ).dot(v.q_n.u), axes_at(v.q_n1).col(kZ).dot(v.q_n1.u)};
}

bool Resistance::idle(const View& v) const {
  if (data_.friction || rows() > 0 || is_load_step(v.step.context)) return false;
  bool idle = true;
  for_limits([&](const JointLimits& limits, bool slides, int memory) {
    if (!idle) return;
    const Place x = place(v, slides);
    idle = read_record<StopMemory>(v.memory + memory).side == 0.0 && limits.within(x.at_n) &&
           limits.within(x.at_n1);
  });
  return idle;
}

Stop Resistance::stop_of(const View& v, const JointLimits& limits, bool slides, const Place& c,
                         int memory) const {
  CoordinateStep step{.at_n = c.at_n, .at_n1 = c.at_n1, .dt = v.step.context.dt};
  if (step.dt != 0.0) {
    const bool link = kind_ == Kind::link;
    const BodyStep a_n = start_of(v.step.a), b_n = start_of(v.step.b);
    step.rate_n = slides ? slide_rate(v.q_n, a_n, b_n, link) : v.angle[0].rate_at_n1(a_n, b_n);
    step.rate_n1 = slides ? slide_rate(v.q_n1, v.step.a, v.step.b, link)
                          : v.angle[0].rate_at_n1(v.step.a, v.step.b);
  }
  if (!is_load_step(v.step.context)) return {limits, v.memory + memory, step};
  // The force is that of the end of the step alone, which may be at the other stop than its start.
  static constexpr std::array<double, kNumbersOf<StopMemory>> kOpen{};
  const double nearer = c.at_n1 - limits.lower <= limits.upper - c.at_n1 ? 1.0 : -1.0;
  const bool closed = read_record<StopMemory>(v.memory + memory).side == nearer;
  if (!closed) step.at_n = std::clamp(c.at_n1, limits.lower, limits.upper);
  return {limits, closed ? v.memory + memory : kOpen.data(), step};
}

Resistance::Motion Resistance::motion(const View& v, bool tangents) const {
  Motion m;
  const PairStep& step = v.step;
  const auto add = [&]() -> Coordinate& {
    Coordinate& c = m.of[m.count++];
    c.on_a.setZero();
    c.on_b.setZero();
    c.by_a.setZero();
    c.by_b.setZero();
    c.D_a.setZero();
    c.D_b.setZero();
    c.by_lambda.setZero();
    return c;
  };
  const auto add_angle = [&](int i) -> Coordinate& {
    Coordinate& c = add();
    const FreeAngle& angle = v.angle[static_cast<std::size_t>(i)];
    AngleStep& s = m.angle[i];
    s = angle_step(angle, step.a, step.b, v.angle_n[static_cast<std::size_t>(i)],
                   step.context.conserving);
    c.angle = i;
    c.at_n = s.at_n;
    c.at_n1 = s.at_n1;
    c.on_a.tail<3>() = -s.mu;
    c.on_b.tail<3>() = s.mu;
    const Vec3 gradient = angle_gradient(angle, step);
    c.by_a.tail<3>() = -gradient;
    c.by_b.tail<3>() = gradient;
    return c;
  };
  if (kind_ == Kind::link) {
    m.slide = m.count;
    Coordinate& c = add();
    const LinkLength length(v.q_n, v.q_n1);
    c.at_n = length.at_n;
    c.at_n1 = length.at_n1;
    LinkLength::row(length.n, v.q_alpha, PairRows{c.on_a.data(), c.on_b.data()});
    LinkLength::row(length.e, v.q_n1, PairRows{c.by_a.data(), c.by_b.data()});
  }
  if (kind_ == Kind::prismatic || kind_ == Kind::cylindrical) {
    m.slide = m.count;
    Coordinate& c = add();
    const PointInPlane along{kZ};
    static_cast<Place&>(c) = place(v, true);
    along.gradient(v.q_alpha, 0, PairRows{c.on_a.data(), c.on_b.data()});
    if (tangents) along.gradient(v.q_n1, 0, PairRows{c.by_a.data(), c.by_b.data()});
  }
  if (kind_ == Kind::revolute || kind_ == Kind::cylindrical) {
    m.turn = m.count;
    Coordinate& c = add_angle(0);
    if (kind_ == Kind::cylindrical && data_.friction) c.lever = data_.friction->radius;
  }
  if (kind_ == Kind::universal)
    for (int i = 0; i < 2; ++i) add_angle(i);
  if (kind_ == Kind::spherical) {
    const Mat3 T_a = cayley_tangent(step.a.theta), T_b = cayley_tangent(step.b.theta);
    for (int i = 0; i < 3; ++i) {
      Coordinate& c = add();
      c.at_n1 = step.b.theta[i] - step.a.theta[i];
      c.on_a.tail<3>() = -Vec3::Unit(i);
      c.on_b.tail<3>() = Vec3::Unit(i);
      c.by_a.tail<3>() = -T_a.col(i);
      c.by_b.tail<3>() = T_b.col(i);
    }
  }
  return m;
}

/// @eq{joint-friction-limit}
Resistance::Slip Resistance::slip(const View& v, int pin) const {
  const JointFriction& f = *data_.friction;
  Slip s;
  s.force = f.constant;
  const double* l = v.step.lambda;
  if (!l || f.mu == 0.0) return s;
  const double across = f.length > 0.0 ? 2.0 / f.length : 0.0;
  const auto add_pair = [&](int row, double factor) {  // factor √(λ² + λ'²)
    const double size = std::hypot(l[row], l[row + 1]);
    s.force += factor * size;
    if (!(size > 0.0)) return;
    s.by_lambda[row] += factor * l[row] / size;
    s.by_lambda[row + 1] += factor * l[row + 1] / size;
  };
  const Vec3 F(l[0], l[1], l[2]);
  const auto add_pin = [&](const Vec3& d, const Vec3& d_n1, Vec3& by_theta) {
    const double along = d.dot(F), square = std::max(0.0, F.squaredNorm() - along * along);
    const double sign = along < 0.0 ? -1.0 : 1.0;
    const double radial = f.mu * f.radius, axial = f.mu * f.face_radius * sign;
    s.force += radial * std::sqrt(square) + axial * along;
    s.by_lambda.head<3>() += radial * over_root(F - along * d, square) + axial * d;
    const Vec3 by_d = radial * over_root(-along * F, square) + axial * F;
    by_theta = v.step.a.alpha_f * d_n1.cross(by_d);  // D d_α = −α ẑ_{n+1}
  };
  switch (kind_) {
    case Kind::revolute:
      add_pin(v.q_alpha.R_a.col(kZ), v.q_n1.R_a.col(kZ), s.by_theta_a);
      add_pair(3, f.mu * f.radius * across);
      break;
    case Kind::universal: {
      if (pin == 0)
        add_pin(v.q_alpha.R_a.col(kX), v.q_n1.R_a.col(kX), s.by_theta_a);
      else
        add_pin(v.q_alpha.R_b.col(kY), v.q_n1.R_b.col(kY), s.by_theta_b);
      const double bent = f.mu * f.radius * across;
      s.force += bent * std::abs(l[3]);
      s.by_lambda[3] += bent * (l[3] < 0.0 ? -1.0 : 1.0);
      break;
    }
    case Kind::spherical:
      s.force += f.mu * f.radius * F.norm();
      s.by_lambda.head<3>() += f.mu * f.radius * over_root(F, F.squaredNorm());
      break;
    case Kind::prismatic:
      if (f.radius > 0.0) {
        s.force += f.mu / f.radius * std::abs(l[4]);
        s.by_lambda[4] += f.mu / f.radius * (l[4] < 0.0 ? -1.0 : 1.0);
      }
      [[fallthrough]];
    case Kind::cylindrical:
      add_pair(0, f.mu);
      add_pair(2, f.mu * across);
      break;
    case Kind::link:
      break;  // no normal force
  }
  return s;
}

/// @eq{contact-bristle}
Resistance::Bristle Resistance::bristle(const View& v, const Motion& m) const {
  const JointFriction& f = *data_.friction;
  Bristle b;
  const auto memory = read_record<BristleMemory>(v.memory);
  const Vec3 kept(memory.bristle);
  b.at_n = kind_ == Kind::spherical ? Vec3(v.step.a.Lambda_n * kept) : kept;
  if (v.step.context.dt == 0.0) {  // an instant: as left by the last step
    b.acting = b.at_n1 = b.at_n;
    b.slips = memory.slips != 0.0;
    return b;
  }
  for (int i = 0; i < m.count; ++i) b.moved[i] = m.of[i].lever * (m.of[i].at_n1 - m.of[i].at_n);
  const StepContext& c = v.step.context;
  const double rate = is_load_step(c) ? 0.0 : 1.0 / std::abs(c.dt);
  const double weight = v.step.a.alpha_f + f.damping * rate / f.stiffness;
  for (int k = 0; k < cones(); ++k) {
    const Vec3 of_cone = cones() == 1 ? Vec3(Vec3::Ones()) : Vec3(Vec3::Unit(k));
    const Vec3 at_n = b.at_n.cwiseProduct(of_cone), moved = b.moved.cwiseProduct(of_cone);
    Cone<double> cone;
    cone.radius = slip(v, k).force / f.stiffness;
    const auto nearest = [&](const Vec3& s) {
      return contact::value(cone.nearest(contact::v3(s)));
    };
    const Vec3 start = nearest(at_n);  // the cone may have shrunk
    const Vec3 D_start = cone.outside(at_n) ? Vec3(at_n.normalized()) : Vec3::Zero();
    const Vec3 middle = start + weight * moved;
    b.acting += nearest(middle);
    b.at_n1 += nearest(start + moved);
    b.slips = b.slips || cone.outside(start + moved);
    if (!cone.outside(middle)) {
      b.D_acting.diagonal() += weight * of_cone;
      b.D_radius += D_start;
      continue;
    }
    const double size = middle.norm();
    const Vec3 t = middle / size;
    Mat3 turned = -cone.radius / size * t * t.transpose();
    turned.diagonal() += cone.radius / size * of_cone;
    b.D_acting += weight * turned;
    b.D_radius += t + turned * D_start;
  }
  return b;
}

Vec3 Resistance::rates(const View& v, const Configuration& q, const BodyStep& a,
                       const BodyStep& b) const {
  if (kind_ == Kind::spherical) return b.Lambda_n1 * b.W_n1 - a.Lambda_n1 * a.W_n1;
  Vec3 rate = Vec3::Zero();
  int count = 0;
  if (kind_ == Kind::prismatic || kind_ == Kind::cylindrical)
    rate[count++] = slide_rate(q, a, b, false);
  if (kind_ == Kind::prismatic) return rate;
  const double lever = kind_ == Kind::cylindrical ? data_.friction->radius : 1.0;
  rate[count++] = lever * v.angle[0].rate_at_n1(a, b);
  if (kind_ == Kind::universal) rate[count++] = v.angle[1].rate_at_n1(a, b);
  return rate;
}

/// @eq{joint-friction-turn}
Resistance::Bristle Resistance::left_bristle(const View& v, const Motion& m) const {
  Bristle b = bristle(v, m);
  const StepContext& c = v.step.context;
  if (!b.slips || !(c.dt > 0.0) || is_load_step(c)) return b;
  const JointFriction& f = *data_.friction;
  const Vec3 before = rates(v, v.q_n, start_of(v.step.a), start_of(v.step.b));
  Vec3 rate = rates(v, v.q_n1, v.step.a, v.step.b);
  // Like the bristle, in the axes of a at t_n.
  if (kind_ == Kind::spherical) rate = v.step.a.Lambda_n * (v.step.a.Lambda_n1.transpose() * rate);
  const Vec3 change = rate - before;
  const auto about = [&](const Vec3& axis) { return inertia_about(axis, v.step.a, v.step.b); };
  Vec3 inertia = Vec3::Constant(f.mass);
  if (kind_ == Kind::revolute) inertia[0] = about(v.q_n1.R_a.col(kZ));
  if (kind_ == Kind::universal) inertia = {about(v.q_n1.R_a.col(kX)), about(v.q_n1.R_b.col(kY)), 0};
  if (kind_ == Kind::spherical) inertia.setConstant(about(change.normalized()));
  if (kind_ == Kind::cylindrical && f.radius > 0.0)  // inertia at the sleeve's surface [kg]
    inertia[1] = about(v.q_n1.R_a.col(kZ)) / (f.radius * f.radius);
  const Vec3 held = b.acting + inertia.cwiseProduct(change) / (f.stiffness * c.dt);
  for (int k = 0; k < cones(); ++k) {
    const Vec3 of_cone = cones() == 1 ? Vec3(Vec3::Ones()) : Vec3(Vec3::Unit(k));
    const Vec3 old = b.at_n1.cwiseProduct(of_cone), wanted = held.cwiseProduct(of_cone);
    const double limit = slip(v, k).force / f.stiffness;
    if (!(rate.dot(old) < 0.0) || old.norm() < (1.0 - kOnCone) * limit) continue;
    const double size = wanted.norm(), most = std::min(old.norm(), limit);
    b.at_n1 += (size > most ? most / size : 1.0) * wanted - old;
    if (cones() == 1) b.slips = size > most;
  }
  return b;
}

void Resistance::add(const View& v, PairTerms& t) const {
  if (idle(v)) return;
  const PairStep& step = v.step;
  const bool tangents = step.context.tangents;
  const double alpha_f = step.a.alpha_f;
  Motion m = motion(v, tangents);
  if (data_.friction) {
    const JointFriction& f = *data_.friction;
    const Bristle b = bristle(v, m);
    for (int i = 0; i < m.count; ++i) {
      Coordinate& c = m.of[i];
      const Slip s = slip(v, cone_of(i));
      c.force -= f.stiffness * c.lever * b.acting[i];
      if (!tangents) continue;
      for (int j = 0; j < m.count; ++j) {
        const double k = f.stiffness * c.lever * b.D_acting(i, j) * m.of[j].lever;
        c.D_a -= k * m.of[j].by_a;
        c.D_b -= k * m.of[j].by_b;
      }
      c.D_a.tail<3>() -= c.lever * b.D_radius[i] * s.by_theta_a;
      c.D_b.tail<3>() -= c.lever * b.D_radius[i] * s.by_theta_b;
      c.by_lambda -= c.lever * b.D_radius[i] * s.by_lambda;
    }
  }
  for_limits([&](const JointLimits& limits, bool slides, int memory) {
    Coordinate& c = m.of[slides ? m.slide : m.turn];
    const Stop stop = stop_of(v, limits, slides, c, memory);
    const auto force = stop_force(stop, step);
    c.force += stop.sign() * force.value;
    c.D_a += force.slope * c.by_a;
    c.D_b += force.slope * c.by_b;
  });
  if (step.context.dt == 0.0)  // an instant: as left by the last step
    for_ends([&](const JointLimits& limits, bool slides, double sign, double, int entry) {
      const double force = sign * read_record<UnilateralMemory>(v.memory + entry).force;
      m.of[slides ? m.slide : m.turn].force += (slides ? 1.0 : limits.radius) * force;
    });
  for (int i = 0; i < m.count; ++i) {
    const Coordinate& c = m.of[i];
    t.wrench_a += c.force * c.on_a;
    t.wrench_b += c.force * c.on_b;
    if (!tangents) continue;
    t.D_aa += c.on_a * c.D_a.transpose();
    t.D_ab += c.on_a * c.D_b.transpose();
    t.D_ba += c.on_b * c.D_a.transpose();
    t.D_bb += c.on_b * c.D_b.transpose();
    t.B_a += c.on_a * c.by_lambda.transpose();
    t.B_b += c.on_b * c.by_lambda.transpose();
    if (i == m.slide && kind_ == Kind::link)
      LinkLength(v.q_n, v.q_n1).add_wrench_tangent(v.q_alpha, v.q_n1, alpha_f, c.force, t);
    else if (i == m.slide)
      PointInPlane{kZ}.add_wrench_tangent(v.q_alpha, v.q_n1, alpha_f, &c.force, t);
    if (c.angle >= 0) {
      const AngleStep& angle = m.angle[c.angle];
      t.D_aa.bottomRightCorner<3, 3>() -= c.force * angle.D_mu_a;
      t.D_ab.bottomRightCorner<3, 3>() -= c.force * angle.D_mu_b;
      t.D_ba.bottomRightCorner<3, 3>() += c.force * angle.D_mu_a;
      t.D_bb.bottomRightCorner<3, 3>() += c.force * angle.D_mu_b;
    }
  }
}

Work Resistance::work(const View& v) const {
  Work w;
  if (idle(v)) return w;
  const Motion m = motion(v, false);
  const StepContext& context = v.step.context;
  if (data_.friction) {
    const Bristle b = left_bristle(v, m);
    const double k = data_.friction->stiffness;
    w.stored += 0.5 * k * b.at_n1.squaredNorm();
    if (context.dt != 0.0)
      w.dissipated += std::max(0.0, k * b.acting.dot(b.moved) -
                                        0.5 * k * (b.at_n1.squaredNorm() - b.at_n.squaredNorm()));
  }
  for_limits([&](const JointLimits& limits, bool slides, int memory) {
    const Coordinate& c = m.of[slides ? m.slide : m.turn];
    const Stop stop = stop_of(v, limits, slides, c, memory);
    w.stored += stop.law_after().energy(stop.gap_n1());
    if (context.dt == 0.0 || !std::isfinite(stop.gap_n()) || !stop.touched()) return;
    const double force = stop_force(stop, v.step).value, before = stop.law().energy(stop.gap_n());
    const double after = stop.law().energy(stop.gap_n1());
    const double released = after - stop.law_after().energy(stop.gap_n1());
    const bool exact = stop.end_share() == 0.0 && v.step.a.alpha_f == 0.5;
    w.dissipated += released;
    if (!exact)
      w.dissipated += std::max(0.0, force * (stop.gap_n() - stop.gap_n1()) - (after - before));
  });
  return w;
}

double Resistance::clearance(const View& v) const {
  double least = std::numeric_limits<double>::infinity();
  for_limits([&](const JointLimits& limits, bool slides, int memory) {
    const Place c = place(v, slides);
    const Stop stop = stop_of(v, limits, slides, c, memory);
    const contact::NormalLaw& law = stop.law();
    least = std::min(least, (stop.gap_n1() - law.floor()) / law.band());
    const double far = stop.sign() > 0.0 ? limits.upper - c.at_n1 : c.at_n1 - limits.lower;
    least = std::min(least, (far + limits.law.tolerance) / limits.law.tolerance);
  });
  return least;
}

void Resistance::initialize(double* memory) const {
  std::fill(memory, memory + memory_size(), 0.0);
}

void Resistance::commit(const View& v, double* memory) const {
  if (data_.friction) {
    const Bristle b = left_bristle(v, motion(v, false));
    BristleMemory after;
    set(after.bristle,
        kind_ == Kind::spherical ? Vec3(v.step.a.Lambda_n.transpose() * b.at_n1) : b.at_n1);
    after.slips = b.slips ? 1.0 : 0.0;
    write_record(after, memory);
  }
  for_limits([&](const JointLimits& limits, bool slides, int at) {
    const Stop stop = stop_of(v, limits, slides, place(v, slides), at);
    stop.remember(stop_force(stop, v.step).value, memory + at);
  });
}

/// @eq{joint-stop-exit}
void Resistance::impacts(const View& v, std::vector<Impact>& list) const {
  for_limits([&](const JointLimits& limits, bool slides, int at) {
    const Stop stop = stop_of(v, limits, slides, place(v, slides), at);
    if (!stop.jumps() && !stop.carries()) return;
    const Motion m = motion(v, true);
    const Coordinate& c = m.of[slides ? m.slide : m.turn];
    Impact impact;
    impact.on_a = stop.sign() * c.by_a;
    impact.on_b = stop.sign() * c.by_b;
    impact.wanted = stop.jumps() ? stop.exit_rate() : std::numeric_limits<double>::quiet_NaN();
    impact.given = v.step.context.dt * stop_force(stop, v.step).value;
    list.push_back(impact);
  });
}

}  // namespace polhode
