// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/core/disjoint_sets.hpp>
#include <polhode/core/format.hpp>
#include <polhode/joint_space/tree_space.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

/// Largest number of coordinates of a joint.
constexpr std::size_t kMostFree = 6;
constexpr const char* kAxes[6] = {"x", "y", "z", "rx", "ry", "rz"};

/// A joint of the model that can lead to a body, with the names of its coordinates.
struct Candidate {
  int joint = -1;
  int wish = 2;  ///< 0: has a coordinate that is to be independent, 1: has an inerter.
  std::vector<std::string> names;
  bool equal_turns = false;
};

std::string name_of(const std::string& of, const std::string& coordinate, std::size_t count) {
  return count == 1 ? of : format("{}.{}", of, coordinate);
}

std::vector<Candidate> candidates(const Model& model, std::span<const std::string> preferred,
                                  std::span<const std::string> released) {
  std::vector<Candidate> list;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const JointSpec& joint = model.joints[i];
    const JointKind& kind = joint_kind(joint.type);
    if (kind.points_apart || std::ranges::find(released, joint.name) != released.end()) continue;
    const Joint item(joint.name, joint.type, {joint.a, joint.b},
                     kind.recipe({joint.Z_a, joint.Z_b, joint.R_a, joint.R_b},
                                 {.free = joint.free, .values = joint.parameters}));
    Candidate c{.joint = static_cast<int>(i), .names = item.coordinate_names()};
    c.equal_turns = item.parts().equal_turns;
    if (std::ranges::any_of(model.loads, [&](const LoadSpec& load) {
          return load.solid < 0 && load.joint == joint.name && load_kind(load.type).parts > 1;
        }))
      c.wish = 1;
    for (const std::string& name : c.names)
      if (std::ranges::find(preferred, name_of(joint.name, name, c.names.size())) !=
          preferred.end())
        c.wish = 0;
    list.push_back(std::move(c));
  }
  // Joints with few coordinates first, so that those with many close the loops.
  std::ranges::stable_sort(list, [](const Candidate& a, const Candidate& b) {
    return std::pair(a.wish, a.names.size()) < std::pair(b.wish, b.names.size());
  });
  return list;
}

}  // namespace

