// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>
#include <polhode/core/error.hpp>

namespace polhode::test::registry_tests {

TEST(JointRegistry, StatesTheFreeMotionsOfEachKind) {
  for (const JointKind& kind : joint_kinds()) {
    if (kind.takes_free_list || kind.points_apart) continue;
    EXPECT_EQ(free_motions(kind.name), kind.free) << kind.name;
  }
}

TEST(JointRegistry, HasUniqueNames) {
  std::set<std::string> names;
  for (const JointKind& kind : joint_kinds()) EXPECT_TRUE(names.insert(kind.name).second);
}

TEST(JointRegistry, ListsTheNamesWhenOneIsUnknown) {
  try {
    (void)joint_kind("hinge");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "joints: the type 'hinge' is not known. Use one of: spherical, revolute, "
                 "prismatic, cylindrical, universal, constant_velocity, planar, fixed, distance, "
                 "revolute_spherical, universal_spherical, slack_link, point_in_plane, "
                 "point_on_line, parallel_axes, generic.");
  }
}

}  // namespace polhode::test::registry_tests
