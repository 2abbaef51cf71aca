// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <support/model_builder.hpp>

/// The models of `polhode examples chain` and `binary_tree`, built without a text in
/// between: a text of a million bodies takes longer to read than the benchmark to run.
namespace polhode::benchmark {

inline constexpr double kRod = 0.1;  ///< Length of the rods [m].
/// Far end of a rod from its centre of mass, body axes [m].
inline const Vec3 kRodEnd{0.5 * kRod, 0.0, 0.0};

inline int add_rod(test::ModelBuilder& m, int i, const Vec3& centre) {
  const double across = kRod * kRod / 12.0 + 1e-3;
  return m.body("b" + std::to_string(i), centre, 1.0, {1e-3, across, across});
}

inline void hang_rod(test::ModelBuilder& m, int i, int parent, const std::string& type,
                     const Vec3& point) {
  const Vec3 axis = i % 2 == 1 ? Vec3(0.0, 1.0, 0.0) : Vec3(0.2, 1.0, 0.3).normalized();
  m.joint("j" + std::to_string(i), type, parent, i, point, axis);
}

/// N rods in a line, held at one end, that swing down.
/// @param type  Of its joints: revolute or spherical.
inline Model chain(int N, const std::string& type) {
  test::ModelBuilder m;
  m.model.gravity = {0.0, 0.0, -9.81};
  for (int i = 0; i < N; ++i) {
    add_rod(m, i, {kRod * (i + 0.5), 0.0, 0.0});
    hang_rod(m, i, i == 0 ? kGround : i - 1, type, {kRod * i, 0.0, 0.0});
  }
  return m.model;
}

/// Rod i hangs on the end of rod (i − 1)/2, all hinges.
inline Model binary_tree(int N) {
  test::ModelBuilder m;
  m.model.gravity = {0.0, 0.0, -9.81};
  std::vector<Vec3> ends;
  for (int i = 0; i < N; ++i) {
    const int parent = i == 0 ? kGround : (i - 1) / 2;
    const Vec3 begin = i == 0 ? Vec3(0.0, 0.0, 0.0) : ends[static_cast<std::size_t>(parent)];
    const double aside = i == 0 ? 0.0 : i % 2 == 1 ? 0.03 : -0.03;
    const Vec3 end = begin + Vec3(kRod, aside, 0.0);
    add_rod(m, i, 0.5 * (begin + end));
    hang_rod(m, i, parent, "revolute", begin);
    ends.push_back(end);
  }
  return m.model;
}

}  // namespace polhode::benchmark
