// SPDX-License-Identifier: Apache-2.0
// Data of the elimination along the tree at an instant: plain data only, as the SIMD kernels
// include this for several instruction sets. docs/theory/elimination_along_the_tree.md, "At an
// instant".
#pragma once

#include <polhode/kernels/tree_data.hpp>

namespace polhode {

/// Eight bodies at an instant. Joints gather the first four members.
struct alignas(64) InstantBlock {
  Lane3 r;                   ///< [m]
  double Lambda[9][kLanes];  ///< Body to world, row by row.
  Lane3 v, omega;            ///< World [m/s, rad/s].
  double J[6][kLanes];       ///< xx, yy, zz, xy, xz, yz about the centre of mass, world [kg m²].
};

/// Numbers of eight joints, a lane for each row of theirs.
struct alignas(64) JointLanes {
  double value[6][kLanes];   ///< Right-hand side is its negative: rates G v, or γ.
  double lambda[6][kLanes];  ///< Multipliers / m_ref,
  double centre[6][kLanes];  ///< and those of the iteration before; zero in the first one.
};

/// A body's elimination.
struct alignas(64) InstantBody {
  RowData A[6];  ///< Articulated inertia / m_ref; symmetric, so that rows are columns.
  RowData B[6];  ///< Relative motions: free ones first, then n_i with G n_i = the i-th unit vector.
  RowData T[3];  ///< Rows of X − 1, the motion of a body welded to its parent.
  RowData D[6];  ///< (BᵀAB + softness⁻¹)⁻¹
  RowData Y[6];  ///< D BᵀAX
  RowData load;  ///< Right-hand side of the body itself, / m_ref.
  RowData rho;   ///< With those of its subtree.
  RowData x_g;   ///< Relative motion that the joint's rows prescribe.
  RowData p;     ///< D Bᵀ(ρ − A x_g), then the relative motion's coefficients.
  RowData X;     ///< Solution.
};

/// Multipliers of a loop's rows.
struct alignas(64) InstantLoop {
  RowData S[6];              ///< Factors of its block, see factor_block().
  RowData value, y, centre;  ///< See JointLanes.
  RowData nu;                ///< With what the bodies add.
  RowData softness;          ///< ε times the weights of its rows.
};

/// All data of the kernels, as plain pointers.
struct InstantView {
  int blocks = 0, bodies = 0, loops = 0, ground_loops = 0;
  /// Every row has a softness ε: those of the tree, too, so that of the multipliers that redundant
  /// rows leave undetermined the smallest ones result. Without loops ε is zero.
  bool soft = false;
  double epsilon = 0.0;
  double inverse_mass = 1.0;  ///< 1/m_ref.
  double length = 1.0;        ///< ℓ, in which rotations are measured [m].
  double gravity[3] = {0, 0, 0};
  const int* block_shape = nullptr;    ///< By block: code of its joints' shape.
  const int* slot_in_order = nullptr;  ///< Slots, parents first.
  const int* parent = nullptr;         ///< By slot; the ground is the last one.
  const int* gather = nullptr;         ///< By slot: offset of the parent's lane in `motion`.
  const int* joint = nullptr;          ///< By block: offset into joint_data, doubles.
  const double* joint_data = nullptr;  ///< Constants in the order of JointLayout.
  const MassBlock* mass = nullptr;
  InstantBlock* motion = nullptr;  ///< blocks + 1, the last one is the ground.
  JointLanes* lanes = nullptr;     ///< By block.
  InstantBody* body = nullptr;     ///< By slot, and one for the ground.
  // Loops, as in TreeView.
  const TreeLoop* loop = nullptr;
  const LaterLoop* later = nullptr;
  const int* product = nullptr;
  const int* ground_loop = nullptr;
  const int* first_open = nullptr;
  const LoopAtBody* open = nullptr;
  const int* first_update = nullptr;
  const LoopUpdate* update = nullptr;
  const int* first_common = nullptr;
  const int* common = nullptr;
  double* pair_rows = nullptr;  ///< Gᵀ at a body: the first six rows of a pair.
  RowData* kept = nullptr;      ///< Twelve rows of each entry of `open`: GB and DBᵀGᵀ.
  double* S = nullptr;
  InstantLoop* loop_data = nullptr;  ///< By loop.
  int loop_blocks = 0;
  const LoopJoints* loop_joints = nullptr;  ///< from_a, from_b are offsets in `motion`.
  const double* loop_constants = nullptr;
};

/// Largest values of rows.
struct InstantRates {
  double value = 0.0;  ///< Of |G v|; NaN if one is.
  double scale = 0.0;  ///< Sum of the magnitudes of its terms.
};

/// Size of a solution, and how far its rows are from their right-hand sides.
struct InstantResidual {
  double residual = 0.0;
  double scale = 0.0;  ///< Largest |x|, rotations times ℓ, and |value|.
};

/// Kernels of one instruction set.
struct InstantKernels {
  /// Fills `motion` from a state.
  void (*place)(const InstantView* view, const BodyBlock* state);
  /// Fills T and B of the bodies and Gᵀ of LoopJoints.
  void (*assemble)(const InstantView* view);
  /// Sets the values of the rows of tree joints and LoopJoints to their rates.
  InstantRates (*rates)(const InstantView* view);
  /// Sets them to γ, the parts of the accelerations of rows that velocities determine.
  void (*velocity_terms)(const InstantView* view);
  /// Sets `load` to gravity and gyroscopic moments.
  void (*loads)(const InstantView* view);
  /// Factors. False: a pivot is not positive.
  bool (*factor)(const InstantView* view);
  /// Solves with the present loads, values and centres.
  InstantResidual (*solve)(const InstantView* view);
  /// Adds the solution to the velocities of `motion` and of the state.
  void (*add_velocities)(const InstantView* view, BodyBlock* state);
};

/// Kernels of the same instruction set as those of lane_kernels().
[[nodiscard]] const InstantKernels& instant_kernels(const LaneKernels& kernels);

}  // namespace polhode
