// SPDX-License-Identifier: Apache-2.0
// Unilateral rows of an equilibrium: where they are, what they exert, how it changes.
#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

#include <polhode/core/format.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/hat.hpp>
#include <polhode/statics/static_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Length of the step with which candidates are searched [s]. The margins by the fall in it affect
/// cost alone.
constexpr double kSearchStep = 1e-2;
/// Accuracy of gaps, as a part of those that count as closed, and their rounding relative to the
/// distance from the origin.
constexpr double kRowAccuracy = 0.1, kPlaceRounding = 16.0 * std::numeric_limits<double>::epsilon();
/// Increment of central differences of fourth order for the derivatives of stops [-].
constexpr double kStopDifference = 1e-3;
/// Part of the largest force below which a row that touches carries none.
constexpr double kNoForce = 1e-9;
/// Part of the friction bound from which on a point with slip slides.
constexpr double kRowRounding = 16.0 * std::numeric_limits<double>::epsilon();

using By = Eigen::Matrix<double, 12, 12>;

/// A moved body: left increments (Δr, Δθ).
BodyStep moved_by(BodyStep s, int j, double by) {
  if (!s.moves) return s;
  if (j < 3) {
    s.r_n1[j] += by;
    s.u[j] += by;
    return s;
  }
  const Vec3 theta = by * Vec3::Unit(j - 3);
  s.Lambda_n1 = cay(theta) * s.Lambda_n1;
  s.theta = compose_cayley(theta, s.theta);
  return s;
}

}  // namespace

StaticRows::StaticRows(const System& system)
    : system_(&system), contacts_(system.contacts().get()), touching_(system.touching_gap()) {
  if (contacts_) {
    impulsive_ = contacts_->impulsive();
    contacts_->prepare(system);
  }
  context_.dt = kSearchStep;
  context_.ga.alpha_f = 1.0;
  context_.conserving = false;
  for (const UnilateralStop& stop : unilateral_stops(system)) stops_.push_back({stop});
  const auto n = static_cast<std::size_t>(system.body_count());
  steps_.assign(n + 1, BodyStep::ground(1.0));
  instants_ = steps_;
}

/// Bodies of the trial as they stand.
void StaticRows::take_instants() {
  double far = system_->length_scale();
  for (std::size_t b = 0; b + 1 < instants_.size(); ++b) {
    BodyStep& s = instants_[b];
    const BodyStep& step = steps_[b];
    s = BodyStep::at_instant(step.r_n1, step.Lambda_n1, Vec3::Zero(), Vec3::Zero());
    far = std::max(far, step.r_n1.lpNorm<Eigen::Infinity>());
  }
  accuracy_ = std::max(kRowAccuracy * touching_, kPlaceRounding * far);
}

void StaticRows::begin(const State& last) {
  frozen_ = false;
  stride_ = 1.0;
  points_.clear();
  anchors_.clear();
  for (Stop& stop : stops_) {
    stop.listed = false;
    stop.force = 0.0;
  }
  for (int b = 0; b < system_->body_count(); ++b) {
    const BodyMotion m = system_->motion(last, b);
    steps_[static_cast<std::size_t>(b)] =
        BodyStep::at_instant(m.r, m.Lambda(), Vec3::Zero(), Vec3::Zero());
  }
  take_instants();
  if (!contacts_) return;
  contacts_->begin_step(last, instants_, context_);
  std::vector<ContactInstant> found;
  impulsive_->points_at(instants_, found);
  for (const ContactInstant& at : found) {
    if (at.gap > touching_) continue;
    Contact& c = anchors_.emplace_back();
    c.at = at;
    c.closed_n = true;
    c.place_n = at.place;
    c.kinetic = at.slips;
  }
}

void StaticRows::recall(const State& state) {
  frozen_ = true;
  for (Contact& c : points_) {
    c.slides = c.at.slips;
    const Vec3& n = c.at.normal;
    c.listed = c.at.gap <= touching_;
    if (!c.listed) continue;
    c.normal = std::max(0.0, n.dot(c.at.impulse));
    c.friction = c.at.impulse - n.dot(c.at.impulse) * n;
    c.torsion = n.dot(c.at.turning);
    c.rolling = c.at.turning - c.torsion * n;
  }
  for (Stop& stop : stops_) {
    stop.listed = stop.exists && stop.row.gap_n1 <= touching_;
    stop.force =
        stop.listed ? read_record<UnilateralMemory>(state.history.data() + stop.memory).force : 0.0;
  }
}

