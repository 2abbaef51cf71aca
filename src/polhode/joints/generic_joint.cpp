// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/joints/generic_joint.hpp>

namespace polhode {

namespace {

constexpr std::array<std::string_view, 6> kFreedoms{"x", "y", "z", "rx", "ry", "rz"};

std::array<bool, 6> locked_freedoms(const std::vector<std::string>& free) {
  std::array<bool, 6> locked;
  locked.fill(true);
  for (const std::string& name : free) {
    const auto found = std::find(kFreedoms.begin(), kFreedoms.end(), name);
    if (found == kFreedoms.end())
      throw InputError("free", format("'{}' is no freedom of a joint", name),
                       "Use some of: x, y, z, rx, ry, rz");
    bool& lock = locked[static_cast<std::size_t>(found - kFreedoms.begin())];
    if (!lock)
      throw InputError("free", format("'{}' is given twice", name), "Give each freedom once");
    lock = false;
  }
  if (std::none_of(locked.begin(), locked.end(), [](bool lock) { return lock; }))
    throw InputError("free", "all six freedoms are free, so the joint has no constraint",
                     "Leave the joint out, or lock a freedom");
  return locked;
}

}  // namespace

JointRecipe generic_joint(const JointFrames& f, const JointParameters& p) {
  const std::array<bool, 6> locked = locked_freedoms(p.free);
  const auto is_locked = [&](int freedom) { return locked[static_cast<std::size_t>(freedom)]; };
  const int translations = is_locked(0) + is_locked(1) + is_locked(2);
  const int rotations = is_locked(3) + is_locked(4) + is_locked(5);

  // z of the parts is the rotation that differs from the other two, if any.
  int odd = 2;
  for (int k = 0; k < 3; ++k)
    if ((rotations == 1 && is_locked(3 + k)) || (rotations == 2 && !is_locked(3 + k))) odd = k;
  JointRecipe recipe;
  recipe.shift = (odd + 1) % 3;
  recipe.frames = f;
  for (int i = 0; i < 3; ++i) {
    recipe.frames.R_a.col(i) = f.R_a.col((i + recipe.shift) % 3);
    recipe.frames.R_b.col(i) = f.R_b.col((i + recipe.shift) % 3);
  }

  if (translations == 3)
    recipe.parts.add(CoincidentPoints{});
  else
    for (int k = 0; k < 3; ++k)
      if (is_locked(k)) recipe.parts.add(PointInPlane{(k - recipe.shift + 3) % 3});
  if (rotations >= 2) {
    recipe.parts.add(OrthogonalAxes{kZ, kX});
    recipe.parts.add(OrthogonalAxes{kZ, kY});
  }
  if (rotations == 1 || rotations == 3) recipe.parts.add(OrthogonalAxes{kX, kY});
  return recipe;
}

}  // namespace polhode
