// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/time_jet.hpp>
#include <polhode/dynamics/load_step.hpp>
#include <polhode/joints/moving_frame.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

namespace {

/// (w, x, y, z), each a number or a TimeJet.
template <class T>
using Quaternion = std::array<T, 4>;

template <class T>
Quaternion<T> product(const Quaternion<T>& p, const Quaternion<T>& q) {
  return {p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
          p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
          p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
          p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]};
}

/// cos(√s/2) and sin(√s/2)/√s, with their first two derivatives by s.
struct HalfTurn {
  double c, c_1, c_2, f, f_1, f_2;
};

HalfTurn half_turn(double s) {
  HalfTurn h{};
  if (s < 1.0) {
    // f = Σ (−s)^k / (2^{2k+1} (2k+1)!)
    double term = 0.5;
    for (int k = 0; k < 12; ++k) {
      h.f += term * std::pow(s, k);
      if (k > 0) h.f_1 += term * k * std::pow(s, k - 1);
      if (k > 1) h.f_2 += term * k * (k - 1) * std::pow(s, k - 2);
      term *= -1.0 / (4.0 * (2.0 * k + 2.0) * (2.0 * k + 3.0));
    }
    h.c = std::cos(0.5 * std::sqrt(s));
  } else {
    const double angle = std::sqrt(s);
    h.c = std::cos(0.5 * angle);
    h.f = std::sin(0.5 * angle) / angle;
    h.f_1 = (0.5 * h.c - h.f) / (2.0 * s);
    h.f_2 = (-h.f / 8.0 - 3.0 * h.f_1) / (2.0 * s);
  }
  h.c_1 = -0.25 * h.f;
  h.c_2 = -0.25 * h.f_1;
  return h;
}

double chained(double, double f, double, double) { return f; }
TimeJet chained(const TimeJet& x, double f, double f_1, double f_2) {
  return x.through(f, f_1, f_2);
}
double value_of(double x) { return x; }
double value_of(const TimeJet& x) { return x.value; }

template <class T>
Quaternion<T> of_vector(const std::array<T, 4>& phi) {
  const T s = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2];
  const HalfTurn h = half_turn(value_of(s));
  const T c = chained(s, h.c, h.c_1, h.c_2), f = chained(s, h.f, h.f_1, h.f_2);
  return {c, f * phi[0], f * phi[1], f * phi[2]};
}

template <class T>
Quaternion<T> of_euler(const std::array<T, 4>& angles, const std::string& sequence) {
  using std::cos, std::sin;
  Quaternion<T> q{T(1.0), T(0.0), T(0.0), T(0.0)};
  for (std::size_t k = 0; k < 3; ++k) {
    const char letter = sequence[k];
    const bool turns_along = letter >= 'x';
    Quaternion<T> turn{cos(T(0.5) * angles[k]), T(0.0), T(0.0), T(0.0)};
    turn[static_cast<std::size_t>(letter - (turns_along ? 'x' : 'X')) + 1] =
        sin(T(0.5) * angles[k]);
    q = turns_along ? product(q, turn) : product(turn, q);
  }
  return q;
}

template <class T>
Quaternion<T> unit(const Quaternion<T>& q) {
  using std::sqrt;
  const T per = T(1.0) / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  return {per * q[0], per * q[1], per * q[2], per * q[3]};
}

template <class T>
Quaternion<T> quaternion(const FrameMotion& motion, const std::array<T, 4>& parameters) {
  switch (motion.rotation) {
    case FrameMotion::Rotation::vector:
      return of_vector(parameters);
    case FrameMotion::Rotation::euler:
      return of_euler(parameters, motion.sequence);
    case FrameMotion::Rotation::quaternion:
      return unit(parameters);
    case FrameMotion::Rotation::none:
      break;
  }
  return {T(1.0), T(0.0), T(0.0), T(0.0)};
}

template <class T>
std::array<std::array<T, 3>, 3> matrix(const Quaternion<T>& q) {
  const T &w = q[0], &x = q[1], &y = q[2], &z = q[3], one(1.0), two(2.0);
  return {{{one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)},
           {two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)},
           {two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)}}};
}

/// Axial vector a of a matrix: â is its antisymmetric part.
Vec3 axial(const Mat3& M) {
  return 0.5 * Vec3(M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1));
}

}  // namespace

