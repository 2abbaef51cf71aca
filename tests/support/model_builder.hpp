// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode::test {

/// Constant function of time.
class Constant final : public TimeFunction {
 public:
  explicit Constant(double value) : value_(value) {}
  [[nodiscard]] double operator()(double) const override { return value_; }
  [[nodiscard]] bool is_constant() const override { return true; }

 private:
  double value_;
};

/// Builder of models from ground coordinates: bodies where they are at the start, joints by a point
/// and an axis or a frame.
class ModelBuilder {
 public:
  Model model;

  /// @param inertia  Principal moments about the centre of mass, along the body axes [kg m²].
  int body(const std::string& name, const Vec3& position, double mass, const Vec3& inertia,
           const Quat& orientation = Quat::Identity()) {
    BodySpec b;
    b.name = name;
    b.position = position;
    b.mass = mass;
    b.inertia = inertia.asDiagonal();
    b.orientation = orientation;
    model.bodies.push_back(b);
    return static_cast<int>(model.bodies.size()) - 1;
  }
  int point_mass(const std::string& name, const Vec3& position, double mass) {
    const int i = body(name, position, mass, Vec3::Zero());
    model.bodies.back().point_mass = true;
    return i;
  }

  /// Velocity of the body as part of a whole that turns with omega about a fixed point.
  void turning(int body, const Vec3& omega, const Vec3& about = Vec3::Zero()) {
    BodySpec& b = at(body);
    b.velocity = omega.cross(b.position - about);
    b.angular_velocity = omega;
  }

  /// A joint at a world point whose axes at the start, on both sides, are the columns of R.
  JointSpec& joint_along(const std::string& name, const std::string& type, int a, int b,
                         const Vec3& point, const Mat3& R) {
    JointSpec j;
    j.name = name;
    j.type = type;
    j.a = a;
    j.b = b;
    place(a, point, R, j.Z_a, j.R_a);
    place(b, point, R, j.Z_b, j.R_b);
    model.joints.push_back(j);
    return model.joints.back();
  }
  JointSpec& joint(const std::string& name, const std::string& type, int a, int b,
                   const Vec3& point, const Vec3& axis = Vec3::UnitZ()) {
    return joint_along(name, type, a, b, point, axes_about(axis));
  }
  /// A rod without mass between two world points.
  void distance(const std::string& name, int a, const Vec3& at_a, int b, const Vec3& at_b) {
    joint_along(name, "distance", a, b, at_a, Mat3::Identity());
    Mat3 unused;
    place(b, at_b, Mat3::Identity(), model.joints.back().Z_b, unused);
  }

  /// A spring and damper between two world points.
  void spring(const std::string& name, int a, const Vec3& at_a, int b, const Vec3& at_b,
              const std::map<std::string, double>& parameters) {
    LoadSpec load;
    load.name = name;
    load.type = "spring_damper";
    load.a = a;
    load.b = b;
    Mat3 unused;
    place(a, at_a, Mat3::Identity(), load.Z_a, unused);
    place(b, at_b, Mat3::Identity(), load.Z_b, unused);
    load.parameters = parameters;
    model.loads.push_back(load);
  }
  void torsional_spring(const std::string& name, const std::string& joint,
                        const std::map<std::string, double>& parameters) {
    LoadSpec load;
    load.name = name;
    load.type = "torsional_spring";
    load.joint = joint;
    load.parameters = parameters;
    model.loads.push_back(load);
  }
  /// A constant moment on a body, world axes.
  void moment(const std::string& name, int b, const Vec3& value) {
    LoadSpec load;
    load.name = name;
    load.type = "moment";
    load.b = b;
    load.vector =
        TimeVector{std::make_shared<Constant>(value[0]), std::make_shared<Constant>(value[1]),
                   std::make_shared<Constant>(value[2])};
    model.loads.push_back(load);
  }

  [[nodiscard]] BodySpec& at(int body) { return model.bodies[static_cast<std::size_t>(body)]; }

  /// Right-handed axes whose third is the one given.
  [[nodiscard]] static Mat3 axes_about(const Vec3& axis) {
    return Quat::FromTwoVectors(Vec3::UnitZ(), axis).toRotationMatrix();
  }

 private:
  void place(int body, const Vec3& point, const Mat3& R, Vec3& Z, Mat3& axes) {
    if (body == kGround) {
      Z = point;
      axes = R;
      return;
    }
    const Mat3 to_body = at(body).orientation.toRotationMatrix().transpose();
    Z = to_body * (point - at(body).position);
    axes = to_body * R;
  }
};

}  // namespace polhode::test
