// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include <polhode/solids/elements/memory.hpp>
#include <polhode/solids/materials/kernels.hpp>

namespace polhode::solids {

/// A family of fibres for the kernels.
struct FibreFamily {
  const void* law = nullptr;
  FibreKernel kernel{};
  double dispersion = 0.0;
};

/// Data of a group of elements for the kernels. Elements are stored in blocks of the width of a
/// pack; the last block is padded with its last element. Packs are consecutive.
struct ElementData {
  int elements = 0;
  int blocks = 0;
  const int* nodes = nullptr;        ///< n per element, including padding.
  const double* X = nullptr;         ///< Block: 3n packs, reference positions.
  const double* points = nullptr;    ///< Block: by point, weight and 3 packs a row, see Rows.
  const double* volumes = nullptr;   ///< Block: a pack.
  const double* fibres = nullptr;    ///< Block: 3 packs by family; null without fibres.
  const double* to_nodes = nullptr;  ///< n × points, from values at points to those at nodes.
  const void* law = nullptr;
  const FibreFamily* families = nullptr;
  int family_count = 0;
  LawKernel law_kernel{};
  VolumeKernel volume_kernel{};
  bool uncoupled = false;
  double bulk = 0.0;       ///< Of the volumetric energy, if uncoupled [Pa].
  bool conserving = true;  ///< Discrete gradient; else the stress of the averaged F.
  bool viscous = false;
  double viscous_lame = 0.0, viscous_shear = 0.0;  ///< [Pa s]
  int memory_size = 0;              ///< Numbers of history at a point; zero: no stress relaxes.
  std::ptrdiff_t first_memory = 0;  ///< In the history, by element and point.
};

/// Input and output of one evaluation.
struct ElementStep {
  const double *x_n = nullptr, *x_n1 = nullptr, *v_n = nullptr, *v_n1 = nullptr;
  double alpha_f = 1.0;
  double rate = 0.0;  ///< D v_{n+1}/D x_{n+1} [1/s].
  double dt = 0.0;
  bool mixed_point = false;
  MemoryWeights memory;
  const double* history = nullptr;
  /// Null at an instant: internal unknowns are then those of the history.
  double* scratch = nullptr;
  double turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Rotation since the condensation, row by row.
  double* force = nullptr;
  double* tangent = nullptr;  ///< Null: not needed.
  const int* slots = nullptr;
  double least_volume = 1.0;  ///< Out: smallest det F.
  int worst_element = -1;     ///< Out.
};

/// Averages over an element: Cauchy stress and C (6 each), energy density, volume.
inline constexpr int kSampleSize = 14;
/// At each node of an element: Cauchy stress (6) and energy density.
inline constexpr int kNodalSize = 7;

/// Functions of a kind of element.
struct ElementKernel {
  void (*evaluate)(const ElementData&, ElementStep&);
  /// Updates internal unknowns. @returns the largest change of one [m].
  double (*advance)(const ElementData&, const ElementStep&, const double* du);
  /// Energy at t_{n+1}, and power dissipated by viscosity and relaxation.
  void (*work)(const ElementData&, const ElementStep&, double* stored, double* power);
  /// @param nodal  n × kNodalSize an element, or null.
  void (*sample)(const ElementData&, const ElementStep&, double* samples, double* nodal);
  /// Writes the memory of stresses at t_{n+1}; before the other history is updated.
  void (*remember)(const ElementData&, const ElementStep&, double* history);
};

/// Sizes used by kernels and the group: rows of gradients at a point (nodes, then enhanced modes),
/// numbers of history by element and packs of scratch by block.
struct ElementSizes {
  int nodes, points, enhanced;
  bool mean_dilatation;

  [[nodiscard]] constexpr int rows() const { return nodes + enhanced; }
  [[nodiscard]] constexpr int point_packs() const { return 1 + 3 * rows(); }
  /// Enhanced: α, and α̇ of the previous step. Mean dilatation: pressure.
  [[nodiscard]] constexpr int history() const {
    return enhanced > 0 ? 6 * enhanced : mean_dilatation ? 1 : 0;
  }
  // Scratch of enhanced elements: α, K_αα⁻¹ r_α, K_αα⁻¹, K_uα K_αα⁻¹, K_αα⁻¹ K_αu.
  [[nodiscard]] constexpr int modes() const { return 3 * enhanced; }
  [[nodiscard]] constexpr int at_move() const { return modes(); }
  [[nodiscard]] constexpr int at_inverse() const { return 2 * modes(); }
  [[nodiscard]] constexpr int at_left() const { return at_inverse() + modes() * modes(); }
  [[nodiscard]] constexpr int at_right() const { return at_left() + 3 * nodes * modes(); }
  // Of mean dilatation: pressure, extrapolated pressure, its derivative by the nodes'
  // displacements.
  [[nodiscard]] constexpr int at_slope() const { return 2; }
  [[nodiscard]] constexpr int scratch() const {
    return enhanced > 0 ? at_right() + 3 * nodes * modes() : mean_dilatation ? 2 + 3 * nodes : 0;
  }
};

/// All kinds of element, in the order of kElementSizes.
inline constexpr ElementSizes kElementSizes[] = {
    {8, 8, 0, false},    // hex8_standard
    {8, 8, 3, false},    // hex8_eas9
    {8, 8, 0, true},     // hex8_q1p0
    {20, 27, 0, false},  // hex20
    {27, 27, 0, false},  // hex27
    {4, 1, 0, false},    // tet4
    {10, 4, 0, false},   // tet10
    {15, 15, 0, false},  // tet15
    {6, 6, 0, false},    // wedge6
    {15, 18, 0, false},  // wedge15
};
inline constexpr int kElementKinds = sizeof kElementSizes / sizeof kElementSizes[0];

/// All kinds for one instruction set.
struct ElementKernels {
  const char* name;
  int width;
  const ElementKernel* kinds;
};

/// Kernels of an instruction set, see material_kernels(). @throws InputError if the machine or the
/// build lacks it.
[[nodiscard]] const ElementKernels& element_kernels(const std::string& isa);

}  // namespace polhode::solids
