// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <limits>

#include <polhode/contact_laws/bristle.hpp>
#include <polhode/contact_laws/stop_force.hpp>
#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode::surface_contact {

namespace {

using contact::Dual;
using contact::V3;

/// Displacement, as a part of the band, below which it has no direction to correct.
constexpr double kNoDirection = 1e-6;

Vec3 at(const double* x, int node) { return NodeStep::at(x, node); }

}  // namespace

SurfaceContact::SurfaceContact(std::string name, SurfacePoints points, const std::vector<Vec3>& X,
                               const RigidSurface& surface, const SurfacePlace& place,
                               const SurfaceLaw& law)
    : name_(std::move(name)),
      surface_(surface),
      place_(place),
      law_(law),
      n_(points.nodes_per_point),
      frame_(place.moves() ? 4 : 0),
      points_(std::move(points)),
      extent_(surface.extent()) {
  for (int i = 0; i < size(); ++i) {
    const auto first = points_.nodes.begin() + static_cast<std::ptrdiff_t>(i) * n_;
    nodes_.insert(nodes_.end(), first, first + n_);
    if (frame_ > 0) nodes_.insert(nodes_.end(), place_.nodes.begin(), place_.nodes.end());
  }
  gaps_at_start_ = gaps(X);
}

std::vector<double> SurfaceContact::gaps(const std::vector<Vec3>& X) const {
  std::vector<double> x, list;
  for (const Vec3& node : X) x.insert(x.end(), node.begin(), node.end());
  for (int i = 0; i < size(); ++i)
    list.push_back(distance(local(x.data(), i), std::numeric_limits<double>::infinity(), true));
  return list;
}

/// @eq{cable-gap}
RigidSurface::Gap SurfaceContact::gap(const Vec3& y, const GapQuery& question) const {
  if (is_far(y, question.at_most)) return {.value = question.at_most};
  return surface_.gap(y, {question.law, question.at_most, question.sided, radius()});
}

double SurfaceContact::distance(const Vec3& y, double at_most, bool sided) const {
  if (is_far(y, at_most)) return at_most;
  const double limit = at_most + radius(), found = surface_.distance(y, limit, sided);
  return found < limit ? found - radius() : at_most;  // exact where nothing is near
}

Vec3 SurfaceContact::foot(const double* x, int point) const {
  const Vec3 p = position(x, point);
  if (!of_cable()) return p;
  return p - radius() * (axes(x) * gap(local(x, point), {law_.normal}).normal.normalized());
}

Vec3 SurfaceContact::position(const double* x, int point) const {
  const std::span<const int> own = nodes(point);
  Vec3 p = Vec3::Zero();
  for (int a = 0; a < n_; ++a)
    p += points_.points[static_cast<std::size_t>(point)].N[a] *
         at(x, own[static_cast<std::size_t>(a)]);
  return p;
}

Vec3 SurfaceContact::local(const double* x, int point) const {
  const Vec3 p = position(x, point);
  if (frame_ == 0) return place_.axes.transpose() * (p - place_.origin);
  const Vec3 x_0 = at(x, place_.nodes[0]);
  Vec3 y;
  for (std::size_t k = 0; k < 3; ++k)
    y[static_cast<int>(k)] = (p - x_0).dot(at(x, place_.nodes[k + 1]) - x_0) / place_.size;
  return y;
}

Vec3 SurfaceContact::local_rate(const double* x, const double* v, int point) const {
  const Vec3 p_dot = position(v, point);
  if (frame_ == 0) return place_.axes.transpose() * p_dot;
  const Vec3 d = position(x, point) - at(x, place_.nodes[0]),
             d_dot = p_dot - at(v, place_.nodes[0]);
  Vec3 y_dot;
  for (std::size_t k = 0; k < 3; ++k) {
    const int node = place_.nodes[k + 1];
    y_dot[static_cast<int>(k)] = (d_dot.dot(at(x, node) - at(x, place_.nodes[0])) +
                                  d.dot(at(v, node) - at(v, place_.nodes[0]))) /
                                 place_.size;
  }
  return y_dot;
}

