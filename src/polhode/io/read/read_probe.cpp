// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/read/read_context.hpp>
#include <polhode/simulation/momentum_columns.hpp>

namespace polhode::io {

namespace {

/// Name of the object of a probe, one of `names`.
std::string read_target(ReadContext& context, Section& section, const std::string& kind,
                        const std::vector<std::string>& names) {
  const auto name = section.text(kind);
  if (!name) return {};
  if (std::find(names.begin(), names.end(), *name) == names.end()) {
    std::string title = kind;
    title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0])));
    const std::string list = names.empty() ? format("The model has no {}s.", kind)
                                           : format("{}s: {}.", title, name_list(names));
    context.fault(*section.find(kind), section.path(kind),
                  format("unknown {} {}", kind, quote(*name)), did_you_mean(*name, names) + list);
  }
  return *name;
}

/// Reads the element of a beam or the segment of a cable.
void read_line_probe(ReadContext& context, Section& section, ProbeSpec& probe) {
  std::vector<std::string> names;
  const Model& model = context.model;
  std::size_t count = 0;
  const bool beam = probe.kind == "beam";
  const auto take = [&](const std::string& name, std::size_t pieces) {
    names.push_back(name);
    if (name == probe.target) count = pieces;
  };
  if (const SourceNode* node = section.find(probe.kind); node->is_text()) probe.target = node->text;
  for (const BeamSpec& b : model.beams)
    if (beam) take(b.name, b.mesh.size());
  for (const CableLineSpec& c : model.cables)
    if (!beam) take(c.name, c.pieces.size());
  read_target(context, section, probe.kind, names);
  probe.element = section.integer("element").value_or(0);
  if (count > 0 && static_cast<std::size_t>(std::max(0, probe.element)) >= count)
    section.fault(
        "element",
        format("is {}, but the last of {} is {}", probe.element, quote(probe.target), count - 1),
        "The first is 0.");
}

/// Reads a point, a node or an interface of a solid.
void read_solid_probe(ReadContext& context, Section& section, ProbeSpec& probe) {
  const auto solid = read_solid_name(context, *section.find("solid"), section.path("solid"));
  const auto point = section.vector("point");
  const auto node = section.integer("node");
  const auto interface = section.text("interface");
  if (section.refuse_both("point", "node", "Give one of them.") ||
      section.refuse_both("point", "interface", "Give one of them.") ||
      section.refuse_both("node", "interface", "Give one of them.") || !solid)
    return;
  const SolidSpec& spec = context.model.solids[static_cast<std::size_t>(*solid)];
  probe.target = spec.name;
  if (!section.has("point") && !section.has("node") && !section.has("interface"))
    section.fault("gives no point of the solid", "Give one of: point, node, interface.");
  if (point) probe.point = *point;
  probe.node = node;
  probe.stress = section.boolean("stress").value_or(false);
  if (probe.stress && interface)
    section.fault("stress", "cannot be combined with 'interface'",
                  "Give a point or a node of the solid.");
  if (!interface) return;
  std::vector<std::string> names;
  for (const BondSpec& bond : spec.bonded) names.push_back(context.model.body_name(bond.body));
  for (const PrescribedSpec& prescribed : spec.prescribed) names.push_back(prescribed.name);
  probe.reaction_of = *interface;
  if (const auto body = context.bodies.find(*interface); body != context.bodies.end())
    probe.reaction_of = context.model.body_name(body->second);  // mast.end has a number, too
  if (std::find(names.begin(), names.end(), probe.reaction_of) == names.end())
    section.fault(
        "interface",
        format("the solid {} has no interface {}", quote(spec.name), quote(*interface)),
        did_you_mean(*interface, names) +
            (names.empty() ? "It is bonded to nothing." : "Interfaces: " + name_list(names) + "."));
}

/// Reads two bodies with shapes, solids or cables, in a model with contact.
void read_contact_probe(ReadContext& context, Section& section, ProbeSpec& probe) {
  const auto pair = read_side_pair(context, *section.find("contact"), section.path("contact"));
  if (!pair) return;
  if (!context.model.contacts.present) {
    section.fault("contact", "the model has no contacts", "Add 'contacts: {}'.");
    return;
  }
  for (const Side& side : *pair) {
    if (side.is_solid()) continue;
    if (side.is_cable()) {
      const CableLineSpec& cable = context.model.cables[static_cast<std::size_t>(side.index)];
      if (cable.contact) continue;
      section.fault("contact", format("the cable {} does not touch", quote(cable.name)),
                    "Give it contact: {radius: ...}, or leave the probe out.");
      return;
    }
    const bool ground = side == kGround;
    if (!ground && !context.model.bodies[static_cast<std::size_t>(side.index)].shapes.empty())
      continue;
    section.fault(
        "contact",
        ground ? std::string("the ground has no shapes")
               : format("the body {} has no shape",
                        quote(context.model.bodies[static_cast<std::size_t>(side.index)].name)),
        ground ? "Name a fixed body with a shape." : "Give it a shape, or leave the probe out.");
    return;
  }
  probe.pair = *pair;
}

