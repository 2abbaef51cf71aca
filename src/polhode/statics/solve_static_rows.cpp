// SPDX-License-Identifier: Apache-2.0
// Unilateral rows of an equilibrium: their forces, and what becomes of them.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/core/format.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/statics/static_rows.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

namespace {

/// Largest number of rows: of the dense matrices of the row problem.
constexpr std::size_t kMostStaticRows = 600;
/// Largest number of row problems of an increment, each with the rows that the last one violates.
constexpr int kListings = 30;
/// Largest increment: a displacement in sizes of the model, twice as long after one that had it,
/// and a rotation [-].
constexpr double kMostMove = 1.0, kMostTurn = 0.5;
/// Halvings of an increment whose candidates are not all known.
constexpr int kCoverings = 40;
/// Tolerance of the row problem, as a part of the accuracy of gaps.
constexpr double kRowTolerance = 0.1;
/// Square of a direction's part in the tangent plane below which it has none there.
constexpr double kNoDirection = 1e-12;
/// Part of the bound from which on friction is at it.
constexpr double kAtBound = 1.0 - 1e-9;
/// Error of forces of an equilibrium, as a part of the largest, and smallest cosine between the
/// friction of a point that slides and the direction against its slip.
constexpr double kForceError = 1e-7, kAgainstSlip = 1.0 - 1e-6;

template <typename Name>
void add_once(std::vector<Name>& list, Name name) {
  if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(std::move(name));
}

}  // namespace

void StaticRows::put_contact(int source) {
  const Contact& c = points_[static_cast<std::size_t>(source)];
  const Vec3& n = c.at.normal;
  const auto add = [&](const Vec3& direction, int part, double way, double given) {
    rows_.push_back(row_of(c, source, direction, part));
    rows_.back().way = way;
    rows_.back().given = given;
    lengths_.push_back(part >= 2 ? c.at.size : 1.0);
  };
  const auto normal = static_cast<Eigen::Index>(rows_.size());
  blocks_.push_back({.kind = ImpulseRows::Kind::normal, .first = normal});
  add(n, 0, c.at.gap, c.normal);
  if (!c.closed_n) return;
  const auto bound = [&](Eigen::Index size, double along, double across) {
    blocks_.push_back({.kind = ImpulseRows::Kind::friction,
                       .first = static_cast<Eigen::Index>(rows_.size()),
                       .size = size,
                       .normal = normal,
                       .half_axes = {along, across, 0.0}});
  };
  Vec3 along = c.at.along - n.dot(c.at.along) * n;
  along = along.squaredNorm() > kNoDirection ? Vec3(along.normalized()) : n.unitOrthogonal();
  const Vec3 across = n.cross(along);
  if (c.rubs()) {
    const bool isotropic = c.at.friction_across == c.at.friction;
    const double mu = isotropic ? c.mu_along() : c.at.friction;
    bound(2, mu, isotropic ? mu : c.at.friction_across);
    for (const Vec3& t : {along, across}) add(t, 1, t.dot(c.slip), t.dot(c.friction));
  }
  if (c.at.torsion > 0.0) {
    bound(1, c.at.torsion, 0.0);
    add(n, 2, n.dot(c.turn), c.torsion);
  }
  if (c.at.rolling > 0.0) {
    bound(2, c.at.rolling, c.at.rolling);
    for (const Vec3& t : {along, across}) add(t, 3, t.dot(c.turn), t.dot(c.rolling));
  }
}

void StaticRows::put_rows() {
  rows_.clear();
  blocks_.clear();
  lengths_.clear();
  for (int k = 0; k < static_cast<int>(points_.size()); ++k)
    if (points_[static_cast<std::size_t>(k)].listed) put_contact(k);
  for (std::size_t k = 0; k < stops_.size(); ++k) {
    const Stop& stop = stops_[k];
    if (!stop.exists || !stop.listed) continue;
    blocks_.push_back(
        {.kind = ImpulseRows::Kind::normal, .first = static_cast<Eigen::Index>(rows_.size())});
    Row& row = rows_.emplace_back();
    row.a = stop.a;
    row.b = stop.b;
    row.on_a = stop.row.by_a;
    row.on_b = stop.row.by_b;
    row.way = stop.row.gap_n1;
    row.given = stop.force;
    row.source = static_cast<int>(points_.size() + k);
    lengths_.push_back(1.0);
  }
}

