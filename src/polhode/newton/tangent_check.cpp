// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/format.hpp>
#include <polhode/equations/body_contact_assembler.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/equations/node_condensation.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/linear/kkt_matrix.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/newton/tangent_columns.hpp>
#include <polhode/system/barrier_constraint.hpp>
#include <polhode/system/impulsive_contacts.hpp>

namespace polhode {

namespace {

constexpr const char* kAssembled = "assembled";
/// Largest number of displaced nodes of solids, evenly chosen.
constexpr int kMaxNodesMoved = 24;
/// Displacement of all unknowns to look beside a kink, in sizes of the model or an element, and
/// radians: large against those of differences, which must not cross the kink again.
constexpr double kBeside = 1e-4;
/// Largest number of shortenings of a prediction that inverts elements or passes through a surface.
constexpr int kShortenings = 8;

/// Trial that continues with the velocities of the state.
Trial sample_trial(const System& system, const State& state, double dt, double rho_inf) {
  Trial trial;
  trial.context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
  trial.context.t_n = state.t;
  trial.context.dt = dt;
  start_trial(system, state, trial);
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(state, b);
    move_body(state, trial, system.slot(b), dt * m.v, dt * m.omega());
  }
  predict_nodes(system, state, trial, {});
  if (std::all_of(trial.lambda.begin(), trial.lambda.end(), [](double l) { return l == 0.0; })) {
    const double weight = system.mean_mass() * std::max(1.0, system.gravity().norm());
    for (int row = 0; row < system.rows(); ++row)
      trial.lambda[row] = (row % 2 == 0 ? 1.0 : -0.5) * weight;
  }
  return trial;
}

bool acts_by_impulses(const System& system) {
  if (!system.contacts()) return false;
  const ImpulsiveContacts* contacts = system.contacts()->impulsive();
  return contacts && contacts->impulses();
}

/// Equations of a step as solved by Newton, with eliminated nodes.
class WholeTangent {
 public:
  WholeTangent(const System& system, const State& state, Trial trial, MomentumRate form)
      : system_(system), state_(state), trial_(std::move(trial)), newton_(system, form) {
    if (!system.nodes().empty()) {
      nodes_.emplace(system);
      condensation_.emplace(system);
      still_.assign(system.nodes().pieces().size(), Mat3::Identity());
    }
    if (system.contacts() && !acts_by_impulses(system)) touching_.emplace(system);
    hold_back();
    assemble();
  }

  [[nodiscard]] Trial& trial() { return trial_; }
  [[nodiscard]] bool has_contacts() const { return touching_.has_value(); }
  /// Reason why there is no tangent; empty if there is one.
  [[nodiscard]] const std::string& fault() const { return fault_; }

  /// Compares the columns of one body's displacement and rotation. Free nodes follow by their
  /// elimination, so that their residual does not change.
  void move(int body) {
    const BodyStep at = body_step(system_, state_, trial_, body);
    const double length = system_.length_scale();
    for (int i = 0; i < 6; ++i) {
      const double unit = i < 3 ? length : 1.0;
      const std::vector<double> along = nodes_along(6 * body + i, unit);
      columns_->compare(6 * body + i, column(6 * body + i, unit), [&](double h) {
        const std::vector<double> x = trial_.node_x, u = trial_.node_u, v = trial_.node_v;
        move_component(system_, state_, trial_, body, at, i, h * unit);
        shift_nodes(along, h);
        Vec r = residual();
        move_body(state_, trial_, system_.slot(body), at.u, at.theta);
        trial_.node_x = x, trial_.node_u = u, trial_.node_v = v;
        return r;
      });
    }
  }
  /// Compares the column of a multiplier, which is linear.
  void pull(int row) {
    const double s = trial_.scale(system_), lambda = trial_.lambda[row];
    const int at = 6 * system_.body_count() + row;
    columns_->compare(at, column(at, 1.0), [&](double h) {
      trial_.lambda[row] = lambda + h / s;
      Vec r = residual();
      trial_.lambda[row] = lambda;
      return r;
    });
  }
  /// Compares the columns of a free node alone.
  void move_free(int node) {
    for (int c = 0; c < 3; ++c) {
      if (system_.nodes().unknown(node, c) < 0) continue;
      const int at = size() + 3 * node + c;
      columns_->compare(at, node_column(node, c), [&](double h) {
        const double d = h * system_.nodes().element_size();
        const std::vector<double> x = trial_.node_x, u = trial_.node_u, v = trial_.node_v;
        move_node(state_, trial_, node, c, d);
        Vec r = residual();
        trial_.node_x = x, trial_.node_u = u, trial_.node_v = v;
        return r;
      });
    }
  }

