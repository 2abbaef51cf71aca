// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/assert.hpp>
#include <polhode/equations/node_condensation.hpp>

namespace polhode {

namespace {

using Block = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>;

Mat3 lane_matrix(const double (&x)[9][kLanes], int lane) {
  Mat3 M;
  for (int i = 0; i < 9; ++i) M(i / 3, i % 3) = x[i][lane];
  return M;
}

Mat3 Lambda_n1(const System& system, const Trial& trial, int body) {
  const int slot = system.slot(body);
  return lane_matrix(trial.blocks[slot / kLanes].Lambda, slot % kLanes);
}

/// [I, −ẑ]: increment of a bonded point by that of its body.
Eigen::Matrix<double, 3, 6> carried(const Vec3& z) {
  Eigen::Matrix<double, 3, 6> P;
  P << Mat3::Identity(), -hat(z);
  return P;
}

Vec6 turned(const Mat3& Q, const Vec6& x) {
  Vec6 y;
  y << Q * x.head<3>(), Q * x.tail<3>();
  return y;
}

Mat6 turned(const Mat3& Q, const Mat6& A) {
  Mat6 B;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      B.block<3, 3>(3 * i, 3 * j) = Q * A.block<3, 3>(3 * i, 3 * j) * Q.transpose();
  return B;
}

}  // namespace

NodeCondensation::NodeCondensation(const System& system) : system_(&system) {
  const Nodes& nodes = system.nodes();
  for (int i = 0; i < nodes.count(); ++i)
    if (nodes[i].body >= 0) bonds_.push_back({i, nodes[i].body, Vec3::Zero(), Vec3::Zero()});

  analyse();

  const auto pieces = nodes.pieces().size();
  couplings_.resize(pieces);
  pair_of_.resize(pieces);
  A_bb_.resize(pieces);
  S_.resize(pieces);
  turn_.assign(pieces, Mat3::Identity());
  Lambda_factored_.assign(pieces, Mat3::Identity());
  std::map<std::pair<int, int>, int> known;
  for (std::size_t p = 0; p < pieces; ++p) {
    const std::vector<int>& bodies = nodes.pieces()[p].bodies;
    columns_ = std::max(columns_, 6 * static_cast<int>(bodies.size()));
    for (std::size_t i = 0; i < bodies.size(); ++i)
      for (std::size_t j = i; j < bodies.size(); ++j) {
        piece_of_.try_emplace({bodies[i], bodies[j]}, static_cast<int>(p));
        if (j == i) continue;
        const auto [it, fresh] =
            known.try_emplace({bodies[i], bodies[j]}, static_cast<int>(pairs_.size()));
        if (fresh) pairs_.push_back({bodies[i], bodies[j], 0, 0});
        pair_of_[p].push_back(it->second);
      }
  }
  piece_pairs_ = pairs_.size();
  meeting_diagonal_.assign(system.body_count(), Mat6::Zero());
  W_.resize(static_cast<std::size_t>(nodes.unknowns()) * columns_);
  y_.resize(nodes.unknowns());
}

void NodeCondensation::analyse() {
  const Nodes& nodes = system_->nodes();
  std::vector<int> rows, columns;
  source_.clear();
  const auto add = [&](int i, int j, std::size_t block) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        const int row = nodes.unknown(i, r), column = nodes.unknown(j, c);
        if (row < 0 || column < 0) continue;
        rows.push_back(row);
        columns.push_back(column);
        source_.push_back(static_cast<int>(9 * block) + 3 * r + c);
      }
  };
  for (int i = 0; i < nodes.count(); ++i)
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b)
      add(i, nodes.column()[b], static_cast<std::size_t>(b));
  for (std::size_t k = 0; k < moving_.row.size(); ++k)
    add(moving_.row[k], moving_.column[k], nodes.column().size() + k);
  values_.resize(source_.size());
  if (nodes.unknowns() > 0) mumps_.analyse(nodes.unknowns(), rows, columns);
}

int NodeCondensation::place_in(int piece, int body) const {
  const std::vector<int>& bodies = system_->nodes().pieces()[piece].bodies;
  const auto place = std::lower_bound(bodies.begin(), bodies.end(), body);
  POLHODE_ASSERT(place != bodies.end() && *place == body);
  return static_cast<int>(place - bodies.begin());
}

