// SPDX-License-Identifier: Apache-2.0
// Forces, history and reports of contact between lines of edges. The search is in edge_search.cpp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <polhode/surface_contact/edge_touch.hpp>

namespace polhode::surface_contact {

EdgeContact::EdgeContact(std::string name, Sides sides, const SurfaceLaw& law,
                         const SolidContactStart& start)
    : name_(std::move(name)),
      sides_(std::move(sides)),
      law_(law),
      self_(start.self),
      centre_(sides_.radius > 0.0 ? sides_.radius : law.normal.tolerance),
      shared_first_(sides_.first.shared()),
      shared_second_(sides_.second.shared()),
      nodes_({&sides_.first.vertices, &sides_.second.vertices}, start) {
  const auto squares = [&](const EdgeLines& lines) {
    std::vector<double> list;
    for (const auto& [a, b] : lines.edges)
      list.push_back((nodes_.start(lines.vertices[static_cast<std::size_t>(a)]) -
                      nodes_.start(lines.vertices[static_cast<std::size_t>(b)]))
                         .squaredNorm());
    return list;
  };
  square_first_ = squares(sides_.first);
  square_second_ = squares(sides_.second);
}

const MeshPoint& EdgeContact::end(int e, int f, int k) const {
  const EdgeLines& lines = k < 2 ? sides_.first : sides_.second;
  const auto& edge = lines.edges[static_cast<std::size_t>(k < 2 ? e : f)];
  return lines.vertices[static_cast<std::size_t>(edge[static_cast<std::size_t>(k % 2)])];
}

EdgePairData EdgeContact::data(int e, int f) const {
  EdgePairData d;
  const auto &first = sides_.first.edges[static_cast<std::size_t>(e)],
             &second = sides_.second.edges[static_cast<std::size_t>(f)];
  for (std::size_t k = 0; k < 2; ++k) {
    d.shared[k] = shared_first_[static_cast<std::size_t>(first[k])];
    d.shared[k + 2] = shared_second_[static_cast<std::size_t>(second[k])];
  }
  d.squares =
      square_first_[static_cast<std::size_t>(e)] * square_second_[static_cast<std::size_t>(f)];
  d.centre = centre_;
  d.retreat = sides_.retreat;
  d.behind = sides_.behind;
  const auto take = [&](const EdgeLines& lines, int edge, EdgeLines::Points& own) {
    if (lines.points.empty()) return;
    own = lines.points[static_cast<std::size_t>(edge)];
    own.area /= sides_.area;
  };
  take(sides_.first, e, d.points[0]);
  take(sides_.second, f, d.points[1]);
  return d;
}

int EdgeContact::slots() const {
  return static_cast<int>(sides_.first.edges.size() + (self_ ? 0 : sides_.second.edges.size()));
}

int EdgeContact::slot_of_second(int f) const {
  return f + (self_ ? 0 : static_cast<int>(sides_.first.edges.size()));
}

std::size_t EdgeContact::history_size() const { return totals() + kNumbersOf<Totals>; }

/// Pair of edges over a step, with its history. If its whole potential closes within the step, an
/// impact begins.
EdgeContact::Touch EdgeContact::touch(const NodeStep& step, const double* history, int e,
                                      int f) const {
  FourMoves moves;
  const bool instant = step.x_n == step.x_n1;
  for (int k = 0; k < 4; ++k) {
    const MeshPoint& p = end(e, f, k);
    moves.x_n1[k] = p.at(step.x_n1);
    moves.u[k] = instant ? Vec3(Vec3::Zero()) : p.at(step.u);
  }
  int slot = -1;
  if (memory_of(history, e).partner == f + 1.0)
    slot = e;
  else if (memory_of(history, slot_of_second(f)).partner == e + 1.0)
    slot = slot_of_second(f);
  PointPhase phase = phase_of(history, slot);
  const auto pair = [&] {
    const SurfaceLaw law = phase.law(law_, with_band_lowered);
    return EdgePair(moves, data(e, f), law, step.alpha_f, step.context.conserving);
  };
  Touch t{e, f, slot, -1, phase, pair(), {}, {}};
  if (!t.pair.acts() || !phase.open() || !step.context.conserving || !(step.context.dt > 0.0))
    return t;
  const bool closed = t.pair.within(false);
  double speed = 0.0;
  if (!closed) {
    Vec3 x_n[4], y = Vec3::Zero(), v = Vec3::Zero();
    moves.at(0.0, x_n);
    const NearestFour nearest = nearest_of_edges(x_n);
    for (int k = 0; k < 4; ++k) {
      y += nearest.c[k] * (x_n[k] - x_n[0]);
      v += nearest.c[k] * end(e, f, k).at(step.v_n);
    }
    speed = y.normalized().dot(v);
  }
  const contact::NormalLaw& normal = law_.normal;
  t.phase = phase =
      phase.in_step(law_, closed ? normal.floor() : normal.reach(), speed, with_band_lowered);
  if (phase.in_impact()) t.pair = pair();
  return t;
}

std::vector<EdgeContact::Touch> EdgeContact::touches(const NodeStep& step, const double* history,
                                                     bool tangent) const {
  std::vector<Touch> list;
  const auto stays = [&](const Touch& t) { return t.pair.gap_n1() < law_.normal.reach(); };
  for (const auto& [e, f] : search(history).pairs) {
    Touch t = touch(step, history, e, f);
    // The history of an opened pair is kept until it has left the band of all its terms.
    if (t.pair.acts() || (t.slot_n >= 0 && stays(t))) list.push_back(std::move(t));
  }
  std::vector<char> taken(static_cast<std::size_t>(slots()), 0);
  for (Touch& t : list)
    if (t.slot_n >= 0 && stays(t)) taken[static_cast<std::size_t>(t.slot_n1 = t.slot_n)] = 1;
  for (Touch& t : list)
    for (const int slot : {t.e, slot_of_second(t.f)})
      if (t.slot_n1 < 0 && stays(t) && !taken[static_cast<std::size_t>(slot)])
        taken[static_cast<std::size_t>(t.slot_n1 = slot)] = 1;
  for (Touch& t : list) {
    if (!(law_.mu > 0.0 && step.context.dt > 0.0) || !t.pair.acts() || t.phase.in_impact())
      continue;
    Vec3 kept = Vec3::Zero();
    double kept_along = 0.0;
    if (t.slot_n >= 0) {
      const EdgeMemory memory = memory_of(history, t.slot_n);
      kept = Vec3(memory.bristle);
      kept_along = memory.bristle_along;
    }
    t.slide = t.pair.slide(kept, tangent);
    t.along = t.pair.slide_along(kept_along, tangent);
    const double half_k = 0.5 * law_.bristle;
    if (t.slot_n1 >= 0 && t.pair.within(true))
      t.bristle_n1 =
          half_k * (t.slide.bristle.squaredNorm() + t.along.bristle_n1 * t.along.bristle_n1);
    t.by_friction =
        std::max(0.0, -t.slide.friction.dot(t.slide.slid) - t.along.friction * t.along.slid -
                          t.bristle_n1 + half_k * (kept.squaredNorm() + kept_along * kept_along));
  }
  return list;
}

/// @eq{edge-potential} @eq{edge-friction}
ElementReport EdgeContact::evaluate(const NodeStep& step, const double* history,
                                    double* /*scratch*/, const Mat3& /*turn*/,
                                    const ElementSink& sink) const {
  const bool tangent = sink.tangent != nullptr;
  for (const Touch& t : touches(step, history, tangent)) {
    const EdgePair::Force f = sides_.area * (t.pair.force() + t.slide.force + t.along.force);
    for (int k = 0; k < 4; ++k) {
      const MeshPoint& p = end(t.e, t.f, k);
      for (int a = 0; a < p.count; ++a)
        for (int c = 0; c < 3; ++c) sink.force[3 * p.node[a] + c] += p.N[a] * f[3 * k + c];
    }
    if (!tangent) continue;
    const EdgePair::Stiffness K =
        sides_.area * (t.pair.stiffness() + t.slide.K + t.along.K +
                       t.slide.by_pressure * t.pair.pressure_slope().transpose());
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        nodes_.add(search(history).blocks, end(t.e, t.f, i), end(t.e, t.f, j),
                   K.block<3, 3>(3 * i, 3 * j), sink.tangent);
  }
  return {};
}

Work EdgeContact::work(const NodeStep& step, const double* history,
                       const double* /*scratch*/) const {
  Work w;
  const bool instant = step.x_n == step.x_n1;
  for (const Touch& t : touches(step, history, false)) {
    w.stored += sides_.area * (t.pair.stored() + t.bristle_n1);
    if (!instant) w.dissipated += sides_.area * (t.by_friction + taken_by_pressure(step, t));
  }
  for (int s = 0; instant && s < slots(); ++s) {
    const EdgeMemory kept = memory_of(history, s);
    w.stored += sides_.area * 0.5 * law_.bristle *
                (Vec3(kept.bristle).squaredNorm() + kept.bristle_along * kept.bristle_along);
  }
  return w;
}

double EdgeContact::taken_by_pressure(const NodeStep& step, const Touch& t) const {
  if (!(t.phase.law(law_, with_band_lowered).end_share > 0.0) && step.alpha_f == 0.5) return 0.0;
  // For pairs that share a node only the sum is nonnegative.
  return of_cables() ? t.pair.dissipated() : std::max(0.0, t.pair.dissipated());
}

void EdgeContact::commit(const NodeStep& step, double* history, const double* /*scratch*/) const {
  double* const numbers = history + totals();
  SurfaceTotals sums = SurfaceTotals::sums_of(numbers);
  sums.gap = least_gap(step.x_n1, history);
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero(), moment = Vec3::Zero();
  const std::vector<Touch> list = touches(step, history, false);
  std::fill(history + place_of(0), numbers, 0.0);
  for (const Touch& t : list) {
    const EdgePair::Force f = t.pair.force() + t.slide.force + t.along.force;
    const Vec3 friction_force = sides_.area * (t.slide.friction + t.along.on_first);
    const bool slips = t.slide.slips || t.along.slips;
    const Vec3 on_first = sides_.area * (f.segment<3>(0) + f.segment<3>(3));
    const double normal = sides_.area * std::max(0.0, t.pair.pressure());
    sums.friction_loss += sides_.area * t.by_friction;
    sums.normal_loss += sides_.area * taken_by_pressure(step, t);
    if (step.x_n != step.x_n1) sums.impulse += normal * step.context.dt;  // otherwise statics
    if (normal > 0.0) {
      sums.normal_force += normal;
      (slips ? sums.slipping : sums.sticking) += 1.0;
      force += on_first;
      friction += friction_force;
      moment += normal * t.pair.point();
    }
    if (t.slot_n1 < 0) continue;
    EdgeMemory kept{};
    kept.partner = (t.slot_n1 == t.e ? t.f : t.e) + 1.0;
    kept.slips = slips ? 1.0 : 0.0;
    const bool closed = t.pair.within(true);
    const double reach = law_.normal.reach();
    kept.phase = t.phase.at_end(
        law_, closed ? law_.normal.floor() : std::max(t.pair.gap_n1(), reach - t.phase.lowered));
    set(kept.bristle, closed ? t.slide.bristle_n1 : Vec3(Vec3::Zero()));
    set(kept.force, on_first);
    set(kept.friction, friction_force);
    kept.normal_force = normal;
    kept.bristle_along = closed ? t.along.bristle_n1 : 0.0;
    write_record(kept, history + place_of(t.slot_n1));
  }
  if (sums.normal_force > 0.0) moment /= sums.normal_force;
  set(sums.force, force);
  set(sums.friction, friction);
  set(sums.point, moment);
  write_record(sums, numbers);
  if (lowered(history) > 0.0 && !(least_of_terms(step.x_n1, history) < law_.normal.reach()))
    write_record(Totals{sums, 0.0}, numbers);
  nodes_.renew(step, history);
}

SurfaceReport EdgeContact::report(const double* history) const {
  return SurfaceTotals::report(history + totals());
}

std::vector<SurfacePointReport> EdgeContact::point_reports(const NodeStep& instant,
                                                           const double* history) const {
  std::vector<SurfacePointReport> list;
  for (int slot = 0; slot < slots(); ++slot) {
    const EdgeMemory kept = memory_of(history, slot);
    if (!(kept.normal_force > 0.0)) continue;
    const int firsts = static_cast<int>(sides_.first.edges.size());
    const int partners = slot < firsts ? slots() - firsts : firsts;
    if (!(kept.partner >= 1.0 && kept.partner <= partners)) continue;
    const int partner = static_cast<int>(kept.partner) - 1;
    const int e = slot < firsts ? slot : partner, f = slot < firsts ? partner : slot - firsts;
    FourMoves at;
    for (int k = 0; k < 4; ++k) {
      at.x_n1[k] = end(e, f, k).at(instant.x_n1);
      at.u[k].setZero();
    }
    const SurfaceLaw law = with_band_lowered(law_, phase_of(history, slot).lowered);
    const EdgePair pair(at, data(e, f), law, 1.0, true);
    list.push_back({.point = pair.point(),
                    .normal = pair.normal(),
                    .force = Vec3(kept.force),
                    .friction = Vec3(kept.friction),
                    .gap = pair.gap_n1() + centre_ - sides_.radius,
                    .pressure = kept.normal_force / sides_.area});
  }
  return list;
}

}  // namespace polhode::surface_contact
