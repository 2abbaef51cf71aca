// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/gradient/changed_items.hpp>

namespace polhode {

namespace {

bool same(const TimeFunctionPtr& a, const TimeFunctionPtr& b) {
  if (!a || !b) return !a && !b;
  return a->is_constant() && b->is_constant() && (*a)(0.0) == (*b)(0.0);
}

bool same(const BodySpec& a, const BodySpec& b) {
  return a.mass == b.mass && a.inertia == b.inertia && a.position == b.position &&
         a.orientation.coeffs() == b.orientation.coeffs() && a.com == b.com;
}

bool same(const JointSpec& a, const JointSpec& b) {
  return a.Z_a == b.Z_a && a.Z_b == b.Z_b && a.R_a == b.R_a && a.R_b == b.R_b &&
         a.parameters == b.parameters && !a.motion && !a.friction && !a.enforcement;
}

bool same(const LoadSpec& a, const LoadSpec& b) {
  if (a.Z_a != b.Z_a || a.Z_b != b.Z_b || a.R_a != b.R_a || a.R_b != b.R_b ||
      a.parameters != b.parameters || a.words != b.words || !same(a.value, b.value) ||
      !std::equal(
          a.others.begin(), a.others.end(), b.others.begin(), b.others.end(),
          [](const CoordinateSpec& x, const CoordinateSpec& y) { return x.factor == y.factor; }) ||
      a.vector.has_value() != b.vector.has_value() || a.laws.size() != b.laws.size() ||
      a.matrices.size() != b.matrices.size())
    return false;
  for (std::size_t i = 0; a.vector && i < 3; ++i)
    if (!same((*a.vector)[i], (*b.vector)[i])) return false;
  for (const auto& [key, law] : a.laws) {
    const auto other = b.laws.find(key);
    if (other == b.laws.end() || !same(law, other->second)) return false;
  }
  for (const auto& [key, matrix] : a.matrices) {
    const auto other = b.matrices.find(key);
    if (other == b.matrices.end() || matrix != other->second) return false;
  }
  return true;
}

}  // namespace

ChangedItems changed_items(const Model& model, const System& system, const Model& other_model,
                           const System& other, const SystemMap& map) {
  ChangedItems changed;
  changed.bodies.assign(static_cast<std::size_t>(system.body_count()), 0);
  changed.interactions.assign(system.interactions().size(), 0);
  for (std::size_t b = 0; b < changed.bodies.size(); ++b) {
    const BodyData &x = system.bodies()[b], &y = other.bodies()[b];
    changed.bodies[b] =
        x.mass != y.mass || x.inertia != y.inertia || system.gravity() != other.gravity();
  }
  if (!model.beams.empty() || !model.cables.empty()) {
    std::fill(changed.interactions.begin(), changed.interactions.end(), 1);
    return changed;
  }
  std::vector<char> known(changed.interactions.size(), 0);
  const auto moved = [&](int body) {
    if (body == kGround) return false;
    const auto b = static_cast<std::size_t>(body);
    return !same(model.bodies[b], other_model.bodies[b]);
  };
  const auto mark = [&](int interaction, bool yes) {
    known[static_cast<std::size_t>(interaction)] = 1;
    changed.interactions[static_cast<std::size_t>(interaction)] = yes;
  };
  std::vector<char> joint_changed;
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointSpec& joint = model.joints[j];
    const bool yes = !same(joint, other_model.joints[j]) || moved(joint.a) || moved(joint.b);
    joint_changed.push_back(yes);
    mark(map.joint[j], yes);
  }
  const auto of_joint = [&](const std::string& name) {
    return !name.empty() && joint_changed[static_cast<std::size_t>(model.joint_index(name))];
  };
  for (std::size_t l = 0; l < model.loads.size(); ++l) {
    const LoadSpec& load = model.loads[l];
    if (map.load[l] < 0) continue;
    mark(map.load[l], !same(load, other_model.loads[l]) || moved(load.a) || moved(load.b) ||
                          of_joint(load.joint) || of_joint(load.joint_2) ||
                          std::any_of(load.others.begin(), load.others.end(),
                                      [&](const CoordinateSpec& q) { return of_joint(q.joint); }));
  }
  for (std::size_t i = 0; i < known.size(); ++i)
    if (!known[i]) changed.interactions[i] = 1;
  return changed;
}

}  // namespace polhode
