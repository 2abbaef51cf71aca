// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/beams/section.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>

namespace polhode {

namespace {

constexpr double kPi = std::numbers::pi;

void check_positive(const char* what, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InputError("section", format("{} is {:g}, not above zero", what, value),
                     "Give a positive size");
}

void check_poisson(double nu) {
  if (!(nu > -1.0 && nu <= 0.5))
    throw InputError("section", format("Poisson's ratio is {:g}", nu),
                     "Give a value above -1, up to 0.5");
}

}  // namespace

SectionShape rectangle_section(double y, double z, double nu) {
  check_positive("a side of the rectangle", std::min(y, z));
  check_poisson(nu);
  SectionShape s;
  s.area = y * z;
  s.I_y = y * z * z * z / 12.0;
  s.I_z = z * y * y * y / 12.0;
  const double a = std::max(y, z), b = std::min(y, z);
  double sum = 0.0;
  for (int n = 1; n < 200; n += 2) sum += std::tanh(0.5 * n * kPi * a / b) / std::pow(n, 5);
  s.J = a * b * b * b / 3.0 * (1.0 - 192.0 / std::pow(kPi, 5) * b / a * sum);
  s.shear_y = s.shear_z = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
  return s;
}

SectionShape circle_section(double diameter, double nu) {
  check_positive("the diameter", diameter);
  check_poisson(nu);
  SectionShape s;
  s.area = 0.25 * kPi * diameter * diameter;
  s.I_y = s.I_z = kPi / 64.0 * std::pow(diameter, 4);
  s.J = s.I_y + s.I_z;
  s.shear_y = s.shear_z = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu);
  return s;
}

SectionShape tube_section(double outer, double inner, double nu) {
  check_positive("the outer diameter", outer);
  check_positive("the inner diameter", inner);
  check_poisson(nu);
  if (!(inner < outer))
    throw InputError("section",
                     format("the inner diameter {:g} is not below the outer, {:g}", inner, outer),
                     "Exchange them, or use a circle");
  SectionShape s;
  s.area = 0.25 * kPi * (outer * outer - inner * inner);
  s.I_y = s.I_z = kPi / 64.0 * (std::pow(outer, 4) - std::pow(inner, 4));
  s.J = s.I_y + s.I_z;
  const double m2 = (inner / outer) * (inner / outer), q = (1.0 + m2) * (1.0 + m2);
  s.shear_y = s.shear_z = 6.0 * (1.0 + nu) * q / ((7.0 + 6.0 * nu) * q + (20.0 + 12.0 * nu) * m2);
  return s;
}

SectionShape i_section(const ISectionSizes& sizes, double nu) {
  const auto& [height, width, web, flange] = sizes;
  check_positive("the height", height);
  check_positive("the width", width);
  check_positive("the thickness of the web", web);
  check_positive("the thickness of the flanges", flange);
  check_poisson(nu);
  if (!(2.0 * flange < height) || !(web < width))
    throw InputError("section", "the flanges or the web of the I section are too thick",
                     "Give flanges thinner than half the height, and a web thinner than the width");
  SectionShape s;
  const double clear = height - 2.0 * flange;
  s.area = 2.0 * width * flange + clear * web;
  s.I_z = (width * std::pow(height, 3) - (width - web) * std::pow(clear, 3)) / 12.0;
  s.I_y = (2.0 * flange * std::pow(width, 3) + clear * std::pow(web, 3)) / 12.0;
  s.J = (2.0 * width * std::pow(flange, 3) + clear * std::pow(web, 3)) / 3.0;
  const double h = height - flange;  // between the middles of the flanges
  const double m = 2.0 * width * flange / (h * web), n2 = (width / h) * (width / h);
  const double m2 = m * m, m3 = m2 * m;
  s.shear_y =
      10.0 * (1.0 + nu) * (1.0 + 3.0 * m) * (1.0 + 3.0 * m) /
      (12.0 + 72.0 * m + 150.0 * m2 + 90.0 * m3 + nu * (11.0 + 66.0 * m + 135.0 * m2 + 90.0 * m3) +
       30.0 * n2 * (m + m2) + 5.0 * nu * n2 * (8.0 * m + 9.0 * m2));
  const double rectangle = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu);
  s.shear_z = rectangle * 2.0 * width * flange / s.area;
  return s;
}

BeamSection elastic_section(const SectionShape& shape, double E, double nu, double density) {
  check_positive("Young's modulus", E);
  check_poisson(nu);
  if (!(density >= 0.0))
    throw InputError("section", format("the density is {:g}", density),
                     "Give a density that is not negative");
  const double G = 0.5 * E / (1.0 + nu);
  BeamSection s;
  s.stiffness.diagonal() << E * shape.area, shape.shear_y * G * shape.area,
      shape.shear_z * G * shape.area, G * shape.J, E * shape.I_y, E * shape.I_z;
  s.mass_per_length = density * shape.area;
  s.inertia_per_length = density * Vec3(shape.I_y + shape.I_z, shape.I_y, shape.I_z);
  return s;
}

}  // namespace polhode
