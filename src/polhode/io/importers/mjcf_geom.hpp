// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>

#include <polhode/io/importers/mjcf_file.hpp>

namespace polhode::io {

/// A <geom>: its shape, and the mass that it has.
struct MjcfGeom {
  std::optional<RobotShape> shape;  ///< In the body's coordinates; none for what is not a shape.
  bool seen = true;                 ///< In a group that is shown by default.
  bool touches = true;              ///< Whether it takes part in contact.
  std::array<double, 3> friction{1.0, 0.005, 0.0001};  ///< Sliding, torsional [m], rolling [m].
  double dimensions = 3.0;                             ///< Of contact forces.
  std::optional<geometry::MassProperties> mass;        ///< In the body's coordinates.
  Mat3 axes = Mat3::Identity();                        ///< Its axes of inertia, likewise.
  bool ellipsoid = false;                              ///< For the flow of a medium.
};

/// The geoms of an MJCF file, and the meshes that they use.
class MjcfGeoms {
 public:
  /// @param folder  Folder of the file.
  MjcfGeoms(MjcfFile& file, const std::string& folder);

  /// @param frame  Frame of the tag's coordinates in the body's.
  /// @param massive  Whether its mass is needed: that of a shape which has none is then an error.
  [[nodiscard]] MjcfGeom read(const MjcfTag& tag, const Pose& frame, bool massive);

 private:
  struct Mesh {
    const XmlFile::Element* at;
    std::string file;
    Vec3 scale;
    std::string inertia;  ///< How its mass properties are found.
    Pose reference;       ///< Frame of the mesh in the file's coordinates, before the scale.
  };
  [[nodiscard]] std::set<std::string> names_in_pairs();
  [[nodiscard]] geometry::MassProperties mass_of_mesh(const Mesh& mesh);

  /// Heights of an <hfield>, rows from -y to +y, over a grid.
  struct Heights {
    double along_x, along_y;  ///< Spacing of the grid [m].
    std::vector<std::vector<double>> rows;
  };
  void read_heights(const XmlFile::Element& e);

  MjcfFile& file_;
  std::string folder_;
  std::set<std::string> in_pairs_;
  std::map<std::string, Mesh> meshes_;
  std::map<std::string, Heights> heights_;
};

}  // namespace polhode::io
