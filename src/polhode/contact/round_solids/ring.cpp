// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/meridian.hpp>
#include <polhode/contact/round_solids/ring.hpp>

namespace polhode::contact {

namespace {

template <class T>
Gap<T> over_ring(const V3<T>& x, double rho_a, const geometry::Shape& b, const Placement<T>& at_b) {
  const Meridian<T> m(x, b, at_b);
  return between_points(x, m.point(at_b, b, 0.0, b.half[0]), rho_a, b.rounding);
}

}  // namespace

const RoundSolid& ring_solid() {
  static constexpr RoundSolid solid{"ring",
                                    nullptr,
                                    nullptr,
                                    nullptr,
                                    {over_ring<double>, nullptr},
                                    {over_ring<Dual>, nullptr},
                                    {over_ring<Fine>, nullptr}};
  return solid;
}

}  // namespace polhode::contact
