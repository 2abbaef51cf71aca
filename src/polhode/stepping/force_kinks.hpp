// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Kinks of forces within a step: where an interaction or an element group passes from one smooth
/// piece of its force to the next, as a servo at its limit, a spring that acts on one side, a law
/// with corners, a cable that goes slack. @eq{force-kink}
class ForceKinks {
 public:
  explicit ForceKinks(const System& system);

  /// Whether no force of the system has kinks.
  [[nodiscard]] bool none() const {
    return items_.empty() && groups_.empty() && stops_.empty() && !contacts_;
  }
  /// Parts of a step at its start and its end that are not searched: for kinks, and for jumps.
  struct Margins {
    double kink = 0.0, jump = 0.0;
  };
  /// Part of a step from one state to another at which the first passage is complete; nothing if
  /// there is none. Between them positions follow cubic polynomials through both ends, with their
  /// velocities.
  [[nodiscard]] std::optional<double> first(const State& from, const State& to,
                                            const Margins& margins) const;
  /// Part of a step at which the first motion with dry friction has turned around; nothing if none
  /// has. Turns at its start count.
  [[nodiscard]] std::optional<double> first_turn(const State& from, const State& to,
                                                 double margin) const;
  /// Pieces of all forces at both ends of a step.
  struct Ends {
    ForcePieces before, after;
    std::vector<ClosedRow> rows_before, rows_after;  ///< Of contacts.
    /// Part of the step at which the first slip or rotation against friction turns around, of
    /// contacts that were closed before it; 1: none does.
    double turn = 1.0;
    /// Largest slip at the start of the step of a contact that slid until then and sticks in it, so
    /// that it stops or turns around in its first half [1/s]: in lengths of the model.
    double stopped = 0.0;
    /// Whether they are others at its end, or there is another state of sticking and slipping.
    [[nodiscard]] bool passed() const;
    /// Row of the same features after the step; null if it is not closed any more.
    [[nodiscard]] const ClosedRow* later(const ClosedRow& row) const;
  };
  [[nodiscard]] Ends ends(const State& from, const State& to) const;
  /// Part of a step at whose end something that sticks, or rests on a stop, is held by as much as
  /// it can be, by the forces of this step and the one before; nothing if that is later, or it does
  /// not stick in both.
  [[nodiscard]] std::optional<double> break_away(const State& from, const State& to,
                                                 const Ends& ends) const;

 private:
  struct Between;
  /// Pieces of all forces. @param histories  Part of the step at which they are taken.
  /// @param stops  Also of interactions with stops alone, of which nothing changes in between.
  [[nodiscard]] ForcePieces pieces(const Between& states, double part, double histories,
                                   bool stops) const;
  /// First passage between pieces of one sort. @param kept  Histories remain those at the start.
  [[nodiscard]] std::optional<double> first(const Between& states, double margin,
                                            std::vector<double> ForcePieces::*sort,
                                            bool kept) const;

  const System* system_;
  std::vector<InteractionRef> items_;            ///< With kinks.
  std::vector<InteractionRef> stops_;            ///< With stops alone.
  std::vector<int> groups_;                      ///< Element groups with kinks.
  const ImpulsiveContacts* contacts_ = nullptr;  ///< If they are rows.
};

}  // namespace polhode
