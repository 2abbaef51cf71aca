// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/math/euler_angles.hpp>
#include <polhode/math/helical_axis.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/simulation/body_columns.hpp>

namespace polhode {

namespace {

/// A body's motion with its accelerations relative to another one, in that one's axes.
struct SeenMotion {
  Vec3 position, velocity, acceleration;  ///< Of the probe's point.
  Mat3 R;
  Vec3 omega, alpha;
};

SeenMotion in_the_world(const Simulation& simulation, int body, const Vec3& Z) {
  if (body == kGround)
    return {Z, Vec3::Zero(), Vec3::Zero(), Mat3::Identity(), Vec3::Zero(), Vec3::Zero()};
  const Simulation::PointMotion p = simulation.point(body, Z);
  const BodyMotion m = simulation.body(body);
  return {p.position, p.velocity, p.acceleration,
          m.Lambda(), m.omega(),  simulation.angular_acceleration(body)};
}

/// @eq{relative-motion}
SeenMotion seen(const SeenMotion& x, const SeenMotion& from) {
  const Mat3 T = from.R.transpose();
  const Vec3 r = x.position - from.position, v = x.velocity - from.velocity;
  const Vec3 drag = v - from.omega.cross(r);  // velocity in the rotating frame
  const Vec3 a = x.acceleration - from.acceleration - from.alpha.cross(r) -
                 from.omega.cross(from.omega.cross(r)) - 2.0 * from.omega.cross(drag);
  const Vec3 omega = x.omega - from.omega;
  return {T * r,   T * drag,  T * a,
          T * x.R, T * omega, T * (x.alpha - from.alpha - from.omega.cross(omega))};
}

/// Origin of the body's coordinates, to which its shape and points refer.
Vec3 origin_of(const Simulation& simulation, int body) {
  return body == kGround ? Vec3::Zero()
                         : Vec3(-simulation.model().bodies[static_cast<std::size_t>(body)].com);
}

void add_vector(std::vector<double>& list, const Vec3& x) {
  list.insert(list.end(), x.begin(), x.end());
}

/// Pose of a body in another one at the start, as described: x = R Z + d in coordinates of both.
std::pair<Mat3, Vec3> start_place(const Model& model, int body, int from) {
  const auto place = [&](int k) -> std::pair<Mat3, Vec3> {
    if (k == kGround) return {Mat3::Identity(), Vec3::Zero()};
    const BodySpec& b = model.bodies[static_cast<std::size_t>(k)];
    const Mat3 R = b.orientation.normalized().toRotationMatrix();
    return {R, b.position - R * b.com};
  };
  const auto [R, d] = place(body);
  const auto [R_0, d_0] = place(from);
  return {R_0.transpose() * R, R_0.transpose() * (d - d_0)};
}

}  // namespace

std::vector<std::string> body_columns(const ProbeSpec& spec) {
  std::vector<std::string> list;
  const auto three = [&](const std::string& prefix, const std::string& unit) {
    for (const char* axis : {"x", "y", "z"})
      list.push_back(format("{}{} [{}]", prefix, axis, unit));
  };
  three("", "m");
  three("v", "m/s");
  three("a", "m/s^2");
  if (spec.rotation == "quaternion") {
    for (const char* name : {"qw", "qx", "qy", "qz"}) list.push_back(format("{} [-]", name));
  } else if (spec.rotation == "vector") {
    three("theta", "rad");
  } else if (spec.rotation == "matrix") {
    for (int i = 0; i < 9; ++i) list.push_back(format("R{}{} [-]", "xyz"[i / 3], "xyz"[i % 3]));
  } else if (!spec.rotation.empty()) {
    for (int i = 0; i < 3; ++i)
      list.push_back(format("euler{}{} [rad]", i + 1, spec.rotation[static_cast<std::size_t>(i)]));
  }
  if (spec.angular) {
    three("w", "rad/s");
    three("alpha", "rad/s^2");
  }
  if (!spec.helical.empty()) {
    const bool finite = spec.helical == "finite";
    three("axis", "-");
    three("point", "m");
    list.push_back(finite ? "turn [rad]" : "turn [rad/s]");
    list.push_back(finite ? "slide [m]" : "slide [m/s]");
  }
  return list;
}

std::vector<double> body_numbers(const Simulation& simulation, const ProbeSpec& spec, int body) {
  const int from = spec.seen_from;
  const SeenMotion frame = in_the_world(simulation, from, origin_of(simulation, from));
  const SeenMotion m = seen(in_the_world(simulation, body, spec.point), frame);
  std::vector<double> row;
  for (const Vec3& x : {m.position, m.velocity, m.acceleration}) add_vector(row, x);
  if (spec.rotation == "quaternion") {
    const Quat q = shown(Quat(m.R).normalized());
    row.insert(row.end(), {q.w(), q.x(), q.y(), q.z()});
  } else if (spec.rotation == "vector") {
    add_vector(row, rotation_vector(Quat(m.R).normalized()));
  } else if (spec.rotation == "matrix") {
    for (int i = 0; i < 9; ++i) row.push_back(m.R(i / 3, i % 3));
  } else if (!spec.rotation.empty()) {
    for (const double angle : euler_angles(m.R, spec.rotation)) row.push_back(angle);
  }
  if (spec.angular) {
    // In the body's axes α has the components of the rate of ω there. @eq{relative-motion}
    const Mat3 to_axes = spec.axes == "body" ? m.R.transpose() : Mat3::Identity().eval();
    add_vector(row, to_axes * m.omega);
    add_vector(row, to_axes * m.alpha);
  }
  if (spec.helical.empty()) return row;
  HelicalAxis axis;
  if (spec.helical == "finite") {
    const SeenMotion now = seen(in_the_world(simulation, body, origin_of(simulation, body)), frame);
    const auto [R_0, d_0] = start_place(simulation.model(), body, from);
    const Mat3 R = now.R * R_0.transpose();
    axis = finite_helical_axis(R, now.position - R * d_0);
  } else {
    axis = helical_axis(m.position, m.velocity, m.omega);
  }
  add_vector(row, axis.direction);
  add_vector(row, axis.point);
  row.insert(row.end(), {axis.turn, axis.slide});
  return row;
}

}  // namespace polhode
