// SPDX-License-Identifier: Apache-2.0
// Deformable solids in files of FEBio: a unit cube that is stretched evenly has closed forms.
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <sstream>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/core/types.hpp>

#include "command_line.hpp"

namespace polhode::feb_solids_tests {
namespace {

using testing::HasSubstr;

struct Cells {
  std::vector<Vec3> nodes;
  std::vector<std::vector<int>> cells;

  /// The node between some others.
  int middle(const std::vector<int>& of) {
    Vec3 x = Vec3::Zero();
    for (const int n : of) x += nodes[static_cast<std::size_t>(n)] / static_cast<double>(of.size());
    for (std::size_t k = 0; k < nodes.size(); ++k)
      if ((nodes[k] - x).norm() < 1e-9) return static_cast<int>(k);
    nodes.push_back(x);
    return static_cast<int>(nodes.size()) - 1;
  }
};

/// The unit cube in cells of a type, in FEBio's order of nodes.
Cells cube(const std::string& type) {
  Cells c;
  c.nodes = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
             {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  if (type.starts_with("tet"))
    c.cells = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  else if (type.starts_with("penta"))
    c.cells = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
  else
    c.cells = {{0, 1, 2, 3, 4, 5, 6, 7}};
  std::vector<std::array<int, 2>> edges;
  if (type == "tet10" || type == "tet15") edges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  if (type == "penta15")
    edges = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
  if (type == "hex20" || type == "hex27")
    edges = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
             {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  for (std::vector<int>& cell : c.cells)
    for (const auto& e : edges)
      cell.push_back(
          c.middle({cell[static_cast<std::size_t>(e[0])], cell[static_cast<std::size_t>(e[1])]}));
  if (type == "tet15")
    for (std::vector<int>& cell : c.cells) {
      for (const std::array<int, 3>& f : {std::array{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}})
        cell.push_back(
            c.middle({cell[static_cast<std::size_t>(f[0])], cell[static_cast<std::size_t>(f[1])],
                      cell[static_cast<std::size_t>(f[2])]}));
      cell.push_back(c.middle({cell[0], cell[1], cell[2], cell[3]}));
    }
  if (type == "hex27")
    for (const Vec3& x :
         {Vec3(0.5, 0, 0.5), Vec3(1, 0.5, 0.5), Vec3(0.5, 1, 0.5), Vec3(0, 0.5, 0.5),
          Vec3(0.5, 0.5, 0), Vec3(0.5, 0.5, 1), Vec3(0.5, 0.5, 0.5)}) {
      c.cells[0].push_back(static_cast<int>(c.nodes.size()));
      c.nodes.push_back(x);
    }
  return c;
}

std::string list(const std::vector<int>& nodes) {
  std::string text;
  for (const int n : nodes) text += format("{}{}", text.empty() ? "" : ",", n + 1);
  return text;
}

/// Nodes of a cube in a plane.
std::vector<int> plane(const Cells& c, int axis, double at) {
  std::vector<int> nodes;
  for (std::size_t k = 0; k < c.nodes.size(); ++k)
    if (std::abs(c.nodes[k][axis] - at) < 1e-9) nodes.push_back(static_cast<int>(k));
  return nodes;
}

constexpr const char* kSymmetry =
    "<bc type='zero displacement' node_set='x0'><x_dof>1</x_dof></bc>"
    "<bc type='zero displacement' node_set='y0'><y_dof>1</y_dof></bc>"
    "<bc type='zero displacement' node_set='z0'><z_dof>1</z_dof></bc>";
constexpr const char* kStretch =
    "<bc name='pull' type='prescribed displacement' node_set='x1'><dof>x</dof><value "
    "lc='1'>0.3</value></bc>";

/// A file with a cube of a material, held by its planes of symmetry.
std::string file(const std::string& type, const std::string& material, const std::string& boundary,
                 const std::string& loads = "", int steps = 10) {
  const Cells c = cube(type);
  std::string text = format(
      "<febio_spec version='4.0'><Module type='solid'/><Control><analysis>STATIC</analysis>"
      "<time_steps>{}</time_steps><step_size>{}</step_size></Control>\n<Material>{}</"
      "Material>\n<Mesh><Nodes>",
      steps, 1.0 / steps, material);
  for (std::size_t k = 0; k < c.nodes.size(); ++k)
    text += format("<node id='{}'>{},{},{}</node>\n", k + 1, c.nodes[k].x(), c.nodes[k].y(),
                   c.nodes[k].z());
  text += "</Nodes><Elements type='" + type + "' name='cube'>";
  for (std::size_t e = 0; e < c.cells.size(); ++e)
    text += format("<elem id='{}'>{}</elem>\n", e + 1, list(c.cells[e]));
  text += "</Elements>";
  for (int axis = 0; axis < 3; ++axis)
    for (int at = 0; at < 2; ++at)
      text +=
          format("<NodeSet name='{}{}'>{}</NodeSet>\n", "xyz"[axis], at, list(plane(c, axis, at)));
  text +=
      "<Surface name='end'><quad4 id='1'>2,3,7,6</quad4></Surface>"
      "<Surface name='inward'><quad4 id='1'>6,7,3,2</quad4></Surface></Mesh>"
      "<MeshDomains><SolidDomain name='cube' mat='m'/></MeshDomains><Boundary>" +
      boundary + "</Boundary><Loads>" + loads +
      "</Loads><LoadData><load_controller id='1' type='loadcurve'><points><pt>0,0</pt><pt>1,1</pt>"
      "</points></load_controller></LoadData></febio_spec>\n";
  return text;
}

std::string material(const std::string& type, const std::string& inside) {
  return "<material id='1' name='m' type='" + type + "'><density>1000</density>" + inside +
         "</material>";
}
const std::string kElastic = material("isotropic elastic", "<E>1e6</E><v>0.3</v>");

/// Root of a function between two ends.
double root(const std::function<double(double)>& f, double a, double b) {
  for (int k = 0; k < 200; ++k) {
    const double m = 0.5 * (a + b);
    ((f(m) > 0) == (f(a) > 0) ? a : b) = m;
  }
  return 0.5 * (a + b);
}

class FebSolidsCli : public test::CommandLine {
 protected:
  /// The last row of a probe after a run, without its time.
  std::vector<double> last(const std::string& text, const std::string& probe) {
    write("cube.feb", text);
    write("cube.overlay.yaml", "format: 1\noutput: {probes: {p: " + probe + "}}\n");
    const auto done = run({"run", "cube.feb", "--quiet", "-o", "r"});
    EXPECT_EQ(done.code, 0) << done.err;
    std::istringstream rows(read("r/probes/p.csv"));
    std::string row, end;
    while (std::getline(rows, row)) end = row;
    std::vector<double> values;
    std::istringstream cells(end);
    while (std::getline(cells, row, ',')) values.push_back(std::stod(row));
    if (!values.empty()) values.erase(values.begin());
    return values;
  }
  /// Force on the pulled face of a cube that is stretched to 1.3 of its length.
  double pull(const std::string& type, const std::string& m, int steps = 10) {
    return last(file(type, m, std::string(kSymmetry) + kStretch, "", steps),
                "{solid: cube, interface: pull}")
        .at(0);
  }
  /// Displacement of the corner (1, 1, 1) under a load.
  Vec3 corner(const std::string& loads, const std::string& m = kElastic) {
    const auto row = last(file("hex8", m, kSymmetry, loads), "{solid: cube, point: [1, 1, 1]}");
    return {row.at(3), row.at(4), row.at(5)};
  }
};

// St. Venant-Kirchhoff: the force is E (l^2 - 1)/2 l of any mesh.
TEST_F(FebSolidsCli, EveryElementStretchesEvenly) {
  const double l = 1.3, force = 1e6 * (l * l - 1) / 2 * l;
  for (const std::string type :
       {"hex8", "hex20", "hex27", "tet4", "tet10", "tet15", "penta6", "penta15"})
    EXPECT_NEAR(pull(type, kElastic) / force, 1.0, 1e-9) << type;
}

// Lateral stretches a follow from zero lateral stress, forces from the derivative of the energy
// W(l, a) by the stretch l; at few and at many load steps.
TEST_F(FebSolidsCli, MaterialsHaveTheirEnergies) {
  using Energy = std::function<double(double, double)>;
  const double l = 1.3, h = 1e-5;
  const auto check = [&](const std::string& m, const Energy& W) {
    const auto by_a = [&](double a) { return W(l, a + h) - W(l, a - h); };
    const double a = root(by_a, 0.6, 1.2);
    const double force = (W(l + h, a) - W(l - h, a)) / (2 * h);
    for (const int steps : {2, 100}) EXPECT_NEAR(pull("hex8", m, steps) / force, 1.0, 1e-7) << m;
  };
  const auto I1 = [](double x, double a) { return x * x + 2 * a * a; };
  const auto I2 = [](double x, double a) { return 2 * x * x * a * a + a * a * a * a; };
  const auto J = [](double x, double a) { return x * a * a; };
  const double mu = 1e6 / 2.6, lame = 1e6 * 0.3 / (1.3 * 0.4);
  check(material("neo-Hookean", "<E>1e6</E><v>0.3</v>"), [&](double x, double a) {
    const double g = std::log(J(x, a));
    return mu / 2 * (I1(x, a) - 3) - mu * g + lame / 2 * g * g;
  });
  check(material("St.Venant-Kirchhoff", "<E>1e6</E><v>0.3</v>"), [&](double x, double a) {
    const double e = (x * x - 1) / 2, f = (a * a - 1) / 2;
    return lame / 2 * (e + 2 * f) * (e + 2 * f) + mu * (e * e + 2 * f * f);
  });
  check(material("coupled Mooney-Rivlin", "<c1>2e5</c1><c2>1e5</c2><k>8e5</k>"),
        [&](double x, double a) {
          const double g = std::log(J(x, a));
          return 2e5 * (I1(x, a) - 3) + 1e5 * (I2(x, a) - 3) - 2 * (2e5 + 2e5) * g + 4e5 * g * g;
        });
  const auto uncoupled = [&](double x, double a) {
    const double j = J(x, a), g = std::log(j);
    return 2e5 * (std::pow(j, -2.0 / 3) * I1(x, a) - 3) +
           1e5 * (std::pow(j, -4.0 / 3) * I2(x, a) - 3) + 5e6 * g * g;
  };
  check(material("Mooney-Rivlin", "<c1>2e5</c1><c2>1e5</c2><k>1e7</k>"), uncoupled);
  // Fibres along the pull: l dF/dl = c3 (exp(c4 (l - 1)) - 1) up to 1.2, then c5 l + c6.
  check(material("trans iso Mooney-Rivlin",
                 "<c1>2e5</c1><c2>1e5</c2><k>1e7</k><c3>1e4</c3><c4>10</c4><c5>4e5</"
                 "c5><lam_max>1.2</lam_max>"
                 "<fiber type='vector'><vector>2,0,0</vector></fiber>"),
        [&](double x, double a) {
          const double y = x * std::pow(J(x, a), -1.0 / 3);
          const auto slope = [](double s) {
            const double c6 = 1e4 * std::expm1(10 * 0.2) - 4e5 * 1.2;
            return (s < 1.2 ? 1e4 * std::expm1(10 * (s - 1)) : 4e5 * s + c6) / s;
          };
          double fibre = 0;
          for (const auto& [from, to] : {std::pair{1.0, std::min(y, 1.2)}, {1.2, std::max(y, 1.2)}})
            for (int k = 0; k < 2000; ++k)
              fibre += (to - from) / 2000 * slope(from + (k + 0.5) * (to - from) / 2000);
          return uncoupled(x, a) + fibre;
        });
}

// l (E (l^2 - 1)/2) a is the dead force; a pressure that follows acts on the area a^2, with
// a^2 = 1 - v (l^2 - 1).
TEST_F(FebSolidsCli, LoadsOnFacesAndNodes) {
  const double p = 2e5, v = 0.3, E = 1e6;
  const auto force = [&](double l) { return E * (l * l - 1) / 2 * l; };
  const auto area = [&](double l) { return 1 - v * (l * l - 1); };
  const double dead = root([&](double l) { return force(l) - p; }, 1, 2);
  const double following = root([&](double l) { return force(l) - p * area(l); }, 1, 2);
  const auto pressure = [](const std::string& surface, const std::string& value,
                           const std::string& more) {
    return "<surface_load type='pressure' surface='" + surface + "'><pressure lc='1'>" + value +
           "</pressure>" + more + "<symmetric_stiffness>1</symmetric_stiffness></surface_load>";
  };
  EXPECT_NEAR(corner(pressure("end", "-2e5", "<linear>1</linear>")).x(), dead - 1, 1e-9);
  EXPECT_NEAR(corner(pressure("end", "-2e5", "")).x(), following - 1, 1e-9);
  EXPECT_NEAR(corner(pressure("inward", "2e5", "")).x(), following - 1, 1e-9);
  const Vec3 end = corner(
      "<surface_load type='traction' surface='end'><scale "
      "lc='1'>2</scale><traction>1e5,0,0</traction>"
      "<linear>1</linear></surface_load>");
  EXPECT_NEAR(end.x(), dead - 1, 1e-9);
  EXPECT_NEAR(end.y(), std::sqrt(area(dead)) - 1, 1e-9);
  EXPECT_NEAR(corner("<nodal_load type='nodal_load' node_set='x1'><dof>x</dof><scale "
                     "lc='1'>5e4</scale></nodal_load>")
                  .x(),
              dead - 1, 1e-9);
  EXPECT_NEAR(corner("<nodal_load type='nodal_force' node_set='@surface:end'><value "
                     "lc='1'>5e4,0,0</value></nodal_load>")
                  .x(),
              dead - 1, 1e-9);
}

// Statics of two steps: what acts in the first alone leaves nothing at the end.
TEST_F(FebSolidsCli, LoadsOfOneStepEndWithIt) {
  const std::string control =
      "<Control><analysis>STATIC</analysis><time_steps>5</time_steps><step_size>0.2</step_size>"
      "</Control>";
  const std::string load =
      "<Loads><nodal_load type='nodal_load' node_set='x1'><dof>x</dof><scale>5e4</scale>"
      "</nodal_load></Loads>";
  const auto end = [&](const std::string& first, const std::string& second) {
    std::string text = file("hex8", kElastic, kSymmetry);
    const std::size_t from = text.find("<Control>"), to = text.find("</Control>") + 10;
    text.erase(from, to - from);
    text.insert(text.find("<LoadData>"), "<Step><step>" + control + first + "</step><step>" +
                                             control + second + "</step></Step>");
    return last(text, "{solid: cube, point: [1, 1, 1]}").at(3);
  };
  const double l = root([](double x) { return 1e6 * (x * x - 1) / 2 * x - 2e5; }, 1, 2);
  EXPECT_NEAR(end(load, ""), 0.0, 1e-9);
  EXPECT_NEAR(end("", load), l - 1, 1e-9);
  EXPECT_NEAR(end(load, load), l - 1, 1e-9);
  ASSERT_EQ(run({"convert", "cube.feb", "cube.yaml"}).code, 0);
  const auto direct = run({"run", "cube.feb", "--json", "--quiet", "-o", "a"});
  const auto converted = run({"run", "cube.yaml", "--json", "--quiet", "-o", "b"});
  EXPECT_EQ(value(direct.out, "result_hash"), value(converted.out, "result_hash"));
  EXPECT_NE(value(direct.out, "result_hash"), "missing");
}

/// Steps of statics of a second each, with the conditions of each on displacements, and curves.
std::string in_steps(std::string text, const std::vector<std::string>& boundaries) {
  const std::size_t from = text.find("<Control>"), to = text.find("</Control>") + 10;
  text.erase(from, to - from);
  std::string steps = "<Step>";
  for (const std::string& boundary : boundaries)
    steps +=
        "<step><Control><analysis>STATIC</analysis><time_steps>5</time_steps><step_size>0.2"
        "</step_size></Control><Boundary>" +
        boundary + "</Boundary></step>";
  text.insert(text.find("<LoadData>"), steps + "</Step>");
  text.insert(text.find("</LoadData>"),
              "<load_controller id='2' type='loadcurve'><points><pt>2,0</pt><pt>3,-1</pt></points>"
              "</load_controller>");
  return text;
}

// Stretched, held, and let back by half of it, relative to where it was held.
TEST_F(FebSolidsCli, DisplacementsAreThoseOfTheStep) {
  const auto pull = [](const char* value, const char* relative) {
    return format(
        "<bc name='pull' type='prescribed displacement' node_set='x1'><dof>x</dof>{}<relative>{}"
        "</relative></bc>",
        value, relative);
  };
  const std::string stretch = pull("<value lc='1'>0.3</value>", "0");
  const std::string hold =
      "<bc name='hold' type='zero displacement' node_set='x1'><x_dof>1</x_dof></bc>";
  const auto force = [](double u) { return 1e6 * (std::pow(1 + u, 2) - 1) / 2 * (1 + u); };
  const auto end = [&](const std::vector<std::string>& boundaries, const char* interface) {
    return last(in_steps(file("hex8", kElastic, kSymmetry), boundaries),
                std::string("{solid: cube, interface: ") + interface + "}")
        .at(0);
  };
  EXPECT_NEAR(end({stretch, hold}, "pull"), force(0.3), 1e-3);
  EXPECT_NEAR(end({stretch, stretch}, "pull"), force(0.3), 1e-3);
  EXPECT_NEAR(end({hold, pull("<value lc='1'>0.3</value>", "0")}, "pull"), force(0.3), 1e-3);
  EXPECT_NEAR(end({stretch, hold, pull("<value lc='2'>0.15</value>", "1")}, "pull"), force(0.15),
              1e-3);
  // Held outside the steps as well.
  write("cube.feb", in_steps(file("hex8", kElastic, std::string(kSymmetry) + hold), {"", stretch}));
  EXPECT_EQ(run({"check", "cube.feb"}).code, 0);
  write("cube.feb", in_steps(file("hex8", kElastic, kSymmetry), {stretch, ""}));
  EXPECT_THAT(run({"check", "cube.feb"}).err,
              HasSubstr("is free in one step and held by 'pull' in another"));
  write("cube.feb",
        in_steps(file("hex8", kElastic, kSymmetry), {"<bc type='rigid' node_set='x1'/>", ""}));
  EXPECT_THAT(run({"check", "cube.feb"}).err,
              HasSubstr("<bc> of type \"rigid\" of one step of several is not read"));
}

// The ground carries the weight, 1000 kg times the acceleration.
TEST_F(FebSolidsCli, BodyForcesAreMinusTheAcceleration) {
  for (const std::string lc : {"", " lc='1'"}) {
    const std::string load =
        "<body_load type='body force'><force" + lc + ">9.81,0,0</force></body_load>";
    EXPECT_NEAR(last(file("hex8", kElastic,
                          "<bc name='hold' type='zero displacement' node_set='x0'>"
                          "<x_dof>1</x_dof><y_dof>1</y_dof><z_dof>1</z_dof></bc>",
                          load),
                     "{solid: cube, interface: hold}")
                    .at(0),
                9810, 1e-6);
  }
}

/// A cube between a wall, to which it is attached, and a rigid block of 1 m^3 that shares its
/// nodes.
std::string grips(const std::string& control, const std::string& density, const std::string& more) {
  const std::string fixed =
      "<Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof><Ry_dof>1</Ry_dof><Rz_dof>1</Rz_dof>";
  return "<febio_spec version='4.0'><Module type='solid'/>" + control +
         "<Material><material id='1' name='m' type='neo-Hookean'><density>" + density +
         "</density><E>1e6</E><v>0</v></material><material id='2' name='wall' type='rigid body'/>"
         "<material id='3' name='grip' type='rigid "
         "body'><density>1000</density></material></Material>"
         "<Mesh><Nodes><node id='1'>0,0,0</node><node id='2'>1,0,0</node><node "
         "id='3'>1,1,0</node><node id='4'>0,1,0</node>"
         "<node id='5'>0,0,1</node><node id='6'>1,0,1</node><node id='7'>1,1,1</node><node "
         "id='8'>0,1,1</node>"
         "<node id='9'>2,0,0</node><node id='10'>2,1,0</node><node id='11'>2,0,1</node><node "
         "id='12'>2,1,1</node></Nodes>"
         "<Elements type='hex8' name='bar'><elem id='1'>1,2,3,4,5,6,7,8</elem></Elements>"
         "<Elements type='hex8' name='block'><elem id='2'>2,9,10,3,6,11,12,7</elem></Elements>"
         "<NodeSet name='x0'>1,4,5,8</NodeSet></Mesh><MeshDomains><SolidDomain name='bar' mat='m'/>"
         "<SolidDomain name='block' mat='grip'/></MeshDomains>"
         "<Boundary><bc type='rigid' node_set='x0'><rb>wall</rb></bc></Boundary>"
         "<Rigid><rigid_bc type='rigid_fixed'><rb>wall</rb><Rx_dof>1</Rx_dof>" +
         fixed +
         "</rigid_bc>"
         "<rigid_bc type='rigid_fixed'><rb>grip</rb>" +
         fixed + "</rigid_bc>" + more +
         "</Rigid><LoadData><load_controller id='1' "
         "type='loadcurve'><points><pt>0,0</pt><pt>1,1</pt></points>"
         "</load_controller></LoadData></febio_spec>";
}

// Without lateral strain the force is E/2 (l - 1/l).
TEST_F(FebSolidsCli, ABarBetweenRigidGripsIsPulled) {
  const std::string text = grips(
      "<Control><analysis>STATIC</analysis><time_steps>10</time_steps><step_size>0.1</step_size></"
      "Control>",
      "1000",
      "<rigid_bc type='rigid_displacement'><rb>grip</rb><dof>x</dof><value "
      "lc='1'>0.3</value></rigid_bc>");
  EXPECT_NEAR(last(text, "{solid: bar, interface: grip}").at(0), 5e5 * (1.3 - 1 / 1.3), 1e-4);
  EXPECT_NEAR(last(text, "{solid: bar, interface: wall}").at(0), -5e5 * (1.3 - 1 / 1.3), 1e-4);
  ASSERT_EQ(run({"convert", "cube.feb", "cube.yaml"}).code, 0);
  const auto direct = run({"run", "cube.feb", "--json", "--quiet", "-o", "a"});
  const auto converted = run({"run", "cube.yaml", "--json", "--quiet", "-o", "b"});
  EXPECT_EQ(value(direct.out, "result_hash"), value(converted.out, "result_hash"));
  EXPECT_NE(value(direct.out, "result_hash"), "missing");
}

// A mass of 1000 kg on a bar of k = 1e6 N/m and hardly any mass: x = F/k (1 - cos(w t)).
TEST_F(FebSolidsCli, ARigidMassOscillatesOnABar) {
  const double w = std::sqrt(1000.0), t = 0.1;
  for (const double step : {4e-3, 1e-3, 1e-5}) {
    const std::string control = format(
        "<Control><analysis>DYNAMIC</analysis><time_steps>{}</time_steps>"
        "<step_size>{}</step_size></Control>",
        std::lround(t / step), step);
    const double x =
        last(grips(control, "1e-6",
                   "<rigid_load "
                   "type='rigid_force'><rb>grip</rb><dof>Rx</dof><value>100</value></rigid_load>"),
             "{body: grip}")
            .at(0) -
        1.5;
    EXPECT_NEAR(x / 1e-4, 1 - std::cos(w * t), 1e-3 + 0.5 * w * w * step * step) << step;
  }
}

// Without forces a cube keeps the velocity of its nodes.
TEST_F(FebSolidsCli, SolidsStartWithTheirVelocity) {
  std::string text = file("hex8", kElastic, "");
  const std::string from = "<analysis>STATIC</analysis>";
  text.replace(text.find(from), from.size(), "<analysis>DYNAMIC</analysis>");
  const std::string end = "<Boundary></Boundary>";
  const auto moving = [&](const std::string& set) {
    std::string moved = text;
    return moved.replace(
        moved.find(end), end.size(),
        "<Initial><ic type='velocity' node_set='" + set + "'><value>0,2,0</value></ic></Initial>");
  };
  std::string all = moving("all");
  const std::string sets = "<NodeSet name='x0'>";
  all.replace(all.find(sets), sets.size(), "<NodeSet name='all'>1:8</NodeSet>" + sets);
  const auto row = last(all, "{solid: cube, point: [0, 0, 0]}");
  EXPECT_NEAR(row.at(1), 2.0, 1e-9);
  write("cube.feb", moving("x0"));
  EXPECT_THAT(run({"check", "cube.feb"}).err, HasSubstr("a part of 'cube' alone has a velocity"));
}

TEST_F(FebSolidsCli, WhatIsNotReadIsSaid) {
  const auto fault = [&](const std::string& text) {
    write("cube.feb", text);
    const auto done = run({"check", "cube.feb"});
    EXPECT_EQ(done.code, 3) << done.out;
    return done.err;
  };
  EXPECT_THAT(fault(file("hex8", material("Arruda-Boyce", ""), kSymmetry)),
              HasSubstr("the material 'm' of type 'arruda-boyce' is not read"));
  EXPECT_THAT(fault(file("hex8", material("neo-Hookean", "<E>1e6</E>"), kSymmetry)),
              HasSubstr("has no <E> or <v>"));
  EXPECT_THAT(fault(file("hex8", kElastic,
                         "<bc type='zero displacement' node_set='x3'><x_dof>1</x_dof></bc>")),
              HasSubstr("there is no set of nodes 'x3'"));
  EXPECT_THAT(fault(file("hex8", kElastic,
                         "<bc name='none' type='zero displacement' node_set='x0'>"
                         "<x_dof>0</x_dof></bc>")),
              HasSubstr("the <bc> 'none' fixes no component"));
  EXPECT_THAT(fault(file("hex8", kElastic, "<bc type='linear constraint' node_set='x0'/>")),
              HasSubstr("<bc> of type 'linear constraint' is not read"));
  EXPECT_THAT(
      fault(file("hex8", kElastic, kSymmetry, "<surface_load type='pressure' surface='top'/>")),
      HasSubstr("there is no surface 'top'"));
  EXPECT_THAT(fault(file("hex8",
                         material("trans iso Mooney-Rivlin",
                                  "<c1>1</c1><k>100</k><fiber type='local'>1,2</fiber>"),
                         kSymmetry)),
              HasSubstr("only fibres of type \"vector\" or \"angles\" are read"));
  std::string shell = file("hex8", kElastic, kSymmetry);
  shell.replace(shell.find("<SolidDomain"), 12, "<ShellDomain");
  EXPECT_THAT(fault(shell),
              HasSubstr("the <ShellDomain> 'cube' of hex8 elements is not read, as there are no "
                        "shells. Mesh its thickness"));
  // Fibres may be given without a tag of their own.
  write("cube.feb",
        file("hex8",
             material("trans iso Mooney-Rivlin",
                      "<c1>1</c1><k>100</k><c3>1</c3><c4>2</c4><fiber type='vector'>1,2,0</fiber>"),
             kSymmetry));
  EXPECT_EQ(run({"check", "cube.feb"}).code, 0);
}

}  // namespace
}  // namespace polhode::feb_solids_tests
