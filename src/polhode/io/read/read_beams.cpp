// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <Eigen/Eigenvalues>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::io {
namespace {

/// Data of a material for beams.
struct BeamMaterial {
  double E = 0.0, nu = 0.0, density = 0.0, relaxation_time = 0.0;
};

class SectionReader {
 public:
  SectionReader(ReadContext& context, const SourceNode& node, SectionSpec& section,
                const std::string& type, const FieldTable& table)
      : context_(context),
        spec_(section),
        type_(type),
        section_(context, node, section.place, "sections." + section.name, table) {}

  void read() {
    if (type_ == "general")
      read_general();
    else
      read_shaped();
  }

 private:
  void read_shaped() {
    const std::size_t before = context_.diagnostics.size();
    const auto size = [&](const char* name) { return section_.number(name).value_or(1.0); };
    const double first = type_ == "circle" ? size("diameter")
                         : type_ == "tube" ? size("outer")
                                           : size("height");
    const double second = type_ == "tube" ? size("inner") : type_ == "circle" ? 0.0 : size("width");
    const double web = type_ == "i" ? size("web") : 0.0;
    const double flange = type_ == "i" ? size("flange") : 0.0;
    const auto torsion = section_.number("torsion_factor"), y = section_.number("shear_factor_y"),
               z = section_.number("shear_factor_z");
    const std::optional<BeamMaterial> m = material();
    if (!m || context_.diagnostics.size() != before) return;
    try {
      SectionShape shape = type_ == "rectangle" ? rectangle_section(first, second, m->nu)
                           : type_ == "circle"  ? circle_section(first, m->nu)
                           : type_ == "tube"    ? tube_section(first, second, m->nu)
                                                : i_section({first, second, web, flange}, m->nu);
      shape.J *= torsion.value_or(1.0);
      shape.shear_y = y.value_or(shape.shear_y);
      shape.shear_z = z.value_or(shape.shear_z);
      spec_.section = elastic_section(shape, m->E, m->nu, m->density);
      spec_.relaxation_time = m->relaxation_time;
      spec_.height = first;
      spec_.width = type_ == "rectangle" || type_ == "i" ? second : first;
    } catch (const InputError& e) {
      section_.fault(e.what_is_wrong(), e.hint() + ".");
    }
  }

  std::optional<BeamMaterial> material() {
    const SourceNode* node = section_.find("material");
    if (!node) return std::nullopt;
    const auto index = read_material_name(context_, *node, section_.path("material"));
    if (!index) return std::nullopt;
    const MaterialSpec& spec = context_.model.materials[static_cast<std::size_t>(*index)];
    if (!context_.material_is_sound[static_cast<std::size_t>(*index)]) return std::nullopt;
    const auto refuse = [&](const std::string& what, const char* hint) {
      section_.fault("material", what, hint);
      return std::nullopt;
    };
    const auto is_isotropic = [&](const std::vector<std::string>& names) {
      return std::all_of(names.begin(), names.end(),
                         [&](const auto& name) { return spec.parameters.contains(name); });
    };
    const auto sets = solids::isotropic_alternatives();
    if (!spec.fibres.empty() || std::none_of(sets.begin(), sets.end(), is_isotropic))
      return refuse(format("{} is {}, without the two moduli of an isotropic material",
                           quote(spec.name), spec.type),
                    "Name a material of type elastic.");
    const auto [lame, shear] = solids::isotropic_moduli(spec.parameters);
    if (!(spec.density > 0.0))
      return refuse(format("{} has no density", quote(spec.name)), "Give the material a density.");
    if (spec.viscosity.any() && !(spec.viscosity.relaxation_time > 0.0))
      return refuse(format("the viscosity of {} is given by moduli", quote(spec.name)),
                    "Give the viscosity of a beam's material by its relaxation_time.");
    if (!spec.relaxation.empty())
      return refuse(format("the stress of {} relaxes", quote(spec.name)),
                    "Give a beam a material without 'relaxation', or use a solid.");
    return BeamMaterial{shear * (3.0 * lame + 2.0 * shear) / (lame + shear),
                        0.5 * lame / (lame + shear), spec.density, spec.viscosity.relaxation_time};
  }

