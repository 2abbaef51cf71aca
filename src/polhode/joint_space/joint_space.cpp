// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/joint_space/body_momentum.hpp>
#include <polhode/joint_space/loop_rows.hpp>
#include <polhode/joint_space/tree_space.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

using Motions = JointSpace::Motions;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Parts of rows below this one of their largest terms are rounding of redundant rows [-].
constexpr double kRedundant = 1e-9;
/// Rows hold if their values are below this part of their terms, and no iteration improves them.
constexpr double kClosed = 1e-13;
/// Largest change of a coordinate while a loop is followed [rad, or of the mechanism's size], and
/// the smallest one of the given coordinates.
constexpr double kLargestPart = 0.25, kSmallestPart = 1e-7;
/// Largest correction of a predicted change of the coordinates, over that change [-].
constexpr double kCorrection = 0.5;
/// A column whose part is this much smaller than the largest one is a poor choice [-].
constexpr double kPoor = 1e-2;
/// Iterations from a position that was predicted, and from the one described.
constexpr int kMaxIterations = 20, kFirstIterations = 100;

std::vector<double> list_of(const VectorXd& x) { return {x.begin(), x.end()}; }
VectorXd vector_of(std::span<const double> x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
}

void refuse_others(const Model& model, std::span<const std::string> released) {
  const auto acts = [&](const std::string& name) {
    return std::ranges::find(released, name) == released.end();
  };
  if (!model.solids.empty())
    throw InputError(format("solids.{}", model.solids.front().name),
                     "deforms, and has no coordinates of joints", "Leave it out of the model");
  for (const BodySpec& body : model.bodies)
    if (!body.node_of.empty() && !body.fixed)
      throw InputError(
          format("bodies.{}", body.name),
          format("is a node of '{}', which has no coordinates of joints", body.node_of),
          "Leave beams and meshed cables out of the model");
  for (const JointSpec& joint : model.joints)
    if (joint.motion && acts(joint.name))
      throw InputError(format("joints.{}.motion", joint.name),
                       "moves a frame with time, so that coordinates do not determine the position",
                       "Give the motion to a motor of a joint");
  for (const LoadSpec& load : model.loads)
    if (load.solid < 0 && load_kind(load.type).place == LoadPlace::wheel && acts(load.name))
      throw InputError(format("loads.{}", load.name),
                       "rolls, which restricts velocities but no coordinates",
                       "Leave it out of the model");
}

/// An inerter along a coordinate of the tree.
struct Inertance {
  int coordinate = 0;
  double value = 0.0;
};

}  // namespace

struct JointSpace::Impl {
  Impl(const Model& given, std::span<const std::string> preferred,
       std::span<const std::string> released)
      : model(given), tree((refuse_others(given, released), given), preferred, released) {
    for (BodySpec& body : model.bodies) {
      BodyMotion m;
      m.r = body.position;
      m.q = body.orientation.normalized();
      m.v = body.velocity;
      m.W = m.q.conjugate() * body.angular_velocity;
      start.push_back(m);
      // an inertia without effect on the motion, which keeps M regular
      if (body.point_mass) body.inertia = body.mass * Mat3::Identity();
    }
    for (const LoadSpec& load : model.loads)
      if (std::ranges::find(released, load.name) == released.end()) add_inertance(load);
    rows.emplace(model, tree, released);
    if (rows->size() == 0) rows.reset();
    choose(preferred);
  }

  void add_inertance(const LoadSpec& load) {
    if (load.solid >= 0 || load_kind(load.type).parts == 1) return;
    const int joint = model.joint_index(load.joint);
    for (int k = 0; k < tree.size(); ++k) {
      const IndependentCoordinate& c = tree.coordinates()[static_cast<std::size_t>(k)];
      if (c.joint != joint) continue;
      if (load.coordinate.empty() ? c.turns == load_kind(load.type).turns
                                  : c.coordinate == load.coordinate) {
        const auto given = load.parameters.find("inertance");
        inertances.push_back({k, given != load.parameters.end() ? given->second : 0.0});
        return;
      }
    }
    unplaced_inerter.emplace(format("loads.{}", load.name),
                             "acts in a joint that closes a loop, where it has no coordinate",
                             "Name that joint before others of the loop");
  }

