// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <polhode/contact/gap.hpp>

namespace polhode::contact {

/// Support point of a round solid from its centre, in its own axes, and its derivative by the
/// direction.
struct CurvedSupport {
  Vec3 x;
  Mat3 D;
};

/// Smoothing of support functions, as a part of a solid's size: straight sides bulge, sharp rims
/// are rounded, and slender and flat ellipsoids are thickened by it.
namespace blur {
inline constexpr double coarse = 1e-2;  ///< From which a search starts.
inline constexpr double fine = 1e-6;
}  // namespace blur

/// Gap and support function of a kind of round solid, for numbers of one type.
template <class T>
struct RoundFormulas {
  /// Gap of a ball of radius rho around the point x against the solid b.
  Gap<T> (*over)(const V3<T>& x, double rho, const geometry::Shape& b, const Placement<T>& at_b);
  /// Support point, from the centre, in the unit direction n; smooth in n, rounding included.
  /// @param axes  The three of the solid, in the world. @param blur  See namespace blur.
  V3<T> (*support)(const geometry::Shape& s, const V3<T>* axes, const V3<T>& n, double blur);
};

/// A kind of convex solid with a smooth surface that is not a polyhedron. It is an ellipsoid, or
/// has `flat_ends`; other code knows a kind by these and by this record alone. The rim of a tube is
/// no such kind, but has a record, see ring.hpp.
struct RoundSolid {
  std::string_view name;  ///< In shape_kinds().
  /// @param sizes  Those of shape_kinds(), checked.
  /// @param place  Of the centroid.
  /// @param rounding  Of edges and corners, if the kind has a choice; 0: its default [m].
  /// @throws InputError if a size or the rounding is rejected.
  geometry::Shape (*shape)(std::string_view where, std::span<const double> sizes,
                           const geometry::ShapePlace& place, double rounding);
  /// As RoundFormulas::support(), with n in the solid's own axes.
  CurvedSupport (*curved_support)(const geometry::Shape& s, const Vec3& n, double blur);
  /// Direction, of any length, whose support point at blur `to` is near that of n at blur `from`.
  Vec3 (*sharpened)(const geometry::Shape& s, const Vec3& n, double from, double to);
  RoundFormulas<double> plain;
  RoundFormulas<Dual> dual;
  RoundFormulas<Fine> fine;
  /// Record of the same kind with flatter ends, for contact with strictly convex shapes; null if it
  /// has no ends.
  const RoundSolid* with_flat_ends = nullptr;

  template <class T>
  [[nodiscard]] const RoundFormulas<T>& formulas() const {
    if constexpr (std::is_same_v<T, Dual>)
      return dual;
    else if constexpr (std::is_same_v<T, Fine>)
      return fine;
    else
      return plain;
  }
};

/// Record of a class of static functions with the names of those of RoundSolid and RoundFormulas.
template <class Kind>
constexpr RoundSolid record_of(std::string_view name, const RoundSolid* with_flat_ends = nullptr) {
  return {name,
          Kind::shape,
          Kind::curved_support,
          Kind::sharpened,
          {Kind::template over<double>, Kind::template support<double>},
          {Kind::template over<Dual>, Kind::template support<Dual>},
          {Kind::template over<Fine>, Kind::template support<Fine>},
          with_flat_ends};
}

/// Every kind of round solid.
[[nodiscard]] std::span<const RoundSolid* const> round_solids();

/// The kind of that name, or null.
[[nodiscard]] const RoundSolid* find_round_solid(std::string_view name);

}  // namespace polhode::contact
