// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/loads/registry.hpp>
#include <support/model_builder.hpp>

namespace polhode::test {

// Small systems built by hand, for statics and modes.

inline TimeVector constant(const Vec3& v) {
  TimeVector f;
  for (int i = 0; i < 3; ++i) f[i] = std::make_shared<Constant>(v[i]);
  return f;
}

inline int add_body(System& system, const std::string& name, double mass, const Vec3& r) {
  BodyMotion start;
  start.r = r;
  return system.add_body({name, mass, mass * Mat3::Identity()}, start);
}

inline void add_joint(System& system, const std::string& type, const std::string& name, int a,
                      int b, const Vec3& Z_a, const Vec3& Z_b, const Mat3& R = Mat3::Identity()) {
  const JointRecipe recipe =
      joint_kind(type).recipe({.Z_a = Z_a, .Z_b = Z_b, .R_a = R, .R_b = R}, {});
  system.group<Joint>().add(name, type, Participants{a, b}, recipe);
}

inline void add_load(System& system, const std::string& type, const LoadDescription& load) {
  load_kind(type).add(system, load);
}

}  // namespace polhode::test