  void read_general() {
    static constexpr const char* kNames[] = {"EA", "GA_y", "GA_z", "GJ", "EI_y", "EI_z"};
    Mat6& C = spec_.section.stiffness;
    bool any = false;
    for (int i = 0; i < 6; ++i) {
      any = any || section_.has(kNames[i]);
      C(i, i) = section_.number(kNames[i]).value_or(1.0);
    }
    if (const SourceNode* node = section_.find("matrix")) {
      if (any)
        section_.fault("matrix", "cannot be combined with EA, GA_y, ...",
                       "Give the matrix or the six.");
      else
        read_matrix(*node, C);
    } else {
      for (const char* name : kNames)
        if (section_.misses(name))
          section_.fault(format("'{}' is missing", name),
                         "Give EA, GA_y, GA_z, GJ, EI_y, EI_z, "
                         "or a matrix.");
    }
    spec_.section.mass_per_length = section_.number("mass_per_length").value_or(1.0);
    const Vec3 inertia = section_.vector("inertia_per_length").value_or(Vec3::Ones());
    if (!(inertia.minCoeff() > 0.0))
      section_.fault("inertia_per_length", "has an entry that is not above zero",
                     "Give the inertia about x, y and z.");
    spec_.section.inertia_per_length = inertia;
    spec_.relaxation_time = section_.number("relaxation_time").value_or(0.0);
  }

  void read_matrix(const SourceNode& node, Mat6& C) {
    const std::string path = section_.path("matrix");
    const auto wrong = [&](const SourceNode& at, std::string what) {
      context_.fault(at, path, std::move(what), "Write six rows of six numbers.");
    };
    if (!node.is_list() || node.children.size() != 6)
      return wrong(node, "expects six rows, but is " + node.description());
    Field entry;
    for (int i = 0; i < 6; ++i) {
      const SourceNode& row = node.children[static_cast<std::size_t>(i)];
      if (!row.is_list() || row.children.size() != 6)
        return wrong(row, "expects rows of six numbers, but this is " + row.description());
      for (int j = 0; j < 6; ++j) {
        const auto value =
            read_number(context_, row.children[static_cast<std::size_t>(j)], path, entry);
        if (!value) return;
        C(i, j) = *value;
      }
    }
    if (!(C - C.transpose()).isZero(1e-9 * C.norm()))
      context_.fault(node, path, "is not symmetric", "Give a symmetric matrix.");
    else if (Eigen::SelfAdjointEigenSolver<Mat6>(C).eigenvalues()[0] <= 0.0)
      context_.fault(node, path, "is not positive definite",
                     "Give positive stiffnesses, and couplings that are not too large.");
    C = 0.5 * (C + Mat6(C.transpose()));
  }

  ReadContext& context_;
  SectionSpec& spec_;
  const std::string& type_;
  Section section_;
};

/// Reports an error found while a beam or cable was meshed, at the key that it names, or the
/// nearest one above.
void tell(ReadContext& context, Section& section, const InputError& e) {
  std::string keys = e.where().substr(std::min(e.where().size(), section.path("").size()));
  const SourceNode* node = nullptr;
  while (!keys.empty()) {
    const std::size_t dot = std::min(keys.find('.'), keys.size());
    const std::string key = keys.substr(0, dot);
    const SourceNode* next = node ? node->find(key) : section.find(key);
    if (!next) break;
    node = next;
    keys.erase(0, dot + 1);
  }
  if (node)
    context.fault(*node, e.where(), e.what_is_wrong(), e.hint() + ".");
  else
    section.fault(e.what_is_wrong(), e.hint() + ".");
}

/// Registers the names of bodies and joints created for a beam or cable.
void name_parts(ReadContext& context, std::size_t bodies, std::size_t joints, bool sound) {
  const Model& model = context.model;
  for (std::size_t k = bodies; k < model.bodies.size(); ++k) {
    context.bodies.emplace(model.bodies[k].name, static_cast<int>(k));
    context.body_is_sound.push_back(sound);
  }
  for (std::size_t k = joints; k < model.joints.size(); ++k)
    context.joints.emplace(model.joints[k].name, static_cast<int>(k));
}

class BeamReader {
 public:
  BeamReader(ReadContext& context, const SourceNode& node, BeamSpec& beam)
      : context_(context),
        beam_(beam),
        section_(context, node, beam.place, "beams." + beam.name, beam_fields()) {}

