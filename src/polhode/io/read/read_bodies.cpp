// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>

#include <polhode/compile/shape_surface.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

/// Reader of one body; errors go to the context.
class BodyReader {
 public:
  BodyReader(ReadContext& context, const SourceNode& node, BodySpec& body)
      : context_(context),
        node_(node),
        body_(body),
        section_(context, node, body.place, "bodies." + body.name, body_fields()) {}

  void read() {
    if (!node_.is_map()) return;
    const auto fixed = section_.boolean("fixed");
    fixed_is_sound_ = fixed.has_value();
    body_.fixed = fixed.value_or(false);
    body_.point_mass = section_.boolean("point_mass").value_or(false);
    const std::size_t before = context_.diagnostics.size();
    if (const SourceNode* shapes = section_.find("shape"))
      body_.shapes = read_shapes(context_, *shapes, section_.path("shape"));
    if (const SourceNode* value = section_.find("contact"))
      body_.contact = read_contact_side(context_, *value, section_.path("contact"));
    check_planes();
    read_mass(context_.diagnostics.size() == before);
    read_place();
    read_velocities();
    read_hold();
    read_body_motion();
    read_color();
  }

 private:
  void read_color() {
    static const std::map<std::string_view, const char*> kNamed{
        {"red", "#c1443c"},   {"orange", "#d9822b"}, {"yellow", "#e3c23a"}, {"green", "#4f9d58"},
        {"teal", "#2f8f8b"},  {"blue", "#3b73b9"},   {"purple", "#8159a8"}, {"pink", "#d77fa1"},
        {"brown", "#8a6242"}, {"black", "#26292e"},  {"gray", "#8c9197"},   {"white", "#f2f2ee"}};
    const auto text = section_.text("color");
    if (!text) return;
    if (const auto named = kNamed.find(*text); named != kNamed.end()) {
      body_.color = named->second;
      return;
    }
    const auto is_digit = [](unsigned char c) { return std::isxdigit(c) != 0; };
    if (text->size() == 7 && text->front() == '#' &&
        std::all_of(text->begin() + 1, text->end(), is_digit)) {
      body_.color = *text;
      return;
    }
    std::vector<std::string> names;
    for (const auto& [name, code] : kNamed) names.emplace_back(name);
    section_.fault(
        "color", quote(*text) + " is no color",
        did_you_mean(*text, names) + "Write \"#4080c0\", or one of " + name_list(names) + ".");
  }

  [[nodiscard]] static bool weighs(const ShapeSpec& shape) {
    return shape.type != "plane" && shape.type != "height_field";
  }

  void check_planes() {
    if (body_.fixed || std::all_of(body_.shapes.begin(), body_.shapes.end(), weighs)) return;
    const bool field = std::any_of(body_.shapes.begin(), body_.shapes.end(),
                                   [](const auto& s) { return s.type == "height_field"; });
    section_.fault("shape",
                   format("a {} is allowed on a fixed body only", field ? "height field" : "plane"),
                   "Add 'fixed: true'.");
  }

  void read_mass(bool shapes_are_sound) {
    const std::size_t before = context_.diagnostics.size();
    const auto mass = section_.number("mass");
    const auto density = section_.number("density");
    read_inertia();
    const bool weighable = std::any_of(body_.shapes.begin(), body_.shapes.end(), weighs);
    const bool from_shapes = weighable && !section_.has("inertia");
    if (section_.has("inertia") && body_.point_mass)
      section_.fault("inertia", "a point mass has no inertia",
                     "Leave out 'inertia' or 'point_mass'.");
    if (section_.has("inertia") && section_.misses("mass"))
      section_.fault("inertia", "requires 'mass'", "Give both, or shape and density.");
    const bool has_density = section_.has("density") ||
                             std::any_of(body_.shapes.begin(), body_.shapes.end(),
                                         [](const ShapeSpec& s) { return s.density.has_value(); });
    if (section_.has("mass") && has_density && weighable)
      section_.fault("mass", "cannot be combined with a density", "Leave one of them out.");
    if (section_.has("density") && !section_.has("shape"))
      section_.fault("density", "requires 'shape'", "Give a shape, or mass and inertia.");
    if (context_.diagnostics.size() != before || !shapes_are_sound) return;
    if (mass) body_.mass = *mass;
    if (from_shapes && (mass || has_density)) {
      weigh_shapes(mass, density);
    } else if (!body_.fixed) {
      require_mass(weighable);
    }
    if (context_.diagnostics.size() == before && body_.mass > 0.0 && !body_.point_mass)
      if (section_.has("inertia") || from_shapes) check_mass();
  }