/// Reads the body of a momentum, or the beginning of the names of several and a star.
void read_momentum_probe(ReadContext& context, Section& section, ProbeSpec& probe) {
  const auto name = section.text("momentum");
  if (!name) return;
  probe.target = *name;
  std::vector<std::string> names;
  for (const BodySpec& body : context.model.bodies)
    if (!body.fixed) names.push_back(body.name);
  try {
    (void)bodies_with_momentum(context.model, *name, section.path("momentum"));
  } catch (const InputError& e) {
    section.fault("momentum", e.what_is_wrong(), did_you_mean(*name, names) + e.hint() + ".");
  }
}

/// Further columns of a body.
void read_body_columns(Section& section, ProbeSpec& probe) {
  const auto rotation = section.text("rotation");
  const bool euler =
      rotation && *rotation != "quaternion" && *rotation != "vector" && *rotation != "matrix";
  if (euler && rotation->size() != 3)
    section.fault("rotation", format("is {}", quote(*rotation)),
                  "Write quaternion, vector, matrix, or an Euler sequence such as zyx.");
  else if (rotation && (!euler || check_euler_sequence(section, *rotation, "rotation")))
    probe.rotation = *rotation;
  probe.angular = section.boolean("angular").value_or(false);
  if (probe.axes == "body" && !probe.angular)
    section.fault("axes", "are those of the angular motion, which is not recorded",
                  "Add angular: true.");
  probe.helical = section.choice("helical").value_or("");
  probe.seen_from = section.body("seen_from").value_or(kGround);
}

}  // namespace

bool read_recorded(ReadContext& context, Section& section, const std::vector<std::string>& kinds,
                   const char* what, ProbeSpec& probe) {
  const std::size_t before = context.diagnostics.size();
  int targets = 0;
  for (const std::string& kind : kinds) {
    if (!section.has(kind)) continue;
    probe.kind = kind;
    ++targets;
  }
  if (targets != 1) {
    if (targets > 0 || !section.has_unknown_key())
      section.fault(targets == 0 ? format("names no object {}", what)
                                 : format("names more than one object {}", what),
                    format("Give one of: {}.", name_list(kinds)));
    return false;
  }
  if (section.has("point") && probe.kind != "body" && probe.kind != "solid")
    section.fault("point", format("cannot be combined with '{}'", probe.kind),
                  "A point belongs to a body or a solid.");
  for (const char* key : {"node", "stress", "interface"})
    if (section.has(key) && probe.kind != "solid")
      section.fault(key, format("cannot be combined with '{}'", probe.kind),
                    "It belongs to a solid.");
  if (section.has("element") && probe.kind != "beam" && probe.kind != "cable")
    section.fault("element", format("cannot be combined with '{}'", probe.kind),
                  "It belongs to a beam or a cable.");
  for (const char* key : {"rotation", "angular", "helical", "seen_from"})
    if (section.has(key) && probe.kind != "body")
      section.fault(key, format("cannot be combined with '{}'", probe.kind),
                    "It belongs to a body.");
  if (const auto axes = section.choice("axes")) probe.axes = *axes;
  if (probe.axes != "world" && probe.axes != (probe.kind == "joint" ? "joint" : "body"))
    section.fault("axes", format("'{}' cannot be combined with '{}'", probe.axes, probe.kind),
                  "A joint's reaction has the axes world or joint, a body's motion world or body.");
  else if (section.has("axes") && probe.kind != "joint" && probe.kind != "body" &&
           probe.kind != "momentum")
    section.fault("axes", format("cannot be combined with '{}'", probe.kind),
                  "Axes belong to a joint's reaction, a body's angular motion and a momentum.");
  if (probe.kind == "body") {
    const auto body = section.body("body");
    const auto point = section.vector("point");
    if (!body) return false;
    const std::size_t faults = context.diagnostics.size();
    read_body_columns(section, probe);
    if (*body == kGround && probe.seen_from == kGround) {
      if (context.diagnostics.size() == faults)
        section.fault("body", "the ground does not move",
                      "Name a body, or the one that it is seen_from.");
      return false;
    }
    probe.target = context.model.body_name(*body);
    if (point)
      probe.point = *body == kGround
                        ? *point
                        : Vec3(*point - context.model.bodies[static_cast<std::size_t>(*body)].com);
  } else if (probe.kind == "solid") {
    read_solid_probe(context, section, probe);
  } else if (probe.kind == "beam" || probe.kind == "cable") {
    read_line_probe(context, section, probe);
  } else if (probe.kind == "contact") {
    read_contact_probe(context, section, probe);
  } else if (probe.kind == "controller") {
    probe.target = read_target(context, section, "controller", context.controllers);
  } else if (probe.kind == "momentum") {
    read_momentum_probe(context, section, probe);
  } else if (probe.kind == "joint") {
    probe.target = read_target(context, section, "joint", context.joint_names());
  } else {
    probe.target = read_target(context, section, "load", context.load_names());
  }
  return context.diagnostics.size() == before;
}

}  // namespace polhode::io