/// Axes of the surface as columns.
Mat3 SurfaceContact::axes(const double* x) const {
  if (frame_ == 0) return place_.axes;
  Mat3 R;
  for (std::size_t k = 0; k < 3; ++k)
    R.col(static_cast<int>(k)) =
        (at(x, place_.nodes[k + 1]) - at(x, place_.nodes[0])) / place_.size;
  return R;
}

namespace {

/// Vector at t_{n+1} with its derivative by y_{n+1}.
template <class T>
V3<T> with_derivative(const Vec3& value, const Mat3& D) {
  if constexpr (std::is_same_v<T, double>) {
    return contact::v3(value);
  } else {
    V3<T> x{T(value[0]), T(value[1]), T(value[2])};
    for (int j = 0; j < 3; ++j) x.x.d[j] = D(0, j), x.y.d[j] = D(1, j), x.z.d[j] = D(2, j);
    return x;
  }
}
template <class T>
T with_derivative(double value, const Vec3& D) {
  T x(value);
  if constexpr (!std::is_same_v<T, double>)
    for (int j = 0; j < 3; ++j) x.d[j] = D[j];
  return x;
}

}  // namespace

namespace {

/// Height above the end of the barrier, as a part of its band, below which the weights of forces
/// are constant. Only iterates get there.
constexpr double kDeepInSurface = 1e-9;

/// Force at the end of a step, as a weight for its direction.
template <class T>
T weight(const contact::NormalLaw& law, double gap, const Vec3& normal) {
  const double least = law.floor() + 2.0 * kDeepInSurface * law.tolerance;
  const auto f = law.force_and_slope(std::max(gap, least));
  return with_derivative<T>(f.value, gap < least ? Vec3(Vec3::Zero()) : Vec3(f.slope * normal));
}

/// Mean of the gap's gradients at both ends, weighted by the forces there. An end without force
/// does not contribute: its nearest feature may be another part of the surface.
template <class T>
V3<T> mean_normal(const contact::NormalLaw& law, double alpha, const RigidSurface::Gap& g_n,
                  const RigidSurface::Gap& g_n1) {
  const T from = T((1.0 - alpha) * weight<double>(law, g_n.value, g_n.normal));
  const T to = alpha * weight<T>(law, g_n1.value, g_n1.normal);
  const V3<T> n_1 = with_derivative<T>(g_n1.normal, g_n1.curvature);
  if (!(contact::value(from + to) > 0.0)) return n_1;
  return (T(1.0) / (from + to)) * (from * contact::v3(g_n.normal) + to * n_1);
}

}  // namespace

/// All quantities that depend on y_{n+1}, with or without their derivatives.
template <class T>
struct SurfaceContact::Terms {
  V3<T> h, friction, bristle, slid;
  T lambda{}, pressure{};

  Terms(const SurfaceLaw& law, const NodeStep& step, const LocalMotion& place,
        const RigidSurface::Gap& g_n, const RigidSurface::Gap& g_n1, const PointMemory& memory,
        bool& slips) {
    const StepContext& context = step.context;
    const double alpha = step.alpha_f;
    const Vec3 dy = place.at_n1 - place.at_n;
    const auto force = contact::stop_force(law.normal, {.at_n = g_n.value,
                                                        .at_n1 = g_n1.value,
                                                        .alpha_f = alpha,
                                                        .conserving = context.conserving,
                                                        .end_share = law.end_share});
    lambda = with_derivative<T>(force.value, force.slope * g_n1.normal);
    const V3<T> u = with_derivative<T>(dy, Mat3::Identity());
    const V3<T> mean = mean_normal<T>(law.normal, alpha, g_n, g_n1);
    V3<T> N = mean;
    if (context.conserving && dy.norm() > kNoDirection * law.normal.tolerance) {
      const V3<T> middle = alpha == 0.5 ? mean : mean_normal<T>(law.normal, 0.5, g_n, g_n1);
      const T change = with_derivative<T>(g_n1.value - g_n.value, g_n1.normal);
      N = N + ((change - dot(middle, u)) / dot(u, u)) * u;
    }
    h = lambda * N;
    if (!(contact::value(mean).norm() > 0.0)) return;  // around a sharp edge, from front to back
    const T length = norm(mean);
    pressure = lambda * length;
    if (law.mu == 0.0 || context.dt == 0.0) return;
    const V3<T> n = (T(1.0) / length) * mean;
    const V3<double> kept = contact::v3(Vec3(memory.bristle));
    contact::Cone<T> cone;
    cone.radius = (law.mu / law.bristle) * pressure;
    const V3<T> start = cone.nearest(kept - dot(n, kept) * n);
    slid = u - dot(n, u) * n;
    slips = cone.outside(contact::value(start + slid));
    bristle = cone.nearest(start + slid);
    friction = -law.bristle * cone.nearest(start + alpha * slid);
    h = h + friction;
  }
};

