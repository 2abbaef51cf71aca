// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <polhode/body/triangle_surface.hpp>
#include <polhode/model/model.hpp>
#include <polhode/model/simulation.hpp>

namespace polhode {

/// What is drawn of one body: triangles in body axes, measured from the centre of mass.
struct BodyPicture {
  std::string name;
  TriangleSurface surface;
};

/// Pictures of the bodies of a model. A moving body without shapes is drawn as the box that has
/// its mass and inertia, a point mass as a small cube. Of a plane, which has no
/// end, a square about its point is drawn that reaches beyond all bodies at the start.
/// @param size  Extent of the mechanism, which the cube's size follows [m].
/// @throws InputError if a mesh file cannot be read.
[[nodiscard]] std::vector<BodyPicture> body_pictures(const Model& model, double size);

/// Moving shapes for ParaView: <name>.pvd lists the times, <name>/<number>.vtp holds the triangles
/// of one time, with point data "velocity" [m/s], cell data "body" (index) and the names of the
/// bodies as field data "body_names".
///
/// Every file is whole before the .pvd names it, and the .pvd is replaced at once, so that a run
/// that was killed leaves readable files.
class ParaviewWriter {
 public:
  /// @param keep  Continue existing files: times up to that one stay listed.
  /// @throws FileError
  ParaviewWriter(std::string folder, std::string name, std::vector<BodyPicture> pictures,
                 std::optional<double> keep = std::nullopt);

  /// @param motions  Of every picture's body. @throws FileError
  void append(double t, const std::vector<BodyMotion>& motions);
  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  void close() { write_list(); }  ///< @throws FileError

 private:
  void write_list();
  [[nodiscard]] std::string file(std::size_t frame) const;

  std::string folder_, name_;
  std::vector<BodyPicture> pictures_;
  std::vector<double> times_;
  double next_listing_ = 0.0;  ///< Seconds of the steady clock.
};

}  // namespace polhode
