// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>

#include <polhode/contact/contact_set.hpp>
#include <polhode/engines/contact_cg_engine.hpp>
#include <polhode/engines/nonsmooth_engine.hpp>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/joints/joint.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/stepping/single_step.hpp>

#include "contact/starts.hpp"

namespace polhode::test {

/// A deformable bar bonded to a body at one end, or to two bodies at both ends, see
/// Scene::add_bar().
struct Bar {
  Vec3 from = Vec3::Zero();  ///< Middle of its end on the body, in its axes; it goes along x.
  Vec3 size = {0.4, 0.1, 0.1};
  std::vector<double> cells{2, 1, 1};
  double density = 100.0, stiffness = 1e5;  ///< Young's modulus [Pa].
  double relaxation_time = 0.0;             ///< Kelvin-Voigt [s].
  int far = kFreeNode;                      ///< Body at the far end.
};

/// Bodies with shapes, and a run of fixed steps.
class Scene {
 public:
  System system;
  std::shared_ptr<contact::ContactSet> contacts = std::make_shared<contact::ContactSet>();
  State state;
  int iterations = 0, steps = 0, cuts = 0;
  double cg_residual = 0.0;  ///< Above 0: the contact CG engine.
  double newton_tolerance = 1e-12;
  int max_iterations = 40;

  explicit Scene(const Vec3& gravity = {0.0, 0.0, -9.81}) { system.set_gravity(gravity); }

