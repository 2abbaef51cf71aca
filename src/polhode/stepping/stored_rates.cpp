// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/stored_rates.hpp>
#include <polhode/system/lane_access.hpp>

namespace polhode {

namespace {

/// Calls visit(number in the state, stored number, its rate) for every number of a, A and ḣ.
template <class Visit>
void for_each_number(State& state, const Visit& visit) {
  const auto lanes = [&](Lane3& x, Lane3& kept, Lane3& rate) {
    for (int i = 0; i < 3; ++i)
      for (int lane = 0; lane < kLanes; ++lane) visit(x[i][lane], kept[i][lane], rate[i][lane]);
  };
  for (std::size_t b = 0; b < state.rates.size(); ++b) {
    BodyBlock& block = state.blocks[b];
    RatesBlock& rates = state.rates[b];
    lanes(block.a, rates.a, rates.a_rate);
    lanes(block.A, rates.A, rates.A_rate);
    lanes(block.h_dot, rates.h_dot, rates.h_dot_rate);
  }
  const std::size_t nodes = state.node_rates.size() / 2;
  for (std::size_t k = 0; k < nodes; ++k)
    visit(state.node_a[k], state.node_rates[k], state.node_rates[nodes + k]);
}

}  // namespace

void begin_stored_rates(State& state, const GeneralizedAlpha& ga, double dt) {
  state.rates.assign(ga.delta == 0.0 ? 0 : state.blocks.size(), RatesBlock{});
  state.node_rates.assign(ga.delta == 0.0 ? 0 : 2 * state.node_a.size(), 0.0);
  state.rates_dt = dt;
  for_each_number(state, [](double& x, double& kept, double&) { kept = x; });
}

void set_stored_rate(State& state, int slot, const Vec3& a, const Vec3& A, const Vec3& h_dot) {
  RatesBlock& rates = state.rates.at(static_cast<std::size_t>(slot / kLanes));
  put(rates.a_rate, slot % kLanes, a);
  put(rates.A_rate, slot % kLanes, A);
  put(rates.h_dot_rate, slot % kLanes, h_dot);
}

/// @eq{stored-rates}
void adapt_stored_rates(State& state, const GeneralizedAlpha& ga, double dt) {
  const double later = ga.delta * (dt - state.rates_dt);
  for_each_number(state, [&](double& x, double& kept, double& rate) { x = kept + later * rate; });
}

void restore_stored_rates(State& state) {
  for_each_number(state, [](double& x, double& kept, double&) { x = kept; });
}

/// @eq{stored-rates-mean}
void renew_stored_rates(State& state, const GeneralizedAlpha& ga, double dt) {
  const double later = ga.delta * (dt - state.rates_dt);
  for_each_number(state, [&](double& x, double& kept, double& rate) {
    rate += kFreshRate * ((x - (kept + later * rate)) / dt - rate);
    kept = x;
  });
  state.rates_dt = dt;
}

}  // namespace polhode
