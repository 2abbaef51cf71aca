// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/compile/build_slide.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// Distance of the point from the curve that is moved away at the start, as a part of an element:
/// the curve between nodes differs from an arc by less.
constexpr double kOnCurve = 1e-3;
/// Turn of the section at a node that counts as a corner [-].
constexpr double kCorner = 1e-9;

class SlideBuilder {
 public:
  SlideBuilder(System& system, const Model& model, const LoadSpec& load,
               std::span<const int> bodies)
      : system_(system),
        model_(model),
        load_(load),
        bodies_(bodies),
        where_(format("loads.{}", load.name)) {}

  void build() {
    const BeamSpec& beam = this->beam();
    refuse_corners(beam);
    refuse_impacts();
    SlideOnBeamSpec s;
    s.name = load_.name;
    s.beam = beam.name;
    s.tip = beam.length() / static_cast<double>(beam.mesh.size());
    for (const BeamSpec::Element& element : beam.mesh) s.lengths.push_back(element.length);
    for (int k = 0; k < beam.node_count(); ++k) s.nodes.push_back(section(beam, k, s.tip));
    const double shortest = *std::min_element(s.lengths.begin(), s.lengths.end());
    s.element_stiffness = beam.section.section.stiffness(0, 0) / shortest;
    s.node_mass = beam.mass() / static_cast<double>(beam.mesh.size());
    const auto value = [&](const char* key) {
      const auto found = load_.parameters.find(key);
      return found == load_.parameters.end() ? 0.0 : found->second;
    };
    s.stiffness = value("stiffness");
    s.free_position = value("free_position");
    s.damping = value("damping");
    if (load_.drive == "force") s.force = load_.value;
    if (load_.drive == "position") s.position = load_.value;
    place(beam, s);
    system_.add_elements(std::make_unique<SlideOnBeam>(std::move(s)));
  }

 private:
  [[nodiscard]] const BeamSpec& beam() const {
    const auto found =
        std::find_if(model_.beams.begin(), model_.beams.end(),
                     [&](const BeamSpec& beam) { return beam.first_node == load_.a; });
    if (found == model_.beams.end())
      throw InputError(where_ + ".beam", "names no beam", "Name an entry of 'beams'");
    return *found;
  }

  /// Impulses at an instant do not contain the beam's constraint.
  void refuse_impacts() const {
    const auto stops = [](const JointSpec& joint) {
      return joint.limits || joint.angle_limits || joint.type == "slack_link";
    };
    if (model_.contacts.present || !model_.events.empty() ||
        std::any_of(model_.joints.begin(), model_.joints.end(), stops))
      throw InputError(where_, "slides on a beam, in a model with contacts, stops or events",
                       "Leave these out: impacts and a point on a beam are not supported together");
  }

  [[nodiscard]] const BodySpec* spec(int body) const {
    return body == kGround ? nullptr : &model_.bodies.at(static_cast<std::size_t>(body));
  }

  void refuse_corners(const BeamSpec& beam) const {
    for (std::size_t k = 1; k < beam.mesh.size(); ++k) {
      const Quat turn = beam.mesh[k - 1].frame_2.conjugate() * beam.mesh[k].frame_1;
      if (turn.vec().norm() > kCorner)
        throw InputError(
            where_ + ".beam",
            format("'{}' has a corner at its node {}, which no point can pass", beam.name, k),
            "Give the beam an arc, or a straight line");
    }
  }

  int node(int body, const Vec3& Z) {
    const BodySpec* b = spec(body);
    NodeData data;
    data.position = b ? Vec3(b->position + b->orientation.normalized() * Z) : Z;
    data.body = body == kGround ? kGround : bodies_[static_cast<std::size_t>(body)];
    data.Z = data.body == kGround ? data.position : Z;
    if (b && data.body != kGround)
      data.velocity = b->velocity + b->angular_velocity.cross(b->orientation.normalized() * Z);
    return system_.add_node(data);
  }

  /// Nodes at the centre of a section and along its axes.
  std::array<int, 4> section(const BeamSpec& beam, int k, double tip) {
    const int body = beam.first_node + k;
    const Quat frame =
        k == 0 ? beam.mesh.front().frame_1 : beam.mesh[static_cast<std::size_t>(k - 1)].frame_2;
    const Mat3 Q = (spec(body)->orientation.conjugate() * frame).toRotationMatrix();
    return {node(body, Vec3::Zero()), node(body, tip * Q.col(0)), node(body, tip * Q.col(1)),
            node(body, tip * Q.col(2))};
  }

  /// Finds the place of the point on the beam at the start, and moves it onto the curve.
  void place(const BeamSpec& beam, SlideOnBeamSpec& s) {
    const BodySpec* body = spec(load_.b);
    const bool fixed = !body || body->fixed;
    if (body && body->node_of == beam.name)
      throw InputError(where_ + ".body", "is a node of the beam itself", "Name another body");
    if (body && body->point_mass && !fixed && !load_.Z_b.isZero(0.0))
      throw InputError(where_ + ".at", "is not at the centre of a point mass",
                       "Leave the point out, or give the body an inertia");
    const Quat q = body ? body->orientation.normalized() : Quat::Identity();
    const Vec3 at = body ? Vec3(body->position + q * load_.Z_b) : load_.Z_b;
    const std::vector<double> x = positions();
    SlideOnBeamSpec copy = s;
    const SlideOnBeam unplaced(std::move(copy));
    s.start = unplaced.nearest(x.data(), at);
    const Vec3 on = unplaced.place(x.data(), s.start, 0);
    const double off = (at - on).norm();
    if (!(off <= kOnCurve * s.tip))
      throw InputError(where_ + ".at",
                       format("is {:.4g} m from beam '{}', whose nearest point is [{:.6g}, {:.6g}, "
                              "{:.6g}] m",
                              off, beam.name, on.x(), on.y(), on.z()),
                       "Put the point there at the start");
    if (s.position) {
      const double given = (*s.position)(0.0);
      if (!(std::abs(given - s.start) <= kOnCurve * s.tip))
        throw InputError(where_ + ".position",
                         format("begins at {:.6g} m, but the point is at {:.6g} m along the beam",
                                given, s.start),
                         "Let it begin there, or move the body");
    }
    const bool turns = !body || fixed || !body->point_mass;
    s.point = node(load_.b, turns ? Vec3(load_.Z_b + q.conjugate() * (on - at)) : load_.Z_b);
  }

  /// Positions of all nodes so far [m].
  [[nodiscard]] std::vector<double> positions() const {
    std::vector<double> x;
    for (int i = 0; i < system_.nodes().count(); ++i)
      for (int c = 0; c < 3; ++c) x.push_back(system_.nodes()[i].position[c]);
    return x;
  }

  System& system_;
  const Model& model_;
  const LoadSpec& load_;
  std::span<const int> bodies_;
  std::string where_;
};

}  // namespace

void add_slide(System& system, const Model& model, const LoadSpec& load,
               std::span<const int> bodies) {
  SlideBuilder(system, model, load, bodies).build();
}

}  // namespace polhode