  /// A body with one shape at its centre of mass. @returns its index.
  int add(const std::string& name, const geometry::Shape& shape, double mass, const Vec3& inertia,
          const BodyMotion& start) {
    BodyData data;
    data.name = name;
    data.mass = mass;
    data.inertia = inertia.asDiagonal();
    const int body = system.add_body(data, start);
    contacts->add_shape({body, name, shape});
    starts_.push_back(start);
    return body;
  }
  int add_ball(const std::string& name, double radius, double mass, const BodyMotion& start) {
    return add(name, geometry::sphere(name, 2.0 * radius), mass,
               Vec3::Constant(0.4 * mass * radius * radius), start);
  }
  int add_box(const std::string& name, const Vec3& size, double mass, const BodyMotion& start) {
    const Vec3 s = size.cwiseProduct(size);
    return add(name, geometry::box(name, size), mass,
               mass / 12.0 * Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()), start);
  }
  /// A joint between two bodies, or a body and the ground, at a position in the ground frame; the
  /// bodies are not rotated.
  void add_joint(const std::string& type, int a, int b, const Vec3& place) {
    const auto seen_from = [&](int body) {
      return body == kGround ? place : Vec3(place - starts_.at(body).r);
    };
    system.group<Joint>().add(
        "joint", type, Participants{a, b},
        joint_kind(type).recipe({.Z_a = seen_from(a), .Z_b = seen_from(b)}, {}));
    if (a != kGround) contacts->exclude(a, b);
  }
  /// Largest |G v| of joints, the velocity of separation of their sides [m/s].
  [[nodiscard]] double parting() const;
  /// The half space below a plane through the origin, on the ground.
  void add_floor(const Vec3& normal = Vec3::UnitZ()) {
    geometry::ShapePlace place;
    place.axes = Quat::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
    contacts->add_shape({kGround, "floor", geometry::plane(place)});
  }
  /// A bar on a body, moving with it. @returns its mass.
  double add_bar(int body, const Bar& bar) {
    const solids::Mesh mesh = solids::make_mesh(
        "bar", "block",
        {{"size", {bar.size.x(), bar.size.y(), bar.size.z()}}, {"cells", bar.cells}}, "hex8");
    const BodyMotion& m = starts_.at(body);
    std::vector<Vec3> X;
    const int first = system.nodes().count();
    for (const Vec3& own : mesh.nodes) {
      const Vec3 Z = bar.from + own + Vec3(0.5 * bar.size.x(), 0.0, 0.0);
      const Vec3 x = m.r + m.q * Z;
      X.push_back(x);
      NodeData node{.position = x, .velocity = m.v + m.omega().cross(x - m.r)};
      if (own.x() < -0.5 * bar.size.x() + 1e-9) {
        node.body = body;
        node.Z = Z;
      } else if (bar.far != kFreeNode && own.x() > 0.5 * bar.size.x() - 1e-9) {
        node.body = bar.far;
        node.Z = starts_.at(bar.far).q.conjugate() * (x - starts_.at(bar.far).r);
      }
      system.add_node(node);
    }
    solids::MaterialDescription material;
    material.kind = "neo_hookean";
    material.values = {{"youngs_modulus", bar.stiffness}, {"poisson_ratio", 0.3}};
    material.relaxation_time = bar.relaxation_time;
    solids::SolidElementsDescription d;
    d.name = "bar";
    d.element = "hex8_eas9";
    d.material = solids::make_material("materials.m", material);
    d.density = bar.density;
    d.connectivity = mesh.blocks.at(0).nodes;
    for (int& node : d.connectivity) node += first;
    bar_points_.insert(bar_points_.end(), X.begin(), X.end());
    d.X = bar_points_;
    system.add_elements(solids::make_solid_elements(std::move(d)));
    return bar.density * bar.size.prod();
  }
  void law(double mu, double restitution, double tolerance = 0.0) {
    contact::ContactLaw law;
    law.friction.mu = mu;
    law.restitution = restitution;
    law.tolerance = tolerance;
    contacts->set_default(law);
  }
  void begin(double dt) {
    dt_ = dt;
    system.set_contacts(contacts);
    system.finish();
    state = system.initial_state();
    state.dt_next = dt;
    restart();
    single_->ledger().begin(state);
  }
  /// A new engine, as after reading the state from a file.
  void restart() {
    std::unique_ptr<NewtonEngine> engine;
    if (contacts->impulses())
      engine = std::make_unique<NonsmoothEngine>(system);
    else if (cg_residual > 0.0)
      engine = std::make_unique<ContactCgEngine>(system, cg_residual);
    else if (!system.nodes().empty())
      engine = std::make_unique<SparseEngine>(system, "block_lu", MomentumRate::momentum,
                                              NodeFactor::every_iteration);
    else
      engine = std::make_unique<SparseEngine>(system, "block_lu");
    single_ = std::make_unique<SingleStep>(system, std::move(engine),
                                           GeneralizedAlpha::from_spectral_radius(1.0),
                                           lane_kernels("automatic"), true);
  }
  /// One step, halved as often as needed. @returns false if that does not help.
  bool step() {
    double left = dt_;
    NewtonOptions options;
    options.tolerance = newton_tolerance;
    options.max_iterations = max_iterations;
    options.jacobian = JacobianPolicy::every_iteration;
    options.line_search = false;
    double h = dt_;
    while (left > 1e-9 * dt_) {
      h = std::min(h, left);
      last = single_->take(state, h, options, {1, false});
      iterations += last.iterations;
      if (watch) watch(h);
      if (last.converged) {
        left -= h;
        h *= 2.0;
        continue;
      }
      ++cuts;
      h *= 0.5;
      if (h < 1e-4 * dt_) return false;
    }
    ++steps;
    single_->ledger().close_step(state);
    return true;
  }
  /// Steps until a duration has passed [s]. @returns false if one failed.
  bool run(double duration) {
    const auto count = static_cast<int>(std::lround(duration / dt_));
    for (int k = 0; k < count; ++k)
      if (!step()) return false;
    return true;
  }
  /// Search for impulses in the last step.
  [[nodiscard]] ImpulseSearch search() const { return contacts->last_search(); }
  /// Smallest distance of two shapes after the last step [m].
  [[nodiscard]] double least_gap() const {
    double least = std::numeric_limits<double>::infinity();
    for (const contact::ShapePairReport& r : contacts->reports()) least = std::min(least, r.gap);
    return least;
  }
  /// Kinetic and stored energy [J].
  [[nodiscard]] double energy() const {
    const Balance b = single_->ledger().balance(state);
    return b.kinetic + b.potential;
  }
  /// Largest error of the energy balance so far [J].
  [[nodiscard]] double drift() const { return state.ledger.energy_drift; }
  [[nodiscard]] BodyMotion motion(int body) const { return system.motion(state, body); }
  [[nodiscard]] Balance balance() const { return single_->ledger().balance(state); }
  NewtonReport last;
  std::function<void(double)>
      watch;  ///< Called after every attempt at a step, with its length [s].

 private:
  double dt_ = 1e-2;
  std::vector<BodyMotion> starts_;
  std::vector<Vec3> bar_points_;
  std::unique_ptr<SingleStep> single_;
};

inline double Scene::parting() const {
  InteractionSweep sweep(system);
  std::vector<BodyStep> instants;
  for (int b = 0; b < system.body_count(); ++b) instants.push_back(system.instant(state, b));
  instants.push_back(BodyStep::ground(1.0));
  const std::vector<double> lambda(static_cast<std::size_t>(system.rows()), 0.0);
  double most = 0.0;
  StepContext context;
  context.dt = dt_;
  context.ga.alpha_f = 1.0;
  sweep.run(instants, context, lambda.data(), state.history.data(),
            [&](int interaction, const PairStep& step, const PairTerms& t) {
              const InteractionRef& ref = system.interactions()[interaction];
              const auto velocity = [](const BodyStep& s) {
                Vec6 v;
                v << s.v_n1, s.Lambda_n1 * s.W_n1;
                return v;
              };
              for (int k = 0; k < ref.rows; ++k) {
                double part = 0.0;
                if (ref.a != kGround) part += t.G_a.row(k).dot(velocity(step.a));
                if (ref.b != kGround) part += t.G_b.row(k).dot(velocity(step.b));
                most = std::max(most, std::abs(part));
              }
            });
  return most;
}

}  // namespace polhode::test
