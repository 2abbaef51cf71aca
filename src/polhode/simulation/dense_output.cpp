// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/math/hermite.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/simulation/dense_output.hpp>
#include <polhode/stepping/column_choice.hpp>
#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/step_control.hpp>

namespace polhode {

namespace {

/// Levels of halves of halves.
constexpr int kDeepest = 6;
/// Largest rotation of a body in a polynomial [rad]: angles are counted from its start.
constexpr double kLargestTurn = 1.2;
/// Length of the steps that give rates of sums, relative to that of the step.
constexpr double kTinyStep = 1e-6;
/// Difference of a memory from its prediction that is rounding, relative to its size or 1.
constexpr double kPredicted = 1e-10;
/// Part of the error that halving must leave at most, for a further one to be of use: the error of
/// a smooth motion falls to a thirtieth or less, that of rounding and of a kink to a quarter.
constexpr double kFalls = 0.15;
/// Largest difference of a polynomial, and h times that of its rate, from the one without the
/// highest derivative at a node, over the difference of that derivative: times h² with
/// accelerations, else h. The node is the last of two, or the middle one of three.
constexpr double kOmitted[2][2] = {{1.0, 1.0}, {0.0678, 0.0902}};

/// Interactions whose memory follows from positions, but for sums since the start.
bool follows_from_positions(const InteractionTraits& traits, const std::string& kind) {
  if (traits.history_size == 0 || traits.lazy_history) return true;
  if (kind.ends_with("_spring")) return traits.history_size == 1;
  if (kind == "beam") return !traits.dissipates;
  constexpr const char* kKinds[] = {"joint", "rotary_motor",   "linear_motor",   "gear",
                                    "screw", "point_on_curve", "curve_on_curve", "coupling"};
  return std::ranges::find(kKinds, kind) != std::end(kKinds);
}

/// Motion of a body from one state to another, as a step.
BodyStep step_of(const System& system, const State& from, const State& to, int body,
                 const StepContext& context) {
  if (body == kGround) return BodyStep::ground(context.ga.alpha_f);
  const BodyMotion n = system.motion(from, body), n1 = system.motion(to, body);
  const Quat turn = n1.q * n.q.conjugate();
  BodyStep step = BodyStep::at_instant(n1.r, n1.Lambda(), n1.v, n1.W);
  step.r_n = n.r;
  step.Lambda_n = n.Lambda();
  step.u = n1.r - n.r;
  step.theta = 2.0 / turn.w() * turn.vec();
  step.v_n = n.v;
  step.W_n = n.W;
  step.alpha_f = context.ga.alpha_f;
  return step;
}

/// Calls a function for every interaction with a single step from one state to another.
/// @param lambda  Means of the multipliers over it, by row.
void for_each_step(const System& system, const State& from, const State& to,
                   const std::vector<double>& lambda, const GeneralizedAlpha& ga,
                   const auto& function) {
  StepContext context;
  context.ga = ga;
  context.t_n = from.t;
  context.dt = to.t - from.t;
  context.tangents = false;
  for (const InteractionRef& ref : system.interactions())
    function(ref, PairStep{step_of(system, from, to, ref.a, context),
                           step_of(system, from, to, ref.b, context), context,
                           lambda.data() + ref.first_row, from.history.data() + ref.first_history});
}

/// Memory of interactions after a single step from one state to another.
/// @param lambda  Means of the multipliers over it, by row.
std::vector<double> memory_after(const System& system, const State& from, const State& to,
                                 const std::vector<double>& lambda, const GeneralizedAlpha& ga) {
  std::vector<double> memory = from.history;
  if (memory.empty()) return memory;
  for_each_step(system, from, to, lambda, ga, [&](const InteractionRef& ref, const PairStep& step) {
    if (system.traits(ref).history_size > 0)
      system.group(ref.group).commit(ref.item, step, memory.data() + ref.first_history);
  });
  return memory;
}

/// Motion of a body with its derivatives, as numbers that polynomials take.
struct BodyJet {
  Eigen::Matrix<double, 7, 1> value, rate, second;

