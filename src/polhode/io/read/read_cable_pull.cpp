// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_context.hpp>

namespace polhode::io {

namespace {

HillMuscle read_muscle(ReadContext& context, const SourceNode& node, const std::string& path) {
  HillMuscle m;
  m.max_force = m.optimal_length = 1.0;  // Stand-ins after an error: both are required.
  Section section(context, node, context.tree.place_of(node), path, muscle_fields());
  if (!node.is_map()) return m;
  section.read_into(m);
  return m;
}

}  // namespace

void read_cable_pull(ReadContext& context, Section& section, CableLineSpec& cable) {
  cable.tension = section.time_number("tension");
  if (const SourceNode* node = section.find("muscle"))
    cable.muscle = read_muscle(context, *node, section.path("muscle"));
  const bool other = section.has("tension") || section.has("muscle");
  const auto stiffness = section.number("stiffness");
  if (section.misses("stiffness") && !other && !section.has_unknown_key())
    section.fault("'stiffness' is missing", "Give EA or, for a sliding cable, a tension.");
  cable.stiffness = stiffness.value_or(other ? 0.0 : 1.0);
  cable.slides = section.boolean("slides").value_or(other);
  cable.friction = section.number("friction").value_or(0.0);
  cable.wraps = section.number_list("wraps").value_or(std::vector<double>());
  for (const char* key : {"friction", "wraps"})
    if (section.has(key) && !cable.slides)
      section.fault(key, "requires 'slides'", "Add slides: true, or leave it out.");
  if (section.has("wraps") && !section.has("friction"))
    section.fault("wraps", "requires 'friction'", "Add friction, or leave it out.");
  if (other && !cable.slides)
    section.fault("slides",
                  format("cannot be combined with '{}'", cable.muscle ? "muscle" : "tension"),
                  "A given tension is the same in all pieces: leave it out.");
  if (cable.slides && section.has("strain"))
    section.fault("strain", "cannot be combined with 'slides'",
                  "A sliding cable has the strain l/L - 1: leave it out.");
}

}  // namespace polhode::io
