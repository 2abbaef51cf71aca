// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include <polhode/beams/running_cable.hpp>
#include <polhode/geometry/wrapping.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// The roller of an obstacle, along its axes.
[[nodiscard]] geometry::Roller roller_of(const ObstacleSpec& obstacle);

/// The middle of an obstacle, and a point along each of its axes.
[[nodiscard]] std::array<AttachmentSpec, 4> frame_of(const ObstacleSpec& obstacle);

/// A cable that runs over its points, without nodes.
[[nodiscard]] RunningCableSpec running_cable_spec(const CableLineSpec& cable);

/// A span of a cable at the start: points along it, its ends included, and lengths between them.
struct StartSpan {
  std::vector<AttachmentSpec> points;
  std::vector<double> lengths;  ///< [m]
  [[nodiscard]] double length() const;
};

/// Spans between the points of a cable, straight or around its obstacles.
/// @throws InputError if an obstacle is not possible, or a point is inside of it.
[[nodiscard]] std::vector<StartSpan> start_spans(const Model& model, const CableLineSpec& cable);

}  // namespace polhode
