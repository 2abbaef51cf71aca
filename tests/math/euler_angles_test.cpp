// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/math/euler_angles.hpp>

namespace polhode::test::euler_angles_tests {

namespace {

Mat3 about(char axis, double angle) {
  return Eigen::AngleAxisd(angle, Vec3::Unit(axis - 'x')).toRotationMatrix();
}

Mat3 of(const std::string& sequence, const std::array<double, 3>& angle) {
  Mat3 R = Mat3::Identity();
  for (std::size_t k = 0; k < 3; ++k) {
    const bool at_rest = sequence[k] < 'a';
    const Mat3 turn =
        about(static_cast<char>(at_rest ? sequence[k] - 'X' + 'x' : sequence[k]), angle[k]);
    R = at_rest ? Mat3(turn * R) : Mat3(R * turn);
  }
  return R;
}

const char* const kSequences[] = {"xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "xyx", "xzx", "yxy",
                                  "yzy", "zxz", "zyz", "XYZ", "ZYX", "YZX", "XZX", "ZXZ"};

}  // namespace

// @tests{euler-angles}
TEST(EulerAngles, AreThoseOfEverySequence) {
  for (const std::string sequence : kSequences) {
    const bool twice = sequence[0] == sequence[2];
    for (const double a : {-2.9, -0.4, 0.0, 1.3, 3.0})
      for (const double b : {0.3, 1.2, -0.9})
        for (const double c : {-2.2, 0.5, 2.8}) {
          const std::array<double, 3> given{a, twice ? std::abs(b) : b, c};
          const auto found = euler_angles(of(sequence, given), sequence);
          for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(std::remainder(found[k] - given[k], 2.0 * std::numbers::pi), 0.0, 1e-13)
                << sequence;
        }
  }
}

TEST(EulerAngles, GiveTheRotationInGimbalLock) {
  for (const std::string sequence : kSequences) {
    const bool twice = sequence[0] == sequence[2];
    for (const double b : twice ? std::array{0.0, std::numbers::pi}
                                : std::array{0.5 * std::numbers::pi, -0.5 * std::numbers::pi}) {
      const Mat3 R = of(sequence, {0.7, b, 0.4});
      EXPECT_LT((of(sequence, euler_angles(R, sequence)) - R).norm(), 1e-7) << sequence << b;
    }
  }
}

}  // namespace polhode::test::euler_angles_tests
