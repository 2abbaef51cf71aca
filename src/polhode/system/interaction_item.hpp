// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/motion_basis.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// Defaults for items: an item derives from this and hides what it needs (no virtual calls).
struct InteractionItem {
  std::string name;  ///< As in the user's file.
  Participants bodies;
  Switching switching = Switching::never;

  /// History that goes on while the item is switched off, such as turns counted.
  void commit_off(const PairStep&, double* /*history*/) const {}
  /// Begins to act at an instant, where its bodies stand.
  void switch_on(const PairStep&, double* /*history*/) const {}

  [[nodiscard]] int rows() const { return 0; }
  [[nodiscard]] int history_size() const { return 0; }
  /// The history only counts turns: it may be committed after several steps, before the bodies
  /// have turned by half a turn against each other.
  [[nodiscard]] bool lazy_history() const { return false; }
  /// Stores all the energy it takes: neither dissipates nor puts in work.
  [[nodiscard]] bool conservative() const { return true; }
  /// Takes energy for good: does not go with steps that run backwards in time.
  [[nodiscard]] bool dissipates() const { return false; }
  /// m_ab of a mass matrix that couples the centres of mass of a and b [kg]: besides what the
  /// bodies hold, there is the kinetic energy −½ m_ab |v_a − v_b|², and evaluate() exerts its
  /// forces (system/mass_coupling.hpp).
  [[nodiscard]] double coupled_mass() const { return 0.0; }
  /// How far it reaches from its bodies [m]: for scales of length.
  [[nodiscard]] double reach() const { return 0.0; }
  /// The functions of time that its force follows; components that are not there may be null.
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {}; }
  /// Which derivative of the motion these functions are: 0 a position, 1 a speed, 2 a force.
  [[nodiscard]] int time_order() const { return 2; }
  /// True if some of its rows follow functions of time, which prescribed() gives.
  [[nodiscard]] bool prescribes() const { return false; }
  void prescribed(const PairStep&, TimeSide, PrescribedRows& /*rows*/) const {}
  /// γ in G q̈ + γ = 0 at an instant, one value per row.
  void acceleration_terms(const PairStep&, Vec6& /*gamma*/) const {}
  [[nodiscard]] Work work(const PairStep&) const { return {}; }
  /// An item with rows has a work() of its own: friction, stops.
  [[nodiscard]] bool works() const { return false; }
  /// Whether its rows have a compliance while they act.
  [[nodiscard]] bool compliant() const { return false; }
  /// Has a configuration that no step may reach: clearance() and impacts() are asked.
  [[nodiscard]] bool has_barrier() const { return false; }
  /// How far t_{n+1} is from that configuration: 0 there, 1 where it begins to be felt.
  [[nodiscard]] double clearance(const PairStep&) const { return 1.0; }
  /// Velocities that jump at the end of the step, which is accepted but not yet committed.
  void impacts(const PairStep&, std::vector<Impact>& /*list*/) const {}
  void initialize(const PairStep&, double* /*history*/) const {}  ///< History at the start.
  void commit(const PairStep&, double* /*history*/) const {}      ///< History at t_{n+1}.
  /// Mirror images: does the accepted configuration still have the assembled orientation?
  [[nodiscard]] bool acceptable(const PairStep&) const { return true; }
  /// acceptable() is asked after every step, not only where rows may have met a mirror image.
  [[nodiscard]] bool always_queried() const { return false; }
  /// What is wrong where acceptable() says no.
  [[nodiscard]] const char* refusal() const { return "reached the mirror image of a joint"; }
  /// Mixed-point iterations of statics: writes to the history the stress that the linear model at
  /// this iterate expects after the increments (Δr, Δθ) of a and b.
  void extrapolate(const PairStep&, const Vec6& /*of_a*/, const Vec6& /*of_b*/,
                   double* /*history*/) const {}
  [[nodiscard]] std::optional<MotionBasis> motion_basis() const { return std::nullopt; }
  [[nodiscard]] Coupling coupling() const { return Coupling::all; }
  /// An equivalent constraint exists with a and b exchanged; reverse() makes it so.
  [[nodiscard]] bool reversible() const { return false; }
  void reverse() {}
};

/// Which functions of InteractionItem a type has of its own.
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
  static constexpr bool impacts = !requires {
    requires std::same_as<decltype(&Item::impacts), decltype(&Base::impacts)>;
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

/// An item whose functions have the signatures that the integrator calls.
template <class Item>
concept HasInteractionFunctions = std::derived_from<Item, InteractionItem> &&
    requires(const Item item, const PairStep& step, PairTerms& terms, Vec6& gamma, double* history,
             std::vector<Impact>& impacts, PrescribedRows& rows) {
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
  { item.acceptable(step) } -> std::same_as<bool>;
  { item.motion_basis() } -> std::same_as<std::optional<MotionBasis>>;
};

/// An item that has all of what belongs together. A misspelt function hides nothing and is never
/// called: its partner gives it away here, when the item is compiled.
template <class Item>
concept Interaction = HasInteractionFunctions<Item> &&
                      // What is remembered is begun and kept.
                      (!OwnFunctions<Item>::history_size ||
                       (OwnFunctions<Item>::initialize && OwnFunctions<Item>::commit)) &&
                      (OwnFunctions<Item>::history_size ||
                       !(OwnFunctions<Item>::initialize || OwnFunctions<Item>::commit ||
                         OwnFunctions<Item>::lazy_history || OwnFunctions<Item>::extrapolate ||
                         OwnFunctions<Item>::commit_off || OwnFunctions<Item>::switch_on)) &&
                      // Rows have accelerations.
                      OwnFunctions<Item>::rows == OwnFunctions<Item>::acceleration_terms &&
                      // What takes energy says how much.
                      (!(OwnFunctions<Item>::dissipates || OwnFunctions<Item>::works) ||
                       OwnFunctions<Item>::work) &&
                      OwnFunctions<Item>::prescribes == OwnFunctions<Item>::prescribed &&
                      (!OwnFunctions<Item>::time_order || OwnFunctions<Item>::time_functions) &&
                      OwnFunctions<Item>::has_barrier == OwnFunctions<Item>::clearance &&
                      (!OwnFunctions<Item>::impacts || OwnFunctions<Item>::has_barrier) &&
                      (!(OwnFunctions<Item>::always_queried || OwnFunctions<Item>::refusal) ||
                       OwnFunctions<Item>::acceptable) &&
                      (!OwnFunctions<Item>::reverse || OwnFunctions<Item>::reversible);

}  // namespace polhode
