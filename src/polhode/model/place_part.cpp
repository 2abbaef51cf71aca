// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/time_sum.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/part_placement.hpp>

namespace polhode {

namespace {

using Signs = std::array<double, 3>;

Mat3 diagonal(const Signs& s) { return Vec3(s[0], s[1], s[2]).asDiagonal(); }

/// The free coordinates of a joint: x, y, z, rx, ry, rz.
std::vector<std::string> free_coordinates(const JointSpec& joint) {
  const JointKind& kind = joint_kind(joint.type);
  if (kind.takes_free_list) return joint.free;
  std::vector<std::string> found;
  for (const std::string name : {"x", "y", "z"}) {
    if (kind.free.find("T" + name) != std::string::npos) found.push_back(name);
    if (kind.free.find("R" + name) != std::string::npos) found.push_back("r" + name);
  }
  return found;
}

/// Sign of a coordinate when the joint's axes become `signs` times their mirror images: a
/// displacement is a polar, a rotation an axial vector.
double sign_of(const std::string& coordinate, const Signs& signs) {
  const double along = signs[static_cast<std::size_t>(coordinate.back() - 'x')];
  return coordinate.size() == 1 ? along : -along;
}

/// Signs that make the mirror images of a joint's axes right-handed again and preserve most of its
/// free coordinates.
Signs axis_signs(const std::vector<std::string>& free) {
  constexpr std::array<Signs, 4> choices{Signs{-1, -1, -1}, {1, -1, 1}, {1, 1, -1}, {-1, 1, 1}};
  const auto kept = [&](const Signs& s) {
    return std::count_if(free.begin(), free.end(),
                         [&](const std::string& c) { return sign_of(c, s) > 0.0; });
  };
  return *std::max_element(choices.begin(), choices.end(),
                           [&](const Signs& a, const Signs& b) { return kept(a) < kept(b); });
}

/// Moves the parts of a model one after the other.
class Placer {
 public:
  Placer(Model& part, const PartPlacement& placement) : part_(part), r_(placement.position) {
    if (placement.mirror) {
      mirrored_ = true;
      S_(*placement.mirror, *placement.mirror) = -1.0;
    }
    Q_ = placement.orientation.toRotationMatrix();
    A_ = Q_ * S_;
  }

  void place() {
    for (JointSpec& joint : part_.joints) place_joint(joint);
    for (LoadSpec& load : part_.loads) place_load(load);
    for (SolidSpec& solid : part_.solids) place_solid(solid);
    for (BeamSpec& beam : part_.beams) place_beam(beam);
    for (CableLineSpec& cable : part_.cables) place_cable(cable);
    for (BodySpec& body : part_.bodies) place_body(body);
  }

 private:
  /// Mirror image of an axial vector: angular velocity or moment.
  [[nodiscard]] Mat3 axial() const { return mirrored_ ? Mat3(-A_) : A_; }
  [[nodiscard]] Vec3 moved(const Vec3& point) const { return r_ + A_ * point; }
  /// Rotation between the mirror images of the two frames of a rotation.
  [[nodiscard]] Quat turned(const Quat& q) const {
    return Quat(Mat3(A_ * q.toRotationMatrix() * S_)).normalized();
  }

  /// A point fixed to a body or the ground.
  [[nodiscard]] Vec3 carried(int body, const Vec3& Z) const {
    return body == kGround ? moved(Z) : Vec3(S_ * Z);
  }
  [[nodiscard]] Mat3 carried(int body, const Mat3& R, const Signs& signs) const {
    const Mat3 D = mirrored_ ? diagonal(signs) : Mat3(Mat3::Identity());
    return (body == kGround ? A_ : S_) * R * D;
  }

  void refuse_mirror(const std::string& where, const std::string& what, const char* hint) const {
    if (mirrored_) throw InputError(where, what + " cannot be mirrored", hint);
  }

  [[nodiscard]] TimeVector turned(const Mat3& T, const TimeVector& v,
                                  const std::string& where) const {
    if (T.isIdentity(0.0)) return v;
    if (!v[0] || !v[1] || !v[2])
      throw InputError(where, "cannot be turned or mirrored: not all components are given",
                       "Give all three");
    TimeVector result;
    for (int i = 0; i < 3; ++i)
      result[static_cast<std::size_t>(i)] =
          std::make_shared<TimeSum>(v, std::array{T(i, 0), T(i, 1), T(i, 2)});
    return result;
  }

  void place_body(BodySpec& body) const {
    body.position = moved(body.position);
    body.orientation = turned(body.orientation);
    body.velocity = A_ * body.velocity;
    body.angular_velocity = axial() * body.angular_velocity;
    if (!mirrored_) return;
    body.com = S_ * body.com;
    body.inertia = S_ * body.inertia * S_;
    for (ShapeSpec& shape : body.shapes) mirror_shape(body, shape);
  }

