// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/loads/loaded_faces.hpp>

namespace polhode::solids {

void check_faces(const std::string& name, std::span<const LoadedFaces> faces) {
  std::size_t count = 0;
  for (const LoadedFaces& f : faces) {
    (void)face_rule(f.shape);
    if (f.nodes.size() % static_cast<std::size_t>(cell_shape(f.shape).size()) != 0)
      throw InputError(name,
                       format("{} node numbers do not form faces {}", f.nodes.size(), f.shape),
                       "Give all nodes of each face");
    count += f.nodes.size();
  }
  if (count == 0)
    throw InputError(name, "there are no faces to load",
                     "Choose faces on the boundary of the solid");
}

}  // namespace polhode::solids
