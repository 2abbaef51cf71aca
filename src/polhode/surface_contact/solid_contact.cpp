// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/surface_contact/solid_contact.hpp>
#include <polhode/surface_contact/solid_contact_field.hpp>

namespace polhode::surface_contact {

namespace {

/// Distance from the edge of a face, over the face's size, below which a point is over the edge.
constexpr double kOnEdge = 1e-6;

}  // namespace

SolidContact::SolidContact(std::string name, std::vector<MeshPoint> points, MeshSurface surface,
                           const SurfaceLaw& law, const SolidContactStart& start, RoundLine cable)
    : name_(std::move(name)),
      points_(std::move(points)),
      surface_(std::move(surface)),
      law_(law),
      self_(start.self),
      cable_(std::move(cable)),
      centre_(of_cable() ? cable_.radius : law.normal.tolerance),
      nodes_({&points_, &surface_.vertices}, start) {
  if (!of_cable()) round_edges();
}

/// Patches, and for each point the width of rounded edges. A point that is opposite to the surface
/// at the start, but not exactly over an edge, is outside of it: overlaps of both meshes, whose
/// weights are those of the faces, then load both evenly.
void SolidContact::round_edges() {
  std::vector<double> history(nodes_.key_size());
  nodes_.write_start(history.data());
  const std::vector<double> places = nodes_.positions(history.data());
  const Field start(surface_, places.data());
  patches_ = smooth_patches(surface_, start.vertices);
  for (std::size_t k = 0; k < patches_.size(); ++k)
    patch_of_.insert(patch_of_.end(), static_cast<std::size_t>(patches_[k].triangles()),
                     static_cast<int>(k));
  width_.assign(points_.size(), kRoundedEdge);
  if (self_) return;
  const Search& s = search(history.data());
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const Nearest n = nearest(start, found(s, p), p);
    if (n.triangle < 0) continue;
    const PatchFoot& f = n.foot;
    width_[static_cast<std::size_t>(p)] =
        clear_width(patches_[static_cast<std::size_t>(f.patch)], f.xi, f.eta, kOnEdge);
  }
}

const MeshPoint& SolidContact::corner(int point, int triangle, int k) const {
  if (k == 0) return points_[static_cast<std::size_t>(point)];
  const auto& t = surface_.triangles[static_cast<std::size_t>(triangle)];
  return surface_.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(k - 1)])];
}

void SolidContact::four_points(const Field& field, int point, int triangle, Vec3 (&x)[4]) const {
  x[0] = points_[static_cast<std::size_t>(point)].at(field.nodes);
  const auto& t = surface_.triangles[static_cast<std::size_t>(triangle)];
  for (std::size_t k = 0; k < 3; ++k) x[k + 1] = field.vertices[static_cast<std::size_t>(t[k])];
}

SolidContact::Nearest SolidContact::nearest_triangle(const Field& field,
                                                     std::span<const int> triangles,
                                                     int point) const {
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const int t : triangles) {
    Vec3 x[4];
    four_points(field, point, t, x);
    const NearestFour four = nearest_of_triangle(x);
    if (four.distance < best.distance) {
      best.triangle = t;
      best.four = four;
      best.distance = four.distance;
    }
  }
  return best;
}

void SolidContact::vertices_of(const SurfacePatch& patch, const std::vector<Vec3>& vertices,
                               Vec3 (&x)[SurfacePatch::kSize]) const {
  for (std::size_t a = 0; a < patch.vertex.size(); ++a)
    x[a] = patch.vertex[a] < 0 ? Vec3(Vec3::Zero())
                               : vertices[static_cast<std::size_t>(patch.vertex[a])];
}

SolidContact::Nearest SolidContact::nearest(const Field& field, std::span<const int> triangles,
                                            int point) const {
  if (of_cable()) return nearest_triangle(field, triangles, point);
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  const Vec3 p = points_[static_cast<std::size_t>(point)].at(field.nodes);
  int last = -1;
  for (const int t : triangles) {
    const int k = patch_of_[static_cast<std::size_t>(t)];
    if (k == last) continue;
    last = k;
    const SurfacePatch& patch = patches_[static_cast<std::size_t>(k)];
    Vec3 x[SurfacePatch::kSize];
    vertices_of(patch, field.vertices, x);
    if (least_distance(patch, p, x) > best.distance) continue;
    const PatchFoot foot = nearest_of_patch(patch, p, x, width_[static_cast<std::size_t>(point)]);
    if (best.triangle >= 0 && !is_nearer(foot, best.foot)) continue;
    best.triangle = foot.triangle;
    best.foot = foot;
    best.foot.patch = k;
    best.distance = foot.distance;
  }
  return best;
}

FourMoves SolidContact::moves(const Field& x_n1, const Field& u, int point, int triangle) const {
  FourMoves m;
  four_points(x_n1, point, triangle, m.x_n1);
  four_points(u, point, triangle, m.u);
  return m;
}

MeshGap SolidContact::gap(const Field& field, std::span<const int> triangles, int point,
                          const Nearest& nearest, const contact::NormalLaw& law) const {
  const double reach = centre_ + law.reach();
  if (nearest.distance >= reach) return MeshGap::of(nearest.triangle, nearest.four);
  std::vector<TriangleAt> near;
  for (const int t : triangles) {
    TriangleAt at;
    four_points(field, point, t, at.x);
    if (nearest_of_triangle(at.x).distance >= reach) continue;
    at.triangle = t;
    at.corners = surface_.triangles[static_cast<std::size_t>(t)];
    near.push_back(at);
  }
  return mesh_gap(near, law, centre_);
}

