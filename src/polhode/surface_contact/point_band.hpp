// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode {

/// By how much the band of a barrier ends lower for what starts at a gap: there, so that nothing
/// is stored at the start, but a twentieth of the band is left. Zero outside of the band, and for
/// NaN, where nothing is near [m]. @eq{surface-start}
[[nodiscard]] double lowered_for(const SurfaceLaw& law, double gap_at_start);
/// The same law with a band that ends lower; the pressure in its middle stays.
[[nodiscard]] SurfaceLaw with_band_lowered(const SurfaceLaw& law, double by);
/// By how much the band ends lower that stores this energy at a gap within, per area [m].
/// @param most  Where it ends no lower than this it stores no less: of the band at hand [m].
/// @eq{surface-turn}
[[nodiscard]] double lowered_to_store(const SurfaceLaw& law, double gap, double energy,
                                      double most);

/// What a point remembers of closing and opening, as numbers of its history.
struct PointPhase {
  double lowered = 0.0;      ///< Its band ends lower by that [m].
  double phase = 0.0;        ///< 0: it is open; else 1 and the number of its ContactPhase.
  double restitution = 0.0;  ///< e of its impact.

  [[nodiscard]] bool open() const { return phase == 0.0; }
  [[nodiscard]] bool is(contact::ContactPhase p) const {
    return phase == 1.0 + static_cast<double>(p);
  }
  [[nodiscard]] bool in_impact() const {
    return is(contact::ContactPhase::compression) || is(contact::ContactPhase::restitution);
  }
  void set(contact::ContactPhase p) { phase = 1.0 + static_cast<double>(p); }

  /// In a step from a gap at which the point has a speed: what closes begins an impact.
  [[nodiscard]] PointPhase in_step(const SurfaceLaw& law, double gap, double speed) const;
  /// At the end of a step in which it had this phase.
  [[nodiscard]] PointPhase at_end(const SurfaceLaw& law, double gap) const;
  /// After its turn at a gap: the part e² is still stored; then it parts, or rests.
  /// @returns what it stores no more, per area.
  double turn(const SurfaceLaw& law, double gap);
  /// The law of a step in this phase.
  [[nodiscard]] SurfaceLaw law(const SurfaceLaw& law) const;
};

}  // namespace polhode
