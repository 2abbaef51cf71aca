// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <set>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/compile/contact_law_choice.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {
namespace {

/// Smallest restitution that a damper can produce.
constexpr double kMinDamped = 0.05;

/// Keys of contact forces that are not available with impulses.
constexpr std::array kForceKeys{"gap_tolerance",      "stiffness",       "hertz_stiffness",
                                "reference_load",     "rebound",         "reference_pressure",
                                "static_friction",    "friction_across", "direction",
                                "friction_stiffness", "friction_damping"};

/// Those that are available where contacts are rows of the step.
constexpr std::array kKeysOfRows{"static_friction", "friction_across", "direction"};

bool is_key_of_rows(std::string_view key) {
  return std::find(kKeysOfRows.begin(), kKeysOfRows.end(), key) != kKeysOfRows.end();
}

/// Whether a law names itself or has a key of forces alone: a model with one gets that law or the
/// barrier, others the law that is chosen for them.
bool asks_for_forces(const SourceNode& law) {
  return law.is_map() && (law.find("law") ||
                          std::any_of(kForceKeys.begin(), kForceKeys.end(), [&](const char* key) {
                            return !is_key_of_rows(key) && law.find(key);
                          }));
}

/// Whether a law applies to all pairs, as it determines the integration.
bool is_of_all(const ContactLawSpec& law) {
  return law.potential == "nonsmooth" || law.potential == "rigid";
}

void read_law(Section& section, ContactLawSpec& law) {
  const auto potential = section.choice("law");
  const bool sound_law = potential || !section.has("law");
  if (potential) law.potential = *potential;
  std::vector<std::string_view> by_hand{"law", "stiffness"};
  if (is_of_all(law)) {
    const bool rigid = law.potential == "rigid";
    for (const char* key : kForceKeys) {
      if (rigid && is_key_of_rows(key)) continue;
      by_hand.emplace_back(key);
      if (section.has(key))
        section.fault(key, format("cannot be combined with the law {}", law.potential),
                      rigid ? "Leave it out: bodies do not penetrate each other with this law."
                            : "Leave it out: this law has restitution, friction, rolling_friction "
                              "and torsional_friction only.");
    }
    section.read_into(law, by_hand);
    return;
  }
  section.read_into(law, by_hand);
  const bool hertz = law.potential == "hertz";
  for (const char* key : {"stiffness", "hertz_stiffness"}) {
    const auto value = section.number(key);
    if (!value || !sound_law) continue;
    if (hertz == (key == std::string("hertz_stiffness")))
      law.stiffness = *value;
    else
      section.fault(key, format("cannot be combined with the law {}", law.potential),
                    hertz ? "Use hertz_stiffness." : "Use stiffness, or law: hertz.");
  }
  if (section.has("reference_load"))
    section.refuse_both("stiffness", "reference_load", "Give one of them.");
  const auto known = contact::potential_of(law.potential);
  if (law.rebound == "damped" && known && !contact::is_spring(*known) && sound_law)
    section.fault("rebound", format("damped cannot be combined with the {} law", law.potential),
                  "Use law: linear or hertz with it, or leave it out.");
  else if (law.rebound == "damped" && law.restitution < kMinDamped)
    section.fault("restitution",
                  format("a damper cannot give the restitution {}", shown(law.restitution)),
                  format("Give at least {}, or leave out 'rebound'.", shown(kMinDamped)));
  if (section.has("static_friction") && law.static_friction < law.friction)
    section.fault(
        "static_friction",
        format("{} is below friction, {}", shown(law.static_friction), shown(law.friction)),
        "Static friction is at least as large as sliding friction.");
  if (section.has("direction") && law.friction_across == 0.0)
    section.fault("direction", "requires 'friction_across'", "Give both, or neither.");
  if (section.has("friction_across") && law.friction == 0.0)
    section.fault("friction_across", "requires 'friction'", "Give friction along direction.");
}

/// Reader of the section; errors go to the context.
class ContactsReader {
 public:
  ContactsReader(ReadContext& context, const SourceNode& node)
      : context_(context),
        node_(node),
        contacts_(context.model.contacts),
        section_(context, node, context.tree.place_of(node), "contacts", contacts_fields()) {}

