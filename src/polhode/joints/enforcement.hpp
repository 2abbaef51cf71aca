// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

struct JointParts;

/// Stiffness by which a joint's rows are enforced.
///
/// Penalty: the rows are springs, λ = −k g, and the joint deflects under load. Augmented
/// Lagrangian: the rows hold exactly, and the stiffnesses determine how redundant rows share their
/// load: as springs would. @eq{compliance-row} @eq{augmented-rows}
struct JointEnforcement {
  enum class Law { penalty, augmented };
  Law law = Law::penalty;
  double stiffness = 0.0;          ///< Against displacements [N/m].
  double turning_stiffness = 0.0;  ///< Against rotations [N m/rad].
};

/// Stiffnesses needed by the parts of a joint.
struct StiffnessDemand {
  bool displacements = false, rotations = false;
};
[[nodiscard]] StiffnessDemand stiffness_demand(const JointParts& parts);

/// 1/k by row, for the measure that each row has of its displacement or rotation.
/// @throws InputError at "stiffness" or "turning_stiffness" that is needed and not positive.
[[nodiscard]] Vec6 row_compliances(const JointParts& parts, const JointEnforcement& enforcement);

}  // namespace polhode
