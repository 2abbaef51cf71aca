// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/model_fingerprint.hpp>

#include <cmath>
#include <fstream>
#include <functional>
#include <memory>

#include <gtest/gtest.h>
#include <support/bound_specs.hpp>
#include <support/scratch.hpp>

namespace polhode::model_fingerprint_tests {
namespace {

struct Wave final : TimeFunction {
  explicit Wave(double rate) : rate_(rate) {}
  double operator()(double t) const override { return std::sin(rate_ * t); }
  double rate_;
};

/// A model with one entry of every section.
Model model_of_all() {
  Model m;
  m.gravity = {0.0, 0.0, -9.81};
  m.bodies.resize(2);
  m.bodies[0].name = "a";
  m.bodies[1].name = "b";
  m.bodies[1].shapes.emplace_back().type = "sphere";
  m.bodies[1].shapes[0].sizes = {0.1};
  JointSpec& joint = m.joints.emplace_back();
  joint.type = "revolute";
  joint.friction.emplace().mu = 0.1;
  joint.limits.emplace().upper = 1.0;
  LoadSpec& load = m.loads.emplace_back();
  load.type = "pressure";
  load.value = std::make_shared<Wave>(1.0);
  load.selection.emplace_back();
  m.materials.emplace_back().parameters["youngs_modulus"] = 1e6;
  m.materials[0].fibres.emplace_back();
  SolidSpec& solid = m.solids.emplace_back();
  solid.mesh.nodes.push_back({0.0, 0.0, 0.0});
  solid.bonded.emplace_back().nodes.emplace_back();
  solid.prescribed.emplace_back().displacement[1] = std::make_shared<Wave>(2.0);
  BeamSpec& beam = m.beams.emplace_back();
  beam.mesh.emplace_back().length = 0.5;
  beam.bonds.emplace_back();
  CableLineSpec& cable = m.cables.emplace_back();
  cable.pieces.emplace_back().free_length = 1.0;
  cable.contact.emplace().radius = 0.01;
  m.contacts.present = true;
  m.contacts.materials.emplace_back().name = "steel";
  m.contacts.pairs.emplace_back().name = "p";
  return m;
}

TEST(ModelFingerprint, ChangesWithEverythingThatTheMotionDependsOn) {
  const std::string fingerprint = io::model_fingerprint(model_of_all());
  EXPECT_EQ(io::model_fingerprint(model_of_all()), fingerprint);
  const std::pair<const char*, std::function<void(Model&)>> changes[] = {
      {"gravity", [](Model& m) { m.gravity[2] = -9.8; }},
      {"inertia", [](Model& m) { m.bodies[1].inertia(0, 1) = 1e-9; }},
      {"name", [](Model& m) { m.bodies[0].name = "ab"; }},
      {"groups", [](Model& m) { m.bodies[0].contact.groups = {"g"}; }},
      {"size of a shape", [](Model& m) { m.bodies[1].shapes[0].sizes[0] = 0.11; }},
      {"joint's point", [](Model& m) { m.joints[0].Z_b[2] = 1e-12; }},
      {"joint's type", [](Model& m) { m.joints[0].type = "universal"; }},
      {"joint's friction", [](Model& m) { m.joints[0].friction->mu = 0.2; }},
      {"no joint's friction", [](Model& m) { m.joints[0].friction.reset(); }},
      {"joint's stop", [](Model& m) { m.joints[0].limits->restitution = 0.5; }},
      {"pressure", [](Model& m) { m.loads[0].value = std::make_shared<Wave>(1.01); }},
      {"faces", [](Model& m) { m.loads[0].selection[0].value = 0.1; }},
      {"Young's modulus", [](Model& m) { m.materials[0].parameters["youngs_modulus"] = 2e6; }},
      {"relaxation",
       [](Model& m) {
         m.materials[0].relaxation = {{0.5, 1e-3}};
       }},
      {"viscosity", [](Model& m) { m.materials[0].viscosity.relaxation_time = 1e-3; }},
      {"fibres", [](Model& m) { m.materials[0].fibres[0].direction = Vec3::UnitY(); }},
      {"mesh", [](Model& m) { m.solids[0].mesh.nodes[0].x() = 1e-9; }},
      {"element", [](Model& m) { m.solids[0].element = "hex8"; }},
      {"bond", [](Model& m) { m.solids[0].bonded[0].body = 1; }},
      {"what is bonded", [](Model& m) { m.solids[0].bonded[0].nodes[0].radius = 1.0; }},
      {"displacement",
       [](Model& m) { m.solids[0].prescribed[0].displacement[1] = std::make_shared<Wave>(3.0); }},
      {"start of a solid", [](Model& m) { m.solids[0].velocity = Vec3::UnitX(); }},
      {"self-contact", [](Model& m) { m.solids[0].self_contact = true; }},
      {"section", [](Model& m) { m.beams[0].section.section.stiffness(3, 3) = 1.0; }},
      {"damping of a beam", [](Model& m) { m.beams[0].section.relaxation_time = 1e-3; }},
      {"length of a beam", [](Model& m) { m.beams[0].mesh[0].length = 0.6; }},
      {"bond of a beam", [](Model& m) { m.beams[0].bonds[0].at_end = true; }},
      {"stiffness of a cable", [](Model& m) { m.cables[0].stiffness = 1e5; }},
      {"length of a cable", [](Model& m) { m.cables[0].pieces[0].free_length = 1.1; }},
      {"mass of a cable", [](Model& m) { m.cables[0].pieces[0].mass = 0.1; }},
      {"radius of a cable", [](Model& m) { m.cables[0].contact->radius = 0.02; }},
      {"a cable that touches itself", [](Model& m) { m.cables[0].contact->self = true; }},
      {"pressure of contact", [](Model& m) { m.contacts.standard.reference_pressure = 1e3; }},
      {"friction", [](Model& m) { m.contacts.standard.friction = 0.3; }},
      {"material of contact", [](Model& m) { m.contacts.materials[0].restitution = 0.3; }},
      {"a pair's law", [](Model& m) { m.contacts.pairs[0].law.potential = "hertz"; }},
      {"a pair's solid", [](Model& m) { m.contacts.pairs[0].b = Side::of_solid(0); }},
      {"a pair's cable", [](Model& m) { m.contacts.pairs[0].b = Side::of_cable(0); }},
      {"exclusion",
       [](Model& m) {
         m.contacts.excluded.push_back({0, 1});
       }},
      {"rho_inf", [](Model& m) { m.analysis.rho_inf = 0.9; }},
      {"momenta", [](Model& m) { m.analysis.momentum_rate = "kinematic"; }},
  };
  for (const auto& [what, change] : changes) {
    Model other = model_of_all();
    change(other);
    EXPECT_NE(io::model_fingerprint(other), fingerprint) << what;
  }
}

TEST(ModelFingerprint, LeavesOutWhatMayChangeWhenARunIsContinued) {
  const std::string fingerprint = io::model_fingerprint(model_of_all());
  const std::function<void(Model&)> changes[] = {
      [](Model& m) { m.title = "again"; },      [](Model& m) { m.analysis.duration = 7.0; },
      [](Model& m) { m.analysis.step = 1e-3; }, [](Model& m) { m.analysis.solver = "klu"; },
      [](Model& m) { m.output.every = 0.1; },   [](Model& m) { m.contacts.record = true; },
  };
  for (const auto& change : changes) {
    Model other = model_of_all();
    change(other);
    EXPECT_EQ(io::model_fingerprint(other), fingerprint);
  }
  // Without contact, shapes are used in pictures only.
  Model drawn = model_of_all();
  drawn.contacts.present = false;
  const std::string without = io::model_fingerprint(drawn);
  drawn.bodies[1].shapes[0].sizes[0] = 0.2;
  EXPECT_EQ(io::model_fingerprint(drawn), without);
}

/// Another value of the same type.
struct Change {
  void operator()(double* value) const { *value = *value == 0.5 ? 0.25 : 0.5; }
  void operator()(int* value) const { ++*value; }
  void operator()(bool* value) const { *value = !*value; }
  void operator()(std::string* value) const { *value += "x"; }
  void operator()(Vec3* value) const { value->y() += 0.5; }
  void operator()(TimeFunctionPtr* value) const { *value = std::make_shared<Wave>(3.0); }
  void operator()(const io::EnumReference& value) const { value.set(value.get() + 1); }
  template <class T>
  void operator()(std::vector<T>* value) const {
    value->emplace_back();
  }
  template <class T>
  void operator()(std::optional<T>* value) const {
    value->emplace();
  }
};

/// Fields of every table, so that a new one is covered.
TEST(ModelFingerprint, ChangesWithEveryBoundFieldThatMayNotChange) {
  const std::string fingerprint = io::model_fingerprint(test::BoundSpecs().model());
  for (const io::FieldTable* table : io::all_field_tables())
    for (const io::Field& field : table->fields) {
      test::BoundSpecs specs;
      bool bound = false;
      specs.each([&]<class Spec>(Spec& spec) {
        if (!field.member.belongs_to<Spec>()) return;
        std::visit(Change(), field.member.in(spec));
        bound = true;
      });
      if (!bound) continue;
      EXPECT_EQ(io::model_fingerprint(specs.model()) == fingerprint, field.may_change)
          << table->title << ' ' << field.name;
    }
}

/// The content of a mesh file enters the fingerprint, not its path.
TEST(ModelFingerprint, ReadsMeshFiles) {
  const test::Scratch scratch;
  const auto with_mesh = [&](const std::string& name, const std::string& text) {
    Model m = model_of_all();
    m.solids[0].mesh.file = scratch / name;
    std::ofstream(m.solids[0].mesh.file) << text;
    return io::model_fingerprint(m);
  };
  const std::string one = with_mesh("one.msh", "nodes");
  EXPECT_EQ(with_mesh("two.msh", "nodes"), one);
  EXPECT_NE(with_mesh("two.msh", "other nodes"), one);
}

}  // namespace
}  // namespace polhode::model_fingerprint_tests
