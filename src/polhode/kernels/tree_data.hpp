// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/body_block.hpp>

namespace polhode {

/// Mass properties of eight bodies; lanes without a body have mass 1 and the unit inertia.
struct alignas(64) MassBlock {
  Lane mass;            ///< [kg]
  double J[6][kLanes];  ///< xx, yy, zz, xy, xz, yz about the centre of mass, body axes [kg m²].
};

/// A row of the elimination: eight numbers of one body.
using RowData = double[8];

/// Stored elimination of a body for back substitution.
struct alignas(64) EliminatedBody {
  RowData A[6];  ///< Articulated rows [A (6) | 0 | −ρ]: children's contributions first, then all.
  RowData X;     ///< Increment [Δr, Δθ, 0, 1].
};

/// Contributions of off-tree interactions to one body's own 6×6 block and right-hand side.
struct alignas(64) ExtraRows {
  RowData A[6];  ///< [K (6) | 0 | −ρ], scaled.
};

/// Coupling of a body with its parent by off-tree interactions (springs at a joint).
struct alignas(64) EdgeRows {
  RowData K_bp[6], K_pb[6];
};

/// Number of values stored per body for a joint of a shape: its layout in TreeView::joint_data, in
/// units of one lane (eight doubles).
struct JointLayout {
  int translation = 0, directions = 0;  ///< Numbers of rows.

  [[nodiscard]] constexpr int free() const { return 6 - translation - directions; }
  [[nodiscard]] constexpr int directors() const { return directions == 0 ? 0 : directions + 1; }
  /// Number of stored slide vectors: the rows' directions, and for one row an auxiliary normal to
  /// it.
  [[nodiscard]] constexpr int slides() const {
    return translation == 1 || translation == 2 ? 2 : 0;
  }
  [[nodiscard]] constexpr bool root() const { return translation == 0 && directions == 0; }
  /// Whether it is a spherical joint: coincident points, all rotations free.
  [[nodiscard]] constexpr bool ball() const { return translation == 3 && directions == 0; }
  // Constants of the joint.
  [[nodiscard]] constexpr int Z_a() const { return 0; }
  [[nodiscard]] constexpr int Z_b() const { return 3; }
  [[nodiscard]] constexpr int director() const { return 6; }
  [[nodiscard]] constexpr int slide() const { return director() + 3 * directors(); }
  // Multipliers.
  [[nodiscard]] constexpr int lambda() const { return slide() + 3 * slides(); }
  // At t_n: lever arm on a, lever arm on b, directors, slides.
  [[nodiscard]] constexpr int arm_a_n() const { return lambda() + translation + directions; }
  [[nodiscard]] constexpr int arm_b_n() const { return arm_a_n() + 3; }
  [[nodiscard]] constexpr int director_n() const { return arm_b_n() + 3; }
  [[nodiscard]] constexpr int slide_n() const { return director_n() + 3 * directors(); }
  // Stored for back substitution.
  [[nodiscard]] constexpr int arm_b_alpha() const { return slide_n() + 3 * slides(); }
  [[nodiscard]] constexpr int c_r() const { return arm_b_alpha() + 3; }
  [[nodiscard]] constexpr int x_g() const { return c_r() + 3; }
  [[nodiscard]] constexpr int S_r() const { return x_g() + 6; }
  [[nodiscard]] constexpr int z_b() const { return S_r(); }  ///< Of a spherical joint: all of S_r.
  [[nodiscard]] constexpr int director_alpha() const { return S_r() + (ball() ? 3 : 6 * free()); }
  [[nodiscard]] constexpr int director_n1() const { return director_alpha() + 3 * directors(); }
  [[nodiscard]] constexpr int slide_alpha() const { return director_n1() + 3 * directors(); }
  [[nodiscard]] constexpr int slide_n1() const { return slide_alpha() + 3 * slides(); }
  [[nodiscard]] constexpr int size() const { return root() ? 0 : slide_n1() + 3 * slides(); }

