// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <polhode/beams/beam_element.hpp>
#include <polhode/beams/cable.hpp>
#include <polhode/beams/running_cable.hpp>
#include <polhode/compile/beam_mesh.hpp>
#include <polhode/compile/build_load_on_nodes.hpp>
#include <polhode/compile/build_slide.hpp>
#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/compile/build_system.hpp>
#include <polhode/compile/cable_obstacles.hpp>
#include <polhode/compile/centrifugal_forces.hpp>
#include <polhode/compile/describe_load.hpp>
#include <polhode/compile/inerter_mass.hpp>
#include <polhode/compile/joint_resistance.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/gear.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/loads/rotor.hpp>
#include <polhode/loads/slide_on_beam_kind.hpp>
#include <polhode/model/gear_geometry.hpp>
#include <polhode/model/switched_contacts.hpp>
#include <polhode/model/velocity_jumps.hpp>

namespace polhode {

namespace {

class Builder {
 public:
  explicit Builder(const Model& model) : model_(model) {}

  System build(SystemMap* map) {
    system_.set_gravity(model_.gravity);
    system_.set_fused(model_.analysis.isa != "baseline");
    const double reach = dummy_reach();
    for (const BodySpec& body : model_.bodies) add_body(body, reach);
    for (const JointSpec& joint : model_.joints) add_joint(joint);
    for (std::size_t i = 0; i < model_.solids.size(); ++i)
      map_.solids.push_back(add_solid(system_, model_, static_cast<int>(i), map_.body));
    for (const LoadSpec& load : model_.loads) add_load(load);
    for (const BeamSpec& beam : model_.beams) add_beam(beam);
    for (const CableLineSpec& cable : model_.cables) add_cable(cable);
    for (const LoadSpec& load : model_.loads)
      if (is_on_beam(load)) add_slide(system_, model_, load, map_.body);
    map_.contacts = build_contacts(model_, map_.body, map_.contact);
    add_surface_contacts(system_, model_, map_.body, map_.solids, map_.contact);
    system_.set_contacts(map_.contacts);
    if (model_.analysis.turning) add_centrifugal_forces(system_, model_);
    add_switching();
    system_.finish();
    if (map) fill(*map);
    return std::move(system_);
  }

 private:
  /// Radius of gyration for point masses: of the size of the other bodies, so that length scales
  /// are not distorted; it has no effect on the motion.
  [[nodiscard]] double dummy_reach() const {
    double sum = 0.0, farthest = 0.0;
    int count = 0;
    for (const BodySpec& body : model_.bodies) {
      farthest = std::max(farthest, body.position.norm());
      if (body.point_mass || body.fixed || body.mass <= 0.0) continue;
      sum += std::sqrt(0.5 * body.inertia.trace() / body.mass);
      ++count;
    }
    return count > 0 ? sum / count : farthest > 0.0 ? farthest : 1.0;
  }

  void add_body(const BodySpec& body, double reach) {
    if (body.fixed) {
      map_.body.push_back(kGround);
      return;
    }
    BodyMotion start;
    start.r = body.position;
    start.q = body.orientation.normalized();
    start.v = body.velocity;
    BodyData data{.name = body.name, .mass = body.mass, .inertia = body.inertia};
    data.point_mass = body.point_mass;
    if (body.point_mass)
      data.inertia = body.mass * reach * reach * Mat3::Identity();
    else
      start.W = start.q.conjugate() * body.angular_velocity;
    data.inertia += rotor_inertia(model_, static_cast<int>(map_.body.size()), true);
    map_.body.push_back(system_.add_body(std::move(data), start));
  }

  [[nodiscard]] const BodySpec* spec(int body) const {
    return body == kGround ? nullptr : &model_.bodies.at(static_cast<std::size_t>(body));
  }
  [[nodiscard]] int system_body(int body) const {
    return body == kGround ? kGround : map_.body.at(static_cast<std::size_t>(body));
  }
  [[nodiscard]] bool is_point_mass(int body) const {
    const BodySpec* s = spec(body);
    return s && s->point_mass && !s->fixed;
  }
  /// World coordinates of a point given in a fixed body's coordinates.
  [[nodiscard]] Vec3 point(int body, const Vec3& Z) const {
    const BodySpec* s = spec(body);
    return s && s->fixed ? Vec3(s->position + s->orientation.normalized() * Z) : Z;
  }
  [[nodiscard]] Mat3 axes(int body, const Mat3& R) const {
    const BodySpec* s = spec(body);
    return s && s->fixed ? Mat3(s->orientation.normalized().toRotationMatrix() * R) : R;
  }
  /// Initial position of a point of any body [m].
  [[nodiscard]] Vec3 start_position(int body, const Vec3& Z) const {
    const BodySpec* s = spec(body);
    return s ? Vec3(s->position + s->orientation.normalized() * Z) : Z;
  }

