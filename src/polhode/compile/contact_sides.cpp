// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <set>

#include <polhode/compile/contact_sides.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/math/dense.hpp>

namespace polhode {

namespace {

/// Largest number of groups, which are bits.
constexpr std::size_t kMaxGroups = 32;

double combine(Combination way, double a, double b) {
  switch (way) {
    case Combination::mean:
      return 0.5 * (a + b);
    case Combination::minimum:
      return std::min(a, b);
    case Combination::maximum:
      return std::max(a, b);
    case Combination::product:
      return a * b;
    case Combination::geometric_mean:
      break;
  }
  return std::sqrt(a * b);
}

template <class T>
const T* pointer(const std::optional<T>& value) {
  return value ? &*value : nullptr;
}

std::string owner_path(const BodySpec& body) {
  return body.node_of.empty() ? "bodies." + body.name : "beams." + body.node_of;
}

template <class Visit>
void for_sides(const Model& model, Visit&& visit) {
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) visit(contact_side(body, s));
  for (const SolidSpec& solid : model.solids) visit(contact_side(solid));
  for (const CableLineSpec& cable : model.cables) visit(contact_side(cable));
}

/// Whether a pair of the model is that of x and y, in either order; −1 and the ground are in none.
template <class T>
bool is_pair_of(const T& x, const T& y, const T& a, const T& b) {
  return x != T(-1) && y != T(-1) && std::minmax(x, y) == std::minmax(a, b);
}

/// Side of an object with a single shape.
ContactSide side_of(const ContactSideSpec& spec, const std::string& path) {
  return {.touches = spec.touches.value_or(true),
          .material = pointer(spec.material),
          .groups = pointer(spec.groups),
          .meets = pointer(spec.meets),
          .material_path = path + "material",
          .groups_path = path + "groups",
          .meets_path = path + "meets"};
}

}  // namespace

std::string shape_path(const BodySpec& body, std::size_t shape) {
  const std::string path = format("bodies.{}.shape", body.name);
  return body.shapes.size() > 1 ? format("{}.{}", path, shape) : path;
}

geometry::ShapePlace shape_place(const BodySpec& body, const ShapeSpec& shape) {
  geometry::ShapePlace place{shape.position - body.com,
                             shape.orientation.normalized().toRotationMatrix()};
  if (shape.type == "plane") {
    const Vec3 n(shape.sizes[0], shape.sizes[1], shape.sizes[2]);
    place.axes = place.axes * rotation_between(Vec3::UnitZ(), n).toRotationMatrix();
  }
  if (!body.fixed) return place;
  const Mat3 R = body.orientation.normalized().toRotationMatrix();
  return {body.position + R * place.origin, R * place.axes};
}

ContactSide contact_side(const BodySpec& body, std::size_t shape) {
  const ContactSideSpec &own = body.shapes[shape].contact, &all = body.contact;
  const auto stated = [&](auto key, const char* name, std::string* path) {
    if (path)
      *path = own.*key ? format("{}.contact.{}", shape_path(body, shape), name)
                       : format("{}.contact.{}", owner_path(body), name);
    return pointer(own.*key ? own.*key : all.*key);
  };
  ContactSide side;
  if (own.touches || all.touches) side.touches = own.touches ? *own.touches : *all.touches;
  side.material = stated(&ContactSideSpec::material, "material", &side.material_path);
  side.groups = stated(&ContactSideSpec::groups, "groups", &side.groups_path);
  side.meets = stated(&ContactSideSpec::meets, "meets", &side.meets_path);
  return side;
}

ContactSide contact_side(const SolidSpec& solid) {
  return side_of(solid.contact, format("solids.{}.contact.", solid.name));
}

ContactSide contact_side(const CableLineSpec& cable) {
  const std::string path = format("cables.{}.contact.", cable.name);
  if (cable.contact) return side_of(cable.contact->side, path);
  ContactSide nothing = side_of({}, path);
  nothing.touches = false;
  return nothing;
}

bool has_touching_cables(const Model& model) {
  return std::any_of(model.cables.begin(), model.cables.end(),
                     [](const CableLineSpec& cable) { return contact_side(cable).touches; });
}

int material_of(const ContactsSpec& contacts, const ContactSide& side) {
  for (std::size_t k = 0; side.material && k < contacts.materials.size(); ++k)
    if (contacts.materials[k].name == *side.material) return static_cast<int>(k);
  return -1;
}

ContactGroups::ContactGroups(const Model& model, std::vector<InputError>* faults) {
  for_sides(model, [&](const ContactSide& side) {
    if (!side.groups) return;
    for (const std::string& name : *side.groups) {
      if (bits_.contains(name)) continue;
      if (bits_.size() < kMaxGroups)
        bits_.emplace(name, 1U << bits_.size());
      else if (faults)
        faults->emplace_back(side.groups_path, format("'{}' is one contact group too many", name),
                             format("Use at most {}, 'default' among them", kMaxGroups));
    }
  });
  if (!faults) return;
  std::vector<std::string> names;
  for (const auto& [name, bit] : bits_) names.push_back(name);
  std::set<std::string> reported;
  for_sides(model, [&](const ContactSide& side) {
    if (!side.meets) return;
    for (const std::string& name : *side.meets)
      if (!bits_.contains(name) && reported.insert(side.meets_path + name).second)
        faults->emplace_back(side.meets_path, format("no shape belongs to the group '{}'", name),
                             did_you_mean(name, names) + "Groups: " + name_list(names));
  });
}

std::uint32_t ContactGroups::mask(const std::vector<std::string>* names,
                                  std::uint32_t otherwise) const {
  if (!names) return otherwise;
  std::uint32_t sum = 0;
  for (const std::string& name : *names)
    if (const auto found = bits_.find(name); found != bits_.end()) sum |= found->second;
  return sum;
}

StatedLaw law_between(const ContactsSpec& contacts, const ContactLawKey& x,
                      const ContactLawKey& y) {
  for (const bool of_materials : {false, true})
    for (const ContactPairSpec& pair : contacts.pairs) {
      if (pair.of_materials != of_materials) continue;
      const bool found =
          of_materials ? is_pair_of(x.material, y.material, pair.materials[0], pair.materials[1])
                       : is_pair_of(x.side, y.side, pair.a, pair.b);
      if (found) return {pair.law, &pair};
    }
  ContactLawSpec law = contacts.standard;
  const ContactMaterialSpec both = combined_surface(contacts, x.material, y.material);
  law.friction = both.friction;
  law.restitution = both.restitution;
  if (law.static_friction < law.friction) law.static_friction = 0.0;
  return {law, nullptr};
}

ContactMaterialSpec combined_surface(const ContactsSpec& contacts, int a, int b) {
  const auto of = [&](int i) {
    if (i >= 0) return contacts.materials[static_cast<std::size_t>(i)];
    ContactMaterialSpec standard;
    standard.friction = contacts.standard.friction;
    standard.restitution = contacts.standard.restitution;
    return standard;
  };
  if (a < 0 && b < 0) return of(-1);
  ContactMaterialSpec both;
  both.friction = combine(contacts.friction, of(a).friction, of(b).friction);
  both.restitution = combine(contacts.restitution, of(a).restitution, of(b).restitution);
  return both;
}

}  // namespace polhode
