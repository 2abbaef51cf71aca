// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/force_pieces.hpp>
#include <polhode/system/motion_basis.hpp>
#include <polhode/system/pair_terms.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode {

/// Defaults for items: an item derives from this and hides the functions it needs (no virtual
/// calls).
struct InteractionItem {
  std::string name;  ///< As in the user's file.
  Participants bodies;
  Switching switching = Switching::never;

  /// Updates history that continues while the item is switched off, such as counted turns.
  void commit_off(const PairStep&, double* /*history*/) const {}
  /// Activates the item at an instant, at the present position of its bodies.
  void switch_on(const PairStep&, double* /*history*/) const {}

  [[nodiscard]] int rows() const { return 0; }
  [[nodiscard]] int history_size() const { return 0; }
  /// Whether the next item of its group is a further part of its only row: a row of more than two
  /// bodies. Each part has the force of the row's multiplier on its own bodies, and its term of g.
  [[nodiscard]] bool row_goes_on() const { return false; }
  /// Whether the history only counts turns: it may then be committed after several steps, before
  /// the bodies have a relative rotation of half a turn.
  [[nodiscard]] bool lazy_history() const { return false; }
  /// Whether all work is stored: no dissipation and no external work.
  [[nodiscard]] bool conservative() const { return true; }
  /// Whether energy is dissipated: not allowed in steps backwards in time.
  [[nodiscard]] bool dissipates() const { return false; }
  /// Whether the ground takes part besides two moving bodies, whose wrenches it balances.
  [[nodiscard]] bool holds_ground() const { return false; }
  /// m_ab of a mass matrix that couples the centres of mass of a and b [kg]. In addition to the
  /// bodies' own, there is the kinetic energy −½ m_ab |v_a − v_b|², and evaluate() exerts its
  /// forces (system/mass_coupling.hpp).
  [[nodiscard]] double coupled_mass() const { return 0.0; }
  /// Whether its force has kinks at positions or rates: steps of high order end there.
  [[nodiscard]] bool piecewise() const { return false; }
  /// Adds the smooth pieces of its force at an instant.
  void pieces(const PairStep&, ForcePieces& /*pieces*/) const {}
  /// Largest distance of its points from its bodies [m]: for length scales.
  [[nodiscard]] double reach() const { return 0.0; }
  /// Functions of time of its force; absent components may be null.
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {}; }
  /// Order of the derivative of the motion that these functions give: 0 a position, 1 a velocity, 2
  /// a force.
  [[nodiscard]] int time_order() const { return 2; }
  /// Whether some of its rows follow functions of time, given by prescribed().
  [[nodiscard]] bool prescribes() const { return false; }
  void prescribed(const PairStep&, TimeSide, PrescribedRows& /*rows*/) const {}
  /// Entry of the history with the work of the prescribed rows [J]; −1: none.
  [[nodiscard]] int work_entry() const { return -1; }
  /// Sum of impulses in the history, from impulse_entry() on, and its entry.
  [[nodiscard]] ImpulseSum impulse_sum() const { return ImpulseSum::none; }
  [[nodiscard]] int impulse_entry() const { return -1; }
  /// γ in G q̈ + γ = 0 at an instant, one value per row.
  void acceleration_terms(const PairStep&, Vec6& /*gamma*/) const {}
  [[nodiscard]] Work work(const PairStep&) const { return {}; }
  /// Whether an item with rows has its own work(): friction, stops.
  [[nodiscard]] bool works() const { return false; }
  /// Whether its rows have a compliance while they are active.
  [[nodiscard]] bool compliant() const { return false; }
  /// Whether its rows are those of a set-valued law: iterations exchange the equations that hold.
  [[nodiscard]] bool set_valued() const { return false; }
  /// Whether it has an inadmissible configuration: clearance() and impacts() are then used.
  [[nodiscard]] bool has_barrier() const { return false; }
  /// Clearance to that configuration at t_{n+1}: 0 there, 1 where the barrier becomes active.
  [[nodiscard]] double clearance(const PairStep&) const { return 1.0; }
  /// Appends velocity jumps at the end of the step, which is accepted but not yet committed.
  void impacts(const PairStep&, std::vector<Impact>& /*list*/) const {}
  /// Number of its rows that only push, and the entry of the history with their records
  /// (UnilateralMemory), which the engine and the impacts write.
  [[nodiscard]] int unilateral() const { return 0; }
  [[nodiscard]] int unilateral_entry() const { return -1; }
  /// Appends these rows, all of them.
  void unilateral_rows(const PairStep&, std::vector<UnilateralRow>& /*list*/) const {}
  void initialize(const PairStep&, double* /*history*/) const {}  ///< History at the start.
  void commit(const PairStep&, double* /*history*/) const {}      ///< History at t_{n+1}.
  /// Whether the accepted configuration still has the assembled orientation, no mirror image.
  [[nodiscard]] bool acceptable(const PairStep&) const { return true; }
  /// Whether acceptable() is called after every step, not only where rows may have a mirror image.
  [[nodiscard]] bool always_queried() const { return false; }
  /// Reason if acceptable() is false.
  [[nodiscard]] const char* refusal() const { return "reached the mirror image of its assembly"; }
  /// Mixed-point iterations of statics: stores in the history the stress that the linear model at
  /// this iterate predicts for the increments (Δr, Δθ) of a and b.
  void extrapolate(const PairStep&, const Vec6& /*of_a*/, const Vec6& /*of_b*/,
                   double* /*history*/) const {}
  [[nodiscard]] std::optional<MotionBasis> motion_basis() const { return std::nullopt; }
  [[nodiscard]] Coupling coupling() const { return Coupling::all; }
  /// Whether an equivalent constraint exists with a and b exchanged, made by reverse().
  [[nodiscard]] bool reversible() const { return false; }
  void reverse() {}
};

