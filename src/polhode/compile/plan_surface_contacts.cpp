// SPDX-License-Identifier: Apache-2.0
// Pairs of surfaces in contact, and their laws.
#include <algorithm>
#include <optional>
#include <set>

#include <polhode/compile/build_surface_contacts.hpp>
#include <polhode/compile/contact_sides.hpp>
#include <polhode/compile/rigid_surfaces.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// First key of a law that surfaces of solids do not support; empty if none. Constants of
/// point forces are ignored: surfaces have their own.
std::string strange_key(const ContactLawSpec& law) {
  if (law.static_friction > law.friction) return "static_friction";
  if (law.friction_across > 0.0 && law.friction_across != law.friction) return "friction_across";
  if (law.rolling > 0.0) return "rolling_friction";
  if (law.torsion > 0.0) return "torsional_friction";
  return {};
}

bool touches_itself(const CableLineSpec& cable) { return cable.contact && cable.contact->self; }

class SurfacePlanner {
 public:
  SurfacePlanner(const Model& model, std::vector<InputError>* faults)
      : model_(model), faults_(faults), groups_(model) {
    for (const auto& [a, b] : model.contacts.excluded) excluded_.insert(std::minmax(a, b));
    for (const ContactPairSpec& pair : model.contacts.pairs)
      if (!pair.of_materials) named_.insert(std::minmax(pair.a, pair.b));
  }

  std::vector<SurfacePair> plan() {
    for (std::size_t s = 0; s < model_.solids.size(); ++s)
      add_bodies(Side::of_solid(static_cast<int>(s)), contact_side(model_.solids[s]));
    for (std::size_t c = 0; c < model_.cables.size(); ++c)
      add_bodies(Side::of_cable(static_cast<int>(c)), contact_side(model_.cables[c]));
    for (std::size_t s = 0; s < model_.solids.size(); ++s)
      for (std::size_t t = s; t < model_.solids.size(); ++t)
        add_solids(static_cast<int>(s), static_cast<int>(t));
    for (std::size_t c = 0; c < model_.cables.size(); ++c)
      for (std::size_t s = 0; s < model_.solids.size(); ++s)
        add_cable_on_solid(static_cast<int>(c), static_cast<int>(s));
    for (std::size_t c = 0; c < model_.cables.size(); ++c)
      for (std::size_t d = c; d < model_.cables.size(); ++d)
        add_cables(static_cast<int>(c), static_cast<int>(d));
    check_named();
    return std::move(list_);
  }

 private:
  [[nodiscard]] bool groups_meet(const ContactSide& a, const ContactSide& b) const {
    return (groups_.of(a) & groups_.met_by(b)) && (groups_.of(b) & groups_.met_by(a));
  }

  /// Whether contact between two sides is neither excluded nor prevented by bonds; named pairs are
  /// always included. A cable may be in contact with the bodies it is attached to, except near the
  /// attachments.
  [[nodiscard]] bool sides_meet(const Side& own, int body) const {
    const std::pair<Side, Side> key = std::minmax(own, Side(body));
    if (excluded_.contains(key)) return false;
    if (own.is_cable() || named_.contains(key) || model_.contacts.joint_neighbours) return true;
    const auto& bonds = model_.solids[static_cast<std::size_t>(own.index)].bonded;
    return std::none_of(bonds.begin(), bonds.end(),
                        [&](const BondSpec& bond) { return bond.body == body; });
  }

  void add_bodies(const Side& own, const ContactSide& side) {
    if (!side.touches) return;
    for (std::size_t b = 0; b < model_.bodies.size(); ++b) {
      if (!sides_meet(own, static_cast<int>(b))) continue;
      for (std::size_t k = 0; k < model_.bodies[b].shapes.size(); ++k) {
        const ContactSide shape = contact_side(model_.bodies[b], k);
        if (shape.touches && groups_meet(side, shape))
          add(own, side, static_cast<int>(b), k, shape);
      }
    }
  }

  void add(const Side& own, const ContactSide& of_own, int body, std::size_t shape,
           const ContactSide& of_shape) {
    const BodySpec& spec = model_.bodies[static_cast<std::size_t>(body)];
    const std::string& name = model_.side_name(own);
    const StatedLaw stated =
        law_between(model_.contacts, {material_of(model_.contacts, of_own), own},
                    {material_of(model_.contacts, of_shape), body});
    const std::string where =
        stated.pair ? format("contacts.pairs.{}", stated.pair->name) : "contacts.default";
    check_tolerance(where, own, spec, shape, stated.law);
    if (const std::string key = strange_key(stated.law); !key.empty())
      fault(where,
            format("'{}' and '{}' touch by a law with {}, which {} do not support", name, spec.name,
                   key, own.is_cable() ? "cables" : "surfaces of solids"),
            "Give the pair its own law in contacts.pairs, without this key, with zero, or with the "
            "value of friction");
    if (model_.analysis.type != "dynamics" && stated.law.friction > 0.0)
      fault(where,
            format("'{}' and '{}' touch with friction, which statics does not support", name,
                   spec.name),
            "Set friction: 0, or let the model come to rest in dynamics");
    list_.push_back({own, body, shape, stated.law});
  }

  /// A band that is wide compared with the triangles of a shape or the radius of a cable would
  /// extend through them.
  void check_tolerance(const std::string& where, const Side& own, const BodySpec& body,
                       std::size_t k, const ContactLawSpec& law) {
    const ShapeSpec& shape = body.shapes[k];
    if (!(law.gap_tolerance > 0.0) || law.potential == "linear") return;
    const bool cable = own.is_cable();
    const double most =
        cable ? widest_tolerance(shape,
                                 model_.cables[static_cast<std::size_t>(own.index)].contact->radius)
              : widest_tolerance(shape);
    if (law.gap_tolerance > most)
      fault(where,
            format("'{}' touches the {} of '{}' with a gap_tolerance of {:.3g} m, above a quarter "
                   "of the median edge of its triangles{}, {:.3g} m",
                   model_.side_name(own), shape.type, body.name, law.gap_tolerance,
                   cable ? " and an eighth of the cable's radius" : "", most),
            "Give the pair a smaller gap_tolerance in contacts.pairs, or leave it out");
  }

