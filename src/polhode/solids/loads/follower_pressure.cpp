// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/math/hat.hpp>
#include <polhode/solids/elements/quadrature.hpp>
#include <polhode/solids/loads/follower_pressure.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::solids {

FollowerPressure::FollowerPressure(std::string name, const LoadedFaces& faces,
                                   TimeFunctionPtr pressure, FollowerRule rule)
    : name_(std::move(name)),
      n_(cell_shape(faces.shape).size()),
      nodes_(faces.nodes),
      pressure_(std::move(pressure)),
      rule_(rule) {
  const CellShape& shape = cell_shape(faces.shape);
  for (const QuadraturePoint& q : face_rule(faces.shape)) {
    Point p{.weight = q.weight, .N = {}, .N_xi = {}, .N_eta = {}};
    const Vec N = shape_functions(shape, q.xi);
    const Mat D = shape_gradients(shape, q.xi);
    for (int a = 0; a < n_; ++a) {
      p.N[a] = N[a];
      p.N_xi[a] = D(a, 0);
      p.N_eta[a] = D(a, 1);
    }
    points_.push_back(p);
  }
}

double FollowerPressure::pressure(const NodeStep& step) const {
  return step.context.load_factor * (*pressure_)(step.context.t_alpha());
}

void FollowerPressure::add(const NodeStep& step, int face, double tau, double p, Forces& f,
                           double* K) const {
  const std::span<const int> own = nodes(face);
  for (const Point& q : points_) {
    Vec3 x_xi = Vec3::Zero(), x_eta = Vec3::Zero();
    for (int a = 0; a < n_; ++a) {
      const Vec3 x =
          (1.0 - tau) * NodeStep::at(step.x_n, own[a]) + tau * NodeStep::at(step.x_n1, own[a]);
      x_xi += q.N_xi[a] * x;
      x_eta += q.N_eta[a] * x;
    }
    const Vec3 push = -p * q.weight * x_xi.cross(x_eta);
    for (int a = 0; a < n_; ++a) f.col(a) += q.N[a] * push;
    if (!K) continue;
    const Mat3 by_xi = hat(x_xi), by_eta = hat(x_eta);
    for (int b = 0; b < n_; ++b) {
      const Mat3 D = -p * q.weight * tau * (q.N_eta[b] * by_xi - q.N_xi[b] * by_eta);
      for (int a = 0; a < n_; ++a)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) K[(3 * a + i) * 3 * n_ + 3 * b + j] += q.N[a] * D(i, j);
    }
  }
}

void FollowerPressure::add_step(const NodeStep& step, int face, double p, Forces& f,
                                double* K) const {
  if (rule_ == FollowerRule::kMomentum || step.alpha_f == 1.0)
    return add(step, face, step.alpha_f, p, f, K);
  add(step, face, 0.0, p / 6.0, f, nullptr);
  add(step, face, step.alpha_f, p * 4.0 / 6.0, f, K);
  add(step, face, 1.0, p / 6.0, f, K);
}

ElementReport FollowerPressure::evaluate(const NodeStep& step, const double* /*history*/,
                                         double* /*scratch*/, const Mat3& /*turn*/,
                                         const ElementSink& sink) const {
  const double p = pressure(step);
  for (int face = 0; face < size(); ++face) {
    Forces f = Forces::Zero();
    double K[9 * kMaxNodes * kMaxNodes];
    if (sink.tangent) std::fill_n(K, 9 * n_ * n_, 0.0);
    add_step(step, face, p, f, sink.tangent ? K : nullptr);
    sink.add_force(nodes(face), f.data());
    if (sink.tangent) sink.add_tangent(face, n_, K);
  }
  return {};
}

Work FollowerPressure::work(const NodeStep& step, const double* /*history*/,
                            const double* /*scratch*/) const {
  Work w;
  if (step.x_n == step.x_n1) return w;
  const double p = pressure(step);
  for (int face = 0; face < size(); ++face) {
    Forces f = Forces::Zero();
    add_step(step, face, p, f, nullptr);
    for (int a = 0; a < n_; ++a) w.put_in += f.col(a).dot(NodeStep::at(step.u, nodes(face)[a]));
  }
  return w;
}

ElementGroups make_follower_pressure(const std::string& name, std::span<const LoadedFaces> faces,
                                     const TimeFunctionPtr& pressure, FollowerRule rule) {
  check_faces(name, faces);
  ElementGroups groups;
  for (const LoadedFaces& f : faces)
    if (!f.nodes.empty())
      groups.push_back(std::make_unique<FollowerPressure>(name, f, pressure, rule));
  return groups;
}

}  // namespace polhode::solids
