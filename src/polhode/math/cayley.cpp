// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/math/cayley.hpp>

namespace polhode {

std::optional<Vec3> try_cayley_vector(const Mat3& Lambda) {
  // Λ − Λᵀ = 4 χ̂ / (4 + χ²)·2 and 1 + tr Λ = 16 / (4 + χ²), so no angle is needed.
  const double one_plus_trace = 1.0 + Lambda.trace();
  if (one_plus_trace < 1e-12) return std::nullopt;
  return 4.0 / one_plus_trace * vee(Lambda);
}

Vec3 cayley_vector(const Mat3& Lambda) {
  if (const auto chi = try_cayley_vector(Lambda)) return *chi;
  throw InputError("cayley_vector", "the rotation angle is π, which no Cayley vector represents",
                   "Take a smaller time step, so that a body turns by less than π in it");
}

}  // namespace polhode