  void require_mass(bool weighable) {
    // A misspelt key, or a 'fixed' that is no boolean, is already reported.
    if (section_.has_unknown_key() || (section_.has("fixed") && !fixed_is_sound_)) return;
    if (!section_.has("mass")) {
      section_.fault(weighable ? "'density' is missing" : "'mass' is missing",
                     weighable ? "Give density or mass."
                               : "Give mass and inertia, or shape and density, or 'fixed: true'.");
    } else if (!section_.has("inertia") && !body_.point_mass) {
      section_.fault("'inertia' is missing", "Give inertia or a shape, or 'point_mass: true'.");
    }
  }

  void read_inertia() {
    const SourceNode* value = section_.find("inertia");
    if (!value) return;
    const std::string path = section_.path("inertia");
    if (value->is_map()) {
      Section entries(context_, *value, context_.tree.place_of(*value), path, inertia_fields());
      const auto entry = [&](const char* name) { return entries.number(name).value_or(0.0); };
      const double xy = entry("xy"), xz = entry("xz"), yz = entry("yz");
      body_.inertia << entry("xx"), xy, xz, xy, entry("yy"), yz, xz, yz, entry("zz");
      return;
    }
    Field positive = body_fields().at("inertia");
    positive.range = kPositive;
    positive.meaning = "Principal moments are positive.";
    if (const auto moments = read_vector(context_, *value, path, positive))
      body_.inertia = moments->asDiagonal();
  }

  void check_mass() {
    try {
      geometry::check_mass_properties(section_.path(), body_.mass, body_.inertia);
    } catch (const InputError& error) {
      section_.fault("inertia", error.what_is_wrong(), error.hint());
    }
  }

  /// Mass, centre of mass and inertia of the shapes, with their densities or a given mass.
  void weigh_shapes(const std::optional<double>& mass, const std::optional<double>& density) {
    std::vector<geometry::MassProperties> parts;
    for (const ShapeSpec& shape : body_.shapes) {
      if (!weighs(shape)) continue;
      std::optional<double> rho = shape.density ? shape.density : density;
      if (mass) rho = 1.0;
      if (!rho) {
        context_.diagnostics.add(shape.place, section_.path("shape"), "a density is missing",
                                 "Give one to this shape or to the body.");
        return;
      }
      if (const auto part = weigh(shape, *rho)) parts.push_back(*part);
    }
    if (parts.empty()) return;
    geometry::MassProperties whole = geometry::composed(parts);
    if (section_.has("com"))
      section_.fault("com", "cannot be combined with shapes, which have a centre of mass",
                     "Leave it out, or give mass and inertia.");
    body_.com = whole.com;
    body_.mass = mass.value_or(whole.mass);
    if (!body_.point_mass) body_.inertia = body_.mass / whole.mass * whole.inertia;
  }

  std::optional<geometry::MassProperties> weigh(const ShapeSpec& shape, double density) {
    const std::string path = section_.path("shape");
    try {
      const Mat3 R = shape.orientation.toRotationMatrix();
      if (const geometry::ShapeKind* kind = geometry::find_shape_kind(shape.type))
        return geometry::placed(geometry::shape_mass_properties(path, *kind, shape.sizes, density),
                                shape.position, R);
      return geometry::placed(geometry::mass_properties(shape_surface(path, shape, 0), density),
                              shape.position, R);
    } catch (const InputError& error) {
      const bool of_mesh = error.where() != path;
      context_.diagnostics.add(shape.place, path,
                               (of_mesh ? error.where() + ": " : "") + error.what_is_wrong(),
                               error.hint());
      return std::nullopt;
    }
  }

  void read_place() {
    if (const auto com = section_.vector("com"))
      if (body_.com.isZero(0.0)) body_.com = *com;
    if (const SourceNode* value = section_.find("orientation"))
      if (const auto q = read_orientation(context_, *value, section_.path("orientation")))
        body_.orientation = *q;
    if (const auto position = section_.vector("position")) body_.position = *position;
    const bool by_origin = body_.shapes.size() > 1 ||
                           (body_.shapes.size() == 1 &&
                            (body_.shapes[0].type == "mesh" || body_.shapes[0].type == "hull"));
    const auto position_of = section_.choice("position_of");
    if (position_of.value_or(by_origin ? "origin" : "com") == "origin")
      body_.position += body_.orientation * body_.com;
  }

