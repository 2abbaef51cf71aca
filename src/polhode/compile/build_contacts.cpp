// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <polhode/compile/beam_contact.hpp>
#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/contact_shapes.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/compile/nonsmooth_contacts.hpp>
#include <polhode/compile/shape_surface.hpp>
#include <polhode/contact/contact_set.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/model/switched_contacts.hpp>

namespace polhode {

namespace {

contact::ContactLaw contact_law(const ContactLawSpec& spec) {
  contact::ContactLaw law;
  law.potential = contact::potential_of(spec.potential).value_or(contact::NormalPotential::barrier);
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
      if (of_bodies(pair)) named_.insert({pair.a.index, pair.b.index});
    add_shapes();
    add_laws();
    exclude();
    shapes_of_.resize(model_.bodies.size());
    for (int i = 0; i < static_cast<int>(map_.body.size()); ++i)
      shapes_of_[static_cast<std::size_t>(map_.body[static_cast<std::size_t>(i)])].push_back(i);
    // Only surfaces of solids are in contact, or stops of joints are rows.
    if ((has_surfaces() || set_->shapes().empty()) && !any_may_meet()) {
      map_.body.clear();
      return nullptr;
    }
    keep_pairs();
    add_switches();
    return set_;
  }

 private:
  [[nodiscard]] static bool of_bodies(const ContactPairSpec& pair) {
    return !pair.of_materials && pair.a.is_body() && pair.b.is_body();
  }
  [[nodiscard]] bool has_surfaces() const {
    return !model_.solids.empty() || has_touching_cables(model_);
  }
  [[nodiscard]] bool any_may_meet() const {
    for (int a = 0; a < static_cast<int>(shapes_of_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(shapes_of_.size()); ++b)
        if (may_meet(a, b)) return true;
    return false;
  }
  void add_shapes() {
    const ContactGroups groups(model_);
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      const BodySpec& body = model_.bodies[b];
      for (std::size_t s = 0; s < body.shapes.size(); ++s) {
        const ContactSide side = contact_side(body, s);
        if (!side.touches) continue;
        contact::PlacedShape placed;
        placed.body = bodies_[b];
        placed.owner = static_cast<int>(b);
        placed.name = body.shapes.size() > 1 ? format("{}.{}", body.name, s) : body.name;
        placed.shape =
            contact_shape(shape_path(body, s), shape_place(body, body.shapes[s]), body.shapes[s]);
        placed.groups = groups.of(side);
        placed.meets = groups.met_by(side);
        placed.material = surface(side, static_cast<int>(b));
        set_->add_shape(std::move(placed));
        map_.body.push_back(static_cast<int>(b));
      }
    }
  }

  /// Index of the shape's surface class.
  int surface(const ContactSide& side, int body) {
    ContactLawKey key{.material = material_of(spec_, side)};
    if (std::any_of(named_.begin(), named_.end(),
                    [&](const auto& p) { return p.first == body || p.second == body; }))
      key.side = body;
    const auto [at, fresh] = classes_.try_emplace(key, static_cast<int>(classes_.size()));
    if (fresh) set_->add_material({format("class {}", at->second), 0.0, 0.0});
    return at->second;
  }

  void add_laws() {
    set_->set_default(contact_law(spec_.standard));
    if (spec_.nonsmooth() || spec_.rigid()) set_->set_impulses(impulse_options(spec_));
    for (const auto& [x, i] : classes_)
      for (const auto& [y, j] : classes_)
        if (i <= j) set_->set_law(i, j, law_of(x, y));
  }

  [[nodiscard]] contact::ContactLaw law_of(const ContactLawKey& x, const ContactLawKey& y) const {
    const StatedLaw stated = law_between(spec_, x, y);
    contact::ContactLaw law = contact_law(stated.law);
    law.sensor = stated.pair && stated.pair->sensor;
    return law;
  }

