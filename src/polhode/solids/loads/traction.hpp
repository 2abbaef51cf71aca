// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/loads/dead_load.hpp>
#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Force per undeformed area, fixed in the world [Pa].
/// @param name  Path of the load in the user's model.
/// @param X     Reference positions of all nodes [m].
/// @throws InputError if there are no faces, or faces of an unknown shape.
[[nodiscard]] inline std::unique_ptr<ElementGroup> make_traction(std::string name,
                                                                 std::span<const LoadedFaces> faces,
                                                                 std::span<const Vec3> X,
                                                                 TimeVector traction) {
  check_faces(name, faces);
  NodeShares shares(X);
  for_each_face_point(faces, X, [&](int node, double w, const FacePoint& point) {
    shares.add(node, w * point.area.norm() * Mat3::Identity());
  });
  return std::make_unique<DeadLoad>("traction", std::move(name), shares.all(), std::move(traction));
}

[[nodiscard]] inline SolidLoadKind traction_kind() {
  return {.name = "traction",
          .meaning = "a force per area on faces of a deformable solid",
          .place = SolidLoadPlace::faces,
          .vector = TimeParameter{"traction", "Pa", "force per undeformed area, world components"},
          .make = [](const SolidLoadDescription& d) {
            return one_group(make_traction(d.name, d.faces, d.X, d.vector));
          }};
}

}  // namespace polhode::solids
