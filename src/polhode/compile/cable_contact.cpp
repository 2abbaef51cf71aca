// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/compile/cable_contact.hpp>

namespace polhode {

namespace {

/// Distance from an attachment along the cable, in radii, within which there is no contact with the
/// attached body.
constexpr double kNear = std::numbers::pi;
/// Part of a spacing that is rounding.
constexpr double kRoundedPart = 1e-9;
/// Largest distance of points in units of the requested spacing: below four nothing passes between
/// them, as every position is then nearer to one of them than the distance they maintain.
constexpr double kMaxStretch = 3.2;

}  // namespace

CableLine add_cable_line(System& system, const Model& model, const CableLineSpec& cable,
                         const std::vector<int>& bodies) {
  CableLine line;
  line.radius = cable.contact->radius;
  const auto add = [&](const AttachmentSpec& at, double arc) {
    NodeData node;
    node.body = kGround;
    node.position = at.Z;
    if (at.body != kGround) {
      const BodySpec& body = model.bodies[static_cast<std::size_t>(at.body)];
      const Vec3 arm = body.orientation.normalized() * at.Z;
      node.body = bodies[static_cast<std::size_t>(at.body)];
      node.Z = at.Z;
      node.position = body.position + arm;
      node.velocity = body.velocity + body.angular_velocity.cross(arm);
    }
    line.nodes.push_back(system.add_node(node));
    line.arc.push_back(arc);
  };
  add(cable.pieces.front().a, 0.0);
  for (const CableLineSpec::Piece& piece : cable.pieces)
    add(piece.b, line.arc.back() + piece.free_length);
  return line;
}

CablePoints cable_points(const CableLine& line, double spacing) {
  CablePoints all;
  all.points.nodes_per_point = 2;
  all.points.radius = line.radius;
  all.points.most_apart = kMaxStretch * spacing;
  const auto add = [&](std::size_t piece, double part, double span, double length) {
    surface_contact::SurfacePoints::Point p;
    p.area = 2.0 * line.radius * length;
    p.N[0] = 1.0 - part;
    p.N[1] = part;
    p.span = span;
    all.points.points.push_back(p);
    all.points.nodes.insert(all.points.nodes.end(), {line.nodes[piece], line.nodes[piece + 1]});
    all.arc.push_back((1.0 - part) * line.arc[piece] + part * line.arc[piece + 1]);
  };
  double before = 0.0;  // half of the distance to the previous point
  for (std::size_t k = 0; k + 1 < line.nodes.size(); ++k) {
    const double length = line.arc[k + 1] - line.arc[k];
    const int parts = std::max(1, static_cast<int>(std::ceil(length / spacing - kRoundedPart)));
    const double half = 0.5 * length / parts;
    for (int i = 0; i < parts; ++i)
      add(k, static_cast<double>(i) / parts, 1.0 / parts, i == 0 ? before + half : 2.0 * half);
    before = half;
  }
  add(line.nodes.size() - 2, 1.0, 0.0, before);
  return all;
}

std::vector<surface_contact::MeshPoint> mesh_points(const surface_contact::SurfacePoints& points) {
  std::vector<surface_contact::MeshPoint> list;
  for (std::size_t k = 0; k < points.points.size(); ++k) {
    surface_contact::MeshPoint& p = list.emplace_back();
    for (std::size_t a = 0; a < 2; ++a) p.add(points.nodes[2 * k + a], points.points[k].N[a]);
    p.area = points.points[k].area;
  }
  return list;
}

surface_contact::RoundLine round_line(const surface_contact::SurfacePoints& points) {
  surface_contact::RoundLine line;
  line.radius = points.radius;
  line.most_apart = points.most_apart;
  for (std::size_t k = 0; k < points.points.size(); ++k)
    line.spans.push_back({points.nodes[2 * k], points.nodes[2 * k + 1], points.points[k].span});
  return line;
}

bool is_fastened_to(const Model& model, const AttachmentSpec& at, int body) {
  if (at.body == body) return true;
  for (const BeamSpec& beam : model.beams) {
    const auto holds = [&](int b) {
      return b >= beam.first_node && b < beam.first_node + beam.node_count();
    };
    if (holds(at.body) && holds(body)) return true;
  }
  return false;
}

void leave_out_attachments(CablePoints& points, const CableLineSpec& cable, const CableLine& line,
                           const std::function<bool(const AttachmentSpec&)>& hangs_on,
                           const std::function<bool(int)>& inside) {
  const int count = static_cast<int>(points.arc.size());
  const double near = kNear * line.radius;
  std::vector<bool> out(points.arc.size(), false);
  const std::size_t per_point = (line.nodes.size() - 1) / (cable.through.size() - 1);
  for (std::size_t k = 0; k < cable.through.size(); ++k) {
    if (!hangs_on(cable.through[k])) continue;
    const double arc = line.arc[k * per_point];
    const auto at = static_cast<int>(std::lower_bound(points.arc.begin(), points.arc.end(), arc) -
                                     points.arc.begin());
    const auto walk = [&](int first, int step) {
      for (int i = first; i >= 0 && i < count; i += step) {
        if (std::abs(points.arc[static_cast<std::size_t>(i)] - arc) > near && !inside(i)) return;
        out[static_cast<std::size_t>(i)] = true;
      }
    };
    walk(at, 1);
    walk(at - 1, -1);
  }
  surface_contact::SurfacePoints& all = points.points;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.arc.size(); ++i) {
    if (out[i]) continue;
    all.points[kept] = all.points[i];
    all.nodes[2 * kept] = all.nodes[2 * i];
    all.nodes[2 * kept + 1] = all.nodes[2 * i + 1];
    points.arc[kept++] = points.arc[i];
  }
  all.points.resize(kept);
  all.nodes.resize(2 * kept);
  points.arc.resize(kept);
}

}  // namespace polhode