  void read_velocities() {
    if (const auto v = section_.vector("velocity")) body_.velocity = *v;
    section_.refuse_both("angular_velocity", "angular_velocity_body", "Give one of them.");
    if (const auto omega = section_.vector("angular_velocity")) body_.angular_velocity = *omega;
    if (const auto W = section_.vector("angular_velocity_body"))
      body_.angular_velocity = body_.orientation * *W;
    for (const char* name : {"velocity", "angular_velocity", "angular_velocity_body"}) {
      if (!section_.has(name)) continue;
      if (body_.fixed)
        section_.fault(name, "a fixed body does not move", "Leave it or 'fixed' out.");
      else if (body_.point_mass && name != std::string("velocity"))
        section_.fault(name, "a point mass has no rotation", "Leave it or 'point_mass' out.");
    }
  }

  void read_hold() {
    const auto held = section_.choices("hold");
    if (!held || held->empty()) return;
    if (body_.fixed)
      section_.fault("hold", "the body is fixed already", "Leave it or 'fixed' out.");
    JointSpec joint;
    joint.name = body_.name + ".hold";
    joint.type = "generic";
    joint.place = context_.tree.place_of(*section_.find("hold"));
    joint.a = kGround;
    joint.b = context_.bodies.at(body_.name);
    joint.Z_a = body_.position;
    joint.R_b = body_.orientation.toRotationMatrix().transpose();
    add_joint(std::move(joint), *held);
  }

  void add_joint(JointSpec joint, const std::vector<std::string>& locked) {
    for (const std::string& freedom : body_fields().at("hold").choices)
      if (std::find(locked.begin(), locked.end(), freedom) == locked.end())
        joint.free.push_back(freedom);
    context_.joints.emplace(joint.name, static_cast<int>(context_.model.joints.size()));
    context_.model.joints.push_back(std::move(joint));
  }

  void read_body_motion() {
    const SourceNode* node = section_.find("motion");
    if (!node) return;
    if (body_.fixed) section_.fault("motion", "the body is fixed", "Leave it or 'fixed' out.");
    if (section_.refuse_both("motion", "hold", "Prescribe 0 for a fixed freedom.")) return;
    Section section(context_, *node, context_.tree.place_of(*node), section_.path("motion"),
                    body_motion_fields());
    if (!node->is_map()) return;
    std::array<bool, 3> moves{};
    const auto motion = read_motion(context_, section, moves);
    const bool from_world = section.choice("measured_from").value_or("start") == "world";
    if (!motion) return;
    const bool turns = motion->rotation != FrameMotion::Rotation::none;
    if (turns && body_.point_mass)
      section.fault("a point mass has no rotation", "Leave the rotation or 'point_mass' out.");
    JointSpec joint;
    joint.name = body_.name + ".motion";
    joint.type = "generic";
    joint.place = context_.tree.place_of(*node);
    joint.a = kGround;
    joint.b = context_.bodies.at(body_.name);
    joint.motion = motion;
    joint.assembled_start = true;
    if (!from_world) {
      joint.Z_a = body_.position;
      joint.R_b = body_.orientation.toRotationMatrix().transpose();
    }
    std::vector<std::string> locked;
    const char* axes[] = {"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k)
      if (moves[k]) locked.emplace_back(axes[k]);
    if (turns) locked.insert(locked.end(), {"rx", "ry", "rz"});
    add_joint(std::move(joint), locked);
  }

  ReadContext& context_;
  const SourceNode& node_;
  BodySpec& body_;
  Section section_;
  bool fixed_is_sound_ = false;
};

}  // namespace

void read_bodies(ReadContext& context, const SourceNode& node) {
  std::vector<const SourceNode*> nodes;
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "bodies")) continue;
    context.bodies.emplace(key.name, static_cast<int>(context.model.bodies.size()));
    BodySpec body;
    body.name = key.name;
    body.place = context.tree.place_of(key, node.children[k]);
    context.model.bodies.push_back(std::move(body));
    nodes.push_back(&node.children[k]);
  }
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t before = context.diagnostics.size();
    BodyReader(context, *nodes[k], context.model.bodies[k]).read();
    context.body_is_sound.push_back(context.diagnostics.size() == before);
  }
}

}  // namespace polhode::io
