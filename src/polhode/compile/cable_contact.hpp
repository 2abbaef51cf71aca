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

/// The centre line of a cable that touches: straight from node to node.
struct CableLine {
  std::vector<int> nodes;   ///< Of the System, bonded to what the cable's pieces hang on.
  std::vector<double> arc;  ///< Of the nodes, along the cable without force [m].
  double radius = 0.0;      ///< [m]
};

/// Adds the nodes of a cable that touches to the System.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
[[nodiscard]] CableLine add_cable_line(System& system, const Model& model,
                                       const CableLineSpec& cable, const std::vector<int>& bodies);

/// Where a cable is looked at, and how far along it each of these points is.
struct CablePoints {
  SurfacePoints points;     ///< Each with its share of the length times the diameter.
  std::vector<double> arc;  ///< Ascending [m].
};
/// Its nodes, and points between them that are no farther apart than `spacing`, half of what they
/// keep away from the core of the shape.
[[nodiscard]] CablePoints cable_points(const CableLine& line, double spacing);

/// The points as those of a mesh, and what is round about them.
[[nodiscard]] std::vector<MeshPoint> mesh_points(const SurfacePoints& points);
[[nodiscard]] RoundLine round_line(const SurfacePoints& points);

/// Takes out what does not meet a body that the cable hangs on: from each place at which it does,
/// what is nearer along the cable than half a turn about a bar of its own radius, and what leaves
/// the body from the inside.
/// @param hangs_on  Whether an attachment is one to this body.
/// @param inside    Whether a point, by its number, is in the body at the start.
void leave_out_attachments(CablePoints& points, const CableLineSpec& cable, const CableLine& line,
                           const std::function<bool(const AttachmentSpec&)>& hangs_on,
                           const std::function<bool(int)>& inside);

/// Whether a cable with contact is fastened to a body, or to another node of the beam that the body
/// is a node of.
[[nodiscard]] bool is_fastened_to(const Model& model, const AttachmentSpec& at, int body);

}  // namespace polhode
