// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// Reads a mesh; the format follows from the file name: .msh (Gmsh 2.2 and 4.1, text and binary),
/// .vtu (VTK, all encodings, zlib), .inp (Abaqus: nodes, elements, sets and surfaces).
///
/// Groups of the file become sets: of elements (solids, lines), of nodes (points), and surfaces
/// (faces), which face outward from the solid they bound. Node orders are those of our shapes.
/// Elements are not checked for inversion; see check_mesh().
///
/// @param scale  Metres per unit of the file.
/// @throws InputError with file, line and column (binary: byte) for whatever cannot be read: a file
///         cut short, element types that are not supported, nodes that do not exist or are given
///         twice, counts that do not match.
[[nodiscard]] Mesh read_mesh(const std::string& path, double scale = 1.0);

/// Reads a mesh like read_mesh(), from the bytes of a file in memory.
/// @param name  First part of messages; its ending chooses the format.
[[nodiscard]] Mesh parse_mesh(const std::string& name, std::string_view bytes, double scale = 1.0);

/// Reads a given format for any file name; in the file's unit.
[[nodiscard]] Mesh parse_gmsh(const std::string& name, std::string_view bytes);
[[nodiscard]] Mesh parse_vtu(const std::string& name, std::string_view bytes);
[[nodiscard]] Mesh parse_abaqus(const std::string& name, std::string_view bytes);

}  // namespace polhode::solids
