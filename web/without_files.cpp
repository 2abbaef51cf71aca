// SPDX-License-Identifier: Apache-2.0
// Readers of surfaces and meshes in a web page, which has no files.
#include <polhode/core/error.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode {

namespace {

constexpr const char* kNoFiles = "a web page has no files";
constexpr const char* kInCode = "Describe the shape in the model itself";

}  // namespace

geometry::TriangleSurface geometry::read_surface(const std::string& path) {
  throw InputError(path, kNoFiles, kInCode);
}
solids::Mesh solids::read_mesh(const std::string& path, double /*scale*/) {
  throw InputError(path, kNoFiles, kInCode);
}

}  // namespace polhode
