// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::solids {

/// Description of a family of fibres by the user.
struct FibreDescription {
  std::string law;         ///< A name of fibre_kinds().
  ParameterValues values;  ///< SI, by the kind's names; defaults for missing ones.
};

/// A term g exp(−t/τ) of the relaxation series of a material. @eq{solid-relaxation}
struct Relaxation {
  double ratio = 0.0;  ///< g [-].
  double time = 0.0;   ///< τ [s].
};

/// Description of a material by the user.
struct MaterialDescription {
  std::string kind;        ///< A name of material_kinds().
  ParameterValues values;  ///< SI, by the kind's names; defaults for missing ones.
  std::vector<FibreDescription> fibres = {};
  /// Kelvin-Voigt viscosity, either relaxation time: times the elastic moduli at rest [s] (of an
  /// uncoupled material times its shear modulus only) ...
  double relaxation_time = 0.0;
  /// ... or separate moduli, S_v = λ_v tr(Ė) I + 2 μ_v Ė [Pa s].
  LinearModuli viscous = {};
  std::vector<Relaxation> relaxation = {};  ///< Terms of the series; empty: no memory.
  double long_term_ratio = 1.0;             ///< g₀, constant term of the series [-].
};

/// A family of fibres: its law with its constants.
struct Fibre {
  int index = 0;            ///< In fibre_kinds().
  double dispersion = 0.0;  ///< κ of κ I + (1 − 3κ) A ⊗ A.
  alignas(16) std::array<std::byte, 64> law{};
};

/// A material: its laws with their constants, as input of the kernels. Made by make_material().
class Material {
 public:
  [[nodiscard]] const MaterialKind& kind() const { return *kind_; }
  [[nodiscard]] bool uncoupled() const { return kind_->uncoupled; }
  [[nodiscard]] bool has_fibres() const { return !fibres_.empty(); }
  [[nodiscard]] bool viscous() const { return viscous_.lame != 0.0 || viscous_.shear != 0.0; }
  [[nodiscard]] LinearModuli linear() const { return linear_; }           ///< At rest [Pa].
  [[nodiscard]] LinearModuli viscous_moduli() const { return viscous_; }  ///< [Pa s]
  /// Terms of the relaxation series, of the isochoric part if the material is uncoupled.
  [[nodiscard]] const std::vector<Relaxation>& relaxation() const { return relaxation_; }
  [[nodiscard]] double long_term_ratio() const { return long_term_ratio_; }  ///< g₀ [-].
  [[nodiscard]] double bulk_modulus() const {                                ///< At rest [Pa].
    return linear_.lame + 2.0 / 3.0 * linear_.shear;
  }

  // For the kernels.
  [[nodiscard]] int law_index() const { return law_index_; }
  [[nodiscard]] const void* law() const { return law_.data(); }
  [[nodiscard]] const std::vector<Fibre>& fibres() const { return fibres_; }

 private:
  friend struct MaterialMaker;
  const MaterialKind* kind_ = nullptr;
  int law_index_ = 0;
  LinearModuli linear_, viscous_;
  alignas(16) std::array<std::byte, 128> law_{};
  std::vector<Fibre> fibres_;
  std::vector<Relaxation> relaxation_;
  double long_term_ratio_ = 1.0;
};

/// Discrete stress between two strains, with its derivative by the second.
struct MaterialPoint {
  Vec6 S;  ///< Order 11 22 33 12 23 31 [Pa].
  Mat6 D;  ///< ∂S/∂E_1, on strains with doubled shear [Pa].
};

/// Discrete stress at a single point, for tests, plots and fits. Elements use the kernels.
/// @param E_0, E_1  Green's strain, order 11 22 33 12 23 31, no factors of two.
/// @param A  Direction of all fibres, or of each family, unit length; not used without fibres.
/// @param whole  False: of an uncoupled material without its volumetric part.
[[nodiscard]] MaterialPoint discrete_stress(const Material& material, const Vec6& E_0,
                                            const Vec6& E_1, const Vec3& A = Vec3::UnitX(),
                                            bool whole = true);
[[nodiscard]] MaterialPoint discrete_stress(const Material& material, const Vec6& E_0,
                                            const Vec6& E_1, std::span<const Vec3> A,
                                            bool whole = true);
/// Strain energy per reference volume [J/m³].
[[nodiscard]] double strain_energy(const Material& material, const Vec6& E,
                                   const Vec3& A = Vec3::UnitX(), bool whole = true);
[[nodiscard]] double strain_energy(const Material& material, const Vec6& E, std::span<const Vec3> A,
                                   bool whole = true);

}  // namespace polhode::solids
