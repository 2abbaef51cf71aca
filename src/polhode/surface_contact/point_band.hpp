// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/surface_contact/surface_law.hpp>
#include <polhode/system/surface_impacts.hpp>

namespace polhode {

/// By how much lower a barrier begins to press on what starts at a gap: there, so that nothing is
/// stored at the start, but a twentieth of the band is left. Zero outside of the band, and for NaN,
/// where nothing is near [m]. @eq{surface-start}
[[nodiscard]] double lowered_for(const SurfaceLaw& law, double gap_at_start);
/// The law of meshes on each other with a band that ends lower; the pressure in its middle stays.
[[nodiscard]] SurfaceLaw with_band_lowered(const SurfaceLaw& law, double by);
/// The law of points on rigid shapes with the same band, in which force begins lower; deeper down
/// it is nearly the same. @eq{contact-later}
[[nodiscard]] SurfaceLaw beginning_later(const SurfaceLaw& law, double by);
/// One of these two.
using LoweredLaw = SurfaceLaw (*)(const SurfaceLaw& law, double by);
/// By how much lower it begins to store this energy at gaps within, per area [m].
/// @param least  Lower than this at least: the law at hand [m].
/// @eq{surface-turn}
[[nodiscard]] double lowered_to_store(const SurfaceLaw& law, std::span<const GapTerm> terms,
                                      double energy, double least, LoweredLaw own);
/// By how much lower it begins to press so much at gaps within [m]; `least` as above.
/// @eq{surface-held}
[[nodiscard]] double lowered_to_press(const SurfaceLaw& law, std::span<const GapTerm> terms,
                                      double pressure, double least, LoweredLaw own);

/// What a point, or a pair of edges, remembers of closing and opening, as numbers of its history.
struct PointPhase {
  double lowered = 0.0;      ///< It begins to press lower by that [m].
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
  [[nodiscard]] PointPhase in_step(const SurfaceLaw& law, double gap, double speed,
                                   LoweredLaw own = beginning_later) const;
  /// At the end of a step in which it had this phase.
  [[nodiscard]] PointPhase at_end(const SurfaceLaw& law, double gap) const;
  /// After its turn: the part e² is still stored, or as much as presses back on what holds it
  /// there; then it parts, or rests.
  /// @param terms  What it stores at the end of the step.
  /// @param held   Pressure by which others press it on [Pa].
  /// @returns what it stores no more, per area.
  double turn(const SurfaceLaw& law, std::span<const GapTerm> terms, double held,
              LoweredLaw own = beginning_later);
  /// At a gap.
  double turn(const SurfaceLaw& law, double gap, double held) {
    const GapTerm one{1.0, gap};
    return turn(law, std::span(&one, 1), held);
  }
  /// The law of a step in this phase.
  [[nodiscard]] SurfaceLaw law(const SurfaceLaw& law, LoweredLaw own = beginning_later) const;
};

}  // namespace polhode
