// SPDX-License-Identifier: Apache-2.0
// Friction of a running cable: from its lengths to the tensions of its spans and back.
#include <cmath>

#include <polhode/beams/running_cable.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

void RunningCable::add_friction() {
  const std::string where = format("cables.{}.friction", spec_.name);
  const std::size_t pieces = spec_.nodes.size() - 1;
  if (pieces < 2)
    throw InputError(where, "needs a point between the ends of the cable",
                     "Give three points or more, or leave it out");
  if (spec_.tension || spec_.muscle)
    throw InputError(where,
                     format("cannot be combined with {}", spec_.muscle ? "muscle" : "tension"),
                     "Pull at an end of the cable, with a force or motor of the body there");
  if (!(spec_.stiffness > 0.0)) throw InputError(where, "needs the cable's stiffness", "Give EA");
  if (spec_.wrapped.empty()) spec_.wrapped.assign(pieces - 1, 0.0);
  if (spec_.wrapped.size() != pieces - 1)
    throw InputError(
        format("cables.{}.wraps", spec_.name),
        format("has {} numbers for {} points between the ends", spec_.wrapped.size(), pieces - 1),
        "Give one number of turns for each of these points");
  std::vector<double> stiffness;
  for (const double length : spec_.pieces) {
    if (!(length > 0.0))
      throw InputError(where, "has two equal points in sequence", "Leave one of them out");
    stiffness.push_back(spec_.stiffness * spec_.free_length / length);
  }
  friction_.emplace(std::move(stiffness));
}

/// @eq{cable-capstan} @eq{cable-capstan-step}
RunningCable::Grip RunningCable::grip(const NodeStep& step, const Course& c, double mean,
                                      const double* history) const {
  Grip g;
  const auto pieces = static_cast<Eigen::Index>(c.spans.size());
  Vec ratio(pieces - 1), change(pieces);
  for (Eigen::Index k = 0; k < pieces; ++k) change[k] = c.spans[static_cast<std::size_t>(k)].change;
  for (std::size_t j = 0; j + 1 < c.spans.size(); ++j) {
    const Span &first = c.spans[j], &second = c.spans[j + 1];
    const Vec3 across = first.n.cross(second.n);
    const double sine = across.norm();
    const double turn = std::atan2(sine, first.n.dot(second.n)) + spec_.wrapped[j];
    ratio[static_cast<Eigen::Index>(j)] = std::exp(-spec_.friction * turn);
    g.turn_first.push_back(Vec3::Zero());
    g.turn_second.push_back(Vec3::Zero());
    if (!(sine > 0.0)) continue;  // straight: the turning angle has no first derivative
    const Vec3 axis = step.alpha_f / sine * across;
    g.turn_first.back() = -first.per_length / first.n.squaredNorm() * axis.cross(first.n);
    g.turn_second.back() = second.per_length / second.n.squaredNorm() * axis.cross(second.n);
  }
  const Vec parts = parts_of(history);
  const double dt = std::abs(step.context.dt);
  const double weight = dt == 0.0 ? 0.0 : step.alpha_f + spec_.damping / (spec_.stiffness * dt);
  g.by_change = weight * friction_->stretch();
  const Vec level = Vec::Constant(pieces, mean);
  g.held = friction_->hold(level + parts + g.by_change * change, ratio);
  if (dt == 0.0) return g;
  const Vec both = g.held.tension.head(pieces - 1) + g.held.tension.tail(pieces - 1);
  const Vec most = ((1.0 - ratio.array()) / (1.0 + ratio.array()) * both.array()).cwiseMax(0.0);
  g.parts = friction_->hold_differences(parts + friction_->stretch() * change, most);
  return g;
}

Mat RunningCable::tension_by_nodes(const Grip& g, const Course& c, const Vec& of_mean) const {
  const auto pieces = static_cast<Eigen::Index>(c.spans.size());
  Mat trial = Vec::Ones(pieces) * of_mean.transpose();
  Mat turn = Mat::Zero(pieces - 1, of_mean.size());
  for (Eigen::Index k = 0; k < pieces; ++k) {
    const Eigen::Index i = 3 * k, j = i + 3;
    const Mat by_point = g.by_change.col(k) * c.spans[static_cast<std::size_t>(k)].e.transpose();
    trial.middleCols<3>(i) -= by_point;
    trial.middleCols<3>(j) += by_point;
    const auto add_turn = [&](Eigen::Index point, const Vec3& by) {
      turn.row(point).segment<3>(i) -= by.transpose();
      turn.row(point).segment<3>(j) += by.transpose();
    };
    if (k > 0) add_turn(k - 1, g.turn_second[static_cast<std::size_t>(k - 1)]);
    if (k + 1 < pieces) add_turn(k, g.turn_first[static_cast<std::size_t>(k)]);
  }
  return g.held.by_trial * trial - spec_.friction * g.held.by_ratio * turn;
}

}  // namespace polhode
