// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <polhode/core/source_location.hpp>
#include <polhode/core/types.hpp>

namespace polhode {

/// Kelvin-Voigt viscosity: either a relaxation time, which multiplies the elastic moduli of the
/// undeformed material, or separate viscous moduli. All zero: none.
struct ViscositySpec {
  double relaxation_time = 0.0;  ///< [s]
  double lame = 0.0;             ///< λ_v of λ_v tr(Ė) I + 2 μ_v Ė [Pa s].
  double shear = 0.0;            ///< μ_v [Pa s].

  [[nodiscard]] bool any() const { return relaxation_time > 0.0 || lame > 0.0 || shear > 0.0; }
};

/// A family of fibres in a material, with stiffness in tension only.
struct FibreSpec {
  std::string law;                           ///< A fibre law of the registry, e.g. exponential.
  std::map<std::string, double> parameters;  ///< By the registry's names, SI.
  Vec3 direction = Vec3::UnitX();            ///< Unit vector in the mesh's own axes [-].
};

/// A term of the relaxation series of a material.
struct RelaxationSpec {
  double modulus_ratio = 0.0;  ///< Of the stress that relaxes to the elastic stress [-].
  double time = 0.0;           ///< In which it falls to 1/e of itself [s].
};

/// Description of a material of deformable solids.
struct MaterialSpec {
  std::string name, type;  ///< type: a kind of the registry of materials.
  SourceLocation place;
  std::map<std::string, double> parameters;  ///< By the registry's names, SI. Absent = default.
  double density = 0.0;                      ///< In the undeformed shape [kg/m^3].
  ViscositySpec viscosity;
  std::vector<RelaxationSpec> relaxation;  ///< Empty: the stress has no memory.
  double long_term_ratio = 1.0;            ///< Of the stress that stays to the elastic stress [-].
  std::vector<FibreSpec> fibres;           ///< By family.
};

}  // namespace polhode