void NodeCondensation::place_bonds(const Trial& trial) {
  const double alpha_f = trial.context.ga.alpha_f;
  for (Bond& bond : bonds_) {
    const int slot = system_->slot(bond.body), l = slot % kLanes;
    const TrialBlock& t = trial.blocks[slot / kLanes];
    const Vec3& Z = system_->nodes()[bond.node].Z;
    bond.z_n1 = lane_matrix(t.Lambda, l) * Z;
    bond.z_alpha = (1.0 - alpha_f) * (lane_matrix(t.Lambda_n, l) * Z) + alpha_f * bond.z_n1;
  }
}

/// @eq{ga-z-interpolation} @eq{ga-z-tangent}
void NodeCondensation::gather_couplings(const std::vector<double>& K,
                                        const std::vector<double>& F_all, double arm_weight) {
  const Nodes& nodes = system_->nodes();
  std::vector<const Bond*> bond_of(nodes.count(), nullptr);
  for (const Bond& bond : bonds_) bond_of[bond.node] = &bond;
  for (std::size_t p = 0; p < couplings_.size(); ++p) {
    const auto n = static_cast<Eigen::Index>(6 * nodes.pieces()[p].bodies.size());
    couplings_[p].clear();
    A_bb_[p].setZero(n, n);
  }
  for (Mat6& block : meeting_diagonal_) block.setZero();
  for (auto& blocks : meeting_blocks_) blocks = {Mat6::Zero(), Mat6::Zero()};
  known_.clear();
  const auto block_of = [&](int row, int column) {
    const auto& c = nodes.column();
    const auto first = c.begin() + nodes.row_start()[row],
               last = c.begin() + nodes.row_start()[row + 1];
    const auto b = std::lower_bound(first, last, column) - c.begin();
    return Mat3(Block(K.data() + 9 * b));
  };
  for (const Bond& bond : bonds_) {
    const int i = bond.node;
    const auto P = carried(bond.z_n1), P_bar = carried(bond.z_alpha);
    for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b) {
      const int j = nodes.column()[b];
      const Mat3 K_ij = Block(K.data() + 9 * b);
      if (const Bond* other = bond_of[j]) {
        const int p = piece_of_pair(bond.body, other->body);
        if (p < 0) continue;
        A_bb_[p].block<6, 6>(6 * place_in(p, bond.body), 6 * place_in(p, other->body)) +=
            P_bar.transpose() * K_ij * carried(other->z_n1);
      } else if (nodes.piece(j) >= 0) {
        const int p = nodes.piece(j);
        Coupling& c = coupling(p, j, bond.body);
        c.bf += P_bar.transpose() * K_ij;
        c.fb += block_of(j, i) * P;
      }
    }
    // The lever arm rotates as well.
    const int p = piece_of_pair(bond.body, bond.body);
    const Vec3 F = Eigen::Map<const Vec3>(F_all.data() + 3 * i);
    const Mat3 turned_arm = arm_weight * hat(F) * hat(bond.z_n1);
    if (p < 0) {
      meeting_diagonal_[bond.body].block<3, 3>(3, 3) += turned_arm;
      continue;
    }
    const int at = 6 * place_in(p, bond.body) + 3;
    A_bb_[p].block<3, 3>(at, at) += turned_arm;
  }
  if (!moving_.row.empty()) gather_moving(K, bond_of);
}

NodeCondensation::Coupling& NodeCondensation::coupling(int piece, int node, int body) {
  auto& list = couplings_[piece];
  const auto [it, fresh] = known_.try_emplace({node, body}, list.size());
  if (fresh)
    list.push_back({node, body, place_in(piece, body), Eigen::Matrix<double, 3, 6>::Zero(),
                    Eigen::Matrix<double, 6, 3>::Zero()});
  return list[it->second];
}

/// Connected component of a pair of bodies bonded to neighbouring nodes; −1 if they are coupled
/// without free nodes.
int NodeCondensation::piece_of_pair(int a, int b) const {
  const auto found = piece_of_.find(std::minmax(a, b));
  return found == piece_of_.end() ? -1 : found->second;
}

