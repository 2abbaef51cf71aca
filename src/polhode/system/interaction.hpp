// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/core/types.hpp>
#include <polhode/dynamics/body_step.hpp>
#include <polhode/system/motion_basis.hpp>

namespace polhode {

/// Most multiplier rows one interaction may have.
inline constexpr int kMaxRows = 6;

/// What one interaction between bodies a and b gives for the current trial step.
///
/// Wrenches are (force [N], moment about the centre of mass [N m]), world components, at
/// t_{n+αf}; increments are (Δr, Δθ), world. Without StepContext::tangents, D and G are not read. A
/// constraint's force on body i is +λ times its column B_i, and belongs to the wrench; so does
/// what else depends on λ, as friction does, with its derivative in the column. Everything about
/// the ground stays zero and unread.
struct PairTerms {
  Vec6 wrench_a, wrench_b;      ///< Of everything, multipliers included.
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< D_ij: wrench of i by the increment of j.
  /// Column k: derivative of the wrench by multiplier k.
  Eigen::Matrix<double, 6, 6> B_a, B_b;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> G_a, G_b;  ///< Row k: derivative of g_k at t_{n+1}.
  Vec6 g;                                                 ///< Constraint values at t_{n+1}.
  Vec6 compliance;  ///< Row k asks g_k + compliance_k·λ_k = 0; 0 is exact.

  void set_zero();
  /// All but B and G, whose columns and rows an interaction with multipliers fills.
  void set_sums_zero();
  void set_values_zero();  ///< Wrenches, values and compliance only.
};

/// One interaction's view of the step.
struct PairStep {
  const BodyStep& a;
  const BodyStep& b;
  const StepContext& context;
  const double* lambda;   ///< Current multipliers, rows() of them.
  const double* history;  ///< What commit() stored at t_n.
};

/// Zeroes what was computed for a side that is the ground: items need not ask while they compute.
void clear_ground_sides(const PairStep& step, PairTerms& terms);

/// What an interaction did over the step that was just accepted.
struct Work {
  double stored = 0.0;      ///< Potential energy at t_{n+1} [J].
  double dissipated = 0.0;  ///< Over the step [J]; never negative.
  double put_in = 0.0;      ///< Work of loads over the step [J].