  /// Shapes with sizes are their own mirror images along their x.
  void mirror_shape(const BodySpec& body, ShapeSpec& shape) const {
    if (shape.type == "mesh" || shape.type == "height_field")
      refuse_mirror(format("bodies.{}.shape", body.name),
                    shape.type == "mesh" ? "a mesh" : "a height field",
                    "Give the mirror image in a part of its own");
    const Vec3 flip(-1.0, 1.0, 1.0);
    shape.position = S_ * shape.position;
    shape.orientation =
        Quat(Mat3(S_ * shape.orientation.toRotationMatrix() * flip.asDiagonal())).normalized();
    for (Vec3& point : shape.points) point.x() = -point.x();
    if (shape.type == "plane") shape.sizes[0] = -shape.sizes[0];
  }

  void place_joint(JointSpec& joint) const {
    const std::vector<std::string> free = free_coordinates(joint);
    const Signs signs = axis_signs(free);
    joint.Z_a = carried(joint.a, joint.Z_a);
    joint.Z_b = carried(joint.b, joint.Z_b);
    joint.R_a = carried(joint.a, joint.R_a, signs);
    joint.R_b = carried(joint.b, joint.R_b, signs);
    if (!mirrored_) return;
    if (joint.limits) mirror(*joint.limits, sign_of_only(free, false, signs));
    if (joint.angle_limits) mirror(*joint.angle_limits, sign_of_only(free, true, signs));
    if (joint.motion) mirror(*joint.motion, signs);
  }

  /// Sign of a joint's only displacement; of its only angle if it has none or `angle` is set.
  static double sign_of_only(const std::vector<std::string>& free, bool angle, const Signs& signs) {
    for (const std::string& c : free)
      if ((c.size() == 2) == angle) return sign_of(c, signs);
    return free.empty() ? 1.0 : sign_of(free.front(), signs);
  }

  static void mirror(JointLimitsSpec& limits, double sign) {
    if (sign > 0.0) return;
    std::swap(limits.lower, limits.upper);
    for (auto* end : {&limits.lower, &limits.upper})
      if (*end) *end = -**end;
  }

  static void mirror(FrameMotion& motion, const Signs& signs) {
    using enum FrameMotion::Rotation;
    for (std::size_t k = 0; k < 3; ++k)
      motion.displacement[k] = scaled(motion.displacement[k], signs[k]);
    const std::size_t first = motion.rotation == quaternion ? 1 : 0;
    for (std::size_t k = 0; k < 3 && motion.rotation != none; ++k) {
      const std::size_t axis = motion.rotation == euler
                                   ? static_cast<std::size_t>((motion.sequence[k] | 0x20) - 'x')
                                   : k;
      motion.parameters[first + k] = scaled(motion.parameters[first + k], -signs[axis]);
    }
  }

  void place_load(LoadSpec& load) const {
    const std::string where = format("loads.{}", load.name);
    constexpr Signs kAgainst{-1.0, -1.0, -1.0};
    const bool axial_vector = load.solid < 0 && load_kind(load.type).vector == "moment";
    // Points of solids are in the coordinates of their meshes.
    if (load.end_solids[0] < 0) load.Z_a = carried(load.a, load.Z_a);
    if (load.end_solids[1] < 0) load.Z_b = carried(load.b, load.Z_b);
    load.R_a = carried(load.a, load.R_a, kAgainst);
    load.R_b = carried(load.b, load.R_b, kAgainst);
    const PartAxes here{r_, A_, S_};
    load.part_axes = load.part_axes.within(here);
    if (load.vector)
      load.vector = turned(here.vector_map(load.body_fixed, axial_vector), *load.vector, where);
    if (!mirrored_) return;
    if (load.type == "rolling" || load.type == "point_on_curve" || load.type == "curve_on_curve")
      refuse_mirror(where, format("'{}'", load.type), "Give the mirror image in a part of its own");
    if (load.type == "screw")
      load.parameters["pitch"] *= -1.0;
    else if (!load.joint.empty())
      mirror_along_joints(load, where);
    if (load.type == "bushing") mirror_bushing(load, where);
  }

  /// Mirrors a bushing, whose new axes are opposite to the mirror images: displacements change
  /// their signs, rotations do not.
  void mirror_bushing(LoadSpec& load, const std::string& where) const {
    for (const char* law : {"law_x", "law_y", "law_z"})
      if (load.laws.count(law) > 0)
        refuse_mirror(where + "." + law, "a law of a displacement", "Use a stiffness");
    for (auto& [key, K] : load.matrices) {
      K.block<3, 3>(0, 3) *= -1.0;
      K.block<3, 3>(3, 0) *= -1.0;
    }
  }

