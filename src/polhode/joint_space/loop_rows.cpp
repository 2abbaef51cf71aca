// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/core/format.hpp>
#include <polhode/joint_space/loop_rows.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/stepping/start.hpp>

namespace polhode {

namespace {

bool has(std::span<const std::string> list, const std::string& name) {
  return std::ranges::find(list, name) != list.end();
}

/// The model with bodies, joints and rows alone.
Model with_rows_alone(const Model& model, std::span<const std::string> released) {
  Model bare;
  for (BodySpec body : model.bodies) {
    body.shapes.clear();
    body.contact = {};
    bare.bodies.push_back(std::move(body));
  }
  for (JointSpec joint : model.joints) {
    joint.friction.reset();
    joint.limits.reset();
    joint.angle_limits.reset();
    joint.breaks = {};
    joint.enforcement.reset();
    bare.joints.push_back(std::move(joint));
  }
  for (const LoadSpec& load : model.loads) {
    if (load.solid >= 0 || load.of_motion.index() != 0 || has(released, load.name)) continue;
    const LoadKind& kind = load_kind(load.type);
    if (kind.parts > 1 || !kind.drives.empty()) continue;
    bare.loads.push_back(load);
  }
  return bare;
}

}  // namespace

LoopRows::LoopRows(const Model& model, const TreeSpace& tree, std::span<const std::string> released)
    : tree_(tree), system_(build_system(with_rows_alone(model, released), &map_)) {
  model_body_.assign(static_cast<std::size_t>(system_.body_count()), kGround);
  for (std::size_t i = 0; i < map_.body.size(); ++i)
    if (map_.body[i] != kGround)
      model_body_[static_cast<std::size_t>(map_.body[i])] = static_cast<int>(i);
  std::vector<char> skipped(system_.interactions().size(), 0);
  for (std::size_t i = 0; i < map_.joint.size(); ++i)
    if (tree.has(static_cast<int>(i)) || has(released, model.joints[i].name))
      skipped[static_cast<std::size_t>(map_.joint[i])] = 1;
  std::vector<int> first_row(system_.interactions().size(), -1);
  for (std::size_t i = 0; i < system_.interactions().size(); ++i) {
    const InteractionRef& ref = system_.interactions()[i];
    const InteractionTraits& traits = system_.traits(ref);
    if (skipped[i] != 0 || ref.rows == 0 || traits.compliant || traits.prescribes) continue;
    if (ref.further_part) {
      first_row[i] = first_row[static_cast<std::size_t>(ref.first_part)];
    } else {
      first_row[i] = rows_;
      rows_ += ref.rows;
    }
    sources_.push_back({static_cast<int>(i), first_row[i]});
  }
  State state = system_.initial_state();
  initialize_histories(system_, state);
  first_history_ = {state.history, Eigen::VectorXd::Zero(rows_)};
}

LoopRows::History LoopRows::history_at(const JointSpace::Motions& motions,
                                       const TreeSpace::Sweep& sweep) const {
  History history = first_history_;
  for (const Source& source : sources_) {
    const InteractionRef& ref =
        system_.interactions()[static_cast<std::size_t>(source.interaction)];
    if (system_.traits(ref).history_size == 0) continue;
    const PairView seen = view(ref, motions, history);
    system_.group(ref.group).initialize(ref.item, seen.step(),
                                        history.values.data() + ref.first_history);
  }
  const Eigen::VectorXd g = at(motions, sweep, history).g;
  for (const Source& source : sources_) {
    const InteractionRef& ref =
        system_.interactions()[static_cast<std::size_t>(source.interaction)];
    if (system_.group(ref.group).kind() != Joint::kKind)
      history.g.segment(source.first_row, ref.rows) = g.segment(source.first_row, ref.rows);
  }
  return history;
}

PairView LoopRows::view(const InteractionRef& ref, const JointSpace::Motions& motions,
                        const History& history) const {
  const auto step_of = [&](int body) {
    if (body == kGround) return BodyStep::ground(1.0);
    const BodyMotion& m =
        motions[static_cast<std::size_t>(model_body_[static_cast<std::size_t>(body)])];
    return BodyStep::at_instant(m.r, m.Lambda(), m.v, m.W);
  };
  static constexpr double kNoMultipliers[kMaxRows] = {};
  PairView view{step_of(ref.a),
                step_of(ref.b),
                {},
                kNoMultipliers,
                history.values.data() + ref.first_history};
  view.context.ga = GeneralizedAlpha::from_spectral_radius(0.0);
  view.context.conserving = false;
  return view;
}

LoopRows::Values LoopRows::at(const JointSpace::Motions& motions, const TreeSpace::Sweep& sweep,
                              const History& history) const {
  Values v;
  v.G = Eigen::MatrixXd::Zero(rows_, tree_.size());
  v.gamma = Eigen::VectorXd::Zero(rows_);
  v.g = -history.g;
  for (const Source& source : sources_) {
    const InteractionRef& ref =
        system_.interactions()[static_cast<std::size_t>(source.interaction)];
    const InteractionGroup& group = system_.group(ref.group);
    const PairView seen = view(ref, motions, history);
    const PairStep step = seen.step();
    PairTerms terms;
    terms.set_zero();
    group.evaluate({&ref.item, 1}, {&step, 1}, {&terms, 1});
    Vec6 gamma = Vec6::Zero();
    if (!sweep.acceleration.empty()) group.acceleration_terms(ref.item, step, gamma);
    for (const auto& [body, G] : {std::pair(ref.a, &terms.G_a), std::pair(ref.b, &terms.G_b)}) {
      if (body == kGround) continue;
      const int of = model_body_[static_cast<std::size_t>(body)];
      const BodyMotion& m = motions[static_cast<std::size_t>(of)];
      const Eigen::MatrixXd J = tree_.jacobian(sweep, of, m.r);
      v.G.middleRows(source.first_row, ref.rows) += G->topRows(ref.rows) * J;
      if (J.size() > 0)
        v.scale = std::max(v.scale, (G->topRows(ref.rows).cwiseAbs() * J.cwiseAbs()).maxCoeff());
      if (sweep.acceleration.empty()) continue;
      const MotionVector& by = sweep.acceleration[static_cast<std::size_t>(of)];
      const Vec3 omega = sweep.twist[static_cast<std::size_t>(of)].angular;
      Vec6 acceleration;
      acceleration << by.at(m.r) + omega.cross(m.v), by.angular;
      gamma += *G * acceleration;
    }
    v.g.segment(source.first_row, ref.rows) += terms.g.head(ref.rows);
    v.gamma.segment(source.first_row, ref.rows) += gamma.head(ref.rows);
  }
  return v;
}

void LoopRows::follow(const JointSpace::Motions& motions, History& history) const {
  for (const Source& source : sources_) {
    const InteractionRef& ref =
        system_.interactions()[static_cast<std::size_t>(source.interaction)];
    const InteractionTraits& traits = system_.traits(ref);
    if (traits.history_size == 0) continue;
    const PairView seen = view(ref, motions, history);
    const auto now = history.values.begin() + ref.first_history;
    std::vector<double> next(now, now + traits.history_size);
    system_.group(ref.group).commit(ref.item, seen.step(), next.data());
    std::ranges::copy(next, now);
  }
}

std::string LoopRows::name_of(int row) const {
  for (const Source& source : sources_) {
    const InteractionRef& ref =
        system_.interactions()[static_cast<std::size_t>(source.interaction)];
    if (row >= source.first_row && row < source.first_row + ref.rows)
      return format("{} '{}'", system_.group(ref.group).kind(), system_.name(ref));
  }
  return "";
}

}  // namespace polhode
