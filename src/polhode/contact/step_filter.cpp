// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/contact/closed_form_point.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/contact/round_solids/ring.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/contact/tube.hpp>

namespace polhode::contact {

namespace {

/// Part of a point's clearance that is kept in one iteration.
constexpr double kKept = 0.1;
/// The same between balls, which are many and all limited by the tightest pair.
constexpr double kKeptByBalls = 0.35;
/// Part of its clearance below which a point's approach is not followed.
constexpr double kHarmless = 0.9;
/// Smallest advance, as a part of the increment; a smaller one ends the search.
constexpr double kMinAdvance = 1e-4;
/// Tolerance on the kept clearance, as a part of it.
constexpr double kMissing = 0.5;
constexpr int kHalvings = 30;
/// Distance of two parallel planes that count as one, as a part of a ring's radius.
constexpr double kSamePlane = 1e-5;
/// Cayley vector of the largest rotation in one iteration.
constexpr double kLongestTurn = 0.6;

/// Distance of the farthest point of a feature from the origin of its body, the lever arm of
/// rotations.
double lever(const geometry::Shape& s, const FeaturePair& f, bool side_a) {
  if (!s.bounded()) return 0.0;
  if (side_a && is_of_corner(f.kind)) return s.corners[f.i].norm();
  if (s.solid == geometry::Solid::ball) return s.centre.norm();
  return s.reach;
}

/// Whether side a (or b) of a feature pair is a whole solid of revolution, or an end or rim of it:
/// a rotation about its axis does not move it.
bool is_of_revolution(const geometry::Shape& s, const FeaturePair& f, bool side_a) {
  const bool tube = is_tube(s);
  if (!tube && !(s.round() && s.half[0] == s.half[1])) return false;
  switch (f.kind) {
    case GapKind::part_solid:
    case GapKind::round_round:
    case GapKind::end_round:
    case GapKind::part_end:
    case GapKind::rim_bar:
      return true;
    case GapKind::extreme_plane:
    case GapKind::part_triangle:
    case GapKind::part_surface:
    case GapKind::round_edge:
    case GapKind::rim_edge:
      return side_a;
    case GapKind::point_solid:
      return !side_a;
    default:
      return false;
  }
}

/// Bound of the speed by a rotation, per unit of the increment, of the points of side a or b.
double turning_speed(const Vec3& theta, const Mat3& Lambda, const geometry::Shape& s,
                     const FeaturePair& f, bool side_a) {
  if (theta.isZero(0.0)) return 0.0;
  const double far = lever(s, f, side_a);
  if (!is_of_revolution(s, f, side_a)) return theta.norm() * far;
  const Vec3 axis = s.axes.col(2);
  const double along = (Lambda * axis).dot(theta),
               across = (theta - along * (Lambda * axis)).norm();
  return across * far + std::abs(along) * axis.cross(s.centre).norm();
}

/// Approach speed of points z of a body along n per unit of the increment: the effect of the
/// rotation on the points themselves plus an upper bound for the part of it that is left.
double approach_by_turn(const Vec3& theta, const Vec3& n, std::span<const Vec3> z, double left) {
  double most = 0.0, farthest = 0.0;
  for (const Vec3& x : z) {
    most = std::max(most, -n.dot(theta.cross(x)));
    farthest = std::max(farthest, x.norm());
  }
  return most + left * theta.squaredNorm() * farthest;
}

/// Path of a point of a, seen from body b, while both follow their increments.
struct PathSeenFromB {
  const BodyStep &a, &b;
  const Vec6 &x_a, &x_b;
  Vec3 Z;  ///< The point, in body coordinates of a.