  [[nodiscard]] TangentDifference worst() const {
    const TangentColumns::Entry& e = columns_->worst();
    if (e.row < 0) return {};
    return {e.error,
            e.analytic,
            e.numeric,
            {},
            name(e.row, {"force", "moment"}, "row"),
            name(e.column, {"displacement", "turn about"}, "multiplier")};
  }
  [[nodiscard]] int kinks() const { return columns_->kinks(); }

 private:
  [[nodiscard]] int size() const { return matrix_.size(); }

  /// Shortens the prediction: no surface may be passed through, no element inverted.
  void hold_back() {
    if (touching_) {
      (void)touching_->begin_step(state_, trial_);
      if (const double part = touching_->free_part(); part < 1.0) shorten(part);
    }
    for (int i = 0; nodes_ && i < kShortenings; ++i) {
      const ElementReport report = nodes_->assemble(state_, trial_, false, still_);
      if (report.least_volume > 0.0 && clear()) break;
      shorten(i + 1 < kShortenings ? 0.25 : 0.0);
    }
  }
  void shorten(double part) { shorten_motion(system_, state_, part, trial_); }
  /// Whether no point of a surface has passed, or nearly passed, through another one.
  [[nodiscard]] bool clear() const {
    std::vector<double> clearance;
    for (int g = 0; g < system_.nodes().group_count(); ++g)
      if (const BarrierConstraint* points = system_.nodes().group(g).barrier_constraint())
        points->clearances(node_step(state_, trial_),
                           state_.element_history.data() + system_.nodes().first_history(g),
                           clearance);
    return std::all_of(clearance.begin(), clearance.end(), [](double c) { return c > 0.05; });
  }

  void assemble() {
    const double s = trial_.scale(system_);
    // Their tangents are those of an iteration, in which multipliers move with the bodies.
    for (int g = 0; g < system_.nodes().group_count(); ++g)
      if (as_slide(system_.nodes().group(g))) {
        fault_ = "the assembled tangent, as multipliers of points on beams are eliminated";
        return;
      }
    if (nodes_) {
      (void)nodes_->assemble(state_, trial_, true, still_);
      if (!condensation_->factor(*nodes_, trial_)) {
        fault_ = "the assembled tangent, as the matrix of the nodes is singular";
        return;
      }
    }
    std::vector<linear::KktPair> more;
    if (nodes_) more = condensation_->pairs();
    if (touching_) more.insert(more.end(), touching_->pairs().begin(), touching_->pairs().end());
    newton_.couple(more);
    newton_.assemble(state_, trial_, true);
    const auto couplings = newton_.cleared_couplings();
    linear::KktValues& values = newton_.values();
    std::size_t cliques = 0;
    if (nodes_) {
      cliques = condensation_->pairs().size();
      std::vector<Vec6> shares(static_cast<std::size_t>(system_.body_count()), Vec6::Zero());
      condensation_->condense(nodes_->residual(), s, shares, values.diagonal,
                              couplings.first(cliques));
    }
    if (touching_) {
      touching_->evaluate(state_, trial_, true);
      touching_->add_tangents(s, values, couplings.subspan(cliques));
    }
    matrix_ = linear::KktMatrix(newton_.topology());
    matrix_.set(values);
    columns_.emplace(measure_rows());
  }

