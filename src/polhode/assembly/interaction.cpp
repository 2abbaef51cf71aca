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

}  // namespace polhode