  /// Whether a coordinate has a name that is given; joints come before free bodies.
  [[nodiscard]] bool is_named(const IndependentCoordinate& c, const std::string& name) const {
    if (c.name != name) return false;
    return c.joint >= 0 || !is_of_joint(name);
  }
  [[nodiscard]] bool is_of_joint(const std::string& name) const {
    return std::ranges::find(tree.closing(), name) != tree.closing().end() ||
           std::ranges::any_of(tree.coordinates(), [&](const IndependentCoordinate& c) {
             return c.joint >= 0 && c.name == name;
           });
  }

  /// Chooses the independent coordinates, so that rows determine the others: first those of free
  /// bodies, then of joints, and those that are preferred last.
  void choose(std::span<const std::string> preferred) {
    const int n = tree.size();
    std::array<std::vector<int>, 3> classes;
    for (int k = 0; k < n; ++k) {
      const IndependentCoordinate& c = tree.coordinates()[static_cast<std::size_t>(k)];
      const bool is_preferred = std::ranges::any_of(
          preferred, [&](const std::string& name) { return is_named(c, name); });
      classes[is_preferred ? 2 : c.joint >= 0 ? 1 : 0].push_back(k);
    }
    std::vector<char> dependent(static_cast<std::size_t>(n), 0);
    if (rows) {
      history = rows->first_history();
      const LoopRows::Values v = rows->at(start, tree.sweep(start), history);
      MatrixXd left = v.G;
      const double rounding = kRedundant * v.scale;
      for (std::size_t of = 0; of < classes.size(); ++of)
        for (;;) {
          double largest = 0.0;
          for (int k : classes[of]) largest = std::max(largest, left.col(k).cwiseAbs().maxCoeff());
          if (!(largest > rounding)) break;
          const double least = of == 0 ? largest : kPoor * largest;
          const int k = *std::find_if(classes[of].rbegin(), classes[of].rend(), [&](int x) {
            return left.col(x).cwiseAbs().maxCoeff() >= least;
          });
          Eigen::Index pivot = 0;
          left.col(k).cwiseAbs().maxCoeff(&pivot);
          dependent[static_cast<std::size_t>(k)] = 1;
          const Eigen::RowVectorXd row = left.row(pivot) / left(pivot, k);
          left -= left.col(k) * row;
          left.row(pivot).setZero();
          left.col(k).setZero();
        }
    }
    for (int k = 0; k < n; ++k) {
      (dependent[static_cast<std::size_t>(k)] != 0 ? dependents : independents).push_back(k);
      if (dependent[static_cast<std::size_t>(k)] == 0)
        coordinates.push_back(tree.coordinates()[static_cast<std::size_t>(k)]);
    }
    for (const std::string& name : preferred) {
      if (std::ranges::any_of(coordinates,
                              [&](const IndependentCoordinate& c) { return is_named(c, name); }))
        continue;
      const bool known =
          is_of_joint(name) ||
          std::ranges::any_of(tree.coordinates(),
                              [&](const IndependentCoordinate& c) { return c.name == name; });
      std::vector<std::string> names;
      for (const IndependentCoordinate& c : coordinates) names.push_back(c.name);
      throw InputError(name,
                       known ? "follows from the other coordinates of its loop at the position "
                               "described, and cannot lead"
                             : "is not a coordinate of a joint or free body",
                       known ? "Leave it or another one out, or describe a position away from dead "
                               "centres"
                             : "There are: " + name_list(names));
    }
  }

  [[nodiscard]] VectorXd all_of(const Motions& motions) const { return tree.read(motions, {}); }

  /// Rates of all coordinates by those of the independent ones, G N = 0.
  [[nodiscard]] MatrixXd transmission(const LoopRows::Values& v) const {
    MatrixXd N = MatrixXd::Zero(tree.size(), static_cast<Eigen::Index>(independents.size()));
    for (std::size_t i = 0; i < independents.size(); ++i)
      N(independents[i], static_cast<Eigen::Index>(i)) = 1.0;
    if (independents.empty() || dependents.empty()) return N;
    const MatrixXd follow = dependent_part(v).solve(-v.G(Eigen::all, independents));
    for (std::size_t i = 0; i < dependents.size(); ++i)
      N.row(dependents[i]) = follow.row(static_cast<Eigen::Index>(i));
    return N;
  }
  /// All coordinates, or their rates, that solve G x = b with independent ones of zero.
  [[nodiscard]] VectorXd solve_dependent(const LoopRows::Values& v, const VectorXd& b) const {
    VectorXd all = VectorXd::Zero(tree.size());
    if (dependents.empty()) return all;
    const VectorXd follow = dependent_part(v).solve(b);
    for (std::size_t i = 0; i < dependents.size(); ++i)
      all[dependents[i]] = follow[static_cast<Eigen::Index>(i)];
    return all;
  }
  [[nodiscard]] Eigen::CompleteOrthogonalDecomposition<MatrixXd> dependent_part(
      const LoopRows::Values& v) const {
    const MatrixXd G = v.G(Eigen::all, dependents);
    const double largest = G.colwise().norm().maxCoeff();
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> part;
    part.setThreshold(largest > 0.0 ? kRedundant * std::max(1.0, v.scale / largest) : kRedundant);
    part.compute(G);
    return part;
  }

