// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <polhode/equations/newton_system.hpp>

namespace polhode {

/// Result of the assembly of positions.
struct PositionReport {
  bool assembled = true;         ///< False: g = 0 was not reached; see `unsatisfied`.
  double residual_before = 0.0;  ///< Largest |g| as given [m or -].
  double residual = 0.0;         ///< Largest |g| now [m or -].
  double largest_move = 0.0;     ///< Of any body, |Δr|/ℓ or angle [-].
  int moved_body = -1;           ///< Which; -1 if nothing moved.
  int iterations = 0;
  std::vector<int> unsatisfied;  ///< Interactions with contradictory rows.
};

/// Result of the projection of velocities.
struct VelocityReport {
  double residual_before = 0.0;  ///< Largest |G v| as given [m/s or 1/s].
  /// Largest speed of a body, ℓ times its angular velocity, speed of a node [m/s], or row sum of
  /// magnitudes of G v.
  double scale = 0.0;
  double residual = 0.0;        ///< Largest |G v| now.
  double largest_change = 0.0;  ///< Of a velocity |Δv| [m/s] or ℓ|Δω| [m/s].
  int changed_body = -1;
  int solves = 0;  ///< 0: G v was already at round-off.
};

/// Accelerations and multipliers at an instant.
struct InstantSolution {
  bool solved = true;               ///< False: a value is not finite.
  std::vector<Vec3> r_ddot, alpha;  ///< By body: of the centre [m/s²], angular, world [rad/s²].
  std::vector<double> node_a;       ///< Of the nodes of solids, three each [m/s²].
  std::vector<double> node_force;   ///< Reaction forces on the nodes of solids, three each [N].
  std::vector<double> lambda;       ///< By row; the smallest ones where rows are redundant.
  double residual = 0.0;            ///< Largest |G q̈ + γ|.
  /// False: the velocities are not compatible with a singular position.
  bool consistent = true;
};

/// The linear system of one instant,
///
///   [ M  −Gᵀ ] [ x ]   [ f    ]
///   [ G   ε  ] [ λ ] = [ −γ   ]      with proximal iterations: G x = −γ to round-off,
///
/// and its uses: assembling positions, projecting velocities, accelerations. The matrix is
/// allocated at its first use. Compliant rows are forces here, not constraints.
class InstantSolver {
 public:
  explicit InstantSolver(const System& system, std::string solver = "block_lu");
  ~InstantSolver();

  /// Sets the factor of drives and loads [-]; 1 unless set.
  void set_load_factor(double factor);
  /// Moves bodies onto g = 0 by the smallest mass-weighted displacement (Gauss-Newton). Does
  /// nothing if g is at round-off. Velocities keep their components (v world, W body).
  /// @param tolerance  |g| that counts as assembled if rounding allows no less [m or -].
  PositionReport assemble_positions(State& state, double tolerance = 1e-10);
  /// Projects velocities onto G v = 0 by the smallest mass-weighted change.
  VelocityReport project_velocities(State& state);
  /// Accelerations and multipliers at a state.
  /// @param more  Further wrenches by body, such as contacts'; may be empty. World, about the
  /// centres of mass [N, N m].
  [[nodiscard]] InstantSolution accelerations(const State& state, std::span<const Vec6> more = {});
  /// Prepares velocity jumps at this instant. Solids take part: impulses act on bodies only, and
  /// free nodes follow through the mass matrix.
  /// @returns false if a matrix is singular.
  [[nodiscard]] bool take_impulses(const State& state);
  /// Sets impulses on free nodes (3 each, zero on others) for jumps() and node_jumps(); empty:
  /// none.
  void press_nodes(std::span<const double> impulses);
  /// Jumps with M Δv = impulses, G Δv = 0. By body (linear, angular), world, about the centres of
  /// mass.
  [[nodiscard]] std::vector<Vec6> jumps(std::span<const Vec6> impulses);
  /// Smallest change that takes the velocities onto G v = 0.
  [[nodiscard]] std::vector<Vec6> jumps_to_admissible(const State& state);
  /// Impulses of the rows in given jumps: Gᵀ Λ = M Δv − impulses, the smallest Λ where rows are
  /// redundant. After take_impulses().
  /// @param impulses  Applied to the bodies; those on free nodes by press_nodes().
  /// @param jumps  Of the bodies (linear, angular), world.
  /// @returns by row [N s or N m s]; empty if they cannot be computed.
  [[nodiscard]] std::vector<double> row_impulses(std::span<const Vec6> impulses,
                                                 std::span<const Vec6> jumps);
  /// Jumps of all velocities at this instant for given jumps of drives.
  /// @param given  Of prescribed components, three per node, zero elsewhere [m/s]; may be empty.
  /// @param rows  Of G v, by row; may be empty.
  /// @param bodies  Out: by body (linear, angular), world.
  /// @param nodes  Out: three per node, including the given ones [m/s].
  /// @param impulses  Out: of all rows [N s or N m s].
  /// @returns false if a matrix is singular.
  [[nodiscard]] bool jumps_by_kinks(const State& state, std::span<const double> given,
                                    std::span<const double> rows, std::vector<Vec6>& bodies,
                                    std::vector<double>& nodes, std::vector<double>& impulses);
  /// Smallest mass-weighted jumps of all velocities at this instant that bring some rows onto G v =
  /// ċ, while others keep their G v.
  /// @param rows  By row: 1 for those.
  /// @param bodies  Out: by body (linear, angular), world.
  /// @param nodes  Out: three per node [m/s].
  /// @param impulses  Out: of the rows [N s or N m s].
  /// @returns the kinetic energy of the jumps, which is the loss by the impulses [J]; nothing if a
  /// matrix is singular.
  [[nodiscard]] std::optional<double> jumps_onto(const State& state, std::span<const char> rows,
                                                 std::vector<Vec6>& bodies,
                                                 std::vector<double>& nodes,
                                                 std::vector<double>& impulses);
  /// Jumps of the nodes of solids (3 each), for jumps of the bodies.
  [[nodiscard]] std::vector<double> node_jumps(std::span<const Vec6> bodies);

  /// Projects a velocity field onto the constraints in the mass metric. In and out: by body
  /// (linear, angular), world.
  void keep_admissible(const State& state, std::vector<Vec6>& field);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Adds jumps of velocities to a state.
/// @param bodies  By body (linear, angular), world.
/// @param nodes   Of solids, three a node; may be empty.
void add_jumps(const System& system, std::span<const Vec6> bodies, std::span<const double> nodes,
               State& state);

/// Assembles positions, see InstantSolver::assemble_positions().
PositionReport assemble_positions(const System& system, State& state, double tolerance = 1e-10);
/// Projects velocities, see InstantSolver::project_velocities().
VelocityReport project_velocities(const System& system, State& state);
/// Accelerations and multipliers at t_n for output. Velocities are first projected on a copy, as
/// those of the step have a constraint-normal error of the order of the method.
[[nodiscard]] InstantSolution instant_solution(const System& system, const State& state);

}  // namespace polhode
