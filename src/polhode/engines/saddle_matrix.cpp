// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/engines/saddle_matrix.hpp>
#include <polhode/math/hat.hpp>

namespace polhode {

namespace {

/// Part of the largest row below which a row may be rounding alone.
constexpr double kNoise = 1e-12;

}  // namespace

SaddleMatrix::SaddleMatrix(const System& system, const linear::KktTopology& topology)
    : system_(&system), topology_(topology), rows_(topology.rows) {
  const Nodes& nodes = system.nodes();
  movable_ = 6 * system.body_count() + nodes.unknowns();
  carrier_.resize(nodes.count());
  arm_.assign(nodes.count(), Vec3::Zero());
  for (int i = 0; i < nodes.count(); ++i) {
    Carrier& c = carrier_[i];
    c.P.setZero();
    if (nodes[i].body >= 0) {
      c.count = 6;
      for (int k = 0; k < 6; ++k) c.unknown[k] = 6 * nodes[i].body + k;
      c.P.leftCols<3>().setIdentity();
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      const int u = unknown(i, k);
      if (u < 0) continue;
      c.unknown[c.count] = u;
      c.P(k, c.count++) = 1.0;
    }
  }
  find_entries();
}

void SaddleMatrix::find_entries() {
  for (std::vector<int>* list : {&row_, &column_, &lower_row_, &lower_column_}) list->clear();
  for_each(nullptr, nullptr, nullptr, 1.0, [&](int i, int j, double) {
    row_.push_back(i);
    column_.push_back(j);
    lower_row_.push_back(std::max(i, j));
    lower_column_.push_back(std::min(i, j));
  });
  values_.resize(row_.size());
  lower_.resize(row_.size());
}

bool SaddleMatrix::set_moving(const NodeBlocks& moving) {
  if (moving_ == moving) return false;
  moving_ = moving;
  find_entries();
  return true;
}

/// Calls put(row, column, value) for every entry, in an order that depends on the model alone.
template <class Put>
void SaddleMatrix::for_each(const linear::KktValues* bodies, const std::vector<double>* blocks,
                            const double* forces, double s, Put&& put) const {
  const Nodes& nodes = system_->nodes();
  for (int b = 0; b < topology_.bodies; ++b)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        put(6 * b + i, 6 * b + j, bodies ? bodies->diagonal[b](i, j) : 0.0);
  for (std::size_t p = 0; p < topology_.pairs.size(); ++p) {
    const linear::KktPair& pair = topology_.pairs[p];
    const linear::KktValues::Pair* v = bodies ? &bodies->pairs[p] : nullptr;
    if (pair.a != kGround && pair.b != kGround)
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) {
          put(6 * pair.a + i, 6 * pair.b + j, v ? v->K_ab(i, j) : 0.0);
          put(6 * pair.b + i, 6 * pair.a + j, v ? v->K_ba(i, j) : 0.0);
        }
    for (int k = 0; k < pair.rows; ++k) {
      const int row = movable_ + pair.first_row + k;
      for (int i = 0; i < 6; ++i) {
        if (pair.a != kGround) {
          put(6 * pair.a + i, row, v ? -v->B_a(i, k) : 0.0);
          put(row, 6 * pair.a + i, v ? -v->G_a(k, i) : 0.0);
        }
        if (pair.b != kGround) {
          put(6 * pair.b + i, row, v ? -v->B_b(i, k) : 0.0);
          put(row, 6 * pair.b + i, v ? -v->G_b(k, i) : 0.0);
        }
      }
      put(row, row, v ? -v->C[k] : 0.0);
    }
  }
  using Block = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;
  const auto put_block = [&](int i, int j, std::size_t k) {
    const Carrier &a = carrier_[i], &b = carrier_[j];
    if (a.count == 0 || b.count == 0) return;
    Mat6 K = Mat6::Zero();
    if (blocks && 9 * k < blocks->size())
      K = s * a.P.transpose() * Block(blocks->data() + 9 * k) * b.P;
    for (int r = 0; r < a.count; ++r)
      for (int c = 0; c < b.count; ++c) put(a.unknown[r], b.unknown[c], K(r, c));
  };
  for (int i = 0; i < nodes.count(); ++i) {
    const Carrier& a = carrier_[i];
    if (a.count == 0) continue;
    for (int k = nodes.row_start()[i]; k < nodes.row_start()[i + 1]; ++k)
      put_block(i, nodes.column()[k], static_cast<std::size_t>(k));
    if (nodes[i].body < 0) continue;
    Mat3 D = Mat3::Zero();  // The lever arm rotates as well. @eq{ga-z-tangent}
    if (forces) D = s * hat(Eigen::Map<const Vec3>(forces + 3 * i)) * hat(arm_[i]);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) put(a.unknown[3 + r], a.unknown[3 + c], D(r, c));
  }
  for (std::size_t k = 0; k < moving_.row.size(); ++k)
    put_block(moving_.row[k], moving_.column[k], nodes.column().size() + k);
}

