// SPDX-License-Identifier: Apache-2.0
// Fingerprint of a model without positions in files and pictures; all other fields in the order of
// the specs.
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <type_traits>
#include <vector>

#include <polhode/core/sha256.hpp>
#include <polhode/io/results/model_fingerprint.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::io {

namespace {

/// Number of sample times of functions: 0, and from 0.1 ms to some three hours.
constexpr int kTimes = 240;
constexpr double kFirstTime = 1e-4, kGrowth = 1.08;

/// Hash of values, each list with its length, so that the sequence is unambiguous.
class Fingerprint {
 public:
  template <class... Values>
  void add(const Values&... values) {
    (one(values), ...);
  }
  /// Adds the bound fields of a spec, in the order of its table, without those with which a run may
  /// be continued.
  template <class Spec>
  void add_fields(const Spec& spec, const FieldTable& table) {
    for (const Field* field : fields_of<Spec>(table))
      if (!field->may_change)
        field->member.visit(spec, [this](const auto& value) { this->one(value); });
  }
  std::string hex() { return hash_.hex(); }

 private:
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void one(T value) {
    const auto number = static_cast<double>(value);
    hash_.update(&number, sizeof number);
  }
  void one(const std::string& text) {
    one(text.size());
    hash_.update(text);
  }
  template <class Derived>
  void one(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      for (Eigen::Index i = 0; i < values.rows(); ++i) one(values(i, j));
  }
  void one(const Quat& q) { one(q.coeffs()); }
  template <class T>
  void one(const std::optional<T>& value) {
    one(value.has_value());
    if (value) one(*value);
  }
  template <class T>
  void one(const std::vector<T>& list) {
    one(list.size());
    for (const T& value : list) one(value);
  }
  template <class T, std::size_t n>
  void one(const std::array<T, n>& list) {
    for (const T& value : list) one(value);
  }
  template <class T>
  void one(const std::map<std::string, T>& map) {
    one(map.size());
    for (const auto& [key, value] : map) add(key, value);
  }
  void one(const TimeFunctionPtr& f) {
    one(f != nullptr);
    if (!f) return;
    // The value of a controller's output is part of the state, not of the model.
    if (f->controller() >= 0) return one(f->controller());
    one((*f)(0.0));
    double t = kFirstTime;
    for (int k = 0; k < kTimes; ++k, t *= kGrowth) one((*f)(t));
  }
  /// Adds the contents of a file, independent of its path. A file removed since the model was read
  /// is no error.
  void contents(const std::string& file) {
    if (file.empty()) return;
    try {
      one(read_file(file));
    } catch (const FileError&) {
      one(file);
    }
  }

