// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

namespace {

using Element = XmlFile::Element;

}  // namespace

bool FebSolids::put_isotropic(const Element& e, const NodeBuilder& make, SourceNode& node) {
  FebFile& file = model_.file;
  const auto E = file.number(e, "E"), v = file.number(e, "v");
  if (!E || !v) {
    if (file.child(e, "E") == nullptr || file.child(e, "v") == nullptr)
      file.xml.fault(e, "the material has no <E> or <v>", "Give both.");
    return false;
  }
  make.put(node, "youngs_modulus", make.number(*E));
  make.put(node, "poisson_ratio", make.number(*v));
  return true;
}

bool FebSolids::put_fibre(const Element& e, const NodeBuilder& make, SourceNode& node) {
  FebFile& file = model_.file;
  if (const Element* active = file.child(e, "active_contraction"))
    file.refuse(*active, "<active_contraction> is not read", "Add a muscle to the model.");
  const Element* direction = file.child(e, "fiber");
  const std::string type = direction == nullptr ? "" : file.type(*direction);
  std::optional<Vec3> a;
  if (type == "vector") {
    if (file.child(*direction, "vector") != nullptr)
      a = file.direction(*direction, "vector", Vec3::UnitX());
    else if (const auto text = XmlFile::content(*direction))
      a = file.direction(e, "fiber", Vec3::UnitX());
  }
  if (!a) {
    file.refuse(direction == nullptr ? e : *direction,
                "only fibres of type \"vector\" are read, which are the same everywhere",
                "Give <fiber type=\"vector\">.");
    return false;
  }
  SourceNode fibre = make.map();
  make.put(fibre, "law", make.text("toe"));
  make.put(fibre, "c3", make.number(file.number(e, "c3").value_or(0.0)));
  make.put(fibre, "c4", make.number(file.number(e, "c4").value_or(0.0)));
  make.put(fibre, "c5", make.number(file.number(e, "c5").value_or(0.0)));
  make.put(fibre, "straight_stretch", make.number(file.number(e, "lam_max").value_or(1.0)));
  make.put(fibre, "direction", make.direction(*a));
  make.put(node, "fibre", std::move(fibre));
  return true;
}

void FebSolids::read_material(const Element& e, const std::string& type) {
  FebFile& file = model_.file;
  const std::string given = file.xml.text(e, "name").value_or("");
  const auto id = file.id(e);
  const std::string name = given.empty() ? format("material{}", id.value_or(0)) : given;
  const NodeBuilder make = file.make(e);
  FebMaterial material;
  material.node = make.map();
  const auto put = [&](const char* kind) { make.put(material.node, "type", make.text(kind)); };
  const auto number = [&](const char* tag) { return file.number(e, tag).value_or(0.0); };
  const double density = file.number(e, "density").value_or(1.0);
  bool sound = true;
  if (type == "neo-hookean") {
    put("neo_hookean");
    sound = put_isotropic(e, make, material.node);
  } else if (type == "isotropic elastic" || type == "st.venant-kirchhoff") {
    put("elastic");
    sound = put_isotropic(e, make, material.node);
  } else if (type == "mooney-rivlin" || type == "trans iso mooney-rivlin") {
    put("mooney_rivlin_uncoupled");
    make.put(material.node, "c1", make.number(number("c1")));
    make.put(material.node, "c2", make.number(number("c2")));
    make.put(material.node, "bulk_modulus", make.number(number("k")));
    material.uncoupled = true;
    if (type == "trans iso mooney-rivlin") sound = put_fibre(e, make, material.node);
  } else if (type == "coupled mooney-rivlin") {
    put("mooney_rivlin");
    make.put(material.node, "c1", make.number(number("c1")));
    make.put(material.node, "c2", make.number(number("c2")));
    // The bulk term of FEBio is k/2 ln(J)^2, that of the model (lame - 4 c2)/2 ln(J)^2.
    make.put(material.node, "lame", make.number(number("k") + 4.0 * number("c2")));
  } else {
    file.refuse(e, format("the material {} of type {} is not read", quote(name), quote(type)),
                "Materials are rigid body, neo-Hookean, isotropic elastic, St.Venant-Kirchhoff, "
                "Mooney-Rivlin, trans iso Mooney-Rivlin and coupled Mooney-Rivlin.");
    return;
  }
  make.put(material.node, "density", make.number(density));
  if (materials_.contains(name)) {
    file.xml.fault(e, format("the material {} stands twice", quote(name)), "Rename one of them.");
    return;
  }
  if (!sound) return;
  material.name = file.name(e, name, material_names_);
  materials_.emplace(name, std::move(material));
}

}  // namespace polhode::io
