// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/system/parameter.hpp>

namespace polhode::solids {

/// Parameters by name, SI.
using ParameterValues = std::map<std::string, double>;

/// Volumetric energy of an uncoupled material.
enum class VolumeRule : unsigned char {
  kLogarithm,  ///< ½ K ln² J.
  kSquare,     ///< ½ K ((J² − 1)/2 − ln J).
};

/// A type of material, or of fibre, in the model file.
struct MaterialKind {
  std::string name;     ///< "type" of a material, "law" of a fibre in the model file.
  std::string meaning;  ///< One line.
  std::vector<Parameter> parameters;
  /// Alternative sets of parameters of which exactly one has to be given, e.g. Young's modulus and
  /// Poisson's ratio, or two others. Empty: no alternatives.
  std::vector<std::vector<std::string>> alternatives = {};
  bool uncoupled = false;  ///< Volumetric and isochoric parts are uncoupled: required by hex8_q1p0.
  std::string also = {};   ///< Alias that is accepted.
  VolumeRule volume = VolumeRule::kLogarithm;
};

/// Moduli of an isotropic material at small strains: S = λ tr E I + 2 μ E.
struct LinearModuli {
  double lame = 0.0;   ///< λ [Pa].
  double shear = 0.0;  ///< μ [Pa].
};

/// λ and μ from the alternative of isotropic_alternatives() that was given.
[[nodiscard]] LinearModuli isotropic_moduli(const ParameterValues& values);
/// Young's modulus and Poisson's ratio, or two of the others.
[[nodiscard]] std::vector<Parameter> isotropic_parameters();
[[nodiscard]] std::vector<std::vector<std::string>> isotropic_alternatives();

/// Parameters with defaults, checked for unknown, missing and invalid ones.
/// @param where  Path of the material in the user's model.
/// @throws InputError
[[nodiscard]] ParameterValues checked_values(std::string_view where, const MaterialKind& kind,
                                             const ParameterValues& given);

}  // namespace polhode::solids
