// SPDX-License-Identifier: Apache-2.0
#include <polhode/simulation/held_values.hpp>

namespace polhode {

std::shared_ptr<HeldNumbers> held_numbers(const Model& model) {
  for (const LoadSpec& load : model.loads)
    if (const HeldValue* held = held_value(load.value)) return held->numbers();
  return nullptr;
}

std::shared_ptr<HeldNumbers> own_held_numbers(Model& model) {
  const std::shared_ptr<HeldNumbers> shared = held_numbers(model);
  if (!shared) return nullptr;
  auto own = std::make_shared<HeldNumbers>(*shared);
  for (LoadSpec& load : model.loads)
    if (const HeldValue* held = held_value(load.value))
      load.value = std::make_shared<HeldValue>(own, held->index(), held->offset());
  return own;
}

}  // namespace polhode