/// @eq{statics-rows}
void StaticRows::place(const State& last, const Trial& trial) {
  for (int b = 0; b < system_->body_count(); ++b)
    steps_[static_cast<std::size_t>(b)] = body_step(*system_, last, trial, b);
  take_instants();
  place_stops(last, trial);
  if (!contacts_) return;
  contacts_->begin_step(last, instants_, context_);
  take_points();
}

/// Takes the candidates for contact points, with what is known of them.
void StaticRows::take_points() {
  std::vector<ContactInstant> found;
  impulsive_->points_at(instants_, found);
  const std::vector<Contact> before = std::exchange(points_, {});
  const auto same = [](const std::vector<Contact>& list, const ContactInstant& at) {
    const Contact* best = nullptr;
    for (const Contact& c : list)
      if (c.at.key == at.key && c.at.normal.dot(at.normal) > 0.5 &&
          (!best || (c.at.place - at.place).norm() < (best->at.place - at.place).norm()))
        best = &c;
    return best;
  };
  for (const ContactInstant& at : found) {
    Contact c;
    if (const Contact* old = same(before, at)) {
      c = *old;
    } else if (const Contact* anchor = same(anchors_, at)) {
      c = *anchor;
    }
    c.at = at;
    c.listed = c.listed || at.gap <= 0.0 || (c.closed_n && at.gap <= touching_);
    const Vec3& n = at.normal;
    const auto turned = [&](const Vec3& f) {  // into the tangent plane
      const Vec3 t = f - n.dot(f) * n;
      const double size = t.norm();
      return Vec3(size > 0.0 ? f.norm() / size * t : t);
    };
    c.friction = turned(c.friction);
    c.rolling = turned(c.rolling);
    if (!frozen_) c.slip = c.turn = Vec3::Zero();
    if (c.closed_n && !frozen_) {
      const auto step = [&](int body) -> const BodyStep& {
        return body == kGround ? steps_.back() : steps_[static_cast<std::size_t>(body)];
      };
      const BodyStep &a = step(at.a), &b = step(at.b);
      const Vec3 middle = 0.5 * (c.place_n + at.place);
      const Vec3 way = a.u + a.theta.cross(middle - a.r_n - 0.5 * a.u) - b.u -
                       b.theta.cross(middle - b.r_n - 0.5 * b.u);
      c.slip = way - n.dot(way) * n;
      c.turn = a.theta - b.theta;
    }
    points_.push_back(c);
  }
}

void StaticRows::place_stops(const State& last, const Trial& trial) {
  std::vector<UnilateralRow> found;
  for (Stop& stop : stops_) {
    const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(stop.interaction)];
    const PairView view = pair_view(*system_, last, trial, ref);
    if (stop.number == 0) {
      found.clear();
      system_->group(ref.group).unilateral_rows(ref.item, view.step(), found);
    }
    stop.exists = !found.empty();
    if (!stop.exists) {
      stop.force = 0.0;
      continue;
    }
    stop.row = found[static_cast<std::size_t>(stop.number)];
    stop.listed = stop.listed || stop.row.gap_n1 <= touching_;
    if (stop.force > 0.0) differentiate(stop, view);
  }
}

