// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/elements/quadrature.hpp>

namespace polhode::solids {

std::vector<std::pair<double, double>> gauss(int points) {
  switch (points) {
    case 1:
      return {{0.0, 2.0}};
    case 2: {
      const double x = 1.0 / std::sqrt(3.0);
      return {{-x, 1.0}, {x, 1.0}};
    }
    case 3: {
      const double x = std::sqrt(0.6);
      return {{-x, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {x, 5.0 / 9.0}};
    }
    case 4: {
      const double r = 2.0 / 7.0 * std::sqrt(1.2), s = std::sqrt(30.0);
      const double a = std::sqrt(3.0 / 7.0 - r), b = std::sqrt(3.0 / 7.0 + r);
      const double v = (18.0 + s) / 36.0, w = (18.0 - s) / 36.0;
      return {{-b, w}, {-a, v}, {a, v}, {b, w}};
    }
    case 5: {
      const double r = 2.0 * std::sqrt(10.0 / 7.0), s = 13.0 * std::sqrt(70.0);
      const double a = std::sqrt(5.0 - r) / 3.0, b = std::sqrt(5.0 + r) / 3.0;
      const double v = (322.0 + s) / 900.0, w = (322.0 - s) / 900.0;
      return {{-b, w}, {-a, v}, {0.0, 128.0 / 225.0}, {a, v}, {b, w}};
    }
    case 6:
      // Roots of Legendre's polynomial of degree 6, which have no closed form in square roots.
      return {{-0.9324695142031521, 0.1713244923791704}, {-0.6612093864662645, 0.3607615730481386},
              {-0.2386191860831969, 0.4679139345726910}, {0.2386191860831969, 0.4679139345726910},
              {0.6612093864662645, 0.3607615730481386},  {0.9324695142031521, 0.1713244923791704}};
    default:
      throw InputError("quadrature", format("there is no Gauss rule of {} points here", points),
                       "Use 1 to 6 points");
  }
}

Quadrature hexahedron_rule(int points) {
  Quadrature rule;
  const auto line = gauss(points);
  for (const auto& [z, w_z] : line)
    for (const auto& [y, w_y] : line)
      for (const auto& [x, w_x] : line) rule.push_back({{x, y, z}, w_x * w_y * w_z});
  return rule;
}

Quadrature tetrahedron_rule(int degree) {
  if (degree == 1) return {{Vec3::Constant(0.25), 1.0 / 6.0}};
  if (degree == 2) {
    const double a = (5.0 + 3.0 * std::sqrt(5.0)) / 20.0, b = (5.0 - std::sqrt(5.0)) / 20.0;
    const double w = 1.0 / 24.0;
    return {{{b, b, b}, w}, {{a, b, b}, w}, {{b, a, b}, w}, {{b, b, a}, w}};
  }
  if (degree == 5) {
    Quadrature rule{{Vec3::Constant(0.25), 8.0 / 405.0}};
    for (const double sign : {-1.0, 1.0}) {
      const double root = sign * std::sqrt(15.0);
      const double a = (7.0 + root) / 34.0, b = (13.0 - 3.0 * root) / 34.0;
      const double w = (2665.0 - 14.0 * root) / 226800.0;
      for (const Vec3& xi : {Vec3(a, a, a), Vec3(b, a, a), Vec3(a, b, a), Vec3(a, a, b)})
        rule.push_back({xi, w});
    }
    const double c = (10.0 - 2.0 * std::sqrt(15.0)) / 40.0, d = 0.5 - c;
    for (const Vec3& xi :
         {Vec3(c, c, d), Vec3(c, d, c), Vec3(d, c, c), Vec3(c, d, d), Vec3(d, c, d), Vec3(d, d, c)})
      rule.push_back({xi, 5.0 / 567.0});
    return rule;
  }
  // A cube mapped to the tetrahedron: degree 9 or 11 in each variable, 2 of it for the Jacobian in
  // the first, one in the second.
  Quadrature rule;
  const auto line = gauss(5);
  for (const auto& [s, w_s] : gauss(degree == 8 ? 6 : 5))
    for (const auto& [t, w_t] : line)
      for (const auto& [u, w_u] : line) {
        const double a = 0.5 * (1.0 + s), b = 0.5 * (1.0 + t), c = 0.5 * (1.0 + u);
        rule.push_back({{a, b * (1.0 - a), c * (1.0 - a) * (1.0 - b)},
                        0.125 * w_s * w_t * w_u * (1.0 - a) * (1.0 - a) * (1.0 - b)});
      }
  return rule;
}

namespace {

/// Triangle: degree 2 (3 points) or 4 (6 points; D. A. Dunavant, International Journal for
/// Numerical Methods in Engineering 21 (1985) 1129-1148).
Quadrature triangle_rule(int degree) {
  Quadrature rule;
  const auto orbit = [&](double a, double w) {
    const double b = 1.0 - 2.0 * a;
    rule.push_back({{a, a, 0.0}, w});
    rule.push_back({{b, a, 0.0}, w});
    rule.push_back({{a, b, 0.0}, w});
  };
  if (degree == 2) {
    orbit(1.0 / 6.0, 1.0 / 6.0);
  } else {
    orbit(0.445948490915965, 0.5 * 0.223381589678011);
    orbit(0.091576213509771, 0.5 * 0.109951743655322);
  }
  return rule;
}

/// Triangle of degree 7: a square of 5 × 4 points mapped to it, one degree of the first for the
/// Jacobian.
Quadrature collapsed_triangle_rule() {
  Quadrature rule;
  for (const auto& [s, w_s] : gauss(5))
    for (const auto& [t, w_t] : gauss(4)) {
      const double a = 0.5 * (1.0 + s), b = 0.5 * (1.0 + t);
      rule.push_back({{a, b * (1.0 - a), 0.0}, 0.25 * w_s * w_t * (1.0 - a)});
    }
  return rule;
}

Quadrature quadrilateral_rule(int points) {
  Quadrature rule;
  const auto line = gauss(points);
  for (const auto& [y, w_y] : line)
    for (const auto& [x, w_x] : line) rule.push_back({{x, y, 0.0}, w_x * w_y});
  return rule;
}

/// Points along a line times those of a rule for the triangle of this degree.
Quadrature prism_rule(int points, int degree) {
  Quadrature rule;
  for (const auto& [z, w_z] : gauss(points))
    for (const QuadraturePoint& p : triangle_rule(degree))
      rule.push_back({{p.xi[0], p.xi[1], z}, p.weight * w_z});
  return rule;
}

}  // namespace

Quadrature wedge_rule() { return prism_rule(2, 2); }

Quadrature wedge15_rule() { return prism_rule(3, 4); }

Quadrature collapsed_wedge_rule() {
  // A cube mapped to the prism: degree 9 in each variable, one of it for the Jacobian in the first.
  Quadrature rule;
  const auto line = gauss(5);
  for (const auto& [z, w_z] : line)
    for (const auto& [s, w_s] : line)
      for (const auto& [t, w_t] : line) {
        const double a = 0.5 * (1.0 + s), b = 0.5 * (1.0 + t);
        rule.push_back({{a, b * (1.0 - a), z}, 0.25 * w_s * w_t * w_z * (1.0 - a)});
      }
  return rule;
}

Quadrature face_rule(const std::string& shape) {
  if (shape == "tri3") return triangle_rule(2);
  if (shape == "tri6") return triangle_rule(4);
  if (shape == "tri7") return collapsed_triangle_rule();
  if (shape == "quad4") return quadrilateral_rule(2);
  if (shape == "quad8" || shape == "quad9") return quadrilateral_rule(3);
  throw InputError("load", format("a face of shape '{}' cannot bear a load", shape),
                   "Faces are tri3, tri6, tri7, quad4, quad8 or quad9");
}

}  // namespace polhode::solids
