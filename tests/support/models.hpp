// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <support/model_builder.hpp>

/// Published cases and mechanisms with a known property, as models.
namespace polhode::test {

inline const Vec3 kDown{0.0, 0.0, -9.81};        ///< Gravity of the spatial cases.
inline const Vec3 kDownPlanar{0.0, -9.81, 0.0};  ///< Gravity of the planar ones.

inline Quat about_z(double angle) { return Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())); }

/// IFToMM library: a point mass of 1 kg on a rod of 1 m, released level. Body 0.
inline Model planar_pendulum() {
  ModelBuilder m;
  m.model.gravity = kDownPlanar;
  const int mass = m.point_mass("P1", {-1.0, 0.0, 0.0}, 1.0);
  m.distance("rod", kGround, Vec3::Zero(), mass, {-1.0, 0.0, 0.0});
  return m.model;
}

/// IFToMM library: N squares in a row, bars of 1 m and 1 kg, spatial hinges: 3N redundant rows. The
/// first body is the vertical whose upper end is B0. `phi` turns the verticals from upright,
/// clockwise; at π/2 all bars are in one line.
inline Model n_four_bar(int N, double phi = 0.0) {
  ModelBuilder m;
  m.model.gravity = kDownPlanar;
  const Vec3 arm(std::sin(phi), std::cos(phi), 0.0), omega(0.0, 0.0, -1.0);
  const Vec3 slender(1e-4, 1.0 / 12.0, 1.0 / 12.0);  // x along the bar
  std::vector<int> vertical;
  for (int i = 0; i <= N; ++i) {
    const Vec3 foot(i, 0.0, 0.0);
    const std::string n = std::to_string(i);
    vertical.push_back(m.body("vertical" + n, foot + 0.5 * arm, 1.0, slender,
                              about_z(0.5 * std::numbers::pi - phi)));
    m.turning(vertical.back(), omega, foot);
    m.joint("ground" + n, "revolute", kGround, vertical.back(), foot);
  }
  for (int i = 0; i < N; ++i) {
    const Vec3 end = Vec3(i, 0.0, 0.0) + arm;
    const std::string n = std::to_string(i);
    const int coupler = m.body("coupler" + n, end + Vec3(0.5, 0.0, 0.0), 1.0, slender);
    m.at(coupler).velocity = omega.cross(arm);
    m.joint("left" + n, "revolute", vertical[static_cast<std::size_t>(i)], coupler, end);
    m.joint("right" + n, "revolute", coupler, vertical[static_cast<std::size_t>(i) + 1],
            end + Vec3(1.0, 0.0, 0.0));
  }
  return m.model;
}
/// B0 from the centre of mass of body 0 of n_four_bar.
inline const Vec3 kFourBarB0{0.5, 0.0, 0.0};

/// W. Schiehlen (ed.), Multibody Systems Handbook: Andrews' squeezer of seven bodies, with spatial
/// hinges. The angles β, Θ, γ, Φ, δ, Ω, ε are the coordinates of the joints that andrews_angles()
/// names.
inline Model andrews_squeezer() {
  ModelBuilder m;
  const double beta = -0.06171389001427645, Theta = 0.0, gamma = 0.45527981916307037,
               Phi = 0.22266839016588588, delta = 0.48736497954384256, Omega = -0.22266839016588588,
               epsilon = 1.2305474445498212;
  const Vec3 O(0.0, 0.0, 0.0), A(-0.06934, -0.00227, 0.0), B(-0.03635, 0.03273, 0.0),
      C(0.014, 0.072, 0.0);
  const auto link = [&](const std::string& name, const Vec3& origin, double angle, double mass,
                        double inertia, const Vec3& com) {
    return m.body(name, origin + about_z(angle) * com, mass, inertia * Vec3(0.6, 0.7, 1.0),
                  about_z(angle));
  };
  const auto hinge = [&](const std::string& name, int a, int b, const Vec3& point) {
    JointSpec& j = m.joint(name, "revolute", a, b, point);
    j.R_a = j.R_b = Mat3::Identity();  // angles are those of the bodies' own axes
  };
  const Vec3 F = about_z(beta) * Vec3(0.007, 0.0, 0.0);
  const Vec3 E = B + about_z(gamma) * Vec3(0.0, -0.035, 0.0);
  const Vec3 D = B + about_z(gamma) * Vec3(0.02, -0.018, 0.0);
  const Vec3 G = A + about_z(delta) * Vec3(0.04, 0.0, 0.0);
  const Vec3 H = A + about_z(epsilon) * Vec3(0.0, -0.04, 0.0);
  const int K1 = link("K1", O, beta, 0.04325, 2.194e-6, {0.00092, 0.0, 0.0});
  const int K2 = link("K2", F, beta + Theta, 0.00365, 4.41e-7, {-0.0115, 0.0, 0.0});
  const int K3 = link("K3", B, gamma, 0.02373, 5.255e-6, {0.01043, -0.01874, 0.0});
  const int K4 = link("K4", G, Phi + delta, 0.00706, 5.667e-7, {0.0, -0.00579, 0.0});
  const int K5 = link("K5", A, delta, 0.0705, 1.169e-5, {0.02308, 0.00916, 0.0});
  const int K6 = link("K6", H, Omega + epsilon, 0.00706, 5.667e-7, {0.00579, 0.0, 0.0});
  const int K7 = link("K7", A, epsilon, 0.05498, 1.912e-5, {-0.00449, -0.01228, 0.0});
  hinge("beta", kGround, K1, O);
  hinge("Theta", K1, K2, F);
  hinge("gamma", kGround, K3, B);
  hinge("E23", K3, K2, E);
  hinge("E34", K3, K4, E);
  hinge("E36", K3, K6, E);
  hinge("delta", kGround, K5, A);
  hinge("epsilon", kGround, K7, A);
  hinge("Phi", K5, K4, G);
  hinge("Omega", K7, K6, H);
  m.moment("motor", K1, {0.0, 0.0, 0.033});
  m.spring("spring", kGround, C, K3, D, {{"stiffness", 4530.0}, {"free_length", 0.07785}});
  return m.model;
}
inline std::vector<std::string> andrews_angles() {
  return {"beta", "Theta", "gamma", "Phi", "delta", "Omega", "epsilon"};
}

