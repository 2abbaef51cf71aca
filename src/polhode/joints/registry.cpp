// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/joints/constant_velocity_joint.hpp>
#include <polhode/joints/cylindrical_joint.hpp>
#include <polhode/joints/distance_joint.hpp>
#include <polhode/joints/fixed_joint.hpp>
#include <polhode/joints/generic_joint.hpp>
#include <polhode/joints/parallel_axes_joint.hpp>
#include <polhode/joints/planar_joint.hpp>
#include <polhode/joints/point_in_plane_joint.hpp>
#include <polhode/joints/point_on_line_joint.hpp>
#include <polhode/joints/prismatic_joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/joints/revolute_joint.hpp>
#include <polhode/joints/rod_joints.hpp>
#include <polhode/joints/spherical_joint.hpp>
#include <polhode/joints/universal_joint.hpp>

namespace polhode {

namespace {

Parameter rod_length() {
  return {"distance",
          "m",
          {},
          std::numeric_limits<double>::min(),
          std::numeric_limits<double>::max(),
          "distance of the two points; left out: as at the start"};
}

}  // namespace

const std::vector<JointKind>& joint_kinds() {
  static const std::vector<JointKind> kinds{
      {"spherical", "ball: the points coincide", "Rx Ry Rz", spherical_joint},
      {"revolute", "hinge: b rotates about z", "Rz", revolute_joint},
      {"prismatic", "slider: b moves along z", "Tz", prismatic_joint},
      {"cylindrical", "sleeve: b moves along z and rotates about it", "Tz Rz", cylindrical_joint},
      {"universal", "cardan: b rotates about x of a and y of b", "Rx Ry", universal_joint},
      {"constant_velocity",
       "both shafts, z of a and of b, rotate equally at any angle between them", "Rx Ry",
       constant_velocity_joint},
      {"planar", "b slides in the plane with normal z and rotates about it", "Tx Ty Rz",
       planar_joint},
      {"fixed", "weld: no freedom", "", fixed_joint},
      {"distance",
       "rod with ball ends: the distance of the points is constant",
       "all but the distance",
       distance_joint,
       {rod_length()},
       false,
       true},
      {"revolute_spherical",
       "massless rod: it rotates about z of a and has a ball end on b",
       "all but the distance and the plane of the hinge",
       revolute_spherical_joint,
       {rod_length()},
       false,
       true},
      {"universal_spherical",
       "massless rod: it has a cross on a, with axes x and y, and a ball end on b",
       "all but the distance",
       universal_spherical_joint,
       {rod_length()},
       false,
       true},
      {"slack_link",
       "link with slack: the distance of the points stays within its limits",
       "all, within the limits",
       slack_link_joint,
       {},
       false,
       true},
      {"point_in_plane", "the point of b stays in the plane with normal z of a", "Tx Ty Rx Ry Rz",
       point_in_plane_joint},
      {"point_on_line", "the point of b stays on the line along z of a", "Tz Rx Ry Rz",
       point_on_line_joint},
      {"parallel_axes", "the z axes stay parallel", "Tx Ty Tz Rz", parallel_axes_joint},
      {"generic",
       "each of x, y, z, rx, ry, rz is free or locked",
       "as given",
       generic_joint,
       {},
       true},
  };
  return kinds;
}

const JointKind& joint_kind(std::string_view name) {
  std::string names;
  for (const JointKind& kind : joint_kinds()) {
    if (kind.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw InputError("joints", format("the type '{}' is not known", name),
                   format("Use one of: {}", names));
}

}  // namespace polhode
