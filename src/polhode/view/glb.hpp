// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/view/scene.hpp>

namespace polhode {

/// Moving bodies of a scene as binary glTF 2.0 (Khronos Group, 2021): one mesh for each different
/// shape, one animation of all bodies. Joints, loads, planes, beams, cables and deformable solids
/// are left out.
/// @throws InputError if the scene has no shapes.
[[nodiscard]] std::string scene_glb(const SceneData& scene);

}  // namespace polhode
