// SPDX-License-Identifier: Apache-2.0
#include <polhode/dynamics/body_motion.hpp>

namespace polhode {

Vec3 BodyMotion::omega() const { return q * W; }

}  // namespace polhode