  /// Adds two solids, or one with itself if requested.
  void add_solids(int s, int t) {
    const SolidSpec &one = model_.solids[static_cast<std::size_t>(s)],
                    &two = model_.solids[static_cast<std::size_t>(t)];
    if (s == t && !one.self_contact) return;
    add_surfaces(Side::of_solid(s), contact_side(one), Side::of_solid(t), contact_side(two),
                 "surfaces of solids", "meshes");
  }

  /// Adds two cables, or one with itself if requested.
  void add_cables(int c, int d) {
    const CableLineSpec &one = model_.cables[static_cast<std::size_t>(c)],
                        &two = model_.cables[static_cast<std::size_t>(d)];
    if (c == d && !touches_itself(one)) return;
    add_surfaces(Side::of_cable(c), contact_side(one), Side::of_cable(d), contact_side(two),
                 "cables", "cables");
  }

  void add_cable_on_solid(int c, int s) {
    const CableLineSpec& cable = model_.cables[static_cast<std::size_t>(c)];
    const SolidSpec& solid = model_.solids[static_cast<std::size_t>(s)];
    const std::optional<StatedLaw> stated =
        add_surfaces(Side::of_cable(c), contact_side(cable), Side::of_solid(s), contact_side(solid),
                     "cables", "cables");
    const double most = widest_tolerance(cable.contact ? cable.contact->radius : 0.0);
    if (stated && stated->law.gap_tolerance > most)
      fault(place_of(*stated),
            format("'{}' touches '{}' with a gap_tolerance of {:.3g} m, above an eighth of the "
                   "cable's radius, {:.3g} m",
                   cable.name, solid.name, stated->law.gap_tolerance, most),
            "Give the pair a smaller gap_tolerance in contacts.pairs, or leave it out");
  }

  /// Adds two surfaces without a shape, or one with itself. @returns their law, unless contact is
  /// excluded.
  std::optional<StatedLaw> add_surfaces(const Side& own, const ContactSide& a, const Side& side,
                                        const ContactSide& b, const char* they,
                                        const char* passing) {
    if (!a.touches || !b.touches || (own != side && !groups_meet(a, b))) return {};
    if (excluded_.contains(std::minmax(own, side))) return {};
    const StatedLaw stated = law_between(model_.contacts, {material_of(model_.contacts, a), own},
                                         {material_of(model_.contacts, b), side});
    check_law(stated,
              own == side
                  ? format("'{}' touches itself", model_.side_name(own))
                  : format("'{}' and '{}' touch", model_.side_name(own), model_.side_name(side)),
              they, passing);
    list_.push_back({own, side, 0, stated.law});
    return stated;
  }

  [[nodiscard]] static std::string place_of(const StatedLaw& stated) {
    return stated.pair ? format("contacts.pairs.{}", stated.pair->name) : "contacts";
  }

  /// Checks a law for properties unsupported between two surfaces without a shape.
  void check_law(const StatedLaw& stated, const std::string& who, const char* they,
                 const char* passing) {
    const std::string where = place_of(stated);
    if (model_.analysis.type != "dynamics" && stated.law.friction > 0.0)
      fault(where, format("{} with friction, which statics does not support", who),
            "Set friction: 0, or let the model come to rest in dynamics");
    if (const std::string key = strange_key(stated.law); !key.empty())
      fault(where, format("{} by a law with {}, which {} do not support", who, key, they),
            "Give the pair its own law in contacts.pairs, without this key, with zero, or with the "
            "value of friction");
    if (stated.law.potential == "linear")
      fault(where, format("{} by the linear law, which does not stop {}", who, passing),
            "Give the pair its own law in contacts.pairs, with law: barrier");
  }

  /// Checks pairs of a solid or a cable with itself that are named without enabled self-contact.
  void check_named() {
    for (const ContactPairSpec& pair : model_.contacts.pairs) {
      if (pair.of_materials || pair.a != pair.b || pair.a.is_body()) continue;
      const bool cable = pair.a.is_cable();
      const bool self = cable
                            ? touches_itself(model_.cables[static_cast<std::size_t>(pair.a.index)])
                            : model_.solids[static_cast<std::size_t>(pair.a.index)].self_contact;
      const std::string& name = model_.side_name(pair.a);
      if (!self)
        fault(format("contacts.pairs.{}", pair.name), format("'{}' does not touch itself", name),
              format("Set {}.{}.contact: {{self: true}}, or leave the pair out",
                     cable ? "cables" : "solids", name));
    }
  }

  void fault(const std::string& where, const std::string& what, const std::string& hint) {
    if (!faults_) throw InputError(where, what, hint);
    if (told_.insert(where + what).second) faults_->emplace_back(where, what, hint);
  }

  const Model& model_;
  std::vector<InputError>* faults_;
  ContactGroups groups_;
  std::set<std::pair<Side, Side>> excluded_, named_;
  std::set<std::string> told_;
  std::vector<SurfacePair> list_;
};

}  // namespace

std::vector<SurfacePair> plan_surface_contacts(const Model& model,
                                               std::vector<InputError>* faults) {
  if (!model.contacts.present) return {};
  return SurfacePlanner(model, faults).plan();
}

}  // namespace polhode
