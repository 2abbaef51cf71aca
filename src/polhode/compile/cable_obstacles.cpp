// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <numeric>

#include <polhode/compile/cable_obstacles.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

/// A frame of a body at the start, or the world.
struct StartFrame {
  Vec3 r = Vec3::Zero();
  Quat q = Quat::Identity();

  StartFrame(const Model& model, int body) {
    if (body == kGround) return;
    const BodySpec& spec = model.bodies.at(static_cast<std::size_t>(body));
    r = spec.position;
    q = spec.orientation;
  }
  [[nodiscard]] Vec3 out(const Vec3& Z) const { return r + q * Z; }
  [[nodiscard]] Vec3 in(const Vec3& x) const { return q.conjugate() * (x - r); }
};

/// Refuses what does not go with an obstacle, and one that is not between points of its own.
void check(const CableLineSpec& cable, std::size_t k) {
  const ObstacleSpec& obstacle = cable.around[k];
  const std::string where = format("cables.{}.around.{}", cable.name, obstacle.name);
  if (!cable.slides)
    throw InputError(format("cables.{}.around", cable.name), "requires 'slides'",
                     "Add slides: true, a tension or a muscle");
  if (cable.friction > 0.0)
    throw InputError(format("cables.{}.friction", cable.name),
                     "cannot be combined with 'around': a cable slides on obstacles freely",
                     "Leave one of them out");
  const bool sizes =
      obstacle.semi_axes.head<2>().allFinite() && obstacle.semi_axes.minCoeff() > 0.0 &&
      (std::isfinite(obstacle.semi_axes.z()) || obstacle.semi_axes.x() == obstacle.semi_axes.y());
  if (!sizes)
    throw InputError(where, "has a size that is not above zero, or a cylinder that is not round",
                     "Give a radius, or three semi_axes, above zero");
  if (obstacle.after < 0 || obstacle.after + 1 >= static_cast<int>(cable.through.size()))
    throw InputError(
        where + ".after",
        format("is {}, but the cable has {} points", obstacle.after + 1, cable.through.size()),
        "Give the number of the point before the obstacle, from 1");
  for (std::size_t i = 0; i < k; ++i)
    if (cable.around[i].after == obstacle.after)
      throw InputError(where, format("is between the same points as '{}'", cable.around[i].name),
                       "Add a point between the two obstacles");
}

StartSpan span_around(const Model& model, const CableLineSpec& cable,
                      const ObstacleSpec& obstacle) {
  const std::string where = format("cables.{}.around.{}", cable.name, obstacle.name);
  const auto first = static_cast<std::size_t>(obstacle.after);
  const StartFrame body(model, obstacle.at.body);
  const geometry::Roller roller = roller_of(obstacle);
  const auto seen = [&](std::size_t i) -> Vec3 {
    const AttachmentSpec& at = cable.through[i];
    const Vec3 x = StartFrame(model, at.body).out(at.Z);
    return obstacle.axes.transpose() * (body.in(x)-obstacle.at.Z);
  };
  const Vec3 p = seen(first), q = seen(first + 1);
  for (const std::size_t i : {first, first + 1})
    if (!(roller.depth(i == first ? p : q) >= geometry::kOutside))
      throw InputError(where,
                       format("point {} of the cable is inside of the obstacle, or on it", i + 1),
                       "Move the point out, or make the obstacle smaller");
  const auto way = geometry::wrap(roller, p, q, false);
  if (!way)
    throw InputError(where, "has no shortest line around it at the start",
                     "Give another side, or a point on either side of it");
  StartSpan span;
  span.points.push_back(cable.through[first]);
  const std::vector<Vec3> points = way->points(roller, p, q, geometry::kArcPieces);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const bool on_surface = way->touches && i > 1 && i + 1 < points.size();
    span.lengths.push_back(on_surface ? way->arc / geometry::kArcPieces
                                      : (points[i] - points[i - 1]).norm());
    if (i + 1 < points.size())
      span.points.push_back({obstacle.at.body, obstacle.at.Z + obstacle.axes * points[i]});
  }
  span.points.push_back(cable.through[first + 1]);
  return span;
}

}  // namespace

geometry::Roller roller_of(const ObstacleSpec& obstacle) {
  geometry::Roller roller{obstacle.semi_axes};
  if (obstacle.side) roller.side = Vec3(obstacle.axes.transpose() * *obstacle.side);
  return roller;
}

std::array<AttachmentSpec, 4> frame_of(const ObstacleSpec& obstacle) {
  std::array<AttachmentSpec, 4> frame;
  frame.fill(obstacle.at);
  const double arm = roller_of(obstacle).size();
  for (std::size_t k = 0; k < 3; ++k)
    frame[k + 1].Z += arm * obstacle.axes.col(static_cast<Eigen::Index>(k));
  return frame;
}

RunningCableSpec running_cable_spec(const CableLineSpec& cable) {
  RunningCableSpec r;
  r.name = cable.name;
  r.damping = cable.damping;
  r.free_length = cable.length();
  r.stiffness = cable.stiffness / r.free_length;
  r.tension_only = cable.tension_only;
  r.tension = cable.tension;
  r.muscle = cable.muscle;
  r.friction = cable.friction;
  for (const double turns : cable.wraps) r.wrapped.push_back(2.0 * std::numbers::pi * turns);
  if (cable.friction > 0.0)
    for (const CableLineSpec::Piece& piece : cable.pieces) r.pieces.push_back(piece.free_length);
  for (const ObstacleSpec& obstacle : cable.around) {
    WindingSpec w{.name = obstacle.name, .span = obstacle.after, .roller = roller_of(obstacle)};
    w.arm = w.roller.size();
    r.windings.push_back(std::move(w));
  }
  return r;
}

double StartSpan::length() const { return std::accumulate(lengths.begin(), lengths.end(), 0.0); }

std::vector<StartSpan> start_spans(const Model& model, const CableLineSpec& cable) {
  for (std::size_t k = 0; k < cable.around.size(); ++k) check(cable, k);
  std::vector<StartSpan> spans;
  for (std::size_t i = 0; i + 1 < cable.through.size(); ++i) {
    const AttachmentSpec &a = cable.through[i], &b = cable.through[i + 1];
    StartSpan span{
        {a, b}, {(StartFrame(model, b.body).out(b.Z) - StartFrame(model, a.body).out(a.Z)).norm()}};
    for (const ObstacleSpec& obstacle : cable.around)
      if (obstacle.after == static_cast<int>(i)) span = span_around(model, cable, obstacle);
    spans.push_back(std::move(span));
  }
  return spans;
}

}  // namespace polhode