/// Adds the blocks outside the graph, one by one: K_ij and K_ji are separate.
void NodeCondensation::gather_moving(const std::vector<double>& K,
                                     const std::vector<const Bond*>& bond_of) {
  const Nodes& nodes = system_->nodes();
  for (std::size_t k = 0; k < moving_.row.size(); ++k) {
    const int i = moving_.row[k], j = moving_.column[k];
    const Bond *row = bond_of[i], *column = bond_of[j];
    if (!row && !column) continue;
    const Mat3 K_ij = Block(K.data() + 9 * (nodes.column().size() + k));
    if (row && column) {
      const Mat6 share = carried(row->z_alpha).transpose() * K_ij * carried(column->z_n1);
      if (row->body == column->body && piece_of_pair(row->body, row->body) < 0) {
        meeting_diagonal_[row->body] += share;
        continue;
      }
      const int p = piece_of_pair(row->body, column->body);
      if (p < 0)
        meeting_blocks_[meeting_.at(std::minmax(row->body, column->body))]
                       [row->body < column->body ? 0 : 1] += share;
      else
        A_bb_[p].block<6, 6>(6 * place_in(p, row->body), 6 * place_in(p, column->body)) += share;
    } else if (row) {
      if (nodes.piece(j) >= 0)
        coupling(nodes.piece(j), j, row->body).bf += carried(row->z_alpha).transpose() * K_ij;
    } else if (nodes.piece(i) >= 0) {
      coupling(nodes.piece(i), i, column->body).fb += K_ij * carried(column->z_n1);
    }
  }
}

/// Finds the pairs of bodies whose bonded nodes may come into contact, unless one connected
/// component couples both.
void NodeCondensation::find_neighbours() {
  const Nodes& nodes = system_->nodes();
  std::map<std::pair<int, int>, std::size_t> now;
  for (std::size_t k = 0; k < moving_.row.size(); ++k) {
    const int a = nodes[moving_.row[k]].body, b = nodes[moving_.column[k]].body;
    if (a >= 0 && b >= 0 && a != b && piece_of_pair(a, b) < 0) now.emplace(std::minmax(a, b), 0);
  }
  std::size_t number = 0;
  for (auto& [bodies, place] : now) place = number++;
  if (now == meeting_) return;
  meeting_ = std::move(now);
  ++meetings_;
  pairs_.resize(piece_pairs_);
  for (const auto& [bodies, place] : meeting_)
    pairs_.push_back({bodies.first, bodies.second, 0, 0});
  meeting_blocks_.resize(meeting_.size());
}

bool NodeCondensation::factor(const NodeSystem& nodes, const Trial& trial) {
  if (!(nodes.moving() == moving_)) {
    moving_ = nodes.moving();
    find_neighbours();
    analyse();
  }
  return factor(nodes.tangent(), nodes.residual(), trial, {});
}

bool NodeCondensation::factor(const std::vector<double>& K, const std::vector<double>& F,
                              const Trial& trial, const FactorOptions& options) {
  const Nodes& nodes = system_->nodes();
  factored_ = false;
  place_bonds(trial);
  gather_couplings(K, F, options.arms_turn ? trial.context.ga.alpha_f : 0.0);
  const int n = nodes.unknowns();
  if (!options.same_matrix && n > 0) {
    for (std::size_t k = 0; k < source_.size(); ++k) values_[k] = K[source_[k]];
    if (!mumps_.factor(values_.data())) return false;
  }

  std::fill(W_.begin(), W_.end(), 0.0);
  for (const auto& list : couplings_)
    for (const Coupling& c : list)
      for (int r = 0; r < 3; ++r) {
        const int row = nodes.unknown(c.node, r);
        if (row < 0) continue;
        for (int k = 0; k < 6; ++k)
          W_[static_cast<std::size_t>(6 * c.place + k) * n + row] = c.fb(r, k);
      }
  if (n > 0 && columns_ > 0) mumps_.solve(W_.data(), columns_);
  for (std::size_t p = 0; p < couplings_.size(); ++p) {
    S_[p] = A_bb_[p];
    for (const Coupling& c : couplings_[p])
      for (int r = 0; r < 3; ++r) {
        const int row = nodes.unknown(c.node, r);
        if (row < 0) continue;
        for (Eigen::Index k = 0; k < S_[p].cols(); ++k)
          S_[p].block<6, 1>(6 * c.place, k) -=
              c.bf.col(r) * W_[static_cast<std::size_t>(k) * n + row];
      }
    turn_[p].setIdentity();
    if (nodes.pieces()[p].turns)
      Lambda_factored_[p] = Lambda_n1(*system_, trial, nodes.pieces()[p].bodies[0]);
  }
  factored_ = true;
  return true;
}

const std::vector<Mat3>& NodeCondensation::turns(const Trial& trial) {
  place_bonds(trial);
  for (std::size_t p = 0; p < turn_.size(); ++p)
    if (factored_ && system_->nodes().pieces()[p].turns)
      turn_[p] = Lambda_n1(*system_, trial, system_->nodes().pieces()[p].bodies[0]) *
                 Lambda_factored_[p].transpose();
  return turn_;
}