void SaddleMatrix::place(const Trial& trial) {
  const Nodes& nodes = system_->nodes();
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes[i].body < 0) continue;
    const int slot = system_->slot(nodes[i].body), lane = slot % kLanes;
    const TrialBlock& t = trial.blocks[slot / kLanes];
    for (int r = 0; r < 3; ++r) {
      arm_[i][r] = 0.0;
      for (int c = 0; c < 3; ++c) arm_[i][r] += t.Lambda[3 * r + c][lane] * nodes[i].Z[c];
    }
    carrier_[i].P.rightCols<3>() = -hat(arm_[i]);
  }
}

void SaddleMatrix::set(const linear::KktValues& bodies, const std::vector<double>& blocks,
                       const double* forces, double s) {
  std::size_t next = 0;
  for_each(&bodies, &blocks, forces, s, [&](int, int, double x) { values_[next++] = x; });
}

void SaddleMatrix::combine(const SaddleMatrix& A, double factor, const SaddleMatrix& B) {
  for (std::size_t k = 0; k < values_.size(); ++k)
    values_[k] = A.values_[k] + factor * B.values_[k];
}

void SaddleMatrix::hold_point_masses(double stiffness) {
  for (int b = 0; b < topology_.bodies; ++b)
    for (int i = 3; i < 6 && system_->bodies()[b].point_mass; ++i)
      values_[36 * std::size_t(b) + 7 * std::size_t(i)] += stiffness;
}

/// @eq{statics-hessian}
void SaddleMatrix::make_hessian(const std::vector<Vec6>& moments) {
  for (int b = 0; b < topology_.bodies; ++b) {
    const Mat3 half = 0.5 * hat(Vec3(moments[b].tail<3>()));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) values_[36 * std::size_t(b) + 6 * (3 + i) + 3 + j] += half(i, j);
  }
}

const std::vector<double>& SaddleMatrix::lower_values() {
  for (std::size_t k = 0; k < values_.size(); ++k)
    lower_[k] = row_[k] == column_[k] ? values_[k] : 0.5 * values_[k];
  return lower_;
}

double SaddleMatrix::asymmetry() const {
  // (A − Aᵀ) x with unrelated numbers x.
  Vec left = Vec::Zero(size()), size_of = Vec::Zero(size());
  const auto x = [](int i) { return 1.0 + 0.5 * std::sin(1.0 + 7.3 * i); };
  for (std::size_t k = 0; k < values_.size(); ++k) {
    left[row_[k]] += values_[k] * x(column_[k]);
    left[column_[k]] -= values_[k] * x(row_[k]);
    size_of[row_[k]] += std::abs(values_[k]);
  }
  const double largest = size_of.size() > 0 ? size_of.maxCoeff() : 0.0;
  double worst = 0.0;
  for (int i = 0; i < size(); ++i)  // rows of rounding alone do not count
    if (size_of[i] > kNoise * largest) worst = std::max(worst, std::abs(left[i]) / size_of[i]);
  return worst;
}

void SaddleMatrix::times(const Vec& x, Vec& y) const {
  y.setZero(size());
  for (std::size_t k = 0; k < values_.size(); ++k) y[row_[k]] += values_[k] * x[column_[k]];
}

void SaddleMatrix::magnitudes(const Vec& x, Vec& y) const {
  y.setZero(size());
  for (std::size_t k = 0; k < values_.size(); ++k)
    y[row_[k]] += std::abs(values_[k] * x[column_[k]]);
}

void SaddleMatrix::gather(const std::vector<double>& F, double factor, Vec& y) const {
  for (std::size_t i = 0; i < carrier_.size(); ++i) {
    const Carrier& c = carrier_[i];
    const Vec6 f = factor * c.P.transpose() * Eigen::Map<const Vec3>(F.data() + 3 * i);
    for (int k = 0; k < c.count; ++k) y[c.unknown[k]] += f[k];
  }
}

void SaddleMatrix::expand(const Vec& x, std::vector<double>& du) const {
  du.assign(3 * carrier_.size(), 0.0);
  for (std::size_t i = 0; i < carrier_.size(); ++i) {
    const Carrier& c = carrier_[i];
    Eigen::Map<Vec3> d(du.data() + 3 * i);
    for (int k = 0; k < c.count; ++k) d += x[c.unknown[k]] * c.P.col(k);
  }
}

}  // namespace polhode