/// A bar between two points, square cross section 0.1 m, x along it.
inline int square_bar(ModelBuilder& m, const std::string& name, const Vec3& from, const Vec3& to) {
  return m.body(name, 0.5 * (from + to), 1.0,
                Vec3(1.0 / 600.0, 0.08416666666666667, 0.08416666666666667),
                Quat::FromTwoVectors(Vec3::UnitX(), to - from));
}

/// IFToMM library: Bricard's six hinges on the edges of a cube; one redundant row in all positions.
/// P3 is the far end of body 1.
inline Model bricard() {
  ModelBuilder m;
  m.model.gravity = kDownPlanar;
  const std::vector<Vec3> P{{0, 0, 0}, {1, 0, 0}, {1, -1, 0}, {1, -1, 1}, {0, -1, 1}, {0, 0, 1}};
  const std::vector<Vec3> axis{Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX(),
                               Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
  for (std::size_t i = 0; i < 5; ++i) square_bar(m, "rod" + std::to_string(i + 1), P[i], P[i + 1]);
  for (std::size_t i = 0; i < 6; ++i) {
    const int a = i == 0 ? kGround : static_cast<int>(i) - 1;
    const int b = i == 5 ? kGround : static_cast<int>(i);
    m.joint("P" + std::to_string(i + 1), "revolute", a, b, P[i], axis[i]);
  }
  return m.model;
}
inline const Vec3 kBricardP3{0.5, 0.0, 0.0};  ///< From the centre of mass of body 1.

/// Bennett's four hinges: links p, q, p, q with twists α, β where q sin α = p sin β. Mobile despite
/// the count of rows: three of them are redundant.
inline Model bennett() {
  ModelBuilder m;
  m.model.gravity = kDown;
  const double p = 1.0, q = 0.8, alpha = 0.7, beta = std::asin(q * std::sin(alpha) / p);
  const double theta = 0.9;  // at hinge 1; the closed form gives hinge 2
  const double other = 2.0 * std::atan(std::sin(0.5 * (beta + alpha)) /
                                       std::sin(0.5 * (beta - alpha)) / std::tan(0.5 * theta));
  // Denavit and Hartenberg: turn about the hinge, along the link, twist to the next hinge.
  const double turn[4] = {theta, other, -theta, -other};
  const double length[4] = {p, q, p, q}, twist[4] = {alpha, beta, alpha, beta};
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  std::vector<Vec3> point, axis;
  for (int i = 0; i < 4; ++i) {
    point.push_back(frame.translation());
    axis.push_back(frame.linear().col(2));
    frame = frame * Eigen::AngleAxisd(turn[i], Vec3::UnitZ()) *
            Eigen::Translation3d(length[i], 0.0, 0.0) * Eigen::AngleAxisd(twist[i], Vec3::UnitX());
  }
  for (std::size_t i = 0; i < 3; ++i)
    square_bar(m, "link" + std::to_string(i + 1), point[i], point[i + 1]);
  for (std::size_t i = 0; i < 4; ++i) {
    const int a = i == 0 ? kGround : static_cast<int>(i) - 1;
    const int b = i == 3 ? kGround : static_cast<int>(i);
    m.joint("hinge" + std::to_string(i + 1), "revolute", a, b, point[i], axis[i]);
  }
  return m.model;
}

/// IFToMM library: stiff flyball governor. Bodies shaft, slider, rodAC, rodBD, each rod with its
/// ball.
inline Model flyball_governor() {
  ModelBuilder m;
  m.model.gravity = kDown;
  const Vec3 omega(0.0, 0.0, 2.0 * std::numbers::pi);
  const int shaft = m.body("shaft", {0.0, 0.0, 0.5}, 0.3, Vec3(0.0250025, 0.0250025, 5e-6));
  const int slider = m.body("slider", {0.0, 0.0, 0.5}, 3.0, Vec3(0.005, 0.005, 0.005));
  m.joint("ground", "revolute", kGround, shaft, Vec3::Zero());
  m.joint("guide", "prismatic", shaft, slider, {0.0, 0.0, 0.5});
  const double c30 = std::cos(std::numbers::pi / 6.0), s30 = 0.5;
  const double rod_mass = 0.3, ball = 5.0, mass = rod_mass + ball;
  const double com = (0.5 * rod_mass + ball) / mass;  // along the rod from its hinge
  const double across =
      0.0250025 + rod_mass * (com - 0.5) * (com - 0.5) + ball * (1.0 - com) * (1.0 - com);
  for (const double side : {1.0, -1.0}) {
    const std::string name = side > 0 ? "AC" : "BD";
    const Vec3 hinge(0.05 * side, 0.0, 1.0), along(c30 * side, 0.0, -s30);
    Mat3 axes;
    axes.col(0) = along;
    axes.col(1) = Vec3::UnitY();
    axes.col(2) = along.cross(Vec3::UnitY());
    const int rod =
        m.body("rod" + name, hinge + com * along, mass, Vec3(5e-6, across, across), Quat(axes));
    m.joint("hinge" + name, "revolute", shaft, rod, hinge, Vec3::UnitY());
    m.spring("spring" + name, slider, {0.05 * side, 0.0, 0.5}, rod, hinge + 0.5 * along,
             {{"stiffness", 8e5}, {"damping", 4e4}, {"free_length", 0.5}});
  }
  for (int b = 0; b < 4; ++b) m.turning(b, omega);
  return m.model;
}

/// The governor with springs a hundred and dampers a thousand times softer. Those of A05 have fast
/// parts that no step resolves, which hide orders above 4.
inline Model soft_governor() {
  Model model = flyball_governor();
  for (LoadSpec& load : model.loads) {
    load.parameters.at("stiffness") *= 0.01;
    load.parameters.at("damping") *= 0.001;
  }
  return model;
}

/// O. Brüls, A. Cardona, J. Comput. Nonlinear Dyn. 5 (2010) 031002: heavy top, spinning at
/// 150 rad/s about a fixed point.
inline Model heavy_top() {
  ModelBuilder m;
  m.model.gravity = kDown;
  const int top = m.body("top", Vec3::UnitY(), 15.0, Vec3(0.234375, 0.46875, 0.234375));
  m.joint("tip", "spherical", kGround, top, Vec3::Zero());
  m.turning(top, {0.0, 150.0, -4.61538});
  return m.model;
}

/// A torque-free body that tumbles about its middle axis.
inline Model free_asymmetric_top() {
  ModelBuilder m;
  const int top = m.body("top", Vec3::Zero(), 1.0, Vec3(1.0, 2.0, 3.0));
  m.at(top).angular_velocity = {0.001, 5.0, 0.001};
  return m.model;
}

/// A torque-free symmetric top, J_r = diag(1, 1, 2), whose closed form is in
/// known_solutions/free_symmetric_top.hpp.
inline Model free_symmetric_top(const Vec3& omega) {
  ModelBuilder m;
  const int top = m.body("top", Vec3::Zero(), 1.0, Vec3(1.0, 1.0, 2.0));
  m.at(top).angular_velocity = omega;
  return m.model;
}

/// E. J. Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, §12: spatial
/// slider-crank. Bodies crank, rod, slider.
inline Model spatial_slider_crank() {
  ModelBuilder m;
  m.model.gravity = kDown;
  const Vec3 A(0.0, 0.1, 0.12), B(0.0, 0.1, 0.2), C(0.2, 0.0, 0.0);
  const int crank = m.body("crank", 0.5 * (A + B), 0.12, Vec3(1e-4, 1e-4, 1e-5));
  const Vec3 along = (C - B).normalized(), cross = Vec3::UnitX().cross(along).normalized();
  Mat3 rod_axes;
  rod_axes.col(0) = along;
  rod_axes.col(1) = cross;
  rod_axes.col(2) = along.cross(cross);
  const int rod = m.body("rod", 0.5 * (B + C), 0.5, Vec3(4e-4, 4e-3, 4e-3), Quat(rod_axes));
  const int slider = m.body("slider", C, 2.0, Vec3(1e-4, 1e-4, 1e-4));
  m.joint("A", "revolute", kGround, crank, A, Vec3::UnitX());
  m.joint("B", "spherical", crank, rod, B);
  Mat3 cardan;
  cardan.col(0) = Vec3::UnitX();
  cardan.col(1) = cross;
  cardan.col(2) = Vec3::UnitX().cross(cross);
  m.joint_along("C", "universal", slider, rod, C, cardan);
  m.joint("guide", "prismatic", kGround, slider, C, Vec3::UnitX());
  m.turning(crank, {6.0, 0.0, 0.0}, A);
  m.at(rod).velocity = {0.12, -0.24, 0.0};
  m.at(rod).angular_velocity = {1.92, -0.96, 0.48};
  m.at(slider).velocity = {0.24, 0.0, 0.0};
  return m.model;
}

/// Three bodies in a row, all joints of one kind: to the ground under gravity, or floating without.
/// They start turning as one body, which every joint allows.
/// @param free  Of generic joints.
inline Model chain(const std::string& type, int links, bool grounded,
                   const std::vector<std::string>& free = {}) {
  ModelBuilder m;
  if (grounded) m.model.gravity = kDown;
  const Vec3 step(0.9, 0.3, -0.2), omega(0.7, -0.4, 1.1);
  Vec3 joint = Vec3::Zero();
  for (int i = 0; i < links; ++i) {
    const std::string n = std::to_string(i + 1);
    const Vec3 axis = Vec3(0.3 + 0.2 * i, 1.0 - 0.4 * i, 0.5).normalized();
    const int b = m.body("link" + n, joint + 0.5 * step, 1.0 + 0.3 * i, Vec3(0.08, 0.11, 0.13),
                         Quat(Eigen::AngleAxisd(0.4 + 0.5 * i, Vec3(1.0, -0.5, 0.8).normalized())));
    if (i > 0 || grounded) {
      const int a = i > 0 ? b - 1 : kGround;
      if (type == "distance")
        m.distance("joint" + n, a, joint - 0.2 * step, b, joint + 0.2 * step);
      else
        m.joint("joint" + n, type, a, b, joint, axis).free = free;
    }
    joint += step;
  }
  if (!grounded)
    for (int b = 0; b < links; ++b) {
      m.turning(b, omega);
      m.at(b).velocity += Vec3(0.2, 0.1, -0.3);
    }
  return m.model;
}

/// A door on two hinges in line: five redundant rows. The hinges are not vertical, so it swings.
inline Model door() {
  ModelBuilder m;
  m.model.gravity = kDown;
  const Vec3 post = Vec3(0.2, 0.1, 1.0).normalized();
  const Vec3 out = Vec3(1.0, 1.0, 0.0).normalized();
  const Vec3 across = (out - out.dot(post) * post).normalized();
  const int leaf = m.body("leaf", 0.4 * across + 1.0 * post, 20.0, Vec3(7.7, 6.7, 1.07));
  m.joint("lower", "revolute", kGround, leaf, 0.3 * post, post);
  m.joint("upper", "revolute", kGround, leaf, 1.7 * post, post);
  return m.model;
}

/// Springs of every kind on jointed bodies: to the ground, between neighbours and between distant
/// bodies, a torsional one in a hinge.
inline Model sprung_chain(double damping = 0.0) {
  Model model = chain("revolute", 3, true);
  ModelBuilder m;
  m.model = std::move(model);
  m.spring("to_ground", kGround, {1.0, 1.0, 0.5}, 0, {0.6, 0.3, 0.0},
           {{"stiffness", 40.0}, {"damping", damping}, {"free_length", 0.3}});
  m.spring("far", 0, {0.2, 0.2, 0.1}, 2, {2.4, 0.8, -0.3},
           {{"stiffness", 25.0}, {"damping", 0.5 * damping}, {"free_length", 1.5}});
  m.torsional_spring("hinge", "joint2",
                     {{"stiffness", 5.0}, {"damping", 0.3 * damping}, {"free_angle", 0.4}});
  return m.model;
}

}  // namespace polhode::test
