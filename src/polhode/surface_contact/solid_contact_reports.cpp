// SPDX-License-Identifier: Apache-2.0
// Losses, history and reports of the contact of solids.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_contact_field.hpp>

namespace polhode::surface_contact {

SolidContact::Energies SolidContact::energies(const NodeStep& step, const Action& a,
                                              const Slide& slide, const PointMemory& memory) const {
  const Vec3 kept(memory.bristle);
  const SurfaceLaw in_step = a.phase.law(law_, with_band_lowered);
  const contact::NormalLaw& law = in_step.normal;
  const bool stays = a.gap_n1 < law.reach();
  const double half_k = 0.5 * law_.bristle;
  const double bristle_n1 = stays ? half_k * slide.bristle.squaredNorm() : 0.0;
  const double e_n1 = law.energy(a.gap_n1);
  Energies e;
  e.stored = e_n1 + bristle_n1;
  e.by_friction =
      std::max(0.0, -slide.friction.dot(slide.slid) - bristle_n1 + half_k * kept.squaredNorm());
  if (in_step.end_share > 0.0 || step.alpha_f != 0.5)
    e.by_pressure =
        std::max(0.0, -a.pressure.value * (a.gap_n1 - a.gap_n) - e_n1 + law.energy(a.gap_n));
  return e;
}

Work SolidContact::work(const NodeStep& step, const double* history,
                        const double* /*scratch*/) const {
  Work w;
  const bool instant = step.x_n == step.x_n1;
  const Search& s = search(history);
  if (s.triangle.empty()) return w;
  const Field x_n(surface_, step.x_n), x_n1(surface_, step.x_n1);
  const Field u(surface_, instant ? step.x_n : step.u);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    if (triangles.empty()) continue;
    const PointMemory kept = memory_of(history, p);
    const double area = points_[static_cast<std::size_t>(p)].area;
    if (instant) {
      const contact::NormalLaw law = law_of(kept).normal;
      const Nearest n = nearest(x_n1, triangles, p);
      const double gap =
          (of_cable() ? this->gap(x_n1, triangles, p, n, law).distance : n.distance) - centre_;
      w.stored += area * (law.energy(gap) + 0.5 * law_.bristle * Vec3(kept.bristle).squaredNorm());
      continue;
    }
    const Action a = act(step, x_n, x_n1, triangles, p, kept);
    if (!a.acts) continue;
    const Slide slide = a.has_friction(law_) ? this->slide(step, x_n1, u, triangles, p,
                                                           a.normal_force.value, kept, false)
                                             : Slide{};
    const Energies e = energies(step, a, slide, kept);
    w.stored += area * e.stored;
    w.dissipated += area * (e.by_friction + e.by_pressure);
  }
  return w;
}

void SolidContact::commit(const NodeStep& step, double* history, const double* /*scratch*/) const {
  double* const numbers = history + totals();
  SurfaceTotals t = SurfaceTotals::sums_of(numbers);
  t.gap = std::numeric_limits<double>::infinity();
  const Search& s = search(history);
  const Field x_n(surface_, step.x_n), x_n1(surface_, step.x_n1), u(surface_, step.u);
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero(), moment = Vec3::Zero();
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    PointMemory kept = memory_of(history, p);
    const MeshPoint& point = points_[static_cast<std::size_t>(p)];
    const std::span<const int> triangles = found(s, p);
    Action a;
    Slide slide;
    Vec3 h = Vec3::Zero();
    if (!triangles.empty()) {
      a = act(step, x_n, x_n1, triangles, p, kept);
      t.gap = std::min(t.gap, a.gap_n1 + centre_ - cable_.radius);
    }
    if (a.acts) {
      if (a.has_friction(law_))
        slide = this->slide(step, x_n1, u, triangles, p, a.normal_force.value, kept, false);
      h = slide.friction;
      with_gap(step, x_n1, u, p, a, [&](const auto& gap, const auto& /*at*/) {
        h += gap.on_point(gap.force(a.pressure.value));
      });
      const Energies e = energies(step, a, slide, kept);
      t.friction_loss += point.area * e.by_friction;
      t.normal_loss += point.area * e.by_pressure;
      if (step.x_n != step.x_n1) t.impulse += point.area * a.normal_force.value * step.context.dt;
    }
    const double pressure = a.acts ? a.normal_force.value : 0.0;
    if (pressure > 0.0) {
      t.normal_force += point.area * pressure;
      t.area += point.area;
      t.pressure = std::max(t.pressure, pressure);
      (slide.slips ? t.slipping : t.sticking) += 1.0;
      force += point.area * h;
      friction += point.area * slide.friction;
      moment += point.area * pressure * foot(x_n1, a.at_n1, p);
    }
    const bool stays = a.acts && a.gap_n1 < law_of(kept).normal.reach();
    set(kept.bristle, stays ? slide.bristle_n1 : Vec3(Vec3::Zero()));
    kept.slips = stays && slide.slips ? 1.0 : 0.0;
    set(kept.force, h);
    set(kept.friction, slide.friction);
    kept.pressure = pressure;
    const double gap = triangles.empty() ? std::numeric_limits<double>::infinity() : a.gap_n1;
    kept.phase = (a.acts ? a.phase : kept.phase).at_end(law_, gap);
    write_record(kept, history + place_of(p));
  }
  if (!std::isfinite(t.gap)) t.gap = std::numeric_limits<double>::quiet_NaN();
  if (t.normal_force > 0.0) moment /= t.normal_force;
  set(t.force, force);
  set(t.friction, friction);
  set(t.point, moment);
  write_record(t, numbers);
  nodes_.renew(step, history);
}