/// @eq{surface-action} @eq{contact-bristle}
SurfaceContact::Action SurfaceContact::act(const NodeStep& step, int point,
                                           const PointMemory& memory, bool tangent) const {
  Action a;
  a.phase = memory.phase;
  SurfaceLaw law = law_of(memory);
  const double reach = law.normal.reach();
  const LocalMotion place = this->place(step, point);
  const Vec3 way = place.at_n1 - place.at_n;
  // The value matters also where the gap is active only at the other end of the step.
  const GapQuery question{law.normal, law_.normal.reach() + way.norm(), sided(step)};
  const RigidSurface::Gap g_n1 = gap(place.at_n1, question);
  const RigidSurface::Gap g_n = way.isZero(0.0) ? g_n1 : gap(place.at_n, question);
  a.gap_n = g_n.value;
  a.gap_n1 = g_n1.value;
  if (g_n.value >= reach && g_n1.value >= reach) return a;
  a.acts = true;
  a.normal = g_n1.normal;
  if (step.context.conserving && step.context.dt > 0.0) {
    const bool open = a.phase.open() && g_n.value >= reach;
    a.phase = a.phase.in_step(law_, g_n.value,
                              open ? g_n.normal.dot(local_rate(step.x_n, step.v_n, point)) : 0.0);
    law = a.phase.law(law_);
  }
  if (step.context.dt == 0.0) {  // an instant
    a.lambda = law.normal.force(g_n1.value);
    a.pressure = a.lambda * g_n1.normal.norm();
    if (law_.mu > 0.0) a.friction = -law_.bristle * Vec3(memory.bristle);
    a.h = a.lambda * g_n1.normal + a.friction;
    a.slips = memory.slips != 0.0;
    return a;
  }
  if (!tangent) {
    const Terms<double> t(law, step, place, g_n, g_n1, memory, a.slips);
    a.h = contact::value(t.h);
    a.friction = contact::value(t.friction);
    a.bristle = contact::value(t.bristle);
    a.slid = contact::value(t.slid);
    a.lambda = t.lambda;
    a.pressure = t.pressure;
    return a;
  }
  const Terms<Dual> t(law, step, place, g_n, g_n1, memory, a.slips);
  a.h = contact::value(t.h);
  for (int j = 0; j < 3; ++j) a.D.col(j) << t.h.x.d[j], t.h.y.d[j], t.h.z.d[j];
  a.lambda = t.lambda.v;
  a.pressure = t.pressure.v;
  return a;
}

