// SPDX-License-Identifier: Apache-2.0
#include <polhode/assembly/interaction.hpp>

namespace polhode {

void PairTerms::set_zero() {
  wrench_a.setZero();
  wrench_b.setZero();
  D_aa.setZero();
  D_ab.setZero();
  D_ba.setZero();
  D_bb.setZero();
  B_a.setZero();
  B_b.setZero();
  G_a.setZero();
  G_b.setZero();
  g.setZero();
  compliance.setZero();
}

void clear_ground_sides(const PairStep& step, PairTerms& t) {
  if (!step.a.moves) {
    t.wrench_a.setZero();
    t.D_aa.setZero();
    t.D_ab.setZero();
    t.D_ba.setZero();
    t.B_a.setZero();
    t.G_a.setZero();
  }
  if (!step.b.moves) {
    t.wrench_b.setZero();
    t.D_bb.setZero();
    t.D_ab.setZero();
    t.D_ba.setZero();
    t.B_b.setZero();
    t.G_b.setZero();
  }
}

}  // namespace polhode
