// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/joints/joint.hpp>

namespace polhode {

namespace {

/// The frame's columns rotated with the body, at t_{n+αf} and t_{n+1}.
struct CarriedFrame {
  CarriedFrame(const BodyStep& body, const Mat3& R) {
    if (!body.moves) {
      at_alpha = at_n1 = R;
      return;
    }
    at_n1.noalias() = body.Lambda_n1.lazyProduct(R);
    at_alpha.noalias() = body.Lambda_n.lazyProduct(R);
    at_alpha = (1.0 - body.alpha_f) * at_alpha + body.alpha_f * at_n1;
  }
  Mat3 at_alpha, at_n1;
};

Vec6 times(const double* rows, const double* lambda, int count) {
  Vec6 w = Vec6::Zero();
  for (int k = 0; k < count; ++k) w += lambda[k] * Eigen::Map<const Vec6>(rows + 6 * k);
  return w;
}

[[noreturn]] void refuse_both(const std::string& joint) {
  throw InputError(format("joints.{}.motion", joint),
                   "a joint whose frame moves has neither friction nor limits",
                   "Give the motion to a separate body, and join to that body");
}

}  // namespace

Joint::Joint(std::string item_name, std::string type, Participants pair, const JointRecipe& recipe)
    : frames_(recipe.frames),
      parts_(recipe.parts),
      rows_(recipe.parts.rows()),
      shift_(recipe.shift),
      rod_(recipe.rod),
      user_frames_(recipe.frames),
      type_(std::move(type)) {
  name = std::move(item_name);
  bodies = pair;
}

template <class What>
auto Joint::with_view(const PairStep& step, What&& what) const {
  const BodyStep &a = step.a, &b = step.b;
  const Carried z_a = a.vector(frames_.Z_a), z_b = b.vector(frames_.Z_b);
  Configuration q_n, q_alpha, q_n1;
  q_n.u = (b.r_n - a.r_n) + (z_b.at_n - z_a.at_n);
  q_n.z_a = z_a.at_n;
  q_n.z_b = z_b.at_n;
  q_n.R_a = a.Lambda_n * frames_.R_a;
  q_n1.u = (b.r_n1 - a.r_n1) + (z_b.at_n1 - z_a.at_n1);
  q_n1.z_a = z_a.at_n1;
  q_n1.z_b = z_b.at_n1;
  q_n1.R_a = a.Lambda_n1 * frames_.R_a;
  const double af = a.alpha_f;
  q_alpha.u = (1.0 - af) * q_n.u + af * q_n1.u;
  q_alpha.z_a = z_a.at_alpha;
  q_alpha.z_b = z_b.at_alpha;
  q_alpha.R_a = (1.0 - af) * q_n.R_a + af * q_n1.R_a;
  q_n1.R_b = b.Lambda_n1 * frames_.R_b;
  q_alpha.R_b = (1.0 - af) * (b.Lambda_n * frames_.R_b) + af * q_n1.R_b;
  Resistance::View view{.step = step,
                        .q_n = q_n,
                        .q_alpha = q_alpha,
                        .q_n1 = q_n1,
                        .memory = step.history + angles()};
  for (int i = 0; i < angles(); ++i) {
    view.angle[static_cast<std::size_t>(i)] = angle(i);
    view.angle_n[static_cast<std::size_t>(i)] = step.history[i];
  }
  return what(view);
}

void Joint::arrange(const PairStep& step, Configuration& q_alpha, Configuration& q_n1) const {
  const BodyStep &a = step.a, &b = step.b;
  JointFrames own;
  const JointFrames& frames = held_frames(step, own);
  const Carried z_a = a.vector(frames.Z_a), z_b = b.vector(frames.Z_b);
  const double af = a.alpha_f;
  const Vec3 u_n = (b.r_n - a.r_n) + (z_b.at_n - z_a.at_n);
  q_n1.u = (b.r_n1 - a.r_n1) + (z_b.at_n1 - z_a.at_n1);
  q_n1.z_a = z_a.at_n1;
  q_n1.z_b = z_b.at_n1;
  q_alpha.u = (1.0 - af) * u_n + af * q_n1.u;
  q_alpha.z_a = z_a.at_alpha;
  q_alpha.z_b = z_b.at_alpha;
  if (parts_.planes > 0 || parts_.turns()) {
    const CarriedFrame R_a(a, frames.R_a);
    q_alpha.R_a = R_a.at_alpha;
    q_n1.R_a = R_a.at_n1;
  }
  if (parts_.turns()) {
    const CarriedFrame R_b(b, frames.R_b);
    q_alpha.R_b = R_b.at_alpha;
    q_n1.R_b = R_b.at_n1;
  }
  if (motion_) move_frame(*motion_, frames_, step, q_alpha, q_n1);
  q_alpha.bend = q_n1.bend = bend(step);
}

void Joint::evaluate(const PairStep& step, PairTerms& t) const {
  if (!step.lambda) {  // only what acts beside the rows
    with_view(step, [&](const Resistance::View& view) { resistance_->add(view, t); });
    return clear_ground_sides(step, t);
  }
  Configuration q_alpha, q_n1;
  arrange(step, q_alpha, q_n1);
  const PairRows G{t.G_a.data(), t.G_b.data()}, B{t.B_a.data(), t.B_b.data()};
  parts_.for_each([&](const auto& part, int row) {
    part.residual(q_n1, t.g.data() + row);
    part.gradient(q_alpha, row, B);
    if (!step.context.tangents) return;
    part.gradient(q_n1, row, G);
    part.add_wrench_tangent(q_alpha, q_n1, step.a.alpha_f, step.lambda + row, t);
  });
  t.wrench_a = times(B.a, step.lambda, rows_);
  t.wrench_b = times(B.b, step.lambda, rows_);
  if (held_by_) soften(step, t);
  if (resistance_)
    with_view(step, [&](const Resistance::View& view) { resistance_->add(view, t); });
  clear_ground_sides(step, t);
}

void Joint::set_resistance(const JointResistance& data) {
  const auto kind = Resistance::kind_of(type_);
  if (!kind)
    throw InputError(
        format("joints.{}", name), format("{} joints have neither friction nor limits", type_),
        "Use a revolute, prismatic, cylindrical, spherical or universal joint, or leave them out");
  if (data.any() && motion_) refuse_both(name);
  resistance_ = data.any() ? std::make_shared<const Resistance>(*kind, data) : nullptr;
}

void Joint::set_motion(const FrameMotion& motion) {
  if (parts_.distance || rod_ != RodKind::none)
    throw InputError(format("joints.{}.motion", name), "a distance has no frame that could move",
                     "Prescribe the motion of a spherical joint, or leave it out");
  if (resistance_) refuse_both(name);
  motion_ = std::make_shared<const FrameMotion>(motion);
}

ResistanceReport Joint::resistance_report(const PairStep& step) const {
  return with_view(step, [&](const Resistance::View& v) { return resistance_->report(v); });
}

double Joint::clearance(const PairStep& step) const {
  return with_view(step, [&](const Resistance::View& v) { return resistance_->clearance(v); });
}

void Joint::impacts(const PairStep& step, std::vector<Impact>& list) const {
  with_view(step, [&](const Resistance::View& v) { resistance_->impacts(v, list); });
}

void Joint::unilateral_rows(const PairStep& step, std::vector<UnilateralRow>& list) const {
  with_view(step, [&](const Resistance::View& v) { resistance_->unilateral_rows(v, list); });
}

void Joint::pieces(const PairStep& step, ForcePieces& pieces) const {
  if (piecewise())
    with_view(step, [&](const Resistance::View& view) { resistance_->pieces(view, pieces); });
  else if (resistance_)
    resistance_->stop_pieces(step.history + angles(), pieces);
}

Work Joint::work(const PairStep& step) const {
  Work work;
  if (resistance_)
    work = with_view(step, [&](const Resistance::View& v) { return resistance_->work(v); });
  work.stored += spring_energy(step);
  return work;
}

/// Largest lever arm, as of a joint in the tree: this joint has no MotionBasis that gives it.
double Joint::reach() const {
  if (!resistance_ && !held_by_ && switching == Switching::never) return 0.0;
  return std::max(bodies.a == kGround ? 0.0 : frames_.Z_a.norm(),
                  bodies.b == kGround ? 0.0 : frames_.Z_b.norm());
}

Vec6 Joint::velocity_terms(const PairStep& step, const FrameRates& frame) const {
  const Configuration q = at_n1(step);
  SideRates w{.omega_a = step.a.Lambda_n1 * step.a.W_n1 + frame.omega,
              .omega_b = step.b.Lambda_n1 * step.b.W_n1,
              .u_dot = Vec3::Zero()};
  w.u_dot = step.b.v_n1 + w.omega_b.cross(q.z_b) - step.a.v_n1 - frame.v - w.omega_a.cross(q.z_a);
  Vec6 gamma = Vec6::Zero();
  parts_.for_each(
      [&](const auto& part, int row) { part.acceleration_terms(q, w, gamma.data() + row); });
  return gamma;
}

void Joint::acceleration_terms(const PairStep& step, Vec6& gamma) const {
  const Vec6 all =
      motion_ ? acceleration_terms(step, TimeSide::kAfter) : velocity_terms(step, FrameRates{});
  gamma.head(rows_) = all.head(rows_);
}

namespace {

/// Rows of the derivative of g by the motion of both sides.
struct Rows {
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> a, b;

