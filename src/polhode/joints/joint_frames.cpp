// SPDX-License-Identifier: Apache-2.0
// Frames of a joint, including one that was switched on at the present position of its bodies.
#include <polhode/dynamics/load_step.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/moving_frame.hpp>

namespace polhode {

const JointFrames& Joint::held_frames(const PairStep& step, JointFrames& own) const {
  if (!anchors() || step.history[anchor() + kAnchored] == 0.0) return frames_;
  const double* held = step.history + anchor();
  own = frames_;
  own.Z_b = Eigen::Map<const Vec3>(held + kAnchorZ);
  own.R_b = Eigen::Map<const Mat3>(held + kAnchorR);
  return own;
}

Configuration Joint::at_n1(const PairStep& step) const {
  const BodyStep &a = step.a, &b = step.b;
  JointFrames own;
  const JointFrames& frames = held_frames(step, own);
  const Vec3 z_a = a.Lambda_n1 * frames.Z_a, z_b = b.Lambda_n1 * frames.Z_b;
  Configuration q{.u = (b.r_n1 - a.r_n1) + (z_b - z_a),
                  .z_a = z_a,
                  .z_b = z_b,
                  .R_a = a.Lambda_n1 * frames.R_a,
                  .R_b = b.Lambda_n1 * frames.R_b};
  if (motion_) {
    Configuration unused = q;
    move_frame(*motion_, frames_, step, unused, q);
  }
  q.bend = bend(step);
  return q;
}

Configuration Joint::at_n(const PairStep& step) const {
  JointFrames own;
  const JointFrames& frames = held_frames(step, own);
  const BodyStep &a = step.a, &b = step.b;
  Vec3 Z_a = frames.Z_a;
  Mat3 R_a = frames.R_a;
  if (motion_) {
    const FrameMotion::Placement moved =
        motion_->at(function_time_n(step.context), load_factor_n(step.context));
    Z_a += R_a * moved.d;
    R_a *= moved.D;
  }
  Configuration q;
  q.z_a = a.Lambda_n * Z_a;
  q.z_b = b.Lambda_n * frames.Z_b;
  q.u = (b.r_n - a.r_n) + (q.z_b - q.z_a);
  q.R_a = a.Lambda_n * R_a;
  q.R_b = b.Lambda_n * frames.R_b;
  q.bend = bend(step);
  return q;
}

/// Stores the frame of a relative to b at this instant.
void Joint::switch_on(const PairStep& step, double* history) const {
  count_turns(step, history);
  if (resistance_) resistance_->initialize(history + angles());
  if (!anchors()) return;
  const BodyStep &a = step.a, &b = step.b;
  double* held = history + anchor();
  held[kAnchored] = 1.0;
  Eigen::Map<Vec3>(held + kAnchorZ) =
      b.Lambda_n1.transpose() * (a.r_n1 + a.Lambda_n1 * frames_.Z_a - b.r_n1);
  Eigen::Map<Mat3>(held + kAnchorR) = b.Lambda_n1.transpose() * (a.Lambda_n1 * frames_.R_a);
}

}  // namespace polhode
