// SPDX-License-Identifier: Apache-2.0
// Coordinates of the joints of a tree, their axes and values at the start.
#include <algorithm>
#include <cmath>

#include <polhode/dynamics/body_motion.hpp>
#include <polhode/io/exporters/export_tree.hpp>

namespace polhode::io {

namespace {

/// Difference of rotations below which the joint's axes coincide [-].
constexpr double kSameAxes = 1e-6;

/// A joint's point and axes on one of its bodies.
struct JointSide {
  Vec3 p, v, w;  ///< World: point [m], its velocity, angular velocity of the body.
  Mat3 F;        ///< Axes of the joint, world.
};

JointSide side_of(const Simulation& simulation, int body, const Vec3& Z, const Mat3& R) {
  if (body == kGround) return {Z, Vec3::Zero(), Vec3::Zero(), R};
  const BodyMotion motion = simulation.body(body);
  const Mat3 A = motion.Lambda();
  const Vec3 w = motion.omega();
  return {motion.r + A * Z, motion.v + w.cross(A * Z), w, A * R};
}

Mat3 turn_about(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

Vec3 in_own_coordinates(const Model& model, int body, const Vec3& Z) {
  return body == kGround ? Z : model.bodies[static_cast<std::size_t>(body)].com + Z;
}

void put_coordinates(const Simulation& simulation, int body, ExportJoint& joint) {
  const Model& model = simulation.model();
  const JointSpec& spec = model.joints[static_cast<std::size_t>(joint.spec)];
  const JointSide a = side_of(simulation, spec.a, spec.Z_a, spec.R_a),
                  b = side_of(simulation, spec.b, spec.Z_b, spec.R_b);
  const Mat3 M = a.F.transpose() * b.F;
  const Vec3 between = b.p - a.p;
  const std::string& type = joint.type;
  Mat3 turn =
      type == "spherical" || (M - Mat3::Identity()).norm() > kSameAxes ? M : Mat3::Identity();
  Mat3 zero = turn;
  Vec3 slid = Vec3::Zero();  // In the axes of the joint on a.
  const auto slide = [&](int k) {
    ExportCoordinate q;
    q.key = std::string(1, "xyz"[k]);
    q.axis = spec.R_a.col(k);
    q.start = slid[k] = a.F.col(k).dot(between);
    q.rate = a.F.col(k).dot(b.v - a.v) + a.w.cross(a.F.col(k)).dot(between);
    joint.coordinates.push_back(q);
  };
  const auto angle = [&](const char* key, const Vec3& own_axis, const Vec3& world, double start) {
    ExportCoordinate q;
    q.key = key;
    q.turns = true;
    q.axis = own_axis;
    q.start = start;
    q.rate = world.dot(b.w - a.w);
    joint.coordinates.push_back(q);
  };
  if (type == "planar")
    for (const int k : {0, 1}) slide(k);
  if (type == "prismatic" || type == "cylindrical") slide(2);
  if (type == "revolute" || type == "cylindrical" || type == "planar") {
    const double start = std::atan2(M(1, 0), M(0, 0));
    angle("rz", spec.R_a.col(2), a.F.col(2), start);
    turn = turn_about(Vec3::UnitZ(), start);
    zero.setIdentity();
  } else if (type == "universal") {
    const double q1 = std::atan2(M(2, 1), M(1, 1)), q2 = std::atan2(M(0, 2), M(0, 0));
    angle("rx", spec.R_a.col(0), a.F.col(0), q1);
    angle("ry", spec.R_b.col(1), b.F.col(1), q2);
    turn = turn_about(Vec3::UnitX(), q1) * turn_about(Vec3::UnitY(), q2);
    zero.setIdentity();
  }
  const Mat3 start = spec.R_a * turn * spec.R_b.transpose();
  joint.at_zero = spec.R_a * zero * spec.R_b.transpose();
  joint.at_start = start;
  joint.slid = spec.R_a * slid;
  const int other = joint.reversed ? spec.b : spec.a;
  joint.on_parent = in_own_coordinates(model, other, joint.reversed ? spec.Z_b : spec.Z_a);
  joint.on_child = in_own_coordinates(model, body, joint.reversed ? spec.Z_a : spec.Z_b);
  // So far the axes are those on a, and for the second angle of a universal joint those on b.
  for (ExportCoordinate& q : joint.coordinates)
    if (const bool on_b = q.key == "ry"; on_b == joint.reversed)
      q.axis = joint.reversed ? Vec3(start * q.axis) : Vec3(start.transpose() * q.axis);
  if (joint.reversed) {
    joint.at_zero.transposeInPlace();
    joint.at_start.transposeInPlace();
    joint.slid = -(joint.at_start * joint.slid);
    for (ExportCoordinate& q : joint.coordinates) q.axis = -q.axis;
    std::reverse(joint.coordinates.begin(), joint.coordinates.end());
  }
  // An axis of rotation before a displacement is where the parent has it.
  const Vec3 parents = joint.on_child - joint.at_start.transpose() * joint.slid;
  const bool before = joint.reversed && !slid.isZero(0.0);
  for (ExportCoordinate& q : joint.coordinates) q.point = before ? parents : joint.on_child;
}

}  // namespace polhode::io
