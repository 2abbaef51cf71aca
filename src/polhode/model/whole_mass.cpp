// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/whole_mass.hpp>

#include <polhode/core/disjoint_sets.hpp>

namespace polhode {

geometry::MassProperties whole_mass(const Model& model) {
  std::vector<geometry::MassProperties> parts;
  for (const BodySpec& body : model.bodies)
    if (body.mass > 0.0)
      parts.push_back(geometry::placed({body.mass, Vec3::Zero(), body.inertia}, body.position,
                                       body.orientation.toRotationMatrix()));
  return parts.empty() ? geometry::MassProperties{} : geometry::composed(parts);
}

int loop_count(const Model& model) {
  // Item 0 is the ground with all that is fixed.
  DisjointSets connected(model.bodies.size() + 1);
  const auto item = [&](int body) {
    return body == kGround || model.bodies[static_cast<std::size_t>(body)].fixed ? 0 : body + 1;
  };
  int loops = 0;
  for (const JointSpec& joint : model.joints) {
    const int a = item(joint.a), b = item(joint.b);
    if (connected.first_of(a) == connected.first_of(b))
      ++loops;
    else
      connected.join(a, b);
  }
  return loops;
}

}  // namespace polhode
