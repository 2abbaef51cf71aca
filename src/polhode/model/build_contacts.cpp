// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <polhode/base/format.hpp>
#include <polhode/base/names.hpp>
#include <polhode/body/shapes.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/model/beam_contact.hpp>
#include <polhode/model/build_contacts.hpp>
#include <polhode/model/shape_surface.hpp>

namespace polhode {

namespace {

/// Triangles around a tube, which touches as a mesh.
constexpr int kTubeSegments = 48;
/// Groups are bits.
constexpr std::size_t kMostGroups = 32;

std::string path_of(const BodySpec& body, std::size_t shape) {
  const std::string path = format("bodies.{}.shape", body.name);
  return body.shapes.size() > 1 ? format("{}.{}", path, shape) : path;
}

/// A key of the shape, or else of its body, with its path.
template <class T>
const T* stated(const BodySpec& body, const ShapeSpec& shape,
                std::optional<T> ContactSideSpec::*key) {
  if (shape.contact.*key) return &*(shape.contact.*key);
  return body.contact.*key ? &*(body.contact.*key) : nullptr;
}

bool touches(const BodySpec& body, const ShapeSpec& shape) {
  const bool* stated_touches = stated(body, shape, &ContactSideSpec::touches);
  return !stated_touches || *stated_touches;
}

/// A node has its beam's name and a number.
std::string owner_path(const BodySpec& body) {
  const std::size_t dot = body.name.find('.');
  return dot == std::string::npos ? "bodies." + body.name : "beams." + body.name.substr(0, dot);
}

std::string side_path(const BodySpec& body, std::size_t s, bool of_shape, const char* key) {
  return of_shape ? format("{}.contact.{}", path_of(body, s), key)
                  : format("{}.contact.{}", owner_path(body), key);
}

/// Where a shape stands in the coordinates of contact: from the centre of mass in body axes, or the
/// world's for what stands still.
contact::ShapePlace place_of(const BodySpec& body, const ShapeSpec& shape) {
  contact::ShapePlace place{shape.position - body.com,
                            shape.orientation.normalized().toRotationMatrix()};
  if (shape.type == "plane") {
    const Vec3 n(shape.sizes[0], shape.sizes[1], shape.sizes[2]);
    place.axes = place.axes * Quat::FromTwoVectors(Vec3::UnitZ(), n).toRotationMatrix();
  }
  if (!body.fixed) return place;
  const Mat3 R = body.orientation.normalized().toRotationMatrix();
  return {body.position + R * place.origin, R * place.axes};
}

contact::Shape contact_shape(const std::string& where, const BodySpec& body,
                             const ShapeSpec& shape) {
  contact::ShapePlace place = place_of(body, shape);
  const std::vector<double>& size = shape.sizes;
  const std::string& type = shape.type;
  if (type == "sphere") return contact::sphere(where, size[0], place);
  if (type == "capsule") {
    const double straight = size[1] - size[0];
    return straight > 1e-12 * size[1] ? contact::capsule(where, size[0], straight, place)
                                      : contact::sphere(where, size[0], place);
  }
  if (type == "box") return contact::box(where, {size[0], size[1], size[2]}, place);
  if (type == "ellipsoid") return contact::ellipsoid(where, {size[0], size[1], size[2]}, place);
  if (type == "cylinder") return contact::cylinder(where, size[0], size[1], place);
  if (type == "cone") {
    // The model file counts from the centroid, a quarter of the length above the base.
    place.origin += 0.25 * size[1] * place.axes.col(2);
    return contact::cone(where, size[0], size[1], place);
  }
  if (type == "plane") return contact::plane(place);
  if (type == "hull") return contact::hull(where, hull_points(shape), place);
  if (type == "height_field")
    return contact::height_field(where, shape.columns, shape.spacing, shape.heights, place);
  return contact::mesh(where, shape_surface(where, shape, kTubeSegments), place);
}

/// Bits of the groups by name; 'default' is the first.
std::map<std::string, std::uint32_t> group_bits(const Model& model,
                                                std::vector<InputError>* faults) {
  std::map<std::string, std::uint32_t> bits{{"default", 1U}};
  const auto add = [&](const std::vector<std::string>* names, const std::string& where) {
    if (!names) return;
    for (const std::string& name : *names) {
      if (bits.contains(name)) continue;
      if (bits.size() < kMostGroups)
        bits.emplace(name, 1U << bits.size());
      else if (faults)
        faults->emplace_back(where, format("'{}' is one contact group too many", name),
                             format("Use at most {}, 'default' among them", kMostGroups));
    }
  };
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      const ShapeSpec& shape = body.shapes[s];
      add(stated(body, shape, &ContactSideSpec::groups),
          side_path(body, s, shape.contact.groups.has_value(), "groups"));
    }
  return bits;
}

/// A group that is met but that nothing belongs to is a slip of the pen.
void check_met_groups(const Model& model, const std::map<std::string, std::uint32_t>& bits,
                      std::vector<InputError>& faults) {
  std::vector<std::string> names;
  for (const auto& [name, bit] : bits) names.push_back(name);
  std::set<std::string> told;
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      const ShapeSpec& shape = body.shapes[s];
      const auto* meets = stated(body, shape, &ContactSideSpec::meets);
      if (!meets) continue;
      const std::string where = side_path(body, s, shape.contact.meets.has_value(), "meets");
      for (const std::string& name : *meets)
        if (!bits.contains(name) && told.insert(where + name).second)
          faults.emplace_back(where, format("no shape belongs to the group '{}'", name),
                              did_you_mean(name, names) + "Groups: " + name_list(names));
    }
}

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

