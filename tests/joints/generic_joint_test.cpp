// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>
#include <polhode/core/error.hpp>

namespace polhode::test::generic_joint_tests {
namespace {

JointParameters free_list(std::vector<std::string> free) {
  return {.free = std::move(free), .values = {}};
}

std::string message(std::vector<std::string> free) {
  try {
    (void)joint_kind("generic").recipe({}, free_list(std::move(free)));
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST(GenericJoint, LeavesFreeWhatIsListed) {
  EXPECT_EQ(free_motions("generic", free_list({"x", "rz"})), "Tx Rz");
  EXPECT_EQ(free_motions("generic", free_list({"rx"})), "Rx");
  EXPECT_EQ(free_motions("generic", free_list({"ry", "z"})), "Tz Ry");
  EXPECT_EQ(free_motions("generic", free_list({"x", "y", "z"})), "Tx Ty Tz");
  EXPECT_EQ(free_motions("generic", free_list({})), "");
}

// Two free rotations follow each other: the first about an axis of a, the second about one of b.
TEST(GenericJoint, LeavesTwoRotationsFreeOneAfterTheOther) {
  EXPECT_EQ(free_motions("generic", free_list({"rx", "ry"})), "Rx Ry");
  EXPECT_EQ(free_motions("generic", free_list({"ry", "rz"})), "Ry Rz");
  EXPECT_EQ(free_motions("generic", free_list({"rx", "rz"})), "Rx Rz");
}

TEST(GenericJoint, NamesItsCoordinatesByTheUsersAxes) {
  const auto names = [](std::vector<std::string> free) {
    return Joint("j", "generic", {0, 1}, joint_kind("generic").recipe({}, free_list(free)))
        .coordinate_names();
  };
  EXPECT_EQ(names({"rx"}), std::vector<std::string>{"rx"});
  EXPECT_EQ(names({"y", "ry"}), (std::vector<std::string>{"y", "ry"}));
  EXPECT_EQ(names({"z", "ry", "rz"}), (std::vector<std::string>{"z", "ry", "rz"}));
  EXPECT_EQ(names({"rx", "ry", "rz"}), (std::vector<std::string>{"rx", "ry", "rz"}));
}

TEST(GenericJoint, RefusesInvalidFreedoms) {
  EXPECT_EQ(message({"rw"}),
            "free: 'rw' is no freedom of a joint. Use some of: x, y, z, rx, ry, rz.");
  EXPECT_EQ(message({"x", "x"}), "free: 'x' is given twice. Give each freedom once.");
  EXPECT_EQ(message({"x", "y", "z", "rx", "ry", "rz"}),
            "free: all six freedoms are free, so the joint has no constraint. Leave the joint out, "
            "or lock a freedom.");
}

}  // namespace polhode::test::generic_joint_tests
