// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

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
  GearPlanner(const std::string& where, const std::array<GearJoint, 2>& joints,
              const std::vector<GearPose>& poses)
      : where_(where), joints_(joints), poses_(poses) {
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
    if (moving.size() <= 2) {
      out.bodies = {moving.size() == 2 ? moving[0] : kGround, moving.back()};
      for (std::size_t i = 0; i < 2; ++i) {
        const Participants b = joints_[i].joint->bodies;
        coordinate_[i].from = code(out.bodies, b.a);
        coordinate_[i].to = code(out.bodies, b.b);
      }
    } else {
      on_carrier(out, moving);
    }
    out.pair.coordinate = coordinate_;
    return out;
  }

 private:
  static int code(const Participants& pair, int body) {
    return body == kGround ? 0 : body == pair.a ? 1 : 2;
  }

  void find_coordinate(std::size_t i) {
    if (joints_[i].joint->frame_moves())
      throw InputError(where_ + ".joints",
                       format("the frame of '{}' has a prescribed motion", joints_[i].joint->name),
                       "Give the motion to a separate body, and act in a joint to that body");
    const auto angle = joints_[i].joint->free_angle(joints_[i].coordinate);
    const auto displacement = joints_[i].joint->free_displacement(joints_[i].coordinate);
    if (angle.has_value() == displacement.has_value()) {
      const std::vector<std::string> names = joints_[i].joint->coordinate_names();
      const std::string what =
          format("'{}' ({}) has ", joints_[i].joint->name, joints_[i].joint->type());
      throw InputError(where_ + ".coordinates",
                       joints_[i].coordinate.empty()
                           ? what + "not one free coordinate"
                           : what + format("no free coordinate '{}'", joints_[i].coordinate),
                       names.empty() ? "Name another joint" : "Free are: " + name_list(names));
    }
    if (angle) {
      coordinate_[i].kind = Kind::angle;
      coordinate_[i].angle = *angle;
    } else {
      coordinate_[i].kind = Kind::displacement;
      coordinate_[i].displacement = *displacement;
    }
  }

  /// Side of a joint that is not on the carrier.
  struct Wheel {
    int body;
    bool is_b;
    Vec3 Z;
    Mat3 R;
  };
  [[nodiscard]] Wheel wheel(std::size_t i, int carrier) const {
    const Joint& j = *joints_[i].joint;
    const bool is_b = j.bodies.a == carrier;
    return is_b ? Wheel{j.bodies.b, true, j.frames().Z_b, j.frames().R_b}
                : Wheel{j.bodies.a, false, j.frames().Z_a, j.frames().R_a};
  }

  void on_carrier(GearGeometry& out, const std::vector<int>& moving) {
    const Participants p = joints_[0].joint->bodies, q = joints_[1].joint->bodies;
    int carrier = kGround;
    for (int body : {p.a, p.b})
      if (body != kGround && (body == q.a || body == q.b)) carrier = body;
    if (moving.size() > 3 || carrier == kGround)
      throw InputError(where_ + ".joints",
                       "act between more than two moving bodies without a common carrier",
                       "Name joints of one carrier, or joints on the ground");
    const Wheel one = wheel(0, carrier), two = wheel(1, carrier);
    if (one.body == kGround || two.body == kGround)
      throw InputError(where_ + ".joints",
                       "connect the carrier to the ground and a wheel to the carrier",
                       "Name joints of one carrier, or joints on the ground");
    out.bodies = {one.body, two.body};
    if (coordinate_[0].kind == Kind::displacement && coordinate_[1].kind == Kind::displacement)
      throw InputError(where_ + ".joints", "are both displacements on a moving carrier",
                       "A gear on a moving carrier needs two wheels, or a rack and a pinion");
    if (out.mixed)
      rack_and_pinion(one, two);
    else
      wheels(one, two);
  }

  /// Sets the plane of a wheel, with axes normal to its own, so that its angle increases with the
  /// joint's coordinate.
  static void set_plane(GearCoordinate& c, const Wheel& w) {
    c.angle = {};
    c.angle.E = w.R.col(w.is_b ? 0 : 1);
    c.angle.F = w.R.col(w.is_b ? 1 : 0);
  }

  void wheels(const Wheel& one, const Wheel& two) {
    for (const GearJoint& j : joints_)
      if (j.joint->type() != "revolute" && j.joint->type() != "cylindrical")
        throw InputError(where_ + ".joints",
                         format("'{}' is {}, on a moving carrier", j.joint->name, j.joint->type()),
                         "Use revolute or cylindrical joints there");
    const GearPose &at_1 = poses_[static_cast<std::size_t>(one.body)],
                   &at_2 = poses_[static_cast<std::size_t>(two.body)];
    const Vec3 n_1 = at_1.Lambda * one.R.col(2), n_2 = at_2.Lambda * two.R.col(2);
    const Vec3 u = at_2.r + at_2.Lambda * two.Z - at_1.r - at_1.Lambda * one.Z;
    const bool parallel = n_1.cross(n_2).norm() < kParallel;
    if (parallel && (u - u.dot(n_1) * n_1).norm() <= kParallel * (1.0 + u.norm()))
      throw InputError(where_ + ".joints",
                       "have one axis on a moving carrier: their wheels do not mesh",
                       "Put an intermediate wheel on the carrier, as real gears do");
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
    if (joints_[0].joint->type() != "prismatic")
      throw InputError(where_ + ".joints",
                       format("'{}' is {}, on a moving carrier", joints_[0].joint->name,
                              joints_[0].joint->type()),
                       "Let a prismatic joint hold the rack");
    for (const GearJoint& j : joints_)
      if (j.assembled_start)
        throw InputError(
            where_ + ".joints",
            format("'{}' is on a moving carrier and is assembled at the start", j.joint->name),
            "Give this joint by at and axis, not by at_body");
    // Along z of the prismatic joint, whose sides are aligned.
    const Vec3 t = rack.R.col(2);
    GearCoordinate& slide = coordinate_[0];
    slide.displacement = {rack.Z, pinion.Z, rack.is_b ? Vec3(-t) : t};
    slide.from = 1;
    slide.to = 2;
    const Mat3 to_rack = poses_[static_cast<std::size_t>(rack.body)].Lambda.transpose() *
                         poses_[static_cast<std::size_t>(pinion.body)].Lambda;
    GearCoordinate& turn = coordinate_[1];
    turn.angle = {};
    turn.angle.E = to_rack * pinion.R.col(0);
    turn.angle.F = to_rack * (pinion.is_b ? Vec3(pinion.R.col(1)) : Vec3(-pinion.R.col(1)));
    turn.angle.D = pinion.R.col(0);
    turn.from = 1;
    turn.to = 2;
  }

  const std::string& where_;
  const std::array<GearJoint, 2>& joints_;
  const std::vector<GearPose>& poses_;
  std::array<GearCoordinate, 2> coordinate_;
};

}  // namespace

GearGeometry gear_geometry(const std::string& where, const std::array<GearJoint, 2>& joints,
                           const std::vector<GearPose>& poses) {
  return GearPlanner(where, joints, poses).plan();
}

}  // namespace polhode
