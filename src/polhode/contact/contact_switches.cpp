// SPDX-License-Identifier: Apache-2.0
// Contacts that are switched on and off during a run.
#include <algorithm>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/format.hpp>

namespace polhode::contact {

void ContactSet::add_switch(int owner_a, int owner_b, bool starts_off) {
  switches_.push_back(
      {{std::min(owner_a, owner_b), std::max(owner_a, owner_b)}, starts_off, starts_off});
}

int ContactSet::switch_of(int owner_a, int owner_b) const {
  const std::pair<int, int> pair{std::min(owner_a, owner_b), std::max(owner_a, owner_b)};
  const auto found = std::find_if(switches_.begin(), switches_.end(),
                                  [&](const Switch& s) { return s.owners == pair; });
  return static_cast<int>(found - switches_.begin());
}

bool ContactSet::is_off(const PlacedShape& a, const PlacedShape& b) const {
  if (switches_.empty()) return false;
  const std::pair<int, int> pair = owners(a, b);
  return std::any_of(switches_.begin(), switches_.end(),
                     [&](const Switch& s) { return s.off && s.holds(pair); });
}

/// Sets switches in a state. The next step or query loads the state and finds candidates from its
/// references, as after a restart: switched-off points are not found, and their histories are
/// dropped at the next save().
void ContactSet::switch_over(State& state, std::span<const int> switches, bool off) {
  if (switches.empty()) return;
  std::vector<double>& memory = state.contacts;
  std::size_t first = 2 + totals_in(state).size();
  if (memory.size() < first + switches_.size()) {  // nothing was saved yet
    memory.assign(1, static_cast<double>(totals_.size()));
    memory.insert(memory.end(), totals_.begin(), totals_.end());
    memory.push_back(longest_step_);
    first = memory.size();
    for (const Switch& s : switches_) memory.push_back(s.starts_off ? 1.0 : 0.0);
  }
  for (const int k : switches) memory[first + static_cast<std::size_t>(k)] = off ? 1.0 : 0.0;
  loaded_ = false;
}

std::vector<std::string> ContactSet::overlaps_if_on(const State& state,
                                                    std::span<const BodyStep> instants,
                                                    std::span<const int> switches) {
  State on = state;
  switch_over(on, switches, false);
  std::vector<std::string> list;
  for (const ShapeOverlap& o : overlaps_at(on, instants)) {
    const std::pair<int, int> pair = owners(shapes_[o.a], shapes_[o.b]);
    const auto meant = [&](int k) { return switches_[static_cast<std::size_t>(k)].holds(pair); };
    if (std::any_of(switches.begin(), switches.end(), meant)) list.push_back(words_of(o));
  }
  return list;
}

}  // namespace polhode::contact
