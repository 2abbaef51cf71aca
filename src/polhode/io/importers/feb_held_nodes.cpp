// SPDX-License-Identifier: Apache-2.0
// Displacements of nodes that some of several steps fix or prescribe.
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/io/importers/feb_model.hpp>

namespace polhode::io {

void FebSolids::settle_boundary() {
  merge_held();
  for (const auto& [node, holders] : held_)
    if (!on_solid(node) && !on_beam(node)) {
      const int hold = *std::max_element(holders.begin(), holders.end());
      model_.file.ignored.add(*holds_[static_cast<std::size_t>(hold)].at,
                              "a displacement of nodes of no deformable solid", "moves nothing");
      return;
    }
}

bool FebSolids::on_beam(int node) const {
  return std::any_of(model_.mesh.parts.begin(), model_.mesh.parts.end(), [&](const FebPart& part) {
    return beam_sections_.contains(part.material) &&
           std::find(part.nodes.begin(), part.nodes.end(), node) != part.nodes.end();
  });
}

void FebSolids::merge_held() {
  if (held_in_.empty()) return;
  std::set<int> nodes;
  for (const auto& [s, held] : held_in_)
    for (const auto& [node, holders] : held) nodes.insert(node);
  std::map<std::vector<int>, int> known;
  std::set<int> told;
  for (const int node : nodes)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto in = [&](const Held& held) {
        const auto found = held.find(node);
        return found == held.end() ? -1 : found->second[k];
      };
      const auto is_prescribed = [&](int hold) {
        return hold >= 0 && holds_[static_cast<std::size_t>(hold)].prescribed;
      };
      const int always = in(held_);
      std::vector<int> by_step(model_.steps.size(), always);
      for (const auto& [s, held] : held_in_) {
        const int own = in(held);
        // FEBio lets what is prescribed override what is fixed.
        if (is_prescribed(own) || (own >= 0 && !is_prescribed(always))) by_step[s] = own;
      }
      const int any = *std::max_element(by_step.begin(), by_step.end());
      const bool as_always =
          std::all_of(by_step.begin(), by_step.end(), [&](int hold) { return hold == always; });
      if (as_always) continue;
      if (std::find(by_step.begin(), by_step.end(), -1) != by_step.end()) {
        if (told.insert(any).second) refuse_released(any, node);
        continue;
      }
      const auto [found, is_new] = known.try_emplace(by_step, static_cast<int>(holds_.size()));
      if (is_new) {
        FebHold merged = holds_[static_cast<std::size_t>(any)];
        const auto first = std::find_if(by_step.begin(), by_step.end(), is_prescribed);
        if (first != by_step.end()) merged = holds_[static_cast<std::size_t>(*first)];
        if (merged.prescribed) merged.by_step = by_step;
        holds_.push_back(std::move(merged));
      }
      held_.try_emplace(node, std::array{-1, -1, -1}).first->second[k] = found->second;
    }
}

void FebSolids::refuse_released(int hold, int node) {
  const FebHold& own = holds_[static_cast<std::size_t>(hold)];
  model_.file.refuse(
      *own.at,
      format("the node {} is free in one step and held by {} in another",
             model_.mesh.labels[static_cast<std::size_t>(node)], quote(own.name)),
      "Hold it in all steps, also where its displacement stays as it is; or bond the nodes to a "
      "rigid body by a <bc> of type \"rigid\": steps can release that.");
}

SourceNode FebSolids::hold_node(const FebHold& hold, std::size_t component) {
  if (hold.by_step.empty()) return model_.curves.node(hold.values[component]);
  const auto spans = model_.spans([&](std::size_t s) -> std::optional<FebSpan> {
    const FebHold& own = holds_[static_cast<std::size_t>(hold.by_step[s])];
    if (!own.prescribed) return std::nullopt;
    return FebSpan{0.0, 0.0, own.values[component], own.relative, false};
  });
  return model_.curves.node(*hold.at, spans);
}

}  // namespace polhode::io
