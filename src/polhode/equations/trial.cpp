// SPDX-License-Identifier: Apache-2.0
#include <polhode/equations/trial.hpp>
#include <polhode/system/lane_access.hpp>

namespace polhode {

void size_blocks(const State& state, Trial& trial) {
  trial.blocks.assign(state.blocks.size() + 1, TrialBlock{});
  TrialBlock& ground = trial.blocks.back();
  for (int lane = 0; lane < kLanes; ++lane) {
    put(ground.Lambda, lane, Mat3::Identity());
    put(ground.Lambda_n, lane, Mat3::Identity());
  }
}

void start_trial(const System& system, const State& state, Trial& trial) {
  size_blocks(state, trial);
  for (int slot = 0; slot < system.tree().slots; ++slot) {
    const int body = system.tree().body_of_slot[slot];
    const BodyMotion m = state.motion(slot);
    const Mat3 Lambda = m.Lambda();
    const Mat3 J_r = body < 0 ? Mat3::Identity() : system.bodies()[body].inertia;
    TrialBlock& t = trial.blocks[slot / kLanes];
    const int lane = slot % kLanes;
    put(t.Lambda_n, lane, Lambda);
    put(t.h_n, lane, Lambda * (J_r * m.W));
    move_body(state, trial, slot, Vec3::Zero(), Vec3::Zero());
  }
  trial.lambda = state.lambda;
  trial.lambda_centre.assign(state.lambda.size(), 0.0);
}

/// @eq{eq:td-Newmark-COM} @eq{eq:td-Newmark-mrot} @eq{eq:td-incremental-rotation}
void update_body_step(const System& system, const State& state, const Trial& trial, int body,
                      BodyStep& s, bool rates) {
  const int slot = system.slot(body), lane = slot % kLanes;
  const TrialBlock& t = trial.blocks[slot / kLanes];
  s.r_n1 = get(t.r, lane);
  s.Lambda_n1 = get(t.Lambda, lane);
  s.u = get(t.u, lane);
  s.theta = get(t.theta, lane);
  if (!rates) return;
  const GeneralizedAlpha& ga = trial.context.ga;
  s.v_n1 = s.rate * s.u + (1.0 - ga.c) * s.v_n;
  s.W_n1 = s.rate * (s.Lambda_n.transpose() * s.theta) + (1.0 - ga.c) * s.W_n;
  if (ga.c_A == 0.0) return;
  const BodyBlock& n = state.blocks[slot / kLanes];
  s.v_n1 += trial.context.dt * ga.c_A * get(n.a, lane);
  s.W_n1 += trial.context.dt * ga.c_A * get(n.A, lane);
}

BodyStep body_step(const System& system, const State& state, const Trial& trial, int body) {
  const GeneralizedAlpha& ga = trial.context.ga;
  if (body == kGround) return BodyStep::ground(ga.alpha_f);
  const int slot = system.slot(body), lane = slot % kLanes;
  const BodyBlock& n = state.blocks[slot / kLanes];
  BodyStep s;
  s.r_n = get(n.r, lane);
  s.Lambda_n = get(trial.blocks[slot / kLanes].Lambda_n, lane);
  s.v_n = get(n.v, lane);
  s.a_n = get(n.a, lane);
  s.W_n = get(n.W, lane);
  s.alpha_f = ga.alpha_f;
  s.rate = ga.c / trial.context.dt;
  update_body_step(system, state, trial, body, s, true);
  return s;
}

PairView pair_view(const System& system, const State& state, const Trial& trial,
                   const InteractionRef& ref) {
  return {body_step(system, state, trial, ref.a), body_step(system, state, trial, ref.b),
          trial.context, trial.lambda.data() + ref.first_row,
          state.history.data() + ref.first_history};
}

/// @eq{eq:ga-rotation-iterations}
void move_body(const State& state, Trial& trial, int slot, const Vec3& u, const Vec3& theta) {
  const int lane = slot % kLanes;
  TrialBlock& t = trial.blocks[slot / kLanes];
  put(t.u, lane, u);
  put(t.theta, lane, theta);
  put(t.r, lane, get(state.blocks[slot / kLanes].r, lane) + u);
  put(t.Lambda, lane, cay(theta) * get(t.Lambda_n, lane));
}

}  // namespace polhode
