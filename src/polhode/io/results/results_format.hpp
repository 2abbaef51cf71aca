// SPDX-License-Identifier: Apache-2.0
#pragma once

// Names in a results file. docs/reference/results_file.md describes it for users; the viewer and
// other readers depend on these names, so a change needs a new kFormatVersion.

namespace polhode::io::results {

inline constexpr int kFormatVersion = 1;
inline constexpr const char* kFileName = "results.h5";

inline constexpr const char* kTime = "/time";

/// All bodies together: (frames, bodies, 3), orientation (frames, bodies, 4).
inline constexpr const char* kPackedBodies = "/packed/bodies";
/// All joints together: force and moment (frames, joints, 3); coordinates and rates (frames,
/// coordinates), joint k owns entries first[k] to first[k] + count[k] − 1.
inline constexpr const char* kPackedJoints = "/packed/joints";

/// All loads together: values (frames, numbers), load k owns those from first[k] on, the channels
/// of its type in order.
inline constexpr const char* kPackedLoads = "/packed/loads";

/// Named views of bodies, joints, loads: bodies/<name>/position is (frames, 3).
inline constexpr const char* kBodies = "/bodies";
inline constexpr const char* kJoints = "/joints";
inline constexpr const char* kLoads = "/loads";
/// Number of bodies, joints and loads above which only the packed form is written: each named view
/// takes a fifth of a millisecond at creation.
inline constexpr int kMaxNamed = 200;

/// Deformable solids by name: solids/<name>/nodes/displacement is (frames, nodes, 3),
/// solids/<name>/elements/von_mises (frames, elements),
/// solids/<name>/interfaces/<body>/force (frames, 3).
inline constexpr const char* kSolids = "/solids";

/// Beams and cables by name: beams/<name>/nodes/position is (frames, nodes, 3),
/// beams/<name>/elements/force (frames, elements, 3), cables/<name>/tension (frames, pieces).
inline constexpr const char* kBeams = "/beams";
inline constexpr const char* kCables = "/cables";
/// Contact of pairs of bodies, together and by name: contacts/<a>+<b>/gap is (frames).
inline constexpr const char* kPackedContacts = "/packed/contacts";
inline constexpr const char* kContacts = "/contacts";

inline constexpr const char* kEnergy = "/energy";
inline constexpr const char* kMomentum = "/momentum";
inline constexpr const char* kSolver = "/solver";
inline constexpr const char* kProvenance = "/provenance";

}  // namespace polhode::io::results
