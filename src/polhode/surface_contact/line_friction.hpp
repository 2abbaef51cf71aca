// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/central_gap.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode::surface_contact {

/// Friction lengthwise between two parallel round edges over a step, per area.
///
/// With t the mean of both directions and y from the middle of one to that of the other, they are
/// shifted by q = t·y. As q is invariant under rigid motions, forces along ∂q/∂x have neither
/// resultant nor moment: across t the edges roll on each other. @eq{cable-along}
struct LineSlide {
  double friction = 0.0;    ///< Along t on the first edge.
  double slid = 0.0;        ///< Change of q [m].
  double bristle_n1 = 0.0;  ///< [m]
  bool slips = false;
  Vec3 on_first = Vec3::Zero();  ///< Force on the first edge.
  Eigen::Matrix<double, 12, 1> force = Eigen::Matrix<double, 12, 1>::Zero();  ///< On the four ends.
  Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();    ///< By x_{n+1}.

  LineSlide() = default;
  /// @param by_pressure  D pressure / D x_{n+1}.
  /// @param kept         The bristle at t_n [m].
  LineSlide(const FourMoves& moves, double alpha, const SurfaceLaw& law, double pressure,
            const CentralGap::Force& by_pressure, double kept, bool tangent);
};

}  // namespace polhode::surface_contact