SolidContact::Action SolidContact::act(const NodeStep& step, const Field& x_n, const Field& x_n1,
                                       std::span<const int> triangles, int point,
                                       const PointMemory& memory) const {
  Action a;
  SurfaceLaw in_step = law_of(memory);
  const contact::NormalLaw law = in_step.normal;
  a.phase = memory.phase;
  const Nearest to = nearest(x_n1, triangles, point);
  const Nearest from = step.x_n == step.x_n1 ? to : nearest(x_n, triangles, point);
  const double reach = law.reach();
  a.gap_n = from.distance - centre_;
  a.gap_n1 = to.distance - centre_;
  if (a.gap_n >= reach && a.gap_n1 >= reach) return a;
  a.acts = true;
  if (step.context.conserving && step.context.dt > 0.0) {
    const bool open = a.phase.open() && a.gap_n >= reach;
    a.phase = a.phase.in_step(law_, a.gap_n, open ? rate_n(step, x_n, from, point) : 0.0,
                              with_band_lowered);
    in_step = a.phase.law(law_, with_band_lowered);
  }
  double resultant = 1.0;
  if (of_cable()) {
    a.at_n1 = gap(x_n1, triangles, point, to, law);
    a.at_n = step.x_n == step.x_n1 ? a.at_n1 : gap(x_n, triangles, point, from, law);
    resultant = a.gap_n < reach ? a.at_n.resultant : a.at_n1.resultant;
    a.gap_n = a.at_n.distance - centre_;
    a.gap_n1 = a.at_n1.distance - centre_;
  } else {
    a.foot_n1 = to.foot;
    a.foot_n = from.foot;
  }
  if (step.context.dt == 0.0)
    a.pressure = {law.force(a.gap_n1), 0.0};
  else
    a.pressure = contact::stop_force(law, {.at_n = a.gap_n,
                                           .at_n1 = a.gap_n1,
                                           .alpha_f = step.alpha_f,
                                           .conserving = step.context.conserving,
                                           .end_share = in_step.end_share});
  a.normal_force = {resultant * a.pressure.value, resultant * a.pressure.slope};
  return a;
}

/// @eq{mesh-contact} @eq{cable-on-mesh}
ElementReport SolidContact::evaluate(const NodeStep& step, const double* history,
                                     double* /*scratch*/, const Mat3& /*turn*/,
                                     const ElementSink& sink) const {
  const Search& s = search(history);
  if (s.triangle.empty()) return {};
  const Field x_n(surface_, step.x_n), x_n1(surface_, step.x_n1);
  const std::vector<double> still(
      step.x_n == step.x_n1 ? 3 * static_cast<std::size_t>(reach().back() + 1) : 0);
  const Field u(surface_, still.empty() ? step.u : still.data());
  const bool tangent = sink.tangent != nullptr;
  const auto add_force = [&](const MeshPoint& at, const Vec3& f) {
    for (int k = 0; k < at.count; ++k)
      for (int c = 0; c < 3; ++c) sink.force[3 * at.node[k] + c] += at.N[k] * f[c];
  };
  for (int p = 0; p < static_cast<int>(points_.size()); ++p) {
    const std::span<const int> triangles = found(s, p);
    if (triangles.empty()) continue;
    const Action a = act(step, x_n, x_n1, triangles, p, memory_of(history, p));
    if (!a.acts) continue;
    const double area = points_[static_cast<std::size_t>(p)].area;
    with_gap(step, x_n1, u, p, a, [&](const auto& gap, const auto& at) {
      const auto f = gap.force(a.pressure.value);
      for (int k = 0; k < gap.points(); ++k) add_force(at(k), area * f.template segment<3>(3 * k));
      if (tangent) {
        const auto K = gap.stiffness(a.pressure);
        for (int i = 0; i < gap.points(); ++i)
          for (int j = 0; j < gap.points(); ++j)
            nodes_.add(s.blocks, at(i), at(j), area * K.template block<3, 3>(3 * i, 3 * j),
                       sink.tangent);
      }
      if (!a.has_friction(law_) || step.context.dt == 0.0) return;
      const Slide slide = this->slide(step, x_n1, u, triangles, p, a.normal_force.value,
                                      memory_of(history, p), tangent);
      for (int k = 0; k < 4; ++k)
        add_force(corner(p, slide.triangle, k), area * slide.force.segment<3>(3 * k));
      if (!tangent) return;
      const auto by_x = (a.normal_force.slope * gap.slope()).eval();
      for (int i = 0; i < 4; ++i) {
        const MeshPoint& row = corner(p, slide.triangle, i);
        for (int j = 0; j < 4; ++j)
          nodes_.add(s.blocks, row, corner(p, slide.triangle, j),
                     area * slide.K.block<3, 3>(3 * i, 3 * j), sink.tangent);
        for (int j = 0; j < gap.points(); ++j)
          nodes_.add(s.blocks, row, at(j),
                     area * slide.by_pressure.segment<3>(3 * i) *
                         by_x.template segment<3>(3 * j).transpose(),
                     sink.tangent);
      }
    });
  }
  return {};
}

}  // namespace polhode::surface_contact
