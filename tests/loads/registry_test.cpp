// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <loads/load_samples.hpp>
#include <polhode/core/error.hpp>
#include <polhode/loads/slide_on_beam_kind.hpp>

namespace polhode::test::registry_tests {

// The energy balance and the reports find a load's items by its kind.
TEST(LoadRegistry, AddsItemsOfTheKindItNames) {
  for (const LoadKind& kind : load_kinds()) {
    if (acts_on_beam(kind)) continue;  // elements on nodes: compile/build_slide.hpp
    System system;
    const int body = system.add_body({.name = "body"}, {});
    LoadDescription d;
    d.name = "load";
    d.bodies = {kGround, body};
    d.angle = FreeAngle{};
    d.coupled.assign(static_cast<std::size_t>(kind.parts), {FreeAngle{}, d.bodies});
    kind.add(system, d);
    system.finish();
    int parts = 0;
    for (const InteractionRef& ref : system.interactions())
      if (system.group(ref.group).kind() == kind.name) {
        EXPECT_EQ(system.name(ref), "load");
        ++parts;
      }
    EXPECT_EQ(parts, kind.parts) << kind.name;
  }
}

TEST(LoadRegistry, ListsTheNamesWhenOneIsUnknown) {
  try {
    (void)load_kind("torque");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "loads: the type 'torque' is not known. Use one of: force, moment, "
        "spring_damper, potential, axial_force, vector_damper, bushing, attraction, "
        "gravity_gradient, "
        "drag, axis_drag, rotor, "
        "torsional_spring, translational_spring, rotary_motor, linear_motor, "
        "rotary_servo, linear_servo, rotary_inerter, linear_inerter, gear, screw, coupling, "
        "point_on_surface, point_on_curve, curve_on_curve, slide_on_beam, rolling.");
  }
}

}  // namespace polhode::test::registry_tests