contact::ContactLaw contact_law(const ContactLawSpec& spec) {
  contact::ContactLaw law;
  using contact::NormalPotential;
  law.potential = spec.potential == "linear"  ? NormalPotential::linear
                  : spec.potential == "hertz" ? NormalPotential::hertz
                                              : NormalPotential::barrier;
  law.stiffness = spec.stiffness;
  law.tolerance = spec.gap_tolerance;
  law.reference_load = spec.reference_load;
  law.restitution = spec.restitution;
  law.damped = spec.rebound == "damped";
  law.friction.mu = spec.friction;
  law.friction.mu_static = spec.static_friction;
  law.friction.mu_across = spec.friction_across;
  law.friction.direction = spec.direction;
  law.friction.rolling = spec.rolling;
  law.friction.torsion = spec.torsion;
  law.friction.stiffness = spec.friction_stiffness;
  law.friction.damping = spec.friction_damping;
  return law;
}

/// What decides the law of a shape: its material, and its body if a pair names it.
struct SurfaceClass {
  int material = -1, body = -1;
  auto operator<=>(const SurfaceClass&) const = default;
};

class ContactsBuilder {
 public:
  ContactsBuilder(const Model& model, const std::vector<int>& bodies, ContactMap& map)
      : model_(model),
        spec_(model.contacts),
        bodies_(bodies),
        map_(map),
        set_(std::make_shared<contact::ContactSet>()) {}

  std::shared_ptr<contact::ContactSet> build() {
    for (const ContactPairSpec& pair : spec_.pairs)
      if (!pair.of_materials) named_.insert({pair.a, pair.b});
    add_shapes();
    add_laws();
    exclude();
    keep_pairs();
    return set_;
  }

