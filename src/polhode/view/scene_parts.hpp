// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/view/scene.hpp>

namespace polhode {

using Json = nlohmann::ordered_json;

/// Collector of packed numbers; entries of the manifest name them by index.
class ChunkList {
 public:
  explicit ChunkList(std::vector<std::string>& chunks) : chunks_(chunks) {}
  /// {"c": index, "n": rows, "w": width, "t": "f" or "u"}
  Json floats(std::span<const double> values, std::size_t width);
  Json integers(std::span<const std::uint32_t> values, std::size_t width);
  Json surface(const TriangleSurface& surface);

 private:
  Json add(std::string bytes, std::size_t count, std::size_t width, const char* type);
  std::vector<std::string>& chunks_;
};

[[nodiscard]] Json json_of(const Vec3& v);
[[nodiscard]] Json json_of(const Quat& q);  ///< w, x, y, z.

/// Fills in "meshes" and "bodies" of the manifest: each different shape once.
void add_bodies(Json& manifest, ChunkList& chunks, const ResultsReader& results,
                const Model* model);
/// Fills in "joints" and "loads".
void add_connections(Json& manifest, const ResultsReader& results, const Model* model,
                     const SceneOptions& options);
/// Fills in "solids": outer faces, edges of elements, and nodal fields on the outside.
void add_solids(Json& manifest, ChunkList& chunks, const ResultsReader& results, std::size_t every);
/// Fills in "beams" and "cables".
void add_lines(Json& manifest, const ResultsReader& results, const Model* model);

}  // namespace polhode
