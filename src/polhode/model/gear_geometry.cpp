// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <initializer_list>
#include <optional>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/model/gear_geometry.hpp>

namespace polhode {

namespace {

using Kind = GearCoordinate::Kind;

/// Sine of the angle below which axes are parallel.
constexpr double kParallel = 1e-6;

class GearPlanner {
 public:
  GearPlanner(const std::string& where, const std::array<GearJoint, 2>& joints)
      : where_(where), joints_(joints) {
    for (std::size_t i = 0; i < 2; ++i) find_coordinate(i);
  }

  GearGeometry plan() {
    GearGeometry out;
    out.mixed = coordinate_[0].kind != coordinate_[1].kind;
    if (out.mixed && coordinate_[0].kind == Kind::angle)
      throw InputError(where_ + ".joints", "the turning joint is named before the sliding one",
                       "Exchange the two joints");
    std::vector<int> moving;
    for (const GearJoint& j : joints_)
      for (int body : {j.joint->bodies.a, j.joint->bodies.b})
        if (body != kGround && std::find(moving.begin(), moving.end(), body) == moving.end())
          moving.push_back(body);
    const std::optional<int> carrier = common_carrier();
    if (moving.size() > 2) {
      if (moving.size() > 3 || !carrier || *carrier == kGround)
        throw InputError(where_ + ".joints",
                         "act between more than two moving bodies without a common carrier",
                         "Name joints of one carrier, or joints on the ground, or use a coupling");
      check_mesh(*carrier);
      on_carrier(out, *carrier);
    } else if (carrier && meshes(*carrier)) {
      on_carrier(out, *carrier);
    } else {
      in_joints(out, moving);
    }
    out.pair.coordinate = coordinate_;
    return out;
  }

 private:
  static int code(const Participants& pair, int body) {
    return body == kGround ? 0 : body == pair.a ? 1 : 2;
  }

  void find_coordinate(std::size_t i) {
    const auto found = free_coordinate(where_, joints_[i]);
    if (const auto* angle = std::get_if<FreeAngle>(&found)) {
      coordinate_[i].kind = Kind::angle;
      coordinate_[i].angle = *angle;
    } else {
      coordinate_[i].kind = Kind::displacement;
      coordinate_[i].displacement = std::get<FreeDisplacement>(found);
    }
  }

  /// Side of a joint that is not on the carrier, and the frame of the joint on the carrier.
  struct Wheel {
    int body;
    bool is_b;
    Vec3 Z;
    Mat3 R;
    Vec3 Z_carrier;
    Mat3 R_carrier;
  };
  [[nodiscard]] Wheel wheel(std::size_t i, int carrier) const {
    const Joint& j = *joints_[i].joint;
    const JointFrames& f = j.frames();
    return j.bodies.a == carrier ? Wheel{j.bodies.b, true, f.Z_b, f.R_b, f.Z_a, f.R_a}
                                 : Wheel{j.bodies.a, false, f.Z_a, f.R_a, f.Z_b, f.R_b};
  }

  /// Body of both joints, which may be the ground; of two a moving one.
  [[nodiscard]] std::optional<int> common_carrier() const {
    std::optional<int> found;
    const Participants p = joints_[0].joint->bodies, q = joints_[1].joint->bodies;
    for (int body : {p.a, p.b})
      if ((body == q.a || body == q.b) && (!found || *found == kGround)) found = body;
    return found;
  }

  [[nodiscard]] bool holds(std::size_t i, std::initializer_list<const char*> types) const {
    return std::any_of(types.begin(), types.end(),
                       [&](const char* type) { return joints_[i].joint->type() == type; });
  }
  [[nodiscard]] bool are_coaxial(int carrier) const {
    const Wheel one = wheel(0, carrier), two = wheel(1, carrier);
    const Vec3 n = one.R_carrier.col(2), u = two.Z_carrier - one.Z_carrier;
    return are_parallel(one, two) && (u - u.dot(n) * n).norm() <= kParallel * (1.0 + u.norm());
  }
  [[nodiscard]] static bool are_parallel(const Wheel& one, const Wheel& two) {
    return one.R_carrier.col(2).cross(two.R_carrier.col(2)).norm() < kParallel;
  }
  /// Whether teeth can act between two wheels, or a rack and a pinion, on a carrier.
  [[nodiscard]] bool meshes(int carrier) const {
    if (wheel(0, carrier).body == wheel(1, carrier).body) return false;
    if (coordinate_[0].kind == Kind::displacement)
      return coordinate_[1].kind == Kind::angle && holds(0, {"prismatic"});
    return holds(0, {"revolute", "cylindrical"}) && holds(1, {"revolute", "cylindrical"}) &&
           !are_coaxial(carrier);
  }
  /// Rejects what cannot mesh on a moving carrier.
  void check_mesh(int carrier) const {
    if (wheel(0, carrier).body == kGround || wheel(1, carrier).body == kGround)
      throw InputError(where_ + ".joints",
                       "connect the carrier to the ground and a wheel to the carrier",
                       "Name joints of one carrier, or joints on the ground");
    const bool slides = coordinate_[0].kind == Kind::displacement;
    if (slides && coordinate_[1].kind == Kind::displacement)
      throw InputError(where_ + ".joints", "are both displacements on a moving carrier",
                       "A gear on a moving carrier needs two wheels, or a rack and a pinion");
    const auto refuse = [&](std::size_t i, const char* hint) {
      throw InputError(where_ + ".joints",
                       format("'{}' is {}, on a moving carrier", joints_[i].joint->name,
                              joints_[i].joint->type()),
                       hint);
    };
    if (slides && !holds(0, {"prismatic"})) refuse(0, "Let a prismatic joint hold the rack");
    for (std::size_t i = 0; i < 2 && !slides; ++i)
      if (!holds(i, {"revolute", "cylindrical"}))
        refuse(i, "Use revolute or cylindrical joints there");
    if (!slides && are_coaxial(carrier))
      throw InputError(where_ + ".joints",
                       "have one axis on a moving carrier: their wheels do not mesh",
                       "Put an intermediate wheel on the carrier, as real gears do");
  }
  /// Coordinates of the joints themselves, of at most two moving bodies: the ground, if it is a
  /// third one, takes the difference of their forces and moments.
  void in_joints(GearGeometry& out, const std::vector<int>& moving) {
    out.bodies = {moving.size() == 2 ? moving[0] : kGround, moving.back()};
    for (std::size_t i = 0; i < 2; ++i) {
      const Participants b = joints_[i].joint->bodies;
      coordinate_[i].from = code(out.bodies, b.a);
      coordinate_[i].to = code(out.bodies, b.b);
    }
  }

