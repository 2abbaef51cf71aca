// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/newton/row_check.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Joints and drives that cannot hold together from a state on, although they hold there: their
/// rows are dependent, and no velocities, accelerations or increments satisfy all of them.
/// @eq{row-contradiction}
/// @param dt  Length of a step; contradictions that leave no gap within it are left out [s].
/// @returns names such as "joint 'elbow'"; empty if there are none.
[[nodiscard]] std::vector<std::string> contradicting(const System& system, const State& state,
                                                     double dt);

/// Joints and drives whose rows are dependent at a state, and whose gaps after a step are those
/// that no motion closes; empty if none of them is a drive, whose values alone differ from one step
/// to the next.
/// @param gaps  By row.
[[nodiscard]] std::vector<std::string> held_open(const System& system, const State& state,
                                                 std::span<const double> gaps);

/// Joints and drives that are close to a limit position at a state: their rows are nearly
/// dependent, and the nearly dependent combination does not allow the rates of the drives.
[[nodiscard]] std::vector<std::string> at_limit(const System& system, const State& state);

/// Gap that a step of length dt leaves at a row.
[[nodiscard]] std::string gap_text(const System& system, const OpenRow& open, double dt);
/// Message about joints and drives that contradict each other; empty if there are none.
/// @param names  Theirs. @param gap  As in gap_text(), of the first step whose rows did not hold.
[[nodiscard]] std::string contradiction_text(double t, const std::vector<std::string>& names,
                                             const std::string& gap);
/// Message about a limit position; empty if it is none. @param gap  Likewise, or empty.
[[nodiscard]] std::string limit_text(const System& system, const State& state,
                                     const std::string& gap);
/// Part of a sentence about possible causes: the first joint whose friction or stop may lock it.
[[nodiscard]] std::string locking_joint(const System& system);

}  // namespace polhode
