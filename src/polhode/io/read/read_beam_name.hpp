// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

/// Body of the first node of the beam that a section names by `beam`; kGround after a fault.
[[nodiscard]] inline int read_first_node(const ReadContext& context, Section& section) {
  const auto name = section.text("beam");
  if (!name) return kGround;
  for (const BeamSpec& beam : context.model.beams)
    if (beam.name == *name) return beam.first_node;
  section.fault("beam", format("there is no beam '{}'", *name), "Name an entry of 'beams'.");
  return kGround;
}

}  // namespace polhode::io
