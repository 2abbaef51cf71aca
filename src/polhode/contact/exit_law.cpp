// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Eigenvalues>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

/// One velocity that impacts change: w_b − w_a along a row, and what it shall be.
struct ContactSet::ImpactRow {
  VelocityRow row;
  double before = 0.0, wanted = 0.0;
  int point = -1;  ///< −1: a row of a joint.
};

namespace {

/// Eigenvalues of J M⁻¹ Jᵀ below this part of the largest count as zero.
constexpr double kPseudoInverse = 1e-9;

/// An island with more contacts than this and no joints is settled one contact after the other.
constexpr int kTogether = 48;
constexpr int kSweeps = 10;

}  // namespace

/// Groups of rows that share moving bodies, each in the order of the rows.
std::vector<std::vector<int>> ContactSet::islands(std::span<const ImpactRow> rows, int bodies) {
  std::vector<int> root(static_cast<std::size_t>(bodies));
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const ImpactRow& r : rows)
    if (r.row.a != kGround && r.row.b != kGround) {
      const int x = find(r.row.a), y = find(r.row.b);
      root[std::max(x, y)] = std::min(x, y);
    }
  std::map<int, std::vector<int>> by_root;
  for (int k = 0; k < static_cast<int>(rows.size()); ++k)
    by_root[find(rows[k].row.a != kGround ? rows[k].row.a : rows[k].row.b)].push_back(k);
  std::vector<std::vector<int>> result;
  for (auto& [key, list] : by_root) {
    const bool hit =
        std::any_of(list.begin(), list.end(), [&](int k) { return rows[k].point >= 0; });
    if (hit) result.push_back(std::move(list));
  }
  return result;
}

