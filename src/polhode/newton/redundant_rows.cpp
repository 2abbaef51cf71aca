// SPDX-License-Identifier: Apache-2.0
#include <polhode/newton/redundant_rows.hpp>

namespace polhode {

RedundantRows::RedundantRows(const linear::KktTopology& topology, double length)
    : topology_(&topology), solver_(linear::make_linear_solver("block_lu")) {
  solver_->analyse(topology);
  Mat6 metric = Mat6::Identity();
  metric.bottomRightCorner<3, 3>() *= length * length;
  values_.diagonal.assign(static_cast<std::size_t>(topology.bodies), metric);
  values_.pairs.resize(topology.pairs.size());
  for (linear::KktValues::Pair& v : values_.pairs) {
    v.K_ab.setZero();
    v.K_ba.setZero();
    v.G_a.setZero();
    v.G_b.setZero();
    v.B_a.setZero();
    v.B_b.setZero();
    v.C.setZero();
  }
  g_ = Vec::Zero(topology.rows);
  rhs_ = x_ = Vec::Zero(6 * topology.bodies + topology.rows);
}

void RedundantRows::put(int pair, const PairTerms& terms) {
  const linear::KktPair& own = topology_->pairs[static_cast<std::size_t>(pair)];
  linear::KktValues::Pair& v = values_.pairs[static_cast<std::size_t>(pair)];
  v.G_a = terms.G_a;
  v.G_b = terms.G_b;
  for (int k = 0; k < own.rows; ++k) {
    v.C[k] = kLeastProximal * terms.weight[k];
    g_[own.first_row + k] = terms.g[k];
    if (terms.compliance[k] == 0.0) continue;
    v.C[k] = 1.0;
    g_[own.first_row + k] = 0.0;
    v.G_a.row(k).setZero();
    v.G_b.row(k).setZero();
  }
  v.B_a = v.G_a.transpose();
  v.B_b = v.G_b.transpose();
}

void RedundantRows::put(const RedundantRows& others, const std::vector<char>& has_centre) {
  g_ = others.g_;
  values_.pairs = others.values_.pairs;
  for (std::size_t p = 0; p < has_centre.size(); ++p)
    if (has_centre[p] == 0) values_.pairs[p].C.setZero();
}

void RedundantRows::add_rows_times(const Vec& all, double factor, Eigen::Ref<Vec> out) const {
  for (std::size_t p = 0; p < topology_->pairs.size(); ++p) {
    const linear::KktPair& own = topology_->pairs[p];
    const linear::KktValues::Pair& v = values_.pairs[p];
    for (int k = 0; k < own.rows; ++k) {
      double sum = 0.0;
      if (own.a != kGround) sum += v.G_a.row(k).dot(all.segment<6>(6 * own.a));
      if (own.b != kGround) sum += v.G_b.row(k).dot(all.segment<6>(6 * own.b));
      out[own.first_row + k] += factor * sum;
    }
  }
}

void RedundantRows::add_columns_times(const Eigen::Ref<const Vec>& rows, Vec& out) const {
  for (std::size_t p = 0; p < topology_->pairs.size(); ++p) {
    const linear::KktPair& own = topology_->pairs[p];
    const linear::KktValues::Pair& v = values_.pairs[p];
    for (int k = 0; k < own.rows; ++k) {
      const double y = rows[own.first_row + k];
      if (own.a != kGround) out.segment<6>(6 * own.a) += y * v.G_a.row(k).transpose();
      if (own.b != kGround) out.segment<6>(6 * own.b) += y * v.G_b.row(k).transpose();
    }
  }
}

/// M x − Gᵀ y = −Gᵀ of,  G x + εW y = 0,  refined once, as rounding of the redundant part of y is
/// divided by ε. @eq{redundant-part}
void RedundantRows::redundant_part(const Eigen::Ref<const Vec>& of, Eigen::Ref<Vec> out) {
  const int rows = topology_->rows, first = 6 * topology_->bodies;
  x_.setZero();
  for (int pass = 0; pass < 2; ++pass) {
    rhs_.setZero();
    out = x_.tail(rows) - of;
    add_columns_times(out, rhs_);
    for (int b = 0; b < topology_->bodies; ++b)
      rhs_.segment<6>(6 * b) -=
          values_.diagonal[static_cast<std::size_t>(b)].diagonal().cwiseProduct(
              x_.segment<6>(6 * b));
    add_rows_times(x_, -1.0, rhs_.tail(rows));
    for (std::size_t p = 0; p < topology_->pairs.size(); ++p)
      for (int k = 0; k < topology_->pairs[p].rows; ++k) {
        const int r = first + topology_->pairs[p].first_row + k;
        rhs_[r] -= values_.pairs[p].C[k] * x_[r];
      }
    solver_->solve(rhs_);
    x_ += rhs_;
  }
  out = of - x_.tail(rows);
  for (std::size_t p = 0; p < topology_->pairs.size(); ++p)
    for (int k = 0; k < topology_->pairs[p].rows; ++k)
      if (values_.pairs[p].C[k] == 1.0) out[topology_->pairs[p].first_row + k] = 0.0;
}

/// g − G x for the least squares x, in two proximal iterations.
void RedundantRows::unreachable_part(Eigen::Ref<Vec> out) {
  out = g_;
  for (int pass = 0; pass < 2; ++pass) {
    rhs_.setZero();
    rhs_.tail(topology_->rows) = out;
    solver_->solve(rhs_);
    add_rows_times(rhs_, -1.0, out);
  }
}

}  // namespace polhode
