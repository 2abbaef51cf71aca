// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>
#include <polhode/system/changing_sparsity.hpp>

namespace polhode {

/// Of one surface, places nearer than so many gap tolerances from the start on do not meet.
inline constexpr double kTogether = 4.0;

/// What a contact of surfaces of solids starts from.
struct SolidContactStart {
  const std::vector<Vec3>& X;        ///< Positions by the system's node numbers [m].
  const std::vector<int>& carriers;  ///< Body of each node, as NodeData::body.
  double edge = 1.0;                 ///< Typical edge of the faces [m].
  double way = 0.0;                  ///< That surfaces may go against each other in a step [m].
  bool self = false;  ///< Both are one surface: what is near from the start is not met.
};

/// The nodes of two surfaces that may meet, and when it has to be looked again for what of them is
/// near.
///
/// That is done where nodes stood at some instant, the `key`: these places, three numbers a node,
/// and how far is looked. It is part of the state, so that a run that goes on from a saved one
/// finds the same. It is done anew when nodes have gone against each other by a good part of what
/// was looked at, and no iterate may take them farther than that.
class ContactNeighbours {
 public:
  /// @param lists  Points whose nodes these are.
  ContactNeighbours(std::initializer_list<const std::vector<MeshPoint>*> lists,
                    const SolidContactStart& start);

  [[nodiscard]] const std::vector<int>& numbers() const { return numbers_; }  ///< Ascending.
  [[nodiscard]] std::size_t key_size() const { return 3 * numbers_.size() + 1; }
  void write_start(double* key) const;
  /// The places of a key by node number, as positions are given.
  [[nodiscard]] std::vector<double> positions(const double* key) const;
  /// For another instant than the start, as if it were that.
  void write_instant(const double* x, double* key) const;
  /// Looks again if it is time to.
  void renew(const NodeStep& step, double* key) const;
  /// How far around features others are looked for [m].
  [[nodiscard]] double look(const double* key) const { return key[key_size() - 1]; }
  /// Of the way from one set of positions to another, the part within which nothing that was not
  /// looked at can meet.
  [[nodiscard]] double free_part(const double* from, const double* to, const double* key) const;

  [[nodiscard]] Vec3 place(const MeshPoint& p, const double* key) const;
  [[nodiscard]] Vec3 start(const MeshPoint& p) const { return place(p, start_.data()); }
  /// Whether points move with one body, or not at all.
  [[nodiscard]] bool carried_together(std::initializer_list<const MeshPoint*> points) const;

  /// Blocks of the tangent for nodes that meet.
  struct Blocks {
    NodeBlocks blocks;
    std::vector<int> row_start;  ///< By place in numbers().
  };
  /// @param sets  Nodes that act on each other, each list for itself.
  [[nodiscard]] Blocks blocks(const std::vector<std::vector<int>>& sets) const;
  void add(const Blocks& b, const MeshPoint& row, const MeshPoint& column, const Mat3& K,
           double* tangent) const;

 private:
  [[nodiscard]] int at(int node) const;
  /// How far node k has moved from the places, beside what all have.
  [[nodiscard]] std::vector<double> deviations(const double* x, const double* places) const;

  double edge_, way_;
  std::vector<int> numbers_;
  std::vector<double> start_;  ///< Places.
  std::vector<int> carriers_;  ///< A body, or kFreeNode.
};

}  // namespace polhode
