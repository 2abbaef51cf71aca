// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/inerter_mass.hpp>

#include <polhode/joints/joint.hpp>
#include <polhode/joints/prismatic_joint.hpp>
#include <polhode/loads/coordinate_motion.hpp>

namespace polhode {

namespace {

/// Slide on the ground of an inerter's mass.
struct InerterSlide : Joint {
  static constexpr const char* kKind = "inerter_slide";
  using Joint::Joint;
};

}  // namespace

void add_inerter_mass(const LoadSpec& load, const Model& model, double size, System& system,
                      LoadDescription& d) {
  const JointSpec& joint = model.joints[static_cast<std::size_t>(model.joint_index(load.joint))];
  const auto at_start = [&](int body, int number) {
    if (number == kGround) return BodyStep::ground(1.0);
    const BodySpec& of = model.bodies[static_cast<std::size_t>(body)];
    const Quat q = of.orientation.normalized();
    return BodyStep::at_instant(of.position, q.toRotationMatrix(), of.velocity,
                                q.conjugate() * of.angular_velocity);
  };
  const BodyStep a = at_start(joint.a, d.bodies.a), b = at_start(joint.b, d.bodies.b);
  const JointCoordinate q = d.coordinate();
  // Displacement of the mass by the coordinate. It slides across gravity, which does no work on it.
  const double length = d.angle ? size : 1.0;
  const double mass = d.value("inertance", 0.0) / (length * length);
  const Vec3 across = system.gravity().isZero(0.0) ? Vec3::UnitX().eval()
                                                   : system.gravity().unitOrthogonal().eval();
  BodyMotion start;
  start.r = d.bodies.b == kGround ? a.r_n1 : b.r_n1;
  start.v = length * coordinate_rate_at_n1(q, a, b) * across;
  const std::string name = load.name + " mass";
  const Participants pair{
      kGround,
      system.add_body(
          {.name = name, .mass = mass, .inertia = mass * size * size * Mat3::Identity()}, start)};
  JointFrames frames;
  frames.Z_a = start.r;
  frames.R_a = frames.R_b = Quat::FromTwoVectors(Vec3::UnitZ(), across).toRotationMatrix();
  const InerterSlide& slide =
      system.group<InerterSlide>().add(name, "prismatic", pair, prismatic_joint(frames, {}));
  d.coupled = {{q, d.bodies, 1.0, coordinate_at_n1(q, a, b, 0.0)},
               {slide.free_displacement("").value(), pair, -1.0 / length, 0.0}};
}

}  // namespace polhode