TreeSpace::TreeSpace(const Model& model, std::span<const std::string> preferred,
                     std::span<const std::string> released)
    : in_tree_(model.joints.size(), 0), to_(model.bodies.size(), -1) {
  const int bodies = static_cast<int>(model.bodies.size());
  const auto is_fixed = [&](int body) {
    return body == kGround || model.bodies[static_cast<std::size_t>(body)].fixed;
  };
  const auto set_of = [&](int body) { return is_fixed(body) ? 0 : body + 1; };
  DisjointSets sets(static_cast<std::size_t>(bodies) + 1);
  std::vector<Candidate> chosen;
  for (Candidate& c : candidates(model, preferred, released)) {
    const JointSpec& joint = model.joints[static_cast<std::size_t>(c.joint)];
    const int a = set_of(joint.a), b = set_of(joint.b);
    if (sets.first_of(a) == sets.first_of(b)) {
      for (const std::string& name : c.names)
        closing_.push_back(name_of(joint.name, name, c.names.size()));
      continue;
    }
    sets.join(a, b);
    chosen.push_back(std::move(c));
  }
  // From the ground, then from the first body of each tree that is not connected with it.
  std::vector<char> reached(static_cast<std::size_t>(bodies), 0);
  std::vector<char> used(chosen.size(), 0);
  std::vector<const Candidate*> of;
  const auto lead_to = [&](TreeJoint joint, const Candidate* candidate) {
    reached[static_cast<std::size_t>(joint.child())] = 1;
    to_[static_cast<std::size_t>(joint.child())] = static_cast<int>(joints_.size());
    joints_.push_back(std::move(joint));
    of.push_back(candidate);
  };
  const auto is_reached = [&](int body) {
    return is_fixed(body) || reached[static_cast<std::size_t>(body)] != 0;
  };
  const auto grow = [&] {
    for (bool more = true; more;) {
      more = false;
      for (std::size_t k = 0; k < chosen.size(); ++k) {
        const JointSpec& spec = model.joints[static_cast<std::size_t>(chosen[k].joint)];
        if (used[k] || is_reached(spec.a) == is_reached(spec.b)) continue;
        used[k] = 1;
        more = true;
        in_tree_[static_cast<std::size_t>(chosen[k].joint)] = 1;
        lead_to({.joint = chosen[k].joint,
                 .a = spec.a,
                 .b = spec.b,
                 .from_a = is_reached(spec.a),
                 .Z_a = spec.Z_a,
                 .Z_b = spec.Z_b,
                 .R_a = spec.R_a,
                 .R_b = spec.R_b,
                 .free = FreeMotion(chosen[k].names, chosen[k].equal_turns)},
                &chosen[k]);
      }
    }
  };
  grow();
  std::vector<Candidate> floating(static_cast<std::size_t>(bodies));
  for (int body = 0; body < bodies; ++body) {
    const BodySpec& spec = model.bodies[static_cast<std::size_t>(body)];
    if (is_reached(body)) continue;
    Candidate& c = floating[static_cast<std::size_t>(body)];
    c.names.assign(kAxes, kAxes + (spec.point_mass ? 3 : 6));
    lead_to({.b = body, .free = FreeMotion(c.names, false)}, &c);
    grow();
  }
  // Coordinates in the order of the model's joints, then of free bodies.
  std::vector<std::size_t> order(joints_.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  std::ranges::stable_sort(order, [&](std::size_t x, std::size_t y) {
    const auto rank = [&](std::size_t k) {
      const TreeJoint& j = joints_[k];
      return j.joint >= 0 ? std::pair(0, j.joint) : std::pair(1, j.b);
    };
    return rank(x) < rank(y);
  });
  for (std::size_t k : order) {
    TreeJoint& joint = joints_[k];
    joint.first = size();
    const std::vector<std::string>& names = of[k]->names;
    const bool is_free = joint.joint < 0;
    const std::string& name = is_free ? model.bodies[static_cast<std::size_t>(joint.b)].name
                                      : model.joints[static_cast<std::size_t>(joint.joint)].name;
    for (const std::string& coordinate : names)
      names_.push_back({.name = name_of(name, coordinate, names.size()),
                        .joint = joint.joint,
                        .body = is_free ? joint.b : kGround,
                        .coordinate = coordinate,
                        .turns = coordinate.size() == 2});
  }
}

PlacedFrames TreeSpace::frames(const TreeJoint& joint, const Motions& motions) const {
  PlacedFrames at{joint.R_a, joint.R_b, joint.Z_b};
  if (joint.a != kGround) at.R_a = motions[static_cast<std::size_t>(joint.a)].q * joint.R_a;
  if (joint.b != kGround) {
    const BodyMotion& m = motions[static_cast<std::size_t>(joint.b)];
    at.R_b = m.q * joint.R_b;
    at.x_b = m.r + m.q * joint.Z_b;
  }
  return at;
}

RelativePose TreeSpace::pose(const TreeJoint& joint, const Motions& motions) const {
  const PlacedFrames at = frames(joint, motions);
  Vec3 x_a = joint.Z_a;
  if (joint.a != kGround) {
    const BodyMotion& m = motions[static_cast<std::size_t>(joint.a)];
    x_a = m.r + m.q * joint.Z_a;
  }
  return {at.R_a.transpose() * (at.x_b - x_a), at.R_a.transpose() * at.R_b};
}

Eigen::VectorXd TreeSpace::read(const Motions& motions, std::span<const double> near) const {
  Eigen::VectorXd q(size());
  for (const TreeJoint& joint : joints_) {
    joint.free.read(pose(joint, motions), q.data() + joint.first);
    for (int k = 0; k < joint.free.size() && !near.empty(); ++k) {
      if (!joint.free.counts_turns(k)) continue;
      double& angle = q[joint.first + k];
      const double turn = 2.0 * std::numbers::pi;
      angle += turn * std::round((near[static_cast<std::size_t>(joint.first + k)] - angle) / turn);
    }
  }
  return q;
}

void TreeSpace::place(const Eigen::VectorXd& q, Motions& motions) const {
  for (const TreeJoint& joint : joints_) {
    const RelativePose pose = joint.free.pose(q.data() + joint.first);
    const BodyMotion ground;
    BodyMotion& child = motions[static_cast<std::size_t>(joint.child())];
    const BodyMotion& parent =
        joint.parent() == kGround ? ground : motions[static_cast<std::size_t>(joint.parent())];
    const Mat3 parent_axes = parent.Lambda();
    const Quat kept = child.q;
    child = BodyMotion();
    if (joint.is_free_point()) {
      child.q = kept;
      child.r = pose.d;
    } else if (joint.from_a) {
      const Mat3 R_a = parent_axes * joint.R_a;
      const Mat3 Lambda = R_a * pose.R * joint.R_b.transpose();
      child.q = Quat(Lambda).normalized();
      child.r = parent.r + parent_axes * joint.Z_a + R_a * pose.d - child.q * joint.Z_b;
    } else {
      const Mat3 R_b = parent_axes * joint.R_b;
      const Mat3 R_a = R_b * pose.R.transpose();
      child.q = Quat(Mat3(R_a * joint.R_a.transpose())).normalized();
      child.r = parent.r + parent_axes * joint.Z_b - R_a * pose.d - child.q * joint.Z_a;
    }
  }
}

void TreeSpace::by_coordinates(const Eigen::VectorXd& q, Eigen::MatrixXd& G) const {
  for (const TreeJoint& joint : joints_)
    if (joint.free.has_spin()) {
      const int last = joint.first + joint.free.size() - 3;
      G.middleCols(last, 3) *= joint.free.spin(q.data() + joint.first);
    }
}

double TreeSpace::size_of(const Eigen::VectorXd& change, double length) const {
  double size = 0.0;
  for (int k = 0; k < this->size(); ++k)
    size = std::max(
        size, std::abs(change[k]) / (names_[static_cast<std::size_t>(k)].turns ? 1.0 : length));
  return size;
}

TreeSpace::Sweep TreeSpace::sweep(const Motions& motions) const {
  Sweep sweep;
  sweep.s.resize(names_.size());
  const Eigen::VectorXd q = read(motions, {});
  for (const TreeJoint& joint : joints_) {
    MotionVector* s = sweep.s.data() + joint.first;
    joint.free.directions(frames(joint, motions), q.data() + joint.first, s);
    for (int k = 0; k < joint.free.size() && !joint.from_a; ++k) s[k] = -1.0 * s[k];
  }
  return sweep;
}

TreeSpace::Sweep TreeSpace::sweep(const Motions& motions, const Eigen::VectorXd& rates) const {
  Sweep sweep = this->sweep(motions);
  std::vector<MotionVector> s_dot(kMostFree);
  sweep.twist.resize(motions.size());
  sweep.acceleration.resize(motions.size());
  const Eigen::VectorXd q = read(motions, {});
  for (const TreeJoint& joint : joints_) {
    const auto child = static_cast<std::size_t>(joint.child());
    MotionVector of_parent, acceleration;
    if (joint.parent() != kGround) {
      of_parent = sweep.twist[static_cast<std::size_t>(joint.parent())];
      acceleration = sweep.acceleration[static_cast<std::size_t>(joint.parent())];
    }
    MotionVector of_child = of_parent;
    for (int k = 0; k < joint.free.size(); ++k)
      of_child += rates[joint.first + k] * sweep.s[static_cast<std::size_t>(joint.first + k)];
    joint.free.direction_rates(frames(joint, motions), q.data() + joint.first,
                               rates.data() + joint.first, joint.from_a ? of_parent : of_child,
                               joint.from_a ? of_child : of_parent, s_dot.data());
    for (int k = 0; k < joint.free.size(); ++k)
      acceleration +=
          (joint.from_a ? 1.0 : -1.0) * rates[joint.first + k] * s_dot[static_cast<std::size_t>(k)];
    sweep.twist[child] = of_child;
    sweep.acceleration[child] = acceleration;
  }
  return sweep;
}

void TreeSpace::set_velocities(const Sweep& sweep, Motions& motions) {
  for (std::size_t i = 0; i < motions.size(); ++i) {
    BodyMotion& m = motions[i];
    m.v = sweep.twist[i].at(m.r);
    m.W = m.q.conjugate() * sweep.twist[i].angular;
  }
}

Eigen::VectorXd TreeSpace::project(const Sweep& sweep, std::vector<Vec6> wrenches) const {
  Eigen::VectorXd sums(size());
  for (auto joint = joints_.rbegin(); joint != joints_.rend(); ++joint) {
    const Vec6& w = wrenches[static_cast<std::size_t>(joint->child())];
    for (int k = joint->first; k < joint->first + joint->free.size(); ++k) {
      const MotionVector& s = sweep.s[static_cast<std::size_t>(k)];
      sums[k] = s.linear.dot(w.head<3>()) + s.angular.dot(w.tail<3>());
    }
    if (joint->parent() != kGround) wrenches[static_cast<std::size_t>(joint->parent())] += w;
  }
  return sums;
}

double TreeSpace::rate(const Motions& motions, const Sweep& sweep, int coordinate) const {
  for (const TreeJoint& joint : joints_) {
    if (coordinate < joint.first || coordinate >= joint.first + joint.free.size()) continue;
    const auto twist = [&](int body) -> MotionVector {
      if (body == kGround) return {};
      const BodyMotion& m = motions[static_cast<std::size_t>(body)];
      const Vec3 omega = m.q * m.W;
      return {m.v - omega.cross(m.r), omega};
    };
    // The nearest rates to the relative motion as seen at the joint's point.
    const Vec3 x = frames(joint, motions).x_b;
    const MotionVector of_child = twist(joint.child()), of_parent = twist(joint.parent());
    Vec6 relative;
    relative << of_child.at(x) - of_parent.at(x), of_child.angular - of_parent.angular;
    Eigen::Matrix<double, 6, Eigen::Dynamic> S(6, joint.free.size());
    for (int k = 0; k < joint.free.size(); ++k) {
      const MotionVector& s = sweep.s[static_cast<std::size_t>(joint.first + k)];
      S.col(k) << s.at(x), s.angular;
    }
    const Eigen::VectorXd rates = S.colPivHouseholderQr().solve(relative);
    return rates[coordinate - joint.first];
  }
  return 0.0;
}

Eigen::MatrixXd TreeSpace::jacobian(const Sweep& sweep, int body, const Vec3& x) const {
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(6, size());
  for (int b = body; b != kGround && joint_to(b) >= 0;) {
    const TreeJoint& joint = joints_[static_cast<std::size_t>(joint_to(b))];
    for (int k = joint.first; k < joint.first + joint.free.size(); ++k) {
      const MotionVector& s = sweep.s[static_cast<std::size_t>(k)];
      J.col(k) << s.at(x), s.angular;
    }
    b = joint.parent();
  }
  return J;
}

}  // namespace polhode