/// Sets the part of increments that is short enough, whose candidates are known, and in which no
/// two bodies pass each other.
void StaticRows::limit(const Vec& x) {
  part_ = 1.0;
  strides_ = false;
  for (std::size_t b = 0; b + 1 < instants_.size(); ++b) {
    const auto i = 6 * static_cast<Eigen::Index>(b);
    const double move = x.segment<3>(i).norm(), turn = x.segment<3>(i + 3).norm();
    const double most = kMostMove * stride_ * system_->length_scale();
    if (move * part_ > most) {
      part_ = most / move;
      strides_ = true;
    }
    if (turn * part_ > kMostTurn) part_ = kMostTurn / turn;
  }
  if (!contacts_) return;
  std::vector<Vec6> increments(instants_.size() - 1);
  const auto scale = [&] {
    for (std::size_t b = 0; b < increments.size(); ++b)
      increments[b] = part_ * x.segment<6>(6 * static_cast<Eigen::Index>(b));
  };
  scale();
  contacts_->cover(instants_, context_, increments);
  std::vector<BodyStep> moved = instants_;
  for (int k = 0; k < kCoverings; ++k) {
    for (std::size_t b = 0; b < increments.size(); ++b) {
      moved[b].r_n1 = instants_[b].r_n1 + increments[b].head<3>();
      moved[b].Lambda_n1 = cay(Vec3(increments[b].tail<3>())) * instants_[b].Lambda_n1;
    }
    if (impulsive_->covers(moved)) break;
    part_ *= 0.5;
    scale();
  }
  part_ *= impulsive_->part_on_one_side(instants_, increments);
}

/// Lists the rows that the increments violate. @returns whether there are any.
bool StaticRows::list_violated(const Vec& x) {
  bool any = false;
  const auto look = [&](bool& listed, const Row& row) {
    if (listed || row.way + part_ * change(row, x) >= -accuracy_) return;
    listed = any = true;
  };
  for (Contact& c : points_) {
    Row row = row_of(c, 0, c.at.normal, 0);
    row.way = c.at.gap;
    look(c.listed, row);
  }
  for (Stop& stop : stops_) {
    if (!stop.exists) continue;
    Row row;
    row.a = stop.a;
    row.b = stop.b;
    row.on_a = stop.row.by_a;
    row.on_b = stop.row.by_b;
    row.way = stop.row.gap_n1;
    look(stop.listed, row);
  }
  return any;
}

/// @eq{statics-rows}
bool StaticRows::solve(double s, const std::function<void(Vec&)>& respond, Vec& x) {
  const Vec without = x;
  for (int listing = 0; listing < kListings; ++listing) {
    put_rows();
    unsolved_.clear();
    if (rows_.size() > kMostStaticRows) {
      unsolved_ = format("contacts have {} rows, more than the {} of statics with the law rigid",
                         rows_.size(), kMostStaticRows);
      return false;
    }
    const auto n = static_cast<Eigen::Index>(rows_.size());
    std::vector<Vec> responses(rows_.size());
    RowProblem problem(n);
    problem.even = true;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const Row& row = rows_[k];
      Vec& response = responses[k];
      response.setZero(without.size());
      if (row.a != kGround) response.segment<6>(6 * row.a) = s * row.on_a;
      if (row.b != kGround) response.segment<6>(6 * row.b) += s * row.on_b;
      respond(response);
      if (!response.allFinite()) return false;
      problem.b[i] = row.way + change(row, without);
      problem.given[i] = row.given;
      problem.lengths[i] = lengths_[k];
    }
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        problem.A(i, j) =
            change(rows_[static_cast<std::size_t>(i)], responses[static_cast<std::size_t>(j)]);
    problem.blocks = blocks_;
    Vec p = -problem.given;          // so that the sums are the smallest
    const Vec guess = Vec::Zero(n);  // but they are near those of the last iterate
    const RowReport report = problem.solve(p, kRowTolerance * accuracy_, &guess);
    if (!report.converged) {
      const Row& row = rows_[static_cast<std::size_t>(std::max<Eigen::Index>(0, report.worst))];
      unsolved_ = format(
          "the rows of {} are not solved: they miss by {:.2g} m",
          row.source < static_cast<int>(points_.size())
              ? "the contact of " + names_of(row.a, row.b)
              : stop_name(
                    *system_,
                    stops_[static_cast<std::size_t>(row.source) - points_.size()].interaction),
          report.error);
    }
    x = without;
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (p[i] != 0.0) x += p[i] * responses[k];
    }
    if (!x.allFinite()) return false;
    take_forces(problem.given + p);
    limit(x);
    if (contacts_) take_points();
    if (!list_violated(x)) break;
  }
  return true;
}

/// Stores the forces of all rows after the increment.
void StaticRows::take_forces(const Vec& forces) {
  for (Contact& c : points_) c.next = Forces();
  for (Stop& stop : stops_) stop.next = 0.0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Row& row = rows_[k];
    const double p = forces[static_cast<Eigen::Index>(k)];
    if (row.source >= static_cast<int>(points_.size())) {
      stops_[static_cast<std::size_t>(row.source) - points_.size()].next = p;
      continue;
    }
    Forces& next = points_[static_cast<std::size_t>(row.source)].next;
    if (row.part == 0) next.normal = p;
    if (row.part == 1) next.friction += p * row.direction;
    if (row.part == 2) next.torsion = p;
    if (row.part == 3) next.rolling += p * row.direction;
  }
}

