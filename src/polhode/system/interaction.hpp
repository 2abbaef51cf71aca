// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <polhode/system/interaction_group.hpp>
#include <polhode/system/interaction_item.hpp>

namespace polhode {

/// Entries behind the history of a switchable item: 1 while it is off, and the values of its rows
/// when it was switched on, which are kept. @eq{switch-rows}
struct SwitchMemory {
  enum Entry : int { kOff, kHeld };
  [[nodiscard]] static int size(int rows) { return kHeld + rows; }
};

/// The group of an item type. Item derives from InteractionItem and has
/// `static constexpr const char* kKind` and `void evaluate(const PairStep&, PairTerms&) const`.
template <class Item>
class Group final : public InteractionGroup {
  static_assert(HasInteractionFunctions<Item>,
                "a function of the item has another signature than InteractionItem's");
  static_assert(Interaction<Item>,
                "functions that belong together are not all there; is one misspelt?");

 public:
  Group() : InteractionGroup(Item::kKind, kTypeTag<Item>) {}

  /// Appends an item constructed from these arguments.
  template <class... Arguments>
  Item& add(Arguments&&... arguments) {
    items_.emplace_back(std::forward<Arguments>(arguments)...);
    ++size_;
    return items_.back();
  }
  [[nodiscard]] const std::vector<Item>& items() const { return items_; }

  InteractionDescription describe(int i) const override {
    const Item& item = at(i);
    const bool switches = switched(i);
    InteractionDescription d;
    InteractionTraits& t = d.traits;
    t.name = item.name;
    t.bodies = item.bodies;
    t.rows = item.rows();
    t.off = switches ? item.history_size() + SwitchMemory::kOff : -1;
    t.history_size = item.history_size() + (switches ? SwitchMemory::size(t.rows) : 0);
    // Elimination with a couple needs exact rows.
    t.coupling = item.coupling();
    if (switches && t.coupling == Coupling::couple) t.coupling = Coupling::all;
    t.switching = item.switching;
    t.lazy_history = !switches && item.lazy_history();
    t.conservative = item.conservative();
    t.dissipates = item.dissipates();
    t.works = t.rows == 0 || item.works();
    t.prescribes = item.prescribes();
    t.has_barrier = item.has_barrier();
    t.always_queried = item.always_queried();
    t.reversible = item.reversible();
    t.compliant = item.compliant();
    t.set_valued = item.set_valued();
    t.holds_ground = item.holds_ground();
    t.piecewise = item.piecewise();
    t.row_goes_on = item.row_goes_on();
    t.impulse_sum = item.impulse_sum();
    t.work_entry = static_cast<short>(item.work_entry());
    t.impulse_entry = static_cast<short>(item.impulse_entry());
    t.unilateral = static_cast<short>(item.unilateral());
    t.unilateral_entry = static_cast<short>(item.unilateral_entry());
    t.coupled_mass = item.coupled_mass();
    t.reach = item.reach();
    t.time_order = item.time_order();
    t.refusal = item.refusal();
    if (!switches) d.motion_basis = item.motion_basis();
    d.time_functions = item.time_functions();
    return d;
  }
  void set_switching(int i, Switching how) override {
    items_[static_cast<std::size_t>(i)].switching = how;
  }
  void reverse(int i) override { items_[static_cast<std::size_t>(i)].reverse(); }
  PrescribedRows prescribed(int i, const PairStep& step, TimeSide side) const override {
    PrescribedRows rows;
    if (!off(i, step.history)) at(i).prescribed(step, side, rows);
    return rows;
  }
  void evaluate(std::span<const int> list, std::span<const PairStep> steps,
                std::span<PairTerms> terms) const override {
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (switched(list[k])) {
        evaluate_switched(list[k], steps[k], terms[k]);
        continue;
      }
      steps[k].context.tangents ? terms[k].set_sums_zero() : terms[k].set_values_zero();
      at(list[k]).evaluate(steps[k], terms[k]);
    }
  }
  void acceleration_terms(int i, const PairStep& step, Vec6& gamma) const override {
    if (!off(i, step.history)) at(i).acceleration_terms(step, gamma);
  }
  Work work(int i, const PairStep& step) const override {
    return off(i, step.history) ? Work{} : at(i).work(step);
  }
  double clearance(int i, const PairStep& step) const override {
    return off(i, step.history) ? 1.0 : at(i).clearance(step);
  }
  void initialize(int i, const PairStep& step, double* history) const override {
    at(i).initialize(step, history);
  }
  void commit(int i, const PairStep& step, double* history) const override {
    off(i, history) ? at(i).commit_off(step, history) : at(i).commit(step, history);
  }
  bool acceptable(int i, const PairStep& step) const override {
    return off(i, step.history) || at(i).acceptable(step);
  }
  void pieces(int i, const PairStep& step, ForcePieces& pieces) const override {
    if (!off(i, step.history)) at(i).pieces(step, pieces);
  }
  void extrapolate(int i, const PairStep& step, const Vec6& of_a, const Vec6& of_b,
                   double* history) const override {
    at(i).extrapolate(step, of_a, of_b, history);
  }
  double switch_on(int i, const PairStep& step, double* history) const override {
    double* memory = history + at(i).history_size();
    at(i).switch_on(step, history);
    std::fill_n(memory, SwitchMemory::size(at(i).rows()), 0.0);
    PairTerms terms;
    terms.set_zero();
    const std::array<double, kMaxRows> none{};
    StepContext still = step.context;
    still.tangents = false;
    at(i).evaluate({step.a, step.b, still, none.data(), history}, terms);
    double most = 0.0;
    for (int k = 0; k < at(i).rows(); ++k) {
      memory[SwitchMemory::kHeld + k] = terms.g[k];
      most = std::max(most, std::abs(terms.g[k]));
    }
    return most;
  }

 protected:
  void one_sided(int i, const PairStep& step, std::vector<Impact>* jumps,
                 std::vector<UnilateralRow>* rows) const override {
    if (off(i, step.history)) return;
    if (jumps) at(i).impacts(step, *jumps);
    if (rows) at(i).unilateral_rows(step, *rows);
  }

 private:
  [[nodiscard]] const Item& at(int i) const { return items_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] bool switched(int i) const { return at(i).switching != Switching::never; }
  [[nodiscard]] bool off(int i, const double* history) const {
    return switched(i) && memory(i, history)[SwitchMemory::kOff] != 0.0;
  }
  [[nodiscard]] const double* memory(int i, const double* history) const {
    return history + at(i).history_size();
  }
  void evaluate_switched(int i, const PairStep& step, PairTerms& terms) const {
    terms.set_zero();
    const int rows = at(i).rows();
    if (off(i, step.history)) {
      terms.compliance.head(rows).setOnes();
      return;
    }
    at(i).evaluate(step, terms);
    const double* held = memory(i, step.history) + SwitchMemory::kHeld;
    for (int k = 0; k < rows; ++k) terms.g[k] -= held[k];
  }

  std::vector<Item> items_;
};

/// Items of a group of interactions of this type.
/// @throws std::logic_error if the group has another type.
template <class Item>
[[nodiscard]] const std::vector<Item>& items_of(const InteractionGroup& group) {
  if (!group.is_of(kTypeTag<Item>))
    throw std::logic_error("items_of: the interactions are of another kind");
  return static_cast<const Group<Item>&>(group).items();
}

}  // namespace polhode
