// SPDX-License-Identifier: Apache-2.0
// Interactions outside the tree: rows of springs and loads, rows and columns of loops. Derivation:
// docs/theory/elimination_along_the_tree.md.
#include <algorithm>

#include <polhode/engines/tree_engine.hpp>

namespace polhode {

namespace {

/// The columns y_i = d_i × e_i of a joint's direction rows: their free directions, and how to
/// obtain their multipliers from a couple.
struct DirectionRows {
  Mat3 dual = Mat3::Zero();  ///< Row i: λ_i of a couple Σ λ_i y_i.
  Mat3 free = Mat3::Zero();  ///< Rows: unit vectors normal to all y_i.
  int rows = 0;
};

DirectionRows direction_rows(const PairTerms& terms, int first, int count) {
  DirectionRows d;
  d.rows = count;
  Vec3 y[3];
  for (int i = 0; i < count; ++i) y[i] = -terms.B_b.col(first + i).tail<3>();
  if (count == 0) {
    d.free.setIdentity();
  } else if (count == 1) {
    d.dual.row(0) = y[0] / y[0].squaredNorm();
    const Vec3 u = y[0].unitOrthogonal();
    d.free.row(0) = u;
    d.free.row(1) = y[0].cross(u).normalized();
  } else if (count == 2) {
    const Vec3 n = y[0].cross(y[1]);
    const double k = 1.0 / n.squaredNorm();
    d.dual.row(0) = k * y[1].cross(n);
    d.dual.row(1) = k * n.cross(y[0]);
    d.free.row(0) = n.normalized();
  } else {
    const Vec3 n = y[1].cross(y[2]);
    const double k = 1.0 / y[0].dot(n);
    d.dual.row(0) = k * n;
    d.dual.row(1) = k * y[2].cross(y[0]);
    d.dual.row(2) = k * y[0].cross(y[1]);
  }
  return d;
}

}  // namespace

void TreeEngine::lay_out_loop_joints() {
  std::vector<const OffTreeInteraction*> joints;
  for (const OffTreeInteraction& x : plan_.extras)
    if (x.in_lanes) joints.push_back(&x);
  const auto kind = [](const OffTreeInteraction* x) {
    return 2 * x->rows + (x->couple >= 0 ? 1 : 0);
  };
  std::stable_sort(
      joints.begin(), joints.end(),
      [&](const OffTreeInteraction* x, const OffTreeInteraction* y) { return kind(x) < kind(y); });
  int size = 0;  // SIMD lanes of loop_data_
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const OffTreeInteraction& x = *joints[i];
    const JointLayout layout{3, x.rows - 3};
    if (i == 0 || kind(joints[i - 1]) != kind(&x) || loop_joints_.back().count == kLanes) {
      LoopJoints& fresh = loop_joints_.emplace_back();
      fresh.directions = layout.directions;
      fresh.couple = x.couple >= 0;
      fresh.data = kLanes * size;
      size += layout.size();
      loop_data_.resize(static_cast<std::size_t>(size), LaneData{});
      for (int lane = 0; lane < kLanes; ++lane) {
        fresh.from_a[lane] = fresh.from_b[lane] = trial_offset(-1);
        put_joint_constants(MotionBasis{}, layout, loop_data_[0].x + fresh.data + lane);
      }
    }
    LoopJoints& block = loop_joints_.back();
    const int lane = block.count++, ground = system_->tree().slots;
    const InteractionRef& ref = system_->interactions()[x.interaction];
    const auto place = [&](int slot, int pair, int& from, int& body, int& extra, int& to) {
      from = trial_offset(slot);
      body = slot < 0 ? ground : slot;
      extra = slot < 0 ? -1 : plan_.extra_of_slot[slot];
      to = pair;
    };
    place(x.slot_a, x.pair_a, block.from_a[lane], block.slot_a[lane], block.extra_a[lane],
          block.pair_a[lane]);
    place(x.slot_b, x.pair_b, block.from_b[lane], block.slot_b[lane], block.extra_b[lane],
          block.pair_b[lane]);
    block.S[lane] = plan_.loops[x.loop].S;
    block.nu[lane] = plan_.loops[x.loop].nu;
    block.row[lane] = ref.first_row;
    put_joint_constants(*system_->group(ref.group).describe(ref.item).motion_basis, layout,
                        loop_data_[0].x + block.data + lane);
  }
  view_.loop_blocks = static_cast<int>(loop_joints_.size());
  view_.loop_joints = loop_joints_.data();
  view_.loop_data = loop_data_.empty() ? nullptr : loop_data_[0].x;
}

