// SPDX-License-Identifier: Apache-2.0
#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/loads/moment.hpp>
#include <polhode/loads/motor.hpp>
#include <polhode/loads/point_force.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/loads/spring_damper.hpp>
#include <polhode/loads/torsional_spring.hpp>

namespace polhode {

namespace {

template <class Item>
std::vector<double> report_of(const InteractionGroup& group, int item, const PairStep& step) {
  const auto& items = dynamic_cast<const Group<Item>&>(group).items;
  return items[static_cast<std::size_t>(item)].report(step);
}

}  // namespace

const std::vector<LoadKind>& load_kinds() {
  constexpr double kMost = std::numeric_limits<double>::max();
  static const std::vector<LoadKind> kinds{
      {"force",
       "force at a point of a body, in world or body axes",
       LoadPlace::body,
       "force",
       {},
       {},
       false,
       add_point_force,
       {{"force", "N", 3}},
       report_of<PointForce>},
      {"moment",
       "moment on a body, in world or body axes",
       LoadPlace::body,
       "moment",
       {},
       {},
       true,
       add_moment,
       {{"moment", "N m", 3}},
       report_of<Moment>},
      {"spring_damper",
       "linear spring and damper between two points",
       LoadPlace::points,
       "",
       {{"stiffness", "N/m", 0.0, 0.0, kMost, "force per elongation"},
        {"damping", "N*s/m", 0.0, 0.0, kMost, "force per rate of elongation"},
        {"free_length",
         "m",
         {},
         0.0,
         kMost,
         "length without force; left out: the distance at the start"}},
       {},
       false,
       add_spring_damper,
       {{"force", "N", 3}, {"length", "m"}, {"rate", "m/s"}, {"energy", "J"}},
       report_of<SpringDamper>},
      {"torsional_spring",
       "linear spring and damper about the axis of a joint",
       LoadPlace::joint,
       "",
       {{"stiffness", "N*m/rad", 0.0, 0.0, kMost, "moment per angle, turns counted"},
        {"damping", "N*m*s/rad", 0.0, 0.0, kMost, "moment per rate of the angle"},
        {"free_angle", "rad", 0.0, -kMost, kMost, "angle of the joint without moment"}},
       {},
       true,
       add_torsional_spring,
       {{"moment", "N m", 3}, {"angle", "rad"}, {"rate", "rad/s"}, {"energy", "J"}},
       report_of<TorsionalSpring>},
      {"rotary_motor",
       "motor that turns a joint about one of its free axes",
       LoadPlace::joint,
       "",
       {},
       {{"angle", "rad", "angle of the joint, turns counted"},
        {"speed", "rad/s", "rate of the angle, which begins where the joint stands"},
        {"moment", "N*m", "moment on the second body about the axis"}},
       true,
       add_rotary_motor,
       {{"moment", "N m", 3}, {"angle", "rad"}, {"rate", "rad/s"}, {"power", "W"}, {"work", "J"}},
       report_of<RotaryMotor>},
      {"linear_motor",
       "motor that pushes a joint along one of its free directions",
       LoadPlace::joint,
       "",
       {},
       {{"displacement", "m", "displacement of the joint"},
        {"speed", "m/s", "rate of the displacement, which begins where the joint stands"},
        {"force", "N", "force on the second body along the direction"}},
       false,
       add_linear_motor,
       {{"force", "N", 3}, {"displacement", "m"}, {"rate", "m/s"}, {"power", "W"}, {"work", "J"}},
       report_of<LinearMotor>},
  };
  return kinds;
}

int LoadKind::report_size() const {
  int size = 0;
  for (const LoadChannel& channel : channels) size += channel.size;
  return size;
}

const LoadKind& load_kind(std::string_view name) {
  std::string names;
  for (const LoadKind& kind : load_kinds()) {
    if (kind.name == name) return kind;
    names += (names.empty() ? "" : ", ") + kind.name;
  }
  throw InputError("loads", format("the type '{}' is not known", name),
                   format("Use one of: {}", names));
}

}  // namespace polhode