void StaticRows::move(double part) {
  stride_ = strides_ ? 2.0 * stride_ : 1.0;
  const auto to = [&](auto& now, const auto& next) {
    if (part < 1.0)
      now += part * (next - now);
    else
      now = next;
  };
  for (Contact& c : points_) {
    to(c.normal, c.next.normal);
    to(c.friction, c.next.friction);
    to(c.torsion, c.next.torsion);
    to(c.rolling, c.next.rolling);
  }
  for (Stop& stop : stops_) to(stop.force, stop.next);
}

/// Friction of a contact as a part of its bound; 1 without a bound.
double StaticRows::friction_part(const Contact& c) {
  if (!(c.normal > 0.0)) return 1.0;
  const double mu = c.mu_along();
  if (c.at.friction_across == c.at.friction) return c.friction.norm() / (mu * c.normal);
  const Vec3& n = c.at.normal;
  Vec3 along = c.at.along - n.dot(c.at.along) * n;
  along = along.squaredNorm() > kNoDirection ? Vec3(along.normalized()) : n.unitOrthogonal();
  return std::hypot(along.dot(c.friction) / c.at.friction,
                    n.cross(along).dot(c.friction) / c.at.friction_across) /
         c.normal;
}

double StaticRows::miss() const {
  double most = 0.0;
  for (const Contact& c : points_) {
    most = std::max(most, c.normal > 0.0 ? std::abs(c.at.gap) : -c.at.gap);
    if (!c.closed_n) continue;
    const double bound = kAtBound * c.normal;
    if (c.rubs() && friction_part(c) < kAtBound) most = std::max(most, c.slip.norm());
    const Vec3& n = c.at.normal;
    const double spin = n.dot(c.turn);
    if (std::abs(c.torsion) < c.at.torsion * bound)
      most = std::max(most, c.at.size * std::abs(spin));
    if (c.rolling.norm() < c.at.rolling * bound)
      most = std::max(most, c.at.size * (c.turn - spin * n).norm());
  }
  for (const Stop& stop : stops_)
    if (stop.exists)
      most = std::max(most, stop.force > 0.0 ? std::abs(stop.row.gap_n1) : -stop.row.gap_n1);
  return most / (accuracy_ > 0.0 ? accuracy_ : touching_);
}

std::string StaticRows::inadmissible() const {
  const double error = kForceError * largest_force();
  for (const Contact& c : points_) {
    const double friction = c.friction.norm(), slip = c.slip.norm();
    const bool acts = c.closed_n && c.rubs();
    const char* what = nullptr;
    if (c.normal < -error) what = "pulls";
    if (friction > error && (!acts || friction_part(c) > 1.0 + kForceError))
      what = "has more than its friction";
    if (std::abs(c.torsion) > c.at.torsion * c.normal + error * c.at.size ||
        c.rolling.norm() > c.at.rolling * c.normal + error * c.at.size)
      what = "has more than its rolling or torsional resistance";
    if (acts && c.normal > error && slip > kOverlapGaps * touching_ &&
        c.at.friction_across == c.at.friction &&
        c.friction.dot(c.slip) > -kAgainstSlip * friction * slip)
      what = "does not resist its slip";
    if (what) return format("the contact of {} {}", names_of(c.at.a, c.at.b), what);
  }
  for (const Stop& stop : stops_)
    if (stop.force < -error) return format("{} pulls", stop_name(*system_, stop.interaction));
  return {};
}

std::vector<int> StaticRows::bodies_with_friction() const {
  std::vector<int> list;
  for (const Contact& c : anchors_)
    for (const int body : {c.at.a, c.at.b})
      if (c.rubs() && body != kGround) add_once(list, body);
  return list;
}

bool StaticRows::lose_static_friction() {
  bool any = false;
  for (Contact& c : points_) {
    if (c.kinetic || !c.closed_n || !(c.at.static_friction > c.at.friction)) continue;
    if (!(c.slip.norm() > touching_)) continue;
    c.kinetic = any = true;
  }
  return any;
}

bool StaticRows::closes() const {
  return std::any_of(points_.begin(), points_.end(),
                     [&](const Contact& c) { return !c.closed_n && c.rubs() && acts(c.normal); });
}

void StaticRows::note_closing() {
  closing_.clear();
  for (const Contact& c : points_)
    if (!c.closed_n && c.rubs() && acts(c.normal)) closing_.push_back(c.at.key);
}

