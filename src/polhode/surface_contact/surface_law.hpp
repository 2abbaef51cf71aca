// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/system/node_step.hpp>

namespace polhode::surface_contact {

/// Contact law of the surface of a solid with another one, per reference area.
struct SurfaceLaw {
  contact::NormalLaw normal;  ///< Stiffness in Pa/m.
  /// Part of the pressure that is evaluated at the end of the step: dissipative.
  double end_share = 0.0;
  double mu = 0.0;       ///< Coefficient of friction [-].
  double bristle = 0.0;  ///< Stiffness of the friction bristle [Pa/m].
};

/// Results of the contact over the last step, and since the start.
struct SurfaceReport {
  double least_gap = 0.0;        ///< At the end of the step [m].
  double normal_force = 0.0;     ///< Sum of pressure times area [N].
  Vec3 force = Vec3::Zero();     ///< On the solid, friction included [N], world.
  Vec3 friction = Vec3::Zero();  ///< Its tangential part [N].
  /// Mean of the points, weighted by normal force [m]; zero if none acts.
  Vec3 point = Vec3::Zero();
  double area = 0.0;               ///< Reference area of active points [m²].
  double largest_pressure = 0.0;   ///< [Pa]
  int sticking = 0, slipping = 0;  ///< Numbers of active points.
  double impulse = 0.0;            ///< Of the normal force since the start [N s].
  double friction_loss = 0.0;      ///< Energy dissipated by friction since the start [J].
  double normal_loss = 0.0;        ///< Likewise by the normal force, see SurfaceLaw::end_share [J].
};

/// An active point over the last step.
struct SurfacePointReport {
  Vec3 point = Vec3::Zero();                           ///< World [m].
  Vec3 normal = Vec3::UnitZ();                         ///< Towards the solid, world.
  Vec3 force = Vec3::Zero(), friction = Vec3::Zero();  ///< On the solid [N], world.
  double gap = 0.0;                                    ///< [m]
  double pressure = 0.0;                               ///< [Pa]
};

/// Contact at a node of a solid's surface.
struct NodeContact {
  double force = 0.0;  ///< Of all contacts, as pressure times area [N].
  double area = 0.0;   ///< Tributary reference area [m²]; zero: there are no contact points.
  double gap = std::numeric_limits<double>::infinity();  ///< Least of the points about it [m].
};

/// Overlap of a surface with another object.
struct SurfaceOverlap {
  double depth = 0.0;       ///< [m]; 0: in contact.
  Vec3 out = Vec3::Zero();  ///< Unit, world: direction of exit; zero if not known.
};

/// Reporting interface of a contact on the surface of a solid.
class SurfaceContactInterface {
 public:
  virtual ~SurfaceContactInterface() = default;
  [[nodiscard]] virtual const SurfaceLaw& law() const = 0;
  /// Points or edges that may be in contact.
  [[nodiscard]] virtual std::size_t places() const = 0;
  /// Restarts from the node positions of an instant before the first step, if they differ from
  /// those at construction.
  virtual void begin_at(const NodeStep& instant, double* history) const = 0;
  [[nodiscard]] virtual SurfaceReport report(const double* history) const = 0;
  /// Points that were active in the last step, at its end.
  [[nodiscard]] virtual std::vector<SurfacePointReport> point_reports(
      const NodeStep& instant, const double* history) const = 0;
  /// Adds the pressure of the last step at the nodes of solids, and their gaps at its end. Edges
  /// add nothing, as they press along lines. @param nodes  By the system's node numbers.
  virtual void add_to_nodes(const NodeStep& /*instant*/, const double* /*history*/,
                            std::vector<NodeContact>& /*nodes*/) const {}
  /// Deepest overlap at an instant, if it exceeds what the law allows. An overlap far from any
  /// surface may not be found, see SolidInside.
  [[nodiscard]] virtual std::optional<SurfaceOverlap> overlap(const NodeStep& instant) const = 0;
};

}  // namespace polhode::surface_contact
