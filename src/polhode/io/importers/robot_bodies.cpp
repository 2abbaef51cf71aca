// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/importers/robot_bodies.hpp>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <utility>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>

namespace polhode::io {

namespace {

using geometry::MassProperties;

/// Part of the next body's mass and inertia that a link without mass takes; the relative error of
/// the motion is about as large. Below 1e-12 the initial velocities of models with inerters at such
/// a link lose accuracy.
constexpr double kNoMass = 1e-10;

/// Singular values of joint axes below this part of the largest are zero.
constexpr double kSameMotion = 1e-9;

constexpr const char* kPartial = "Give it, or allow a partial import to hold its joint.";

/// Reason why mass properties are no rigid body's; "" if they are.
std::string unsound(const MassProperties& m) {
  if (!(m.mass > 0.0)) return "has no mass";
  if (m.inertia.isZero(0.0)) return "has no inertia";
  try {
    geometry::check_mass_properties("", m.mass, m.inertia);
  } catch (const InputError& error) {
    return "cannot have its inertia: " + error.what_is_wrong();
  }
  return "";
}

class BodyFormer {
  template <class T>
  static auto& at(std::vector<T>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
  template <class T>
  static const auto& at(const std::vector<T>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
  static std::vector<bool>::reference at(std::vector<bool>& list, int i) {
    return list[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] const RobotLink& link(int i) const { return at(robot_.links, i); }
  [[nodiscard]] const RobotJoint& joint(int j) const { return at(robot_.joints, j); }

 public:
  BodyFormer(const Robot& robot, const ImportOptions& options, XmlFile& xml,
             Diagnostics& diagnostics, std::vector<ImportNote>& notes, RobotTree& tree)
      : robot_(robot),
        options_(options),
        xml_(xml),
        diagnostics_(diagnostics),
        notes_(notes),
        tree_(tree) {}

  void form() {
    for (bool again = true; again && diagnostics_.empty();) {
      group();
      again = hold_massless();
    }
    for (const auto& [i, below] : light_) {
      if (link(i).name_in_file)
        notes_.push_back({ImportNote::Kind::approximated, xml_.place(*link(i).at),
                          format("the link {} has no mass, and takes {} of that of {}",
                                 quote(link(i).name), kNoMass, quote(link(below).name))});
      // Its mass and inertia are taken from that body: the sums remain.
      MassProperties& mass = at(tree_.mass, below);
      MassProperties& own = at(tree_.mass, i);
      own = {kNoMass * mass.mass, Vec3::Zero(),
             kNoMass * geometry::principal_axes(mass.inertia).moments[0] * Mat3::Identity()};
      MassProperties taken = own;
      taken.mass = -taken.mass;
      taken.inertia = -taken.inertia;
      const Pose between = at(tree_.world, below).inverse() * at(tree_.world, i);
      const MassProperties parts[2] = {mass, geometry::placed(taken, between.p, between.R)};
      mass = geometry::composed(parts);
    }
  }

 private:
  [[nodiscard]] bool is_rigid(int j) { return joint(j).type == "fixed" || at(tree_.held, j); }

  void group() {
    const std::size_t n = robot_.links.size();
    tree_.grounded.assign(n, false);
    tree_.body.resize(n);
    std::iota(tree_.body.begin(), tree_.body.end(), 0);
    tree_.mass.resize(n);
    for (std::size_t i = 0; i < n; ++i) tree_.mass[i] = robot_.links[i].mass;
    if (options_.base == "fixed") at(tree_.grounded, tree_.root) = true;
    for (const int i : tree_.order)
      if (const int j = at(tree_.parent_joint, i); j >= 0 && is_rigid(j))
        at(tree_.grounded, i) = at(tree_.grounded, at(tree_.parent, j));
    // Parents first, so that a chain of links without mass is merged in one pass; links below a
    // root without mass in the second.
    for (bool changed = true; changed;) {
      changed = false;
      for (const int i : tree_.order) {
        const int j = at(tree_.parent_joint, i);
        if (j < 0 || !is_rigid(j)) continue;
        const int above = body_of(at(tree_.parent, j)), own = body_of(i);
        if (above == own || !merges(j, above, own)) continue;
        unite(above, own);
        changed = true;
      }
    }
    for (const int i : tree_.order) at(tree_.body, i) = body_of(i);
  }

  /// Whether two bodies that a rigid joint connects become one. Fixed ones need no mass, but one
  /// whose inertia is no rigid body's would lose it.
  [[nodiscard]] bool merges(int j, int above, int own) {
    const auto loses = [&](int i) {
      const MassProperties& m = at(tree_.mass, i);
      return !m.inertia.isZero(0.0) && !unsound(m).empty();
    };
    if (at(tree_.grounded, own)) return loses(above) || loses(own);
    return options_.fixed_joints == "merge" || at(tree_.held, j) ||
           !unsound(at(tree_.mass, own)).empty() || !unsound(at(tree_.mass, above)).empty();
  }

  int body_of(int i) {
    while (at(tree_.body, i) != i) i = at(tree_.body, i) = at(tree_.body, at(tree_.body, i));
    return i;
  }

  /// Makes one body of two. Its name is that of the upper one, or of the lower one if only that
  /// has mass.
  void unite(int above, int own) {
    const bool lower = at(tree_.mass, above).mass == 0.0 && at(tree_.mass, own).mass > 0.0;
    const int kept = lower ? own : above, given = lower ? above : own;
    const Pose between = at(tree_.world, kept).inverse() * at(tree_.world, given);
    const MassProperties parts[2] = {at(tree_.mass, kept),
                                     geometry::placed(at(tree_.mass, given), between.p, between.R)};
    if (parts[0].mass == 0.0 || parts[1].mass == 0.0) {
      MassProperties& whole = at(tree_.mass, kept);
      if (parts[0].mass == 0.0) whole = parts[1];
      whole.inertia = parts[0].inertia + parts[1].inertia;
    } else {
      at(tree_.mass, kept) = geometry::composed(parts);
    }
    at(tree_.body, given) = kept;
  }

  /// The first body with mass below another one. @param joints  Those between them are added.
  /// @returns −1 if there is none.
  int massive_below(int body, std::vector<int>& joints) {
    for (const int i : tree_.order) {
      const int j = at(tree_.parent_joint, i), own = at(tree_.body, i);
      if (j < 0 || own == body || at(tree_.body, at(tree_.parent, j)) != body) continue;
      const int found = unsound(at(tree_.mass, own)).empty() ? own : massive_below(own, joints);
      if (found < 0) continue;
      joints.push_back(j);
      return found;
    }
    return -1;
  }

  /// A body with mass at the other end of a joint that closes a loop; behind the world, where that
  /// is the ground, the body above. @param joints  That joint is added.
  /// @returns −1 if there is none.
  int massive_beside(int body, std::vector<int>& joints) {
    for (std::size_t k = 0; k < robot_.joints.size(); ++k) {
      const int j = static_cast<int>(k);
      if (!joint(j).closes) continue;
      const int a = at(tree_.body, at(tree_.parent, j)), b = at(tree_.body, at(tree_.child, j));
      if (a != body && b != body) continue;
      const int own = a == body ? b : a;
      const int above = at(tree_.body, at(tree_.parent, at(tree_.parent_joint, body)));
      for (const int other : {own, above})
        if (!at(tree_.grounded, other) && unsound(at(tree_.mass, other)).empty()) {
          joints.push_back(j);
          return other;
        }
    }
    return -1;
  }

  /// Whether the motions of joints are independent in the start, so that a body with mass below
  /// them determines the motion of links without mass.
  [[nodiscard]] bool independent(const std::vector<int>& joints) {
    std::vector<Vec6> screws;
    for (const int j : joints) {
      const RobotJoint& joint = this->joint(j);
      if (!joint.is_single() && joint.type != "spherical") return false;
      const Pose frame = at(tree_.world, at(tree_.parent, j)) * joint.origin;
      for (int k = 0; k < (joint.is_single() ? 1 : 3); ++k) {
        const Vec3 axis = frame.R * (joint.is_single() ? joint.axis : Vec3::Unit(k));
        Vec6 screw;
        if (joint.type == "prismatic")
          screw << Vec3::Zero(), axis;
        else
          screw << axis, frame.p.cross(axis) + joint.pitch / (2.0 * std::numbers::pi) * axis;
        screws.push_back(screw);
      }
    }
    if (screws.size() > 6) return false;
    Eigen::MatrixXd all(6, static_cast<Eigen::Index>(screws.size()));
    for (std::size_t k = 0; k < screws.size(); ++k)
      all.col(static_cast<Eigen::Index>(k)) = screws[k];
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(all).singularValues();
    return values.size() > 0 && values.minCoeff() > kSameMotion * values.maxCoeff();
  }

  /// Body with mass that determines the motion of a link without mass between moving joints; −1 if
  /// there is none. @param top  By body: its uppermost joint.
  int determines(int body, const std::vector<int>& top) {
    std::vector<int> joints;
    int below = massive_below(body, joints);
    if (below < 0) below = massive_beside(body, joints);
    if (below < 0) return -1;
    for (int above = body; !at(tree_.grounded, above) && !unsound(at(tree_.mass, above)).empty();) {
      const int j = at(top, above);
      if (j < 0) return -1;
      joints.push_back(j);
      above = at(tree_.body, at(tree_.parent, j));
    }
    return independent(joints) ? below : -1;
  }

  /// Holds joints of links that have no mass. @returns whether there are new ones.
  bool hold_massless() {
    std::vector<bool> carries(robot_.links.size(), false);  // By body: a joint below it.
    std::vector<int> top(robot_.links.size(), -1);          // By body: its uppermost joint.
    for (const int i : tree_.order) {
      const int j = at(tree_.parent_joint, i);
      if (j < 0) continue;
      const int own = at(tree_.body, i), above = at(tree_.body, at(tree_.parent, j));
      if (own == above) continue;
      at(carries, above) = true;
      if (at(top, own) < 0) at(top, own) = j;
    }
    for (const RobotLoop& loop : robot_.loops)
      for (const std::string& name : loop.links)
        if (const auto found = tree_.link_index.find(name); found != tree_.link_index.end())
          at(carries, at(tree_.body, found->second)) = true;
    for (const RobotJoint& joint : robot_.joints)
      if (joint.closes)
        for (const std::string& name : {joint.parent, joint.child})
          at(carries, at(tree_.body, tree_.link_index.at(name))) = true;
    bool again = false;
    light_.clear();
    for (const int i : tree_.order) {
      if (at(tree_.body, i) != i || at(tree_.grounded, i)) continue;
      const MassProperties& mass = at(tree_.mass, i);
      const std::string reason = unsound(mass);
      if (reason.empty()) continue;
      const int j = at(top, i);
      const bool empty = mass.mass == 0.0 && mass.inertia.isZero(0.0) && !at(carries, i);
      if (j >= 0 && (empty || options_.allow_partial)) {
        at(tree_.held, j) = true;
        again = true;
        notes_.push_back({empty ? ImportNote::Kind::approximated : ImportNote::Kind::left_out,
                          xml_.place(*link(i).at),
                          format("the link {} {}: its joint {} is held{}", quote(link(i).name),
                                 empty ? "has no mass" : reason, quote(joint(j).name),
                                 empty ? ", which changes no other motion" : "")});
        continue;
      }
      if (mass.mass == 0.0 && mass.inertia.isZero(0.0) && at(carries, i))
        if (const int below = determines(i, top); below >= 0) {
          light_.emplace_back(i, below);
          continue;
        }
      xml_.fault(
          *link(i).at,
          format(
              "the link {} {}{}", quote(link(i).name), reason,
              j >= 0 && at(carries, i) && mass.mass == 0.0 ? ", but moves between two joints" : ""),
          j >= 0 ? kPartial : "Give it, or let the base be fixed.");
    }
    return again;
  }

  const Robot& robot_;
  const ImportOptions& options_;
  XmlFile& xml_;
  Diagnostics& diagnostics_;
  std::vector<ImportNote>& notes_;
  RobotTree& tree_;
  /// Links without mass that move between joints, each with a body whose motion determines its own.
  std::vector<std::pair<int, int>> light_;
};

}  // namespace

void form_bodies(const Robot& robot, const ImportOptions& options, XmlFile& xml,
                 Diagnostics& diagnostics, std::vector<ImportNote>& notes, RobotTree& tree) {
  BodyFormer(robot, options, xml, diagnostics, notes, tree).form();
}

}  // namespace polhode::io
