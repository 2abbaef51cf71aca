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

/// Collection of compressed numbers; entries of the manifest refer to them by index.
class ChunkList {
 public:
  explicit ChunkList(SceneData& scene) : chunks_(scene.chunks), later_(scene.later) {}
  /// Marks the numbers added next as not needed for the first picture.
  void later() { later_.insert(chunks_.size()); }
  /// {"c": index, "n": rows, "w": width, "t": "f" or "u"}
  Json floats(std::span<const double> values, std::size_t width);
  Json integers(std::span<const std::uint32_t> values, std::size_t width);
  Json surface(const geometry::TriangleSurface& surface);

 private:
  Json add(std::string bytes, std::size_t count, std::size_t width, const char* type);
  std::vector<std::string>& chunks_;
  std::set<std::size_t>& later_;
};

/// Lines of a text that are not empty.
[[nodiscard]] std::vector<std::string> lines_of(const std::string& text);

[[nodiscard]] Json json_of(const Vec3& v);
[[nodiscard]] Json json_of(const Quat& q);  ///< w, x, y, z.

/// Mesh of a solid as stored in the results, by the path of its group; only the topology is filled
/// in.
[[nodiscard]] solids::Mesh mesh_of_results(const io::ResultsReader& results,
                                           const std::string& group);

/// Adds "meshes" and "bodies" to the manifest: each different shape once.
void add_bodies(Json& manifest, ChunkList& chunks, const io::ResultsReader& results,
                const Model* model, const SceneOptions& options);
/// Adds "joints" and "loads".
void add_connections(Json& manifest, const io::ResultsReader& results, const Model* model,
                     const SceneOptions& options);
/// Adds "solids": outer faces, edges of elements, and fields of outer nodes and elements.
void add_solids(Json& manifest, ChunkList& chunks, const io::ResultsReader& results,
                std::size_t every);
/// Adds "beams" and "cables".
void add_lines(Json& manifest, const io::ResultsReader& results, const Model* model);

}  // namespace polhode