  void one(const ContactSideSpec& s) { add_fields(s, contact_side_fields()); }
  void one(const ShapeSpec& s) {
    add(s.type, s.sizes, s.scale, s.points, s.heights, s.columns, s.spacing, s.position,
        s.orientation, s.contact);
    contents(s.file);
  }
  void one(const BodySpec& b) {
    add(b.name, b.fixed, b.point_mass, b.mass, b.inertia, b.position, b.orientation, b.com,
        b.velocity, b.angular_velocity, b.contact);
  }
  // By hand: each kind of joint has a table of its own.
  void one(const JointFrictionSpec& f) {
    add(f.mu, f.radius, f.face_radius, f.length, f.constant, f.stiffness, f.damping);
  }
  void one(const JointLimitsSpec& l) { add_fields(l, angle_limit_fields()); }
  void one(const FrameMotion& m) {
    add(m.displacement, static_cast<int>(m.rotation), m.parameters, m.sequence);
  }
  void one(const JointSpec& j) {
    add(j.name, j.type, j.a, j.b, j.Z_a, j.Z_b, j.R_a, j.R_b, j.free, j.parameters, j.friction,
        j.limits, j.angle_limits, j.motion);
    // Absent entries leave the fingerprints of older models unchanged.
    if (j.breaks.force || j.breaks.moment) add_fields(j.breaks, strength_fields());
    if (j.enforcement) add_fields(*j.enforcement, enforcement_fields());
  }
  void one(const ChannelSpec& c) {
    const ProbeSpec& of = c.of;
    add(of.kind, of.target, c.name, of.point);
    // Absent entries leave the fingerprints of older models unchanged.
    if (of.kind != "body" && of.kind != "joint" && of.kind != "load")
      add(of.pair, of.node, of.element, of.reaction_of, of.stress);
    if (of.axes != "world") add(of.axes);
    if (!of.rotation.empty() || of.seen_from != kGround || !of.helical.empty())
      add(of.rotation, of.helical, of.seen_from);
  }
  void one(const ConditionSpec& c) { add(c.channel, c.level, c.above); }
  void one(const EventSpec& e) {
    add(e.name, e.at, e.when, e.after, e.on, e.off, e.repeat, e.stop);
  }
  void one(const ControllerSpec& c) {
    add(c.name, c.channel, c.setpoint);
    add_fields(c, controller_fields());
  }
  void one(const solids::Selection& s) {
    add(s.kind, s.set, s.normal, s.level, s.value, s.least, s.most, s.centre, s.radius,
        s.on_surface, s.tolerance, s.nodes);
  }
  void one(const PartAxes& p) { add(p.origin, p.axes, p.body_axes, p.sense); }
  void one(const CoordinateSpec& c) { add(c.joint, c.coordinate, c.factor); }
  void one(const LoadSpec& l) {
    add(l.name, l.type, l.a, l.b, l.joint, l.coordinate, l.drive, l.Z_a, l.Z_b, l.body_fixed,
        l.vector, l.value, l.solid, l.selection, l.follower, l.keeps, l.parameters, l.laws, l.words,
        l.matrices, l.joint_2, l.coordinate_2, l.R_a, l.R_b);
    if (!l.others.empty()) add(l.others);
    if (l.has_end_on_solid()) add(l.end_solids[0], l.end_solids[1]);
    // Functions in code are represented by their presence only.
    if (l.of_motion.index() != 0) add(static_cast<int>(l.of_motion.index()), l.part_axes);
  }
  // By hand: not in the order of the table.
  void one(const ViscositySpec& v) { add(v.relaxation_time, v.lame, v.shear); }
  void one(const RelaxationSpec& r) { add_fields(r, relaxation_fields()); }
  void one(const FibreSpec& f) { add(f.law, f.parameters, f.direction); }
  void one(const MaterialSpec& m) {
    add(m.name, m.type, m.parameters, m.density, m.viscosity, m.fibres);
    // Absent entries leave the fingerprints of older models unchanged.
    if (!m.relaxation.empty()) add(m.relaxation, m.long_term_ratio);
  }
  void one(const MeshSpec& m) {
    add(m.type, m.group, m.scale, m.parameters, m.nodes, m.elements, m.sets, m.position,
        m.orientation);
    contents(m.file);
  }
  void one(const BondSpec& b) { add(b.body, b.nodes); }
  void one(const PrescribedSpec& p) { add(p.name, p.nodes, p.displacement); }
  void one(const RegionSpec& r) {
    add(r.name, r.material, r.element, r.density, r.within, r.elements);
  }
  void one(const SolidSpec& s) {
    add(s.name, s.mesh, s.element, s.material, s.stress, s.density, s.bonded, s.prescribed,
        s.contact, s.contact_surface, s.self_contact, s.velocity, s.angular_velocity);
    // Absent entries leave the fingerprints of older models unchanged.
    if (!s.regions.empty()) add(s.regions);
    if (!s.fibre_directions.empty()) add(s.fibre_directions);
  }
  void one(const SectionSpec& s) {
    add(s.section.stiffness, s.section.mass_per_length, s.section.inertia_per_length,
        s.relaxation_time);
  }
  void one(const BeamBondSpec& b) { add(b.body, b.at_end); }
  void one(const BeamContactSpec& c) {
    add_fields(c, beam_contact_fields());
    add(c.side);
  }
  void one(const BeamSpec::Element& e) { add(e.length, e.frame_1, e.frame_2); }
  void one(const BeamSpec& b) {
    add(b.name, b.points, b.arc, b.elements, b.section, b.up, b.residual_bending_flexibility,
        b.consistent_mass, b.velocity, b.angular_velocity, b.bonds, b.contact, b.first_node,
        b.mesh);
  }
  void one(const AttachmentSpec& a) { add(a.body, a.Z); }
  void one(const CableContactSpec& c) {
    add_fields(c, cable_contact_fields());
    add(c.side);
  }
  void one(const CableLineSpec::Piece& p) { add(p.a, p.b, p.free_length, p.mass); }
  void one(const HillMuscle& m) { add_fields(m, muscle_fields()); }
  void one(const ObstacleSpec& o) { add(o.name, o.at, o.axes, o.semi_axes, o.side, o.after); }
  void one(const CableLineSpec& c) {
    add(c.name, c.through, c.stiffness);
    add_fields(c, cable_fields());
    add(c.contact, c.pieces);
    if (c.slides) add(c.tension, c.muscle);
    if (c.friction > 0.0) add(c.friction, c.wraps);
    if (!c.around.empty()) add(c.around);
  }
  void one(const ContactLawSpec& l) { add_fields(l, contact_law_fields()); }
  void one(const ContactMaterialSpec& m) {
    add(m.name);
    add_fields(m, contact_material_fields());
  }
  /// One number, as in fingerprints of older models: solids and cables are below the ground.
  void one(const Side& side) {
    constexpr int kCables = 1 << 24;
    if (side.is_body()) return one(side.index);
    one(kGround - 1 - side.index - (side.is_cable() ? kCables : 0));
  }
  void one(const ContactPairSpec& p) {
    add(p.name, p.of_materials);
    if (p.of_materials)
      add(p.materials);
    else
      add(p.a, p.b);
    add(p.sensor, p.law);
  }
  void one(const ContactsSpec& c) {
    add(c.present, c.standard, c.materials);
    add_fields(c, contact_combination_fields());
    add(c.pairs, c.excluded);
    add_fields(c, contacts_fields());
  }

  Sha256 hash_;
};

}  // namespace

std::string model_fingerprint(const Model& model) {
  Fingerprint f;
  f.add(model.gravity, model.bodies, model.joints, model.loads, model.materials, model.solids,
        model.beams, model.cables, model.contacts);
  // Shapes do not affect the mass here, only contact.
  if (model.contacts.present)
    for (const BodySpec& body : model.bodies) f.add(body.shapes);
  if (!model.events.empty()) f.add(model.events);
  if (!model.controllers.empty()) f.add(model.controllers);
  f.add_fields(model.analysis, analysis_fields());
  return f.hex();
}

}  // namespace polhode::io
