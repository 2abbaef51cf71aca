// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/surface_contact/edge_lines.hpp>
#include <polhode/surface_contact/line_friction.hpp>
#include <polhode/surface_contact/plane_friction.hpp>
#include <polhode/surface_contact/slip_rates.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode::surface_contact {

/// Data of two edges that may cross.
struct EdgePairData {
  /// For the ends of both: the part of an end's contribution that is shared with other edges ending
  /// there. (n − 1)/n where n edges meet, 0 at a free end.
  double shared[4]{};
  double squares = 1.0;  ///< Product of both squared lengths at the start [m⁴].
  double centre = 0.0;   ///< Distance at which the gap is zero [m].
  /// Retraction of the edges' potential for parallel edges, which makes them round ones; 0: sharp
  /// edges, whose potential fades there [m].
  double retreat = 0.0;
  double behind = 0.0;  ///< Retraction of the potential of their points [m].
  /// Of both edges: parts, and their area over that of a crossing.
  EdgeLines::Points points[2];
};

/// Two edges over a step, per area: the potential m(c) B of
///
///   B = β(d) − Σ_i s_i β(d_i) + Σ_ij s_i s_j β(d_ij)
///
/// with d the distance of the edges, d_i that of an end of one of them from the other edge and d_ij
/// that of two ends: along a line of edges it does not matter which of them are crossed. m
/// increases from 0 to 1 between crossing angles of 3 and 10 degrees, measured by c = |e × f|²,
/// also a function of squared lengths: parallel edges have no unique nearest points, and there the
/// points of the edges are in contact with the other surface. @eq{edge-potential}
///
/// Round edges, the segments of cables, have no faces. Their potential does not fade, but its gap
/// grows by up to a few tolerances, d − D + r (1 − m(c)). Points of each edge, retracted by less,
/// contact the other edge: they are inactive where edges cross, and they alone act where edges are
/// parallel. @eq{cable-pair}
///
/// All forces act between pairs of the four ends along their averaged connecting lines.
class EdgePair {
 public:
  using Force = CentralGap::Force;
  using Stiffness = CentralGap::Stiffness;

  /// @param alpha_f  1 at an instant. The law must outlive the pair.
  EdgePair(const FourMoves& moves, const EdgePairData& data, const SurfaceLaw& law, double alpha_f,
           bool conserving);

  /// Whether the pair acts: crossing and near at one end of the step. Otherwise nothing else is
  /// defined.
  [[nodiscard]] bool acts() const { return acts_; }
  [[nodiscard]] double gap_n1() const { return gap_n1_; }               ///< [m]
  [[nodiscard]] double pressure() const { return pressure_ + along_; }  ///< Total [Pa].
  [[nodiscard]] double pressure_across() const { return pressure_; }  ///< m̄ times that of B [Pa].
  [[nodiscard]] double stored() const { return factor_n1_ * B_n1_; }  ///< At t_{n+1} [J/m²].
  [[nodiscard]] double dissipated() const;     ///< By the normal force [J/m²].
  [[nodiscard]] Force force() const;           ///< On the four ends.
  [[nodiscard]] Stiffness stiffness() const;   ///< D force / D x_{n+1}.
  [[nodiscard]] Force pressure_slope() const;  ///< D pressure_across / D x_{n+1}.
  /// @param kept  Bristle at t_n.
  [[nodiscard]] FourSlide slide(const Vec3& kept, bool tangent) const;
  /// Round edges that lie along each other.
  [[nodiscard]] LineSlide slide_along(double kept, bool tangent) const;
  /// Whether any of its distances is within the law's activation distance, at t_n or t_{n+1}.
  [[nodiscard]] bool within(bool at_end) const;
  /// Terms of its potential at t_{n+1}.
  [[nodiscard]] std::vector<GapTerm> terms() const;
  /// Slip rates of the nearest points at t_{n+1} normal to n by the velocities of the four ends,
  /// without the rolling part.
  [[nodiscard]] std::array<Mat3, 4> slip_rates(const Vec3& n) const;
  [[nodiscard]] const NearestFour& nearest() const { return nearest_; }  ///< At t_{n+1}.
  /// Contact point at t_{n+1}, midway between the nearest points, for round edges of all points
  /// under pressure; and direction from the second to the first edge.
  [[nodiscard]] Vec3 point() const;
  [[nodiscard]] Vec3 normal() const;

 private:
  /// One of the distances in B.
  struct Part {
    double sign;
    double gap_n, gap_n1;
    contact::ForceAndSlope pressure;
    CentralGap gap;
    bool across;        ///< A distance of the edges; else of a point of a round edge.
    Eigen::Vector4d c;  ///< Of the nearest points at t_{n+1}.
  };
  void add_edges(const Vec3 (&x_n)[4]);
  void add_points(const Vec3 (&x_n)[4]);
  /// @param e_place, f_place  As of nearest_of_edges().
  void add(double sign, double e_place, double f_place, bool across, const Vec3 (&x_n)[4]);
  [[nodiscard]] bool round() const { return data_.retreat > 0.0; }
  /// D gap / D x_{n+1} of a part.
  [[nodiscard]] Force gap_slope(const Part& part) const;
  /// Force due to the change of m with the angle; its derivatives are added to K.
  Force by_angle(Stiffness* K) const;
  [[nodiscard]] Force m_slope() const;  ///< D m_{n+1} / D x_{n+1}.

  FourMoves moves_;
  EdgePairData data_;
  SurfaceLaw law_;
  double alpha_;
  bool conserving_, acts_ = false;
  NearestFour nearest_;
  double gap_n1_ = 0.0;
  double c_n_ = 0.0, c_n1_ = 0.0, m_n_ = 0.0, m_n1_ = 0.0;
  double factor_ = 1.0,
         factor_n1_ = 1.0;  ///< Of B, in the middle and at the end; of round edges 1.
  double B_n_ = 0.0, B_n1_ = 0.0, pressure_ = 0.0, along_ = 0.0;
  std::vector<Part> parts_;
};

/// m of a crossing: 0 where the edges count as parallel, 1 where they cross fully.
/// @eq{edge-potential}
/// @param squares  As of EdgePairData.
[[nodiscard]] double crossing(const Vec3& e, const Vec3& f, double squares);

}  // namespace polhode::surface_contact