 private:
  void add_shapes() {
    const auto bits = group_bits(model_, nullptr);
    const auto mask = [&](const std::vector<std::string>* names, std::uint32_t otherwise) {
      if (!names) return otherwise;
      std::uint32_t sum = 0;
      for (const std::string& name : *names)
        if (const auto found = bits.find(name); found != bits.end()) sum |= found->second;
      return sum;
    };
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const BodySpec& body = model_.bodies[b];
      for (std::size_t s = 0; s < body.shapes.size(); ++s) {
        const ShapeSpec& shape = body.shapes[s];
        if (!touches(body, shape)) continue;
        contact::PlacedShape placed;
        placed.body = bodies_[b];
        placed.owner = static_cast<int>(b);
        placed.name = body.shapes.size() > 1 ? format("{}.{}", body.name, s) : body.name;
        placed.shape = contact_shape(path_of(body, s), body, shape);
        placed.groups = mask(stated(body, shape, &ContactSideSpec::groups), 1U);
        placed.meets = mask(stated(body, shape, &ContactSideSpec::meets), 0xffffffffU);
        placed.material = surface(body, shape, static_cast<int>(b));
        set_->add_shape(std::move(placed));
        map_.body.push_back(static_cast<int>(b));
      }
    }
  }

  /// Number of the shape's class.
  int surface(const BodySpec& body, const ShapeSpec& shape, int index) {
    SurfaceClass key;
    if (const std::string* name = stated(body, shape, &ContactSideSpec::material))
      for (std::size_t k = 0; k < spec_.materials.size(); ++k)
        if (spec_.materials[k].name == *name) key.material = static_cast<int>(k);
    if (std::any_of(named_.begin(), named_.end(),
                    [&](const auto& p) { return p.first == index || p.second == index; }))
      key.body = index;
    const auto [at, fresh] = classes_.try_emplace(key, static_cast<int>(classes_.size()));
    if (fresh) set_->add_material({format("class {}", at->second), 0.0, 0.0});
    return at->second;
  }

  void add_laws() {
    set_->set_default(contact_law(spec_.standard));
    for (const auto& [x, i] : classes_)
      for (const auto& [y, j] : classes_)
        if (i <= j) set_->set_law(i, j, law_of(x, y));
  }

  /// A pair of bodies goes before a pair of materials, that before their combination.
  [[nodiscard]] contact::ContactLaw law_of(const SurfaceClass& x, const SurfaceClass& y) const {
    for (const bool of_materials : {false, true})
      for (const ContactPairSpec& pair : spec_.pairs) {
        if (pair.of_materials != of_materials) continue;
        const int a = of_materials ? x.material : x.body, b = of_materials ? y.material : y.body;
        if (a < 0 || b < 0 || std::minmax(a, b) != std::minmax(pair.a, pair.b)) continue;
        contact::ContactLaw law = contact_law(pair.law);
        law.sensor = pair.sensor;
        return law;
      }
    ContactLawSpec law = spec_.standard;
    const ContactMaterialSpec both = combined_surface(spec_, x.material, y.material);
    law.friction = both.friction;
    law.restitution = both.restitution;
    if (law.static_friction < law.friction) law.static_friction = 0.0;
    return contact_law(law);
  }

  void exclude() {
    for (const auto& [a, b] : spec_.excluded) excluded_.insert(std::minmax(a, b));
    if (!spec_.joint_neighbours)
      for (const JointSpec& joint : model_.joints)
        if (joint.a != kGround && joint.b != kGround)
          excluded_.insert(std::minmax(joint.a, joint.b));
    for (const auto& [a, b] : beam_neighbours(model_)) excluded_.insert(std::minmax(a, b));
    // A pair that is named is meant.
    for (const ContactPairSpec& pair : spec_.pairs)
      if (!pair.of_materials) excluded_.erase(std::minmax(pair.a, pair.b));
    for (const auto& [a, b] : spec_.excluded) excluded_.insert(std::minmax(a, b));
    for (const auto& [a, b] : excluded_) set_->exclude(a, b);
  }

  [[nodiscard]] bool may_meet(int a, int b) const {
    const std::vector<contact::PlacedShape>& shapes = set_->shapes();
    for (int i : shapes_of_[static_cast<std::size_t>(a)])
      for (int j : shapes_of_[static_cast<std::size_t>(b)])
        if (set_->may_meet(shapes[static_cast<std::size_t>(i)],
                           shapes[static_cast<std::size_t>(j)]))
          return true;
    return false;
  }

  void keep_pairs() {
    std::set<std::pair<int, int>> kept;
    const auto keep = [&](int a, int b, const std::string& sensor) {
      if (kept.insert(std::minmax(a, b)).second) map_.pairs.push_back({a, b, sensor});
    };
    for (const ContactPairSpec& pair : spec_.pairs)
      if (!pair.of_materials) keep(pair.a, pair.b, pair.sensor ? pair.name : "");
    for (const ProbeSpec& probe : model_.output.probes)
      if (probe.kind == "contact") keep(probe.pair[0], probe.pair[1], "");
    if (!spec_.record.value_or(true)) return;
    shapes_of_.resize(model_.bodies.size());
    for (int i = 0; i < static_cast<int>(map_.body.size()); ++i)
      shapes_of_[static_cast<std::size_t>(map_.body[static_cast<std::size_t>(i)])].push_back(i);
    std::vector<std::pair<int, int>> found;
    for (int a = 0; a < static_cast<int>(shapes_of_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(shapes_of_.size()); ++b) {
        if (!may_meet(a, b)) continue;
        found.emplace_back(a, b);
        if (!spec_.record && static_cast<int>(found.size()) > kMostContactPairs) return;
      }
    for (const auto& [a, b] : found) keep(a, b, "");
    map_.all_pairs = true;
  }

  const Model& model_;
  const ContactsSpec& spec_;
  const std::vector<int>& bodies_;
  ContactMap& map_;
  std::shared_ptr<contact::ContactSet> set_;
  std::set<std::pair<int, int>> named_, excluded_;
  std::map<SurfaceClass, int> classes_;
  std::vector<std::vector<int>> shapes_of_;
};

