// SPDX-License-Identifier: Apache-2.0
// Admissible displacements, losses, history and reports of a surface contact.
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/dynamics/load_step.hpp>
#include <polhode/surface_contact/conservative_advancement.hpp>
#include <polhode/surface_contact/line_stretch.hpp>
#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode::surface_contact {

namespace {

/// Clearance, in bands, above which all are equal.
constexpr double kFarReport = 10.0;
/// Displacement, over the pass-through depth, below which it cannot pass through.
constexpr double kThroughBeam = 2.0;
constexpr int kHalvings = 6;
/// Cosine between the ways out of a shape below which they are opposite: less than zero, as those
/// of neighbouring faces of a box are at right angles.
constexpr double kOpposite = -1e-6;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace

void SurfaceContact::clearances(const NodeStep& step, const double* /*history*/,
                                std::vector<double>& list) const {
  if (law_.normal.is_spring()) return;
  const double floor = law_.normal.floor(), band = 2.0 * law_.normal.tolerance;
  for (int i = 0; i < size(); ++i)
    list.push_back((distance(local(step.x_n1, i), floor + kFarReport * band) - floor) / band);
}

/// Admissible part of a displacement for stretched segments of a cable: between their points the
/// shape could pass.
double SurfaceContact::free_of_stretch(const NodeStep& from, const NodeStep& to) const {
  double most = 1.0;
  if (std::isinf(points_.most_apart)) return most;
  for (int i = 0; i < size(); ++i) {
    const std::span<const int> ends = nodes(i);
    const RoundLine::Span span{ends[0], ends[1], points_.points[static_cast<std::size_t>(i)].span};
    most = std::min(most,
                    polhode::surface_contact::free_of_stretch(span, points_.most_apart, from, to));
  }
  return most;
}

/// Whether the straight displacement of a step passes through the shape. The iterates of a step
/// could be led around a cable to its far side, since a cable has no inside.
bool SurfaceContact::goes_through(const Vec3& from, const Vec3& to) const {
  const Vec3 way = to - from;
  const double length = way.norm();
  if (length < kThroughBeam * points_.through) return false;
  double part = 0.0;
  for (int k = 0; k < kMaxAdvances && part < 1.0; ++k) {
    const double clearance = distance(from + part * way) + points_.through;
    if (clearance <= kLeave * points_.through) return true;
    part += clearance / length;
  }
  return false;
}

/// Admissible part of a displacement. The gap changes by at most the displacement in the surface's
/// coordinates. Iterates of statics may be within the shape, but no point leaves it on another side
/// than that on which it was at the last equilibrium: where the straight way since then leads
/// through the shape, and the ways out of it at both ends are opposite. A way around a corner or a
/// round side turns them by less than a right angle in a load step short enough.
double SurfaceContact::free_part(const NodeStep& from, const NodeStep& to,
                                 const double* /*history*/) const {
  const double band = 2.0 * law_.normal.tolerance;
  if (is_load_step(from.context)) {
    const auto out = [&](const Vec3& y) {
      return gap(y, {.law = law_.normal, .sided = true}).normal;
    };
    const auto passes = [&](const Vec3& y_n, const Vec3& y) {
      const Vec3 way = y - y_n;
      const double length = way.norm();
      if (length < band) return false;
      bool enters = false;
      double part = 0.0;
      for (int k = 0; !enters && part < 1.0; ++k) {
        const double outside =
            distance(y_n + part * way, (1.0 - part) * length + band, true) + band;
        enters = outside <= kLeave * band || k == kMaxAdvances;
        part += outside / length;
      }
      return enters && out(y_n).dot(out(y)) < kOpposite;
    };
    double most = 1.0;
    for (int i = 0; i < size(); ++i) {
      const Vec3 y_n = local(from.x_n, i), start = local(from.x_n1, i);
      const Vec3 way = local(to.x_n1, i) - start;
      for (int k = 0; k < kHalvings && passes(y_n, start + most * way); ++k) most *= 0.5;
    }
    return most;
  }
  if (law_.normal.is_spring()) return 1.0;
  double most = free_of_stretch(from, to);
  const double floor = law_.normal.floor();
  for (int i = 0; i < size(); ++i) {
    const Vec3 start = local(from.x_n1, i), way = local(to.x_n1, i) - start;
    const double length = way.norm();
    if (of_cable()) {
      const Vec3 y_n = local(from.x_n, i);
      const bool beside = !goes_through(y_n, start);
      for (int k = 0; beside && k < kHalvings && goes_through(y_n, start + most * way); ++k)
        most *= 0.5;
    }
    const auto clearance_at = [&](const Vec3& y) {
      return distance(y, floor + length + band) - floor;
    };
    const double clearance = clearance_at(start);
    if (clearance <= 0.0) continue;
    most = conservative_advancement(most, clearance, kLeave * std::min(clearance, band), length,
                                    [&](double part) { return clearance_at(start + part * way); });
  }
  return most;
}

std::optional<SurfaceOverlap> SurfaceContact::overlap(const NodeStep& instant) const {
  double least = -law_.normal.tolerance;
  int deepest = -1;
  for (int i = 0; i < size(); ++i) {
    const double d = distance(local(instant.x_n1, i), least, true);
    if (!(d < least)) continue;
    least = d;
    deepest = i;
  }
  if (deepest < 0) return {};
  const GapQuery question{.law = law_.normal, .sided = true};
  const Vec3 normal = gap(local(instant.x_n1, deepest), question).normal;
  return SurfaceOverlap{-least, axes(instant.x_n1) * normal.normalized()};
}

SurfaceContact::Energies SurfaceContact::energies(const NodeStep& step, const Action& a,
                                                  const PointMemory& memory) const {
  const Vec3 kept(memory.bristle);
  const SurfaceLaw in_step = a.phase.law(law_);
  const contact::NormalLaw& law = in_step.normal;
  const bool stays = a.gap_n1 < law.reach();
  const double half_k = 0.5 * law_.bristle;
  const double bristle_n1 = stays ? half_k * a.bristle.squaredNorm() : 0.0;
  const double e_n1 = law.energy(a.gap_n1);
  Energies e;
  e.stored = e_n1 + bristle_n1;
  e.by_friction = std::max(0.0, -a.friction.dot(a.slid) - bristle_n1 + half_k * kept.squaredNorm());
  if (in_step.end_share > 0.0 || step.alpha_f != 0.5)
    e.by_pressure = std::max(0.0, -a.lambda * (a.gap_n1 - a.gap_n) - e_n1 + law.energy(a.gap_n));
  return e;
}

Work SurfaceContact::work(const NodeStep& step, const double* history,
                          const double* /*scratch*/) const {
  Work w;
  const bool instant = step.x_n == step.x_n1;
  const bool gets_in = law_.normal.is_spring();
  for (int i = 0; i < size(); ++i) {
    const PointMemory memory = memory_of(history, i);
    const double area = points_.points[static_cast<std::size_t>(i)].area;
    if (instant) {
      const Vec3 kept(memory.bristle);
      const contact::NormalLaw law = law_of(memory).normal;
      const double now = gap(local(step.x_n1, i), {law, law.reach(), gets_in}).value;
      w.stored += area * (law.energy(now) + 0.5 * law_.bristle * kept.squaredNorm());
      continue;
    }
    const Action a = act(step, i, memory, false);
    if (!a.acts) continue;
    const Energies e = energies(step, a, memory);
    w.stored += area * e.stored;
    w.dissipated += area * (e.by_friction + e.by_pressure);
  }
  return w;
}

void SurfaceContact::initialize(double* history) const {
  std::fill_n(history, history_size(), 0.0);
  write_start(gaps_at_start_, history);
}

void SurfaceContact::begin_at(const NodeStep& instant, double* history) const {
  std::vector<double> gaps;
  for (int i = 0; i < size(); ++i)
    gaps.push_back(distance(local(instant.x_n1, i), kInfinite, true));
  write_start(gaps, history);
}

/// @eq{surface-start}
void SurfaceContact::write_start(const std::vector<double>& gaps, double* history) const {
  double least = kInfinite;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    least = std::min(least, gaps[i]);
    PointMemory memory = memory_of(history, static_cast<int>(i));
    memory.phase = {lowered_for(law_, gaps[i])};
    write_record(memory, history + place_of(static_cast<int>(i)));
  }
  SurfaceTotals::set_gap(least, history + totals());
}

