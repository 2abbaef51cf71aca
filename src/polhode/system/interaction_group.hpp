// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/system/force_pieces.hpp>
#include <polhode/system/motion_basis.hpp>
#include <polhode/system/pair_terms.hpp>
#include <polhode/system/unilateral_row.hpp>

namespace polhode {

/// Constant properties of an interaction; see the functions of InteractionItem of the same names.
/// Read once, when the system is finished.
struct InteractionTraits {
  std::string name;  ///< As in the user's file.
  Participants bodies;
  int rows = 0;
  int history_size = 0;  ///< Including the entries of a switchable item.
  /// Index of the history entry that is 1 while it is switched off; -1: none.
  int off = -1;
  Coupling coupling = Coupling::all;
  Switching switching = Switching::never;
  bool lazy_history = false, conservative = true, dissipates = false;
  bool works = false;  ///< work() must be called.
  bool prescribes = false, has_barrier = false, always_queried = false, reversible = false;
  bool compliant = false, set_valued = false, holds_ground = false;
  bool piecewise = false;    ///< Its force has kinks.
  bool row_goes_on = false;  ///< The next item is a further part of its only row.
  ImpulseSum impulse_sum = ImpulseSum::none;
  short work_entry = -1, impulse_entry = -1;  ///< In the history; −1: none.
  short unilateral = 0, unilateral_entry = -1;
  double coupled_mass = 0.0;  ///< [kg]
  double reach = 0.0;         ///< [m]
  int time_order = 2;
  const char* refusal = "";
};

/// Traits and further properties that are needed only when engines are constructed.
struct InteractionDescription {
  InteractionTraits traits;
  std::optional<MotionBasis> motion_basis;
  std::vector<TimeFunctionPtr> time_functions;  ///< Null for components without one.
};

/// Address that identifies a type.
template <class Type>
inline constexpr char kTypeTag = 0;

/// All interactions of one type in a contiguous array: the assembler makes one virtual call per
/// group, not per item.
///
/// An item that is switched off has no wrench, no work and rows λ = 0. It is not part of the tree.
class InteractionGroup {
 public:
  virtual ~InteractionGroup() = default;
  InteractionGroup(const InteractionGroup&) = delete;
  InteractionGroup& operator=(const InteractionGroup&) = delete;

  [[nodiscard]] const std::string& kind() const { return kind_; }  ///< "joint", "force" ...
  [[nodiscard]] int size() const { return size_; }
  /// Whether the group's items are of a type. @param type  kTypeTag of the type.
  [[nodiscard]] bool is_of(const char& type) const { return &type == type_; }
  /// Reads the traits of all items; called by System::finish().
  void finish();
  /// Traits of an item, after finish(). @param i  Item.
  [[nodiscard]] const InteractionTraits& traits(int i) const {
    return traits_[static_cast<std::size_t>(i)];
  }
  /// Whether an item is switched off. @param history  Of the item.
  [[nodiscard]] bool is_off(int i, const double* history) const {
    const int off = traits(i).off;
    return off >= 0 && history[off] != 0.0;
  }
  void switch_off(int i, double* history) const { history[traits(i).off] = 1.0; }

  [[nodiscard]] virtual InteractionDescription describe(int i) const = 0;
  virtual void set_switching(int i, Switching how) = 0;  ///< Before finish().
  virtual void reverse(int i) = 0;                       ///< Likewise.
  /// Prescribed values with limits from one side of t_{n+1}.
  [[nodiscard]] virtual PrescribedRows prescribed(int i, const PairStep& step,
                                                  TimeSide side) const = 0;
  /// Wrenches, constraint values and tangents of the listed items, into terms[k] for items[k].
  virtual void evaluate(std::span<const int> items, std::span<const PairStep> steps,
                        std::span<PairTerms> terms) const = 0;
  virtual void acceleration_terms(int i, const PairStep& step, Vec6& gamma) const = 0;
  [[nodiscard]] virtual Work work(int i, const PairStep& step) const = 0;
  virtual void initialize(int i, const PairStep& step, double* history) const = 0;
  virtual void commit(int i, const PairStep& step, double* history) const = 0;
  [[nodiscard]] virtual bool acceptable(int i, const PairStep& step) const = 0;
  virtual void extrapolate(int i, const PairStep& step, const Vec6& of_a, const Vec6& of_b,
                           double* history) const = 0;
  [[nodiscard]] virtual double clearance(int i, const PairStep& step) const = 0;
  void impacts(int i, const PairStep& step, std::vector<Impact>& list) const {
    one_sided(i, step, &list, nullptr);
  }
  void unilateral_rows(int i, const PairStep& step, std::vector<UnilateralRow>& list) const {
    one_sided(i, step, nullptr, &list);
  }
  /// Adds the smooth pieces of its force at an instant; none while it is
  /// switched off.
  virtual void pieces(int i, const PairStep& step, ForcePieces& pieces) const = 0;
  /// Activates an item at an instant; its rows keep their present values.
  /// @returns the largest of these [m or -].
  virtual double switch_on(int i, const PairStep& step, double* history) const = 0;

 protected:
  /// Appends velocity jumps, or rows that only push, to the list that is given.
  virtual void one_sided(int i, const PairStep& step, std::vector<Impact>* jumps,
                         std::vector<UnilateralRow>* rows) const = 0;
  InteractionGroup(std::string kind, const char& type) : kind_(std::move(kind)), type_(&type) {}
  int size_ = 0;

 private:
  std::string kind_;
  const char* type_;
  std::vector<InteractionTraits> traits_;
};

}  // namespace polhode
