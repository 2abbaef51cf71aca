// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <polhode/surface_contact/central_gap.hpp>
#include <polhode/surface_contact/surface_law.hpp>

namespace polhode::surface_contact {

/// Distance of a point from moving triangles.
///
/// A round section about the point has a gap to each triangle, edge and corner nearby; the reported
/// distance has the potential of their sum, see RigidMesh. In a valley of the surface, such as a
/// cable presses into it, both slopes exert force. @eq{surface-feature-sum}
struct MeshGap {
  /// A face, edge or corner, as four points of a triangle that contains it.
  struct Part {
    int triangle = -1;
    NearestFour four;
    double share = 1.0;  ///< ∂D/∂d of this feature's distance d.
    double bend = 0.0;   ///< w f′(d)/f(D)
  };
  std::vector<Part> parts;
  double distance = 0.0;   ///< D [m]
  double bend = 0.0;       ///< f′(D)/f(D)
  double resultant = 1.0;  ///< |∂D/∂p|: resultant of all forces over that of D.

  [[nodiscard]] static MeshGap of(int triangle, const NearestFour& four) {
    MeshGap gap;
    gap.parts.push_back({triangle, four});
    gap.distance = four.distance;
    return gap;
  }
  [[nodiscard]] bool single() const { return parts.size() == 1; }
};

/// A triangle near a point: the point x_0, the corners x_1 to x_3.
struct TriangleAt {
  int triangle = -1;
  std::array<int, 3> corners{};
  Vec3 x[4];
};

/// @param near  All triangles within `centre` and the activation distance of the law, at least one:
/// the nearest one alone if none is.
/// @param centre  Distance at which the gap is zero [m].
[[nodiscard]] MeshGap mesh_gap(const std::vector<TriangleAt>& near, const contact::NormalLaw& law,
                               double centre);

/// Distance over a step, by the lengths between the points of all its features.
struct MeshGapStep {
  CentralGapOf<kMaxTriangles>::Over over;
  std::vector<int> triangles;  ///< Of its sets of points.

  /// Adds the features at both ends. Those beyond kMaxTriangles triangles do not contribute to the
  /// direction of the force; its work is exact all the same.
  /// @param moves  (triangle) → FourMoves.
  template <class Moves>
  MeshGapStep(const MeshGap& at_n, const MeshGap& at_n1, Moves&& moves) {
    for (const MeshGap* gap : {&at_n1, &at_n})
      for (const MeshGap::Part& p : gap->parts)
        if (triangles.size() < static_cast<std::size_t>(kMaxTriangles) && place(p.triangle) < 0)
          triangles.push_back(p.triangle);
    over.sets = static_cast<int>(triangles.size());
    for (std::size_t k = 0; k < triangles.size(); ++k) over.moves[k] = moves(triangles[k]);
    fill(at_n, at_n1);
  }

 private:
  [[nodiscard]] int place(int triangle) const {
    const auto at = std::find(triangles.begin(), triangles.end(), triangle);
    return at == triangles.end() ? -1 : static_cast<int>(at - triangles.begin());
  }
  void fill(const MeshGap& at_n, const MeshGap& at_n1);
};

}  // namespace polhode::surface_contact