FrameMotion::Placement FrameMotion::at(double t, double part) const {
  Placement p;
  for (int i = 0; i < 3; ++i)
    if (const auto& f = displacement[static_cast<std::size_t>(i)]) p.d[i] = part * (*f)(t);
  if (rotation == Rotation::none) return p;
  std::array<double, 4> x{};
  for (std::size_t k = 0; k < 4; ++k)
    if (parameters[k]) x[k] = (*parameters[k])(t);
  if (rotation != Rotation::quaternion)
    for (double& number : x) number *= part;
  const auto q = quaternion(*this, x);
  const auto D = matrix(q);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      p.D(i, j) = D[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  if (rotation == Rotation::quaternion && part != 1.0) p.D = exp_map(part * log_map(p.D));
  return p;
}

FrameMotion::Course FrameMotion::course(double t, TimeSide side) const {
  const auto jet = [&](const TimeFunctionPtr& f) {
    if (!f) return TimeJet();
    const TimeRates r = f->rates(t, side);
    return TimeJet(r.value, r.rate, r.second);
  };
  Course c;
  for (int i = 0; i < 3; ++i) {
    const TimeJet x = jet(displacement[static_cast<std::size_t>(i)]);
    c.d[i] = x.value;
    c.d_dot[i] = x.rate;
    c.d_ddot[i] = x.second;
  }
  if (rotation == Rotation::none) return c;
  std::array<TimeJet, 4> x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = jet(parameters[k]);
  const auto D = matrix(quaternion(*this, x));
  Mat3 D_dot, D_ddot;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const TimeJet& entry = D[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      c.D(i, j) = entry.value;
      D_dot(i, j) = entry.rate;
      D_ddot(i, j) = entry.second;
    }
  c.omega = axial(D_dot * c.D.transpose());
  c.alpha = axial(D_ddot * c.D.transpose());  // the remainder, ω̂ω̂, is symmetric
  return c;
}

std::vector<TimeFunctionPtr> FrameMotion::time_functions() const {
  std::vector<TimeFunctionPtr> list;
  for (const TimeFunctionPtr& f : displacement)
    if (f) list.push_back(f);
  for (const TimeFunctionPtr& f : parameters)
    if (f) list.push_back(f);
  return list;
}

namespace {

/// Point [m] and axes of the frame in body components of a.
struct FrameInBody {
  Vec3 Z;
  Mat3 R;
};

FrameInBody in_body(const FrameMotion::Placement& p, const JointFrames& frames) {
  return {frames.Z_a + frames.R_a * p.d, frames.R_a * p.D};
}

}  // namespace

BodyStep carried_step(const FrameMotion& motion, const JointFrames& frames, const BodyStep& a,
                      const StepContext& context) {
  const auto place = [&](const FrameMotion::Placement& p, const Vec3& r, const Mat3& Lambda,
                         Vec3& r_out, Mat3& Lambda_out) {
    const FrameInBody f = in_body(p, frames);
    Lambda_out = Lambda * f.R * frames.R_a.transpose();
    r_out = r + Lambda * f.Z - Lambda_out * frames.Z_a;
  };
  BodyStep s = a;
  s.moves = true;
  place(motion.at(function_time_n(context), load_factor_n(context)), a.r_n, a.Lambda_n, s.r_n,
        s.Lambda_n);
  place(motion.at(context.t_n1(), context.load_factor), a.r_n1, a.Lambda_n1, s.r_n1, s.Lambda_n1);
  s.u = s.r_n1 - s.r_n;
  const FrameRates rates = frame_rates(motion, frames, a, context, TimeSide::kAfter);
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, omega = omega_a + rates.omega;
  s.W_n1 = s.Lambda_n1.transpose() * omega;
  s.v_n1 = a.v_n1 + rates.v + omega.cross(s.r_n1 - a.r_n1);
  return s;
}

void move_frame(const FrameMotion& motion, const JointFrames& frames, const PairStep& step,
                Configuration& q_alpha, Configuration& q_n1) {
  const StepContext& c = step.context;
  const BodyStep& a = step.a;
  const double af = a.alpha_f;
  const FrameInBody at_n = in_body(motion.at(function_time_n(c), load_factor_n(c)), frames),
                    at_n1 = in_body(motion.at(c.t_n1(), c.load_factor), frames);
  const Vec3 z_n = a.Lambda_n * at_n.Z, z_n1 = a.Lambda_n1 * at_n1.Z;
  const Mat3 R_n = a.Lambda_n * at_n.R, R_n1 = a.Lambda_n1 * at_n1.R;
  const auto put = [](Configuration& q, const Vec3& z_a, const Mat3& R_a) {
    q.u += q.z_a - z_a;
    q.z_a = z_a;
    q.R_a = R_a;
  };
  put(q_alpha, (1.0 - af) * z_n + af * z_n1, (1.0 - af) * R_n + af * R_n1);
  put(q_n1, z_n1, R_n1);
}

FrameRates frame_rates(const FrameMotion& motion, const JointFrames& frames, const BodyStep& a,
                       const StepContext& context, TimeSide side) {
  const FrameMotion::Course course = motion.course(context.t_n1(), side);
  const Mat3 axes = a.Lambda_n1 * frames.R_a;
  const Vec3 z = a.Lambda_n1 * in_body(course, frames).Z;
  const Vec3 omega_a = a.Lambda_n1 * a.W_n1, z_dot = axes * course.d_dot;
  FrameRates r;
  r.omega = axes * course.omega;
  r.v = z_dot - r.omega.cross(z);
  r.alpha = omega_a.cross(r.omega) + axes * course.alpha;
  const Vec3 omega = omega_a + r.omega;
  r.a = omega_a.cross(omega_a.cross(z)) + 2.0 * omega_a.cross(z_dot) + axes * course.d_ddot -
        r.alpha.cross(z) - omega.cross(omega.cross(z));
  return r;
}

}  // namespace polhode
