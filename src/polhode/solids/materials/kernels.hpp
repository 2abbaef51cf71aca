// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::solids {

/// Largest number of terms of a relaxation series.
inline constexpr int kMostRelaxations = 12;

/// Functions of a law for several elements in SIMD lanes. Numbers are packs of that many doubles,
/// aligned to their size; symmetric tensors are six packs (11 22 33 12 23 31), D is 36 row by row
/// and acts on strains with doubled shear.
struct LawKernel {
  /// Discrete stress between E_0 and E_1 (the stress itself if they are equal), and its derivative
  /// by E_1 if D is not null.
  /// @param whole  False: of an uncoupled material without its volumetric part.
  void (*stress)(const void* law, bool whole, const double* E_0, const double* E_1, double* S,
                 double* D);
  /// Strain energy per reference volume.
  void (*energy)(const void* law, bool whole, const double* E, double* W);
};

/// Functions of fibres along A (three packs, unit length), added to S, D and W.
struct FibreKernel {
  /// @param uncoupled  The fibre is subject to the isochoric stretch.
  /// @param dispersion  κ of the mean square stretch of fibres spread about A.
  void (*add_stress)(const void* law, bool uncoupled, double dispersion, const double* A,
                     const double* E_0, const double* E_1, double* S, double* D);
  void (*add_energy)(const void* law, bool uncoupled, double dispersion, const double* A,
                     const double* E, double* W);
};

/// Volumetric energy of the mean volume ratio θ = 1 + tau of an element, over a step.
struct VolumeKernel {
  /// Pressure U[θ_0, θ_1] and its derivative by θ_1. [Pa]
  void (*pressure)(double K, const double* tau_0, const double* tau_1, double* p, double* dp);
  void (*energy)(double K, const double* tau, double* U);
};

/// All laws for one instruction set, in the order of the lists in laws.hpp.
struct MaterialKernels {
  const char* name;  ///< baseline, avx2, avx512.
  int width;         ///< Doubles in a pack.
  const LawKernel* laws;
  const FibreKernel* fibres;
  const VolumeKernel* volumes;  ///< In the order of VolumeRule.
};

/// Kernels of an instruction set: "automatic" chooses the widest of this machine; else baseline,
/// avx2 or avx512.
/// @throws InputError if the machine or the build lacks it.
[[nodiscard]] const MaterialKernels& material_kernels(const std::string& isa);

}  // namespace polhode::solids
