// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <polhode/beams/beam_element.hpp>
#include <polhode/compile/beam_contact.hpp>
#include <polhode/compile/beam_mesh.hpp>
#include <polhode/compile/cable_obstacles.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode {

namespace {

/// Smallest distance of points of a polyline, as a part of its length.
constexpr double kApart = 1e-9;

/// Numbers of elements of the segments: in proportion to the lengths, at least one each.
std::vector<int> shared_out(int elements, const std::vector<double>& lengths) {
  const double whole = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  std::vector<int> counts;
  int left = elements;
  double length_left = whole;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const int others = static_cast<int>(lengths.size() - i) - 1;
    const int share = static_cast<int>(std::lround(left * lengths[i] / length_left));
    counts.push_back(std::clamp(share, 1, left - others));
    left -= counts.back();
    length_left -= lengths[i];
  }
  return counts;
}

/// Frame with x along t and y as near as possible to `up`.
Mat3 section_frame(const Vec3& t, const Vec3& up) {
  Mat3 D;
  D.col(0) = t;
  D.col(1) = (up - up.dot(t) * t).normalized();
  D.col(2) = D.col(0).cross(D.col(1));
  return D;
}

class BeamMesher {
 public:
  BeamMesher(const BeamSpec& beam) : beam_(beam), where_("beams." + beam.name) {
    if (beam.elements < 1)
      throw InputError(where_ + ".elements", "is below 1", "Give it at least one element");
    if (beam.arc)
      mesh_arc();
    else
      mesh_polyline();
  }
  std::vector<Vec3> nodes;
  std::vector<BeamSpec::Element> elements;

 private:
  [[nodiscard]] Vec3 up_for(const Vec3& t) const {
    if (!beam_.up) return std::abs(t.z()) < 0.99 ? Vec3::UnitZ() : Vec3::UnitX();
    if (beam_.up->normalized().cross(t).norm() < 1e-6)
      throw InputError(where_ + ".up", "is parallel to the beam",
                       "Give a direction transverse to the beam");
    return beam_.up->normalized();
  }

  void mesh_polyline() {
    const std::vector<Vec3>& p = beam_.points;
    if (p.size() < 2)
      throw InputError(where_ + ".points", "needs two points or more", "Give [start, ..., end]");
    std::vector<double> lengths;
    for (std::size_t i = 1; i < p.size(); ++i) lengths.push_back((p[i] - p[i - 1]).norm());
    const double whole = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    for (std::size_t i = 0; i < lengths.size(); ++i)
      if (!(lengths[i] > kApart * whole))
        throw InputError(where_ + ".points", format("points {} and {} coincide", i + 1, i + 2),
                         "Give distinct points");
    if (beam_.elements < static_cast<int>(lengths.size()))
      throw InputError(
          where_ + ".elements",
          format("is {}, but the polyline has {} pieces", beam_.elements, lengths.size()),
          "Give at least one element to each piece");
    const std::vector<int> counts = shared_out(beam_.elements, lengths);
    nodes.push_back(p[0]);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Vec3 t = (p[i + 1] - p[i]) / lengths[i];
      const Quat frame(section_frame(t, up_for(t)));
      for (int k = 1; k <= counts[i]; ++k) {
        nodes.push_back(p[i] + (p[i + 1] - p[i]) * k / counts[i]);
        elements.push_back({lengths[i] / counts[i], frame, frame});
      }
    }
  }

  /// Meshes an arc; the section keeps its angle to the plane of the circle.
  void mesh_arc() {
    const std::vector<Vec3>& p = beam_.points;
    if (p.size() != 3)
      throw InputError(where_ + ".arc", "needs three points", "Give [start, on the arc, end]");
    const Vec3 a = p[1] - p[0], b = p[2] - p[0], normal = a.cross(b);
    if (!(normal.norm() > 1e-9 * a.norm() * b.norm()))
      throw InputError(where_ + ".arc", "has its three points on one line",
                       "Use points: [start, end] for a straight beam");
    const Vec3 n = normal.normalized();
    // From the centre to the start.
    const Vec3 arm = (b.squaredNorm() * a.cross(normal) - a.squaredNorm() * b.cross(normal)) /
                     (2.0 * normal.squaredNorm());
    const Vec3 centre = p[0] - arm, e_1 = arm.normalized(), e_2 = n.cross(e_1);
    const double radius = arm.norm();
    double angle = std::atan2((p[2] - centre).dot(e_2), (p[2] - centre).dot(e_1));
    if (angle < 0.0) angle += 2.0 * std::numbers::pi;
    const Mat3 first = section_frame(e_2, up_for(e_2));
    const double per_element = angle / beam_.elements;
    if (per_element > kLargestBeamAngle)
      throw InputError(where_ + ".elements",
                       format("is {}: one element turns by {:.3g} rad, more than {:g}",
                              beam_.elements, per_element, kLargestBeamAngle),
                       "Use more elements");
    for (int k = 0; k <= beam_.elements; ++k) {
      const Mat3 turn = exp_map(k * per_element * n);
      nodes.push_back(k == beam_.elements ? p[2] : Vec3(centre + turn * arm));
      if (k > 0)
        elements.push_back({radius * per_element, Quat(exp_map((k - 1) * per_element * n) * first),
                            Quat(turn * first)});
    }
    nodes[0] = p[0];
  }

  const BeamSpec& beam_;
  std::string where_;
};

