// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/compile/build_system.hpp>
#include <polhode/stepping/closed_rows.hpp>

namespace polhode {

/// Closed rows of a simulation at its instants. Their contacts are those of a second system: steps
/// must not depend on what is recorded between them.
class RowsAtInstants {
 public:
  /// Those of a system, which is built from the model.
  [[nodiscard]] ClosedRows& of(const Model& model, const System& system) {
    if (rows_) return *rows_;
    if (are_rows(system.contacts().get())) {
      second_ = std::make_unique<System>(build_system(model, &map_));
      second_->contacts()->prepare(*second_);
    }
    rows_ = std::make_unique<ClosedRows>(system, second_ ? second_->contacts().get() : nullptr);
    return *rows_;
  }

 private:
  SystemMap map_;
  std::unique_ptr<System> second_;  ///< Null: no contacts are rows.
  std::unique_ptr<ClosedRows> rows_;
};

}  // namespace polhode
