// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/system/body_contacts.hpp>
#include <polhode/system/interaction.hpp>
#include <polhode/system/nodes.hpp>
#include <polhode/system/spanning_tree.hpp>
#include <polhode/system/state.hpp>

namespace polhode {

/// Constant data of a moving body of the system.
struct BodyData {
  std::string name;
  double mass = 1.0;                ///< [kg]
  Mat3 inertia = Mat3::Identity();  ///< J_r about the centre of mass, body axes [kg m²].
  /// No moment acts on it: statics and modes leave out its rotations.
  bool point_mass = false;
};

/// An interaction and its position in the numbering.
struct InteractionRef {
  int group = 0, item = 0;  ///< groups()[group], item-th of it.
  int a = kGround, b = kGround;
  int rows = 0;
  int first_row = 0;      ///< Into State::lambda.
  int first_history = 0;  ///< Into State::history.
  /// First of the interactions that are parts of its row, by default this one.
  int first_part = 0;
  bool last_part = true;

  /// Whether its row has parts of other bodies.
  [[nodiscard]] bool shares_row() const { return !last_part || further_part; }
  bool further_part = false;  ///< Not the first one.
};

/// A body of an interaction that is not the ground; kGround if there is none.
[[nodiscard]] inline int moving_body(const InteractionRef& ref) {
  return ref.a != kGround ? ref.a : ref.b;
}

/// View of a step for one interaction, together with the bodies' steps that it refers to.
struct PairView {
  BodyStep a, b;
  StepContext context;
  const double* lambda;   ///< The interaction's own.
  const double* history;  ///< Likewise.

  [[nodiscard]] PairStep step() const { return {a, b, context, lambda, history}; }
};

/// The compiled model: numbered unknowns, grouped interactions, spanning tree. Immutable after
/// finish().
class System {
 public:
  /// Adds a body and returns its index.
  int add_body(BodyData body, const BodyMotion& start);
  /// The group of this item type, made on first use.
  template <class Item>
  Group<Item>& group();
  /// Adds a node of a deformable solid; returns its number. Bodies may be added later.
  int add_node(const NodeData& node) { return nodes_.add(node); }
  /// Prescribes a component of a node's displacement from the start [m].
  void prescribe(int node, int component, TimeFunctionPtr displacement) {
    nodes_.prescribe(node, component, std::move(displacement));
  }
  int add_elements(std::unique_ptr<ElementGroup> elements) {
    return nodes_.add_elements(std::move(elements));
  }
  /// Sets the contacts between bodies.
  void set_contacts(std::shared_ptr<BodyContacts> contacts) { contacts_ = std::move(contacts); }
  [[nodiscard]] const std::shared_ptr<BodyContacts>& contacts() const { return contacts_; }
  void set_gravity(const Vec3& gravity) { gravity_ = gravity; }
  /// Whether linear solvers may use fused multiply-add, by which results depend on the processor.
  void set_fused(bool fused) { fused_ = fused; }
  [[nodiscard]] bool fused() const { return fused_; }
  /// Makes the item-th interaction of a kind switchable.
  /// @throws std::logic_error if there is none.
  void set_switching(std::string_view kind, int item, Switching how);
  /// Sets the number of further values saved with the state in addition to those of interactions,
  /// initially zero.
  void set_memory(int count) { memory_size_ = count; }
  /// Numbers everything. @throws InputError if an interaction names a nonexistent body.
  void finish();