/// Adds half of an element's mass and rotary inertia to a node.
void add_half(BodySpec& node, const BeamSection& section, double length, const Quat& frame) {
  const Mat3 Q = (node.orientation.conjugate() * frame).toRotationMatrix();
  node.mass += 0.5 * length * section.mass_per_length;
  node.inertia += 0.5 * length * Q * section.inertia_per_length.asDiagonal() * Q.transpose();
}

JointSpec bond(const std::string& name, const SourceLocation& place, const std::string& type,
               const Model& model, int body, int node) {
  JointSpec joint;
  joint.name = name;
  joint.type = type;
  joint.place = place;
  joint.a = body;
  joint.b = node;
  const BodySpec& b = model.bodies[static_cast<std::size_t>(node)];
  joint.R_b = b.orientation.conjugate().toRotationMatrix();
  joint.Z_a = b.position;
  if (body == kGround) return joint;
  const BodySpec& a = model.bodies[static_cast<std::size_t>(body)];
  joint.Z_a = a.orientation.conjugate() * (b.position - a.position);
  joint.R_a = a.orientation.conjugate().toRotationMatrix();
  return joint;
}

}  // namespace

int add_beam(Model& model, BeamSpec beam) {
  const std::string where = "beams." + beam.name;
  const BeamSection& section = beam.section.section;
  if (!(section.mass_per_length > 0.0) || !(section.inertia_per_length.minCoeff() > 0.0))
    throw InputError(where + ".section", "has no mass or no rotary inertia",
                     "Give its material a density, or the section its mass and inertia per length");
  if (!(beam.consistent_mass >= 0.0 && beam.consistent_mass <= 1.0))
    throw InputError(where + ".consistent_mass", format("is {:g}", beam.consistent_mass),
                     "Give a value from 0 (lumped) to 1 (consistent)");
  BeamMesher mesher(beam);
  beam.mesh = mesher.elements;
  beam.first_node = static_cast<int>(model.bodies.size());
  const std::size_t count = mesher.nodes.size();
  for (std::size_t k = 0; k < count; ++k) {
    BodySpec node;
    node.name = format("{}.{}", beam.name, k);
    node.node_of = beam.name;
    node.place = beam.place;
    node.position = mesher.nodes[k];
    node.orientation = k == 0 ? beam.mesh[0].frame_1 : beam.mesh[k - 1].frame_2;
    node.angular_velocity = beam.angular_velocity;
    node.velocity = beam.velocity + beam.angular_velocity.cross(mesher.nodes[k] - mesher.nodes[0]);
    if (k > 0) add_half(node, section, beam.mesh[k - 1].length, beam.mesh[k - 1].frame_2);
    if (k + 1 < count) add_half(node, section, beam.mesh[k].length, beam.mesh[k].frame_1);
    model.bodies.push_back(std::move(node));
  }
  if (beam.contact) add_beam_shapes(model, beam);
  for (const BeamBondSpec& b : beam.bonds)
    model.joints.push_back(
        bond(format("{}.{}", beam.name, b.at_end ? "end" : "start"), beam.place, "fixed", model,
             b.body, b.at_end ? beam.first_node + static_cast<int>(count) - 1 : beam.first_node));
  model.beams.push_back(std::move(beam));
  return static_cast<int>(model.beams.size()) - 1;
}