  [[nodiscard]] const Eigen::Matrix<double, 7, 1>& derivative(int d) const {
    return d == 0 ? value : d == 1 ? rate : second;
  }
};

using Vec4 = Eigen::Vector4d;

/// Product of a quaternion (w, x, y, z) and a vector.
Vec4 product(const Vec4& p, const Vec3& V) {
  const Vec3 v = p.tail<3>();
  Vec4 result;
  result << -v.dot(V), p[0] * V + v.cross(V);
  return result;
}

BodyJet jet(const BodyMotion& m, const Vec3& a, const Vec3& alpha) {
  BodyJet j;
  const Vec4 q(m.q.w(), m.q.x(), m.q.y(), m.q.z());
  const Vec4 q_dot = 0.5 * product(q, m.W);
  const Vec3 W_dot = m.q.conjugate() * alpha;
  j.value << m.r, q;
  j.rate << m.v, q_dot;
  j.second << a, 0.5 * (product(q_dot, m.W) + product(q, W_dot));
  return j;
}

/// A state that steps have reached, with its accelerations.
struct Node {
  State state;
  std::vector<BodyJet> bodies;
  std::vector<double> lambda;
  std::vector<double> memory_rates;  ///< Of State::history [1/s].
  double dissipation = 0.0;          ///< Of interactions [W].
  Balance balance;
};

/// Part of a step between two nodes.
struct Window {
  std::shared_ptr<const Node> first, last;
  std::shared_ptr<const Node> middle;  ///< Null until it is needed.
  double error = -1.0;                 ///< Of the polynomial [-]; negative: not yet known.
  int taken = 2;                       ///< Highest derivative that it takes.
  std::vector<char> sums;  ///< By entry of the memory: whether a single step does not give it.
  std::unique_ptr<Window> left, right;

  [[nodiscard]] double length() const { return last->state.t - first->state.t; }
  [[nodiscard]] double middle_time() const { return 0.5 * (first->state.t + last->state.t); }
  [[nodiscard]] std::vector<const Node*> nodes() const {
    if (!middle) return {first.get(), last.get()};
    return {first.get(), middle.get(), last.get()};
  }
  /// Values and derivatives at the nodes up to the highest one, which `without` leaves out.
  [[nodiscard]] std::vector<HermiteCondition> conditions(int highest,
                                                         const Node* without = nullptr) const {
    std::vector<HermiteCondition> list;
    for (const Node* node : nodes())
      for (int d = 0; d <= highest - (node == without ? 1 : 0); ++d)
        list.push_back({node == first.get() ? -1.0 : node == last.get() ? 1.0 : 0.0, d});
    return list;
  }
  /// Sum of a body's numbers with the weights of such conditions.
  [[nodiscard]] Eigen::Matrix<double, 7, 1> sum(const Eigen::VectorXd& weights, std::size_t body,
                                                int highest, const Node* without = nullptr) const {
    Eigen::Matrix<double, 7, 1> total = Eigen::Matrix<double, 7, 1>::Zero();
    const double half = 0.5 * length();
    Eigen::Index k = 0;
    for (const Node* node : {first.get(), middle.get(), last.get()}) {
      if (!node) continue;
      const BodyJet& j = node->bodies[body];
      // The same rotation as that of the first node has, not its negative quaternion.
      const double sign =
          j.value.tail<4>().dot(first->bodies[body].value.tail<4>()) < 0.0 ? -1.0 : 1.0;
      Eigen::Matrix<double, 7, 1> own = Eigen::Matrix<double, 7, 1>::Zero();
      double scale = 1.0;
      for (int d = 0; d <= highest - (node == without ? 1 : 0); ++d, scale *= half)
        own += weights[k++] * scale * j.derivative(d);
      total.head<3>() += own.head<3>();
      total.tail<4>() += sign * own.tail<4>();
    }
    return total;
  }
};

/// Value at a time of the polynomial through those at the nodes.
double between(const Window& window, double t, const auto& value) {
  const std::vector<const Node*> nodes = window.nodes();
  double sum = 0.0;
  for (const Node* node : nodes) {
    double weight = 1.0;
    for (const Node* other : nodes)
      if (other != node) weight *= (t - other->state.t) / (node->state.t - other->state.t);
    sum += weight * value(*node);
  }
  return sum;
}

/// Value at a time of the polynomial through values and rates at the nodes.
double hermite(const Window& window, double t, const auto& value, const auto& rate) {
  const double half = 0.5 * window.length();
  const std::vector<const Node*> nodes = window.nodes();
  std::vector<HermiteCondition> conditions;
  for (const Node* node : nodes)
    for (const int d : {0, 1})
      conditions.push_back({(node->state.t - window.middle_time()) / half, d});
  const Eigen::VectorXd weights = hermite_weights(conditions, (t - window.middle_time()) / half);
  double sum = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(2 * i);
    sum += weights[k] * value(*nodes[i]) + weights[k + 1] * half * rate(*nodes[i]);
  }
  return sum;
}

/// Means of the multipliers from the first node to a time, by row: of polynomials through those at
/// the nodes, by Simpson's rule.
std::vector<double> mean_multipliers(const Window& window, double t) {
  std::vector<double> mean;
  const double start = window.first->state.t;
  for (std::size_t k = 0; k < window.first->lambda.size(); ++k) {
    const auto at = [&](double time) {
      return between(window, time, [&](const Node& n) { return n.lambda[k]; });
    };
    mean.push_back((at(start) + 4.0 * at(0.5 * (start + t)) + at(t)) / 6.0);
  }
  return mean;
}

}  // namespace

