// SPDX-License-Identifier: Apache-2.0
// Uses a function that stands in a header, one that is compiled into the library, and an error
// that crosses the library's border.
#include <cmath>
#include <iostream>

#include <polhode/core/error.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>

int main() {
  using namespace polhode;

  // A Cayley vector of length 2 is a quarter turn.
  const Mat3 quarter = cay(Vec3(0.0, 0.0, 2.0));
  const double header_error =
      (quarter - exp_map(Vec3(0.0, 0.0, std::acos(0.0)))).cwiseAbs().maxCoeff();

  const double sizes[] = {2.0, 1.0, 0.5};
  const MassProperties box = shape_mass_properties("box", *find_shape_kind("box"), sizes, 8.0);

  bool refused = false;
  try {
    check_mass_properties("bodies.box", -1.0, box.inertia);
  } catch (const InputError& error) {
    refused = error.where() == "bodies.box";
  }

  std::cout << "cay: error " << header_error << "; box: " << box.mass << " kg; refusal "
            << (refused ? "caught" : "lost") << '\n';
  return header_error < 1e-15 && box.mass == 8.0 && refused ? 0 : 1;
}
