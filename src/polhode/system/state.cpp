// SPDX-License-Identifier: Apache-2.0
#include <polhode/system/lane_access.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

BodyMotion State::motion(int slot) const {
  const BodyBlock& b = blocks[static_cast<std::size_t>(slot / kLanes)];
  const int l = slot % kLanes;
  return {.r = get(b.r, l),
          .q = Quat(b.q[0][l], b.q[1][l], b.q[2][l], b.q[3][l]),
          .v = get(b.v, l),
          .W = get(b.W, l),
          .a = get(b.a, l),
          .A = get(b.A, l),
          .h_dot = get(b.h_dot, l)};
}

void State::set_motion(int slot, const BodyMotion& m) {
  BodyBlock& b = blocks[static_cast<std::size_t>(slot / kLanes)];
  const int l = slot % kLanes;
  put(b.r, l, m.r);
  put(b.r_rest, l, Vec3::Zero());
  b.q[0][l] = m.q.w();
  b.q[1][l] = m.q.x();
  b.q[2][l] = m.q.y();
  b.q[3][l] = m.q.z();
  put(b.v, l, m.v);
  put(b.W, l, m.W);
  put(b.a, l, m.a);
  put(b.A, l, m.A);
  put(b.h_dot, l, m.h_dot);
}

}  // namespace polhode
