// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_medium.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

namespace polhode::io {

Mat3 rotated_to_principal(const Mat3& inertia) {
  Mat3 axes = Mat3::Identity();
  for (int round = 0; round < 100; ++round) {
    const Mat3 D = axes.transpose() * inertia * axes;
    int i = 0, j = 1;
    for (const auto& [m, n] : {std::pair{0, 2}, std::pair{1, 2}})
      if (std::abs(D(m, n)) > std::abs(D(i, j))) std::tie(i, j) = std::pair{m, n};
    // Entries below this are no products of inertia there either.
    if (std::abs(D(i, j)) < 1e-12) break;
    const double tau = (D(j, j) - D(i, i)) / (2.0 * D(i, j));
    const double t = (tau >= 0.0 ? 1.0 : -1.0) / (std::abs(tau) + std::hypot(1.0, tau));
    const double c = 1.0 / std::hypot(1.0, t), s = t * c;
    if (c > 1.0 - 1e-12) break;
    const Vec3 x = axes.col(i), y = axes.col(j);
    axes.col(i) = c * x - s * y;
    axes.col(j) = s * x + c * y;
  }
  return axes;
}

void add_medium(const MjcfMedium& medium, MjcfRefusals& refusals, const MjcfBodies& bodies,
                Robot& robot) {
  if (medium.density == 0.0 && medium.viscosity == 0.0) return;
  if (medium.wind)
    refusals.add(*medium.at, "the medium moves with a wind", "Let it rest: leave 'wind' out.");
  for (const XmlFile::Element* geom : bodies.ellipsoids())
    refusals.add(*geom, "a medium flows around a <geom> as around an ellipsoid, with lift",
                 "Leave 'fluidshape' out.");
  for (const RobotLink& link : robot.links) {
    const auto axes = bodies.axes().find(link.name);
    if (axes == bodies.axes().end() || !(link.mass.mass > 0.0)) continue;
    const Mat3& R = axes->second;
    const Vec3 J = (R.transpose() * link.mass.inertia * R).diagonal();
    Vec3 box;
    for (int i = 0; i < 3; ++i)
      box[i] = std::sqrt(std::max(0.0, 6.0 * (J.sum() - 2.0 * J[i]) / link.mass.mass));
    RobotDrag drag;
    drag.at = link.at;
    drag.link = link.name;
    drag.frame = {link.mass.com, R};
    const double size = box.mean();
    drag.linear.setConstant(3.0 * std::numbers::pi * size * medium.viscosity);
    drag.turning.setConstant(std::numbers::pi * std::pow(size, 3) * medium.viscosity);
    for (int i = 0; i < 3; ++i) {
      const double y = box[(i + 1) % 3], z = box[(i + 2) % 3];
      drag.quadratic[i] = 0.5 * medium.density * y * z;
      drag.quadratic_turning[i] =
          medium.density * box[i] * (std::pow(y, 4) + std::pow(z, 4)) / 64.0;
    }
    robot.drags.push_back(drag);
  }
}

}  // namespace polhode::io
