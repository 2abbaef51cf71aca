// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/mjcf_inertia.hpp>

#include <Eigen/Cholesky>

namespace polhode::io {

namespace {

/// Spatial inertia about the world's origin, rotation first.
Mat6 spatial_inertia(const geometry::MassProperties& mass, const Pose& frame) {
  const Vec3 c = frame * mass.com;
  Mat3 C;
  C << 0, -c.z(), c.y(), c.z(), 0, -c.x(), -c.y(), c.x(), 0;
  Mat6 I;
  I.topLeftCorner<3, 3>() = frame.R * mass.inertia * frame.R.transpose() - mass.mass * C * C;
  I.topRightCorner<3, 3>() = mass.mass * C;
  I.bottomLeftCorner<3, 3>() = -mass.mass * C;
  I.bottomRightCorner<3, 3>() = mass.mass * Mat3::Identity();
  return I;
}

/// Motions of the velocities of a joint, by rotation and by the velocity at the world's origin.
std::vector<Vec6> motions(const RobotJoint& joint, const Pose& child) {
  const Pose frame = child * joint.on_child;
  std::vector<Vec6> list;
  const auto turn = [&](const Vec3& axis) {
    Vec6 s;
    s << axis, frame.p.cross(axis);
    list.push_back(s);
  };
  const auto slide = [&](const Vec3& axis) {
    Vec6 s;
    s << Vec3::Zero(), axis;
    list.push_back(s);
  };
  if (joint.is_single()) joint.turns() ? turn(frame.R * joint.axis) : slide(frame.R * joint.axis);
  if (joint.type == "floating")
    for (int k = 0; k < 3; ++k) slide(Vec3::Unit(k));
  if (joint.type == "floating" || joint.type == "spherical")
    for (int k = 0; k < 3; ++k) turn(child.R.col(k));
  return list;
}

}  // namespace

MjcfInertia::MjcfInertia(const Robot& robot, const std::map<std::string, Pose>& frames) {
  const std::size_t n = robot.joints.size();
  std::map<std::string, std::size_t> link;
  for (std::size_t i = 0; i < robot.links.size(); ++i) link[robot.links[i].name] = i;
  std::vector<std::vector<Vec6>> S(n);
  std::vector<Mat6> below(robot.links.size());
  for (std::size_t i = 0; i < robot.links.size(); ++i)
    below[i] = spatial_inertia(robot.links[i].mass, frames.at(robot.links[i].name));
  first_.push_back(0);
  for (std::size_t j = 0; j < n; ++j) {
    S[j] = motions(robot.joints[j], frames.at(robot.joints[j].child));
    first_.push_back(first_.back() + static_cast<int>(S[j].size()));
  }
  if (!is_there()) return;
  for (std::size_t j = n; j-- > 0;) below[link.at(robot.joints[j].parent)] += below[j + 1];
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(first_.back(), first_.back());
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < S[j].size(); ++k) {
      const int row = first_[j] + static_cast<int>(k);
      const Vec6 momentum = below[j + 1] * S[j][k];
      // Joints on the way to the world; joint i is above link i + 1.
      for (std::size_t i = j + 1; i > 0; i = link.at(robot.joints[i - 1].parent))
        for (std::size_t m = 0; m < S[i - 1].size(); ++m) {
          const int column = first_[i - 1] + static_cast<int>(m);
          mass(row, column) = mass(column, row) = S[i - 1][m].dot(momentum);
        }
    }
  for (std::size_t j = 0; j < n; ++j)
    for (int k = first_[j]; k < first_[j + 1]; ++k) mass(k, k) += robot.joints[j].armature;
  const Eigen::LLT<Eigen::MatrixXd> factors(mass);
  if (factors.info() == Eigen::Success)
    mobility_ = factors.solve(Eigen::MatrixXd::Identity(mass.rows(), mass.cols()));
}

double MjcfInertia::effective(std::size_t joint) const {
  if (mobility_.size() == 0) return 0.0;
  const int count = first_[joint + 1] - first_[joint];
  const double sum = mobility_.diagonal().segment(first_[joint], count).sum();
  return count > 0 && sum > 0.0 ? count / sum : 0.0;
}

double MjcfInertia::effective(const std::vector<std::pair<std::size_t, double>>& sum) const {
  if (mobility_.size() == 0) return 0.0;
  double mobility = 0.0;
  for (const auto& [i, a] : sum)
    for (const auto& [j, b] : sum) mobility += a * b * mobility_(first_[i], first_[j]);
  return mobility > 0.0 ? 1.0 / mobility : 0.0;
}

}  // namespace polhode::io
