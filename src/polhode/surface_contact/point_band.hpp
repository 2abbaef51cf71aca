// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/surface_contact/surface_law.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode::surface_contact {

/// Distance by which a barrier starts lower for a point that starts at a gap. Force begins at that
/// gap, so that no energy is stored at the start, but a twentieth of the band remains. Zero outside
/// of the band, and for NaN, where nothing is near [m]. @eq{surface-start}
[[nodiscard]] double lowered_for(const SurfaceLaw& law, double gap_at_start);
/// Law between meshes with a band that ends lower; the pressure in its middle is unchanged.
[[nodiscard]] SurfaceLaw with_band_lowered(const SurfaceLaw& law, double by);
/// Law of points on rigid shapes with the same band, in which force begins lower; deeper down it is
/// nearly unchanged. @eq{contact-later}
[[nodiscard]] SurfaceLaw beginning_later(const SurfaceLaw& law, double by);
/// One of these two.
using LoweredLaw = SurfaceLaw (*)(const SurfaceLaw& law, double by);
/// Distance by which the band starts lower so that it stores this energy at the given gaps, per
/// area [m].
/// @param least  Smallest value: that of the present law [m]. @eq{surface-turn}
[[nodiscard]] double lowered_to_store(const SurfaceLaw& law, std::span<const GapTerm> terms,
                                      double energy, double least, LoweredLaw own);
/// Distance by which the band starts lower so that it exerts this pressure at the given gaps [m];
/// `least` as above. @eq{surface-held}
[[nodiscard]] double lowered_to_press(const SurfaceLaw& law, std::span<const GapTerm> terms,
                                      double pressure, double least, LoweredLaw own);

/// Closing and opening of a point, or a pair of edges, as numbers of its history.
struct PointPhase {
  double lowered = 0.0;      ///< Distance by which its band starts lower [m].
  double phase = 0.0;        ///< 0: open; else 1 and the number of its ContactPhase.
  double restitution = 0.0;  ///< e of its impact.

  [[nodiscard]] bool open() const { return phase == 0.0; }
  [[nodiscard]] bool is(contact::ContactPhase p) const {
    return phase == 1.0 + static_cast<double>(p);
  }
  [[nodiscard]] bool in_impact() const {
    return is(contact::ContactPhase::compression) || is(contact::ContactPhase::restitution);
  }
  void set(contact::ContactPhase p) { phase = 1.0 + static_cast<double>(p); }
  /// Phase in a step from a gap with a normal speed: closing begins an impact.
  [[nodiscard]] PointPhase in_step(const SurfaceLaw& law, double gap, double speed,
                                   LoweredLaw own = beginning_later) const;
  /// Phase at the end of a step in which this phase held.
  [[nodiscard]] PointPhase at_end(const SurfaceLaw& law, double gap) const;
  /// Turn of an impact: the part e² of the energy remains stored, or as much as balances the
  /// pressure on the point; then it separates, or rests.
  /// @param terms  Terms of its potential at the end of the step.
  /// @param held  Pressure on it by others [Pa]. @returns the released energy per area.
  double turn(const SurfaceLaw& law, std::span<const GapTerm> terms, double held,
              LoweredLaw own = beginning_later);
  /// Turn at a single gap.
  double turn(const SurfaceLaw& law, double gap, double held) {
    const GapTerm one{1.0, gap};
    return turn(law, std::span(&one, 1), held);
  }
  /// Law of a step in this phase.
  [[nodiscard]] SurfaceLaw law(const SurfaceLaw& law, LoweredLaw own = beginning_later) const;
};

}  // namespace polhode::surface_contact
