// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

struct AnalysisSpec;

/// Time of an endless analysis up to which functions of time are searched for jumps and kinks [s]:
/// some thirty years.
inline constexpr double kEndlessHorizon = 1e9;

/// Whether an analysis has steps without an end: its duration is infinite.
[[nodiscard]] bool is_endless(const AnalysisSpec& analysis);

/// Checks that a run of the analysis has an end.
/// @throws InputError for `duration: none`.
void require_end(const AnalysisSpec& analysis);

}  // namespace polhode
