// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/view/scene.hpp>

namespace polhode {

using Json = nlohmann::ordered_json;

/// Collector of packed numbers; entries of the manifest name them by index.
class ChunkList {
 public:
  explicit ChunkList(SceneData& scene) : chunks_(scene.chunks), later_(scene.later) {}
  /// Says that the first picture does without the numbers that are added next.
  void later() { later_.insert(chunks_.size()); }
  /// {"c": index, "n": rows, "w": width, "t": "f" or "u"}
  Json floats(std::span<const double> values, std::size_t width);
  Json integers(std::span<const std::uint32_t> values, std::size_t width);
  Json surface(const TriangleSurface& surface);

 private:
  Json add(std::string bytes, std::size_t count, std::size_t width, const char* type);
  std::vector<std::string>& chunks_;
  std::set<std::size_t>& later_;
};

[[nodiscard]] Json json_of(const Vec3& v);
[[nodiscard]] Json json_of(const Quat& q);  ///< w, x, y, z.

/// The mesh of a solid as the results keep it, by the path of its group; only topology is filled
/// in.
[[nodiscard]] Mesh mesh_of_results(const ResultsReader& results, const std::string& group);

/// Fills in "meshes" and "bodies" of the manifest: each different shape once.
void add_bodies(Json& manifest, ChunkList& chunks, const ResultsReader& results, const Model* model,
                const SceneOptions& options);
/// Fills in "joints" and "loads".
void add_connections(Json& manifest, const ResultsReader& results, const Model* model,
                     const SceneOptions& options);
/// Fills in "solids": outer faces, edges of elements, and fields of nodes and elements outside.
void add_solids(Json& manifest, ChunkList& chunks, const ResultsReader& results, std::size_t every);
/// Fills in "beams" and "cables".
void add_lines(Json& manifest, const ResultsReader& results, const Model* model);

}  // namespace polhode
