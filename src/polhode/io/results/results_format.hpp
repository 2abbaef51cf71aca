// SPDX-License-Identifier: Apache-2.0
#pragma once

// Names of what a results file holds. docs/reference/results_file.md describes it for users; the
// viewer and other readers rely on these names, so a change is a new kFormatVersion.

namespace polhode::results {

inline constexpr int kFormatVersion = 1;
inline constexpr const char* kFileName = "results.h5";

inline constexpr const char* kTime = "/time";

/// Everything about all bodies side by side: (frames, bodies, 3), orientation (frames, bodies, 4).
inline constexpr const char* kPackedBodies = "/packed/bodies";
/// All joints side by side: force and moment (frames, joints, 3); coordinates and rates
/// (frames, coordinates), joint k owns entries first[k] to first[k] + count[k] − 1.
inline constexpr const char* kPackedJoints = "/packed/joints";

/// All loads side by side: values (frames, numbers), load k owns those from first[k] on, the
/// channels of its type one after the other.
inline constexpr const char* kPackedLoads = "/packed/loads";

/// The same under the names of bodies, joints, loads: bodies/<name>/position is (frames, 3).
inline constexpr const char* kBodies = "/bodies";
inline constexpr const char* kJoints = "/joints";
inline constexpr const char* kLoads = "/loads";
/// Models with more bodies, joints and loads than this have only the packed form: each takes a
/// fifth of a millisecond when the file is made.
inline constexpr int kMaxNamed = 200;

/// Deformable solids by name: solids/<name>/nodes/displacement is (frames, nodes, 3),
/// solids/<name>/elements/von_mises (frames, elements),
/// solids/<name>/interfaces/<body>/force (frames, 3).
inline constexpr const char* kSolids = "/solids";

/// Beams and cables by name: beams/<name>/nodes/position is (frames, nodes, 3),
/// beams/<name>/elements/force (frames, elements, 3), cables/<name>/tension (frames, pieces).
inline constexpr const char* kBeams = "/beams";
inline constexpr const char* kCables = "/cables";
/// Contact of pairs of bodies, side by side and by name: contacts/<a>+<b>/gap is (frames).
inline constexpr const char* kPackedContacts = "/packed/contacts";
inline constexpr const char* kContacts = "/contacts";

inline constexpr const char* kEnergy = "/energy";
inline constexpr const char* kMomentum = "/momentum";
inline constexpr const char* kSolver = "/solver";
inline constexpr const char* kProvenance = "/provenance";

}  // namespace polhode::results
