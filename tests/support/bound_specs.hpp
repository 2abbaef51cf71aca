// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/model.hpp>

namespace polhode::test {

/// All specs with fields that are bound to members, as they are in a model.
struct BoundSpecs {
  AnalysisSpec analysis{};
  OutputSpec output{};
  ContactsSpec contacts{};
  ContactLawSpec law{};
  ContactMaterialSpec contact_material{};
  ContactSideSpec side{};
  BeamContactSpec beam_contact{};
  CableContactSpec cable_contact{};
  CableLineSpec cable{};
  HillMuscle muscle{};
  ControllerSpec controller{};
  JointFrictionSpec friction{};
  JointLimitsSpec limits{};
  JointStrengthSpec strength{};
  JointEnforcement enforcement{};
  ViscositySpec viscosity{};
  RelaxationSpec relaxation{};

  /// Calls `visitor(spec)` for each.
  template <class Visitor>
  void each(Visitor&& visitor) {
    visitor(analysis);
    visitor(output);
    visitor(contacts);
    visitor(law);
    visitor(contact_material);
    visitor(side);
    visitor(beam_contact);
    visitor(cable_contact);
    visitor(cable);
    visitor(muscle);
    visitor(controller);
    visitor(friction);
    visitor(limits);
    visitor(strength);
    visitor(enforcement);
    visitor(viscosity);
    visitor(relaxation);
  }

  /// Model that contains each of them.
  [[nodiscard]] Model model() const {
    Model m;
    m.analysis = analysis;
    m.output = output;
    m.contacts = contacts;
    m.contacts.present = true;
    m.contacts.standard = law;
    m.contacts.materials = {contact_material};
    m.bodies.emplace_back().contact = side;
    m.beams.emplace_back().contact = beam_contact;
    m.cables = {cable, {}};
    m.cables[1].contact = cable_contact;
    m.cables[1].muscle = muscle;
    m.cables[1].slides = true;
    m.controllers = {controller};
    JointSpec& joint = m.joints.emplace_back();
    joint.friction = friction;
    joint.limits = limits;
    joint.breaks = strength;
    joint.enforcement = enforcement;
    m.materials.emplace_back().viscosity = viscosity;
    m.materials.back().relaxation = {relaxation};
    return m;
  }
};

/// Number of specs that have this field.
inline int owners(const io::Field& field) {
  int count = 0;
  BoundSpecs().each([&]<class Spec>(Spec&) { count += field.member.belongs_to<Spec>(); });
  return count;
}

}  // namespace polhode::test
