// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/geometry/shape.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Contact settings of a shape of a body, of the surface of a solid or of a cable; null where
/// nothing is given. Paths are those of the keys, or of their position.
struct ContactSide {
  bool touches = true;
  const std::string* material = nullptr;
  const std::vector<std::string>* groups = nullptr;
  const std::vector<std::string>* meets = nullptr;
  std::string material_path, groups_path, meets_path;
};

/// Path of a shape: bodies.crate.shape, with several shapes bodies.crate.shape.1.
[[nodiscard]] std::string shape_path(const BodySpec& body, std::size_t shape);
/// Placement of a shape in contact coordinates: from the centre of mass in body axes, or in the
/// world for fixed bodies. The normal of a plane is its z.
[[nodiscard]] geometry::ShapePlace shape_place(const BodySpec& body, const ShapeSpec& shape);
/// Settings of a shape; its keys override those of its body.
[[nodiscard]] ContactSide contact_side(const BodySpec& body, std::size_t shape);
[[nodiscard]] ContactSide contact_side(const SolidSpec& solid);
/// Settings of a cable; without any it has no contact.
[[nodiscard]] ContactSide contact_side(const CableLineSpec& cable);
[[nodiscard]] bool has_touching_cables(const Model& model);
/// Index into ContactsSpec::materials, −1 if none is given or it is unknown.
[[nodiscard]] int material_of(const ContactsSpec& contacts, const ContactSide& side);

/// Collision groups as bits; 'default' is the first.
class ContactGroups {
 public:
  /// @param faults  Receives errors for too many groups, and for groups that are met but have no
  /// members, which is probably a misspelling; may be null.
  explicit ContactGroups(const Model& model, std::vector<InputError>* faults = nullptr);
  [[nodiscard]] std::uint32_t of(const ContactSide& side) const { return mask(side.groups, 1U); }
  [[nodiscard]] std::uint32_t met_by(const ContactSide& side) const {
    return mask(side.meets, 0xffffffffU);
  }

 private:
  [[nodiscard]] std::uint32_t mask(const std::vector<std::string>* names,
                                   std::uint32_t otherwise) const;
  std::map<std::string, std::uint32_t> bits_{{"default", 1U}};
};

/// Key of the law of one side of a contact.
struct ContactLawKey {
  int material = -1;    ///< Index into ContactsSpec::materials, or −1.
  Side side = kGround;  ///< The ground: no pair names it.
  auto operator<=>(const ContactLawKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Law between two sides: a pair of sides overrides a pair of materials, which overrides the
/// combination of the materials.
struct StatedLaw {
  ContactLawSpec law;
  const ContactPairSpec* pair = nullptr;  ///< Pair with a given law; null: combined.
};
[[nodiscard]] StatedLaw law_between(const ContactsSpec& contacts, const ContactLawKey& x,
                                    const ContactLawKey& y);

/// Friction and restitution of a pair of materials by the combination rules.
/// @param a, b  Indices into ContactsSpec::materials; −1: the default law.
[[nodiscard]] ContactMaterialSpec combined_surface(const ContactsSpec& contacts, int a, int b);

}  // namespace polhode
