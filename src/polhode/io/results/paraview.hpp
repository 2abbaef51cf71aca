// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/io/results/paraview_series.hpp>
#include <polhode/model/model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/solid_contact_fields.hpp>
#include <polhode/simulation/solid_report.hpp>

namespace polhode::io {

/// Picture of one body: triangles in body axes, relative to the centre of mass.
struct BodyPicture {
  std::string name;
  geometry::TriangleSurface surface;
};

/// Pictures of the bodies of a model. A moving body without shapes is drawn as the box with its
/// mass and inertia, a point mass as a small cube, nodes of beams and cables not at all
/// (LinesWriter draws these). An unbounded plane is drawn as a square about its point that extends
/// beyond all bodies at the start.
/// @param size  Extent of the mechanism, the scale of the cube [m].
/// @throws InputError if a mesh file cannot be read.
[[nodiscard]] std::vector<BodyPicture> body_pictures(const Model& model, double size);

/// Box with the mass and inertia of a body, about its centre of mass, body axes; for a point mass a
/// cube of 2 % of `size`.
/// @param thinnest  Smallest side, as a part of the largest [-].
[[nodiscard]] geometry::TriangleSurface inertia_box(const BodySpec& body, double size,
                                                    double thinnest = 0.02);

/// Moving shapes for ParaView, as a ParaviewSeries of .vtp files: the triangles of one time, with
/// point data "velocity" [m/s], cell data "body" (index) and the names of the bodies as field data
/// "body_names".
class ParaviewWriter {
 public:
  /// @param keep  Continue existing files: times up to that one stay listed.
  /// @throws FileError
  ParaviewWriter(const std::string& folder, const std::string& name,
                 std::vector<BodyPicture> pictures, std::optional<double> keep = std::nullopt)
      : series_(folder, name, "vtp", keep), pictures_(std::move(pictures)) {}

  /// @param motions  Of every picture's body. @throws FileError
  void append(double t, const std::vector<BodyMotion>& motions);
  [[nodiscard]] std::size_t frames() const { return series_.frames(); }
  [[nodiscard]] std::optional<double> last_time() const { return series_.last_time(); }
  void sync() { series_.sync(); }    ///< @throws FileError
  void close() { series_.close(); }  ///< @throws FileError

 private:
  ParaviewSeries series_;
  std::vector<BodyPicture> pictures_;
};

/// Nodes of a cell in the order of VTK, by their places in ours.
[[nodiscard]] std::vector<std::size_t> vtk_order(const solids::CellShape& shape);

/// Deforming solids for ParaView, as a ParaviewSeries of .vtu files. Points are the present
/// positions of nodes. Point data: "displacement" [m], "velocity" [m/s] and the averages "cauchy",
/// "von_mises" [Pa], "strain_energy_density" [J/m³]. Cell data: these three by element,
/// "principal_stretches" [-], largest first, and "solid" (index); field data "solid <name>"
/// contains the index of each. Stresses have six components: xx, yy, zz, xy, yz, xz.
class SolidsWriter {
 public:
  /// @param meshes  Of the solids; nodes and cells in the order of the reports.
  /// @param keep    Continue existing files: times up to that one stay listed.
  /// @throws FileError
  SolidsWriter(const std::string& folder, const std::string& name, std::vector<std::string> solids,
               std::vector<const solids::Mesh*> meshes, std::optional<double> keep = std::nullopt)
      : series_(folder, name, "vtu", keep),
        solids_(std::move(solids)),
        meshes_(std::move(meshes)) {}

  /// @param reports  Of every solid.
  /// @param contacts  Likewise: "contact_pressure" [Pa] and "contact_gap" [m], NaN where there is
  /// none; empty: neither is written. @throws FileError
  void append(double t, const std::vector<SolidReport>& reports,
              const std::vector<SolidContactFields>& contacts = {});
  [[nodiscard]] std::size_t frames() const { return series_.frames(); }
  void sync() { series_.sync(); }    ///< @throws FileError
  void close() { series_.close(); }  ///< @throws FileError

 private:
  ParaviewSeries series_;
  std::vector<std::string> solids_;
  std::vector<const solids::Mesh*> meshes_;
};

/// Beams and cables for ParaView, as a ParaviewSeries of .vtp files with a line for each element or
/// segment. Point data: "velocity" [m/s], "radius" [m], of a circle of about the section's size,
/// for the filter Tube, and "y_axis", that of the section. Cell data: "force" (N, V_y, V_z) [N],
/// "moment" [N m], "strain" [-] and "curvature" [1/m] along section axes, for cables the tension as
/// N, and "line" (index); the names of the beams, then the cables, are field data "line_names".
class LinesWriter {
 public:
  /// @param size  Extent of the mechanism, the scale of unknown thicknesses [m].
  /// @param keep  Continue existing files: times up to that one stay listed.
  /// @throws FileError
  LinesWriter(const std::string& folder, const std::string& name, const Model& model, double size,
              std::optional<double> keep = std::nullopt);

  /// @param beams, cables  All of the model. @throws FileError
  void append(double t, const std::vector<BeamReport>& beams,
              const std::vector<CableReport>& cables);
  [[nodiscard]] std::size_t frames() const { return series_.frames(); }
  void sync() { series_.sync(); }    ///< @throws FileError
  void close() { series_.close(); }  ///< @throws FileError

 private:
  ParaviewSeries series_;
  std::vector<std::string> names_;
  std::vector<double> radii_;  ///< Of the beams, then the cables [m].
};

/// Contact forces for ParaView, as a ParaviewSeries of .vtp files: a point for each force, with
/// point data "force" and "friction" [N] on the first of its two bodies, "normal_force" [N], "gap"
/// [m] and "bodies" (two indices), to be drawn by the filter Glyph. The names of the bodies are
/// field data "body_names".
class ContactsWriter {
 public:
  /// @param keep  Continue existing files: times up to that one stay listed. @throws FileError
  ContactsWriter(const std::string& folder, const std::string& name,
                 std::vector<std::string> bodies, std::vector<int> body_of_shape,
                 std::optional<double> keep = std::nullopt)
      : series_(folder, name, "vtp", keep),
        bodies_(std::move(bodies)),
        body_of_shape_(std::move(body_of_shape)) {}

  void append(double t, const std::vector<contact::TouchingPoint>& points);  ///< @throws FileError
  void sync() { series_.sync(); }                                            ///< @throws FileError
  void close() { series_.close(); }                                          ///< @throws FileError

 private:
  ParaviewSeries series_;
  std::vector<std::string> bodies_;
  std::vector<int> body_of_shape_;
};

}  // namespace polhode::io