  [[nodiscard]] MatrixXd tree_mass(const Motions& motions, const TreeSpace::Sweep& sweep) const {
    if (unplaced_inerter) throw InputError(*unplaced_inerter);
    std::vector<Mat6> carried(motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i)
      carried[i] = mass_of(model.bodies[i], motions[i]);
    MatrixXd M = MatrixXd::Zero(tree.size(), tree.size());
    const auto& joints = tree.joints();
    for (auto joint = joints.rbegin(); joint != joints.rend(); ++joint) {
      const Mat6& of_child = carried[static_cast<std::size_t>(joint->child())];
      for (int k = joint->first; k < joint->first + joint->free.size(); ++k) {
        const MotionVector& s = sweep.s[static_cast<std::size_t>(k)];
        Vec6 direction;
        direction << s.linear, s.angular;
        const Vec6 h = of_child * direction;
        for (const TreeJoint* up = &*joint;;) {
          for (int l = up->first; l < up->first + up->free.size(); ++l) {
            const MotionVector& t = sweep.s[static_cast<std::size_t>(l)];
            M(k, l) = M(l, k) = t.linear.dot(h.head<3>()) + t.angular.dot(h.tail<3>());
          }
          const int next = up->parent() == kGround ? -1 : tree.joint_to(up->parent());
          if (next < 0) break;
          up = &joints[static_cast<std::size_t>(next)];
        }
      }
      if (joint->parent() != kGround)
        carried[static_cast<std::size_t>(joint->parent())] += of_child;
    }
    return M;
  }

  /// Everything that depends on the position alone.
  struct Position {
    TreeSpace::Sweep sweep;
    LoopRows::Values loop;
    MatrixXd N;            ///< Empty without loops.
    MatrixXd M;            ///< Of the tree.
    bool inerters = true;  ///< M contains them.
  };
  /// @param inerters  Whether M contains them.
  [[nodiscard]] Position position(const Motions& motions, bool inerters = true) const {
    Position p{.sweep = tree.sweep(motions), .loop = {}, .N = {}, .M = {}, .inerters = inerters};
    if (rows) {
      p.loop = rows->at(motions, p.sweep, history);
      p.N = transmission(p.loop);
    }
    p.M = tree_mass(motions, p.sweep);
    for (const Inertance& i : inertances)
      if (inerters) p.M(i.coordinate, i.coordinate) += i.value;
    return p;
  }
  [[nodiscard]] VectorXd onto(const Position& p, const VectorXd& of_tree) const {
    return rows ? VectorXd(p.N.transpose() * of_tree) : of_tree;
  }
  [[nodiscard]] MatrixXd mass(const Position& p) const {
    return rows ? MatrixXd(p.N.transpose() * p.M * p.N) : p.M;
  }

  [[nodiscard]] VectorXd rates(const Position& p, const Motions& motions) const {
    if (independents.empty()) return VectorXd(0);
    std::vector<Vec6> momenta(motions.size(), Vec6::Zero());
    for (std::size_t i = 0; i < motions.size(); ++i)
      if (!model.bodies[i].fixed) momenta[i] = momentum_of(model.bodies[i], motions[i]);
    VectorXd momentum = tree.project(p.sweep, std::move(momenta));
    if (!p.inerters) return mass(p).ldlt().solve(onto(p, momentum));
    for (const Inertance& i : inertances)
      momentum[i.coordinate] += i.value * tree.rate(motions, p.sweep, i.coordinate);
    return mass(p).ldlt().solve(onto(p, momentum));
  }

  /// Second derivatives of all coordinates at constant rates of the independent ones.
  [[nodiscard]] VectorXd drift(const Position& p, const LoopRows::Values& moving) const {
    return solve_dependent(p.loop, -moving.gamma);
  }