  [[nodiscard]] const Vec3& gravity() const { return gravity_; }  ///< [m/s²]
  [[nodiscard]] const std::vector<BodyData>& bodies() const { return bodies_; }
  [[nodiscard]] int body_count() const { return static_cast<int>(bodies_.size()); }
  [[nodiscard]] const Nodes& nodes() const { return nodes_; }
  /// Mass of a body including attached solids; solids between several bodies count in equal parts
  /// [kg].
  [[nodiscard]] double carried_mass(int body) const { return carried_mass_[body]; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const InteractionGroup& group(int i) const { return *groups_[i]; }
  [[nodiscard]] const std::vector<InteractionRef>& interactions() const { return refs_; }
  /// Offset of the numbers of set_memory() in State::history.
  [[nodiscard]] int memory() const {
    return static_cast<int>(initial_.history.size()) - memory_size_;
  }
  [[nodiscard]] int memory_size() const { return memory_size_; }
  /// Whether an interaction is switched off.
  [[nodiscard]] bool is_off(const State& state, int interaction) const;
  /// Whether joints have friction or stops: forces that change strongly over tiny displacements.
  [[nodiscard]] bool stiff() const { return stiff_; }
  /// Whether there are set-valued laws, whose equations are exchanged during iterations.
  [[nodiscard]] bool set_valued() const { return set_valued_; }
  /// Whether bodies interact by exact constraints alone, whose tangents are complete, so that
  /// Newton's method converges quadratically but for the proximal iteration of redundant rows.
  [[nodiscard]] bool only_constraints() const { return only_constraints_; }
  /// Interactions with an inadmissible configuration.
  [[nodiscard]] const std::vector<int>& barriers() const { return barriers_; }
  /// Interactions with rows that only push.
  [[nodiscard]] const std::vector<int>& unilateral() const { return unilateral_; }
  /// Gap up to which such rows, and rigid surfaces, touch [m].
  [[nodiscard]] double touching_gap() const { return kTouchingGap * length_; }
  /// Interactions with rows that follow functions of time.
  [[nodiscard]] const std::vector<int>& drives() const { return drives_; }
  [[nodiscard]] const SpanningTree& tree() const { return tree_; }
  [[nodiscard]] int slot(int body) const { return tree_.slot_of_body[body]; }
  [[nodiscard]] double mean_mass() const { return mean_mass_; }  ///< m_ref of the scaling [kg].
  [[nodiscard]] double length_scale() const {
    return length_;
  }  ///< ℓ: extent of the mechanism [m].
  /// Whether all work is stored: neither dampers nor time-dependent loads.
  [[nodiscard]] bool conservative() const { return conservative_; }
  /// Whether energy is dissipated, as by dampers.
  [[nodiscard]] bool dissipates() const { return dissipates_; }
  [[nodiscard]] const InteractionTraits& traits(const InteractionRef& ref) const {
    return groups_[ref.group]->traits(ref.item);
  }
  [[nodiscard]] const std::string& name(const InteractionRef& ref) const {
    return traits(ref).name;
  }

  /// The state as bodies were added; not yet assembled, projected or started.
  [[nodiscard]] const State& initial_state() const { return initial_; }
  [[nodiscard]] BodyMotion motion(const State& state, int body) const {
    return state.motion(slot(body));
  }
  /// Instant of a body as a degenerate step; the ground for kGround.
  [[nodiscard]] BodyStep instant(const State& state, int body) const;
  /// Instant of an interaction. @param lambda  Multipliers by row, or null if it has none.
  [[nodiscard]] PairView instant(const State& state, const InteractionRef& ref,
                                 const double* lambda) const;

 private:
  std::vector<BodyData> bodies_;
  std::vector<BodyMotion> start_;
  std::vector<std::unique_ptr<InteractionGroup>> groups_;
  std::vector<InteractionRef> refs_;
  std::shared_ptr<BodyContacts> contacts_;
  Nodes nodes_;
  SpanningTree tree_;
  State initial_;
  Vec3 gravity_ = Vec3::Zero();
  bool fused_ = true;
  int rows_ = 0;
  std::vector<double> carried_mass_;
  double mean_mass_ = 1.0, length_ = 1.0;
  bool conservative_ = true, dissipates_ = false, stiff_ = false, only_constraints_ = true;
  bool set_valued_ = false;
  std::vector<int> barriers_, unilateral_, drives_;
  int memory_size_ = 0;
  bool finished_ = false;
};

template <class Item>
Group<Item>& System::group() {
  for (auto& g : groups_)
    if (g->is_of(kTypeTag<Item>)) return static_cast<Group<Item>&>(*g);
  groups_.push_back(std::make_unique<Group<Item>>());
  return static_cast<Group<Item>&>(*groups_.back());
}

}  // namespace polhode