int add_cable(Model& model, CableLineSpec cable) {
  const std::string where = "cables." + cable.name;
  if (cable.through.size() < 2)
    throw InputError(where + ".through", "needs two points or more", "Give [[body, point], ...]");
  if (!(cable.mass_per_length >= 0.0))
    throw InputError(where + ".mass_per_length", format("is {:g}", cable.mass_per_length),
                     "Give a mass that is not negative");
  if (cable.elements < 1)
    throw InputError(where + ".elements", "is below 1", "Give it at least one element");
  const auto position = [&](const AttachmentSpec& a) -> Vec3 {
    if (a.body == kGround) return a.Z;
    const BodySpec& body = model.bodies.at(static_cast<std::size_t>(a.body));
    return body.position + body.orientation * a.Z;
  };
  const auto velocity = [&](const AttachmentSpec& a) -> Vec3 {
    if (a.body == kGround) return Vec3::Zero();
    const BodySpec& body = model.bodies.at(static_cast<std::size_t>(a.body));
    return body.velocity + body.angular_velocity.cross(body.orientation * a.Z);
  };
  if (cable.slides && (cable.mass_per_length > 0.0 || cable.contact))
    throw InputError(
        where + ".slides",
        format("cannot be combined with {}", cable.contact ? "contact" : "mass_per_length"),
        "A sliding cable has neither mass nor contact: leave one of them out");
  const std::vector<StartSpan> spans = start_spans(model, cable);
  std::vector<double> lengths;
  for (std::size_t i = 1; i < cable.through.size(); ++i) {
    lengths.push_back(spans[i - 1].length());
    const AttachmentSpec &a = cable.through[i - 1], &b = cable.through[i];
    if (!(lengths.back() > 0.0) && !cable.free_length)
      throw InputError(where + ".through", format("points {} and {} coincide", i, i + 1),
                       "Give distinct points, or a free_length");
    if (cable.mass_per_length == 0.0 && a.body == b.body && !cable.slides)
      throw InputError(where + ".through",
                       format("points {} and {} are on the same body", i, i + 1),
                       "Leave one out: their distance is constant");
  }
  const double whole = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  const double stretch = cable.free_length ? *cable.free_length / whole : 1.0;
  if (cable.free_length && !(*cable.free_length > 0.0 && std::isfinite(stretch)))
    throw InputError(where + ".free_length", "is not above zero, or all points coincide",
                     "Give a free length above zero and distinct points");

  if (cable.mass_per_length == 0.0) {
    for (const StartSpan& span : spans)
      for (std::size_t i = 0; i < span.lengths.size(); ++i)
        cable.pieces.push_back(
            {span.points[i], span.points[i + 1], stretch * span.lengths[i], 0.0});
  } else {
    const int first = static_cast<int>(model.bodies.size());
    const auto node = [&](const Vec3& at, const Vec3& v) {
      BodySpec n;
      n.name = format("{}.{}", cable.name, static_cast<int>(model.bodies.size()) - first);
      n.node_of = cable.name;
      n.place = cable.place;
      n.point_mass = true;
      n.position = at;
      n.velocity = v;
      model.bodies.push_back(std::move(n));
      return static_cast<int>(model.bodies.size()) - 1;
    };
    const auto hung_up = [&](const AttachmentSpec& at) {
      const int n = node(position(at), velocity(at));
      JointSpec joint = bond(model.bodies.back().name, cable.place, "spherical", model, at.body, n);
      joint.Z_a = at.Z;
      model.joints.push_back(std::move(joint));
      return n;
    };
    int last = hung_up(cable.through[0]);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Vec3 from = position(cable.through[i]), to = position(cable.through[i + 1]);
      const Vec3 v_0 = velocity(cable.through[i]), v_1 = velocity(cable.through[i + 1]);
      for (int k = 1; k <= cable.elements; ++k) {
        const double part = static_cast<double>(k) / cable.elements;
        const int next = k == cable.elements
                             ? hung_up(cable.through[i + 1])
                             : node(from + part * (to - from), v_0 + part * (v_1 - v_0));
        const double free = stretch * lengths[i] / cable.elements;
        const double mass = cable.mass_per_length * free;
        model.bodies[static_cast<std::size_t>(last)].mass += 0.5 * mass;
        model.bodies[static_cast<std::size_t>(next)].mass += 0.5 * mass;
        cable.pieces.push_back({{last, Vec3::Zero()}, {next, Vec3::Zero()}, free, mass});
        last = next;
      }
    }
  }
  model.cables.push_back(std::move(cable));
  return static_cast<int>(model.cables.size()) - 1;
}

double BeamSpec::length() const {
  double sum = 0.0;
  for (const Element& element : mesh) sum += element.length;
  return sum;
}

double CableLineSpec::length() const {
  double sum = 0.0;
  for (const Piece& piece : pieces) sum += piece.free_length;
  return sum;
}

double CableLineSpec::mass() const {
  double sum = 0.0;
  for (const Piece& piece : pieces) sum += piece.mass;
  return sum;
}

std::vector<bool> are_nodes(const Model& model) {
  std::vector<bool> nodes(model.bodies.size(), false);
  for (const BeamSpec& beam : model.beams)
    for (int k = 0; k < beam.node_count(); ++k) nodes.at(beam.first_node + k) = true;
  for (const CableLineSpec& cable : model.cables)
    for (const CableLineSpec::Piece& piece : cable.pieces)
      if (piece.mass > 0.0)  // otherwise its ends are other bodies
        for (const int body : {piece.a.body, piece.b.body})
          nodes.at(static_cast<std::size_t>(body)) = true;
  return nodes;
}

}  // namespace polhode
