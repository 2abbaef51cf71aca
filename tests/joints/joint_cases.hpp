// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/math/cayley.hpp>
#include <support/random_steps.hpp>

namespace polhode::test {

/// A kind of joint with one choice of its parameters.
struct JointCase {
  const JointKind* kind;
  JointParameters parameters;
  [[nodiscard]] std::string name() const {
    std::string text = kind->name;
    for (const std::string& f : parameters.free) text += "_" + f;
    return text;
  }
};

/// The kind with its parameters; the generic one with all of its 63 choices of freedoms.
[[nodiscard]] inline std::vector<JointCase> joint_cases(const std::string& type) {
  const JointKind& kind = joint_kind(type);
  JointParameters p;
  for (const Parameter& parameter : kind.parameters) p.values[parameter.name] = 1.3;
  if (!kind.takes_free_list) return {{&kind, p}};
  std::vector<JointCase> cases;
  const std::string freedoms[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (int mask = 0; mask < 63; ++mask) {
    p.free.clear();
    for (int k = 0; k < 6; ++k)
      if (mask & (1 << k)) p.free.push_back(freedoms[k]);
    cases.push_back({&kind, p});
  }
  return cases;
}

[[nodiscard]] inline Joint make_joint(const JointCase& c, const JointFrames& frames) {
  return Joint("j", c.kind->name, Participants{0, 1}, c.kind->recipe(frames, c.parameters));
}

[[nodiscard]] inline JointFrames random_frames(Random& random) {
  return {
      .Z_a = random.vector(), .Z_b = random.vector(), .R_a = random.frame(), .R_b = random.frame()};
}

/// The motions of b that a joint with aligned frames at the origin allows: "Tx Ty Tz Rx Ry Rz" less
/// those it prevents. Frames are the same for all: in a joint whose points are apart (distance)
/// they are apart along x.
[[nodiscard]] inline std::string free_motions(const std::string& type,
                                              const JointParameters& parameters = {},
                                              const Vec3& offset = Vec3::Zero()) {
  const Joint joint("j", type, Participants{0, 1},
                    joint_kind(type).recipe(JointFrames{}, parameters));
  const Vec3 o = Vec3::Zero();
  std::string free;
  for (int k = 0; k < 6; ++k) {
    const Vec3 r = k < 3 ? Vec3(0.3 * Vec3::Unit(k)) : o;
    const Mat3 Lambda = k < 3 ? Mat3::Identity() : cay(0.3 * Vec3::Unit(k - 3));
    const BodyStep a = BodyStep::at_instant(o, Mat3::Identity(), o, o);
    const BodyStep b = BodyStep::at_instant(offset + r, Lambda, o, o);
    const StepContext context;
    // 0.3²/2 or sin 0.3 where it is prevented; exact zero or round-off where it is free.
    if (joint.residual({a, b, context, nullptr, nullptr}).norm() < 1e-14)
      free += (free.empty() ? "" : " ") + std::string(k < 3 ? "T" : "R") + "xyz"[k % 3];
  }
  return free;
}

}  // namespace polhode::test