void NodeCondensation::gather(const std::vector<double>& F, double scale,
                              std::vector<Vec6>& residual) const {
  for (const Bond& bond : bonds_) {
    const Eigen::Map<const Vec3> at(F.data() + 3 * bond.node);
    Vec6& R = residual[bond.body];
    R.head<3>() += scale * at;
    R.tail<3>() += scale * bond.z_alpha.cross(at);
  }
}

void NodeCondensation::press(const std::vector<double>& F, double scale,
                             std::vector<Vec6>& residual) {
  const Nodes& nodes = system_->nodes();
  const auto at = [&](int node) { return Eigen::Map<const Vec3>(F.data() + 3 * node); };
  gather(F, scale, residual);
  for (int i = 0; i < nodes.count(); ++i) {
    if (nodes.piece(i) < 0) continue;
    const Vec3 f = turn_[nodes.piece(i)].transpose() * at(i);
    for (int c = 0; c < 3; ++c)
      if (const int row = nodes.unknown(i, c); row >= 0) y_[row] = f[c];
  }
  if (nodes.unknowns() > 0) mumps_.solve(y_.data());
  for (std::size_t p = 0; p < couplings_.size(); ++p)
    for (const Coupling& c : couplings_[p]) {
      Vec6 share = Vec6::Zero();
      for (int r = 0; r < 3; ++r)
        if (const int row = nodes.unknown(c.node, r); row >= 0) share += y_[row] * c.bf.col(r);
      residual[c.body] -= scale * turned(turn_[p], share);
    }
}

void NodeCondensation::condense(const std::vector<double>& F, double scale,
                                std::vector<Vec6>& residual, std::vector<Mat6>& diagonal,
                                std::span<linear::KktValues::Pair> pairs) {
  const Nodes& nodes = system_->nodes();
  press(F, scale, residual);
  for (std::size_t p = 0; p < couplings_.size(); ++p) {
    const std::vector<int>& bodies = nodes.pieces()[p].bodies;
    const Mat3& Q = turn_[p];
    std::size_t pair = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const auto block = [&](std::size_t r, std::size_t c) {
        return Mat6(scale * turned(Q, Mat6(S_[p].block<6, 6>(6 * static_cast<Eigen::Index>(r),
                                                             6 * static_cast<Eigen::Index>(c)))));
      };
      diagonal[bodies[i]] += block(i, i);
      for (std::size_t j = i + 1; j < bodies.size(); ++j, ++pair) {
        linear::KktValues::Pair& v = pairs[pair_of_[p][pair]];
        v.K_ab += block(i, j);
        v.K_ba += block(j, i);
      }
    }
  }
  for (std::size_t b = 0; b < meeting_diagonal_.size(); ++b)
    diagonal[b] += scale * meeting_diagonal_[b];
  for (std::size_t k = 0; k < meeting_blocks_.size(); ++k) {
    linear::KktValues::Pair& v = pairs[piece_pairs_ + k];
    v.K_ab += scale * meeting_blocks_[k][0];
    v.K_ba += scale * meeting_blocks_[k][1];
  }
}

void NodeCondensation::expand(const double* x, std::vector<double>& du) const {
  const Nodes& nodes = system_->nodes();
  du.assign(3 * static_cast<std::size_t>(nodes.count()), 0.0);
  const auto of_body = [&](int body) { return Eigen::Map<const Vec6>(x + 6 * body); };
  for (const Bond& bond : bonds_)
    Eigen::Map<Vec3>(du.data() + 3 * bond.node) = carried(bond.z_n1) * of_body(bond.body);
  const int n = nodes.unknowns();
  std::vector<Vec6> local;
  for (std::size_t p = 0; p < couplings_.size(); ++p) {
    const ConnectedComponent& piece = nodes.pieces()[p];
    local.clear();
    for (int body : piece.bodies)
      local.push_back(turned(Mat3(turn_[p].transpose()), Vec6(of_body(body))));
    for (int i : piece.nodes) {
      Vec3 d = Vec3::Zero();
      for (int c = 0; c < 3; ++c) {
        const int row = nodes.unknown(i, c);
        if (row < 0) continue;
        d[c] = -y_[row];
        for (std::size_t b = 0; b < local.size(); ++b)
          for (int k = 0; k < 6; ++k)
            d[c] -= W_[(6 * b + k) * n + static_cast<std::size_t>(row)] * local[b][k];
      }
      Eigen::Map<Vec3>(du.data() + 3 * i) = turn_[p] * d;
    }
  }
}

}  // namespace polhode
