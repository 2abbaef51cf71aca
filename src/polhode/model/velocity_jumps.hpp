// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

struct Model;

/// Whether velocities of a model may jump during a run: by contact, stops, events or kinks of
/// drives. Its joints then report their impulses.
[[nodiscard]] bool velocities_may_jump(const Model& model);

}  // namespace polhode