  struct Where {
    Mat3 L_a, L_b;
    Vec3 y;  ///< The point, in body coordinates of b.
  };
  [[nodiscard]] Where at(double part) const {
    Where w{cay(part * x_a.tail<3>()) * a.Lambda_n1, cay(part * x_b.tail<3>()) * b.Lambda_n1,
            Vec3::Zero()};
    w.y = w.L_b.transpose() *
          (a.r_n1 + part * x_a.head<3>() + w.L_a * Z - b.r_n1 - part * x_b.head<3>());
    return w;
  }
  /// Bound of the length of this part of the path, for a distance of the point from the centre of
  /// mass of a [m].
  [[nodiscard]] double length(double part, double distance) const {
    return part * ((x_a.head<3>() - x_b.head<3>()).norm() + x_a.tail<3>().norm() * distance);
  }
  /// Bound of the distance from the chord of the path from y [m].
  [[nodiscard]] double bulge(double part, const Vec3& y, double distance) const {
    const double turn_a = part * x_a.tail<3>().norm(), turn_b = part * x_b.tail<3>().norm();
    const double far = length(part, distance);
    return 0.25 *
           (turn_a * turn_a * distance + turn_b * turn_b * (y.norm() + far) + 2.0 * turn_b * far);
  }
};

/// Whether side a of a pair is a part of a shape.
bool has_part(GapKind kind) {
  return kind == GapKind::part_solid || kind == GapKind::part_triangle ||
         kind == GapKind::part_surface;
}

/// Whether all of a part lies in front of the plane across a gap through its nearest point. A ring
/// may have another shape within it, which its other side may approach faster.
bool lies_in_front(const geometry::Shape& part, const Vec3& r, const Mat3& Lambda,
                   const Gap<double>& g) {
  if (!is_ring(part)) return true;
  const Vec3 n = value(g.normal);
  const double nearest = n.dot(value(g.point)) + 0.5 * g.distance + part.rounding,
               extent =
                   part.half.cwiseProduct(part.axes.transpose() * (Lambda.transpose() * n)).norm();
  return n.dot(r + Lambda * part.centre) - extent > nearest - kSamePlane * part.half.x();
}

/// Number of halvings of the rest of the increment in the search for a part in front of a plane.
constexpr int kShorterParts = 4;

/// Points that span side a (or b) of a feature pair, if they are few. @returns how many.
int few_points(const geometry::Shape& s, const FeaturePair& f, bool side_a,
               std::array<Vec3, 2>& points) {
  if (side_a && is_of_corner(f.kind)) {
    points[0] = s.corners[f.i];
    return 1;
  }
  if (s.solid == geometry::Solid::ball) {
    points[0] = s.centre;
    return 1;
  }
  if (f.kind == GapKind::edge_edge) {
    const geometry::Shape::Edge& e = s.edges[side_a ? f.i : f.j];
    points = {s.corners[e.i], s.corners[e.j]};
    return 2;
  }
  return 0;
}

}  // namespace

/// A point that is followed along the increment, and the gap that it keeps [m].
struct ContactSet::Followed {
  int point;
  double least;
};

/// Gap of a point's shapes at a fraction of the increments.
Gap<double> ContactSet::gap_along(const Point& p, const FeaturePair& pair,
                                  std::span<const BodyStep> steps, std::span<const Vec6> increments,
                                  double part) const {
  const auto placed = [&](int shape) {
    const BodyStep& s = step_of(shape, steps);
    const int body = shapes_[shape].body;
    if (body == kGround || part == 0.0) return std::pair(s.r_n1, s.Lambda_n1);
    const Vec6& x = increments[body];
    return std::pair(Vec3(s.r_n1 + part * x.head<3>()),
                     Mat3(cay(part * x.tail<3>()) * s.Lambda_n1));
  };
  const auto [r_a, L_a] = placed(p.a);
  const auto [r_b, L_b] = placed(p.b);
  return gap(pair, *p.data.a, *p.data.b, Placement<double>(r_a, L_a, 0),
             Placement<double>(r_b, L_b, 6));
}

double ContactSet::sensible_part(std::span<const Vec6> increments) const {
  double part = 1.0;
  const auto shorten = [&](const auto& way, double most) {
    if (way.squaredNorm() * part * part > most * most) part = most / way.norm();
  };
  for (std::size_t body = 0; body < references_.size(); ++body) {
    shorten(increments[body].tail<3>(), kLongestTurn);
    if (reach_of_body_[body] > 0.0) shorten(increments[body].head<3>(), stride_[body]);
  }
  return part;
}

/// Largest admissible part of the increments. Points that a bound of the speed finds harmless are
/// not followed. The extreme point of a round solid is always followed: it also slides along its
/// rim, arbitrarily fast where the axis is along the normal.
double ContactSet::filter(std::span<const BodyStep> steps, std::span<const Vec6> increments) {
  const Vec6 still = Vec6::Zero();
  const auto increment = [&](int shape) -> const Vec6& {
    const int body = shapes_[shape].body;
    return body == kGround ? still : increments[body];
  };
  double most = sensible_part(increments);
  std::vector<Followed> closing;
  const auto ground = static_cast<int>(steps.size()) - 1;
  for (int i = 0; i < static_cast<int>(points_.size()); ++i) {
    if (const SpherePairCache& balls = balls_[i]; balls.holds) {
      const Vec6 &x_a = balls.a == ground ? still : increments[balls.a],
                 &x_b = balls.b == ground ? still : increments[balls.b];
      const Vec3 change = x_a.head<3>() - x_b.head<3>();
      if (change.isZero(0.0)) continue;
      const double part = balls.part(steps[balls.a], steps[balls.b], change, kKeptByBalls);
      if (part < most && !points_[i].sensor) {
        most = part;
        tightest_ = i;
      }
      continue;
    }
    const Point& p = points_[i];
    if (p.sensor || !std::isfinite(p.least_gap)) continue;
    const Vec6 &x_a = increment(p.a), &x_b = increment(p.b);
    const Vec3 relative = x_a.head<3>() - x_b.head<3>();
    const geometry::Shape &A = *p.data.a, &B = *p.data.b;
    const BodyStep &a = step_of(p.a, steps), &b = step_of(p.b, steps);
    double speed = turning_speed(x_a.tail<3>(), a.Lambda_n1, A, p.data.pair, true);
    if (B.bounded()) {
      speed += relative.norm();
      speed += turning_speed(x_b.tail<3>(), b.Lambda_n1, B, p.data.pair, false);
    } else {
      speed += std::abs(relative.dot(b.Lambda_n1 * B.axes.col(2)));
      speed += x_b.tail<3>().norm() * ((a.r_n1 - b.r_n1).norm() + A.reach + B.centre.norm());
    }
    if (speed == 0.0) continue;
    // The combined gap of several features may decrease faster than each of theirs.
    const bool surface =
        p.data.pair.kind == GapKind::point_surface || p.data.pair.kind == GapKind::part_surface;
    const auto harmless = [&](double clearance) {
      return most * speed <= (surface ? 0.5 : 1.0) * kHarmless * clearance &&
             p.data.pair.kind != GapKind::extreme_plane;
    };
    if (harmless(least_gap_at_end(p, a, b) - p.least_gap)) continue;
    const double clearance = gap_n1(p.data, p.gap_n, a, b) - p.least_gap;
    if (harmless(clearance)) continue;
    const double band = p.data.normal.reach() - p.least_gap;
    closing.push_back({i, p.least_gap + kKept * std::min(clearance, band)});
  }
  if (closing.empty()) return most;
  double part = most;
  for (const Followed& f : closing) {
    const GapKind kind = points_[f.point].data.pair.kind;
    if (kind != GapKind::point_surface && kind != GapKind::part_surface)
      part = advance(f, steps, increments, part);
  }
  for (const Followed& f : closing) {
    const GapKind kind = points_[f.point].data.pair.kind;
    if (kind == GapKind::point_surface || kind == GapKind::part_surface)
      part = advance_over_surface(f.point, steps, increments, part);
  }
  const auto loses = [&](const Followed& f) {
    const double least = points_[f.point].least_gap;
    if (gap_along(points_[f.point], points_[f.point].data.pair, steps, increments, part).distance >=
        least + (1.0 - kMissing) * (f.least - least))
      return false;
    tightest_ = f.point;
    return true;
  };
  for (int k = 0; k < kHalvings && std::any_of(closing.begin(), closing.end(), loses); ++k)
    part *= 0.5;
  return part;
}

/// Conservative advancement. Along r + a Δr, cay(a Δθ)Λ two convex features approach along their
/// present normal n no faster than v = −n·(Δr_a − Δr_b) + |Δθ_a| ρ_a + |Δθ_b| ρ_b, so a gap can be
/// followed by steps of its own size. A single point also stays clear of b as long as it is in
/// front of the plane that separates both now and turns with b: it may roll or slide along a
/// turning face. Of the rotation of a solid of revolution only the part across its axis counts.
/// A rim around a feature, as the inner side of a tube, is approached by all of the motion.
/// @eq{contact-filter}
double ContactSet::advance(const Followed& followed, std::span<const BodyStep> steps,
                           std::span<const Vec6> increments, double most) {
  const Vec6 still = Vec6::Zero();
  const auto increment = [&](int shape) -> const Vec6& {
    const int body = shapes_[shape].body;
    return body == kGround ? still : increments[body];
  };
  const Point& p = points_[followed.point];
  const Vec6 &x_a = increment(p.a), &x_b = increment(p.b);
  const BodyStep &a = step_of(p.a, steps), &b = step_of(p.b, steps);
  const Vec3 relative = x_a.head<3>() - x_b.head<3>();
  // On a straight path a concave side may be approached faster than along the present normal.
  const GapKind kind = p.data.pair.kind;
  const bool in_tube =
      ((kind == GapKind::point_solid || kind == GapKind::part_solid) && is_tube(*p.data.b)) ||
      kind == GapKind::part_end || is_of_rim(kind) ||
      (kind == GapKind::round_edge && is_tube(*p.data.b));
  const bool ring = has_part(kind) && is_tube(*p.data.a);
  const geometry::Shape rim = ring ? part_of(*p.data.a, p.data.pair.i) : geometry::Shape{};
  std::array<Vec3, 2> ends;
  const bool single = !in_tube && few_points(*p.data.a, p.data.pair, true, ends) == 1;
  const PathSeenFromB path{a, b, x_a, x_b, single ? ends[0] : Vec3::Zero()};
  const auto part_in_front = [&](const Gap<double>& g, double from) {
    const PathSeenFromB::Where now = path.at(from);
    const Vec3 n = now.L_b.transpose() * value(g.normal);
    double part = most - from;
    for (int k = 0; k <= kShorterParts; ++k, part *= 0.5) {
      const double end = g.distance + n.dot(path.at(from + part).y - now.y);
      const double bulge = path.bulge(part, now.y, path.Z.norm());
      if (std::min(g.distance, end) - bulge >= followed.least) return part;
    }
    return 0.0;
  };
  double done = 0.0, last = 0.0;
  for (int k = 0; k < 200; ++k) {
    const Gap<double> g = gap_along(p, p.data.pair, steps, increments, done);
    const Vec3 n = value(g.normal);
    const bool hollow = in_tube || (is_of_hull(kind) && g.feature == kInMouth) ||
                        (ring && !lies_in_front(rim, a.r_n1 + done * x_a.head<3>(),
                                                Mat3(cay(done * x_a.tail<3>()) * a.Lambda_n1), g));
    double speed = hollow ? relative.norm() : std::max(0.0, -n.dot(relative));
    std::array<Vec3, 2> few;
    const auto turns = [&](const Vec3& theta, const Mat3& Lambda, const Vec3& towards,
                           bool side_a) {
      if (theta.isZero(0.0)) return 0.0;
      const geometry::Shape& shape = side_a ? *p.data.a : *p.data.b;
      const int count = few_points(shape, p.data.pair, side_a, few);
      if (count == 0 || hollow) return turning_speed(theta, Lambda, shape, p.data.pair, side_a);
      const Mat3 L = done > 0.0 ? Mat3(cay(done * theta) * Lambda) : Lambda;
      for (int m = 0; m < count; ++m) few[m] = L * few[m];
      return approach_by_turn(theta, towards, std::span(few).first(count), most - done);
    };
    speed += turns(x_a.tail<3>(), a.Lambda_n1, n, true);
    if (p.data.b->bounded())
      speed += turns(x_b.tail<3>(), b.Lambda_n1, -n, false);
    else
      speed += x_b.tail<3>().norm() *
               ((a.r_n1 - b.r_n1).norm() + x_a.norm() + p.data.a->reach + p.data.b->centre.norm());
    double step = speed > 0.0 ? (g.distance - followed.least) / speed
                              : std::numeric_limits<double>::infinity();
    if (single && step < most - done) step = std::max(step, part_in_front(g, done));
    if (step >= most - done) return most;
    tightest_ = followed.point;
    // Bodies that separate from a narrow gap start with small advances, each larger than the last.
    if (!(step > 0.0) || (step < kMinAdvance * most && step < last))
      return done > 0.0 ? done : 1e-3 * most;
    last = step;
    done += step;
  }
  return done;
}

/// Conservative advancement over a surface of triangles. Every nearby triangle is convex, and so is
/// the half space in front of its plane: the part of the increment that leaves the gap to one of
/// both. @eq{contact-filter}
double ContactSet::advance_over_surface(int point, std::span<const BodyStep> steps,
                                        std::span<const Vec6> increments, double most) {
  const Point& p = points_[point];
  const geometry::Shape &A = *p.data.a, &B = *p.data.b;
  const Vec6 still = Vec6::Zero();
  const auto increment = [&](int shape) -> const Vec6& {
    const int body = shapes_[shape].body;
    return body == kGround ? still : increments[body];
  };
  const Vec6 &x_a = increment(p.a), &x_b = increment(p.b);
  const BodyStep &a = step_of(p.a, steps), &b = step_of(p.b, steps);
  const bool corner = p.data.pair.kind == GapKind::point_surface;
  const geometry::Shape part = corner ? geometry::Shape{} : part_of(A, p.data.pair.i);
  const Vec3 Z = corner ? A.corners[p.data.pair.i] : part.centre;
  const double farthest = corner ? 0.0 : part.half.maxCoeff(), round = A.rounding + B.rounding;
  const double lever_a = corner ? Z.norm() : A.reach;
  using Where = PathSeenFromB::Where;
  const PathSeenFromB path{a, b, x_a, x_b, Z};
  const Where start = path.at(0.0), end = path.at(most);
  const Vec3 relative = x_a.head<3>() - x_b.head<3>();
  const double bulge = path.bulge(most, start.y, lever_a);
  const double band = p.data.normal.reach() - p.least_gap;
  const double wide = round + farthest + bulge + std::max(0.0, p.least_gap + kKept * band);
  // Reusable list: the gaps of single triangles evaluated below start no search.
  std::vector<int>& near = SurfaceSearch::of_this_thread().triangles;
  near.clear();
  const Vec3 middle = 0.5 * (start.y + end.y);
  const double around = wide + 0.5 * (end.y - start.y).norm();
  B.tree->visit(
      [&](const auto& box) {
        if (box.squared_distance(middle) > around * around) return false;
        double enters = 0.0, leaves = 1.0;
        for (int k = 0; k < 3; ++k) {
          const double from = start.y[k], along = end.y[k] - from;
          const double low = box.low[k] - wide - from, high = box.high[k] + wide - from;
          if (along == 0.0) {
            if (low > 0.0 || high < 0.0) return false;
            continue;
          }
          enters = std::max(enters, std::min(low / along, high / along));
          leaves = std::min(leaves, std::max(low / along, high / along));
        }
        return enters <= leaves;
      },
      [&](int t) { near.push_back(t); });
  const auto speed = [&](const Vec3& n, const Mat3& L_a, double left, bool in_front) {
    double v = in_front ? std::max(0.0, -n.dot(relative)) : relative.norm();
    if (corner) {
      const std::array<Vec3, 1> z{L_a * Z};
      v += approach_by_turn(x_a.tail<3>(), n, z, left);
    } else {
      v += turning_speed(x_a.tail<3>(), L_a, A, p.data.pair, true);
    }
    return v + x_b.tail<3>().norm() * B.reach;
  };
  for (const int t : near) {
    const FeaturePair alone{corner ? GapKind::point_triangle : GapKind::part_triangle,
                            p.data.pair.i, t, Fade::none};
    const geometry::Shape::Plane& plane = B.planes[t];
    const double side = plane.normal.dot(start.y) < plane.offset ? -1.0 : 1.0;
    const auto over_plane_of_it = [&](const Where& w) {
      double deep = 0.0;
      if (!corner)
        deep =
            part.half
                .cwiseProduct(part.axes.transpose() * (w.L_a.transpose() * (w.L_b * plane.normal)))
                .norm();
      return side * (plane.normal.dot(w.y) - plane.offset) - deep - round;
    };
    const double first = over_plane_of_it(start);
    double least = p.least_gap + kKept * std::min(first - p.least_gap, band);
    bool least_known = first >= p.least_gap;
    double done = 0.0, last = 0.0;
    for (int k = 0; k < 200 && done < most; ++k) {
      const Where w = path.at(done);
      const auto next = [&](double gap, const Vec3& n, bool in_front) {
        const double v = speed(n, w.L_a, most - done, in_front);
        return gap < least ? 0.0
               : v > 0.0   ? (gap - least) / v
                           : std::numeric_limits<double>::infinity();
      };
      double step =
          least_known ? next(over_plane_of_it(w), Vec3(side * (w.L_b * plane.normal)), true) : 0.0;
      if (!(step >= most - done)) {
        const Gap<double> g = gap_along(p, alone, steps, increments, done);
        if (k == 0) {
          least = p.least_gap + kKept * std::min(std::max(0.0, g.distance - p.least_gap), band);
          least_known = true;
        }
        const bool in_front = lies_in_front(part, a.r_n1 + done * x_a.head<3>(), w.L_a, g);
        step = std::max(step, next(g.distance, value(g.normal), in_front));
      }
      if (step >= most - done) {
        done = most;
      } else if (!(step > 0.0) || (step < kMinAdvance * most && step < last)) {
        most = done > 0.0 ? done : 1e-3 * most;
        tightest_ = point;
        break;
      } else {
        last = step;
        done += step;
      }
    }
    most = std::min(most, std::max(done, 1e-3 * most));
  }
  return most;
}

}  // namespace polhode::contact
