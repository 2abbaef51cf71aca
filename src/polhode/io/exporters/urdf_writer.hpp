// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/exporters/export_model.hpp>

namespace polhode::io {

/// A model as a URDF: a tree of links below the link `world`. The origin of a link is at the joint
/// to its parent, and its axes are those of the body.
/// @throws ModelErrors as export_model().
[[nodiscard]] Exported export_urdf(const Simulation& simulation, const ExportOptions& options);

}  // namespace polhode::io
