// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include <polhode/model/model.hpp>
#include <polhode/surface_contact/line_stretch.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/surface_contact/surface_points.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Centre line of a cable with contact: straight from node to node.
struct CableLine {
  /// Node numbers in the System; the nodes are bonded to the bodies of the cable's segments.
  std::vector<int> nodes;
  std::vector<double> arc;  ///< Arc lengths of the nodes along the unstressed cable [m].
  double radius = 0.0;      ///< [m]
};

/// Adds the nodes of a cable with contact to the System.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
[[nodiscard]] CableLine add_cable_line(System& system, const Model& model,
                                       const CableLineSpec& cable, const std::vector<int>& bodies);

/// Contact points of a cable, and their arc lengths.
struct CablePoints {
  surface_contact::SurfacePoints points;  ///< Each with its part of the length times the diameter.
  std::vector<double> arc;                ///< Ascending [m].
};
/// Contact points: nodes, and points between them at distances of at most `spacing`, half of the
/// distance they maintain from the core of the shape.
[[nodiscard]] CablePoints cable_points(const CableLine& line, double spacing);

/// Contact points as points of a mesh with a round section.
[[nodiscard]] std::vector<surface_contact::MeshPoint> mesh_points(
    const surface_contact::SurfacePoints& points);
[[nodiscard]] surface_contact::RoundLine round_line(const surface_contact::SurfacePoints& points);

/// Removes contact points near attachments to a body: from each attachment, points nearer along the
/// cable than half a turn about a bar of its own radius, and points that leave the body from the
/// inside.
/// @param hangs_on  Whether an attachment belongs to this body.
/// @param inside  Whether a point, by its number, is in the body at the start.
void leave_out_attachments(CablePoints& points, const CableLineSpec& cable, const CableLine& line,
                           const std::function<bool(const AttachmentSpec&)>& hangs_on,
                           const std::function<bool(int)>& inside);

/// Whether a cable with contact is attached to a body, or to another node of the beam that the body
/// is a node of.
[[nodiscard]] bool is_fastened_to(const Model& model, const AttachmentSpec& at, int body);

}  // namespace polhode