struct DenseOutput::Impl {
  const System& system;
  Method method;
  Stepper stepper;  ///< For steps of its own.
  InstantSolver solver;
  std::shared_ptr<Node> first, last;
  Window whole;
  bool smooth = true;

  Impl(const System& s, Method m)
      : system(s),
        method(std::move(m)),
        stepper(s, std::move(method.engine), method.ga, method.control, *method.kernels),
        solver(s) {}

  /// Completes a node by its accelerations. @param side  1: just after its time, −1: just before.
  void differentiate(Node& node, int side) {
    State now = node.state;
    // Limits of functions from the other side are those of times which are nearer than this.
    const TimeSide of = side > 0 ? TimeSide::kAfter : TimeSide::kBefore;
    now.t = beside(beside(now.t, of), of);
    solver.project_velocities(now);
    const InstantSolution found = solver.accelerations(now);
    node.bodies.clear();
    for (int b = 0; b < system.body_count(); ++b) {
      const auto k = static_cast<std::size_t>(b);
      node.bodies.push_back(jet(system.motion(now, b), found.r_ddot[k], found.alpha[k]));
    }
    node.lambda = found.lambda;
    find_rates(node, now, side);
    stepper.leave();
    node.balance = stepper.balance(node.state);
  }

  /// Sets the rates of sums at a node, from a tiny step on one side of it. A step before that one
  /// makes angles that are counted those of the bodies, from which they differ by a step's error.
  void find_rates(Node& node, const State& now, int side) const {
    const double dt = kTinyStep * (last->state.t - first->state.t);
    State before = moved(now, side * dt);
    before.history = memory_after(system, now, before, node.lambda, method.ga);
    const State after = side > 0 ? moved(now, 2.0 * dt) : now;
    node.memory_rates = memory_after(system, before, after, node.lambda, method.ga);
    for (std::size_t k = 0; k < node.memory_rates.size(); ++k)
      node.memory_rates[k] = (node.memory_rates[k] - before.history[k]) / dt;
    node.dissipation = 0.0;
    for_each_step(system, before, after, node.lambda, method.ga,
                  [&](const InteractionRef& ref, const PairStep& step) {
                    if (!system.traits(ref).works) return;
                    node.dissipation +=
                        system.group(ref.group).work(ref.item, step).dissipated / dt;
                  });
  }

  /// A state moved by its velocities.
  [[nodiscard]] State moved(const State& from, double dt) const {
    State to = from;
    to.t += dt;
    for (int b = 0; b < system.body_count(); ++b) {
      BodyMotion m = system.motion(from, b);
      m.r += dt * m.v;
      m.q = (m.q * quaternion_from_cayley(dt * m.W)).normalized();
      to.set_motion(system.slot(b), m);
    }
    return to;
  }

  /// The state that a step of its own reaches from another one; null if none does.
  std::shared_ptr<Node> reach(const State& from, double t) {
    auto node = std::make_shared<Node>();
    State& state = node->state;
    state = from;
    state.dt_next = t - from.t;
    state.steps_to_compare = std::numeric_limits<int>::max();
    if (method.control.varies && state.columns > kLeastColumns + 1) --state.columns;
    stepper.leave();
    while (state.t < t)
      if (!stepper.advance(state, t).accepted) return nullptr;
    return node;
  }