  void read() {
    const std::size_t before = context_.diagnostics.size();
    if (!section_.refuse_both("points", "arc", "Give one of them.")) {
      beam_.arc = section_.has("arc");
      if (!beam_.arc && section_.misses("points"))
        section_.fault("'points' is missing", "Give points: [start, ..., end], or an arc.");
      if (const auto points = read_points(beam_.arc ? "arc" : "points")) beam_.points = *points;
    }
    beam_.elements = section_.integer("elements").value_or(1);
    read_section();
    if (const auto up = section_.direction("up")) beam_.up = *up;
    if (const SourceNode* bonded = section_.find("bonded")) read_bonds(*bonded);
    read_velocities();
    if (const SourceNode* node = section_.find("contact")) read_contact(*node);
    // Contact impulses act on single nodes.
    beam_.consistent_mass = section_.number("consistent_mass").value_or(beam_.contact ? 0.0 : 0.5);
    beam_.residual_bending_flexibility =
        section_.boolean("residual_bending_flexibility").value_or(true);
    if (context_.diagnostics.size() != before || !section_is_sound_ || !mesh()) stand_in();
  }

 private:
  void read_contact(const SourceNode& node) {
    Section section(context_, node, context_.tree.place_of(node), section_.path("contact"),
                    beam_contact_fields());
    if (!node.is_map()) return;
    BeamContactSpec contact;
    section.read_into(contact);
    read_contact_side(section, contact.side);
    if (contact.side.touches.value_or(true)) beam_.contact = contact;
  }

  void read_velocities() {
    const auto v = section_.vector("velocity"), omega = section_.vector("angular_velocity");
    if (v) beam_.velocity = *v;
    if (omega) beam_.angular_velocity = *omega;
    if (v || omega || beam_.bonds.empty() || beam_.points.empty()) return;
    const int holder = beam_.bonds.front().body;
    if (holder == kGround) return;
    const BodySpec& body = context_.model.bodies[static_cast<std::size_t>(holder)];
    beam_.angular_velocity = body.angular_velocity;
    beam_.velocity =
        body.velocity + body.angular_velocity.cross(beam_.points.front() - body.position);
  }

  std::optional<std::vector<Vec3>> read_points(const char* name) {
    const SourceNode* node = section_.find(name);
    if (!node) return std::nullopt;
    const std::string path = section_.path(name);
    if (!node->is_list() || node->children.empty()) {
      context_.fault(*node, path, "expects a list of points, but is " + node->description(),
                     "Write [[0, 0, 0], [1, 0, 0]].");
      return std::nullopt;
    }
    std::vector<Vec3> points;
    for (const SourceNode& child : node->children) {
      const auto point = read_vector(context_, child, path, beam_fields().at(name));
      if (!point) return std::nullopt;
      points.push_back(*point);
    }
    return points;
  }

  void read_section() {
    const auto name = section_.text("section");
    if (!name) return;
    const auto found = context_.sections.find(*name);
    if (found == context_.sections.end()) {
      std::vector<std::string> names;
      for (const auto& [known, spec] : context_.sections) names.push_back(known);
      section_.fault(
          "section", "unknown section " + quote(*name),
          did_you_mean(*name, names) + (names.empty() ? "The model has no sections."
                                                      : "Sections: " + name_list(names) + "."));
      return;
    }
    section_is_sound_ = found->second.has_value();
    if (section_is_sound_) beam_.section = *found->second;
  }

