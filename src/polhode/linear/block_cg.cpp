// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include <polhode/linear/block_cg_blocks.hpp>

namespace polhode::linear {

namespace {

/// Inverse of a symmetric matrix, by cofactors. @returns false if it is not positive definite.
bool invert(const Mat3& M, Mat3& inverse) {
  const double a = M(0, 0), b = M(1, 0), c = M(2, 0), d = M(1, 1), e = M(2, 1), f = M(2, 2);
  const double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d, minor = a * d - b * b;
  const double det = a * A + b * B + c * C;
  if (!(a > 0.0 && minor > 0.0 && det > 0.0)) return false;
  const double s = 1.0 / det;
  const double D = a * f - c * c, E = b * c - a * e;
  inverse << s * A, s * B, s * C, s * B, s * D, s * E, s * C, s * E, s * minor;
  return true;
}

}  // namespace

/// Adds Pᵀ C P with P = [I, −arm^].
inline void BlockCg::add(const Spring& spring, Four arm, Block& block) {
  const Four *C = spring.C, turned[3] = {cross(arm, C[0]), cross(arm, C[1]), cross(arm, C[2])};
  // Column j of −C arm^ is C (e_j × arm).
  const Four back[3] = {arm[1] * C[2] - arm[2] * C[1], arm[2] * C[0] - arm[0] * C[2],
                        arm[0] * C[1] - arm[1] * C[0]};
  for (int j = 0; j < 3; ++j) {
    block.column[j].moved += C[j];
    block.column[j].turned += turned[j];
    block.column[3 + j].moved += back[j];
    block.column[3 + j].turned += cross(arm, back[j]);
  }
}

/// [A, Bᵀ; B, D]⁻¹ by the Schur complement of A. @returns false if it is not positive definite.
bool BlockCg::invert(const Block& block, Mat6& inverse) {
  Mat3 A, B, D, inverse_A, inverse_S;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      A(i, j) = block.column[j].moved[i];
      B(i, j) = block.column[j].turned[i];
      D(i, j) = block.column[3 + j].turned[i];
    }
  if (!linear::invert(A, inverse_A)) return false;
  const Mat3 X = B * inverse_A;
  if (!linear::invert(D - X * B.transpose(), inverse_S)) return false;
  const Mat3 Y = inverse_S * X;
  inverse.topLeftCorner<3, 3>() = inverse_A + X.transpose() * Y;
  inverse.bottomLeftCorner<3, 3>() = -Y;
  inverse.topRightCorner<3, 3>() = -Y.transpose();
  inverse.bottomRightCorner<3, 3>() = inverse_S;
  return true;
}

bool BlockCg::invert(const Block& block, Block& inverse) {
  Mat6 precise;
  if (!invert(block, precise)) return false;
  narrow(precise, inverse);
  return true;
}