  void read() {
    contacts_.present = true;
    contacts_.place = section_.place();
    if (!node_.is_map()) return;
    if (const SourceNode* node = section_.find("default")) {
      Section law(context_, *node, context_.tree.place_of(*node), section_.path("default"),
                  contact_law_fields());
      if (node->is_map()) read_law(law, contacts_.standard);
    }
    if (const SourceNode* node = section_.find("combine")) read_combination(*node);
    each("materials", contact_material_fields(), "{friction: 0.5}",
         [&](Section& section, const std::string& name) {
           ContactMaterialSpec material{name, section.place(), contacts_.standard.friction,
                                        contacts_.standard.restitution};
           section.read_into(material);
           contacts_.materials.push_back(std::move(material));
         });
    each("pairs", contact_pair_fields(), "{between: [a, b], friction: 0.5}",
         [&](Section& section, const std::string& name) { read_pair(section, name); });
    if (const SourceNode* node = section_.find("exclude")) read_excluded(*node);
    each("sensors", contact_sensor_fields(), "{between: [a, b]}",
         [&](Section& section, const std::string& name) { read_sensor(section, name); });
    contacts_.resolve_overlaps = section_.choice("overlaps").value_or("error") == "resolve";
    section_.read_into(contacts_);
    for (const char* key : {"sweeps", "sweep_tolerance"})
      if (section_.has(key) && !contacts_.nonsmooth())
        section_.fault(key, "requires the law nonsmooth",
                       "Set contacts.default.law: nonsmooth, or leave it out.");
  }

 private:
  /// Visits every entry of a map from names to sections.
  template <class F>
  void each(const std::string& key, const FieldTable& table, const char* example, F&& read_one) {
    const SourceNode* node = section_.find(key);
    if (!node || node->kind == SourceNode::Kind::kEmpty) return;
    if (!node->is_map()) {
      context_.fault(*node, section_.path(key),
                     format("expects a map from names to {}, but is {}", key, node->description()),
                     format("Write name: {}.", example));
      return;
    }
    for (std::size_t k = 0; k < node->keys.size(); ++k) {
      const std::string& name = node->keys[k].name;
      if (!check_name(context_, node->keys[k], node->children[k], section_.path(key))) continue;
      Section section(context_, node->children[k],
                      context_.tree.place_of(node->keys[k], node->children[k]),
                      section_.path(key) + "." + name, table);
      if (node->children[k].is_map()) read_one(section, name);
    }
  }

  void read_combination(const SourceNode& node) {
    Section section(context_, node, context_.tree.place_of(node), section_.path("combine"),
                    contact_combination_fields());
    if (node.is_map()) section.read_into(contacts_);
  }

  /// Two bodies that have shapes, or one and a solid or cable; the ground itself has none.
  std::optional<std::array<Side, 2>> read_sides(Section& section) {
    const SourceNode* node = section.find("between");
    if (!node) return std::nullopt;
    const auto pair = read_side_pair(context_, *node, section.path("between"));
    if (!pair || !check_bodies(*pair, *section.find("between"), section.path("between")))
      return std::nullopt;
    return pair;
  }

  bool check_bodies(const std::array<Side, 2>& pair, const SourceNode& node,
                    const std::string& path) {
    for (std::size_t k = 0; k < 2; ++k) {
      if (pair[k].is_solid()) continue;
      if (pair[k].is_cable()) {
        const CableLineSpec& cable = context_.model.cables[static_cast<std::size_t>(pair[k].index)];
        if (cable.contact) continue;
        context_.fault(node.children[k], path,
                       format("the cable {} does not touch", quote(cable.name)),
                       "Give it contact: {radius: ...}, or leave the pair out.");
        return false;
      }
      if (pair[k] == kGround) {
        context_.fault(node.children[k], path, "the ground has no shapes",
                       "Name a fixed body with a shape.");
        return false;
      }
      const BodySpec& body = context_.model.bodies[static_cast<std::size_t>(pair[k].index)];
      if (!body.shapes.empty()) continue;
      if (context_.body_is_sound[static_cast<std::size_t>(pair[k].index)])
        context_.fault(node.children[k], path, format("the body {} has no shape", quote(body.name)),
                       "Give it a shape, or leave the pair out.");
      return false;
    }
    const auto fixed = [&](const Side& b) {
      return b.is_body() && context_.model.bodies[static_cast<std::size_t>(b.index)].fixed;
    };
    if (!fixed(pair[0]) || !fixed(pair[1])) return true;
    context_.fault(node, path, "both bodies are fixed", "Name at least one that moves.");
    return false;
  }