void SurfaceContact::commit(const NodeStep& step, double* history,
                            const double* /*scratch*/) const {
  double* const numbers = history + totals();
  SurfaceTotals t = SurfaceTotals::sums_of(numbers);
  t.gap = std::numeric_limits<double>::infinity();
  const bool instant = step.x_n == step.x_n1;  // in statics nothing moves
  const Mat3 R = (1.0 - step.alpha_f) * axes(step.x_n) + step.alpha_f * axes(step.x_n1);
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero(), moment = Vec3::Zero();
  for (int i = 0; i < size(); ++i) {
    PointMemory memory = memory_of(history, i);
    const double area = points_.points[static_cast<std::size_t>(i)].area;
    const Action a = act(step, i, memory, false);
    t.gap = std::min(t.gap, a.acts ? a.gap_n1 : distance(local(step.x_n1, i), t.gap));
    if (a.acts && !instant) {
      const Energies e = energies(step, a, memory);
      t.friction_loss += area * e.by_friction;
      t.normal_loss += area * e.by_pressure;
      t.impulse += area * a.pressure * step.context.dt;
    }
    if (a.acts && a.pressure > 0.0) {
      t.normal_force += area * a.pressure;
      t.area += area;
      t.pressure = std::max(t.pressure, a.pressure);
      (a.slips ? t.slipping : t.sticking) += 1.0;
      force += area * a.h;
      friction += area * a.friction;
      moment += area * a.pressure * foot(step.x_n1, i);
    }
    const bool stays = a.gap_n1 < law_of(memory).normal.reach();
    set(memory.bristle, stays ? a.bristle : Vec3(Vec3::Zero()));
    memory.slips = stays && a.slips ? 1.0 : 0.0;
    set(memory.force, a.h);
    set(memory.friction, a.friction);
    memory.pressure = a.pressure;
    memory.phase = a.phase.at_end(law_, a.gap_n1);
    write_record(memory, history + place_of(i));
  }
  if (t.normal_force > 0.0) moment /= t.normal_force;
  set(t.force, R * force);
  set(t.friction, R * friction);
  set(t.point, moment);
  write_record(t, numbers);
}

