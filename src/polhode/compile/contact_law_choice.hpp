// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// Law of contacts for a model that names none: rigid where contacts can be rows of the step and
/// these are few, barrier elsewhere.
struct ContactLawChoice {
  std::string law;
  std::string reason;  ///< Of the barrier, "as ..."; empty for rigid.
};

/// The choice for a model whose bodies, joints and analysis are known; its contacts.default.law
/// does not matter.
[[nodiscard]] ContactLawChoice choose_contact_law(const Model& model);

}  // namespace polhode