  void exclude() {
    for (const auto& [a, b] : spec_.excluded) excluded_.insert(std::minmax(a, b));
    if (!spec_.joint_neighbours)
      for (const JointSpec& joint : model_.joints)
        if (joint.a != kGround && joint.b != kGround)
          excluded_.insert(std::minmax(joint.a, joint.b));
    for (const auto& [a, b] : beam_neighbours(model_)) excluded_.insert(std::minmax(a, b));
    // Pairs that are named are always included.
    for (const ContactPairSpec& pair : spec_.pairs)
      if (of_bodies(pair)) excluded_.erase(std::minmax(pair.a, pair.b));
    for (const auto& [a, b] : spec_.excluded) excluded_.insert(std::minmax(a, b));
    for (const auto& [a, b] : excluded_)
      if (a.is_body() && b.is_body()) set_->exclude(a.index, b.index);
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
      if (of_bodies(pair)) keep(pair.a.index, pair.b.index, pair.sensor ? pair.name : "");
    for (const Reported& asked : reported(model_))
      if (asked.of->kind == "contact" && asked.of->pair[0].is_body() && asked.of->pair[1].is_body())
        keep(asked.of->pair[0].index, asked.of->pair[1].index, "");
    if (!spec_.record.value_or(true)) return;
    std::vector<std::pair<int, int>> found;
    for (int a = 0; a < static_cast<int>(shapes_of_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(shapes_of_.size()); ++b) {
        if (!may_meet(a, b)) continue;
        found.emplace_back(a, b);
        if (!spec_.record && static_cast<int>(found.size()) > kMaxContactPairs) return;
      }
    for (const auto& [a, b] : found) keep(a, b, "");
    map_.all_pairs = true;
  }

  /// Adds the switches of events; events at the start define the initial state.
  void add_switches() {
    std::map<std::array<int, 2>, bool> off;  // by sides, at the start
    const auto look = [&](const EventSpec& event, const std::vector<std::string>& names,
                          bool to_off) {
      for (const std::string& name : names) {
        const auto sides = switched_contact(model_, name);
        if (!sides) continue;
        const bool starts = event.at && *event.at <= 0.0;
        bool& is_off = off.try_emplace(*sides, false).first->second;
        if (starts) is_off = to_off;
      }
    };
    for (const EventSpec& event : model_.events) {
      look(event, event.on, false);
      look(event, event.off, true);
    }
    for (const auto& [sides, is_off] : off)
      set_->add_switch(sides[0], sides[1] == kEverySide ? contact::kEveryOwner : sides[1], is_off);
  }

  const Model& model_;
  const ContactsSpec& spec_;
  const std::vector<int>& bodies_;
  ContactMap& map_;
  std::shared_ptr<contact::ContactSet> set_;
  std::set<std::pair<int, int>> named_;  ///< By Model::bodies.
  std::set<std::pair<Side, Side>> excluded_;
  std::map<ContactLawKey, int> classes_;
  std::vector<std::vector<int>> shapes_of_;
};

void check_material(const Model& model, const ContactSide& side, std::vector<InputError>& faults,
                    std::set<std::string>& reported) {
  if (!side.material || material_of(model.contacts, side) >= 0) return;
  std::vector<std::string> names;
  for (const ContactMaterialSpec& m : model.contacts.materials) names.push_back(m.name);
  if (reported.insert(side.material_path).second)
    faults.emplace_back(
        side.material_path, format("unknown contact material '{}'", *side.material),
        names.empty() ? std::string("The model has none: give contacts.materials")
                      : did_you_mean(*side.material, names) + "Materials: " + name_list(names));
}

/// Checks that do not need the shapes to be built.
void check_sides(const Model& model, std::vector<InputError>& faults) {
  std::set<std::string> reported;
  bool any = false;
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      const ContactSide side = contact_side(body, s);
      if (!side.touches) continue;
      any = any || !body.fixed;
      check_material(model, side, faults, reported);
      if (body.point_mass && !body.fixed) {
        faults.emplace_back(shape_path(body, s),
                            "a point mass cannot touch: contact exerts moments",
                            "Give the body an inertia, or contact: {touches: false}");
      }
    }
  for (const SolidSpec& solid : model.solids) {
    const ContactSide side = contact_side(solid);
    if (!side.touches) continue;
    any = true;
    check_material(model, side, faults, reported);
  }
  for (const CableLineSpec& cable : model.cables) {
    const ContactSide side = contact_side(cable);
    if (!side.touches) continue;
    any = true;
    check_material(model, side, faults, reported);
  }
  static_cast<void>(ContactGroups(model, &faults));
  const bool stops =
      model.contacts.rigid() &&
      std::any_of(model.joints.begin(), model.joints.end(),
                  [](const JointSpec& joint) { return joint.limits || joint.angle_limits; });
  if (!any && !stops)
    faults.emplace_back("contacts", "no body that moves has a shape that touches",
                        "Give bodies shapes, or leave 'contacts' out");
}

}  // namespace

void check_contact_shapes(const Model& model, std::vector<InputError>& faults) {
  check_sides(model, faults);
  check_nonsmooth(model, faults);
  check_rigid(model, faults);
  for (const BodySpec& body : model.bodies)
    for (std::size_t s = 0; s < body.shapes.size(); ++s) {
      if (!contact_side(body, s).touches) continue;
      const std::string path = shape_path(body, s);
      try {
        static_cast<void>(contact_shape(path, shape_place(body, body.shapes[s]), body.shapes[s]));
      } catch (const InputError& e) {
        const bool of_file = e.where() != path;
        faults.emplace_back(path, (of_file ? e.where() + ": " : "") + e.what_is_wrong(),
                            of_file ? "Contact needs a closed surface: repair it in the program "
                                      "that made it, or set contact: {touches: false}"
                                    : e.hint());
      }
    }
}

std::shared_ptr<contact::ContactSet> build_contacts(const Model& model,
                                                    const std::vector<int>& bodies,
                                                    ContactMap& map) {
  if (!model.contacts.present) return nullptr;
  std::vector<InputError> faults;
  check_sides(model, faults);
  check_nonsmooth(model, faults);
  check_rigid(model, faults);
  if (!faults.empty()) throw InputError(faults.front());
  return ContactsBuilder(model, bodies, map).build();
}

}  // namespace polhode
