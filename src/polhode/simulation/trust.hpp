// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Largest relative drift of the balances that a model's method allows [-]: with exact conservation
/// that of round-off over any run, otherwise that of second-order errors. The non-smooth law of
/// contact is not exact: its impulses are iterated to a tolerance.
[[nodiscard]] double allowed_drift(const Model& model);

/// Reasons not to trust a run so far, a sentence each: a balance of energy or momentum that does
/// not close, or constraints that do not hold, to what the method can reach. @eq{trust}
/// @param extrapolated  Balances of extrapolated steps close to their estimated errors.
[[nodiscard]] std::vector<std::string> reasons_for_distrust(const Model& model,
                                                            const System& system,
                                                            const Ledger& ledger,
                                                            bool extrapolated = false);

}  // namespace polhode
