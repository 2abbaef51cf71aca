// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/system/changing_sparsity.hpp>

namespace polhode::surface_contact {

/// Distance at the start, in gap tolerances, below which points of one surface are not paired.
inline constexpr double kTogether = 4.0;

/// Initial data of a contact between surfaces of solids.
struct SolidContactStart {
  const std::vector<Vec3>& X;        ///< Positions by the system's node numbers [m].
  const std::vector<int>& carriers;  ///< Body of each node, as NodeData::body.
  double edge = 1.0;                 ///< Typical edge of the faces [m].
  /// Largest relative displacement of the surfaces in a step [m].
  double way = 0.0;
  bool self = false;  ///< Both are one surface: points that are near at the start are not paired.
};

/// Neighbour list of two surfaces: the nodes that may come into contact, and when the list has to
/// be renewed.
///
/// The search is made at node positions of some instant, the `key`: these positions, three numbers
/// per node, and the search radius. The key is part of the state, so that a restarted run finds the
/// same list. The search is repeated when relative displacements of nodes reach a considerable part
/// of the search radius, and no iterate may move them farther than the radius allows.
class ContactNeighbours {
 public:
  /// @param lists  Points that depend on these nodes.
  ContactNeighbours(std::initializer_list<const std::vector<MeshPoint>*> lists,
                    const SolidContactStart& start);

  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }  ///< Ascending.
  [[nodiscard]] std::size_t key_size() const { return 3 * numbers_.size() + 1; }
  void write_start(double* key) const;
  /// Positions of a key by node number, in the layout of positions.
  [[nodiscard]] std::vector<double> positions(const double* key) const;
  /// Sets the key for another instant than the start, as if it were the start.
  void write_instant(const double* x, double* key) const;
  /// Repeats the search if it is due.
  void renew(const NodeStep& step, double* key) const;
  /// Search radius around features [m].
  [[nodiscard]] double look(const double* key) const { return key[key_size() - 1]; }
  /// Part of the displacement from one set of positions to another within which only listed pairs
  /// can come into contact.
  [[nodiscard]] double free_part(const double* from, const double* to, const double* key) const;

  [[nodiscard]] Vec3 place(const MeshPoint& p, const double* key) const;
  [[nodiscard]] Vec3 start(const MeshPoint& p) const { return place(p, start_.data()); }
  /// Whether points move with one body, or are all fixed.
  [[nodiscard]] bool carried_together(std::initializer_list<const MeshPoint*> points) const;

  /// Blocks of the tangent of the paired nodes.
  struct Blocks {
    NodeBlocks blocks;
    std::vector<int> row_start;  ///< By position in numbers().
  };
  /// @param sets  Lists of nodes that act on each other within each list.
  [[nodiscard]] Blocks blocks(const std::vector<std::vector<int>>& sets) const;
  void add(const Blocks& b, const MeshPoint& row, const MeshPoint& column, const Mat3& K,
           double* tangent) const;

 private:
  [[nodiscard]] int at(int node) const;
  /// Displacement of each node k from the given positions, less the mean displacement.
  [[nodiscard]] std::vector<double> deviations(const double* x, const double* places) const;

  double edge_, way_;
  std::vector<int> numbers_;
  std::vector<double> start_;  ///< Positions.
  std::vector<int> carriers_;  ///< A body, or kFreeNode.
};

}  // namespace polhode::surface_contact