  /// Residual of bodies, rows, then three per node; bonded and prescribed components have none.
  [[nodiscard]] Vec residual() {
    const double s = trial_.scale(system_);
    if (nodes_) {
      follow_bodies(system_, state_, trial_);
      update_node_velocities(system_, state_, trial_);
      (void)nodes_->assemble(state_, trial_, false, still_);
    }
    newton_.assemble(state_, trial_, false);
    Vec rhs = newton_.right_hand_side();
    if (touching_) {
      touching_->evaluate(state_, trial_, false);
      touching_->add_wrenches(s, rhs);
    }
    Vec r = Vec::Zero(size() + 3 * static_cast<Eigen::Index>(system_.nodes().count()));
    r.head(size()) = -rhs;
    if (!nodes_) return r;
    (void)condensation_->turns(trial_);  // updates the lever arms of bonded nodes
    add_shares(nodes_->residual(), s, r);
    for (int i = 0; i < system_.nodes().count(); ++i)
      for (int c = 0; c < 3; ++c)
        if (system_.nodes().unknown(i, c) >= 0)
          r[size() + 3 * i + c] = s * nodes_->residual()[static_cast<std::size_t>(3 * i + c)];
    return r;
  }
  /// Adds the forces that bonded nodes transmit to their bodies.
  void add_shares(const std::vector<double>& F, double s, Vec& r) const {
    std::vector<Vec6> shares(static_cast<std::size_t>(system_.body_count()), Vec6::Zero());
    condensation_->gather(F, s, shares);
    for (int b = 0; b < system_.body_count(); ++b)
      r.segment<6>(6 * b) += shares[static_cast<std::size_t>(b)];
  }

  /// Displacements of free nodes that follow an unknown of a body, bonded nodes excepted; 3 per
  /// node.
  [[nodiscard]] std::vector<double> nodes_along(int unknown, double unit) {
    if (!nodes_) return {};
    (void)condensation_->turns(trial_);
    Vec x = Vec::Zero(size());
    std::vector<double> none, along;
    condensation_->expand(x.data(), none);
    x[unknown] = unit;
    condensation_->expand(x.data(), along);
    for (std::size_t k = 0; k < along.size(); ++k) along[k] -= none[k];
    for (int i = 0; i < system_.nodes().count(); ++i)
      for (int c = 0; c < 3; ++c)
        if (system_.nodes().unknown(i, c) < 0) along[static_cast<std::size_t>(3 * i + c)] = 0.0;
    return along;
  }
  void shift_nodes(const std::vector<double>& along, double h) {
    for (std::size_t k = 0; k < along.size(); ++k) {
      trial_.node_u[k] += h * along[k];
      trial_.node_x[k] = state_.node_x[k] + trial_.node_u[k];
    }
  }

  [[nodiscard]] Vec column(int at, double unit) const {
    Vec c = Vec::Zero(size() + 3 * static_cast<Eigen::Index>(system_.nodes().count()));
    for (int k = matrix_.column_start()[at]; k < matrix_.column_start()[at + 1]; ++k)
      c[matrix_.row_index()[k]] = unit * matrix_.values()[k];
    return c;
  }
  template <class Visit>
  void each_node_entry(Visit&& visit) const {
    const Nodes& nodes = system_.nodes();
    const double unit = trial_.scale(system_) * nodes.element_size();
    const auto block = [&](int i, int j, std::size_t k) {
      for (int e = 0; e < 9; ++e)
        visit(3 * i + e / 3, 3 * j + e % 3,
              unit * nodes_->tangent()[9 * k + static_cast<std::size_t>(e)]);
    };
    for (int i = 0; i < nodes.count(); ++i)
      for (int k = nodes.row_start()[i]; k < nodes.row_start()[i + 1]; ++k)
        block(i, nodes.column()[k], static_cast<std::size_t>(k));
    const NodeBlocks& moving = nodes_->moving();
    for (std::size_t k = 0; k < moving.row.size(); ++k)
      block(moving.row[k], moving.column[k], nodes.column().size() + k);
  }
  [[nodiscard]] Vec node_column(int node, int component) {
    std::vector<double> forces(3 * static_cast<std::size_t>(system_.nodes().count()), 0.0);
    each_node_entry([&](int row, int at, double v) {
      if (at == 3 * node + component) forces[static_cast<std::size_t>(row)] += v;
    });
    Vec c = Vec::Zero(size() + static_cast<Eigen::Index>(forces.size()));
    (void)condensation_->turns(trial_);
    add_shares(forces, 1.0, c);
    for (int i = 0; i < static_cast<int>(forces.size()); ++i)
      if (system_.nodes().unknown(i / 3, i % 3) >= 0) c[size() + i] = forces[i];
    return c;
  }
  [[nodiscard]] Vec measure_rows() {
    Vec rows = Vec::Zero(size() + 3 * static_cast<Eigen::Index>(system_.nodes().count()));
    for (int j = 0; j < size(); ++j) {
      const double unit = j < 6 * system_.body_count() && j % 6 < 3 ? system_.length_scale() : 1.0;
      for (int k = matrix_.column_start()[j]; k < matrix_.column_start()[j + 1]; ++k) {
        double& size = rows[matrix_.row_index()[k]];
        size = std::max(size, std::abs(unit * matrix_.values()[k]));
      }
    }
    if (nodes_)
      each_node_entry([&](int row, int, double v) {
        double& size_of_row = rows[size() + row];
        size_of_row = std::max(size_of_row, std::abs(v));
      });
    return rows;
  }