  void check_movable(const std::string& where, int a, int b) const {
    if (system_body(a) == kGround && system_body(b) == kGround)
      throw InputError(where, "connects no moving body",
                       "Name at least one body that is not fixed, or leave it out");
  }
  void refuse_turning(const std::string& where, int body) const {
    throw InputError(where,
                     format("exerts a moment on '{}', which is a point mass", spec(body)->name),
                     "Attach it at the point mass itself, or give the body an inertia");
  }

  [[nodiscard]] JointRecipe recipe(const std::string& where, const JointSpec& joint) const {
    const JointFrames frames{.Z_a = point(joint.a, joint.Z_a),
                             .Z_b = point(joint.b, joint.Z_b),
                             .R_a = axes(joint.a, joint.R_a),
                             .R_b = axes(joint.b, joint.R_b)};
    JointParameters parameters{.free = joint.free, .values = joint.parameters};
    const JointKind& kind = joint_kind(joint.type);
    if (kind.points_apart && !kind.parameters.empty() && !parameters.values.contains("distance")) {
      const double distance =
          (start_position(joint.b, joint.Z_b) - start_position(joint.a, joint.Z_a)).norm();
      if (!(distance > 0.0))
        throw InputError(where, "the two points coincide, so their distance is zero",
                         "Give two distinct points, or use a spherical joint");
      parameters.values["distance"] = distance;
    }
    try {
      return kind.recipe(frames, parameters);
    } catch (const InputError& e) {
      throw InputError(format("{}.{}", where, e.where()), e.what_is_wrong(), e.hint());
    }
  }

  [[nodiscard]] double stiffest_augmented() const {
    double most = 0.0;
    for (const JointSpec& joint : model_.joints)
      if (joint.enforcement && joint.enforcement->law == JointEnforcement::Law::augmented)
        most = std::max({most, joint.enforcement->stiffness, joint.enforcement->turning_stiffness});
    return most;
  }

  void add_joint(const JointSpec& joint) {
    const std::string where = format("joints.{}", joint.name);
    check_movable(where, joint.a, joint.b);
    const JointRecipe r = recipe(where, joint);
    const JointParts& parts = r.parts;
    // Pairs of axes rotate both bodies; planes rotate a, to which their normals are fixed.
    if (is_point_mass(joint.a) && (parts.axes > 0 || parts.planes > 0 || !joint.Z_a.isZero(0.0)))
      refuse_turning(where, joint.a);
    if (is_point_mass(joint.b) && (parts.axes > 0 || !joint.Z_b.isZero(0.0)))
      refuse_turning(where, joint.b);
    Joint& item = system_.group<Joint>().add(
        joint.name, joint.type, Participants{system_body(joint.a), system_body(joint.b)}, r);
    if (joint.friction || joint.limits || joint.angle_limits)
      item.set_resistance(joint_resistance(model_, joint));
    if (joint.motion) item.set_motion(*joint.motion);
    if (velocities_may_jump(model_)) item.record_impulses();
    if (!joint.enforcement) return;
    try {
      item.set_enforcement(*joint.enforcement, stiffest_augmented());
    } catch (const InputError& e) {
      throw InputError(format("{}.enforcement.{}", where, e.where()), e.what_is_wrong(), e.hint());
    }
  }

  /// Rejects a load along a coordinate that its joint does not leave free.
  [[noreturn]] static void refuse_coordinate(const std::string& where, const LoadSpec& load,
                                             const JointSpec& joint, const Joint& item,
                                             bool turns) {
    const std::vector<std::string> names = item.coordinate_names();
    const std::string what = turns ? "angle" : "displacement";
    if (!load.coordinate.empty())
      throw InputError(where + ".coordinate",
                       format("'{}' is not free as {} {} in '{}' ({})", load.coordinate,
                              turns ? "an" : "a", what, joint.name, joint.type),
                       names.empty() ? "Name another joint" : "Free are: " + name_list(names));
    if (load.drive.empty() && turns)
      throw InputError(
          where + ".joint",
          format("'{}' is {}, which has no angle about one axis", joint.name, joint.type),
          "Use a joint with one free rotation, such as revolute or cylindrical");
    throw InputError(
        where + ".joint",
        format("'{}' is {}, which does not have exactly one free {}", joint.name, joint.type, what),
        turns ? "Use a joint with one free rotation, such as revolute or cylindrical, "
                "or give the coordinate"
              : "Use a joint with one free translation, such as prismatic or "
                "cylindrical, or give the coordinate");
  }