  /// Motions with the velocities of given rates, and the sweep that belongs to them.
  [[nodiscard]] TreeSpace::Sweep set_moving(const Position& p, const VectorXd& qd,
                                            Motions& motions) const {
    TreeSpace::Sweep sweep = tree.sweep(motions, rows ? VectorXd(p.N * qd) : qd);
    TreeSpace::set_velocities(sweep, motions);
    return sweep;
  }

  [[nodiscard]] VectorXd velocity_forces(const Position& p, Motions motions) const {
    const TreeSpace::Sweep sweep = set_moving(p, rates(p, motions), motions);
    std::vector<Vec6> wrenches(motions.size(), Vec6::Zero());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (model.bodies[i].fixed) continue;
      const MotionVector& by = sweep.acceleration[i];
      const Vec3 a = by.at(motions[i].r) + sweep.twist[i].angular.cross(motions[i].v);
      wrenches[i] = momentum_rate_of(model.bodies[i], motions[i], a, by.angular);
    }
    VectorXd forces = tree.project(p.sweep, std::move(wrenches));
    if (rows) forces += p.M * drift(p, rows->at(motions, sweep, history));
    return onto(p, forces);
  }

  [[nodiscard]] VectorXd gravity_forces(const Position& p, const Motions& motions) const {
    std::vector<Vec6> wrenches(motions.size(), Vec6::Zero());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (model.bodies[i].fixed) continue;
      const Vec3 f = -model.bodies[i].mass * model.gravity;
      wrenches[i] << f, motions[i].r.cross(f);
    }
    return onto(p, tree.project(p.sweep, std::move(wrenches)));
  }

  [[noreturn]] void refuse_open(const LoopRows::Values& v) const {
    Eigen::Index worst = 0;
    v.g.cwiseAbs().maxCoeff(&worst);
    throw InputError(rows->name_of(static_cast<int>(worst)),
                     "cannot be closed at these coordinates", "Give coordinates that it can reach");
  }

  /// Brings the dependent coordinates onto the rows. @returns whether they hold.
  [[nodiscard]] bool close(VectorXd& q, Motions& motions, const LoopRows::History& turns,
                           double size, int iterations) const {
    double before = std::numeric_limits<double>::infinity();
    for (int i = 0; i < iterations; ++i) {
      tree.place(q, motions);
      LoopRows::Values v = rows->at(motions, tree.sweep(motions), turns);
      const double g = v.g.cwiseAbs().maxCoeff();
      if (!std::isfinite(g)) return false;
      double reach = size;
      for (const BodyMotion& m : motions) reach = std::max(reach, m.r.norm());
      const bool small = g <= kClosed * (reach + v.scale * q.cwiseAbs().maxCoeff());
      if (small && (g == 0.0 || g > 0.5 * before)) return true;
      if (dependents.empty()) return small;
      tree.by_coordinates(q, v.G);
      VectorXd change = solve_dependent(v, -v.g);
      const double part = tree.size_of(change, size);
      if (part > kLargestPart) change *= kLargestPart / part;
      q += change;
      before = g;
    }
    return false;
  }

  /// Follows the rows from a position to given independent coordinates, along their tangent: the
  /// branch of a loop is kept where others cross it.
  [[nodiscard]] Motions place(const Motions& from, const VectorXd& wanted) const {
    Motions motions = from;
    if (!rows) {
      tree.place(wanted, motions);
      return motions;
    }
    double size = 0.0;
    for (const BodyMotion& m : from) size = std::max(size, (m.r - from.front().r).norm());
    if (size == 0.0) size = 1.0;
    VectorXd q = all_of(from);
    const VectorXd first = q(independents);
    LoopRows::History turns = &from == &start ? history : rows->history_at(from, tree.sweep(from));
    if (!close(q, motions, turns, size, kFirstIterations))
      refuse_open(rows->at(motions, tree.sweep(motions), turns));
    double done = 0.0, part = 1.0;
    while (done < 1.0) {
      LoopRows::Values v = rows->at(motions, tree.sweep(motions), turns);
      tree.by_coordinates(q, v.G);
      const VectorXd way = transmission(v) * (wanted - first);
      const double length = tree.size_of(way, size);
      const double next = std::min(1.0, done + std::min(part, kLargestPart / length));
      VectorXd trial = q + (next - done) * way;
      trial(independents) = next < 1.0 ? VectorXd(first + next * (wanted - first)) : wanted;
      const VectorXd predicted = trial;
      Motions there = motions;
      if (close(trial, there, turns, size, kMaxIterations) &&
          tree.size_of(trial - predicted, size) <= kCorrection * (next - done) * length + kClosed) {
        q = trial;
        motions = std::move(there);
        rows->follow(motions, turns);
        part = 2.0 * (next - done);
        done = next;
        continue;
      }
      part = 0.5 * (next - done);
      VectorXd given = VectorXd::Zero(tree.size());
      given(independents) = part * (wanted - first);
      if (tree.size_of(given, size) < kSmallestPart) {
        tree.place(predicted, there);
        refuse_open(rows->at(there, tree.sweep(there), turns));
      }
    }
    return motions;
  }

  Model model;
  TreeSpace tree;
  Motions start;
  std::optional<LoopRows> rows;  ///< None without loops.
  LoopRows::History history;
  std::vector<int> independents, dependents;  ///< Coordinates of the tree.
  std::vector<IndependentCoordinate> coordinates;
  std::vector<Inertance> inertances;
  std::optional<InputError> unplaced_inerter;  ///< Refusal of equations with it.
};