  [[nodiscard]] std::string name(int i, std::pair<const char*, const char*> of_body,
                                 const char* of_row) const {
    const int bodies = 6 * system_.body_count();
    if (i < bodies) return body_component(system_, i / 6, i % 6, of_body.first, of_body.second);
    if (i >= size())
      return format("{} {} of {}", of_body.first, "xyz"[(i - size()) % 3],
                    system_.nodes().node_name((i - size()) / 3));
    for (const InteractionRef& ref : system_.interactions())
      if (i - bodies >= ref.first_row && i - bodies < ref.first_row + ref.rows)
        return format("{} {} of {} '{}'", of_row, i - bodies - ref.first_row + 1,
                      system_.group(ref.group).kind(), system_.name(ref));
    return "?";
  }

  const System& system_;
  const State& state_;
  Trial trial_;
  NewtonSystem newton_;
  std::optional<NodeSystem> nodes_;
  std::optional<NodeCondensation> condensation_;
  std::optional<BodyContactAssembler> touching_;
  std::vector<Mat3> still_;  ///< By connected component: identity, no rotation.
  linear::KktMatrix matrix_;
  std::optional<TangentColumns> columns_;
  std::string fault_;
};

void compare_whole(const System& system, WholeTangent& whole, int most_bodies,
                   TangentReport& report) {
  const int bodies = system.body_count(), every = stride_of(bodies, most_bodies);
  for (int b = 0; b < bodies; b += every, ++report.bodies_moved) whole.move(b);
  for (int row = 0; row < system.rows(); row += every) whole.pull(row);
  std::vector<int> free;
  for (int i = 0; i < system.nodes().count(); ++i)
    if (!system.nodes().bonded(i)) free.push_back(i);
  const int step = stride_of(static_cast<int>(free.size()), kMaxNodesMoved);
  for (std::size_t i = 0; i < free.size(); i += static_cast<std::size_t>(step)) {
    whole.move_free(free[i]);
    ++report.nodes_moved;
  }
  const auto left = [&](int moved, int of, const char* what) {
    if (moved < of)
      report.left_out.push_back(
          format("{} of {} {} in the assembled tangent", of - moved, of, what));
  };
  left(report.bodies_moved, bodies, "bodies");
  left(report.nodes_moved, static_cast<int>(free.size()), "nodes");
  if (whole.kinks() > 0)
    report.left_out.push_back(format(
        "one side of {} columns of the assembled tangent, at a kink of a force", whole.kinks()));
  report.parts.push_back({kAssembled, report.bodies_moved + report.nodes_moved,
                          bodies + static_cast<int>(free.size()), whole.worst()});
}

}  // namespace

std::string TangentReport::text() const {
  if (worst.row.empty()) return "the tangent agrees exactly with differences of the residual";
  return format(
      "{}the derivative of {} by {} is {:.9g}, and {:.9g} by differences ({:.1e} of its row)",
      worst.of.empty() ? "" : worst.of + ": ", worst.row, worst.column, worst.analytic,
      worst.numeric, worst.error);
}