  /// Whether a load is an element on nodes of a beam.
  [[nodiscard]] static bool is_on_beam(const LoadSpec& load) {
    return load.solid < 0 && acts_on_beam(load_kind(load.type));
  }

  void add_load(const LoadSpec& load) {
    const std::string where = format("loads.{}", load.name);
    if (load.has_end_on_solid()) {
      map_.load_on_nodes[static_cast<int>(&load - model_.loads.data())] =
          add_load_on_nodes(system_, model_, load, map_);
      return;
    }
    if (load.solid >= 0) {
      if (load.of_motion.index() != 0)
        throw InputError(where, "a load on a solid cannot be a function of the motion",
                         "Act on a body that the solid is bonded to");
      add_solid_load(system_, load, map_.solids.at(static_cast<std::size_t>(load.solid)));
      return;
    }
    if (is_on_beam(load)) return;  // needs the beam's nodes
    const LoadKind& kind = load_kind(load.type);
    int a = load.a, b = load.b;
    std::optional<FreeAngle> angle;
    std::optional<FreeDisplacement> displacement;
    std::optional<GearGeometry> gear;
    std::vector<CoupledCoordinate> coupled;
    if (kind.place == LoadPlace::joint) {
      const int index = model_.joint_index(load.joint);
      const JointSpec& joint = model_.joints[static_cast<std::size_t>(index)];
      a = joint.a;
      b = joint.b;
      const Joint& item = system_.group<Joint>().items()[static_cast<std::size_t>(index)];
      if (item.frame_moves())
        throw InputError(where + ".joint",
                         format("the frame of '{}' has a prescribed motion", joint.name),
                         "Give the motion to a separate body, and act in a joint to that body");
      if (kind.turns)
        angle = item.free_angle(load.coordinate);
      else
        displacement = item.free_displacement(load.coordinate);
      if (kind.name == Screw::kKind)
        gear = gear_of(where, {load.joint, load.joint}, {"z", "rz"});
      else if (!angle && !displacement)
        refuse_coordinate(where, load, joint, item, kind.turns);
      if (load.drive == "speed" && model_.analysis.type != "dynamics")
        throw InputError(where + ".speed", "is a rate, which statics and modes do not have",
                         kind.turns ? "Give the angle" : "Give the displacement");
    } else if (kind.place == LoadPlace::joints) {
      gear = gear_of(where, {load.joint, load.joint_2}, {load.coordinate, load.coordinate_2});
      const bool has_radius = load.parameters.contains("radius");
      if (gear->mixed != has_radius || load.parameters.contains("ratio") == has_radius)
        throw InputError(where,
                         gear->mixed ? "relates an angle to a displacement, which requires a radius"
                                     : "relates coordinates of one kind, which requires a ratio",
                         gear->mixed ? "Give radius alone" : "Give ratio alone");
    }
    if (kind.name == Rotor::kKind && model_.analysis.turning)
      throw InputError(where, "is a rotor, which modes about a spin do not support yet",
                       "Give a body with a revolute joint and a motor instead");
    if (kind.place == LoadPlace::row)
      coupled = coupled_coordinates(where, load, model_, system_.group<Joint>().items());
    else
      check_movable(where, kind.place == LoadPlace::body ? b : a, b);
    for (const auto& [body, Z] : {std::pair(a, load.Z_a), std::pair(b, load.Z_b)})
      if (is_point_mass(body) && (kind.turns || !Z.isZero(0.0))) refuse_turning(where, body);
    LoadDescription d{
        .name = load.name,
        .bodies = {kind.place == LoadPlace::body ? kGround : system_body(a), system_body(b)},
        .Z_a = point(a, load.Z_a),
        .Z_b = point(b, load.Z_b),
        .body_fixed = load.body_fixed,
        .vector = load.vector.value_or(TimeVector{}),
        .values = load.parameters,
        .angle = angle,
        .displacement = displacement,
        .function = load.value,
        .drive = load.drive,
        .at_rest = model_.analysis.type != "dynamics"};
    d.laws = load.laws;
    d.words = load.words;
    d.matrices = load.matrices;
    d.R_a = axes(a, load.R_a);
    d.R_b = axes(b, load.R_b);
    if (const BodySpec* one = spec(a)) d.mass_a = one->mass;
    if (const BodySpec* one = spec(b)) {
      d.mass_b = one->mass;
      if (!one->point_mass) d.inertia_b = one->inertia;
      if (kind.place == LoadPlace::centres) d.inertia_b += rotor_inertia(model_, b, false);
    }
    if (gear) {
      d.bodies = gear->bodies;
      d.gear = gear->pair;
    }
    d.coupled = std::move(coupled);
    d.start_length = (start_position(b, load.Z_b) - start_position(a, load.Z_a)).norm();
    if (kind.parts > 1) add_inerter_mass(load, model_, dummy_reach(), system_, d);
    if (load.of_motion.index() != 0) add_function(where, load, kind, d);
    kind.add(system_, d);
  }