bool BlockCg::set_bodies(std::span<const Mat6> blocks) {
  double moving = 0.0, turning = 0.0;
  for (const Mat6& B : blocks) {
    moving = std::max(moving, B.topLeftCorner<3, 3>().trace());
    turning = std::max(turning, B.bottomRightCorner<3, 3>().trace());
  }
  if (!blocks.empty() && !(moving > 0.0 && turning > 0.0)) return false;
  per_length_ = 1.0 / std::sqrt(moving);
  per_turn_ = 1.0 / std::sqrt(turning);
  own_.resize(blocks.size());
  own_inverse_.resize(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (!scale_body(blocks[b], own_[b], own_inverse_[b])) return false;
  return true;
}

bool BlockCg::scale_body(const Mat6& from, Block& block, Block& inverse) const {
  for (int j = 0; j < 6; ++j) {
    const double scale = j < 3 ? per_length_ : per_turn_;
    Pair& to = block.column[j];
    to = Pair{};
    for (int i = 0; i < 3; ++i) {
      const auto half = [&](int k) { return 0.5 * (from(k, j) + from(j, k)); };
      to.moved[i] = static_cast<float>(per_length_ * scale * half(i));
      to.turned[i] = static_cast<float>(per_turn_ * scale * half(3 + i));
    }
  }
  return invert(block, inverse);
}

bool BlockCg::update_bodies(std::span<const int> bodies, std::span<const Mat6> blocks) {
  for (const int b : bodies)
    if (!scale_body(blocks[b], own_[b], own_inverse_[b])) return false;
  return true;
}

void BlockCg::set_springs(std::span<const ActingPoint> points, std::span<const int> moving) {
  const double squared = per_length_ * per_length_, ratio = per_turn_ / per_length_;
  const auto four = [](const auto& x, double s) {
    return Four{static_cast<float>(s * x[0]), static_cast<float>(s * x[1]),
                static_cast<float>(s * x[2]), 0.0f};
  };
  const auto count = static_cast<int>(moving.size());
  moving_.assign(moving.begin(), moving.end());
  place_.assign(own_.size(), count);
  block_.resize(moving.size());
  for (int k = 0; k < count; ++k) {
    place_[moving[k]] = k;
    block_[k] = own_[moving[k]];
  }
  diagonal_ = block_;
  eliminated_ = false;
  group_of_.assign(moving_.size(), -1);
  groups_.clear();
  springs_.clear();
  friction_.clear();
  ties_.clear();
  rows_.clear();
  for (const ActingPoint& point : points) {
    const ContactSpring& from = point.spring;
    Spring s;
    s.a = from.a == kGround ? count : place_[from.a];
    s.b = from.b == kGround ? count : place_[from.b];
    if (s.a == count && s.b == count) continue;
    for (int j = 0; j < 3; ++j) s.C[j] = four(from.C.col(j), squared);
    s.arm_a = four(from.arm_a, ratio);
    s.arm_b = four(from.arm_b, ratio);
    if (s.a != count) add(s, s.arm_a, diagonal_[s.a]);
    if (s.b != count) add(s, s.arm_b, diagonal_[s.b]);
    springs_.push_back(s);
    if (!from.friction_slope.isZero(0.0))
      friction_.push_back(
          {four(from.friction_slope, squared), four(from.normal, 1.0), s.arm_a, s.arm_b, s.a, s.b});
  }
}

/// Inverse of a body's pivot, or of another positive definite block where the pivot is lost in
/// rounding, as that of a body with springs far stiffer than its own block. @returns it precisely;
/// inverse_ has it rounded.
Mat6 BlockCg::invert_pivot(std::size_t k) {
  Mat6 inverse;
  if (!invert(pivot(k), inverse) && !invert(diagonal_[k], inverse)) {
    inverse_[k] = own_inverse_[moving_[k]];
    return widened(inverse_[k]);
  }
  narrow(inverse, inverse_[k]);
  return inverse;
}

/// Sorts the springs by body, and each body's into those to bodies swept before it and after it.
/// Springs within a group take no part in the sweeps.
void BlockCg::sort_neighbours() {
  const auto n = static_cast<int>(block_.size());
  const auto turn = [&](int k) { return group_of_[k] < 0 ? k : n + group_of_[k]; };
  const auto counts = [&](const Spring& s) {
    return s.a != n && s.b != n && turn(s.a) != turn(s.b);
  };
  first_.assign(block_.size() + 1, 0);
  for (const Spring& s : springs_)
    if (counts(s)) ++first_[s.a], ++first_[s.b];
  for (int k = 0, sum = 0; k <= n; ++k) {
    const int count = first_[k];
    first_[k] = sum;
    sum += count;
  }
  neighbours_.resize(first_[block_.size()]);
  later_.assign(first_.begin(), first_.end() - 1);
  const auto put = [&](const Spring& s, int own, int other, Four arm, Four other_arm) {
    neighbours_[later_[own]++] = {{s.C[0], s.C[1], s.C[2]}, arm, other_arm, other};
  };
  for (const bool larger : {false, true})  // turns
    for (const Spring& s : springs_) {
      if (!counts(s)) continue;
      if ((turn(s.b) > turn(s.a)) == larger) put(s, s.a, s.b, s.arm_a, s.arm_b);
      if ((turn(s.a) > turn(s.b)) == larger) put(s, s.b, s.a, s.arm_b, s.arm_a);
    }
  for (int k = 0; k < n; ++k) {
    later_[k] = first_[k];
    while (later_[k] < first_[k + 1] && turn(neighbours_[later_[k]].other) < turn(k)) ++later_[k];
  }
}

/// Pivot D_k = A_kk − Σ A_kj D_j⁻¹ A_jk over the bodies j without rows that are swept before k.
/// @eq{cg-sweeps}
BlockCg::Block BlockCg::pivot(std::size_t k) const {
  Block pivot = diagonal_[k];
  for (int i = first_[k]; i < later_[k]; ++i) {
    const Neighbour& s = neighbours_[i];
    if (group_of_[s.other] >= 0) continue;
    // C W C, with W the compliance of the other body at the point; several points between the
    // same bodies count one by one.
    const Block& Y = inverse_[s.other];
    Spring t;
    Four by_force[3];
    for (int j = 0; j < 3; ++j) {
      Pair unit{};
      unit.moved = s.C[j];
      unit.turned = cross(s.other_arm, s.C[j]);
      const Pair x = times(Y, unit);
      by_force[j] = x.moved + cross(x.turned, s.other_arm);
    }
    for (int j = 0; j < 3; ++j)
      t.C[j] = -(by_force[j][0] * s.C[0] + by_force[j][1] * s.C[1] + by_force[j][2] * s.C[2]);
    add(t, s.arm, pivot);
  }
  return pivot;
}

/// Inverts the pivots of bodies without rows.
void BlockCg::eliminate() {
  eliminated_ = true;
  sort_neighbours();
  inverse_.resize(diagonal_.size());
  for (std::size_t k = 0; k < diagonal_.size(); ++k)
    if (group_of_[k] < 0) invert_pivot(k);
}

/// z += P left_ on the bodies of a group, with P = M⁻¹ − M⁻¹ Gᵀ Q⁻¹ G M⁻¹.
void BlockCg::add_solution(const Group& group, Vectors& z) {
  if (group.inverse.empty()) {
    project(group, left_, nullptr);
    for (const int k : group.bodies) add(times(inverse_[k], left_[k]), z[k]);
    return;
  }
  const Block* block = group.inverse.data();
  for (const int k : group.bodies)
    for (const int j : group.bodies) add(times(*block++, left_[j]), z[k]);
}

double BlockCg::precondition(const Vectors& r, Vectors& z) {
  const std::size_t n = diagonal_.size();
  double product = 0.0;
  const auto subtract = [&](const Neighbour& s, Pair& from) {  // off-diagonal blocks are negative
    const Pair& x = z[s.other];
    const Four u = x.moved + cross(x.turned, s.other_arm);
    const Four F = u[0] * s.C[0] + u[1] * s.C[1] + u[2] * s.C[2];
    from.moved += F;
    from.turned += cross(s.arm, F);
  };
  const auto before = [&](std::size_t k) {
    Pair left = r[k];
    for (int i = first_[k]; i < later_[k]; ++i) subtract(neighbours_[i], left);
    return left;
  };
  const auto after = [&](std::size_t k) {
    Pair left{};
    for (int i = later_[k]; i < first_[k + 1]; ++i) subtract(neighbours_[i], left);
    return left;
  };
  for (std::size_t k = 0; k < n; ++k)
    if (group_of_[k] < 0) z[k] = times(inverse_[k], before(k));
  for (const Group& group : groups_) {
    for (const int k : group.bodies) {
      left_[k] = before(k);
      z[k] = Pair{};
    }
    add_solution(group, z);
  }
  for (std::size_t g = groups_.size(); g-- > 0;) {
    const Group& group = groups_[g];
    if (group.touches_later_one) {
      for (const int k : group.bodies) left_[k] = after(k);
      add_solution(group, z);
    }
    for (const int k : group.bodies) product += dot(r[k], z[k]);
  }
  for (std::size_t k = n; k-- > 0;) {
    if (group_of_[k] >= 0) continue;
    if (later_[k] < first_[k + 1]) add(times(inverse_[k], after(k)), z[k]);
    product += dot(r[k], z[k]);
  }
  return product;
}

/// y = A p. Fixed bodies have a part of p that is zero, and a part of y that is not used.
void BlockCg::multiply() {
  for (std::size_t k = 0; k < block_.size(); ++k) y_[k] = times(block_[k], p_[k]);
  for (const Spring& s : springs_) {
    const Pair &a = p_[s.a], &b = p_[s.b];
    const Four u = (a.moved - b.moved) + (cross(a.turned, s.arm_a) - cross(b.turned, s.arm_b));
    const Four F = u[0] * s.C[0] + u[1] * s.C[1] + u[2] * s.C[2];
    y_[s.a].moved += F;
    y_[s.a].turned += cross(s.arm_a, F);
    y_[s.b].moved -= F;
    y_[s.b].turned -= cross(s.arm_b, F);
  }
  for (const ScaledTie& t : ties_) {
    const Pair on_a = times(t.ab, p_[t.b]), on_b = times(t.ba, p_[t.a]);
    add(on_a, y_[t.a]);
    add(on_b, y_[t.b]);
  }
}

double BlockCg::scale(std::span<const Vec6> rhs, double least, Vectors& b) const {
  // Scaled, since forces of any unit have to fit into single precision.
  double size = least;
  for (const int body : moving_) {
    const Vec6& f = rhs[body];
    size = std::max(size, per_length_ * f.head<3>().lpNorm<Eigen::Infinity>());
    size = std::max(size, per_turn_ * f.tail<3>().lpNorm<Eigen::Infinity>());
  }
  if (!(size > 0.0) || !std::isfinite(size)) return 0.0;
  const double by_length = per_length_ / size, by_turn = per_turn_ / size;
  b.assign(moving_.size(), Pair{});
  for (std::size_t k = 0; k < moving_.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      b[k].moved[i] = static_cast<float>(by_length * rhs[moving_[k]][i]);
      b[k].turned[i] = static_cast<float>(by_turn * rhs[moving_[k]][3 + i]);
    }
  return size;
}

void BlockCg::unscale(const Vectors& from, double size, std::vector<Vec6>& x) const {
  const double length = per_length_ * size, turn = per_turn_ * size;
  for (std::size_t k = 0; k < moving_.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      x[moving_[k]][i] = length * from[k].moved[i];
      x[moving_[k]][3 + i] = turn * from[k].turned[i];
    }
}

int BlockCg::iterate(const Vectors& b, double part, int most) {
  const std::size_t n = moving_.size();
  const Pair zero{};
  x_.assign(n, zero);
  r_ = b;
  z_.resize(n);
  left_.resize(n);
  p_.assign(n + 1, zero);
  y_.assign(n + 1, zero);
  carried_.setZero();
  project(r_);
  double rz = precondition(r_, z_);
  std::copy(z_.begin(), z_.end(), p_.begin());
  const double enough = part * rz;
  int iterations = 0;
  while (iterations < most && rz > enough) {
    ++iterations;
    multiply();
    double curvature = 0.0;
    for (std::size_t k = 0; k < n; ++k) curvature += dot(p_[k], y_[k]);
    if (!(curvature > 0.0)) break;
    const auto alpha = static_cast<float>(rz / curvature);
    for (std::size_t k = 0; k < n; ++k) {
      x_[k].moved += alpha * p_[k].moved;
      x_[k].turned += alpha * p_[k].turned;
      r_[k].moved -= alpha * y_[k].moved;
      r_[k].turned -= alpha * y_[k].turned;
    }
    project(r_);
    const double next = precondition(r_, z_);
    const auto beta = static_cast<float>(next / rz);
    rz = next;
    for (std::size_t k = 0; k < n; ++k) {
      p_[k].moved = z_[k].moved + beta * p_[k].moved;
      p_[k].turned = z_[k].turned + beta * p_[k].turned;
    }
  }
  return iterations;
}

int BlockCg::solve(std::span<const Vec6> rhs, std::vector<Vec6>& x, double part, int most,
                   int directions) {
  x.assign(rhs.size(), Vec6::Zero());
  multipliers_.setZero(static_cast<Eigen::Index>(rows_.size()));
  const double size = scale(rhs, force_of_rows(), basis_[0]);
  if (size == 0.0) return 0;
  if (!eliminated_) eliminate();
  const Vectors asked = rows_.empty() ? Vectors{} : fulfil_rows(size, basis_[0]);
  const int iterations =
      friction_.empty() || directions == 0
          ? iterate(basis_[0], part, most)
          : iterate_with_friction(part, most, std::min(directions, kMaxDirections));
  for (std::size_t k = 0; k < asked.size(); ++k) add(asked[k], x_[k]);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    multipliers_[rows_[i].number] = -size * rows_[i].scale * carried_[static_cast<Eigen::Index>(i)];
  unscale(x_, size, x);
  return iterations;
}

void BlockCg::subtract_friction(const Vectors& p, Vectors& y) const {
  for (const FrictionTerm& s : friction_) {
    const Pair &a = p[s.a], &b = p[s.b];
    const Four u = (a.moved - b.moved) + (cross(a.turned, s.arm_a) - cross(b.turned, s.arm_b));
    const Four n = s.normal * u, F = (n[0] + n[1] + n[2]) * s.force;
    y[s.a].moved -= F;
    y[s.a].turned -= cross(s.arm_a, F);
    y[s.b].moved += F;
    y[s.b].turned += cross(s.arm_b, F);
  }
}

/// Flexible GMRES (Saad, SIAM J. Sci. Comput. 14, 1993) for S − U: S z is the vector v to which
/// conjugate gradients were applied.
int BlockCg::iterate_with_friction(double part, int most, int directions) {
  const std::size_t n = moving_.size();
  const auto product = [n](const Vectors& p, const Vectors& q) {
    double sum = 0.0;
    for (std::size_t k = 0; k < n; ++k) sum += dot(p[k], q[k]);
    return sum;
  };
  const auto add_times = [n](double factor, const Vectors& p, Vectors& to) {
    const auto s = static_cast<float>(factor);
    for (std::size_t k = 0; k < n; ++k) {
      to[k].moved += s * p[k].moved;
      to[k].turned += s * p[k].turned;
    }
  };
  carried_.setZero();
  project(basis_[0]);
  const double length = std::sqrt(product(basis_[0], basis_[0]));
  add_times(1.0 / length - 1.0, basis_[0], basis_[0]);
  const Vec before = carried_;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(directions + 1, directions);
  Eigen::VectorXd weights;
  std::vector<Vec> carried;
  int iterations = 0;
  for (int j = 0; j < directions; ++j) {
    iterations += iterate(basis_[j], part, most);
    Vectors& w = basis_[j + 1];
    w = basis_[j];
    add_times(-1.0, r_, w);
    x_.resize(n + 1);
    w.resize(n + 1);
    x_.back() = Pair{};
    subtract_friction(x_, w);
    w.resize(n);
    found_[j] = x_;
    if (!rows_.empty()) {  // w includes their multipliers
      Vec of_both = carried_;
      carried_.setZero();
      project(w);
      carried.push_back(of_both - carried_);
    }
    for (int i = 0; i <= j; ++i) {
      H(i, j) = product(basis_[i], w);
      add_times(-H(i, j), basis_[i], w);
    }
    H(j + 1, j) = std::sqrt(product(w, w));
    const Eigen::MatrixXd so_far = H.topLeftCorner(j + 2, j + 1);
    const Eigen::VectorXd start = length * Eigen::VectorXd::Unit(j + 2, 0);
    weights = so_far.colPivHouseholderQr().solve(start);
    const double left = (so_far * weights - start).squaredNorm();
    if (!(left > part * length * length) || !(H(j + 1, j) > 0.0)) break;
    add_times(1.0 / H(j + 1, j) - 1.0, w, w);
  }
  x_.assign(n, Pair{});
  carried_ = before;
  for (int j = 0; j < weights.size(); ++j) {
    add_times(weights[j], found_[j], x_);
    if (!rows_.empty()) carried_ += weights[j] * carried[static_cast<std::size_t>(j)];
  }
  return iterations;
}

}  // namespace polhode::linear
