// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/robot_tree.hpp>

namespace polhode::io {

namespace {

/// Distance of the ends of a loop, as a part of the robot's size, that is rounding of a file.
constexpr double kOpenLoop = 1e-3;

}  // namespace

void note_open_loops(const Robot& robot, const RobotTree& tree, XmlFile& xml,
                     std::vector<ImportNote>& notes) {
  double size = 0.0;
  for (const Pose& frame : tree.world) size = std::max(size, frame.p.norm());
  for (const RobotLoop& loop : robot.loops) {
    if (loop.type != "spherical" && loop.type != "revolute" && loop.type != "continuous" &&
        loop.type != "fixed")
      continue;
    Vec3 ends[2];
    bool there = true;
    for (std::size_t k = 0; k < 2; ++k) {
      const auto link = tree.link_index.find(loop.links[k]);
      there = there && link != tree.link_index.end();
      if (there) ends[k] = tree.world[static_cast<std::size_t>(link->second)] * loop.frames[k].p;
    }
    const double gap = there ? (ends[1] - ends[0]).norm() : 0.0;
    if (gap > kOpenLoop * size)
      notes.push_back({ImportNote::Kind::approximated, xml.place(*loop.at),
                       format("the loop of {} is open by {:.3g} m where its joints start, and is "
                              "closed from there: import.start gives other starts",
                              quote(loop.name), gap)});
  }
}

}  // namespace polhode::io