  [[nodiscard]] GearGeometry gear_of(const std::string& where,
                                     const std::array<std::string, 2>& joints,
                                     const std::array<std::string, 2>& coordinates) {
    std::array<GearJoint, 2> pair;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto index = static_cast<std::size_t>(model_.joint_index(joints[i]));
      pair[i] = {&system_.group<Joint>().items()[index], coordinates[i]};
    }
    return gear_geometry(where, pair);
  }

  void add_beam(const BeamSpec& beam) {
    auto& group = system_.group<BeamElement>();
    for (int k = 0; k < static_cast<int>(beam.mesh.size()); ++k) {
      const BeamSpec::Element& element = beam.mesh[static_cast<std::size_t>(k)];
      const int a = beam.first_node + k, b = a + 1;
      const Quat q_a = spec(a)->orientation.conjugate(), q_b = spec(b)->orientation.conjugate();
      BeamElementSpec e;
      e.name = format("{}.{}", beam.name, k);
      e.bodies = {system_body(a), system_body(b)};
      e.end_1.Q = (q_a * element.frame_1).toRotationMatrix();
      e.end_2.Q = (q_b * element.frame_2).toRotationMatrix();
      e.stiffness = beam.section.section.stiffness;
      e.residual_bending_flexibility = beam.residual_bending_flexibility;
      e.relaxation_time = beam.section.relaxation_time;
      set_reference(e, instant(a), instant(b));
      e.coupled_mass =
          coupled_part(e.length * beam.section.section.mass_per_length, beam.consistent_mass);
      group.add(e);
    }
  }

  /// Adds a node bonded to a body, or to the ground.
  int add_bonded_node(const AttachmentSpec& at) {
    NodeData node{.position = start_position(at.body, at.Z)};
    node.body = system_body(at.body);
    node.Z = node.body == kGround ? node.position : at.Z;
    return system_.add_node(node);
  }

  void add_running_cable(const CableLineSpec& cable) {
    const std::string where = format("cables.{}", cable.name);
    RunningCableSpec r = running_cable_spec(cable);
    bool moves = false;
    for (const AttachmentSpec& at : cable.through) {
      if (is_point_mass(at.body) && !at.Z.isZero(0.0)) refuse_turning(where, at.body);
      r.nodes.push_back(add_bonded_node(at));
      moves = moves || system_body(at.body) != kGround;
    }
    for (const ObstacleSpec& obstacle : cable.around) {
      if (is_point_mass(obstacle.at.body)) refuse_turning(where, obstacle.at.body);
      moves = moves || system_body(obstacle.at.body) != kGround;
    }
    if (!moves)
      throw InputError(where, "connects no moving body",
                       "Name at least one body that is not fixed, or leave it out");
    for (std::size_t k = 0; k < cable.around.size(); ++k) {
      const std::array<AttachmentSpec, 4> frame = frame_of(cable.around[k]);
      for (std::size_t i = 0; i < 4; ++i) r.windings[k].frame[i] = add_bonded_node(frame[i]);
    }
    auto elements = std::make_unique<RunningCable>(std::move(r));
    SystemMap::Running& running = map_.running_cable.back();
    running.cable = elements.get();
    running.group = system_.add_elements(std::move(elements));
  }

  void add_cable(const CableLineSpec& cable) {
    map_.running_cable.emplace_back();
    if (cable.slides) return add_running_cable(cable);
    const std::string where = format("cables.{}", cable.name);
    auto& group = system_.group<Cable>();
    const auto pieces = static_cast<double>(cable.pieces.size());
    for (const CableLineSpec::Piece& piece : cable.pieces) {
      check_movable(where, piece.a.body, piece.b.body);
      for (const AttachmentSpec& at : {piece.a, piece.b})
        if (is_point_mass(at.body) && !at.Z.isZero(0.0)) refuse_turning(where, at.body);
      group.add(CableSpec{.name = cable.name,
                          .bodies = {system_body(piece.a.body), system_body(piece.b.body)},
                          .Z_a = point(piece.a.body, piece.a.Z),
                          .Z_b = point(piece.b.body, piece.b.Z),
                          .stiffness = cable.stiffness,
                          .free_length = piece.free_length,
                          .damping = cable.damping * pieces,
                          .tension_only = cable.tension_only,
                          .strain = cable.strain,
                          .coupled_mass = coupled_part(piece.mass, 0.5)});
    }
  }

