// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/exporters/export_model.hpp>

namespace polhode::io {

/// A model as an MJCF, the format of MuJoCo: nested bodies in the coordinates of the model file, at
/// the start, which is also the reference of each joint's coordinate and the keyframe `start`.
/// @throws ModelErrors as export_model().
[[nodiscard]] Exported export_mjcf(const Simulation& simulation, const ExportOptions& options);

}  // namespace polhode::io