/// From the triangles to a point of a cable.
Vec3 SolidContact::normal(const Field& field, const MeshGap& gap, int point) const {
  Vec3 sum = Vec3::Zero();
  for (const MeshGap::Part& part : gap.parts) {
    Vec3 x[4], y = Vec3::Zero();
    four_points(field, point, part.triangle, x);
    for (int k = 0; k < 4; ++k) y += part.four.c[k] * (x[k] - x[0]);
    sum += part.share * y.normalized();
  }
  return sum.normalized();
}

/// Point of the round section about a point that is nearest to the surface.
Vec3 SolidContact::foot(const Field& field, const MeshGap& gap, int point) const {
  const Vec3 at = points_[static_cast<std::size_t>(point)].at(field.nodes);
  return of_cable() ? Vec3(at - cable_.radius * normal(field, gap, point)) : at;
}

/// Writes the start of a history: the node positions of the search; NaN where nothing is near.
/// @eq{surface-start}
void SolidContact::write_start(double* history) const {
  const std::vector<double> x = nodes_.positions(history);
  const Search& s = search(history);
  const Field start(surface_, x.data());
  double least = std::numeric_limits<double>::infinity();
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const double d = nearest(start, found(s, p), p).distance;
    least = std::min(least, d - cable_.radius);
    PointMemory memory = memory_of(history, p);
    memory.phase = {lowered_for(law_, d - centre_)};
    write_record(memory, history + place_of(p));
  }
  SurfaceTotals::set_gap(std::isfinite(least) ? least : std::numeric_limits<double>::quiet_NaN(),
                         history + totals());
}

SurfaceReport SolidContact::report(const double* history) const {
  return SurfaceTotals::report(history + totals());
}

std::vector<SurfacePointReport> SolidContact::point_reports(const NodeStep& instant,
                                                            const double* history) const {
  std::vector<SurfacePointReport> list;
  const Search& s = search(history);
  const Field x(surface_, instant.x_n1);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const PointMemory kept = memory_of(history, p);
    if (!(kept.pressure > 0.0)) continue;
    const MeshPoint& point = points_[static_cast<std::size_t>(p)];
    const std::span<const int> triangles = found(s, p);
    const Nearest n = nearest(x, triangles, p);
    if (n.triangle < 0) continue;
    SurfacePointReport& r = list.emplace_back();
    if (of_cable()) {
      const MeshGap gap = this->gap(x, triangles, p, n, law_of(kept).normal);
      r = {.point = foot(x, gap, p), .normal = normal(x, gap, p), .gap = gap.distance - radius()};
    } else {
      r = {.point = point.at(x.nodes),
           .normal = vector_to(p, n.foot).between(x.nodes).normalized(),
           .gap = n.distance};
    }
    r.force = point.area * Vec3(kept.force);
    r.friction = point.area * Vec3(kept.friction);
    r.pressure = kept.pressure;
  }
  return list;
}

/// Points of each solid bear a part of the pressure between them, those of the other one the rest:
/// each force is shared by the nodes on both sides.
void SolidContact::add_to_nodes(const NodeStep& instant, const double* history,
                                std::vector<NodeContact>& nodes) const {
  if (of_cable()) return;
  const Search& s = search(history);
  const Field x(surface_, instant.x_n1);
  std::vector<double> areas(nodes.size(), 0.0);
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const MeshPoint& point = points_[static_cast<std::size_t>(p)];
    const double pressure = std::max(memory_of(history, p).pressure, 0.0);
    const Nearest n = nearest(x, found(s, p), p);
    const bool is_near = n.triangle >= 0;
    const auto share = [&](const MeshPoint& at, double part, const auto& use) {
      double sum = 0.0;  // shape functions are negative at some corners
      for (int a = 0; a < at.count; ++a) sum += std::abs(at.N[a]);
      for (int a = 0; a < at.count; ++a) {
        const auto number = static_cast<std::size_t>(at.node[a]);
        const double area = part * std::abs(at.N[a]) / sum * point.area;
        nodes[number].force += area * pressure;
        if (is_near) nodes[number].gap = std::min(nodes[number].gap, n.distance - centre_);
        use(number, area);
      }
    };
    share(point, 1.0, [&](std::size_t number, double area) { areas[number] += area; });
    if (!is_near) continue;
    const NearestFour four = nearest_triangle(x, {&n.triangle, 1}, p).four;
    const auto& corners = surface_.triangles[static_cast<std::size_t>(n.triangle)];
    for (std::size_t k = 0; k < 3; ++k)
      if (const double part = std::abs(four.c[static_cast<Eigen::Index>(k) + 1]); part > 0.0)
        share(surface_.vertices[static_cast<std::size_t>(corners[k])], part,
              [](std::size_t, double) {});
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].area = std::max(nodes[i].area, areas[i]);
}

}  // namespace polhode::surface_contact
