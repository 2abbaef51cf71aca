// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/point_band.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode::surface_contact {

/// History of a point of a surface in contact, in the surface's axes where that is rigid.
struct PointMemory {
  double bristle[3];             ///< [m]
  double slips;                  ///< 1: yes.
  double force[3];               ///< Of the last step, per area [Pa].
  double friction[3], pressure;  ///< Its tangential part and the normal one [Pa].
  PointPhase phase;

  static constexpr std::size_t kCount = 14;
};
static_assert(kNumbersOf<PointMemory> == PointMemory::kCount);

/// History of an edge in contact with one other edge.
struct EdgeMemory {
  double partner;                    ///< Its number and one; 0: none.
  double bristle[3];                 ///< In the world [m].
  double slips;                      ///< 1: yes.
  double force[3];                   ///< On the first edge in the last step [N].
  double friction[3], normal_force;  ///< Its tangential part and the normal one [N].
  double bristle_along;              ///< Lengthwise [m].
  PointPhase phase;

  static constexpr std::size_t kCount = 16;
};
static_assert(kNumbersOf<EdgeMemory> == EdgeMemory::kCount);

}  // namespace polhode::surface_contact
