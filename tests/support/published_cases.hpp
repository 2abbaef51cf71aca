// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <support/models.hpp>
#include <support/reference.hpp>

namespace polhode::test {

/// A case with reference data: its model and the compared quantities.
struct PublishedCase {
  std::string name;
  Model model;
  std::string data;  ///< Name of the reference, see Reference::read.
  Observation observe;
  double duration = 0.0;  ///< Of the whole case [s].
};

inline Vec joint_coordinates(const Simulation& s, const std::vector<std::string>& names) {
  Vec values(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i)
    values[static_cast<Eigen::Index>(i)] =
        s.joint(s.model().joint_index(names[i])).coordinates.at(0);
  return values;
}

/// Position of a point of a body, without the accelerations that Simulation::point solves for.
inline Vec3 place_of(const Simulation& s, int body, const Vec3& Z) {
  const BodyMotion m = s.body(body);
  return m.r + m.q * Z;
}

inline PublishedCase planar_pendulum_case() {
  return {"A01", planar_pendulum(), "planar_pendulum",
          [](const Simulation& s) -> Vec { return s.body(0).r.head<2>(); }, 10.0};
}
inline PublishedCase n_four_bar_case(int N) {
  return {"A02 N=" + std::to_string(N), n_four_bar(N), "n_four_bar_" + std::to_string(N),
          [](const Simulation& s) -> Vec { return place_of(s, 0, kFourBarB0).head<2>(); }, 10.0};
}
inline PublishedCase andrews_case() {
  // The angles from the bodies' orientations, turns counted by the joint of the crank.
  return {"A03", andrews_squeezer(), "andrews_squeezer",
          [](const Simulation& s) -> Vec { return joint_coordinates(s, andrews_angles()); }, 0.05};
}
inline PublishedCase bricard_case() {
  return {"A04", bricard(), "bricard",
          [](const Simulation& s) -> Vec { return place_of(s, 1, kBricardP3); }, 10.0};
}
inline PublishedCase flyball_case() {
  // Height of the slider along the shaft, which is vertical.
  return {"A05", flyball_governor(), "flyball_governor",
          [](const Simulation& s) -> Vec { return s.body(1).r.tail<1>(); }, 10.0};
}
inline PublishedCase heavy_top_case() {
  return {"HT", heavy_top(), "heavy_top", [](const Simulation& s) -> Vec { return s.body(0).r; },
          2.0};
}
inline PublishedCase slider_crank_case() {
  return {"SC3D", spatial_slider_crank(), "spatial_slider_crank",
          [](const Simulation& s) -> Vec { return s.body(2).r.head<1>(); }, 5.0};
}
inline PublishedCase asymmetric_top_case() {
  return {"free asymmetric top", free_asymmetric_top(), "free_asymmetric_top",
          [](const Simulation& s) -> Vec { return s.body(0).W; }, 50.0};
}

}  // namespace polhode::test
