// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>

#include <polhode/compile/beam_mesh.hpp>
#include <support/model_builder.hpp>

/// Published beams in motion, as models.
namespace polhode::test {

class OfTime final : public TimeFunction {
 public:
  explicit OfTime(std::function<double(double)> f) : f_(std::move(f)) {}
  double operator()(double t) const override { return f_(t); }

 private:
  std::function<double(double)> f_;
};

/// A force or moment on a body, world axes, that keeps its direction.
inline LoadSpec along(const std::string& type, int body, const Vec3& direction,
                      std::function<double(double)> size) {
  LoadSpec load;
  load.name = type;
  load.type = type;
  load.b = body;
  TimeVector v;
  for (std::size_t i = 0; i < 3; ++i)
    v[i] = std::make_shared<OfTime>(
        [size, d = direction[static_cast<Eigen::Index>(i)]](double t) { return d * size(t); });
  load.vector = v;
  return load;
}

struct SectionNumbers {
  double EA, GA, GJ, EI, rho_A;
  Vec3 rho_J;
};

inline SectionSpec section_of(const SectionNumbers& n) {
  SectionSpec s;
  s.name = "section";
  s.section.stiffness.diagonal() << n.EA, n.GA, n.GA, n.GJ, n.EI, n.EI;
  s.section.mass_per_length = n.rho_A;
  s.section.inertia_per_length = n.rho_J;
  return s;
}

inline BeamSpec beam_through(std::vector<Vec3> points, int elements, const SectionNumbers& n) {
  BeamSpec beam;
  beam.name = "beam";
  beam.points = std::move(points);
  beam.elements = elements;
  beam.section = section_of(n);
  return beam;
}

/// Simo and Vu-Quoc's flying beam ("spaghetti"): a free beam pushed and turned at one end for 5 s.
inline Model flying_beam(int elements) {
  Model m;
  add_beam(m, beam_through({{6, 0, 0}, {0, 8, 0}}, elements,
                           {1e4, 1e4, 500.0, 500.0, 1.0, {20, 10, 10}}));
  const auto rise = [](double t) {
    return t <= 2.5 ? 80.0 * t : t <= 5.0 ? 80.0 * (5.0 - t) : 0.0;
  };
  m.loads.push_back(along("force", 0, {0.1, 0, 0}, rise));
  m.loads.push_back(along("moment", 0, {0, -0.5, -1.0}, rise));
  return m;
}

/// Simo and Vu-Quoc's right-angle cantilever: clamped, with a short force across its plane at the
/// elbow.
inline Model right_angle_cantilever(int elements_per_leg) {
  Model m;
  BeamSpec beam = beam_through({{0, 0, 0}, {0, 10, 0}, {10, 10, 0}}, 2 * elements_per_leg,
                               {1e6, 1e6, 1e3, 1e3, 1.0, {20, 10, 10}});
  beam.bonds = {{kGround, false}};
  add_beam(m, beam);
  m.loads.push_back(along("force", elements_per_leg, {0, 0, 1}, [](double t) {
    return t <= 1.0 ? 50.0 * t : t <= 2.0 ? 50.0 * (2.0 - t) : 0.0;
  }));
  return m;
}

/// Simo and Vu-Quoc's spin-up: a beam on a rotor (body 0) that goes from rest to 6 rad/s in 15 s.
/// The rotor is so heavy that a moment gives it this motion regardless of the beam.
inline Model spin_up_beam(int elements) {
  constexpr double kRotor = 1e10;
  ModelBuilder m;
  const int rotor = m.body("rotor", Vec3::Zero(), 1.0, kRotor * Vec3::Ones());
  m.joint("axle", "revolute", kGround, rotor, Vec3::Zero());
  BeamSpec beam = beam_through({{0, 0, 0}, {10, 0, 0}}, elements,
                               {2.8e7, 1e7, 1.4e4, 1.4e4, 1.2, {12e-4, 6e-4, 6e-4}});
  beam.bonds = {{rotor, false}};
  add_beam(m.model, beam);
  m.model.loads.push_back(along("moment", rotor, {0, 0, kRotor}, [](double t) {
    return t < 15.0 ? 0.4 * (1.0 - std::cos(2.0 * std::numbers::pi * t / 15.0)) : 0.0;
  }));
  return m.model;
}

/// A flexible pendulum in a plane, released level; an Euler-Bernoulli beam, so shear is stiff and
/// the rotary inertia of sections small.
inline Model flexible_pendulum(int elements) {
  constexpr double kEA = 1e5, kEI = 1e7 * 1e-4 / 12.0, kInertia = 1e-3 * 1e3 * 1e-4 / 12.0;
  ModelBuilder m;
  m.model.gravity = {0.0, -9.81, 0.0};
  add_beam(m.model,
           beam_through({{0, 0, 0}, {2, 0, 0}}, elements,
                        {kEA, 100.0 * kEA, kEI, kEI, 10.0, kInertia * Vec3(2.0, 1.0, 1.0)}));
  m.joint("pin", "revolute", kGround, 0, Vec3::Zero());
  return m.model;
}

}  // namespace polhode::test
