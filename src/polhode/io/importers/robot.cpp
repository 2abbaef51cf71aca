// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

Mat3 axes_along(const Vec3& z) {
  int least = 0;
  z.cwiseAbs().minCoeff(&least);
  const Vec3 x = Vec3::Unit(least);
  Mat3 F;
  F.col(2) = z;
  F.col(0) = (x - x.dot(z) * z).normalized();
  F.col(1) = z.cross(F.col(0));
  return F;
}

Mat3 rotation_of_rpy(const Vec3& rpy) {
  return (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
          Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
      .toRotationMatrix();
}

}  // namespace polhode::io