  void read_bonds(const SourceNode& node) {
    const std::string path = section_.path("bonded");
    if (!node.is_map()) {
      context_.fault(node, path, "expects a map from bodies to ends, but is " + node.description(),
                     "Write {plate: start}.");
      return;
    }
    std::vector<bool> taken(2, false);
    for (std::size_t k = 0; k < node.keys.size(); ++k) {
      SourceNode name = node.children[k];
      name.text = node.keys[k].name;
      name.kind = SourceNode::Kind::kText;
      const auto body = read_body(context_, name, path);
      const SourceNode& value = node.children[k];
      const auto add = [&](const SourceNode& end) {
        const auto word =
            read_choice(context_, end, path + "." + node.keys[k].name, {"start", "end"});
        if (!word || !body) return;
        const bool at_end = *word == "end";
        if (taken[at_end])
          context_.fault(end, path, format("holds the {} twice", *word),
                         "Bond each end to one body.");
        taken[at_end] = true;
        beam_.bonds.push_back({*body, at_end});
      };
      if (value.is_list())
        for (const SourceNode& end : value.children) add(end);
      else
        add(value);
    }
  }

  bool mesh() {
    const std::size_t bodies = context_.model.bodies.size(), joints = context_.model.joints.size();
    try {
      add_beam(context_.model, beam_);
    } catch (const InputError& e) {
      tell(context_, section_, e);
      return false;
    }
    name_parts(context_, bodies, joints, true);
    name_ends(bodies);
    return true;
  }

  /// Adds placeholder bodies with the names of the nodes, so that references to them cause no
  /// further error.
  void stand_in() {
    const std::size_t bodies = context_.model.bodies.size();
    beam_.first_node = static_cast<int>(bodies);
    beam_.mesh.resize(static_cast<std::size_t>(std::clamp(beam_.elements, 1, kMaxStandIns)));
    for (int k = 0; k < beam_.node_count(); ++k) {
      context_.model.bodies.emplace_back();
      context_.model.bodies.back().name = format("{}.{}", beam_.name, k);
      context_.model.bodies.back().node_of = beam_.name;
    }
    context_.model.beams.push_back(beam_);
    name_parts(context_, bodies, context_.model.joints.size(), false);
    name_ends(bodies);
  }

  void name_ends(std::size_t first) {
    context_.bodies.emplace(beam_.name + ".start", static_cast<int>(first));
    context_.bodies.emplace(beam_.name + ".end",
                            static_cast<int>(context_.model.bodies.size()) - 1);
  }

  static constexpr int kMaxStandIns = 1000;
  ReadContext& context_;
  BeamSpec& beam_;
  Section section_;
  bool section_is_sound_ = true;
};

class CableReader {
 public:
  CableReader(ReadContext& context, const SourceNode& node, CableLineSpec& cable)
      : context_(context),
        cable_(cable),
        section_(context, node, cable.place, "cables." + cable.name, cable_fields()) {}

  void read() {
    const std::size_t before = context_.diagnostics.size();
    if (const SourceNode* node = section_.find("through")) read_through(*node);
    read_cable_pull(context_, section_, cable_);
    section_.read_into(cable_);
    read_obstacles(context_, section_, cable_);
    if (const SourceNode* node = section_.find("contact")) read_contact(*node);
    if (context_.diagnostics.size() == before) divide();
  }

 private:
  void read_contact(const SourceNode& node) {
    Section section(context_, node, context_.tree.place_of(node), section_.path("contact"),
                    cable_contact_fields());
    if (!node.is_map()) return;
    CableContactSpec contact;
    section.read_into(contact);
    read_contact_side(section, contact.side);
    cable_.contact = std::move(contact);
  }