  Work& operator+=(const Work& w) {
    stored += w.stored;
    dissipated += w.dissipated;
    put_in += w.put_in;
    return *this;
  }
};

/// A relative velocity J v of an impact at the end of a step, where velocities may jump.
/// @eq{turn-law} @eq{impact-friction}
struct Impact {
  Vec6 on_a, on_b;  ///< J, by (v, ω) of a and b, world.
  /// J v afterwards. NaN: as it is, of lasting contact that is no impact but carries others on.
  double wanted = 0.0;
  double given = 0.0;      ///< Normal impulse of the step; no more than this is taken back [N s].
  double mu = 0.0;         ///< Coefficient of friction, along `along` if it depends on direction.
  double mu_across = 0.0;  ///< Across `along` [-].
  Vec3 along = Vec3::Zero(), across = Vec3::Zero();  ///< Tangents, unit; zero without friction.
  Vec3 rubbed =
      Vec3::Zero();  ///< Impulse of friction on a in the step, part of what mu bounds [N s].
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< From the centres of mass [m].
};

/// Demands of rows that follow functions of time c(t): g = q − c, G v = ċ. Zero for others.
/// @eq{drive-row}
struct PrescribedRows {
  Vec6 increment = Vec6::Zero();  ///< c_{n+1} − c_n.
  Vec6 rate = Vec6::Zero();       ///< ċ at t_{n+1} [1/s].
  Vec6 second = Vec6::Zero();     ///< c̈ there [1/s²].
};

/// Which bodies an interaction acts on; kGround for none. Single-body loads use b alone.
struct Participants {
  int a = kGround, b = kGround;
};

/// How the wrenches on a and b depend on the other body's motion, beyond the multipliers' own
/// columns: not at all; only as a couple, whose moments on a and b are equal and opposite and
/// depend on rotations alone; or in any way. In the first two cases all tangents are of moments by
/// rotations. Elimination along the tree carries no more than that.
enum class Coupling { none, couple, all };

/// Whether an interaction may be switched off and on during a run, and how it begins.
enum class Switching : unsigned char { never, starts_on, starts_off };

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
  [[nodiscard]] bool always_asked() const { return false; }
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
  static constexpr bool always_asked = !requires {
    requires std::same_as<decltype(&Item::always_asked), decltype(&Base::always_asked)>;
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
                      (!(OwnFunctions<Item>::always_asked || OwnFunctions<Item>::refusal) ||
                       OwnFunctions<Item>::acceptable) &&
                      (!OwnFunctions<Item>::reverse || OwnFunctions<Item>::reversible);

/// Entries behind the item's own history, of one that may be switched: 1 while it is off, and the
/// values of its rows when it was switched on, which they keep. @eq{switch-rows}
struct SwitchMemory {
  enum Entry : int { kOff, kHeld };
  [[nodiscard]] static int size(int rows) { return kHeld + rows; }
};

/// All interactions of one type, in one contiguous array: the assembler makes one virtual call
/// per group, never per item. `first` and `count` select items; pair(i) gives item i's step.
///
/// An item that is switched off has no wrench, no work and rows λ = 0. It has no place in the tree.
class InteractionGroup {
 public:
  virtual ~InteractionGroup() = default;
  [[nodiscard]] virtual std::string kind() const = 0;  ///< "joint", "force" ...: for reports.
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual const std::string& name(int i) const = 0;
  [[nodiscard]] virtual Participants bodies(int i) const = 0;
  [[nodiscard]] virtual int rows(int i) const = 0;
  [[nodiscard]] virtual int history_size(int i) const = 0;
  [[nodiscard]] virtual bool lazy_history(int i) const = 0;
  [[nodiscard]] virtual bool conservative(int i) const = 0;
  [[nodiscard]] virtual bool dissipates(int i) const = 0;
  [[nodiscard]] virtual std::optional<MotionBasis> motion_basis(int i) const = 0;
  [[nodiscard]] virtual Coupling coupling(int i) const = 0;
  [[nodiscard]] virtual bool reversible(int i) const = 0;
  virtual void reverse(int i) = 0;  ///< Before the system is finished.
  [[nodiscard]] virtual double coupled_mass(int i) const = 0;
  [[nodiscard]] virtual double reach(int i) const = 0;
  [[nodiscard]] virtual std::vector<TimeFunctionPtr> time_functions(int i) const = 0;
  [[nodiscard]] virtual int time_order(int i) const = 0;
  [[nodiscard]] virtual bool prescribes(int i) const = 0;
  /// Limits from one side of t_{n+1}.
  [[nodiscard]] virtual PrescribedRows prescribed(int i, const PairStep& step,
                                                  TimeSide side) const = 0;

  /// Wrench, constraint values and tangents of the items listed, into terms[k] for items[k].
  virtual void evaluate(std::span<const int> items, std::span<const PairStep> steps,
                        std::span<PairTerms> terms) const = 0;
  virtual void acceleration_terms(int i, const PairStep& step, Vec6& gamma) const = 0;
  [[nodiscard]] virtual Work work(int i, const PairStep& step) const = 0;
  virtual void initialize(int i, const PairStep& step, double* history) const = 0;
  virtual void commit(int i, const PairStep& step, double* history) const = 0;
  [[nodiscard]] virtual bool acceptable(int i, const PairStep& step) const = 0;
  [[nodiscard]] virtual bool always_asked(int i) const = 0;
  [[nodiscard]] virtual const char* refusal(int i) const = 0;
  virtual void extrapolate(int i, const PairStep& step, const Vec6& of_a, const Vec6& of_b,
                           double* history) const = 0;
  [[nodiscard]] virtual bool works(int i) const = 0;
  [[nodiscard]] virtual bool has_barrier(int i) const = 0;
  [[nodiscard]] virtual double clearance(int i, const PairStep& step) const = 0;
  virtual void impacts(int i, const PairStep& step, std::vector<Impact>& list) const = 0;

  [[nodiscard]] virtual Switching switching(int i) const = 0;
  virtual void set_switching(int i, Switching how) = 0;  ///< Before the system is finished.
  /// @param history  Of the item.
  [[nodiscard]] virtual bool is_off(int i, const double* history) const = 0;
  virtual void switch_off(int i, double* history) const = 0;
  /// Makes an item act from an instant on; its rows keep the values that they have there.
  /// @returns the largest of these [m or -].
  virtual double switch_on(int i, const PairStep& step, double* history) const = 0;
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
  std::vector<Item> items;

  std::string kind() const override { return Item::kKind; }
  int size() const override { return static_cast<int>(items.size()); }
  const std::string& name(int i) const override { return at(i).name; }
  Participants bodies(int i) const override { return at(i).bodies; }
  int rows(int i) const override { return at(i).rows(); }
  int history_size(int i) const override {
    return at(i).history_size() + (switched(i) ? SwitchMemory::size(at(i).rows()) : 0);
  }
  bool lazy_history(int i) const override { return !switched(i) && at(i).lazy_history(); }
  bool conservative(int i) const override { return at(i).conservative(); }
  bool dissipates(int i) const override { return at(i).dissipates(); }
  std::optional<MotionBasis> motion_basis(int i) const override {
    return switched(i) ? std::nullopt : at(i).motion_basis();
  }
  /// The couple's own elimination asks for rows that hold.
  Coupling coupling(int i) const override {
    const Coupling own = at(i).coupling();
    return switched(i) && own == Coupling::couple ? Coupling::all : own;
  }
  bool reversible(int i) const override { return at(i).reversible(); }
  void reverse(int i) override { items[static_cast<std::size_t>(i)].reverse(); }
  double coupled_mass(int i) const override { return at(i).coupled_mass(); }
  double reach(int i) const override { return at(i).reach(); }
  std::vector<TimeFunctionPtr> time_functions(int i) const override {
    return at(i).time_functions();
  }
  int time_order(int i) const override { return at(i).time_order(); }
  bool prescribes(int i) const override { return at(i).prescribes(); }
  PrescribedRows prescribed(int i, const PairStep& step, TimeSide side) const override {
    PrescribedRows rows;
    if (!is_off(i, step.history)) at(i).prescribed(step, side, rows);
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
    if (!is_off(i, step.history)) at(i).acceleration_terms(step, gamma);
  }
  Work work(int i, const PairStep& step) const override {
    return is_off(i, step.history) ? Work{} : at(i).work(step);
  }
  bool works(int i) const override { return at(i).rows() == 0 || at(i).works(); }
  bool has_barrier(int i) const override { return at(i).has_barrier(); }
  double clearance(int i, const PairStep& step) const override {
    return is_off(i, step.history) ? 1.0 : at(i).clearance(step);
  }
  void impacts(int i, const PairStep& step, std::vector<Impact>& list) const override {
    if (!is_off(i, step.history)) at(i).impacts(step, list);
  }
  void initialize(int i, const PairStep& step, double* history) const override {
    at(i).initialize(step, history);
  }
  void commit(int i, const PairStep& step, double* history) const override {
    is_off(i, history) ? at(i).commit_off(step, history) : at(i).commit(step, history);
  }
  bool acceptable(int i, const PairStep& step) const override {
    return is_off(i, step.history) || at(i).acceptable(step);
  }
  bool always_asked(int i) const override { return at(i).always_asked(); }
  const char* refusal(int i) const override { return at(i).refusal(); }
  void extrapolate(int i, const PairStep& step, const Vec6& of_a, const Vec6& of_b,
                   double* history) const override {
    at(i).extrapolate(step, of_a, of_b, history);
  }
  Switching switching(int i) const override { return at(i).switching; }
  void set_switching(int i, Switching how) override {
    items[static_cast<std::size_t>(i)].switching = how;
  }
  bool is_off(int i, const double* history) const override {
    return switched(i) && memory(i, history)[SwitchMemory::kOff] != 0.0;
  }
  void switch_off(int i, double* history) const override {
    history[at(i).history_size() + SwitchMemory::kOff] = 1.0;
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

 private:
  [[nodiscard]] const Item& at(int i) const { return items[static_cast<std::size_t>(i)]; }
  [[nodiscard]] bool switched(int i) const { return at(i).switching != Switching::never; }
  [[nodiscard]] const double* memory(int i, const double* history) const {
    return history + at(i).history_size();
  }
  void evaluate_switched(int i, const PairStep& step, PairTerms& terms) const {
    terms.set_zero();
    const int rows = at(i).rows();
    if (is_off(i, step.history)) {
      terms.compliance.head(rows).setOnes();
      return;
    }
    at(i).evaluate(step, terms);
    const double* held = memory(i, step.history) + SwitchMemory::kHeld;
    for (int k = 0; k < rows; ++k) terms.g[k] -= held[k];
  }
};

}  // namespace polhode