/// Functions of InteractionItem that a type defines itself.
template <class Item>
struct OwnFunctions {
  using Base = InteractionItem;
  static constexpr bool rows = !requires {
    requires std::same_as<decltype(&Item::rows), decltype(&Base::rows)>;
  };
  static constexpr bool history_size = !requires {
    requires std::same_as<decltype(&Item::history_size), decltype(&Base::history_size)>;
  };
  static constexpr bool initialize = !requires {
    requires std::same_as<decltype(&Item::initialize), decltype(&Base::initialize)>;
  };
  static constexpr bool commit = !requires {
    requires std::same_as<decltype(&Item::commit), decltype(&Base::commit)>;
  };
  static constexpr bool extrapolate = !requires {
    requires std::same_as<decltype(&Item::extrapolate), decltype(&Base::extrapolate)>;
  };
  static constexpr bool commit_off = !requires {
    requires std::same_as<decltype(&Item::commit_off), decltype(&Base::commit_off)>;
  };
  static constexpr bool switch_on = !requires {
    requires std::same_as<decltype(&Item::switch_on), decltype(&Base::switch_on)>;
  };
  static constexpr bool lazy_history = !requires {
    requires std::same_as<decltype(&Item::lazy_history), decltype(&Base::lazy_history)>;
  };
  static constexpr bool acceleration_terms = !requires {
    requires std::same_as<decltype(&Item::acceleration_terms), decltype(&Base::acceleration_terms)>;
  };
  static constexpr bool conservative = !requires {
    requires std::same_as<decltype(&Item::conservative), decltype(&Base::conservative)>;
  };
  static constexpr bool dissipates = !requires {
    requires std::same_as<decltype(&Item::dissipates), decltype(&Base::dissipates)>;
  };
  static constexpr bool works = !requires {
    requires std::same_as<decltype(&Item::works), decltype(&Base::works)>;
  };
  static constexpr bool work = !requires {
    requires std::same_as<decltype(&Item::work), decltype(&Base::work)>;
  };
  static constexpr bool prescribes = !requires {
    requires std::same_as<decltype(&Item::prescribes), decltype(&Base::prescribes)>;
  };
  static constexpr bool prescribed = !requires {
    requires std::same_as<decltype(&Item::prescribed), decltype(&Base::prescribed)>;
  };
  static constexpr bool work_entry = !requires {
    requires std::same_as<decltype(&Item::work_entry), decltype(&Base::work_entry)>;
  };
  static constexpr bool time_functions = !requires {
    requires std::same_as<decltype(&Item::time_functions), decltype(&Base::time_functions)>;
  };
  static constexpr bool time_order = !requires {
    requires std::same_as<decltype(&Item::time_order), decltype(&Base::time_order)>;
  };
  static constexpr bool has_barrier = !requires {
    requires std::same_as<decltype(&Item::has_barrier), decltype(&Base::has_barrier)>;
  };
  static constexpr bool clearance = !requires {
    requires std::same_as<decltype(&Item::clearance), decltype(&Base::clearance)>;
  };
  static constexpr bool piecewise = !requires {
    requires std::same_as<decltype(&Item::piecewise), decltype(&Base::piecewise)>;
  };
  static constexpr bool pieces = !requires {
    requires std::same_as<decltype(&Item::pieces), decltype(&Base::pieces)>;
  };
  static constexpr bool impacts = !requires {
    requires std::same_as<decltype(&Item::impacts), decltype(&Base::impacts)>;
  };
  static constexpr bool unilateral = !requires {
    requires std::same_as<decltype(&Item::unilateral), decltype(&Base::unilateral)>;
  };
  static constexpr bool unilateral_entry = !requires {
    requires std::same_as<decltype(&Item::unilateral_entry), decltype(&Base::unilateral_entry)>;
  };
  static constexpr bool unilateral_rows = !requires {
    requires std::same_as<decltype(&Item::unilateral_rows), decltype(&Base::unilateral_rows)>;
  };
  static constexpr bool acceptable = !requires {
    requires std::same_as<decltype(&Item::acceptable), decltype(&Base::acceptable)>;
  };
  static constexpr bool always_queried = !requires {
    requires std::same_as<decltype(&Item::always_queried), decltype(&Base::always_queried)>;
  };
  static constexpr bool refusal = !requires {
    requires std::same_as<decltype(&Item::refusal), decltype(&Base::refusal)>;
  };
  static constexpr bool reversible = !requires {
    requires std::same_as<decltype(&Item::reversible), decltype(&Base::reversible)>;
  };
  static constexpr bool reverse = !requires {
    requires std::same_as<decltype(&Item::reverse), decltype(&Base::reverse)>;
  };
};

