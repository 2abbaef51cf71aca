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

/// A moving body of the system: what does not change during a run.
struct BodyData {
  std::string name;
  double mass = 1.0;                ///< [kg]
  Mat3 inertia = Mat3::Identity();  ///< J_r about the centre of mass, body axes [kg m²].
  bool point_mass = false;          ///< Nothing turns it: statics and modes leave its turns out.
};

/// One interaction with its place in the numbering.
struct InteractionRef {
  int group = 0, item = 0;  ///< groups()[group], item-th of it.
  int a = kGround, b = kGround;
  int rows = 0;
  int first_row = 0;      ///< Into State::lambda.
  int first_history = 0;  ///< Into State::history.
};

/// One interaction's view of a step, together with the bodies' steps that it looks at.
struct PairView {
  BodyStep a, b;
  StepContext context;
  const double* lambda;   ///< The interaction's own.
  const double* history;  ///< Likewise.

  [[nodiscard]] PairStep step() const { return {a, b, context, lambda, history}; }
};

/// The compiled model: numbered unknowns, grouped interactions, spanning tree. Immutable once
/// finish() was called.
class System {
 public:
  /// Adds a body and returns its index.
  int add_body(BodyData body, const BodyMotion& start);
  /// The group of this item type, made on first use.
  template <class Item>
  Group<Item>& group();
  /// A node of a deformable solid; returns its number. Bodies may follow later.
  int add_node(const NodeData& node) { return nodes_.add(node); }
  /// Gives a component of a node's displacement from the start [m].
  void prescribe(int node, int component, TimeFunctionPtr displacement) {
    nodes_.prescribe(node, component, std::move(displacement));
  }
  int add_elements(std::unique_ptr<ElementGroup> elements) {
    return nodes_.add_elements(std::move(elements));
  }
  /// Contact between bodies, if any.
  void set_contacts(std::shared_ptr<BodyContacts> contacts) { contacts_ = std::move(contacts); }
  [[nodiscard]] const std::shared_ptr<BodyContacts>& contacts() const { return contacts_; }
  void set_gravity(const Vec3& gravity) { gravity_ = gravity; }
  /// Lets the item-th interaction of a kind be switched.
  /// @throws std::logic_error if there is none.
  void set_switching(std::string_view kind, int item, Switching how);
  /// Numbers that are saved with the state beside those of interactions, zero at the start.
  void set_memory(int count) { memory_size_ = count; }
  /// Numbers everything. @throws InputError if an interaction names a body that does not exist.
  void finish();

  [[nodiscard]] const Vec3& gravity() const { return gravity_; }  ///< [m/s²]
  [[nodiscard]] const std::vector<BodyData>& bodies() const { return bodies_; }
  [[nodiscard]] int body_count() const { return static_cast<int>(bodies_.size()); }
  [[nodiscard]] const Nodes& nodes() const { return nodes_; }
  /// Of a body and the solids it holds; what hangs between several bodies in equal parts [kg].
  [[nodiscard]] double carried_mass(int body) const { return carried_mass_[body]; }
  [[nodiscard]] int rows() const { return rows_; }
  [[nodiscard]] const InteractionGroup& group(int i) const { return *groups_[i]; }
  [[nodiscard]] const std::vector<InteractionRef>& interactions() const { return refs_; }
  /// Where the numbers of set_memory() are in State::history.
  [[nodiscard]] int memory() const {
    return static_cast<int>(initial_.history.size()) - memory_size_;
  }
  [[nodiscard]] int memory_size() const { return memory_size_; }
  /// Whether an interaction is switched off.
  [[nodiscard]] bool is_off(const State& state, int interaction) const;
  /// Friction or stops of joints: forces that change a lot over tiny ways.
  [[nodiscard]] bool stiff() const { return stiff_; }
  /// Interactions with a configuration that no step may reach.
  [[nodiscard]] const std::vector<int>& barriers() const { return barriers_; }
  /// Interactions some of whose rows follow functions of time.
  [[nodiscard]] const std::vector<int>& drives() const { return drives_; }
  [[nodiscard]] const SpanningTree& tree() const { return tree_; }
  [[nodiscard]] int slot(int body) const { return tree_.slot_of_body[body]; }
  [[nodiscard]] double mean_mass() const { return mean_mass_; }  ///< m_ref of the scaling [kg].
  [[nodiscard]] double length_scale() const {
    return length_;
  }  ///< ℓ: extent of the mechanism [m].
  /// Neither dampers nor loads that depend on time: every interaction stores all it takes.
  [[nodiscard]] bool conservative() const { return conservative_; }
  /// Something takes energy for good, as dampers do.
  [[nodiscard]] bool dissipates() const { return dissipates_; }
  [[nodiscard]] const InteractionTraits& traits(const InteractionRef& ref) const {
    return groups_[ref.group]->traits(ref.item);
  }
  [[nodiscard]] const std::string& name(const InteractionRef& ref) const {
    return traits(ref).name;
  }

  /// The state the bodies were added with; not yet assembled, projected or started.
  [[nodiscard]] const State& initial_state() const { return initial_; }
  [[nodiscard]] BodyMotion motion(const State& state, int body) const {
    return state.motion(slot(body));
  }
  /// The instant of a body as a degenerate step; the ground for kGround.
  [[nodiscard]] BodyStep instant(const State& state, int body) const;
  /// The same for an interaction. @param lambda  Multipliers by row, or null if it has none.
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
  int rows_ = 0;
  std::vector<double> carried_mass_;
  double mean_mass_ = 1.0, length_ = 1.0;
  bool conservative_ = true, dissipates_ = false, stiff_ = false;
  std::vector<int> barriers_, drives_;
  int memory_size_ = 0;
};

template <class Item>
Group<Item>& System::group() {
  for (auto& g : groups_)
    if (g->is_of(kTypeTag<Item>)) return static_cast<Group<Item>&>(*g);
  groups_.push_back(std::make_unique<Group<Item>>());
  return static_cast<Group<Item>&>(*groups_.back());
}

}  // namespace polhode
