// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <polhode/beams/slide_on_beam.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/newton/tangent_columns.hpp>
#include <polhode/system/changing_sparsity.hpp>
#include <polhode/system/impulsive_contacts.hpp>

namespace polhode {

namespace {

/// Largest numbers of displaced interactions of a kind, nodes of a group and bodies in contact.
constexpr int kMaxItems = 1000, kMaxNodes = 24, kMaxTouching = 60;

/// Two bodies, without the ground, and multipliers, as columns of unknowns or as rows.
struct PairUnknowns {
  int a, b, rows;
  [[nodiscard]] int size() const { return 12 + rows; }
  [[nodiscard]] int body(int i) const { return i < 6 ? a : b; }
  [[nodiscard]] bool exists(int i) const { return i >= 12 || body(i) != kGround; }
};

/// Wrenches on a and b and rows, scaled as in the assembled system.
Vec scaled_values(const PairUnknowns& pair, const PairTerms& t, const double* lambda, double s) {
  Vec values = Vec::Zero(pair.size());
  if (pair.a != kGround) values.head<6>() = s * t.wrench_a;
  if (pair.b != kGround) values.segment<6>(6) = s * t.wrench_b;
  for (int k = 0; k < pair.rows; ++k) values[12 + k] = t.g[k] + t.compliance[k] * lambda[k];
  return values;
}

Mat scaled_tangent(const PairUnknowns& pair, const PairTerms& t, double s, double length) {
  Mat K = Mat::Zero(pair.size(), pair.size());
  const auto put = [&](int row, int column, const Mat6& D) {
    if (!pair.exists(row) || !pair.exists(column)) return;
    K.block<6, 6>(row, column) = s * D;
  };
  put(0, 0, t.D_aa);
  put(0, 6, t.D_ab);
  put(6, 0, t.D_ba);
  put(6, 6, t.D_bb);
  for (int k = 0; k < pair.rows; ++k) {
    if (pair.a != kGround) {
      K.block<6, 1>(0, 12 + k) = t.B_a.col(k);
      K.block<1, 6>(12 + k, 0) = t.G_a.row(k);
    }
    if (pair.b != kGround) {
      K.block<6, 1>(6, 12 + k) = t.B_b.col(k);
      K.block<1, 6>(12 + k, 6) = t.G_b.row(k);
    }
    K(12 + k, 12 + k) = t.compliance[k] / s;
  }
  for (const int first : {0, 6}) K.middleCols<3>(first) *= length;
  return K;
}

std::string name_of(const System& system, const PairUnknowns& pair, int i, bool row) {
  if (i >= 12) return format("{} {}", row ? "row" : "multiplier", i - 12 + 1);
  return body_component(system, pair.body(i), i % 6, row ? "force" : "displacement",
                        row ? "moment" : "turn about");
}

void take(const System& system, const PairUnknowns& pair, const TangentColumns& columns,
          const std::string& of, TangentPart& part) {
  const TangentColumns::Entry& e = columns.worst();
  if (e.row < 0 || e.error <= part.worst.error) return;
  part.worst = {e.error,
                e.analytic,
                e.numeric,
                of,
                name_of(system, pair, e.row, true),
                name_of(system, pair, e.column, false)};
}

void finish(TangentPart part, int kinks, TangentReport& report) {
  if (part.compared < part.of)
    report.left_out.push_back(
        format("{} of {} of kind '{}'", part.of - part.compared, part.of, part.kind));
  if (kinks > 0)
    report.left_out.push_back(
        format("one side of {} columns of kind '{}', at a kink of the force", kinks, part.kind));
  report.parts.push_back(std::move(part));
}

/// Terms of an interaction at the present trial.
PairTerms terms_of(const System& system, const State& state, const Trial& trial,
                   const InteractionRef& ref, bool tangents) {
  StepContext context = trial.context;
  context.tangents = tangents;
  const auto step = [&](int body) {
    return body == kGround ? BodyStep::ground(context.ga.alpha_f)
                           : body_step(system, state, trial, body);
  };
  const BodyStep a = step(ref.a), b = step(ref.b);
  const PairStep pair{a, b, context, trial.lambda.data() + ref.first_row,
                      state.history.data() + ref.first_history};
  PairTerms terms;
  terms.set_zero();
  system.group(ref.group).evaluate(std::span(&ref.item, 1), std::span(&pair, 1),
                                   std::span(&terms, 1));
  return terms;
}

int compare_interaction(const System& system, const State& state, Trial& trial,
                        const InteractionRef& ref, TangentPart& part) {
  const PairUnknowns pair{ref.a, ref.b, ref.rows};
  const double s = trial.scale(system), length = system.length_scale();
  double* lambda = trial.lambda.data() + ref.first_row;
  const Mat K = scaled_tangent(pair, terms_of(system, state, trial, ref, true), s, length);
  TangentColumns columns(row_sizes(K));
  const auto values = [&] {
    return scaled_values(pair, terms_of(system, state, trial, ref, false), lambda, s);
  };
  for (int i = 0; i < pair.size(); ++i) {
    if (!pair.exists(i)) continue;
    if (i >= 12) {
      const double before = lambda[i - 12];
      columns.compare(i, K.col(i), [&](double h) {
        lambda[i - 12] = before + h / s;
        const Vec result = values();
        lambda[i - 12] = before;
        return result;
      });
      continue;
    }
    const int body = pair.body(i);
    const BodyStep at = body_step(system, state, trial, body);
    columns.compare(i, K.col(i), [&](double h) {
      move_component(system, state, trial, body, at, i % 6, i % 6 < 3 ? h * length : h);
      const Vec result = values();
      move_body(state, trial, system.slot(body), at.u, at.theta);
      return result;
    });
  }
  take(system, pair, columns,
       format("{} {}", system.group(ref.group).kind(), quote(system.name(ref))), part);
  return columns.kinks();
}

/// Forces of a group of elements on all nodes, and its blocks.
class GroupForces {
 public:
  GroupForces(const System& system, const State& state, int group)
      : nodes_(system.nodes()),
        group_(nodes_.group(group)),
        slots_(nodes_.slots(group)),
        history_(state.element_history.data() + nodes_.first_history(group)),
        first_scratch_(nodes_.first_scratch(group)),
        moving_(group_.changing_sparsity()) {
    if (moving_)
      blocks_ = moving_->blocks(history_);
    else if (!slots_.empty())
      for (int i = 0; i < nodes_.count(); ++i)
        for (int k = nodes_.row_start()[i]; k < nodes_.row_start()[i + 1]; ++k) {
          blocks_.row.push_back(i);
          blocks_.column.push_back(nodes_.column()[k]);
        }
  }
  [[nodiscard]] const NodeBlocks& blocks() const { return blocks_; }
  [[nodiscard]] Vec operator()(const State& state, Trial& trial, double* tangent) const {
    Vec force = Vec::Zero(3 * static_cast<Eigen::Index>(nodes_.count()));
    group_.evaluate(node_step(state, trial), history_,
                    trial.element_scratch.data() + first_scratch_, Mat3::Identity(),
                    ElementSink{force.data(), tangent, slots_.data()});
    return force;
  }
  /// Nodes on which elements of the group act, ascending.
  [[nodiscard]] std::vector<int> acted_on() const {
    std::vector<int> list;
    if (moving_) {
      list = blocks_.column;
    } else {
      for (int e = 0; e < group_.size(); ++e)
        list.insert(list.end(), group_.nodes(e).begin(), group_.nodes(e).end());
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }

 private:
  const Nodes& nodes_;
  const ElementGroup& group_;
  std::span<const int> slots_;
  const double* history_;
  std::size_t first_scratch_;
  const ChangingSparsity* moving_;  ///< Null: blocks of the graph.
  NodeBlocks blocks_;
};

void compare_group(const System& system, const State& state, Trial& trial, int g,
                   TangentReport& report) {
  const Nodes& nodes = system.nodes();
  const ElementGroup& group = nodes.group(g);
  const std::string name = format("{} of {}", group.kind(), quote(group.name()));
  const GroupForces forces(system, state, g);
  const std::vector<int> acted_on = forces.acted_on();
  if (!group.has_tangent() || forces.blocks().row.empty()) {
    report.left_out.push_back(format("{}, which {}", name,
                                     group.has_tangent() ? "has no contact in this step"
                                     : as_slide(group)   ? "eliminates its multipliers"
                                                         : "has no tangent"));
    return;
  }
  std::vector<double> tangent(9 * forces.blocks().row.size(), 0.0);
  (void)forces(state, trial, tangent.data());
  const double s = trial.scale(system), length = nodes.element_size();
  const auto size = 3 * static_cast<Eigen::Index>(nodes.count());
  Vec sizes = Vec::Zero(size);
  const auto each_entry = [&](auto&& visit) {
    for (std::size_t k = 0; k < forces.blocks().row.size(); ++k)
      for (int i = 0; i < 9; ++i)
        visit(3 * forces.blocks().row[k] + i / 3, 3 * forces.blocks().column[k] + i % 3,
              s * length * tangent[9 * k + static_cast<std::size_t>(i)]);
  };
  each_entry([&](int row, int, double v) { sizes[row] = std::max(sizes[row], std::abs(v)); });
  if (sizes.maxCoeff() == 0.0 && forces(state, trial, nullptr).isZero(0.0))
    report.left_out.push_back(format("{}, which exerts no force in this step", name));
  TangentColumns columns(sizes);
  TangentPart part{name, 0, static_cast<int>(acted_on.size()), {}};
  const int every = stride_of(part.of, kMaxNodes);
  for (int k = 0; k < part.of; k += every, ++part.compared)
    for (int c = 0; c < 3; ++c) {
      const int node = acted_on[static_cast<std::size_t>(k)], column = 3 * node + c;
      Vec analytic = Vec::Zero(size);
      each_entry([&](int row, int at, double v) {
        if (at == column) analytic[row] += v;
      });
      columns.compare(column, analytic, [&](double h) {
        move_node(state, trial, node, c, h * length);
        const Vec result = s * forces(state, trial, nullptr);
        move_node(state, trial, node, c, -h * length);
        return result;
      });
    }
  if (const TangentColumns::Entry& e = columns.worst(); e.row >= 0)
    part.worst = {
        e.error,
        e.analytic,
        e.numeric,
        name,
        format("force {} of {}", "xyz"[e.row % 3], nodes.node_name(e.row / 3)),
        format("displacement {} of {}", "xyz"[e.column % 3], nodes.node_name(e.column / 3))};
  part.kind = name;
  const int kinks = columns.kinks();
  if (part.compared < part.of)
    report.left_out.push_back(
        format("{} of {} nodes of {}", part.of - part.compared, part.of, name));
  part.of = part.compared;
  finish(std::move(part), kinks, report);
}

}  // namespace

std::string body_component(const System& system, int body, int component, const char* moved,
                           const char* turned) {
  return format("{} {} of body {}", component < 3 ? moved : turned, "xyz"[component % 3],
                quote(system.bodies()[static_cast<std::size_t>(body)].name));
}

int stride_of(int count, int most) { return std::max(1, (count + most - 1) / std::max(1, most)); }

void move_component(const System& system, const State& state, Trial& trial, int body,
                    const BodyStep& from, int component, double h) {
  const Vec3 d = h * Vec3::Unit(component % 3);
  move_body(state, trial, system.slot(body), component < 3 ? Vec3(from.u + d) : from.u,
            component < 3 ? from.theta : compose_cayley(d, from.theta));
}

void move_node(const State& state, Trial& trial, int node, int component, double h) {
  const auto k = static_cast<std::size_t>(3 * node + component);
  const StepContext& c = trial.context;
  trial.node_u[k] += h;
  trial.node_x[k] = state.node_x[k] + trial.node_u[k];
  trial.node_v[k] += c.ga.c / c.dt * h;
}

void check_interactions(const System& system, const State& state, Trial& trial,
                        TangentReport& report) {
  const std::vector<InteractionRef>& refs = system.interactions();
  std::vector<std::vector<const InteractionRef*>> by_group;
  for (const InteractionRef& ref : refs) {
    if (by_group.size() <= static_cast<std::size_t>(ref.group)) by_group.resize(ref.group + 1);
    by_group[static_cast<std::size_t>(ref.group)].push_back(&ref);
  }
  for (const auto& list : by_group) {
    if (list.empty()) continue;
    TangentPart part{
        system.group(list.front()->group).kind(), 0, static_cast<int>(list.size()), {}};
    int kinks = 0;
    const int every = stride_of(part.of, kMaxItems);
    for (int k = 0; k < part.of; k += every, ++part.compared)
      kinks += compare_interaction(system, state, trial, *list[static_cast<std::size_t>(k)], part);
    finish(std::move(part), kinks, report);
  }
}

void check_elements(const System& system, const State& state, Trial& trial, TangentReport& report) {
  for (int g = 0; g < system.nodes().group_count(); ++g)
    compare_group(system, state, trial, g, report);
}

/// Evaluates all pairs for each displacement: each body is displaced once for all its pairs.
void check_contacts(const System& system, const State& state, Trial& trial, TangentReport& report) {
  BodyContacts& contacts = *system.contacts();
  const auto n = static_cast<std::size_t>(system.body_count());
  std::vector<BodyStep> steps(n + 1);
  steps.back() = BodyStep::ground(trial.context.ga.alpha_f);
  for (std::size_t b = 0; b < n; ++b)
    steps[b] = body_step(system, state, trial, static_cast<int>(b));
  const double s = trial.scale(system), length = system.length_scale();
  std::vector<PairTerms> terms(contacts.pairs().size());
  for (PairTerms& t : terms) t.set_zero();
  StepContext context = trial.context;
  contacts.evaluate(steps, context, terms);
  context.tangents = false;

  const std::vector<Participants> pairs = contacts.pairs();
  std::vector<std::size_t> acting;
  std::vector<Mat> K;
  std::vector<TangentColumns> columns;
  std::vector<char> moves(n, 0);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (terms[k].wrench_a.isZero(0.0) && terms[k].wrench_b.isZero(0.0)) continue;
    const PairUnknowns pair{pairs[k].a, pairs[k].b, 0};
    acting.push_back(k);
    K.push_back(scaled_tangent(pair, terms[k], s, length));
    columns.emplace_back(row_sizes(K.back()));
    for (const int body : {pair.a, pair.b})
      if (body != kGround) moves[static_cast<std::size_t>(body)] = 1;
  }
  TangentPart part{"contact", 0, static_cast<int>(acting.size()), {}};
  if (acting.empty()) {
    report.left_out.push_back(
        format("contacts between bodies: none of the {} near pairs exerts a force in this step",
               pairs.size()));
    return;
  }
  std::vector<int> bodies;
  for (std::size_t b = 0; b < n; ++b)
    if (moves[b]) bodies.push_back(static_cast<int>(b));
  const int every = stride_of(static_cast<int>(bodies.size()), kMaxTouching);
  std::vector<char> seen(acting.size(), 0);
  for (std::size_t at = 0; at < bodies.size(); at += static_cast<std::size_t>(every)) {
    const int body = bodies[at];
    const BodyStep from = steps[static_cast<std::size_t>(body)];
    for (std::size_t i = 0; i < acting.size(); ++i) {
      const PairUnknowns pair{pairs[acting[i]].a, pairs[acting[i]].b, 0};
      if (pair.a != body && pair.b != body) continue;
      seen[i] = 1;
      for (int c = 0; c < 6; ++c) {
        const int column = (pair.a == body ? 0 : 6) + c;
        columns[i].compare(column, K[i].col(column), [&](double h) {
          move_component(system, state, trial, body, from, c, c < 3 ? h * length : h);
          steps[static_cast<std::size_t>(body)] = body_step(system, state, trial, body);
          contacts.evaluate(steps, context, terms);
          return scaled_values(pair, terms[acting[i]], nullptr, s);
        });
      }
    }
    move_body(state, trial, system.slot(body), from.u, from.theta);
    steps[static_cast<std::size_t>(body)] = from;
  }
  int kinks = 0;
  const auto name = [&](int body) {
    return body == kGround ? std::string("ground")
                           : quote(system.bodies()[static_cast<std::size_t>(body)].name);
  };
  for (std::size_t i = 0; i < acting.size(); ++i) {
    const PairUnknowns pair{pairs[acting[i]].a, pairs[acting[i]].b, 0};
    take(system, pair, columns[i], format("contact of {} and {}", name(pair.a), name(pair.b)),
         part);
    kinks += columns[i].kinks();
    part.compared += seen[i];
  }
  finish(std::move(part), kinks, report);
}

}  // namespace polhode
