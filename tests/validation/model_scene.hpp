// SPDX-License-Identifier: Apache-2.0
#pragma once

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