  [[nodiscard]] static constexpr JointLayout of_code(int code) { return {code / 4, code % 4}; }
};

/// A loop that is open at a body: the interaction's columns and rows carried along the tree.
struct LoopAtBody {
  int loop;             ///< Index into loops.
  int pair;             ///< Position of its C and Rᵀ (in rows of 8, see TreeView::pair_rows).
  int parent_pair;      ///< The same at the parent; -1 if the parent is the ground.
  int first_at_parent;  ///< 1: this is the first writer into parent_pair.
  int kept;             ///< Position of γ and e, panels × free directions rows each.
};

/// One product e γ' that is subtracted from a block between two loops open at the same body.
struct LoopUpdate {
  int row_loop, column_loop;  ///< Positions within the body's list of open loops.
  int block;                  ///< Offset of S(row, column) in TreeView::S.
};

/// Unknowns in addition to the tree: multipliers of a loop joint, couplings of distant bodies.
struct TreeLoop {
  int unknowns = 0, panels = 0;         ///< panels = ⌈unknowns/8⌉.
  int common = -1;                      ///< Slot of the lowest common ancestor; -1: the ground.
  int common_pair = -1;                 ///< Position of C and Rᵀ at the common ancestor.
  int S = 0;                            ///< Offset of the diagonal block.
  int nu = 0;                           ///< Offset of ν, of the solution y and of the pivots.
  int U = 0;                            ///< Rows of S⁻¹[R_common | · | ν], unknowns rows of 8.
  int first_later = 0, last_later = 0;  ///< Into TreeView::later.
  int first_product = 0;  ///< Blocks S(b, a) of later loops b, a: into TreeView::product.
};

/// A loop `loop` that is eliminated after the present one and shares a block with it.
struct LaterLoop {
  int loop, S_row, S_column;  ///< S(present, later), S(later, present).
  int common_pair;            ///< Pair of `later` at the present loop's common ancestor; -1: none.
};

/// Eight loop joints with coincident points, of one shape, assembled together; `count` lanes are in
/// use. Their values are in TreeView::loop_data, in the order of JointLayout.
struct LoopJoints {
  int directions = 0;  ///< Direction rows.
  /// The couple is the unknown, three numbers; otherwise the multipliers are.
  bool couple = false;
  int count = 0;
  int data = 0;                                  ///< Offset into loop_data, doubles.
  int from_a[kLanes] = {}, from_b[kLanes] = {};  ///< Offsets of the bodies' lanes in the trial.
  int slot_a[kLanes] = {}, slot_b[kLanes] = {};  ///< The ground is the last one.
  int extra_a[kLanes] = {}, extra_b[kLanes] = {};
  int pair_a[kLanes] = {}, pair_b[kLanes] = {};  ///< Start of C and Rᵀ; −1: the ground.
  int S[kLanes] = {}, nu[kLanes] = {};           ///< Of their loops.
  int row[kLanes] = {};                          ///< First multiplier.
};

/// Constraint violations at the trial.
struct LaneCheck {
  double largest = 0.0;                        ///< |g|.
  int worst_slot = -1;                         ///< A tree joint's body, or
  int worst_row = -1;                          ///< a loop joint's row.
  double work_defect = 0.0, work_scale = 0.0;  ///< Σ|λ g|, Σ|λ|(ℓ + |x|) [J].
};

/// All data of the tree kernels, as plain pointers: the kernels are compiled for several
/// instruction sets and must not instantiate library code.
struct TreeView {
  // Topology.
  int bodies = 0, blocks = 0, chunks = 0;
  const TreeRun* run = nullptr;
  const TreeChunk* chunk = nullptr;
  const int* slot_in_order = nullptr;  ///< Slots, parents first.
  const int* parent = nullptr;         ///< Slot of the parent, −1 ground; by slot.
  const int* gather = nullptr;  ///< Offset of the parent's lane in the trial, doubles; by slot.
  const int* shape = nullptr;   ///< Shape code by slot.
  const unsigned char* has_children = nullptr;  ///< Contributions are added to A before its turn.
  const unsigned char* first_child = nullptr;   ///< This slot is the first writer at its parent.
  const int* extra = nullptr;                   ///< Index into extra_rows or −1; by slot.
  const int* edge = nullptr;                    ///< Index into edge_rows or −1; by slot.
  const int* y_row = nullptr;                   ///< First row in Y; by slot.
  const int* joint = nullptr;                   ///< Offset into joint_data, doubles; by block.
  // Data.
  const BodyBlock* state = nullptr;
  TrialBlock* trial = nullptr;  ///< blocks + 1, the last one is the ground.
  const MassBlock* mass = nullptr;
  double* joint_data = nullptr;
  EliminatedBody* body = nullptr;  ///< By slot, and one for the ground.
  RowData* Y = nullptr;            ///< D⁻¹[Qᵀ | · | −β] of each free direction.
  ExtraRows* extra_rows = nullptr;
  EdgeRows* edge_rows = nullptr;
  // Loops.
  int loops = 0, ground_loops = 0;
  TreeLoop* loop = nullptr;
  const LaterLoop* later = nullptr;
  const int* product = nullptr;      ///< Offsets of S(b, a), row by row, by loop.
  const int* ground_loop = nullptr;  ///< Loops whose common ancestor is the ground, in order.
  const int* first_open = nullptr;   ///< By slot, size slots + 1: range in open.
  const LoopAtBody* open = nullptr;
  const int* first_update = nullptr;  ///< By slot: range in update.
  const LoopUpdate* update = nullptr;
  const int* first_common = nullptr;  ///< By slot: range in common: loops with this ancestor.
  const int* common = nullptr;
  double* pair_rows = nullptr;  ///< C (6 × panels rows), then Rᵀ (6 × panels rows).
  double* kept_rows = nullptr;  ///< γ and e of (body, loop).
  double* S = nullptr;
  double* nu = nullptr;
  double* y = nullptr;
  int* pivots = nullptr;
  double* U = nullptr;
  int loop_blocks = 0;
  const LoopJoints* loop_joints = nullptr;
  double* loop_data = nullptr;
  double* lambda = nullptr;  ///< By row; tree joints store theirs in joint_data.
  const double* lambda_centre = nullptr;
  double proximal = 0.0;  ///< ε of loop rows.
  // Step.
  double gravity[3] = {0, 0, 0};
  double scale = 0.0;  ///< s_c = βΔt²/m_ref.
  double alpha_f = 0.5, alpha_m = 0.5, beta = 0.25, gamma = 0.5, kappa = 1.0, c = 2.0, c_A = 0.0;
  double dt = 0.0;
  double inverse_mass = 1.0;    ///< 1/m_ref.
  double inverse_length = 1.0;  ///< 1/ℓ.
  double damping = 1.0;
  int first_iteration = 1;  ///< Step constants are computed in this sweep.
};

struct SweepResult {
  double increment = 0.0;         ///< Largest |Δr|/ℓ or |Δθ|; NaN if a value was not finite.
  double rotation_squared = 0.0;  ///< Largest θ·θ after the update.
};

/// Quantities of ledger and energy, summed over bodies.
struct BodySums {
  double kinetic = 0.0, gravity_potential = 0.0;
  double p[3] = {0, 0, 0}, l[3] = {0, 0, 0};
  double mr[3] = {0, 0, 0};             ///< Σ m r.
  double p_scale = 0.0, l_scale = 0.0;  ///< Σ m|v|, Σ |r × mv| + |h|.
};

struct PredictWeights {
  double weight[kPast] = {0, 0, 0, 0};  ///< By ring position; used if count > 0.
  int count = 0;
};

/// SIMD kernels of one instruction set.
struct LaneKernels {
  const char* name;
  /// Fills the trial from the state: Λ_n, h_n, predicted u and θ, configuration at t_{n+1}.
  void (*predict)(const BodyBlock* state, const MassBlock* mass, TrialBlock* trial, int blocks,
                  double dt, const PredictWeights* weights);
  /// Fills the state at t_{n+1} from the trial.
  void (*commit)(BodyBlock* state, const MassBlock* mass, const TrialBlock* trial, int blocks,
                 const TreeView* step, int ring);
  void (*sums)(const BodyBlock* state, const MassBlock* mass, const int* body_of_slot, int blocks,
               const double* gravity, BodySums* out);
  /// Sweep towards the roots: residual, tangent, elimination. False: a zero pivot.
  bool (*up)(const TreeView* view, int* failed_slot);
  /// Sweep towards the leaves: increments, multipliers, new configuration.
  SweepResult (*down)(const TreeView* view);
  /// Adds force and moment about the origin of the tree joints to the ground.
  void (*ground)(const TreeView* view, const int* body_of_slot, double* force, double* moment);
  /// Checks the constraints of the tree joints and of LoopJoints at the trial.
  void (*check)(const TreeView* view, const int* body_of_slot, LaneCheck* result);
};

}  // namespace polhode