JointSpace::JointSpace(const Model& model, std::span<const std::string> preferred,
                       std::span<const std::string> released)
    : impl_(std::make_unique<const Impl>(model, preferred, released)) {}
JointSpace::~JointSpace() = default;
JointSpace::JointSpace(JointSpace&&) noexcept = default;

const std::vector<IndependentCoordinate>& JointSpace::coordinates() const {
  return impl_->coordinates;
}

const JointSpace::Motions& JointSpace::model_motions() const { return impl_->start; }

std::vector<double> JointSpace::positions(const Motions& motions,
                                          std::span<const double> near) const {
  if (near.empty()) return list_of(impl_->all_of(motions)(impl_->independents));
  VectorXd all = VectorXd::Zero(impl_->tree.size());
  all(impl_->independents) = vector_of(near);
  return list_of(impl_->tree.read(motions, list_of(all))(impl_->independents));
}

std::vector<double> JointSpace::rates(const Motions& motions) const {
  return list_of(impl_->rates(impl_->position(motions), motions));
}

std::vector<double> JointSpace::second_rates(const Motions& motions, std::span<const Vec3> linear,
                                             std::span<const Vec3> angular) const {
  const Impl& s = *impl_;
  const Impl::Position p = s.position(motions, false);
  std::vector<Vec6> wrenches(motions.size(), Vec6::Zero());
  for (std::size_t i = 0; i < motions.size(); ++i)
    if (!s.model.bodies[i].fixed)
      wrenches[i] = momentum_rate_of(s.model.bodies[i], motions[i], linear[i], angular[i]);
  const VectorXd forces = s.onto(p, s.tree.project(p.sweep, std::move(wrenches)));
  return list_of(s.mass(p).ldlt().solve(forces - s.velocity_forces(p, motions)));
}

JointSpace::Motions JointSpace::place(const Motions& from, std::span<const double> positions,
                                      std::span<const double> rates) const {
  Motions motions = impl_->place(from, vector_of(positions));
  if (!rates.empty()) (void)impl_->set_moving(impl_->position(motions), vector_of(rates), motions);
  return motions;
}

std::vector<double> JointSpace::mass_matrix(const Motions& motions) const {
  const MatrixXd M = impl_->mass(impl_->position(motions));
  return {M.data(), M.data() + M.size()};
}

std::vector<double> JointSpace::velocity_forces(const Motions& motions) const {
  return list_of(impl_->velocity_forces(impl_->position(motions), motions));
}

std::vector<double> JointSpace::gravity_forces(const Motions& motions) const {
  return list_of(impl_->gravity_forces(impl_->position(motions), motions));
}

std::vector<double> JointSpace::inverse_dynamics(const Motions& motions,
                                                 std::span<const double> second) const {
  const Impl::Position p = impl_->position(motions);
  return list_of(impl_->mass(p) * vector_of(second) + impl_->velocity_forces(p, motions) +
                 impl_->gravity_forces(p, motions));
}

std::vector<double> JointSpace::jacobian(const Motions& motions, int body,
                                         const Vec3& point) const {
  const Impl::Position p = impl_->position(motions);
  const BodyMotion& m = motions.at(static_cast<std::size_t>(body));
  MatrixXd J = impl_->tree.jacobian(p.sweep, body, m.r + m.q * point);
  if (impl_->rows) J *= p.N;
  std::vector<double> list;
  for (Eigen::Index i = 0; i < J.rows(); ++i)
    for (Eigen::Index k = 0; k < J.cols(); ++k) list.push_back(J(i, k));
  return list;
}

}  // namespace polhode