SurfaceReport SurfaceContact::report(const double* history) const {
  return SurfaceTotals::report(history + totals());
}

std::vector<SurfacePointReport> SurfaceContact::point_reports(const NodeStep& instant,
                                                              const double* history) const {
  std::vector<SurfacePointReport> list;
  const Mat3 R = axes(instant.x_n1);
  for (int i = 0; i < size(); ++i) {
    const PointMemory memory = memory_of(history, i);
    if (!(memory.pressure > 0.0)) continue;
    const double area = points_.points[static_cast<std::size_t>(i)].area;
    const contact::NormalLaw law = law_of(memory).normal;
    const RigidSurface::Gap here = gap(local(instant.x_n1, i), {law});
    list.push_back({.point = foot(instant.x_n1, i),
                    .normal = R * here.normal.normalized(),
                    .force = area * (R * Vec3(memory.force)),
                    .friction = area * (R * Vec3(memory.friction)),
                    .gap = here.value,
                    .pressure = memory.pressure});
  }
  return list;
}

void SurfaceContact::add_to_nodes(const NodeStep& instant, const double* history,
                                  std::vector<NodeContact>& nodes) const {
  if (of_cable()) return;
  std::vector<double> areas(nodes.size(), 0.0);
  for (int i = 0; i < size(); ++i) {
    const SurfacePoints::Point& point = points_.points[static_cast<std::size_t>(i)];
    const double gap = distance(local(instant.x_n1, i));
    double sum = 0.0;  // shape functions are negative at some corners
    for (int k = 0; k < n_; ++k) sum += std::abs(point.N[k]);
    for (int k = 0; k < n_; ++k) {
      const auto number = static_cast<std::size_t>(this->nodes(i)[static_cast<std::size_t>(k)]);
      const double area = std::abs(point.N[k]) / sum * point.area;
      areas[number] += area;
      nodes[number].force += area * std::max(memory_of(history, i).pressure, 0.0);
      nodes[number].gap = std::min(nodes[number].gap, gap);
    }
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].area = std::max(nodes[i].area, areas[i]);
}

}  // namespace polhode::surface_contact