  void mirror_along_joints(LoadSpec& load, const std::string& where) const {
    const bool turns = load_kind(load.type).turns;
    const auto sign = [&](const std::string& joint, const std::string& coordinate) {
      const auto found = std::find_if(part_.joints.begin(), part_.joints.end(),
                                      [&](const JointSpec& j) { return j.name == joint; });
      const std::vector<std::string> free = free_coordinates(*found);
      const Signs signs = axis_signs(free);
      return coordinate.empty() ? sign_of_only(free, turns, signs) : sign_of(coordinate, signs);
    };
    if (load_kind(load.type).place == LoadPlace::row) {
      const double first = sign(load.joint, load.coordinate);
      for (CoordinateSpec& other : load.others)
        other.factor *= first * sign(other.joint, other.coordinate);
      if (const auto offset = load.parameters.find("offset"); offset != load.parameters.end())
        offset->second *= first;
      return;
    }
    if (!load.joint_2.empty()) {
      if (!keeps_all(load.joint) || !keeps_all(load.joint_2))
        refuse_mirror(where, "a gear on a joint that moves both along and about an axis",
                      "Use joints with one freedom");
      return;
    }
    if (sign(load.joint, load.coordinate) > 0.0) return;
    if (!load.laws.empty() || (load.words.count("acts") > 0 && load.words.at("acts") != "both"))
      refuse_mirror(where, "a law of a coordinate whose sign changes",
                    "Use a stiffness and a damping, or a joint with one freedom");
    load.value = scaled(load.value, -1.0);
    load.part_axes.sense *= -1.0;
    for (const char* rest : {"free_angle", "free_displacement"})
      if (const auto found = load.parameters.find(rest); found != load.parameters.end())
        found->second = -found->second;
  }

  [[nodiscard]] bool keeps_all(const std::string& joint) const {
    const auto found = std::find_if(part_.joints.begin(), part_.joints.end(),
                                    [&](const JointSpec& j) { return j.name == joint; });
    const std::vector<std::string> free = free_coordinates(*found);
    const Signs signs = axis_signs(free);
    return std::all_of(free.begin(), free.end(),
                       [&](const std::string& c) { return sign_of(c, signs) > 0.0; });
  }

  void place_solid(SolidSpec& solid) const {
    const std::string where = format("solids.{}", solid.name);
    refuse_mirror(where, "a deformable solid", "Give the mirror image in a part of its own");
    solid.mesh.position = moved(solid.mesh.position);
    solid.mesh.orientation = Quat(Q_) * solid.mesh.orientation;
    if (solid.velocity) solid.velocity = Vec3(Q_ * *solid.velocity);
    if (solid.angular_velocity) solid.angular_velocity = Vec3(Q_ * *solid.angular_velocity);
    for (PrescribedSpec& p : solid.prescribed)
      p.displacement = turned(Q_, p.displacement, format("{}.prescribed.{}", where, p.name));
  }

  void place_beam(BeamSpec& beam) const {
    refuse_mirror(format("beams.{}", beam.name), "a beam",
                  "Give the mirror image in a part of its own");
    for (Vec3& point : beam.points) point = moved(point);
    if (beam.up) beam.up = Vec3(Q_ * *beam.up);
    beam.velocity = Q_ * beam.velocity;
    beam.angular_velocity = Q_ * beam.angular_velocity;
    for (BeamSpec::Element& element : beam.mesh) {
      element.frame_1 = Quat(Q_) * element.frame_1;
      element.frame_2 = Quat(Q_) * element.frame_2;
    }
  }

  void place_cable(CableLineSpec& cable) const {
    for (AttachmentSpec& point : cable.through) point.Z = carried(point.body, point.Z);
    for (ObstacleSpec& obstacle : cable.around) {
      obstacle.at.Z = carried(obstacle.at.body, obstacle.at.Z);
      const Mat3& turn = obstacle.at.body == kGround ? A_ : S_;
      if (obstacle.side) obstacle.side = Vec3(turn * *obstacle.side);
      obstacle.axes = turn * obstacle.axes;  // of either hand: the surface is its own mirror image
    }
    for (CableLineSpec::Piece& piece : cable.pieces)
      for (AttachmentSpec* end : {&piece.a, &piece.b}) end->Z = carried(end->body, end->Z);
  }

  Model& part_;
  Vec3 r_;
  Mat3 Q_ = Mat3::Identity();
  Mat3 S_ = Mat3::Identity();  ///< Reflection, in the part's axes and in those of each body.
  Mat3 A_ = Mat3::Identity();  ///< From the part's axes to the whole's, including the reflection.
  bool mirrored_ = false;
};

}  // namespace

void place_part(Model& part, const PartPlacement& placement) { Placer(part, placement).place(); }

}  // namespace polhode