void check_material(const Model& model, const BodySpec& body, std::size_t s,
                    std::vector<InputError>& faults, std::set<std::string>& told) {
  const ShapeSpec& shape = body.shapes[s];
  const std::string* name = stated(body, shape, &ContactSideSpec::material);
  if (!name) return;
  std::vector<std::string> names;
  for (const ContactMaterialSpec& m : model.contacts.materials) names.push_back(m.name);
  if (std::find(names.begin(), names.end(), *name) != names.end()) return;
  const std::string where = side_path(body, s, shape.contact.material.has_value(), "material");
  if (told.insert(where).second)
    faults.emplace_back(where, format("unknown contact material '{}'", *name),
                        names.empty()
                            ? std::string("contacts.materials lists none")
                            : did_you_mean(*name, names) + "Materials: " + name_list(names));
}

/// What needs no shape to be made.
void check_sides(const Model& model, std::vector<InputError>& faults) {
  std::set<std::string> told;
  bool any = false;
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      if (!touches(body, body.shapes[s])) continue;
      any = any || !body.fixed;
      check_material(model, body, s, faults, told);
      if (body.point_mass && !body.fixed) {
        faults.emplace_back(path_of(body, s), "a point mass cannot touch: contact would turn it",
                            "Give the body an inertia, or contact: {touches: false}");
      }
    }
  check_met_groups(model, group_bits(model, &faults), faults);
  if (!any)
    faults.emplace_back("contacts", "no body that moves has a shape that touches",
                        "Give bodies shapes, or leave 'contacts' out");
}

}  // namespace

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

void check_contact_shapes(const Model& model, std::vector<InputError>& faults) {
  check_sides(model, faults);
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      if (!touches(body, body.shapes[s])) continue;
      const std::string path = path_of(body, s);
      try {
        static_cast<void>(contact_shape(path, body, body.shapes[s]));
      } catch (const InputError& e) {
        const bool of_file = e.where() != path;
        faults.emplace_back(path, (of_file ? e.where() + ": " : "") + e.what_is_wrong(),
                            of_file ? "Contact needs a closed surface: mend it in the program that "
                                      "made it, or set contact: {touches: false}"
                                    : e.mend());
      }
    }
}

std::shared_ptr<contact::ContactSet> build_contacts(const Model& model,
                                                    const std::vector<int>& bodies,
                                                    ContactMap& map) {
  if (!model.contacts.present) return nullptr;
  std::vector<InputError> faults;
  check_sides(model, faults);
  if (!faults.empty()) throw InputError(faults.front());
  return ContactsBuilder(model, bodies, map).build();
}

}  // namespace polhode
