// SPDX-License-Identifier: Apache-2.0
// Materials of FEBio's files: energies of FEBio's user manual, written with F itself.
#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include <polhode/compile/solid_parts.hpp>
#include <polhode/solids/materials/registry.hpp>

#include <io/importers/feb_fixture.hpp>
#include <solids/materials/homogeneous.hpp>

namespace polhode::feb_tests {
namespace {

using testing::HasSubstr;

class FebMaterials : public FebFixture {
 protected:
  static std::string cube(const std::string& type, const std::string& inside) {
    return feb(control("DYNAMIC", 1, 1.0) +
               tag("Material", tag("material", inside, "id='1' name='m' type='" + type + "'")) +
               tag("Mesh", block(1, "part", Vec3::Zero(), Vec3::Ones())) +
               tag("MeshDomains", domain("part", "m")));
  }
  /// Compares stresses with the derivative of an energy at some deformations.
  void expect_energy(const std::string& type, const std::string& inside,
                     const std::function<double(const Mat3&)>& W) {
    const Model model = read(cube(type, inside));
    ASSERT_EQ(model.materials.size(), 1u);
    const MaterialSpec& spec = model.materials[0];
    const auto material = solids::make_material("m", material_description(spec));
    std::vector<Vec3> A;
    for (const FibreSpec& fibre : spec.fibres) A.push_back(fibre.direction);
    for (const double size : {0.02, 0.1, 0.35}) {
      Mat3 F;
      F << 1.0 + size, 0.3 * size, -0.2 * size, 0.5 * size, 1.0 - 0.4 * size, 0.6 * size,
          -0.1 * size, 0.25 * size, 1.0 + 0.2 * size;
      const Vec6 E = test::green_strain_of(F);
      EXPECT_NEAR(solids::strain_energy(*material, E, A) / W(F), 1.0, 1e-9) << type << ' ' << size;
      const Mat3 P = F * test::tensor_of(solids::discrete_stress(*material, E, E, A).S);
      Mat3 numeric;
      const double h = 1e-5;
      for (int k = 0; k < 9; ++k) {
        Mat3 up = F, down = F;
        up.data()[k] += h;
        down.data()[k] -= h;
        numeric.data()[k] = (W(up) - W(down)) / (2.0 * h);
      }
      EXPECT_LT((P - numeric).norm(), 2e-7 * P.norm()) << type << ' ' << size;
    }
  }
};

double first(const Mat3& F) { return (F.transpose() * F).trace(); }
Vec3 stretches(const Mat3& F) { return F.jacobiSvd().singularValues(); }
double square_stretch(const Mat3& F, const Vec3& a) { return (F * a).squaredNorm(); }
Mat3 isochoric(const Mat3& F) { return std::cbrt(1.0 / F.determinant()) * F; }
double volume(const Mat3& F, double k) {
  const double g = std::log(F.determinant());
  return 0.5 * k * g * g;
}
double neo_hookean(const Mat3& F) {
  const double mu = 1e4 / 2.8, lame = 1e4 * 0.4 / (1.4 * 0.2), g = std::log(F.determinant());
  return mu / 2.0 * (first(F) - 3.0) - mu * g + lame / 2.0 * g * g;
}
constexpr const char* kNeoHookean = "<solid type='neo-Hookean'><E>1e4</E><v>0.4</v></solid>";

TEST_F(FebMaterials, OgdenHasItsEnergies) {
  const double c[] = {2e4, -300.0}, m[] = {2.4, -1.5};
  const auto terms = [&](const Vec3& l, double log_J) {
    double W = 0.0;
    for (int k = 0; k < 2; ++k)
      W += c[k] / (m[k] * m[k]) * (l.array().pow(m[k]).sum() - 3.0 - m[k] * log_J);
    return W;
  };
  // A term without a factor stands between the others.
  const std::string inside =
      "<c1>2e4</c1><m1>2.4</m1><c2>0</c2><m2>3</m2><c4>-300</c4><m4>-1.5</m4>";
  expect_energy("Ogden", inside + "<k>1e6</k>", [&](const Mat3& F) {
    return terms(stretches(isochoric(F)), 0.0) + volume(F, 1e6);
  });
  expect_energy("Ogden unconstrained", inside + "<cp>3e4</cp>", [&](const Mat3& F) {
    const double J = F.determinant();
    return terms(stretches(F), std::log(J)) + 1.5e4 * (J - 1.0) * (J - 1.0);
  });
}

TEST_F(FebMaterials, VerondaWestmannHasItsEnergy) {
  expect_energy("Veronda-Westmann", "<c1>2e3</c1><c2>1.7</c2><k>1e6</k>", [](const Mat3& F) {
    const Mat3 C = isochoric(F).transpose() * isochoric(F);
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
    return 2e3 * (std::expm1(1.7 * (I1 - 3.0)) - 0.5 * 1.7 * (I2 - 3.0)) + volume(F, 1e6);
  });
}

TEST_F(FebMaterials, HolzapfelGasserOgdenHasItsEnergy) {
  const double gamma = 40.0 * std::acos(-1.0) / 180.0;
  // Axes e1 = z and e2 = x.
  const Vec3 sides[] = {Vec3(std::sin(gamma), 0.0, std::cos(gamma)),
                        Vec3(-std::sin(gamma), 0.0, std::cos(gamma))};
  expect_energy("Holzapfel-Gasser-Ogden",
                "<c>7e3</c><k1>9e3</k1><k2>0.7</k2><kappa>0.12</kappa><gamma>40</gamma><k>1e6</k>"
                "<mat_axis type='vector'><a>0,0,2</a><d>1,0,0.3</d></mat_axis>",
                [&](const Mat3& F) {
                  const double J = F.determinant(), I1 = first(isochoric(F));
                  double W = 3.5e3 * (I1 - 3.0) + 0.5e6 * ((J * J - 1.0) / 2.0 - std::log(J));
                  for (const Vec3& a : sides) {
                    const double e =
                        0.12 * (I1 - 3.0) + (1.0 - 0.36) * (square_stretch(isochoric(F), a) - 1.0);
                    if (e > 0.0) W += 9e3 / 1.4 * std::expm1(0.7 * e * e);
                  }
                  return W;
                });
}

TEST_F(FebMaterials, MixturesAddTheEnergiesOfTheirFibres) {
  const double third = 1.0 / 3.0, s = std::sin(std::acos(-1.0) / 6.0);
  const double c = std::cos(std::acos(-1.0) / 6.0);
  const auto power = [](double I, double xi, double alpha, double beta) {
    const double y = std::max(I - 1.0, 0.0);
    return xi / (alpha * beta) * std::expm1(alpha * std::pow(y, beta));
  };
  const auto toe = [](double I) {
    const double E = 8e4, l = 1.04, beta = 2.6, y_0 = l * l - 1.0, y = I - 1.0;
    const double xi = E / 4.0 / (beta - 1.0) * std::pow(l, -3.0) * std::pow(y_0, 2.0 - beta);
    const double b = xi * std::pow(y_0, beta - 1.0) + E / 2.0 / l;
    if (y < 0.0) return 0.0;
    if (y < y_0) return xi / beta * std::pow(y, beta);
    return b * (y - y_0) - E * (std::sqrt(I) - l) + xi / beta * std::pow(y_0, beta);
  };
  const Vec3 tilted(2.0 * third, 2.0 * third, third), turned(0.0, s, c);
  const std::string fibres =
      "<solid type='fiber-exp-pow{0}'><ksi>5e3</ksi><alpha>1.5</alpha><beta>2.5</beta>"
      "<fiber type='vector'>2,2,1</fiber></solid>"
      "<solid type='fiber-pow-linear{0}'><E>8e4</E><beta>2.6</beta><lam0>1.04</lam0>"
      "<fiber type='angles'><theta>90</theta><phi>30</phi></fiber></solid>";
  const auto with = [&](std::string text, const std::string& end) {
    for (std::size_t at; (at = text.find("{0}")) != std::string::npos;) text.replace(at, 3, end);
    return text;
  };
  expect_energy("solid mixture", kNeoHookean + with(fibres, ""), [&](const Mat3& F) {
    return neo_hookean(F) + power(square_stretch(F, tilted), 5e3, 1.5, 2.5) +
           toe(square_stretch(F, turned));
  });
  expect_energy("uncoupled solid mixture",
                "<k>2e6</k><solid type='Mooney-Rivlin'><c1>2e3</c1><c2>0</c2></solid>" +
                    with(fibres, "-uncoupled"),
                [&](const Mat3& F) {
                  const Mat3 G = isochoric(F);
                  return 2e3 * (first(G) - 3.0) + volume(F, 2e6) +
                         power(square_stretch(G, tilted), 5e3, 1.5, 2.5) +
                         toe(square_stretch(G, turned));
                });
}

// Tension over the stretch l of fibres that straighten: l W' = c3 (exp(c4 (l - 1)) - 1), then a
// line.
TEST_F(FebMaterials, FibresThatStraightenHaveTheIntegralOfTheirTension) {
  const double c3 = 2e3, c4 = 12.0, c5 = 3e4, last = 1.06;
  const auto rate = [&](double l) {
    const double toe = c3 * std::expm1(c4 * (std::min(l, last) - 1.0));
    return (l < last ? toe : toe + c5 * (l - last)) / l;
  };
  const auto integral = [&](double from, double to) {  // Simpson's rule
    const int n = 200;
    const double h = (to - from) / n;
    double sum = rate(from) + rate(to);
    for (int k = 1; k < n; ++k) sum += (k % 2 == 1 ? 4.0 : 2.0) * rate(from + k * h);
    return sum * h / 3.0;
  };
  const auto energy = [&](double I) {
    const double l = std::sqrt(I);
    if (l <= 1.0) return 0.0;
    return integral(1.0, std::min(l, last)) + (l > last ? integral(last, l) : 0.0);
  };
  expect_energy("solid mixture",
                std::string(kNeoHookean) +
                    "<solid type='fiber-exp-linear'><c3>2e3</c3><c4>12</c4><c5>3e4</c5>"
                    "<lambda>1.06</lambda><fiber type='vector'>2,2,1</fiber></solid>",
                [&](const Mat3& F) {
                  return neo_hookean(F) + energy(square_stretch(F, Vec3(2, 2, 1) / 3.0));
                });
}

// Energies of parts of one family add up to a material of the model.
TEST_F(FebMaterials, PartsOfOneFamilyAreOneMaterial) {
  const std::string soft = "<solid type='neo-Hookean'><E>3e3</E><v>0.1</v></solid>";
  const auto softer = [](const Mat3& F) {
    const double mu = 3e3 / 2.2, lame = 3e3 * 0.1 / (1.1 * 0.8), g = std::log(F.determinant());
    return mu / 2.0 * (first(F) - 3.0) - mu * g + lame / 2.0 * g * g;
  };
  const auto second = [](const Mat3& F) {
    const Mat3 C = F.transpose() * F;
    return 0.5 * (C.trace() * C.trace() - (C * C).trace());
  };
  expect_energy("solid mixture", kNeoHookean + soft,
                [&](const Mat3& F) { return neo_hookean(F) + softer(F); });
  expect_energy("solid mixture",
                kNeoHookean + std::string("<solid type='coupled Mooney-Rivlin'><c1>500</c1><c2>300"
                                          "</c2><k>4e3</k></solid>"),
                [&](const Mat3& F) {
                  const double g = std::log(F.determinant());
                  return neo_hookean(F) + 500 * (first(F) - 3.0) + 300 * (second(F) - 3.0) -
                         2.0 * (500 + 600) * g + 2e3 * g * g;
                });
  const std::string mooney = "<solid type='Mooney-Rivlin'><c1>2e3</c1><c2>400</c2></solid>";
  expect_energy("uncoupled solid mixture", "<k>2e6</k>" + mooney + mooney, [&](const Mat3& F) {
    const Mat3 G = isochoric(F);
    return 4e3 * (first(G) - 3.0) + 800 * (second(G) - 3.0) + volume(F, 2e6);
  });
  const std::string ogden = "<solid type='Ogden'><c1>2e4</c1><m1>2.4</m1></solid>";
  expect_energy("uncoupled solid mixture", "<k>2e6</k>" + mooney + ogden, [&](const Mat3& F) {
    const Mat3 G = isochoric(F);
    return 2e3 * (first(G) - 3.0) + 400 * (second(G) - 3.0) + volume(F, 2e6) +
           2e4 / (2.4 * 2.4) * (stretches(G).array().pow(2.4).sum() - 3.0);
  });
  const auto term = [](const Mat3& F, double c, double m) {
    return c / (m * m) * (stretches(F).array().pow(m).sum() - 3.0 - m * std::log(F.determinant()));
  };
  expect_energy("solid mixture",
                "<solid type='Ogden unconstrained'><cp>5e3</cp><c1>2e4</c1><m1>2.4</m1></solid>"
                "<solid type='Ogden unconstrained'><cp>4e3</cp><c1>900</c1><m1>-3</m1></solid>",
                [&](const Mat3& F) {
                  const double J = F.determinant() - 1.0;
                  return term(F, 2e4, 2.4) + term(F, 900, -3) + 4.5e3 * J * J;
                });
}

TEST_F(FebMaterials, MixturesHaveTheDensityAndTheBulkModulusOfTheirParts) {
  const Model coupled = read(
      cube("solid mixture",
           "<density>7</density><solid type='neo-Hookean'><density>900</density><E>1</E><v>0.3</v>"
           "</solid><solid type='fiber-exp-pow'><density>50</density><ksi>1</ksi><alpha>0</alpha>"
           "<beta>3</beta></solid>"));
  EXPECT_EQ(coupled.materials[0].density, 950.0);
  EXPECT_EQ(coupled.materials[0].fibres[0].direction, Vec3::UnitX());
  const Model parts =
      read(cube("uncoupled solid mixture",
                "<density>900</density><solid type='Mooney-Rivlin'><c1>1</c1><k>60</k></solid>"
                "<solid type='fiber-exp-pow-uncoupled'><ksi>1</ksi><alpha>0</alpha><beta>2</beta>"
                "<k>40</k></solid>"));
  EXPECT_EQ(parts.materials[0].density, 900.0);
  EXPECT_EQ(parts.materials[0].parameters.at("bulk_modulus"), 100.0);
  EXPECT_EQ(parts.solids[0].element, "hex8_q1p0");  // three-field elements, as FEBio has
  EXPECT_EQ(coupled.solids[0].element, "hex8_standard");
}

TEST_F(FebMaterials, WhatCannotBeReadIsNamed) {
  const auto said = [&](const std::string& type, const std::string& inside) {
    return fault(cube(type, inside));
  };
  const std::string fibre =
      "<solid type='fiber-exp-pow'><ksi>1</ksi><alpha>0</alpha><beta>2</beta></solid>";
  EXPECT_THAT(said("solid mixture", fibre), HasSubstr("a mixture of fibres alone is not read"));
  EXPECT_THAT(said("solid mixture", kNeoHookean + std::string("<solid type='isotropic elastic'><E>1"
                                                              "</E><v>0.3</v></solid>")),
              HasSubstr("two materials that are not fibres, and not of one family"));
  std::string terms;
  for (int k = 1; k <= 6; ++k) terms += format("<c{0}>1</c{0}><m{0}>{0}</m{0}>", k);
  EXPECT_THAT(said("uncoupled solid mixture", "<k>9</k><solid type='Ogden'>" + terms +
                                                  "</solid><solid type='Mooney-Rivlin'><c1>1</c1>"
                                                  "</solid>"),
              HasSubstr("two materials that are not fibres, and not of one family"));
  EXPECT_THAT(
      said("solid mixture", "<solid type='Mooney-Rivlin'><c1>1</c1><k>9</k></solid>" + fibre),
      HasSubstr("coupled and with uncoupled response"));
  EXPECT_THAT(said("solid mixture", kNeoHookean + std::string("<solid type='fiber-NH'/>")),
              HasSubstr("fibres of type 'fiber-nh' are not read"));
  EXPECT_THAT(said("Ogden", "<k>1</k>"), HasSubstr("has no stiffness"));
  EXPECT_THAT(said("Ogden", "<c1>1</c1><m1>2</m1><k>1</k><pressure_model>2</pressure_model>"),
              HasSubstr("only <pressure_model> 0 is read"));
  EXPECT_THAT(said("uncoupled solid mixture",
                   "<solid type='Holzapfel-Gasser-Ogden'><c>1</c><k>9</k></solid>"),
              HasSubstr("in an uncoupled mixture is not read"));
  EXPECT_THAT(said("Holzapfel-Gasser-Ogden",
                   "<c>1</c><k1>1</k1><k2>1</k2><k>9</k><mat_axis type='local'>1,2,4</mat_axis>"),
              HasSubstr("<mat_axis> of type 'local' is not read"));
  EXPECT_THAT(
      said("solid mixture",
           kNeoHookean + std::string("<solid type='fiber-exp-pow'><ksi>1</ksi><alpha>0</alpha>"
                                     "<beta>2</beta><lam0>1.1</lam0></solid>")),
      HasSubstr("<lam0> of fiber-exp-pow is not read"));
}

}  // namespace
}  // namespace polhode::feb_tests
