// SPDX-License-Identifier: Apache-2.0
// Constants of the step control, for stepper.cpp: docs/theory/step_control.md.
#pragma once

namespace polhode::step_control {

/// Difference of times, as a part of a step, below which they are equal.
inline constexpr double kSameTime = 1e-9;
/// Difference of times, relative to them, that is round-off; and length of a phase between breaks,
/// in shortest steps, below which nothing more of it is left out.
inline constexpr double kRoundOff = 0x1p-44, kShortPhase = 1e3;
/// Steps in which the fastest body covers its distance from the origin: for the round-off of its
/// velocities before it has moved by as much [-].
inline constexpr double kFarAway = 4096.0;
/// Relative lengthening of a step that then ends at a requested time [-].
inline constexpr double kStretch = 1e-3;
inline constexpr double kSafety = 0.9, kSafetyComposed = 0.8, kMinFactor = 0.3, kMaxFactor = 1.6;
/// Of steps by extrapolation, whose estimate is one of this very step.
inline constexpr double kMinFactorTable = 0.1, kMaxFactorTable = 4.0;
/// Ratios of the companions' errors to the error at order 6 and at order 8, measured.
inline constexpr double kErrorOfSix = 1.0, kErrorOfEight = 2.5;
/// Degree of the extrapolation in time by which members of an extrapolated step are predicted.
inline constexpr int kMemberDegree = 2;
/// Round-off of an error estimate, for positions at the origin and relative to the distance from
/// it: the smallest attainable error.
inline constexpr double kMinError = 1e-15, kStepRoundOff = 2.2e-16;
inline constexpr double kRoundOffComposed =
    30.0;  ///< At higher orders stages and companions increase it.
/// Smallest order in the step length by which a rejected step's error decreases; otherwise it is
/// noise, which is small.
inline constexpr double kFalls = 1.5, kMaxNoise = 1e-8, kMaxNoiseComposed = 1e-11;
/// Factor on the noise found for later steps, and its decay per step.
inline constexpr double kNoiseAllowed = 2.0, kNoiseFades = 0.98;
/// Tolerated error of an impact in time, times the jump of velocities, as a part of the tolerance;
/// and the smallest factor by which a step with an impact is shortened at once.
inline constexpr double kImpactError = 0.1, kMinImpactFactor = 0.02;
/// Highest derivatives of the motion whose jumps end steps.
inline constexpr int kBreaksOfTwo = 3, kBreaksComposed = 5;
/// Independent samples of loads in a composed step, with a safety margin.
inline constexpr double kSamplesComposed = 3.0;
/// Steps of the search for a first length, and the number of fixed steps of higher order of which
/// one is measured.
inline constexpr int kStepProbes = 40, kSampled = 64;
inline constexpr double kWorthLonger = 3.0, kLonger = 10.0;
/// Drift of the balance of energy over a run that extrapolated steps may leave, in tolerances [-].
inline constexpr double kBalanceTolerances = 10.0;
/// Rounding of the work of rows in an extrapolated step [-]: positions give velocities their
/// relative rounding times the reach over the step, rows forces that are as wrong by that over the
/// step once more, which the displacement multiplies; weights and substeps enlarge it.
inline constexpr double kWorkRounding = 1e-12;
/// Part of the planned length below which a step that a limit ends is not judged by its balance.
inline constexpr double kCutShort = 0.1;
/// Trials of an extrapolated step after which order 2 is tried; the length of a step of order 2, in
/// those of equal work, above which it is taken.
inline constexpr int kTrialsOfTable = 3;
inline constexpr double kWorthTwo = 1.5;
/// Steps between comparisons of extrapolation with order 2: the first and the most; each one that
/// changes nothing multiplies them by the factor.
inline constexpr int kFirstComparison = 4, kLastComparison = 256, kLaterBy = 2;
/// Steps of order 2 beyond a stop after which extrapolation is tried again.
inline constexpr int kBeyondStop = 3;
/// Part of the allowed error below which a kink in a step of order 2 leaves its past of use.
inline constexpr double kPassesUnnoticed = 0.01;
/// Ratio to the last step below which velocities are projected onto the rows first.
inline constexpr double kMuchShorter = 0.25;
/// Trials of a step that kinks of forces may shorten; the estimate of its error judges later ones.
inline constexpr int kTrialsOfKink = 8;
/// Consecutive steps with few iterations after which a halved step grows again.
inline constexpr int kEasySteps = 3, kFewIterations = 4;
/// State::easy_steps of automatic steps: the length has to be found again.
inline constexpr int kFindAnew = -1;
/// Weight of the end of a step above which a method evaluates loads there.
inline constexpr double kLooksAtEnd = 0.999;
/// Times just before and just after a break, as parts of it [-].
inline constexpr double kJustBeside = 0x1p-47;

}  // namespace polhode::step_control