namespace {

/// Forces and stiffness between the point p and the four nodes of the frame, p first.
struct Central {
  Eigen::Matrix<double, 15, 1> f = Eigen::Matrix<double, 15, 1>::Zero();
  Eigen::Matrix<double, 15, 15> K = Eigen::Matrix<double, 15, 15>::Zero();
};

/// Central forces of y_k = (|p − x_0|² − |p − x_k|² + ℓ²)/(2ℓ): force Σ h_k ∂y_k at averaged
/// distances. @eq{surface-squared-distances}
Central central_forces(const Vec3& h, const Mat3* D, const Vec3 (&d_alpha)[4],
                       const Vec3 (&d_n1)[4], double size, double alpha_f) {
  using Columns = Eigen::Matrix<double, 15, 3>;
  const auto gradients = [&](const Vec3(&d)[4]) {
    Columns B = Columns::Zero();
    for (int k = 0; k < 3; ++k) {
      B.col(k).segment<3>(0) = (d[0] - d[k + 1]) / size;
      B.col(k).segment<3>(3) = -d[0] / size;
      B.col(k).segment<3>(6 + 3 * k) = d[k + 1] / size;
    }
    return B;
  };
  Central c;
  const Columns B = gradients(d_alpha);
  c.f = B * h;
  if (!D) return c;
  c.K = B * *D * gradients(d_n1).transpose();
  const auto add = [&](int row, int column, double value) {
    for (int i = 0; i < 3; ++i) c.K(3 * row + i, 3 * column + i) += alpha_f / size * value;
  };
  for (int k = 0; k < 3; ++k) {
    add(0, 1, -h[k]);  // p: δd_0 − δd_k
    add(0, 2 + k, h[k]);
    add(1, 0, -h[k]);  // x_0: −δd_0
    add(1, 1, h[k]);
    add(2 + k, 0, h[k]);  // x_k: δd_k
    add(2 + k, 2 + k, -h[k]);
  }
  return c;
}

}  // namespace

ElementReport SurfaceContact::evaluate(const NodeStep& step, const double* history,
                                       double* /*scratch*/, const Mat3& /*turn*/,
                                       const ElementSink& sink) const {
  const bool tangent = sink.tangent != nullptr;
  const int width = 3 * (n_ + frame_);
  constexpr std::size_t kWidth = 3 * (SurfacePoints::kMaxNodes + 4);
  std::array<double, kWidth> f;
  std::array<double, kWidth * kWidth> K;
  for (int i = 0; i < size(); ++i) {
    const SurfacePoints::Point& point = points_.points[static_cast<std::size_t>(i)];
    const Action a = act(step, i, memory_of(history, i), tangent);
    if (!a.acts) continue;
    Central c;
    if (frame_ == 0) {
      const Mat3& R = place_.axes;
      c.f.head<3>() = R * a.h;
      if (tangent) c.K.topLeftCorner<3, 3>() = R * a.D * R.transpose();
    } else {
      Vec3 d_alpha[4], d_n1[4];
      for (std::size_t k = 0; k < 4; ++k) {
        d_n1[k] = position(step.x_n1, i) - at(step.x_n1, place_.nodes[k]);
        d_alpha[k] =
            (1.0 - step.alpha_f) * (position(step.x_n, i) - at(step.x_n, place_.nodes[k])) +
            step.alpha_f * d_n1[k];
      }
      c = central_forces(a.h, tangent ? &a.D : nullptr, d_alpha, d_n1, place_.size, step.alpha_f);
    }
    // From (p, frame) to (nodes of the face, frame): p = Σ N_a x_a.
    const auto spread = [&](int node) -> std::pair<int, double> {
      return node < n_ ? std::pair(0, point.N[node]) : std::pair(node - n_ + 1, 1.0);
    };
    for (int p = 0; p < n_ + frame_; ++p) {
      const auto [from, N] = spread(p);
      for (int r = 0; r < 3; ++r) f[3 * p + r] = point.area * N * c.f[3 * from + r];
      if (!tangent) continue;
      for (int q = 0; q < n_ + frame_; ++q) {
        const auto [by, M] = spread(q);
        for (int r = 0; r < 3; ++r)
          for (int s = 0; s < 3; ++s)
            K[(3 * p + r) * width + 3 * q + s] = point.area * N * M * c.K(3 * from + r, 3 * by + s);
      }
    }
    sink.add_force(nodes(i), f.data());
    if (tangent) sink.add_tangent(i, n_ + frame_, K.data());
  }
  return {};
}

}  // namespace polhode::surface_contact