  void read_pair(Section& section, const std::string& name) {
    ContactPairSpec pair;
    pair.name = name;
    pair.place = section.place();
    pair.law = contacts_.standard;
    if (section.refuse_both("between", "materials", "Give one of them.")) return;
    if (!section.has("between") && !section.has("materials")) {
      if (!section.has_unknown_key())
        section.fault("names no pair", "Give 'between' with two bodies, or 'materials' with two.");
      return;
    }
    bool known = false;
    if (section.has("materials")) {
      pair.of_materials = true;
      if (const auto materials = read_materials(section)) {
        known = true;
        pair.materials = *materials;
        const auto combined = combined_surface(contacts_, pair.materials[0], pair.materials[1]);
        pair.law.friction = combined.friction;
        pair.law.restitution = combined.restitution;
      }
    } else if (const auto sides = read_sides(section)) {
      known = true;
      pair.a = (*sides)[0];
      pair.b = (*sides)[1];
    }
    read_law(section, pair.law);
    if ((is_of_all(pair.law) || is_of_all(contacts_.standard)) &&
        pair.law.potential != contacts_.standard.potential)
      section.fault(
          "law",
          format("{} cannot be combined with {} in contacts.default", pair.law.potential,
                 contacts_.standard.potential),
          format("The law {} applies to all pairs: give it in contacts.default, or nowhere.",
                 is_of_all(pair.law) ? pair.law.potential : contacts_.standard.potential));
    if (!known) return;
    if (!pair.of_materials) check_law_of_sides(section, {pair.a, pair.b});
    const auto same = [&](const ContactPairSpec& other) {
      const auto& [m, n] = pair.materials;
      return pair.of_materials
                 ? std::minmax(other.materials[0], other.materials[1]) == std::minmax(m, n)
                 : std::minmax(other.a, other.b) == std::minmax(pair.a, pair.b);
    };
    for (const ContactPairSpec& other : contacts_.pairs)
      if (other.of_materials == pair.of_materials && same(other))
        section.fault(pair.of_materials ? "materials" : "between",
                      format("{} already defines this pair", quote(other.name)),
                      "Keep one of them.");
    contacts_.pairs.push_back(std::move(pair));
  }

  /// Rejects law keys for points on surfaces, and vice versa.
  void check_law_of_sides(Section& section, const std::array<Side, 2>& sides) {
    if (sides[0].is_body() && sides[1].is_body()) {
      if (section.has("reference_pressure"))
        section.fault("reference_pressure", "is not a key for a pair of bodies",
                      "It is for surfaces of solids and cables: use reference_load.");
      return;
    }
    const bool cable = sides[0].is_cable() || sides[1].is_cable();
    const std::string not_of =
        format("cannot be combined with {}", cable ? "a cable" : "the surface of a solid");
    for (const char* key : {"stiffness", "hertz_stiffness", "reference_load", "rebound",
                            "friction_stiffness", "friction_damping"})
      if (section.has(key))
        section.fault(key, not_of,
                      "Leave it out; reference_pressure makes the surface stiffer or softer.");
    if (section.has("law") && section.choice("law") == "hertz")
      section.fault(
          "law", "hertz " + not_of,
          cable ? "Use barrier or linear."
                : "Use barrier or linear: the solid itself has the compliance of Hertz's law.");
  }