void TreeEngine::add_extra(const OffTreeInteraction& x, const PairTerms& terms,
                           const Trial& trial) {
  const double s = view_.scale;
  const int first = x.rotations_only ? 3 : 0;  // first nonzero row and column of D
  const auto add_own = [&](int slot, const Vec6& wrench, const auto& D) {
    if (slot < 0) return;
    RowData* A = extra_rows_[plan_.extra_of_slot[slot]].A;
    for (int i = first; i < 6; ++i)
      for (int j = first; j < 6; ++j) A[i][j] -= s * D(i, j);
    for (int i = 0; i < 6; ++i) A[i][7] -= s * wrench[i];
  };
  if (x.coupling == Coupling::couple) {  // write_couple() handles the rest
    add_own(x.slot_a, terms.wrench_a, terms.D_aa + terms.D_ba);
    add_own(x.slot_b, terms.wrench_b, terms.D_bb + terms.D_ab);
  } else {
    add_own(x.slot_a, terms.wrench_a, terms.D_aa);
    add_own(x.slot_b, terms.wrench_b, terms.D_bb);
  }
  if (x.edge >= 0) {
    EdgeRows& e = edge_rows_[x.edge];
    const Mat6& K_bp = x.edge_child_is_b ? terms.D_ba : terms.D_ab;
    const Mat6& K_pb = x.edge_child_is_b ? terms.D_ab : terms.D_ba;
    for (int i = first; i < 6; ++i)
      for (int j = first; j < 6; ++j) {
        e.K_bp[i][j] -= s * K_bp(i, j);
        e.K_pb[i][j] -= s * K_pb(i, j);
      }
  }
  if (x.loop >= 0) write_loop(x, terms, trial);
  if (x.coupling == Coupling::all) write_coupling(x, terms);
}

void TreeEngine::write_loop(const OffTreeInteraction& x, const PairTerms& terms,
                            const Trial& trial) {
  const double s = view_.scale;
  const TreeLoop& loop = plan_.loops[x.loop];
  const int first = system_->interactions()[x.interaction].first_row, width = 8 * loop.panels;
  double *S = view_.S + loop.S, *nu = view_.nu + loop.nu;
  for (int k = 0; k < width; ++k) nu[k] = 0.0;
  double softness[kMaxRows];
  for (int k = 0; k < x.rows; ++k) {
    const bool exact = terms.compliance[k] == 0.0;
    const double lambda = trial.lambda[first + k];
    softness[k] = exact ? view_.proximal * terms.weight[k] : terms.compliance[k] / s;
    nu[k] = terms.g[k] + (exact ? softness[k] * s * (lambda - trial.lambda_centre[first + k])
                                : terms.compliance[k] * lambda);
  }
  // Columns of multipliers and rows of constraints; unknowns beyond them follow.
  const int columns = x.coupling == Coupling::couple ? x.translation_rows : x.rows;
  const auto write_side = [&](int pair, bool fresh, const auto& B, const auto& G) {
    if (pair < 0) return;
    double* C = view_.pair_rows + 8 * pair;
    double* Rt = C + 6 * width;
    if (!fresh) {  // after another part of the row, which is the loop's only one
      for (int i = 0; i < 6; ++i) {
        C[width * i] -= B(i, 0);
        Rt[width * i] += G(0, i);
      }
      return;
    }
    for (int i = 0; i < 12 * width; ++i) C[i] = 0.0;
    for (int k = 0; k < columns; ++k)
      for (int i = 0; i < 6; ++i) C[width * i + k] = -B(i, k);
    for (int k = 0; k < x.rows; ++k)
      for (int i = 0; i < 6; ++i) Rt[width * i + k] = G(k, i);
  };
  write_side(x.pair_a, x.first_at_a, terms.B_a, terms.G_a);
  write_side(x.pair_b, x.first_at_b, terms.B_b, terms.G_b);
  for (int k = 0; k < columns; ++k) S[width * k + k] = softness[k];
  if (x.coupling == Coupling::couple) write_couple(x, terms, softness);
}

