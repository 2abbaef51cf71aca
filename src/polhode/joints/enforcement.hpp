// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

struct JointParts;

/// Stiffness by which a joint's rows are held.
///
/// Penalty: the rows are springs, λ = −k g, and the joint gives way under load. Augmented
/// Lagrangian: the rows hold exactly, as without, and the stiffnesses say how redundant ones share
/// what they hold: as springs would. @eq{compliance-row} @eq{augmented-rows}
struct JointEnforcement {
  enum class Law { penalty, augmented };
  Law law = Law::penalty;
  double stiffness = 0.0;          ///< Against displacements [N/m].
  double turning_stiffness = 0.0;  ///< Against rotations [N m/rad].
};

/// Which stiffnesses the parts of a joint ask for.
struct StiffnessDemand {
  bool displacements = false, rotations = false;
};
[[nodiscard]] StiffnessDemand stiffness_demand(const JointParts& parts);

/// 1/k by row, for the measure that each row has of its displacement or rotation.
/// @throws InputError at "stiffness" or "turning_stiffness" that is asked for and not positive.
[[nodiscard]] Vec6 row_compliances(const JointParts& parts, const JointEnforcement& enforcement);

}  // namespace polhode