  std::optional<std::array<int, 2>> read_materials(Section& section) {
    const SourceNode& node = *section.find("materials");
    const std::string path = section.path("materials");
    if (!node.is_list() || node.children.size() != 2) {
      context_.fault(node, path,
                     format("expects two contact materials, but is {}",
                            node.is_list() ? format("a list of {}", node.children.size())
                                           : node.description()),
                     "Write [rubber, steel]; for a material against itself, write it twice.");
      return std::nullopt;
    }
    std::array<int, 2> ends{};
    for (std::size_t k = 0; k < 2; ++k) {
      const auto name = read_text(context_, node.children[k], path);
      if (!name) return std::nullopt;
      const auto index = find_material(*name);
      if (!index) {
        unknown_material(context_.tree.place_of(node.children[k]), path, *name);
        return std::nullopt;
      }
      ends[k] = *index;
    }
    return ends;
  }

  std::optional<int> find_material(const std::string& name) const {
    for (std::size_t k = 0; k < contacts_.materials.size(); ++k)
      if (contacts_.materials[k].name == name) return static_cast<int>(k);
    return std::nullopt;
  }

  void unknown_material(const SourceLocation& place, const std::string& path,
                        const std::string& name) {
    std::vector<std::string> names;
    for (const ContactMaterialSpec& m : contacts_.materials) names.push_back(m.name);
    context_.diagnostics.add(
        place, path, "unknown contact material " + quote(name),
        did_you_mean(name, names) + (names.empty() ? "The model has none: give contacts.materials."
                                                   : sentence("Materials: " + name_list(names))));
  }

  void read_sensor(Section& section, const std::string& name) {
    if (!section.has("between")) return;
    const auto ends = read_sides(section);
    if (!ends) return;
    if (!(*ends)[0].is_body() || !(*ends)[1].is_body()) {
      section.fault("between", "a sensor cannot have solids or cables",
                    "Name two bodies; for a solid or cable a probe reports gap and force.");
      return;
    }
    for (const ContactPairSpec& other : contacts_.pairs)
      if (!other.of_materials &&
          std::minmax(other.a, other.b) == std::minmax((*ends)[0], (*ends)[1]))
        section.fault("between", format("{} already defines this pair", quote(other.name)),
                      "A sensor exerts no force: keep one of them. Probes report contacts, see "
                      "output.probes.");
    ContactPairSpec pair;
    pair.name = name;
    pair.place = section.place();
    pair.a = (*ends)[0];
    pair.b = (*ends)[1];
    pair.sensor = true;
    contacts_.pairs.push_back(std::move(pair));
  }

  void read_excluded(const SourceNode& node) {
    const std::string path = section_.path("exclude");
    if (node.kind == SourceNode::Kind::kEmpty) return;
    if (!node.is_list()) {
      context_.fault(node, path, "expects a list of pairs, but is " + node.description(),
                     "Write [[a, b], [a, c]].");
      return;
    }
    for (const SourceNode& child : node.children) {
      const auto pair = read_side_pair(context_, child, path);
      if (pair && check_bodies(*pair, child, path)) contacts_.excluded.push_back(*pair);
    }
  }

  ReadContext& context_;
  const SourceNode& node_;
  ContactsSpec& contacts_;
  Section section_;
};

}  // namespace

std::optional<std::vector<std::string>> read_names(ReadContext& context, const SourceNode& node,
                                                   const std::string& path) {
  if (!node.is_list() || node.children.empty()) {
    context.fault(node, path, "expects a list of names, but is " + node.description(),
                  "Write [a, b], for example.");
    return std::nullopt;
  }
  std::vector<std::string> names;
  for (const SourceNode& child : node.children) {
    const auto name = read_text(context, child, path);
    if (!name) return std::nullopt;
    if (name->empty() || std::find(names.begin(), names.end(), *name) != names.end()) {
      context.fault(child, path, name->empty() ? "a name is empty" : quote(*name) + " stands twice",
                    "Give each name once.");
      return std::nullopt;
    }
    names.push_back(*name);
  }
  return names;
}

