// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/describe_load.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/rotor.hpp>
#include <polhode/model/gear_geometry.hpp>
#include <polhode/system/angle_quotient.hpp>

namespace polhode {

BodyStep start_of(const BodySpec& body) {
  return BodyStep::at_instant(body.position, body.orientation.normalized().toRotationMatrix(),
                              Vec3::Zero(), Vec3::Zero());
}

void add_function(const std::string& where, const LoadSpec& load, const LoadKind& kind,
                  LoadDescription& d) {
  const std::string key = kind.function_key();
  if (key.empty())
    throw InputError(where, format("a '{}' cannot be a function of the motion", kind.name),
                     "Use a force, moment, axial_force, rotary_motor or linear_motor");
  const bool of_point = kind.place == LoadPlace::body;
  const auto* point = std::get_if<PointFunction>(&load.of_motion);
  const auto* coordinate = std::get_if<CoordinateFunction>(&load.of_motion);
  if (of_point != (point != nullptr))
    throw InputError(format("{}.{}", where, key),
                     of_point ? "is a function of a coordinate" : "is a function of a point",
                     of_point ? "Give one of the motion of the point (PointFunction)"
                              : "Give one of the coordinate and its rate (CoordinateFunction)");
  if (point ? !point->value : !coordinate->value)
    throw InputError(format("{}.{}", where, key), "is a function without a value", "Set its value");
  if (!load.drive.empty() && load.drive != key)
    throw InputError(format("{}.{}", where, load.drive),
                     format("is prescribed, so the {} cannot be given too", key),
                     "Give one of them");
  d.of_motion = placed(load.of_motion, load.part_axes, load.body_fixed, kind.vector == "moment");
  if (!of_point) d.drive = key;
}

Mat3 rotor_inertia(const Model& model, int body, bool driven) {
  Mat3 sum = Mat3::Zero();
  for (const LoadSpec& load : model.loads) {
    if (load.solid >= 0 || load.type != Rotor::kKind || load.b != body) continue;
    if (driven && load.drive != "speed") continue;
    const Vec3 axis = load.R_b.col(2);
    sum += load.parameters.at("inertia") * axis * axis.transpose();
  }
  return sum;
}

std::vector<CoupledCoordinate> coupled_coordinates(const std::string& where, const LoadSpec& load,
                                                   const Model& model,
                                                   const std::vector<Joint>& joints) {
  std::vector<CoupledCoordinate> list;
  const auto add = [&](const std::string& name, const std::string& coordinate, double factor) {
    const auto index = static_cast<std::size_t>(model.joint_index(name));
    const Joint& joint = joints[index];
    const JointSpec& of = model.joints[index];
    CoupledCoordinate c{free_coordinate(where, {&joint, coordinate}), joint.bodies, factor};
    const auto at_start = [&](int body, int number) {
      return number == kGround ? BodyStep::ground(1.0)
                               : start_of(model.bodies[static_cast<std::size_t>(body)]);
    };
    c.near = coordinate_at_n1(c.coordinate, at_start(of.a, joint.bodies.a),
                              at_start(of.b, joint.bodies.b), 0.0);
    list.push_back(c);
  };
  add(load.joint, load.coordinate, 1.0);
  for (const CoordinateSpec& other : load.others) add(other.joint, other.coordinate, -other.factor);
  const auto offset = load.parameters.find("offset");
  if (offset == load.parameters.end() || list[0].coordinate.index() != 0) return list;
  double row = offset->second;
  for (std::size_t k = 1; k < list.size(); ++k) row -= list[k].factor * list[k].near;
  list[0].near = nearest_turn(list[0].near, row);
  return list;
}

}  // namespace polhode