  void on_carrier(GearGeometry& out, int carrier) {
    const Wheel one = wheel(0, carrier), two = wheel(1, carrier);
    out.bodies = {one.body, two.body};
    if (out.mixed)
      rack_and_pinion(one, two);
    else
      wheels(one, two);
    for (GearCoordinate& c : coordinate_)
      for (int* end : {&c.from, &c.to})
        if ((*end == 1 ? one : two).body == kGround) *end = 0;
  }

  /// Sets the plane of a wheel, with axes normal to its own, so that its angle increases with the
  /// joint's coordinate.
  static void set_plane(GearCoordinate& c, const Wheel& w) {
    c.angle = {};
    c.angle.E = w.R.col(w.is_b ? 0 : 1);
    c.angle.F = w.R.col(w.is_b ? 1 : 0);
  }

  void wheels(const Wheel& one, const Wheel& two) {
    const bool parallel = are_parallel(one, two);
    const std::array<const Wheel*, 2> wheel{&one, &two};
    for (std::size_t i = 0; i < 2; ++i) {
      const Wheel &own = *wheel[i], &other = *wheel[1 - i];
      GearCoordinate& c = coordinate_[i];
      set_plane(c, own);
      c.kind = parallel ? Kind::centres : Kind::axes;
      c.angle.D = other.R.col(2);
      c.displacement.Z_a = own.Z;
      c.displacement.Z_b = other.Z;
      c.from = i == 0 ? 1 : 2;
      c.to = i == 0 ? 2 : 1;
    }
  }

  /// A rack does not rotate relative to its carrier: the pinion's angle is the same relative to
  /// both, and the pinion's centre moves along the rack.
  void rack_and_pinion(const Wheel& rack, const Wheel& pinion) {
    // Along z of the prismatic joint, whose sides are aligned.
    const Vec3 t = rack.R.col(2);
    GearCoordinate& slide = coordinate_[0];
    slide.displacement = {rack.Z, pinion.Z, rack.is_b ? Vec3(-t) : t};
    slide.from = 1;
    slide.to = 2;
    // From the pinion's axes on the carrier to the rack: angles count from the start anyway.
    const Mat3 to_rack = rack.R * rack.R_carrier.transpose() * pinion.R_carrier;
    GearCoordinate& turn = coordinate_[1];
    turn.angle = {};
    turn.angle.E = to_rack.col(0);
    turn.angle.F = pinion.is_b ? Vec3(to_rack.col(1)) : Vec3(-to_rack.col(1));
    turn.angle.D = pinion.R.col(0);
    turn.from = 1;
    turn.to = 2;
  }

  const std::string& where_;
  const std::array<GearJoint, 2>& joints_;
  std::array<GearCoordinate, 2> coordinate_;
};

}  // namespace

std::variant<FreeAngle, FreeDisplacement> free_coordinate(const std::string& where,
                                                          const GearJoint& of) {
  const Joint& joint = *of.joint;
  if (joint.frame_moves())
    throw InputError(where + ".joints",
                     format("the frame of '{}' has a prescribed motion", joint.name),
                     "Give the motion to a separate body, and act in a joint to that body");
  const auto angle = joint.free_angle(of.coordinate);
  const auto displacement = joint.free_displacement(of.coordinate);
  if (angle.has_value() == displacement.has_value()) {
    const std::vector<std::string> names = joint.coordinate_names();
    const std::string what = format("'{}' ({}) has ", joint.name, joint.type());
    throw InputError(where + ".coordinates",
                     of.coordinate.empty()
                         ? what + "not one free coordinate"
                         : what + format("no free coordinate '{}'", of.coordinate),
                     names.empty() ? "Name another joint" : "Free are: " + name_list(names));
  }
  if (angle) return *angle;
  return *displacement;
}

GearGeometry gear_geometry(const std::string& where, const std::array<GearJoint, 2>& joints) {
  return GearPlanner(where, joints).plan();
}

}  // namespace polhode
