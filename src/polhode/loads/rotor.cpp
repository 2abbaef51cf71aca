// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/rotor.hpp>

#include <limits>

#include <polhode/dynamics/load_step.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/math/gauss_rule.hpp>

namespace polhode {

Rotor::Rotor(const LoadDescription& load)
    : axis_(load.R_b.col(2)),
      inertia_(load.value("inertia", 0.0)),
      start_speed_(load.value("start_speed", 0.0)),
      function_(load.function),
      has_speed_(load.drive == "speed") {
  name = load.name;
  bodies = load.bodies;
}

double Rotor::mean_moment(const StepContext& c, double from) const {
  if (!function_) return 0.0;
  double mean = 0.0;
  for (const auto& [place, weight] : kGauss)
    mean += weight * (*function_)(c.t_n + (from + place * (1.0 - from)) * c.dt);
  return c.load_factor * mean;
}

Rotor::Spin Rotor::spin(const PairStep& step) const {
  const StepContext& c = step.context;
  const double weight = step.b.alpha_f, from = 2.0 * weight - 1.0;
  Spin s;
  s.at_n = s.at_n1 = step.history[kMomentum];
  if (!has_speed_) {
    if (!is_load_step(c)) s.at_n1 += c.dt * mean_moment(c, 0.0);
    s.rate = mean_moment(c, from);
  } else if (!is_load_step(c)) {
    s.at_n1 = inertia_ * (*function_)(c.t_n1());
    const double part = (1.0 - from) * c.dt;
    if (from == 0.0 && part != 0.0)
      s.rate = (s.at_n1 - s.at_n) / part;
    else if (part != 0.0)
      s.rate = inertia_ / part * ((*function_)(c.t_n1()) - (*function_)(c.t_n1() - part));
    else
      s.rate = inertia_ * function_->rates(c.t_n1(), TimeSide::kBefore).rate;
  }
  s.at_alpha = (1.0 - weight) * s.at_n + weight * s.at_n1;
  return s;
}

void Rotor::evaluate(const PairStep& step, PairTerms& t) const {
  const BodyStep& b = step.b;
  const Spin s = spin(step);
  const Carried a = b.vector(axis_);
  const Vec3 omega = b.omega_alpha(), h = s.at_alpha * a.at_alpha;
  t.wrench_b.tail<3>() = -omega.cross(h) - s.rate * a.at_alpha;
  if (step.context.tangents)
    t.D_bb.bottomRightCorner<3, 3>() =
        hat(h) * b.omega_alpha_tangent() +
        b.alpha_f * (s.at_alpha * hat_hat(omega, a.at_n1) + s.rate * hat(a.at_n1));
  clear_ground_sides(step, t);
}

double Rotor::change(const PairStep& step, const Spin& s) const {
  const double own = has_speed_ ? inertia_ * axis_.dot(step.b.W_n1 - step.b.W_n) : 0.0;
  return s.at_n1 - s.at_n + own;
}

Work Rotor::work(const PairStep& step) const {
  const Spin s = spin(step);
  const double mean = 0.5 * (s.at_n + s.at_n1) / inertia_;
  if (has_speed_) return {.put_in = mean * change(step, s)};
  const double turned = step.b.vector(axis_).at_alpha.dot(step.b.theta);
  return {.put_in = mean * (s.at_n1 - s.at_n) - s.rate * turned};
}

double Rotor::added_energy(const BodyStep& b, const double* history) const {
  const double H = history[kMomentum], energy = 0.5 * H * H / inertia_;
  return has_speed_ ? energy + H * axis_.dot(b.W_n1) : energy;
}

std::vector<double> Rotor::report(const PairStep& step) const {
  const BodyStep& b = step.b;
  const Vec3 a = b.Lambda_n1 * axis_;
  const double H = step.history[kMomentum], carried = axis_.dot(b.W_n1);
  const double speed = has_speed_ ? H / inertia_ : H / inertia_ - carried;
  const double momentum = inertia_ * (speed + carried);
  const double drive = has_speed_  ? step.history[kDrive]
                       : function_ ? (*function_)(step.context.t_n1())
                                   : 0.0;
  const Vec3 h = momentum * a;
  std::vector<double> list =
      numbers(-(b.Lambda_n1 * b.W_n1).cross(h) - drive * a, {speed, momentum});
  for (const double x : {h[0], h[1], h[2], drive, drive * speed, step.history[kWork],
                         0.5 * momentum * momentum / inertia_})
    list.push_back(x);
  return list;
}

void Rotor::initialize(const PairStep& step, double* history) const {
  history[kMomentum] =
      has_speed_ ? inertia_ * function_->rates(step.context.t_n1(), TimeSide::kAfter).value
                 : inertia_ * (start_speed_ + axis_.dot(step.b.W_n1));
  history[kWork] = history[kDrive] = 0.0;
}

void Rotor::commit(const PairStep& step, double* history) const {
  const Spin s = spin(step);
  const double drive = change(step, s) / step.context.dt, work = this->work(step).put_in;
  history[kMomentum] = s.at_n1;
  history[kWork] += work;
  history[kDrive] = drive;
}

namespace {

void add_rotor(System& system, const LoadDescription& load) { system.group<Rotor>().add(load); }

std::vector<double> report_of_rotor(const InteractionGroup& group, int item, const PairStep& step) {
  return items_of<Rotor>(group)[static_cast<std::size_t>(item)].report(step);
}

}  // namespace

LoadKind rotor_kind() {
  constexpr double kMax = std::numeric_limits<double>::max();
  LoadKind kind;
  kind.name = Rotor::kKind;
  kind.meaning =
      "rotor of a body, about an axis fixed in it, without an angle: a reaction wheel, a flywheel";
  kind.place = LoadPlace::axis;
  kind.parameters = {
      {"inertia",
       "kg*m^2",
       {},
       std::numeric_limits<double>::min(),
       kMax,
       "of the rotor about its axis; the body's own inertia has the rotor's mass and its inertia "
       "about the two other axes, but not this one"},
      {"start_speed", "rad/s", 0.0, -kMax, kMax,
       "relative to the body, at the start; with a moment only"}};
  kind.drives = {{"speed", "rad/s", "relative to the body, about the axis"},
                 {"moment", "N*m", "on the rotor by its body, about the axis; 0: it runs freely"}};
  kind.turns = true;
  kind.add = add_rotor;
  kind.channels = {{"moment", "N m", 3},
                   {"speed", "rad/s"},
                   {"axial_momentum", "N m s"},
                   {"angular_momentum", "N m s", 3},
                   {"drive_moment", "N m"},
                   {"power", "W"},
                   {"work", "J"},
                   {"energy", "J"}};
  kind.report = report_of_rotor;
  kind.needs_one_of = {"inertia"};
  kind.switches = false;
  return kind;
}

}  // namespace polhode
