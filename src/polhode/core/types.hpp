// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace polhode {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vec = Eigen::VectorXd;
using Mat = Eigen::MatrixXd;
using Quat = Eigen::Quaterniond;  ///< Unit quaternion (w, x, y, z), body to world.

/// Body index of the ground, which is fixed.
inline constexpr int kGround = -1;

}  // namespace polhode
