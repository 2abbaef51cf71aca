// SPDX-License-Identifier: Apache-2.0
// Numbers of the step control, for stepper.cpp: docs/theory/step_control.md.
#pragma once

namespace polhode::step_control {

/// Two times closer than this part of a step are the same.
inline constexpr double kSameTime = 1e-9;
/// Rest of a fixed step, as part of it, that the next one takes along.
inline constexpr double kLeftOver = 1e-6;
/// How much longer a step may be if it ends at a wanted time then [-].
inline constexpr double kStretch = 1e-3;
inline constexpr double kSafety = 0.9, kSafetyComposed = 0.8, kMinFactor = 0.3, kMaxFactor = 1.6;
/// What the companions' errors say of the error at order 6 and at order 8, measured.
inline constexpr double kErrorOfSix = 1.0, kErrorOfEight = 2.5;
/// Round-off of an error estimate, for places at the origin and as part of how far others are:
/// nothing below can be asked of a step.
inline constexpr double kMinError = 1e-15, kStepRoundOff = 2.2e-16;
inline constexpr double kRoundOffComposed =
    30.0;  ///< At higher orders stages and companions add to it.
/// A refused step's error falls with this power of its length at least, or it is noise; and noise
/// is small.
inline constexpr double kFalls = 1.5, kMaxNoise = 1e-8, kMaxNoiseComposed = 1e-11;
/// Noise that was found counts for the steps after it, less and less.
inline constexpr double kNoiseAllowed = 2.0, kNoiseFades = 0.98;
/// Error of an impact allowed in time, times the velocities that jump, as part of the tolerance;
/// and the part to which a step that holds one is shortened at once at most.
inline constexpr double kImpactError = 0.1, kMinImpactFactor = 0.02;
/// Highest derivatives of the motion whose jumps end steps.
inline constexpr int kBreaksOfTwo = 3, kBreaksComposed = 5;
/// Independent samples of loads that a composed step takes, to be on the safe side.
inline constexpr double kSamplesComposed = 3.0;
/// Steps of the search for a first length, and what it may be lengthened by at once. Of so many
/// fixed steps of higher order one is measured.
inline constexpr int kStepProbes = 40, kSampled = 64;
inline constexpr double kWorthLonger = 3.0, kLonger = 10.0;
/// Steps in a row with few iterations after which a halved step grows again.
inline constexpr int kEasySteps = 3, kFewIterations = 4;
/// State::easy_steps of automatic steps: the length is to be found anew.
inline constexpr int kFindAnew = -1;
/// A method with this weight of the end of a step looks at loads there.
inline constexpr double kLooksAtEnd = 0.999;
/// Times just before and just after a break, as parts of it [-].
inline constexpr double kJustBeside = 0x1p-47;

}  // namespace polhode::step_control
