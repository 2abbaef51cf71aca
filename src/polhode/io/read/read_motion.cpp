// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

namespace {

constexpr const char* kRotations[] = {"rotation_vector", "euler", "quaternion"};

void read_euler(ReadContext& context, const SourceNode& node, const std::string& path,
                FrameMotion& motion) {
  Section section(context, node, context.tree.place_of(node), path, moving_euler_fields());
  const auto sequence = section.text("sequence");
  const auto angles = section.time_vector("angles");
  if (!sequence || !angles || !check_euler_sequence(section, *sequence)) return;
  motion.rotation = FrameMotion::Rotation::euler;
  motion.sequence = *sequence;
  std::copy(angles->begin(), angles->end(), motion.parameters.begin());
}

void read_quaternion(ReadContext& context, const SourceNode& node, const std::string& path,
                     FrameMotion& motion) {
  Section section(context, node, context.tree.place_of(node), path, moving_quaternion_fields());
  const char* names[] = {"w", "x", "y", "z"};
  std::array<TimeFunctionPtr, 4> q;
  double square = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    q[k] = section.time_number(names[k]);
    if (!q[k]) return;
    square += (*q[k])(0.0) * (*q[k])(0.0);
  }
  if (square == 0.0) {
    section.fault("w", "the quaternion is zero at t = 0", "Give one of any other length.");
    return;
  }
  motion.rotation = FrameMotion::Rotation::quaternion;
  motion.parameters = q;
}

}  // namespace

std::optional<FrameMotion> read_motion(ReadContext& context, Section& section,
                                       std::array<bool, 3>& moves) {
  FrameMotion motion;
  const char* axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    moves[k] = section.has(axes[k]);
    motion.displacement[k] = section.time_number(axes[k]);
  }
  for (const char* one : kRotations)
    for (const char* other : kRotations)
      if (one != other && section.refuse_both(one, other, "Give one of them.")) return std::nullopt;
  if (const auto vector = section.time_vector("rotation_vector")) {
    motion.rotation = FrameMotion::Rotation::vector;
    std::copy(vector->begin(), vector->end(), motion.parameters.begin());
  }
  if (const SourceNode* node = section.find("euler"))
    read_euler(context, *node, section.path("euler"), motion);
  if (const SourceNode* node = section.find("quaternion"))
    read_quaternion(context, *node, section.path("quaternion"), motion);
  const bool any = moves[0] || moves[1] || moves[2] || section.has("rotation_vector") ||
                   section.has("euler") || section.has("quaternion");
  if (!any && !section.has_unknown_key())
    section.fault("nothing moves", "Give x, y, z or a rotation, or leave it out.");
  return any ? std::optional(motion) : std::nullopt;
}

}  // namespace polhode::io