namespace {

/// Comparison of all parts at a trial.
TangentReport compare_at(const System& system, const State& state, Trial trial, MomentumRate form,
                         int most_bodies) {
  TangentReport report;
  WholeTangent whole(system, state, std::move(trial), form);
  check_interactions(system, state, whole.trial(), report);
  check_elements(system, state, whole.trial(), report);
  if (whole.has_contacts())
    check_contacts(system, state, whole.trial(), report);
  else if (system.contacts())
    report.left_out.push_back("contacts, which act by impulses and have no tangent");
  if (whole.fault().empty())
    compare_whole(system, whole, most_bodies, report);
  else
    report.left_out.push_back(whole.fault());
  return report;
}

/// Displaces every unknown of a trial by a number of its own between −size and size: of bodies in
/// sizes of the model and radians, of nodes in sizes of an element.
void nudge(const System& system, const State& state, double size, Trial& trial) {
  int k = 0;
  const auto number = [&] { return size * std::sin(1.0 + 7.3 * k++); };
  const auto vector = [&] {
    const double x = number(), y = number();
    return Vec3(x, y, number());
  };
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyStep at = body_step(system, state, trial, b);
    const Vec3 d = system.length_scale() * vector(), turn = vector();
    move_body(state, trial, system.slot(b), at.u + d, compose_cayley(turn, at.theta));
  }
  const Nodes& nodes = system.nodes();
  if (nodes.empty()) return;
  for (int i = 0; i < nodes.count(); ++i)
    for (int c = 0; c < 3; ++c)
      if (nodes.unknown(i, c) >= 0) {
        const auto at = static_cast<std::size_t>(3 * i + c);
        trial.node_u[at] += nodes.element_size() * number();
        trial.node_x[at] = state.node_x[at] + trial.node_u[at];
      }
  follow_bodies(system, state, trial);
  update_node_velocities(system, state, trial);
}

/// Parts that are right on both sides of a trial at which they are wrong have no derivative there,
/// as a cable at its free length or a fibre before its first strain: the comparison beside it
/// counts.
void look_beside_kinks(const System& system, const State& state, const Trial& trial,
                       MomentumRate form, int most_bodies, TangentReport& report) {
  const auto wrong = [](const TangentPart& part) {
    return !(part.worst.error <= kTangentTolerance);
  };
  if (std::none_of(report.parts.begin(), report.parts.end(), wrong)) return;
  std::vector<TangentReport> beside;
  for (const double size : {kBeside, -kBeside}) {
    Trial moved = trial;
    nudge(system, state, size, moved);
    beside.push_back(compare_at(system, state, std::move(moved), form, most_bodies));
  }
  for (TangentPart& part : report.parts) {
    if (!wrong(part)) continue;
    TangentDifference worst;
    int seen = 0;
    for (const TangentReport& other : beside)
      for (const TangentPart& same : other.parts)
        if (same.kind == part.kind && same.compared > 0) {
          ++seen;
          if (!(same.worst.error <= worst.error)) worst = same.worst;
        }
    if (seen < 2 || !(worst.error <= kTangentTolerance)) continue;
    part.worst = worst;
    report.left_out.push_back(format(
        "{} here, where it is not differentiable: it was compared on both sides", part.kind));
  }
}

}  // namespace

TangentReport check_tangents(const System& system, const State& state, double dt, double rho_inf,
                             MomentumRate form, int most_bodies) {
  const Trial trial = sample_trial(system, state, dt, rho_inf);
  TangentReport report = compare_at(system, state, trial, form, most_bodies);
  look_beside_kinks(system, state, trial, form, most_bodies, report);
  // The assembled tangent contains the errors of its parts, whose reports are more specific.
  for (const TangentPart& part : report.parts)
    if (!(part.worst.error <= report.worst.error) &&
        (part.kind != kAssembled || report.worst.error <= kTangentTolerance))
      report.worst = part.worst;
  return report;
}

}  // namespace polhode