/// Derivatives of a stop's wrench by central differences of fourth order.
void StaticRows::differentiate(Stop& stop, const PairView& view) const {
  const InteractionRef& ref = system_->interactions()[static_cast<std::size_t>(stop.interaction)];
  const PairStep whole = view.step();
  std::vector<UnilateralRow> list;
  stop.by.setZero();
  for (int j = 0; j < 12; ++j) {
    if (!(j < 6 ? whole.a : whole.b).moves) continue;
    const double h = kStopDifference * (j % 6 < 3 ? system_->length_scale() : 1.0);
    for (const auto& [at, weight] : {std::pair(1.0, 2.0 / 3.0), std::pair(-1.0, -2.0 / 3.0),
                                     std::pair(2.0, -1.0 / 12.0), std::pair(-2.0, 1.0 / 12.0)}) {
      const BodyStep a = j < 6 ? moved_by(whole.a, j, at * h) : whole.a;
      const BodyStep b = j < 6 ? whole.b : moved_by(whole.b, j - 6, at * h);
      list.clear();
      system_->group(ref.group).unilateral_rows(
          ref.item, {a, b, whole.context, whole.lambda, whole.history}, list);
      if (list.empty()) return;
      const UnilateralRow& row = list[static_cast<std::size_t>(stop.number)];
      stop.by.col(j).head<6>() += weight / h * row.by_a;
      stop.by.col(j).tail<6>() += weight / h * row.by_b;
    }
  }
}

/// Derivative of the wrenches of a contact by the increments, its forces carried along with the
/// tangent plane. @eq{statics-row-stiffness}
By StaticRows::stiffness_of(const Contact& c) const {
  const Vec3& n = c.at.normal;
  const Vec3 force = c.normal * n + c.friction;
  By D;
  for (int j = 0; j < 12; ++j) {
    const Vec3 dn = c.at.normal_by.col(j), dc = c.at.place_by.col(j);
    const Vec3 df = c.normal * dn - c.friction.dot(dn) * n;
    const Vec3 dm = c.torsion * dn - c.rolling.dot(dn) * n;
    const auto wrench = [&](int body, bool own) {
      const Vec3 r =
          body == kGround ? Vec3(Vec3::Zero()) : instants_[static_cast<std::size_t>(body)].r_n1;
      Vec3 arm_by = dc;
      if (own && j % 6 < 3) arm_by[j % 6] -= 1.0;
      Vec6 w;
      w << df, arm_by.cross(force) + (c.at.place - r).cross(df) + dm;
      return w;
    };
    D.col(j).head<6>() = wrench(c.at.a, j < 6);
    D.col(j).tail<6>() = -wrench(c.at.b, j >= 6);
  }
  return D;
}

namespace {

/// Convex part of the energy whose wrenches change by D with the increments, so that row problems
/// are convex where only the rows hold a body, such as a block that stands. A ground has none.
By convex_part(By D, int a, int b) {
  if (a == kGround) D.topRows<6>().setZero(), D.leftCols<6>().setZero();
  if (b == kGround) D.bottomRows<6>().setZero(), D.rightCols<6>().setZero();
  const Eigen::SelfAdjointEigenSolver<By> modes(By(0.5 * (D + D.transpose())));
  return modes.eigenvectors() * modes.eigenvalues().cwiseMin(0.0).asDiagonal() *
         modes.eigenvectors().transpose();
}

}  // namespace

bool StaticRows::acts(double force) const { return force > kNoForce * largest_force(); }

bool StaticRows::sticks(const Contact& c) const {
  if (!c.rubs()) return false;
  return frozen_ ? !c.slides : !(c.slip.norm() > touching_);
}

void StaticRows::freeze() {
  for (Contact& c : points_) c.slides = c.slip.norm() > touching_;
  frozen_ = true;
}

double StaticRows::largest_force() const {
  double most = 0.0;
  for (const Contact& c : points_) most = std::max(most, c.normal);
  for (const Stop& stop : stops_) most = std::max(most, stop.force);
  return most;
}

StaticRows::Row StaticRows::row_of(const Contact& c, int source, const Vec3& direction,
                                   int part) const {
  const auto arm = [&](int body) {
    return Vec3(c.at.place - (body == kGround ? Vec3(Vec3::Zero())
                                              : instants_[static_cast<std::size_t>(body)].r_n1));
  };
  Row row;
  row.a = c.at.a;
  row.b = c.at.b;
  row.source = source;
  row.direction = direction;
  row.part = part;
  const bool turns = part >= 2;
  const Vec3 force = turns ? Vec3(Vec3::Zero()) : direction;
  row.on_a << force, turns ? direction : Vec3(arm(c.at.a).cross(direction));
  row.on_b << -force, turns ? Vec3(-direction) : Vec3(-arm(c.at.b).cross(direction));
  return row;
}