ContactSideSpec read_contact_side(ReadContext& context, const SourceNode& node,
                                  const std::string& path) {
  ContactSideSpec side;
  side.place = context.tree.place_of(node);
  Section section(context, node, side.place, path, contact_side_fields());
  if (node.is_map()) read_contact_side(section, side);
  return side;
}

void read_contact_side(Section& section, ContactSideSpec& side) {
  side.place = section.place();
  section.read_into(side);
}

void read_solid_contact(ReadContext& context, const SourceNode& node, const std::string& path,
                        SolidSpec& solid) {
  Section section(context, node, context.tree.place_of(node), path, solid_contact_fields());
  if (!node.is_map()) return;
  if (const SourceNode* value = section.find("surface"))
    if (auto faces = read_selections(context, *value, section.path("surface")))
      solid.contact_surface = std::move(*faces);
  solid.self_contact = section.boolean("self").value_or(false);
  read_contact_side(section, solid.contact);
}

std::optional<std::array<Side, 2>> read_side_pair(ReadContext& context, const SourceNode& node,
                                                  const std::string& path) {
  const auto is_solid = [&](const SourceNode& child) {
    return child.is_text() && context.solids.contains(child.text);
  };
  const auto is_cable = [&](const SourceNode& child) {
    return child.is_text() && context.cables.contains(child.text);
  };
  if (!node.is_list() || node.children.size() != 2 ||
      std::none_of(node.children.begin(), node.children.end(),
                   [&](const SourceNode& child) { return is_solid(child) || is_cable(child); })) {
    const auto bodies = read_body_pair(context, node, path);
    if (!bodies) return std::nullopt;
    return std::array<Side, 2>{(*bodies)[0], (*bodies)[1]};
  }
  std::array<Side, 2> sides{};
  for (std::size_t k = 0; k < 2; ++k) {
    const SourceNode& child = node.children[k];
    const bool solid = is_solid(child), cable = is_cable(child);
    if (!solid && !cable) {
      const auto body = read_body(context, child, path);
      if (!body) return std::nullopt;
      sides[k] = *body;
      continue;
    }
    if (const bool body = context.bodies.contains(child.text); body || (solid && cable)) {
      context.fault(child, path,
                    format("{} is a {} and a {}", quote(child.text), body ? "body" : "solid",
                           cable ? "cable" : "solid"),
                    "Give one of them another name.");
      return std::nullopt;
    }
    if (cable && !context.cables.at(child.text)) return std::nullopt;  // already reported
    sides[k] = cable ? Side::of_cable(*context.cables.at(child.text))
                     : Side::of_solid(context.solids.at(child.text));
  }
  return sides;
}

void choose_law(ReadContext& context, const SourceNode& contacts) {
  const SourceNode* standard = contacts.is_map() ? contacts.find("default") : nullptr;
  const SourceNode* pairs = contacts.is_map() ? contacts.find("pairs") : nullptr;
  if (standard && asks_for_forces(*standard)) return;
  if (pairs && pairs->is_map() &&
      std::any_of(pairs->children.begin(), pairs->children.end(), asks_for_forces))
    return;
  ContactsSpec& spec = context.model.contacts;
  spec.standard.potential = choose_contact_law(context.model).law;
  for (ContactPairSpec& pair : spec.pairs) pair.law.potential = spec.standard.potential;
}

void read_contacts(ReadContext& context, const SourceNode& node) {
  ContactsReader(context, node).read();
}

void check_contacts(ReadContext& context, const SourceNode& root) {
  Model& model = context.model;
  if (!model.contacts.present) return;
  if (std::find(context.body_is_sound.begin(), context.body_is_sound.end(), false) !=
      context.body_is_sound.end())
    return;
  std::vector<InputError> faults;
  check_contact_shapes(model, faults);
  if (faults.empty()) static_cast<void>(plan_surface_contacts(model, &faults));
  for (const InputError& e : faults)
    context.diagnostics.add(place_of_path(context, root, e.where()), e.where(), e.what_is_wrong(),
                            sentence(e.hint()));
}

}  // namespace polhode::io