  /// Chooses the polynomial of a window: with accelerations, or without where these magnify errors
  /// of velocities, in stiff dampers.
  void choose_polynomial(Window& w) const {
    const double with = error_of(w, 2), without = error_of(w, 1);
    w.taken = with <= without ? 2 : 1;
    w.error = std::min(with, without);
  }

  /// Difference of a polynomial from the one without its highest derivative at a node, as errors of
  /// steps.
  [[nodiscard]] double error_of(const Window& w, int highest) const {
    const Node* without = w.middle ? w.middle.get() : w.last.get();
    const double h = w.length(), per_length = 1.0 / system.length_scale();
    const double x = w.middle ? 0.0 : 1.0, power = highest == 2 ? h * h : h;
    const Eigen::VectorXd weights =
        hermite_weights(w.conditions(highest, without), x, highest) * std::pow(2.0 / h, highest);
    const double factor = kOmitted[highest - 1][w.middle ? 1 : 0] * power;
    double most = 0.0;
    for (std::size_t b = 0; b < without->bodies.size(); ++b) {
      const BodyJet& j = without->bodies[b];
      const Vec4 start = w.first->bodies[b].value.tail<4>();
      if (std::abs(start.dot(w.last->bodies[b].value.tail<4>())) < std::cos(0.5 * kLargestTurn))
        return std::numeric_limits<double>::infinity();
      Eigen::Matrix<double, 7, 1> d = w.sum(weights, b, highest, without);
      d.head<3>() -= j.derivative(highest).head<3>();
      d.tail<4>() -=
          (j.value.tail<4>().dot(start) < 0.0 ? -1.0 : 1.0) * j.derivative(highest).tail<4>();
      most = std::max(most,
                      factor * std::max(per_length * d.head<3>().norm(), 2.0 * d.tail<4>().norm()));
    }
    return most;
  }

  /// The part of a window whose polynomial is accurate at a time.
  Window& window_at(Window& w, double t, int depth, double before) {
    const double allowed = method.control.tolerance;
    if (w.error < 0.0) choose_polynomial(w);
    if (w.error <= allowed) return w;
    if (!w.middle) {
      const auto middle = reach(w.first->state, w.middle_time());
      if (!middle) return w;
      differentiate(*middle, 1);
      w.middle = middle;
      choose_polynomial(w);
      if (w.error <= allowed) return w;
    }
    if (depth == kDeepest || (before >= 0.0 && w.error > kFalls * before)) return w;
    std::unique_ptr<Window>& part = t < w.middle_time() ? w.left : w.right;
    if (!part) {
      part = std::make_unique<Window>();
      part->first = t < w.middle_time() ? w.first : w.middle;
      part->last = t < w.middle_time() ? w.middle : w.last;
    }
    return window_at(*part, t, depth + 1, w.error);
  }

  [[nodiscard]] State interpolated(Window& w, double t) {
    State state = last->state;
    state.t = t;
    const double x = 2.0 * (t - w.middle_time()) / w.length();
    const std::vector<HermiteCondition> conditions = w.conditions(w.taken);
    const Eigen::VectorXd at = hermite_weights(conditions, x),
                          rates = hermite_weights(conditions, x, 1) * 2.0 / w.length();
    for (std::size_t b = 0; b < w.first->bodies.size(); ++b) {
      const Eigen::Matrix<double, 7, 1> value = w.sum(at, b, w.taken),
                                        rate = w.sum(rates, b, w.taken);
      const Vec4 p = value.tail<4>();
      const Quat q(p[0], p[1], p[2], p[3]), q_dot(rate[3], rate[4], rate[5], rate[6]);
      BodyMotion m;
      m.r = value.head<3>();
      m.v = rate.head<3>();
      m.q = q.normalized();
      m.W = 2.0 / p.squaredNorm() * (q.conjugate() * q_dot).vec();
      state.set_motion(system.slot(static_cast<int>(b)), m);
    }
    for (std::size_t k = 0; k < state.lambda.size(); ++k)
      state.lambda[k] = between(w, t, [&](const Node& n) { return n.lambda[k]; });
    remember(w, state);
    if (system.rows() > 0 && solver.assemble_positions(state).assembled)
      solver.project_velocities(state);
    balance_sums(w, t, state);
    return state;
  }

