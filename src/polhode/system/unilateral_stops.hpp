// SPDX-License-Identifier: Apache-2.0
// Unilateral rows of a model: its stops, whether it has any, and their names in messages.
#pragma once

#include <string>
#include <vector>

#include <polhode/system/system.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode {

/// A unilateral row of an interaction, such as a stop of a joint.
struct UnilateralStop {
  int interaction = 0, a = kGround, b = kGround;
  int memory = 0;       ///< Entry of its record in State::history.
  int number = 0;       ///< Among the rows of its interaction.
  bool exists = false;  ///< Not that of an interaction that is off.
  bool listed = false;  ///< It is a row since an earlier iteration.
  UnilateralRow row;
};

/// Unilateral rows of all interactions, in the order of these.
[[nodiscard]] std::vector<UnilateralStop> unilateral_stops(const System& system);

/// Whether a model has unilateral rows: stops of interactions, or contacts that are rows.
[[nodiscard]] bool has_unilateral_rows(const System& system);

/// "the stop of joint 'knee'".
[[nodiscard]] std::string stop_name(const System& system, int interaction);

/// "body 'a' and the ground".
[[nodiscard]] std::string pair_name(const System& system, int a, int b);

}  // namespace polhode