/// Writes the joint's whole couple on b as the unknown: M = Σ Δλ̂_i y_i + σ, σ = −s (D_ba Δθ_a −
/// D_ab Δθ_b) from the directions that rotate with the bodies. Its part in the span of the y_i
/// enforces the direction rows, the rest is that of σ.
void TreeEngine::write_couple(const OffTreeInteraction& x, const PairTerms& terms,
                              const double* softness) {
  const double s = view_.scale;
  const TreeLoop& loop = plan_.loops[x.loop];
  const int T = x.translation_rows, width = 8 * loop.panels;
  const DirectionRows d = direction_rows(terms, T, x.rows - T);
  double* S = view_.S + loop.S;
  double *C_a = view_.pair_rows + 8 * x.pair_a, *C_b = view_.pair_rows + 8 * x.pair_b;
  double *R_a = C_a + 6 * width, *R_b = C_b + 6 * width;
  for (int k = 0; k < 3; ++k) {
    C_a[width * (3 + k) + T + k] = -1.0;
    C_b[width * (3 + k) + T + k] = 1.0;
  }
  const Mat3 by_a = s * terms.D_ba.bottomRightCorner<3, 3>();
  const Mat3 by_b = s * terms.D_ab.bottomRightCorner<3, 3>();
  for (int i = 0; i < d.rows; ++i)
    for (int k = 0; k < 3; ++k) S[width * (T + i) + T + k] = softness[T + i] * d.dual(i, k);
  for (int i = d.rows; i < 3; ++i) {  // w·(M − σ) = 0 for w free
    const Vec3 w = d.free.row(i - d.rows), on_a = by_a.transpose() * w, on_b = by_b.transpose() * w;
    for (int k = 0; k < 3; ++k) {
      S[width * (T + i) + T + k] = w[k];
      R_a[width * (3 + k) + T + i] = on_a[k];
      R_b[width * (3 + k) + T + i] = -on_b[k];
    }
  }
  couples_[x.couple] = {d.dual, by_a, by_b};
}

/// Writes the coupling as twelve unknowns after the multipliers: −s D_ab Δx_b acts on a, −s D_ba
/// Δx_a on b.
void TreeEngine::write_coupling(const OffTreeInteraction& x, const PairTerms& terms) {
  const double s = view_.scale;
  const TreeLoop& loop = plan_.loops[x.coupling_loop];
  const int width = 8 * loop.panels;
  double* S = view_.S + loop.S;
  double* C_a = view_.pair_rows + 8 * x.coupling_pair_a;
  double* C_b = view_.pair_rows + 8 * x.coupling_pair_b;
  double *R_a = C_a + 6 * width, *R_b = C_b + 6 * width;
  if (x.coupling_loop != x.loop) {  // nothing else writes it
    for (double* rows : {C_a, C_b})
      for (int i = 0; i < 12 * width; ++i) rows[i] = 0.0;
    for (int k = 0; k < width; ++k) view_.nu[loop.nu + k] = 0.0;
  }
  for (int k = 0; k < 6; ++k) {
    const int on_a = x.coupling_first + k, on_b = on_a + 6;
    S[width * on_a + on_a] = S[width * on_b + on_b] = -1.0;
    C_a[width * k + on_a] = 1.0;
    C_b[width * k + on_b] = 1.0;
    for (int i = 0; i < 6; ++i) {
      R_b[width * i + on_a] = -s * terms.D_ab(k, i);
      R_a[width * i + on_b] = -s * terms.D_ba(k, i);
    }
  }
}

void TreeEngine::move_multipliers(Trial& trial, double damping) {
  const double unscale = damping / view_.scale;
  const auto turn = [&](int slot) { return Vec3(body_[slot].X + 3); };
  for (const OffTreeInteraction& x : plan_.extras) {
    if (x.rows == 0 || x.in_lanes || x.further_part) continue;
    double* lambda = trial.lambda.data() + system_->interactions()[x.interaction].first_row;
    const double* y = view_.y + plan_.loops[x.loop].nu;
    const int plain = x.coupling == Coupling::couple ? x.translation_rows : x.rows;
    for (int k = 0; k < plain; ++k) lambda[k] += unscale * y[k];
    if (x.coupling != Coupling::couple) continue;
    const Couple& c = couples_[x.couple];
    const Vec3 sigma = -c.by_a * turn(x.slot_a) + c.by_b * turn(x.slot_b);
    const Vec3 fresh = c.dual * (Vec3(y + plain) - sigma);
    for (int k = plain; k < x.rows; ++k) lambda[k] += unscale * fresh[k - plain];
  }
}

}  // namespace polhode
