// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include <polhode/joints/parts/coincident_points.hpp>
#include <polhode/joints/parts/distance.hpp>
#include <polhode/joints/parts/equal_turns.hpp>
#include <polhode/joints/parts/orthogonal_axes.hpp>
#include <polhode/joints/parts/point_in_plane.hpp>

namespace polhode {

/// Parts of a joint: at most one CoincidentPoints, or two planes, and one distance, and at most
/// three pairs of axes or one EqualTurns. Translation rows come first.
struct JointParts {
  bool coincident = false;
  bool equal_turns = false;
  bool turn_springs = false;  ///< Springs hold the equal turns.
  std::optional<Distance> distance;
  int planes = 0, axes = 0;
  std::array<PointInPlane, 2> plane{};
  std::array<OrthogonalAxes, 3> pair{};

  void add(const CoincidentPoints&) { coincident = true; }
  void add(const EqualTurns&) { equal_turns = true; }
  void add(const Distance& d) { distance = d; }
  void add(const PointInPlane& p) { plane.at(static_cast<std::size_t>(planes++)) = p; }
  void add(const OrthogonalAxes& p) { pair.at(static_cast<std::size_t>(axes++)) = p; }

  [[nodiscard]] int rows() const {
    return (coincident ? 3 : planes) + (distance ? 1 : 0) +
           (equal_turns ? (turn_springs ? 3 : 1) : axes);
  }
  /// Whether joint axes of both sides are needed.
  [[nodiscard]] bool turns() const { return axes > 0 || equal_turns; }

  /// Calls what(part, first_row) for each part, in the order of the rows.
  template <class What>
  void for_each(What&& what) const {
    int row = 0;
    const auto visit = [&](const auto& part) {
      what(part, row);
      row += part.kRows;
    };
    if (coincident) visit(CoincidentPoints{});
    for (int i = 0; i < planes; ++i) visit(plane[static_cast<std::size_t>(i)]);
    if (distance) visit(*distance);
    if (equal_turns && turn_springs) visit(EqualTurnsSprings{});
    if (equal_turns && !turn_springs) visit(EqualTurns{});
    for (int i = 0; i < axes; ++i) visit(pair[static_cast<std::size_t>(i)]);
  }
};

/// Columns of a joint frame.
enum JointAxis : int { kX = 0, kY = 1, kZ = 2 };

}  // namespace polhode
