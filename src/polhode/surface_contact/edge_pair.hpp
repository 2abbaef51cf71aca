// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/surface_contact/edge_lines.hpp>
#include <polhode/surface_contact/line_friction.hpp>
#include <polhode/surface_contact/plane_friction.hpp>
#include <polhode/surface_contact/slip_rates.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode {

/// What two edges that may cross bring along.
struct EdgePairData {
  /// For the ends of both: the part of what an end does that other edges do, which end there too.
  /// (n − 1)/n where n edges meet, 0 at a loose end.
  double shared[4]{};
  double squares = 1.0;  ///< Product of both squared lengths at the start [m⁴].
  double centre = 0.0;   ///< Distance at which the gap is zero [m].
  /// How far the edges' potential is drawn back where they lie along each other, which makes them
  /// round ones; 0: sharp ones, whose potential fades there [m].
  double retreat = 0.0;
  double behind = 0.0;  ///< How far that of their points lies behind [m].
  /// Of both edges: parts, and their area over that of a crossing.
  EdgeLines::Points points[2];
};

/// Two edges over a step, per area: the potential m(c) B of
///
///   B = β(d) − Σ_i s_i β(d_i) + Σ_ij s_i s_j β(d_ij)
///
/// with d the distance of the edges, d_i that of an end of one of them from the other edge and d_ij
/// that of two ends: along a line of edges it does not matter which of them are crossed. m goes
/// from 0 to 1 between 3 and 10 degrees between the edges, of which c = |e × f|² is the measure,
/// squared lengths too: edges that lie along each other have no nearest points, and their own
/// points meet the other surface. @eq{edge-potential}
///
/// Round edges, pieces of cables, have no faces. Their potential does not fade, but its gap grows
/// by up to a few tolerances, d − D + r (1 − m(c)), and points of each edge, which lie behind by
/// less, meet the other one: where edges cross they never act, where edges lie along each other
/// they alone do. @eq{cable-pair}
///
/// All forces act between pairs of the four ends along their averaged connections.
class EdgePair {
 public:
  using Force = CentralGap::Force;
  using Stiffness = CentralGap::Stiffness;

  /// @param alpha_f  1 at an instant. The law is to live as long.
  EdgePair(const FourMoves& moves, const EdgePairData& data, const SurfaceLaw& law, double alpha_f,
           bool conserving);

  /// Neither crossing nor near at either end of the step: nothing else is known.
  [[nodiscard]] bool acts() const { return acts_; }
  [[nodiscard]] double gap_n1() const { return gap_n1_; }               ///< [m]
  [[nodiscard]] double pressure() const { return pressure_ + along_; }  ///< Of all [Pa].
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
  /// Whether any of its distances is within the reach of the law, at t_n or t_{n+1}.
  [[nodiscard]] bool within(bool at_end) const;
  /// What it stores at t_{n+1}.
  [[nodiscard]] std::vector<GapTerm> terms() const;
  /// Of the nearest points at t_{n+1} across n, by the velocities of the four ends, as far as edges
  /// rub and do not roll on each other.
  [[nodiscard]] std::array<Mat3, 4> slip_rates(const Vec3& n) const;
  [[nodiscard]] const NearestFour& nearest() const { return nearest_; }  ///< At t_{n+1}.
  /// Middle of the nearest points, of round edges of all that press, and direction from the second
  /// to the first edge at t_{n+1}.
  [[nodiscard]] Vec3 point() const;
  [[nodiscard]] Vec3 normal() const;

 private:
  /// One of the distances in B.
  struct Part {
    double sign;
    double gap_n, gap_n1;
    contact::ForceAndSlope pressure;
    CentralGap gap;
    bool across;        ///< Of the edges; else of a point of a round one.
    Eigen::Vector4d c;  ///< Of the nearest points at t_{n+1}.
  };
  void add_edges(const Vec3 (&x_n)[4]);
  void add_points(const Vec3 (&x_n)[4]);
  /// @param e_place, f_place  As of nearest_of_edges().
  void add(double sign, double e_place, double f_place, bool across, const Vec3 (&x_n)[4]);
  [[nodiscard]] bool round() const { return data_.retreat > 0.0; }
  /// D gap / D x_{n+1} of a part.
  [[nodiscard]] Force gap_slope(const Part& part) const;
  /// What acts because m changes with the angle; its derivatives are added to K.
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

/// 0 where two edges count as parallel, 1 from where they cross for good. @eq{edge-potential}
/// @param squares  As of EdgePairData.
[[nodiscard]] double crossing(const Vec3& e, const Vec3& f, double squares);

}  // namespace polhode
