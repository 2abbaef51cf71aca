// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode {

/// How the surface of a solid and another one act on each other, per
/// reference area.
struct SurfaceLaw {
  contact::NormalLaw normal;  ///< Stiffness in Pa/m.
  double end_share = 0.0;     ///< Part of the pressure that is that of the step's
                              ///< end: takes energy.
  double mu = 0.0;            ///< Coefficient of friction [-].
  double bristle = 0.0;       ///< Stiffness of the friction bristle [Pa/m].
};

/// What the contact did over the last step, and since the start.
struct SurfaceReport {
  double least_gap = 0.0;          ///< At the end of the step [m].
  double normal_force = 0.0;       ///< Sum of pressure times area [N].
  Vec3 force = Vec3::Zero();       ///< On the solid, friction included [N], world.
  Vec3 friction = Vec3::Zero();    ///< Its tangential part [N].
  Vec3 point = Vec3::Zero();       ///< Mean of the points, by normal force [m]; zero if none acts.
  double area = 0.0;               ///< Of points that act [m²], reference.
  double largest_pressure = 0.0;   ///< [Pa]
  int sticking = 0, slipping = 0;  ///< Points that act.
  double impulse = 0.0;            ///< Of the normal force since the start [N s].
  double friction_loss = 0.0;      ///< Energy that friction took since the start [J].
  double normal_loss = 0.0;        ///< Likewise the normal force, see SurfaceLaw::end_share [J].
};

/// A point that acts, over the last step.
struct SurfacePointReport {
  Vec3 point = Vec3::Zero();                           ///< World [m].
  Vec3 normal = Vec3::UnitZ();                         ///< Towards the solid, world.
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero();  ///< On the solid [N], world.
  double gap = 0.0;                                    ///< [m]
  double pressure = 0.0;                               ///< [Pa]
};

/// How a surface lies in what it may touch.
struct SurfaceOverlap {
  double depth = 0.0;       ///< [m]; 0: they touch.
  Vec3 out = Vec3::Zero();  ///< Unit, world: where the surface goes to leave; zero if not known.
};

/// The surface of a solid that touches something: what is told of it.
class SurfaceContactInterface {
 public:
  virtual ~SurfaceContactInterface() = default;
  [[nodiscard]] virtual const SurfaceLaw& law() const = 0;
  [[nodiscard]] virtual std::size_t places() const = 0;  ///< Points or edges that may touch.
  /// Begins anew where nodes stand at an instant before the first step, if that is not where they
  /// were built.
  virtual void begin_at(const NodeStep& instant, double* history) const = 0;
  [[nodiscard]] virtual SurfaceReport report(const double* history) const = 0;
  /// Points that acted in the last step, where they are at its end.
  [[nodiscard]] virtual std::vector<SurfacePointReport> point_reports(
      const NodeStep& instant, const double* history) const = 0;
  /// Where it is deepest at an instant in what it touches, if that is beyond what its law lets
  /// pass. What is far from any surface may not be found, see SolidInside.
  [[nodiscard]] virtual std::optional<SurfaceOverlap> overlap(const NodeStep& instant) const = 0;
};

}  // namespace polhode