  Rows(const JointParts& parts, const Configuration& q) {
    a.setZero();
    b.setZero();
    const PairRows G{a.data(), b.data()};
    parts.for_each([&](const auto& part, int row) { part.gradient(q, row, G); });
  }
};

Vec6 stacked(const Vec3& r, const Vec3& theta) {
  Vec6 x;
  x << r, theta;
  return x;
}

}  // namespace

Vec6 Joint::acceleration_terms(const PairStep& step, TimeSide side) const {
  const FrameRates frame = frame_rates(*motion_, frames_, step.a, step.context, side);
  return velocity_terms(step, frame) + Rows(parts_, at_n1(step)).a * stacked(frame.a, frame.alpha);
}

/// Increments of the drive: the discrete gradient by the bodies' motion minus the change of the
/// rows' values; the remainder is that of the frame. @eq{moving-frame}
Vec6 Joint::drive_increments(const PairStep& step) const {
  Configuration q_alpha, q_n1;
  arrange(step, q_alpha, q_n1);
  const Rows G(parts_, q_alpha);
  return G.a * stacked(step.a.u, step.a.theta) + G.b * stacked(step.b.u, step.b.theta) -
         (residual(q_n1) - residual(at_n(step)));
}

void Joint::prescribed(const PairStep& step, TimeSide side, PrescribedRows& rows) const {
  if (!motion_) return;
  const FrameRates frame = frame_rates(*motion_, frames_, step.a, step.context, side);
  rows.rate = -(Rows(parts_, at_n1(step)).a * stacked(frame.v, frame.omega));
  rows.second = velocity_terms(step, FrameRates{}) - acceleration_terms(step, side);
  if (step.context.dt != 0.0) rows.increment = drive_increments(step);
}

double Joint::drive_power(const PairStep& step) const {
  PrescribedRows rows;
  prescribed(step, TimeSide::kAfter, rows);
  double power = 0.0;
  for (int k = 0; k < rows_; ++k) power += step.lambda[k] * rows.rate[k];
  return power;
}

double Joint::drive_work(const PairStep& step) const {
  return motion_ ? step.history[angles()] : 0.0;
}

Reaction Joint::impulses(const PairStep& step) const {
  const double* sums = step.history + record();
  return {Vec3(sums[0], sums[1], sums[2]), Vec3(sums[3], sums[4], sums[5])};
}

Vec6 Joint::residual(const Configuration& q) const {
  Vec6 g = Vec6::Zero();
  parts_.for_each([&](const auto& part, int row) { part.residual(q, g.data() + row); });
  return g;
}

Vec6 Joint::residual(const PairStep& step) const { return residual(at_n1(step)); }

template <class With>
auto Joint::with_sides(const PairStep& step, With&& with) const {
  if (motion_) return with(carried_step(*motion_, frames_, step.a, step.context), step.b);
  return reversed_ ? with(step.b, step.a) : with(step.a, step.b);
}

/// Without a history, as before the start, that at t_n.
Vec3 Joint::bend(const PairStep& step) const {
  if (!parts_.equal_turns) return Vec3::UnitX();
  const Vec3 before = step.history ? Vec3(step.history + bend()) : Vec3(Vec3::Zero());
  if (!before.isZero(0.0)) return before;
  return with_sides(step, [&](const BodyStep& a, const BodyStep& b) {
    return bend_of((a.Lambda_n * user_frames_.R_a).transpose() * (b.Lambda_n * user_frames_.R_b));
  });
}

/// Rotation of the joint frame on b relative to that on a, at t_{n+1}.
Mat3 Joint::relative_turn(const BodyStep& a, const BodyStep& b) const {
  return (a.Lambda_n1 * user_frames_.R_a).transpose() * (b.Lambda_n1 * user_frames_.R_b);
}

/// Least length of bend_along in a step; 4 without bend, and 1 after 151 degrees of it.
constexpr double kLeastBend = 1.0;

bool Joint::acceptable(const PairStep& step) const {
  if (motion_ && is_driven_half_a_turn(*motion_, step.context)) return false;
  JointFrames own;
  const Mat3& R_b = anchors() ? held_frames(step, own).R_b : user_frames_.R_b;
  // Parallel axes, enforced by right angles, could also be antiparallel: the rows do not
  // distinguish them.
  return with_sides(step, [&](const BodyStep& a, const BodyStep& b) {
    if (parts_.equal_turns) return bend_along(relative_turn(a, b), bend(step)).norm() > kLeastBend;
    const auto same_side = [&](int axis) {
      const Carried on_a = a.vector(user_frames_.R_a.col(axis));
      const Carried on_b = b.vector(R_b.col(axis));
      return (on_a.at_n.dot(on_b.at_n) > 0.0) == (on_a.at_n1.dot(on_b.at_n1) > 0.0);
    };
    return (parts_.axes < 2 || same_side(kZ)) && (parts_.axes < 3 || same_side(kX));
  });
}

std::optional<MotionBasis> Joint::motion_basis() const {
  // Friction may depend on the multipliers, moving frames do work, and springs deflect: the tree,
  // which eliminates multipliers, treats such joints as loops. Other friction, and stops, act
  // beside the rows.
  const bool rubs = resistance_ && (resistance_->rubs_by_reaction() || resistance_->rows() > 0);
  if (rubs || motion_ || held_by_ || rows_ < 3 || parts_.distance || parts_.equal_turns)
    return std::nullopt;
  MotionBasis m;
  m.coincident = parts_.coincident;
  m.slides = parts_.planes;
  m.directions = parts_.axes;
  m.Z_a = frames_.Z_a;
  m.Z_b = frames_.Z_b;
  m.R_a = frames_.R_a;
  m.R_b = frames_.R_b;
  for (int i = 0; i < parts_.planes; ++i)
    m.slide[i] = frames_.R_a.col(parts_.plane[static_cast<std::size_t>(i)].normal);
  return m;
}

bool Joint::reversible() const {
  if (!motion_basis() || resistance_) return false;
  if (parts_.coincident || parts_.axes == 3) return true;
  if (parts_.axes != 2) return false;
  // The planes' normals rotate with a: fixed to b they are the same planes only if they are normal
  // to the common axis, or together span the directions normal to it.
  return parts_.planes == 1 ? parts_.plane[0].normal == kZ
                            : parts_.plane[0].normal != kZ && parts_.plane[1].normal != kZ;
}

void Joint::reverse() {
  std::swap(bodies.a, bodies.b);
  std::swap(frames_.Z_a, frames_.Z_b);
  std::swap(frames_.R_a, frames_.R_b);
  if (parts_.axes == 1) {
    // x_a·y_b again: the new x is the old y, the new y the old x.
    const auto turned = [](const Mat3& R, double sign) {
      Mat3 out;
      out << sign * R.col(kY), -sign * R.col(kX), R.col(kZ);
      return out;
    };
    frames_.R_a = turned(frames_.R_a, 1.0);
    frames_.R_b = turned(frames_.R_b, -1.0);
  }
  reversed_ = !reversed_;
}

void Joint::initialize(const PairStep& step, double* history) const {
  with_sides(step, [&](const BodyStep& a, const BodyStep& b) {
    for (int i = 0; i < angles(); ++i) history[i] = angle(i).at_n1(a, b, 0.0);
  });
  if (resistance_) resistance_->initialize(history + angles());
  if (motion_) history[angles()] = 0.0;
  if (records_) std::fill_n(history + record(), kRecordSize, 0.0);
  if (parts_.equal_turns)
    Eigen::Map<Vec3>(history + bend()) = with_sides(
        step, [&](const BodyStep& a, const BodyStep& b) { return bend_of(relative_turn(a, b)); });
}

void Joint::commit(const PairStep& step, double* history) const {
  if (records_) {
    StepContext values_only = step.context;
    values_only.tangents = false;
    PairTerms t;
    t.set_zero();
    evaluate({step.a, step.b, values_only, step.lambda, step.history}, t);
    if (resistance_)
      with_view(step, [&](const Resistance::View& v) {
        resistance_->add_stops(v, history + angles(), t.wrench_a, t.wrench_b);
      });
    const double dt = step.context.dt;
    add_impulse(impulse_sum(), step, dt * t.wrench_a, dt * t.wrench_b, history + record());
  }
  if (resistance_)
    with_view(step, [&](const Resistance::View& v) { resistance_->commit(v, history + angles()); });
  if (motion_) {
    const Vec6 increments = drive_increments(step);
    for (int k = 0; k < rows_; ++k) history[angles()] += step.lambda[k] * increments[k];
  }
  count_turns(step, history);
}

void Joint::count_turns(const PairStep& step, double* history) const {
  with_sides(step, [&](const BodyStep& a, const BodyStep& b) {
    for (int i = 0; i < angles(); ++i) history[i] = angle(i).at_n1(a, b, step.history[i]);
    if (parts_.equal_turns)
      Eigen::Map<Vec3>(history + bend()) = bend_towards(relative_turn(a, b), bend(step));
  });
}

JointCoordinates Joint::coordinates(const PairStep& step) const {
  return with_sides(
      step, [&](const BodyStep& a, const BodyStep& b) { return coordinates(a, b, step.history); });
}

Reaction Joint::reaction(const PairStep& step, bool joint_axes) const {
  const Configuration q = at_n1(step);
  double rows_a[36], rows_b[36];
  const PairRows G{rows_a, rows_b};
  parts_.for_each([&](const auto& part, int row) { part.gradient(q, row, G); });
  const Vec6 w_b = times(rows_b, step.lambda, rows_);
  // On the solver's b, at its joint point, by its a.
  Reaction on_b{w_b.head<3>(), w_b.tail<3>() - q.z_b.cross(w_b.head<3>())};
  if (reversed_) {
    // The user's b is the solver's a: the opposite wrench, moved to the joint point of that body.
    on_b.force = -on_b.force;
    on_b.moment = -on_b.moment + q.u.cross(on_b.force);
  }
  if (joint_axes) {
    const Mat3 axes = with_sides(step, [&](const BodyStep& a, const BodyStep&) -> Mat3 {
      return a.Lambda_n1 * user_frames_.R_a;
    });
    Mat3 R;
    for (int i = 0; i < 3; ++i) R.col((i + shift_) % 3) = axes.col(i);
    return {R.transpose() * on_b.force, R.transpose() * on_b.moment};
  }
  return on_b;
}

}  // namespace polhode