/// Concept of an item whose functions have the signatures that the integrator calls.
template <class Item>
concept HasInteractionFunctions = std::derived_from<Item, InteractionItem> &&
    requires(const Item item, const PairStep& step, PairTerms& terms, Vec6& gamma, double* history,
             std::vector<Impact>& impacts, PrescribedRows& rows, std::vector<UnilateralRow>& ends,
             ForcePieces& pieces) {
  { Item::kKind } -> std::convertible_to<const char*>;
  { item.evaluate(step, terms) } -> std::same_as<void>;
  { item.rows() } -> std::same_as<int>;
  { item.history_size() } -> std::same_as<int>;
  { item.acceleration_terms(step, gamma) } -> std::same_as<void>;
  { item.work(step) } -> std::same_as<Work>;
  { item.initialize(step, history) } -> std::same_as<void>;
  { item.commit(step, history) } -> std::same_as<void>;
  { item.commit_off(step, history) } -> std::same_as<void>;
  { item.switch_on(step, history) } -> std::same_as<void>;
  { item.prescribed(step, TimeSide::kBefore, rows) } -> std::same_as<void>;
  { item.impacts(step, impacts) } -> std::same_as<void>;
  { item.clearance(step) } -> std::same_as<double>;
  { item.unilateral_rows(step, ends) } -> std::same_as<void>;
  { item.pieces(step, pieces) } -> std::same_as<void>;
  { item.acceptable(step) } -> std::same_as<bool>;
  { item.motion_basis() } -> std::same_as<std::optional<MotionBasis>>;
};

/// Concept of an item with complete sets of related functions. A misspelt function hides nothing
/// and is never called. At compile time this reveals it if it has a counterpart, or if items of
/// its kind have to define it; not if it is one of those that stand alone: motion_basis, coupling,
/// coupled_mass, reach, compliant, set_valued, time_functions without time_order.
template <class Item>
concept Interaction = HasInteractionFunctions<Item> &&
                      // A history needs functions that initialise and commit it.
                      (!OwnFunctions<Item>::history_size ||
                       (OwnFunctions<Item>::initialize && OwnFunctions<Item>::commit)) &&
                      (OwnFunctions<Item>::history_size ||
                       !(OwnFunctions<Item>::initialize || OwnFunctions<Item>::commit ||
                         OwnFunctions<Item>::lazy_history || OwnFunctions<Item>::extrapolate ||
                         OwnFunctions<Item>::commit_off || OwnFunctions<Item>::switch_on)) &&
                      // Rows need acceleration terms.
                      OwnFunctions<Item>::rows == OwnFunctions<Item>::acceleration_terms &&
                      // Forces declare whether they conserve energy, and their work.
                      (OwnFunctions<Item>::rows ||
                       (OwnFunctions<Item>::conservative && OwnFunctions<Item>::work)) &&
                      // Dissipative items report their work.
                      (!(OwnFunctions<Item>::dissipates || OwnFunctions<Item>::works) ||
                       OwnFunctions<Item>::work) &&
                      OwnFunctions<Item>::prescribes == OwnFunctions<Item>::prescribed &&
                      // Drives count their work.
                      (!OwnFunctions<Item>::prescribes || OwnFunctions<Item>::work_entry) &&
                      (!OwnFunctions<Item>::time_order || OwnFunctions<Item>::time_functions) &&
                      (OwnFunctions<Item>::has_barrier == OwnFunctions<Item>::clearance) &&
                      (OwnFunctions<Item>::has_barrier == OwnFunctions<Item>::impacts) &&
                      (OwnFunctions<Item>::piecewise == OwnFunctions<Item>::pieces) &&
                      // Rows that only push need records.
                      (OwnFunctions<Item>::unilateral == OwnFunctions<Item>::unilateral_rows) &&
                      (OwnFunctions<Item>::unilateral == OwnFunctions<Item>::unilateral_entry) &&
                      (!(OwnFunctions<Item>::always_queried || OwnFunctions<Item>::refusal) ||
                       OwnFunctions<Item>::acceptable) &&
                      OwnFunctions<Item>::reverse == OwnFunctions<Item>::reversible;

}  // namespace polhode