void StaticRows::add_forces(double s, Vec& rhs, Vec& noise) const {
  const auto add = [&](int body, const Vec6& wrench, const Vec6& size) {
    if (body == kGround) return;
    rhs.segment<6>(6 * body) += s * wrench;
    noise.segment<6>(6 * body) += s * kRowRounding * size;
  };
  for (const Contact& c : points_) {
    if (c.normal == 0.0 && c.friction.isZero(0.0)) continue;
    const Vec3 force = c.normal * c.at.normal + c.friction,
               moment = c.torsion * c.at.normal + c.rolling;
    for (const auto& [body, sign] : {std::pair(c.at.a, 1.0), std::pair(c.at.b, -1.0)}) {
      if (body == kGround) continue;
      const Vec3& r = instants_[static_cast<std::size_t>(body)].r_n1;
      Vec6 wrench, size;
      wrench << force, (c.at.place - r).cross(force) + moment;
      size << Vec3::Constant(force.norm()),
          Vec3::Constant(force.norm() * (c.at.place.norm() + r.norm()) + moment.norm());
      add(body, sign * wrench, size);
    }
  }
  for (const Stop& stop : stops_) {
    if (stop.force == 0.0) continue;
    add(stop.a, stop.force * stop.row.by_a, stop.force * stop.row.by_a.cwiseAbs());
    add(stop.b, stop.force * stop.row.by_b, stop.force * stop.row.by_b.cwiseAbs());
  }
}

void StaticRows::extend(linear::KktTopology& topology, linear::KktValues& values, double s,
                        bool hold) const {
  const auto add = [&](int a, int b, const By& exact, const std::vector<Row>& rows) {
    const By D = hold ? exact : convex_part(exact, a, b);
    if (a != kGround) values.diagonal[static_cast<std::size_t>(a)] -= s * D.topLeftCorner<6, 6>();
    if (b != kGround)
      values.diagonal[static_cast<std::size_t>(b)] -= s * D.bottomRightCorner<6, 6>();
    if (rows.empty() && (a == kGround || b == kGround)) return;
    linear::KktPair pair{a, b, static_cast<int>(rows.size()), topology.rows};
    linear::KktValues::Pair v;
    v.K_ab = -s * D.topRightCorner<6, 6>();
    v.K_ba = -s * D.bottomLeftCorner<6, 6>();
    v.B_a.setZero(), v.B_b.setZero(), v.G_a.setZero(), v.G_b.setZero();
    v.C.setConstant(kProximal);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      v.B_a.col(i) = rows[k].on_a;
      v.B_b.col(i) = rows[k].on_b;
      v.G_a.row(i) = rows[k].on_a.transpose();
      v.G_b.row(i) = rows[k].on_b.transpose();
    }
    topology.rows += pair.rows;
    topology.pairs.push_back(pair);
    values.pairs.push_back(v);
  };
  std::vector<Row> rows;
  for (const Contact& c : points_) {
    if (!acts(c.normal)) continue;
    rows.clear();
    if (hold) {
      const Vec3& n = c.at.normal;
      const Vec3 t = n.unitOrthogonal(), t2 = n.cross(t);
      rows.push_back(row_of(c, 0, n, 0));
      if (sticks(c)) {
        rows.push_back(row_of(c, 0, t, 1));
        rows.push_back(row_of(c, 0, t2, 1));
      }
      if (c.at.torsion > 0.0) rows.push_back(row_of(c, 0, n, 2));
      if (c.at.rolling > 0.0) {
        rows.push_back(row_of(c, 0, t, 3));
        rows.push_back(row_of(c, 0, t2, 3));
      }
    }
    add(c.at.a, c.at.b, stiffness_of(c), rows);
  }
  for (const Stop& stop : stops_) {
    if (!stop.exists || !acts(stop.force)) continue;
    rows.clear();
    if (hold) {
      Row row;
      row.a = stop.a;
      row.b = stop.b;
      row.on_a = stop.row.by_a;
      row.on_b = stop.row.by_b;
      rows.push_back(row);
    }
    add(stop.a, stop.b, stop.force * stop.by, rows);
  }
}

}  // namespace polhode