  /// Memory at a state between nodes: what a single step from the first one gives where it gives
  /// that of the other nodes too, as it counts angles and follows drives exactly; else, of works
  /// and impulses, polynomials through values and rates.
  void remember(Window& w, State& state) const {
    if (state.history.empty()) return;
    const auto memory_at = [&](const State& there) {
      return memory_after(system, w.first->state, there, mean_multipliers(w, there.t), method.ga);
    };
    if (w.sums.empty()) {
      w.sums.assign(state.history.size(), 0);
      std::vector<char> counted_later(state.history.size(), 0);
      for (const InteractionRef& ref : system.interactions())
        if (system.traits(ref).lazy_history)
          std::fill_n(counted_later.begin() + ref.first_history, system.traits(ref).history_size,
                      1);
      for (const Node* node : w.nodes()) {
        const std::vector<double> given = memory_at(node->state);
        for (std::size_t k = 0; k < given.size(); ++k) {
          const double is = node->state.history[k];
          if (counted_later[k] == 0 &&
              std::abs(given[k] - is) > kPredicted * std::max(1.0, std::abs(is)))
            w.sums[k] = 1;
        }
      }
    }
    state.history = memory_at(state);
    for (std::size_t k = 0; k < state.history.size(); ++k)
      if (w.sums[k] != 0)
        state.history[k] = hermite(
            w, state.t, [&](const Node& n) { return n.state.history[k]; },
            [&](const Node& n) { return n.memory_rates[k]; });
  }

  /// Sums of the ledger at a state between nodes: its balances are as open there as at the nodes.
  void balance_sums(const Window& w, double t, State& state) {
    stepper.leave();
    const Balance now = stepper.balance(state);
    Ledger& l = state.ledger;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double p = between(w, t, [&](const Node& n) {
        return n.balance.linear_momentum[i] - n.state.ledger.impulse[k].value();
      });
      const double angular = between(w, t, [&](const Node& n) {
        return n.balance.angular_momentum[i] - n.state.ledger.angular_impulse[k].value();
      });
      l.impulse[k] = {now.linear_momentum[i] - p, 0.0};
      l.angular_impulse[k] = {now.angular_momentum[i] - angular, 0.0};
    }
    const auto dissipated = [](const Node& n) { return n.state.ledger.dissipated.value(); };
    const auto put_in = [](const Node& n) { return n.state.ledger.put_in.value(); };
    const double energy = now.kinetic + now.potential;
    const double open = between(w, t, [&](const Node& n) {
      return n.balance.kinetic + n.balance.potential + dissipated(n) - put_in(n);
    });
    if (put_in(*w.first) == put_in(*w.last)) {
      if (dissipated(*w.first) != dissipated(*w.last))
        l.dissipated = {open - energy + put_in(*w.first), 0.0};
    } else {
      l.dissipated = {hermite(w, t, dissipated, [](const Node& n) { return n.dissipation; }), 0.0};
      l.put_in = {energy + l.dissipated.value() - open, 0.0};
    }
  }
};

bool DenseOutput::suits(const System& system, const StepControl& control) {
  if (control.step || control.order <= 2 || system.contacts() || !system.nodes().empty())
    return false;
  return std::ranges::all_of(system.interactions(), [&](const InteractionRef& ref) {
    return follows_from_positions(system.traits(ref), system.group(ref.group).kind());
  });
}

DenseOutput::DenseOutput(const System& system, Method method)
    : impl_(std::make_unique<Impl>(system, std::move(method))) {}

DenseOutput::~DenseOutput() = default;

void DenseOutput::start(const State& state) {
  Impl& s = *impl_;
  s.first = std::make_shared<Node>();
  s.first->state = state;
}

void DenseOutput::finish(const State& state, bool smooth) {
  Impl& s = *impl_;
  s.last = std::make_shared<Node>();
  s.last->state = state;
  s.smooth = smooth;
  s.whole = {};
}

State DenseOutput::at(double t) {
  Impl& s = *impl_;
  if (!s.smooth) {
    const auto node = s.reach(s.first->state, t);
    return node ? node->state : s.last->state;
  }
  if (!s.whole.first) {
    s.differentiate(*s.first, 1);
    s.differentiate(*s.last, -1);
    s.whole.first = s.first;
    s.whole.last = s.last;
  }
  return s.interpolated(s.window_at(s.whole, t, 0, -1.0), t);
}

}  // namespace polhode