  [[nodiscard]] BodyStep instant(int body) const { return start_of(*spec(body)); }

  /// Makes the interactions of events switchable; events at the start define the initial state.
  void add_switching() {
    map_.events = all_events(model_);
    int memory = EventMemory::kSize * static_cast<int>(map_.events.size());
    for (const ControllerSpec& controller : model_.controllers)
      memory += ControllerMemory::size(controller);
    system_.set_memory(memory);
    if (!model_.controllers.empty() && model_.analysis.type != "dynamics")
      throw InputError("controllers", "act in time, which statics and modes do not have",
                       "Leave them out, or use type: dynamics");
    if (map_.events.empty()) return;
    if (model_.analysis.type != "dynamics" && !model_.analysis.history)
      throw InputError("events",
                       "occur in time, which statics without a history and modes do not have",
                       "Leave what they switch off out of the model, give analysis.history, or use "
                       "type: dynamics");
    const auto each = [&](const EventSpec& event, const std::vector<std::string>& names,
                          Switching how) {
      for (const std::string& name : names) {
        try {
          if (switched_contact(model_, name)) continue;  // see build_contacts()
          if (switched_controller(model_, name) >= 0) continue;
          const SwitchTarget target = switch_target(model_, name);
          const auto index = static_cast<std::size_t>(target.index);
          const std::string kind = target.joint ? Joint::kKind : model_.loads[index].type;
          int item = target.index;
          if (!target.joint)
            item = static_cast<int>(std::count_if(
                model_.loads.begin(), model_.loads.begin() + target.index,
                [&](const LoadSpec& load) { return load.solid < 0 && load.type == kind; }));
          system_.set_switching(kind, item, how);
        } catch (const InputError& e) {
          throw InputError("events." + event.name, e.what_is_wrong(), e.hint());
        }
      }
    };
    for (const EventSpec& event : map_.events)
      for (const auto* names : {&event.on, &event.off}) each(event, *names, Switching::starts_on);
    for (const EventSpec& event : map_.events) {
      if (!event.at || *event.at > 0.0) continue;
      each(event, event.off, Switching::starts_off);
      each(event, event.on, Switching::starts_on);
    }
  }

  /// Fills the map. Items keep the user's order within their group; loads are found by kind and
  /// count.
  void fill(SystemMap& map) {
    std::map<std::string, std::vector<int>> interactions;
    for (int i = 0; i < static_cast<int>(system_.interactions().size()); ++i)
      interactions[system_.group(system_.interactions()[i].group).kind()].push_back(i);
    map_.joint = interactions[Joint::kKind];
    std::map<std::string, std::size_t> next;
    for (const LoadSpec& load : model_.loads) {
      if (is_on_beam(load)) {
        map_.load.push_back(-1);
        continue;
      }
      std::size_t& item = next[load.type];
      map_.load.push_back(load.solid >= 0 ? -1 : interactions.at(load.type).at(item));
      item += static_cast<std::size_t>(load.solid >= 0 ? 0 : load_kind(load.type).parts) +
              load.others.size();
    }
    const auto take = [&](const std::string& kind, auto& things, auto&& size,
                          std::vector<std::vector<int>>& of) {
      std::size_t first = 0;
      for (const auto& thing : things) {
        const auto at = interactions[kind].begin() + static_cast<std::ptrdiff_t>(first);
        of.emplace_back(at, at + static_cast<std::ptrdiff_t>(size(thing)));
        first += size(thing);
      }
    };
    take(
        BeamElement::kKind, model_.beams, [](const BeamSpec& b) { return b.mesh.size(); },
        map_.beam);
    take(
        Cable::kKind, model_.cables,
        [](const CableLineSpec& c) { return c.slides ? 0 : c.pieces.size(); }, map_.cable);
    map = std::move(map_);
  }

  const Model& model_;
  System system_;
  SystemMap map_;
};

}  // namespace

System build_system(const Model& model, SystemMap* map) { return Builder(model).build(map); }

const Joint& joint_at(const System& system, int interaction) {
  const InteractionRef& ref = system.interactions().at(static_cast<std::size_t>(interaction));
  return items_of<Joint>(system.group(ref.group))[static_cast<std::size_t>(ref.item)];
}

}  // namespace polhode
