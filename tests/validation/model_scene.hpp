// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/contact/contact_set.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test {

/// Bodies in contact, described as a Model and run by Simulation with fixed steps.
class ModelScene {
 public:
  Model model;

  explicit ModelScene(const Vec3& gravity = {0.0, 0.0, -9.81}) {
    model.gravity = gravity;
    model.contacts.present = true;
  }
  /// A body with one shape. @returns its index in the Model.
  int add(const std::string& name, ShapeSpec shape, double mass, const Vec3& inertia,
          const BodyMotion& start) {
    BodySpec body;
    body.name = name;
    body.mass = mass;
    body.inertia = inertia.asDiagonal();
    body.position = start.r;
    body.orientation = start.q;
    body.velocity = start.v;
    body.angular_velocity = start.omega();
    body.shapes.push_back(std::move(shape));
    model.bodies.push_back(std::move(body));
    return static_cast<int>(model.bodies.size()) - 1;
  }
  int add_ball(const std::string& name, double radius, double mass, const BodyMotion& start) {
    return add(name, shape("sphere", {2.0 * radius}), mass,
               Vec3::Constant(0.4 * mass * radius * radius), start);
  }
  int add_box(const std::string& name, const Vec3& size, double mass, const BodyMotion& start) {
    const Vec3 s = size.cwiseProduct(size);
    return add(name, shape("box", {size.x(), size.y(), size.z()}), mass,
               mass / 12.0 * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()), start);
  }
  /// A fixed body with a shape, at a position.
  void add_fixed(const std::string& name, ShapeSpec shape, const Vec3& place = Vec3::Zero()) {
    BodySpec body;
    body.name = name;
    body.fixed = true;
    body.position = place;
    body.shapes.push_back(std::move(shape));
    model.bodies.push_back(std::move(body));
  }
  /// The half space below z = 0.
  void add_floor() { add_fixed("floor", shape("plane", {0.0, 0.0, 1.0})); }
  [[nodiscard]] static ShapeSpec shape(const std::string& type, std::vector<double> sizes) {
    ShapeSpec spec;
    spec.type = type;
    spec.sizes = std::move(sizes);
    return spec;
  }
  /// SPHERES_IN_A_BIN: n spheres of 0.1 m and 1 kg over a bin with walls.
  void add_bin(int n, double side) {
    const int row = static_cast<int>(std::floor((side - 0.21) / 0.22)) + 1;
    const double first = -0.11 * (row - 1);
    for (int i = 0; i < n; ++i) {
      BodyMotion start;
      start.r = {first + 0.22 * (i % row) + 0.005 * std::sin(12.9898 * i),
                 first + 0.22 * ((i / row) % row) + 0.005 * std::sin(78.233 * i),
                 0.12 + 0.22 * (i / (row * row)) + 0.005 * std::sin(37.719 * i)};
      add_ball("sphere_" + std::to_string(i), 0.1, 1.0, start);
    }
    add_floor();
    for (int k = 0; k < 4; ++k) {
      const double sign = k % 2 ? -1.0 : 1.0;
      const Vec3 inwards = sign * (k < 2 ? Vec3::UnitX() : Vec3::UnitY());
      add_fixed("wall_" + std::to_string(k),
                shape("plane", {inwards.x(), inwards.y(), inwards.z()}), -0.5 * side * inwards);
    }
  }
  /// Contact law of all pairs, until begin().
  [[nodiscard]] ContactLawSpec& law() { return model.contacts.standard; }
  void law(double mu, double restitution, double tolerance = 0.0) {
    law().friction = mu;
    law().restitution = restitution;
    law().gap_tolerance = tolerance;
  }
  void begin(double dt) {
    dt_ = dt;
    model.analysis.step = dt;
    run_.emplace(model);
  }
  /// One step of the given length, in parts where the run needs them.
  void step() {
    const double end = run_->time() + dt_;
    while (run_->time() < end - 1e-9 * dt_) run_->step(end);
  }
  void run(double duration) {
    const double end = run_->time() + duration;
    while (run_->time() < end - 1e-9 * dt_) run_->step(end);
  }
  [[nodiscard]] const Simulation& simulation() const { return *run_; }
  [[nodiscard]] BodyMotion motion(int body) const { return run_->body(body); }
  /// Smallest distance of two shapes after the last step [m].
  [[nodiscard]] double least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const contact::ShapePairReport& r : run_->contact_set()->reports())
      least = std::min(least, r.gap);
    return least;
  }
  /// Kinetic and stored energy [J].
  [[nodiscard]] double energy() const {
    const Balance b = run_->balance();
    return b.kinetic + b.potential;
  }

 private:
  double dt_ = 0.0;
  std::optional<Simulation> run_;
};

}  // namespace polhode::test
