// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <type_traits>

#include <polhode/core/format.hpp>
#include <polhode/io/schema/field_table.hpp>
#include <polhode/model/endless.hpp>
#include <polhode/model/part_placement.hpp>
#include <polhode/study/side_by_side.hpp>

namespace polhode {

namespace {

/// Whether all bound fields of two specs are equal.
template <class Spec>
bool equal_fields(const Spec& a, const Spec& b, const io::FieldTable& table) {
  for (const io::Field* field : io::fields_of<Spec>(table)) {
    bool equal = true;
    field->member.visit(a, [&](const auto& x) {
      field->member.visit(b, [&](const auto& y) {
        if constexpr (std::is_same_v<decltype(x), decltype(y)>)
          equal = x == y;
        else
          equal = false;
      });
    });
    if (!equal) return false;
  }
  return true;
}

/// Compares two lists of specs, one by one.
template <class Specs, class Same>
bool alike(const Specs& a, const Specs& b, const Same& same) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

bool has_laws(const LoadSpec& load) { return !load.laws.empty(); }

}  // namespace

std::string why_alone(const Model& model) {
  if (model.analysis.type != "dynamics")
    return format("its analysis is '{}', no motion in time", model.analysis.type);
  if (!model.analysis.step) return "its steps are automatic: give analysis.step";
  if (is_endless(model.analysis)) return "it has no end";
  if (model.contacts.present) return "it has contacts";
  if (!model.solids.empty()) return "it has deformable solids";
  if (!model.beams.empty()) return "it has beams";
  if (!model.cables.empty()) return "it has cables";
  if (!model.events.empty()) return "it has events";
  if (!model.controllers.empty()) return "it has controllers";
  for (const JointSpec& joint : model.joints) {
    const char* what = joint.friction                              ? "friction"
                       : joint.limits || joint.angle_limits        ? "stops"
                       : joint.breaks.force || joint.breaks.moment ? "a strength"
                                                                   : nullptr;
    if (what) return format("joint '{}' has {}", joint.name, what);
  }
  for (const LoadSpec& load : model.loads)
    if (load.of_motion.index() != 0)
      return format("load '{}' is a function given in code", load.name);
  return "";
}

bool same_mechanism(const Model& a, const Model& b) {
  const auto same_body = [](const BodySpec& x, const BodySpec& y) {
    return x.name == y.name && x.fixed == y.fixed && x.point_mass == y.point_mass;
  };
  const auto same_joint = [](const JointSpec& x, const JointSpec& y) {
    return x.name == y.name && x.type == y.type && x.a == y.a && x.b == y.b && x.free == y.free &&
           x.motion.has_value() == y.motion.has_value() &&
           x.enforcement.has_value() == y.enforcement.has_value();
  };
  const auto same_load = [](const LoadSpec& x, const LoadSpec& y) {
    return x.name == y.name && x.type == y.type && x.a == y.a && x.b == y.b && x.joint == y.joint &&
           x.joint_2 == y.joint_2 && x.words == y.words && has_laws(x) == has_laws(y);
  };
  return a.gravity == b.gravity && alike(a.bodies, b.bodies, same_body) &&
         alike(a.joints, b.joints, same_joint) && alike(a.loads, b.loads, same_load) &&
         a.output.every == b.output.every &&
         equal_fields(a.analysis, b.analysis, io::analysis_fields());
}

std::string name_side_by_side(std::size_t number, const std::string& name) {
  return format("run {}: {}", number, name);
}

Model side_by_side(std::vector<Model> models) {
  Model whole;
  const Model& first = models.front();
  whole.title = first.title;
  whole.gravity = first.gravity;
  whole.analysis = first.analysis;
  whole.output = first.output;
  whole.output.probes.clear();
  for (std::size_t k = 0; k < models.size(); ++k)
    append_part(whole, std::move(models[k]), name_side_by_side(k, ""));
  return whole;
}

}  // namespace polhode