  void read_through(const SourceNode& node) {
    const std::string path = section_.path("through");
    const char* const hint = "Write [[plate, [0, 0, 0.1]], [mast, end]].";
    if (!node.is_list()) {
      context_.fault(node, path, "expects a list of points, but is " + node.description(), hint);
      return;
    }
    for (const SourceNode& entry : node.children) {
      if (!entry.is_list() || entry.children.empty() || entry.children.size() > 2) {
        context_.fault(entry, path, "expects [body, point], but is " + entry.description(), hint);
        continue;
      }
      read_attachment(entry, path);
    }
  }

  void read_attachment(const SourceNode& entry, const std::string& path) {
    const SourceNode& of = entry.children[0];
    AttachmentSpec at;
    if (entry.children.size() == 2 && entry.children[1].is_text()) {  // [mast, end]
      SourceNode node = of;
      if (of.is_text()) node.text = of.text + "." + entry.children[1].text;
      const auto body = read_body(context_, node, path);
      if (!body) return;
      at.body = *body;
      cable_.through.push_back(at);
      return;
    }
    const auto body = read_body(context_, of, path);
    if (!body) return;
    at.body = *body;
    if (entry.children.size() == 2) {
      const auto point =
          read_vector(context_, entry.children[1], path, cable_fields().at("through"));
      if (!point) return;
      at.Z = *body == kGround
                 ? *point
                 : Vec3(*point - context_.model.bodies[static_cast<std::size_t>(*body)].com);
    }
    cable_.through.push_back(at);
  }

  void divide() {
    const std::size_t bodies = context_.model.bodies.size(), joints = context_.model.joints.size();
    try {
      add_cable(context_.model, cable_);
    } catch (const InputError& e) {
      tell(context_, section_, e);
      return;
    }
    name_parts(context_, bodies, joints, true);
  }

  ReadContext& context_;
  CableLineSpec& cable_;
  Section section_;
};

/// Checks that the name of a beam or cable does not collide with bodies, whose names it prefixes.
bool check_free_name(ReadContext& context, const SourceNode::Key& key, const SourceNode& value,
                     const std::string& collection) {
  if (!check_name(context, key, value, collection)) return false;
  for (const char* suffix : {".0", ".start"})
    if (context.bodies.contains(key.name + suffix)) {
      context.diagnostics.add(context.tree.place_of(key, value), collection + "." + key.name,
                              "has the name of a beam", "Choose another name.");
      return false;
    }
  return true;
}

}  // namespace

void read_sections(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_name(context, key, node.children[k], "sections")) continue;
    SectionSpec section;
    section.name = key.name;
    section.place = context.tree.place_of(key, node.children[k]);
    const std::size_t before = context.diagnostics.size();
    std::string type;
    if (const FieldTable* table = read_kind(context, node.children[k], section.place,
                                            "sections." + key.name, section_tables(), type))
      SectionReader(context, node.children[k], section, type, *table).read();
    // An error of its material is reported there, and leaves the section without mass.
    const bool sound =
        context.diagnostics.size() == before && section.section.mass_per_length > 0.0;
    context.sections.emplace(key.name, sound ? std::optional(std::move(section)) : std::nullopt);
  }
}

void read_beams(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_free_name(context, key, node.children[k], "beams")) continue;
    BeamSpec beam;
    beam.name = key.name;
    beam.place = context.tree.place_of(key, node.children[k]);
    BeamReader(context, node.children[k], beam).read();
  }
}

void read_cables(ReadContext& context, const SourceNode& node) {
  for (std::size_t k = 0; k < node.keys.size(); ++k) {
    const SourceNode::Key& key = node.keys[k];
    if (!check_free_name(context, key, node.children[k], "cables")) continue;
    CableLineSpec cable;
    cable.name = key.name;
    cable.place = context.tree.place_of(key, node.children[k]);
    CableReader(context, node.children[k], cable).read();
    const int index = static_cast<int>(context.model.cables.size()) - 1;
    const bool sound = index >= 0 && context.model.cables.back().name == key.name;
    context.cables.emplace(key.name, sound ? std::optional(index) : std::nullopt);
  }
}

}  // namespace polhode::io
