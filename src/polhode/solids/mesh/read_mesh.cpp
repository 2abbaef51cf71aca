// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/input_file.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/mesh_cursor.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::solids {

Mesh parse_mesh(const std::string& name, std::string_view bytes, double factor) {
  if (!(factor > 0.0 && std::isfinite(factor)))
    throw InputError(name, format("the scale {} is not positive", factor),
                     "Give the metres per unit of the file, such as 0.001");
  const std::size_t dot = name.find_last_of("./\\");
  const std::string ending =
      dot == std::string::npos || name[dot] != '.' ? "" : lower_case(name.substr(dot));
  Mesh mesh;
  if (ending == ".msh")
    mesh = parse_gmsh(name, bytes);
  else if (ending == ".vtu")
    mesh = parse_vtu(name, bytes);
  else if (ending == ".inp")
    mesh = parse_abaqus(name, bytes);
  else
    throw InputError(name, format("a mesh cannot be read from a file ending in {}", quote(ending)),
                     "Use .msh (Gmsh 2.2 or 4.1), .vtu (VTK) or .inp (Abaqus)");
  if (factor == 1.0) return mesh;
  const Extent box = extent(mesh);
  const double largest = box.least.cwiseAbs().cwiseMax(box.most.cwiseAbs()).maxCoeff();
  if (largest * factor > kLargestCoordinate)
    throw InputError(name,
                     format("the scale {} makes coordinates of {:.3g} m", factor, largest * factor),
                     "Give the metres per unit of the file, such as 0.001");
  scale(mesh, factor);
  return mesh;
}

Mesh read_mesh(const std::string& path, double factor) {
  std::error_code no_matter;
  if (std::filesystem::is_directory(path, no_matter))
    throw InputError(path, "a directory is not a mesh", "Name a .msh, .vtu or .inp file in it");
  std::string bytes;
  if (const auto fault = read_input(path, bytes))
    throw InputError(path, "the file " + fault->what, fault->hint);
  return parse_mesh(path, bytes, factor);
}

}  // namespace polhode::solids
