// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

/// A force on all mass: the values of FEBio, which are minus the acceleration.
struct BodyForce {
  const Element* at;
  std::array<FebValue, 3> values;
};

/// A body force as forces at the centres of the meshes.
void add_weights(FebModel& model, const BodyForce& force) {
  const NodeBuilder make = model.file.make(*force.at);
  for (const FebBody& body : model.bodies) {
    if (body.is_fixed() || !(body.mesh.mass > 0.0)) continue;
    SourceNode load = make.map();
    make.put(load, "type", make.text("force"));
    make.put(load, "body", make.text(body.name));
    if (!body.is_centred()) make.put(load, "at", make.vector(body.mesh.com));
    make.put(load, "force", model.vector(*force.at, force.values, -body.mesh.mass));
    model.add_load(*force.at, body.name + "_weight", std::move(load));
  }
}

}  // namespace

void read_feb_loads(FebModel& model, const Element& section) {
  FebFile& file = model.file;
  std::vector<BodyForce> forces;
  for (const Element* e : file.xml.children(section, "body_load")) {
    const std::string type = file.type(*e);
    file.ignored.attributes(*e, {"name"});
    if (const auto part = file.xml.text(*e, "elem_set"); part && !part->empty()) {
      file.refuse(*e, format("a body force on the elements {} alone is not read", quote(*part)),
                  "Apply it to all elements.");
    } else if (type == "body force") {
      forces.push_back({e, file.vector_value(*e, "force")});
    } else if (type == "const") {
      forces.push_back({e, {file.value(*e, "x"), file.value(*e, "y"), file.value(*e, "z")}});
    } else if (!type.empty()) {
      file.refuse(*e, format("a body load of type {} is not read", quote(type)),
                  "Use a body force, or add a load to the model.");
    }
  }
  for (const Element* e : file.xml.children(section, "nodal_load"))
    model.solids.read_nodal_load(*e);
  for (const Element* e : file.xml.children(section, "surface_load"))
    model.solids.read_surface_load(*e);
  for (const Element* e : file.xml.children(section, "edge_load"))
    file.refuse(*e, "<edge_load> is not read", "Use nodal loads.");
  bool plain = model.step == nullptr &&
               std::all_of(model.bodies.begin(), model.bodies.end(), [](const FebBody& b) {
                 return b.is_fixed() || (b.mesh.mass > 0.0 && b.is_centred());
               });
  for (const BodyForce& force : forces)
    for (const FebValue& value : force.values) plain = plain && value.is_constant();
  for (const BodyForce& force : forces) {
    if (!plain) {
      add_weights(model, force);
      model.solids.add_body_force(*force.at, force.values);
      continue;
    }
    for (int k = 0; k < 3; ++k)
      model.gravity[k] -= force.values[static_cast<std::size_t>(k)].factor;
  }
}

}  // namespace polhode::io
