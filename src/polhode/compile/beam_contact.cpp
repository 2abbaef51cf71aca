// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numbers>

#include <polhode/compile/beam_contact.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/dense.hpp>

namespace polhode {

namespace {

/// Relative rotation of frames below which a bar is straight [rad].
constexpr double kStraight = 1e-6;
/// Distance along the beam, in radii, within which parts of it are not paired: half a turn around a
/// bar of the same radius brings them together without contact.
constexpr double kNearAlongBeam = std::numbers::pi;

double radius_of(const BeamSpec& beam) {
  if (beam.contact->radius > 0.0) return beam.contact->radius;
  const double least = std::min(beam.section.height, beam.section.width);
  if (least > 0.0) return 0.5 * least;
  throw InputError("beams." + beam.name + ".contact", "needs a radius, as the section has no sizes",
                   "Give contact: {radius: ...}");
}

/// A round bar between two points of the centre line, in coordinates of the node.
ShapeSpec bar(const Vec3& from, const Vec3& to, const Vec3& along, double radius) {
  ShapeSpec shape;
  shape.type = "capsule";
  shape.sizes = {2.0 * radius, (to - from).norm() + 2.0 * radius};
  shape.position = 0.5 * (from + to);
  shape.orientation = rotation_between(Vec3::UnitZ(), along);
  return shape;
}

/// Arc lengths of the nodes from the start of the beam [m].
std::vector<double> arc_lengths(const BeamSpec& beam) {
  std::vector<double> s{0.0};
  for (const BeamSpec::Element& element : beam.mesh) s.push_back(s.back() + element.length);
  return s;
}

}  // namespace

void add_beam_shapes(Model& model, const BeamSpec& beam) {
  const double radius = radius_of(beam);
  const int last = beam.node_count() - 1;
  for (int k = 0; k <= last; ++k) {
    BodySpec& node = model.bodies[beam.first_node + k];
    node.contact = beam.contact->side;
    const Quat to_node = node.orientation.conjugate();
    const auto half = [&](int element, bool ahead) {  // from the node to the middle of the element
      const BeamSpec::Element& e = beam.mesh[static_cast<std::size_t>(element)];
      const Vec3 along = to_node * ((ahead ? e.frame_1 : e.frame_2) * Vec3::UnitX());
      return std::pair<Vec3, Vec3>(along, (ahead ? 0.5 : -0.5) * e.length * along);
    };
    if (k == 0 || k == last) {
      const auto [along, middle] = half(k == 0 ? 0 : last - 1, k == 0);
      const Vec3 end = middle * std::min(1.0, radius / middle.norm());
      node.shapes.push_back(bar(end, middle, along, radius));
      continue;
    }
    const auto [back, behind] = half(k - 1, false);
    const auto [forth, before] = half(k, true);
    if (back.cross(forth).norm() < kStraight && back.dot(forth) > 0.0) {
      node.shapes.push_back(bar(behind, before, forth, radius));
    } else {
      node.shapes.push_back(bar(behind, Vec3::Zero(), back, radius));
      node.shapes.push_back(bar(Vec3::Zero(), before, forth, radius));
    }
  }
}

std::vector<std::pair<int, int>> beam_neighbours(const Model& model) {
  std::vector<std::pair<int, int>> pairs;
  for (const BeamSpec& beam : model.beams) {
    if (!beam.contact) continue;
    const std::vector<double> s = arc_lengths(beam);
    const auto half = [&](std::size_t element) { return 0.5 * beam.mesh[element].length; };
    const double near = kNearAlongBeam * radius_of(beam);
    const std::size_t count = s.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i + 1; j < count; ++j) {
        const double between = s[j] - half(j - 1) - (s[i] + half(i));
        if (j > i + 1 && between > near) break;
        pairs.emplace_back(beam.first_node + static_cast<int>(i),
                           beam.first_node + static_cast<int>(j));
      }
    for (const BeamBondSpec& bond : beam.bonds) {
      if (bond.body == kGround) continue;
      for (std::size_t i = 0; i < count; ++i) {
        const double away = bond.at_end ? s.back() - s[i] - (i + 1 < count ? half(i) : 0.0)
                                        : s[i] - (i > 0 ? half(i - 1) : 0.0);
        if (away <= near) pairs.emplace_back(bond.body, beam.first_node + static_cast<int>(i));
      }
    }
  }
  return pairs;
}

}  // namespace polhode