/// Each impulse takes energy, in whatever order.
void ContactSet::settle_in_turn(std::span<const ImpactRow> rows, const std::vector<int>& island,
                                std::map<int, BodyMotion>& motions, VelocityJump& jump) {
  struct Side {
    BodyMotion* motion;
    Mat3 inverse_inertia;
    double mass;
  };
  std::map<int, Side> sides;
  for (int k : island)
    for (int body : {rows[k].row.a, rows[k].row.b}) {
      if (body == kGround || sides.contains(body)) continue;
      const BodyData& data = system_->bodies()[body];
      BodyMotion& m = motions.at(body);
      const Mat3 Lambda = m.Lambda();
      sides[body] = {&m, Lambda * data.inertia.inverse() * Lambda.transpose(), data.mass};
    }
  struct Row {
    Side *a, *b;
    Vec6 G_a, G_b;
    double wanted, per_impulse;
    int point;
  };
  std::vector<Row> list;
  for (int k : island) {
    const ImpactRow& r = rows[k];
    Row row{r.row.a == kGround ? nullptr : &sides.at(r.row.a),
            r.row.b == kGround ? nullptr : &sides.at(r.row.b),
            r.row.G_a,
            r.row.G_b,
            r.wanted,
            0.0,
            r.point};
    const auto add = [&](const Side* s, const Vec6& G) {
      if (s)
        row.per_impulse +=
            G.head<3>().squaredNorm() / s->mass + G.tail<3>().dot(s->inverse_inertia * G.tail<3>());
    };
    add(row.a, row.G_a);
    add(row.b, row.G_b);
    list.push_back(row);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (const Row& row : list) {
      double speed = 0.0;
      const auto read = [&](const Side* s, const Vec6& G) {
        if (s) speed += G.head<3>().dot(s->motion->v) + G.tail<3>().dot(s->motion->omega());
      };
      read(row.a, row.G_a);
      read(row.b, row.G_b);
      if (!(speed > row.wanted)) continue;
      const double p = (row.wanted - speed) / row.per_impulse;
      const auto push = [&](Side* s, const Vec6& G) {
        if (!s) return;
        const Vec3 impulse = p * G.head<3>();
        s->motion->v += impulse / s->mass;
        s->motion->W += s->motion->Lambda().transpose() * (s->inverse_inertia * (p * G.tail<3>()));
        jump.impulse += impulse;
        jump.turning += s->motion->r.cross(impulse) + p * G.tail<3>();
      };
      push(row.a, row.G_a);
      push(row.b, row.G_b);
      const double lost = -0.5 * p * (row.wanted + speed);
      jump.energy_lost += lost;
      points_[row.point].impact_loss += lost;
      points_[row.point].impact_impulse += p;
    }
}

/// Contacts that opened in the step keep the part e of the speed they had at the surface; those
/// that do not rebound lose the speed with which midpoint kinematics would throw them back. All
/// rows of an island together, by the pseudo-inverse of J M⁻¹ Jᵀ. @eq{exit-law}
VelocityJump ContactSet::settle_impacts(State& state, std::span<const VelocityRow> joint_rows) {
  VelocityJump jump;
  std::vector<ImpactRow> rows;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    Point& p = points_[i];
    if (!p.touched || p.data.pair.weight < 0.0 || p.restitution >= 1.0) continue;
    if (!(p.elastic_force > 0.0) || !(p.speed_n1 > 0.0)) continue;
    PointHistory& h = p.data.history;
    double wanted = 0.0;
    const Vec3 n = p.report.normal;
    if (h.plastic) {
      if (!h.fresh || p.speed_n >= 0.0) continue;
      h.fresh = false;
    } else {
      if (h.closed) continue;
      // The gap beyond the surface was flown under the pull of gravity alone.
      const double height = p.report.gap_n1 - p.data.normal.reach();
      Vec3 pull = Vec3::Zero();
      if (shapes_[p.a].body != kGround) pull += system_->gravity();
      if (shapes_[p.b].body != kGround) pull -= system_->gravity();
      const double a = -n.dot(pull);
      const double at_surface = p.speed_n1 * p.speed_n1 + 2.0 * a * height;
      wanted =
          std::sqrt(std::max(p.restitution * p.restitution * at_surface - 2.0 * a * height, 0.0));
    }
    ImpactRow r;
    r.point = i;
    r.row.a = shapes_[p.a].body;
    r.row.b = shapes_[p.b].body;
    const auto side = [&](int body) {
      Vec6 G = Vec6::Zero();
      if (body == kGround) return G;
      G.head<3>() = n;
      G.tail<3>() = (p.report.point - system_->motion(state, body).r).cross(n);
      return G;
    };
    r.row.G_a = side(r.row.a);
    r.row.G_b = -side(r.row.b);
    for (const auto& [body, G] : {std::pair(r.row.a, r.row.G_a), std::pair(r.row.b, r.row.G_b)}) {
      if (body == kGround) continue;
      const BodyMotion m = system_->motion(state, body);
      r.before += G.head<3>().dot(m.v) + G.tail<3>().dot(m.omega());
    }
    if (!(r.before > 0.0)) continue;
    r.wanted = std::min(wanted, r.before);
    rows.push_back(r);
  }
  if (rows.empty()) return jump;
  for (const VelocityRow& j : joint_rows) rows.push_back({j, 0.0, 0.0, -1});

  std::map<int, BodyMotion> motions;
  const auto motion = [&](int body) -> BodyMotion& {
    const auto [at, fresh] = motions.try_emplace(body);
    if (fresh) at->second = system_->motion(state, body);
    return at->second;
  };
  for (const std::vector<int>& island : islands(rows, system_->body_count())) {
    if (island.size() > kTogether && joint_rows.empty()) {
      for (int k : island)
        for (int body : {rows[k].row.a, rows[k].row.b})
          if (body != kGround) (void)motion(body);
      settle_in_turn(rows, island, motions, jump);
      continue;
    }
    // Bodies of the island and their rows.
    std::map<int, int> place;
    for (int k : island)
      for (int body : {rows[k].row.a, rows[k].row.b})
        if (body != kGround) place.try_emplace(body, 0);
    int next = 0;
    for (auto& [body, at] : place) at = next++;
    const auto m = static_cast<Eigen::Index>(island.size());
    Mat J = Mat::Zero(m, 6 * next), inverse_mass = Mat::Zero(6 * next, 6 * next);
    Vec velocity(6 * next), wanted(m);
    std::vector<Mat3> inertia(static_cast<std::size_t>(next));
    for (const auto& [body, at] : place) {
      const BodyData& data = system_->bodies()[body];
      const BodyMotion& now = motion(body);
      const Mat3 Lambda = now.Lambda();
      inertia[at] = Lambda * data.inertia * Lambda.transpose();
      inverse_mass.block<3, 3>(6 * at, 6 * at) = Mat3::Identity() / data.mass;
      inverse_mass.block<3, 3>(6 * at + 3, 6 * at + 3) = inertia[at].inverse();
      velocity.segment<3>(6 * at) = now.v;
      velocity.segment<3>(6 * at + 3) = Lambda * now.W;
    }
    for (Eigen::Index k = 0; k < m; ++k) {
      const ImpactRow& r = rows[island[k]];
      if (r.row.a != kGround) J.row(k).segment<6>(6 * place[r.row.a]) += r.row.G_a.transpose();
      if (r.row.b != kGround) J.row(k).segment<6>(6 * place[r.row.b]) += r.row.G_b.transpose();
      wanted[k] = r.point < 0 ? -J.row(k).dot(velocity) : r.wanted - r.before;
    }
    Vec impulses(m);
    // Contacts only take speed away: rows that would have to push are left out, one round after the
    // other.
    const auto solve = [&](const Vec& change) {
      std::vector<Eigen::Index> acting;
      for (Eigen::Index k = 0; k < m; ++k) acting.push_back(k);
      for (;;) {
        const Mat some = J(acting, Eigen::all);
        const Eigen::SelfAdjointEigenSolver<Mat> A(some * inverse_mass * some.transpose());
        Vec p = A.eigenvectors().transpose() * change(acting);
        const double least = kPseudoInverse * A.eigenvalues()[A.eigenvalues().size() - 1];
        for (Eigen::Index k = 0; k < p.size(); ++k)
          p[k] = A.eigenvalues()[k] > least ? p[k] / A.eigenvalues()[k] : 0.0;
        p = A.eigenvectors() * p;
        impulses.setZero();
        impulses(acting) = p;
        const double most = p.lpNorm<Eigen::Infinity>();
        const auto pushes = [&](Eigen::Index k) {
          return rows[island[k]].point >= 0 && impulses[k] > kPseudoInverse * most;
        };
        if (std::erase_if(acting, pushes) == 0) break;
        if (!acting.empty()) continue;
        impulses.setZero();
        break;
      }
      return Vec(inverse_mass * (J.transpose() * impulses));
    };
    const auto loss = [&](const Vec& change) {
      double lost = 0.0;
      for (const auto& [body, at] : place) {
        const Vec6 d = change.segment<6>(6 * at);
        const Vec6 sum = 2.0 * velocity.segment<6>(6 * at) + d;
        lost -= 0.5 * (system_->bodies()[body].mass * sum.head<3>().dot(d.head<3>()) +
                       sum.tail<3>().dot(inertia[at] * d.tail<3>()));
      }
      return lost;
    };
    Vec change = solve(wanted);
    double lost = loss(change);
    if (lost < 0.0) {  // different restitutions in one island: the smallest for all
      double least = 1.0;
      for (int k : island)
        if (rows[k].point >= 0) least = std::min(least, rows[k].wanted / rows[k].before);
      for (Eigen::Index k = 0; k < m; ++k)
        if (rows[island[k]].point >= 0) wanted[k] = (least - 1.0) * rows[island[k]].before;
      change = solve(wanted);
      lost = loss(change);
    }
    if (lost < 0.0) continue;
    for (const auto& [body, at] : place) {
      BodyMotion& now = motion(body);
      const Vec3 dv = change.segment<3>(6 * at), dw = change.segment<3>(6 * at + 3);
      now.v += dv;
      now.W += now.Lambda().transpose() * dw;
      const Vec3 impulse = system_->bodies()[body].mass * dv;
      jump.impulse += impulse;
      jump.turning += now.r.cross(impulse) + inertia[at] * dw;
    }
    jump.energy_lost += lost;
    double share = 0.0;
    for (int k : island) share += rows[k].point >= 0 ? 1.0 : 0.0;
    for (Eigen::Index k = 0; k < m; ++k) {
      if (rows[island[k]].point < 0) continue;
      Point& p = points_[rows[island[k]].point];
      p.impact_loss += lost / share;
      p.impact_impulse += impulses[k];
    }
  }
  for (const auto& [body, m] : motions) state.set_motion(system_->slot(body), m);
  lost_in_impacts_ += jump.energy_lost;
  save(state);
  return jump;
}

}  // namespace polhode::contact
