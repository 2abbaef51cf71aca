// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/loads/dead_load.hpp>
#include <polhode/solids/loads/follower_pressure.hpp>
#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Pressure against the outward normals and areas of the undeformed faces [Pa].
/// @param name  Path of the load in the user's model.
/// @param X     Reference positions of all nodes [m].
/// @throws InputError if there are no faces, or faces of an unknown shape.
[[nodiscard]] inline std::unique_ptr<ElementGroup> make_dead_pressure(
    std::string name, std::span<const LoadedFaces> faces, std::span<const Vec3> X,
    TimeFunctionPtr pressure) {
  check_faces(name, faces);
  NodeShares shares(X);
  for_each_face_point(faces, X, [&](int node, double w, const FacePoint& point) {
    // The value is in the first component of the vector.
    Mat3 B = Mat3::Zero();
    B.col(0) = -w * point.area;
    shares.add(node, B);
  });
  return std::make_unique<DeadLoad>("pressure", std::move(name), shares.all(),
                                    TimeVector{std::move(pressure), nullptr, nullptr});
}

[[nodiscard]] inline SolidLoadKind pressure_kind() {
  return {.name = "pressure",
          .meaning = "a pressure on faces of a deformable solid, against their outward normals",
          .place = SolidLoadPlace::faces,
          .value = TimeParameter{"pressure", "Pa", "positive is compression"},
          .can_follow = true,
          .make = [](const SolidLoadDescription& d) {
            if (d.follower) return make_follower_pressure(d.name, d.faces, d.value, *d.follower);
            return one_group(make_dead_pressure(d.name, d.faces, d.X, d.value));
          }};
}

}  // namespace polhode::solids