double StaticRows::gap_of_closing() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Contact& c : points_)
    if (std::find(closing_.begin(), closing_.end(), c.at.key) != closing_.end())
      least = std::min(least, c.at.gap);
  return least;
}

std::string StaticRows::overlap() const {
  for (const Stop& stop : stops_)
    if (stop.exists && stop.row.gap_n1 < -kOverlapGaps * touching_)
      return format("{} would be passed", stop_name(*system_, stop.interaction));
  for (const Contact& c : points_)
    if (c.at.gap < -kOverlapGaps * touching_)
      return format("{} would overlap", names_of(c.at.a, c.at.b));
  return {};
}

void StaticRows::commit(State& state) {
  for (const Stop& stop : stops_) {
    const UnilateralMemory record{stop.exists ? stop.force : 0.0,
                                  stop.exists && stop.row.gap_n1 <= touching_ ? 1.0 : 0.0};
    write_record(record, state.history.data() + stop.memory);
  }
  if (!contacts_) return;
  StepContext whole = context_;
  whole.dt = 1.0;  // forces, not impulses
  std::vector<ImpulsePoint> list;
  std::vector<ImpulseLoss> losses;
  for (const Contact& c : points_) {
    if (!(c.normal > 0.0)) continue;
    ImpulsePoint& p = list.emplace_back();
    p.a = c.at.a;
    p.b = c.at.b;
    p.number = c.at.number;
    p.normal = p.normal_n = c.at.normal;
    p.place = p.place_n = c.at.place;
    p.gap = c.at.gap;
    p.friction = c.mu_along();
    p.impulse = c.normal * c.at.normal + c.friction;
    p.turning = c.torsion * c.at.normal + c.rolling;
    p.slip = c.slip.norm();
    losses.push_back({0.0, -c.friction.dot(c.slip) - p.turning.dot(c.turn)});
  }
  ImpulseSearch search;
  search.converged = true;
  impulsive_->commit_impulses(state, instants_, whole, list, losses, search);
  std::vector<PairImpact> rows;
  contacts_->impacts(state, rows);
  if (rows.empty()) return;
  std::vector<ResolvedImpact> settled(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const StepRow& row = *rows[k].row;
    settled[k].solved = true;
    settled[k].closed = row.touches;
    settled[k].sticks = row.closes() || row.stuck || row.stops;
  }
  contacts_->settled(state, settled);
}

/// The ground is named last.
std::string StaticRows::names_of(int a, int b) const {
  return a == kGround ? pair_name(*system_, b, a) : pair_name(*system_, a, b);
}

std::vector<std::string> StaticRows::held() const {
  struct Count {
    int sticking = 0, sliding = 0;
  };
  std::vector<std::pair<std::string, Count>> pairs;
  for (const Contact& c : points_) {
    if (!acts(c.normal)) continue;
    const std::string name = names_of(c.at.a, c.at.b);
    auto at = std::find_if(pairs.begin(), pairs.end(),
                           [&](const auto& entry) { return entry.first == name; });
    if (at == pairs.end()) at = pairs.insert(pairs.end(), {name, {}});
    ++(sticks(c) ? at->second.sticking : at->second.sliding);
  }
  std::vector<std::string> list;
  for (const auto& pair : pairs) {
    const std::string& name = pair.first;
    const auto& count = pair.second;
    const auto add = [&](int points, const char* how) {
      if (points > 0)
        list.push_back(format("the contact of {}: {} {}, {}", name, points,
                              points == 1 ? "point" : "points", how));
    };
    add(count.sticking, "held along the normal and by friction");
    add(count.sliding, "held along the normal alone");
  }
  for (const Stop& stop : stops_)
    if (stop.exists && acts(stop.force)) list.push_back(stop_name(*system_, stop.interaction));
  return list;
}

std::vector<std::string> StaticRows::touching() const {
  std::vector<std::string> list;
  for (const Contact& c : points_)
    if (c.at.gap <= touching_) add_once(list, "the contact of " + names_of(c.at.a, c.at.b));
  for (const Stop& stop : stops_)
    if (stop.exists && stop.row.gap_n1 <= touching_)
      add_once(list, stop_name(*system_, stop.interaction));
  return list;
}

std::string StaticRows::rubbing_name(const Contact& c) const {
  return format("the contact of {} (friction {:g})", names_of(c.at.a, c.at.b), c.mu_along());
}

std::vector<std::string> StaticRows::sliding() const {
  std::vector<std::string> list;
  for (const Contact& c : points_)
    if (acts(c.normal) && c.rubs() && c.slip.norm() > touching_) add_once(list, rubbing_name(c));
  return list;
}

std::vector<std::string> StaticRows::with_friction() const {
  std::vector<std::string> list;
  for (const Contact& c : anchors_)
    if (c.rubs()) add_once(list, rubbing_name(c));
  return list;
}

}  // namespace polhode
