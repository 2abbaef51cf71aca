// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <loads/load_samples.hpp>
#include <polhode/beams/beam_element.hpp>

namespace polhode::test {

/// A section without symmetry: positive definite, everything coupled.
[[nodiscard]] inline Mat6 coupled_section(Random& random) {
  const Mat6 A = Mat6::NullaryExpr([&] { return random.number(); });
  Mat6 C = 0.3 * A * A.transpose();
  C.diagonal() += (Vec6() << 30.0, 12.0, 10.0, 3.0, 4.0, 5.0).finished();
  return C;
}

/// An element between two bodies in a large step, strongly bent and stretched. By default it is
/// attached away from the centres of mass.
struct BeamSample {
  PairMotion motion;
  BeamElementSpec spec;

  BeamSample(Random& random, const StepContext& context, bool off_centre = true)
      : motion(random, context) {
    motion.theta_a = random.vector(0.4);
    motion.theta_b = random.vector(0.4);
    motion.u_a = random.vector(0.3);
    motion.u_b = random.vector(0.3);
    motion.b_n.r = motion.a_n.r + 1.5 * random.direction();
    motion.a_n.W = random.vector(0.3);
    motion.b_n.W = random.vector(0.3);
    spec.name = "mast";
    spec.bodies = {0, 1};
    if (off_centre) {
      spec.end_1.Z = random.vector(0.3);
      spec.end_2.Z = random.vector(0.3);
    }
    const Vec3 y =
        motion.b_n.r + motion.b_n.q * spec.end_2.Z - motion.a_n.r - motion.a_n.q * spec.end_1.Z;
    const Mat3 frame =
        Quat::FromTwoVectors(Vec3::UnitX(), y).toRotationMatrix() * exp_map(random.vector(0.4));
    spec.end_1.Q = motion.a_n.Lambda().transpose() * frame;
    spec.end_2.Q = motion.b_n.Lambda().transpose() * frame * exp_map(random.vector(0.8));
    spec.length = 0.9 * y.norm();
    spec.reference_strain << 1.0, 0.0, 0.0, random.vector(0.3);
    spec.stiffness = coupled_section(random);
  }
  /// The element with the history of the start of the step.
  [[nodiscard]] BeamElement element() {
    const BeamElement beam(spec);
    motion.at_start([&](const PairStep& s) { beam.initialize(s, motion.history.data()); });
    return beam;
  }
};

}  // namespace polhode::test
