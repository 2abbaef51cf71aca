// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <polhode/contact/contact_set.hpp>
#include <polhode/simulation/contact_keeper.hpp>

namespace polhode {

namespace {

/// Totals: what impacts and friction took, the smallest gap and impacts that steps do not resolve
/// before those of pairs, and for each
/// pair: impulse, energy lost, whether its sensor overlaps. With impulses, last: sweeps, and steps
/// that did not converge.
constexpr std::size_t kHead = 4, kPerPair = 3, kImpulses = 2, kLeastGap = 2, kUnresolvedTime = 3;
/// No gap was small yet: totals are compared, which NaN would not stand.
constexpr double kNoGap = std::numeric_limits<double>::infinity();

}  // namespace

std::size_t ContactKeeper::total_count() const {
  return kHead + kPerPair * map_->pairs.size() + (contacts_->impulses() ? kImpulses : 0);
}

void ContactKeeper::begin(State& state) {
  if (!contacts_) return;
  totals_.assign(total_count(), 0.0);
  totals_[kLeastGap] = kNoGap;
  look(state, false);
}

void ContactKeeper::resume(const State& state) {
  if (!contacts_) return;
  totals_ = contact::ContactSet::totals_in(state);
  const std::size_t wanted = total_count();
  const ImpulseFigures search = impulse_figures();
  if (totals_.size() < kHead) totals_ = {0.0, 0.0, kNoGap, 0.0};
  if (totals_.size() != wanted) totals_.resize(kHead);  // other pairs are kept now
  totals_.resize(wanted, 0.0);
  if (!contacts_->impulses()) return;
  totals_[wanted - 2] = search.sweeps;
  totals_[wanted - 1] = search.unconverged;
}

void ContactKeeper::after_step(State& state) {
  if (contacts_) look(state, true);
}

void ContactKeeper::look(State& state, bool sum) {
  const std::vector<contact::ShapePairReport> all = contacts_->reports();
  points_ = contacts_->touching();
  wrenches_ = contacts_->wrenches();
  std::map<std::pair<int, int>, std::size_t> place;
  for (std::size_t k = 0; k < map_->pairs.size(); ++k)
    place[std::minmax(map_->pairs[k].a, map_->pairs[k].b)] = k;
  ContactReport none;
  none.gap = std::numeric_limits<double>::quiet_NaN();
  reports_.assign(map_->pairs.size(), none);
  double* totals = totals_.data();
  touching_ = 0;
  for (const contact::ShapePairReport& r : all) {
    if (r.points > 0) ++touching_;
    const int a = map_->body[static_cast<std::size_t>(r.a)];
    const int b = map_->body[static_cast<std::size_t>(r.b)];
    if (!contacts_->law(r.a, r.b).sensor) totals[kLeastGap] = std::fmin(totals[kLeastGap], r.gap);
    if (sum) {
      totals[0] += r.impact_loss;
      totals[1] += r.dissipated - r.impact_loss;
      totals[kUnresolvedTime] += r.unresolved;
    }
    const auto found = place.find(std::minmax(a, b));
    if (found == place.end()) continue;
    const double sign = a == map_->pairs[found->second].a ? 1.0 : -1.0;
    ContactReport& report = reports_[found->second];
    report.gap = std::fmin(report.gap, r.gap);
    report.normal_force += r.normal_force;
    report.force += sign * r.force;
    report.friction += sign * r.friction;
    report.point += r.normal_force * r.point;
    report.points += r.points;
    report.status = std::max(report.status, static_cast<int>(r.status));
    if (!sum) continue;
    totals[kHead + kPerPair * found->second] += r.normal_force * state.dt_last;
    totals[kHead + kPerPair * found->second + 1] += r.dissipated;
  }
  for (std::size_t k = 0; k < reports_.size(); ++k) {
    ContactReport& report = reports_[k];
    if (report.normal_force > 0.0) report.point /= report.normal_force;
    const std::string& sensor = map_->pairs[k].sensor;
    if (sensor.empty()) continue;
    report.status = report.gap < 0.0 ? 1 : 0;
    double& overlaps = totals[kHead + kPerPair * k + 2];
    if ((overlaps != 0.0) == (report.status != 0)) continue;
    overlaps = report.status;
    events_.push_back({state.t, sensor, report.status != 0});
  }
  if (contacts_->impulses() && sum) {
    totals[totals_.size() - 2] += contacts_->last_search().sweeps;
    totals[totals_.size() - 1] += contacts_->last_search().converged ? 0.0 : 1.0;
  }
  contacts_->keep_totals(state, totals_);
}

ContactReport ContactKeeper::report(int pair) const {
  const auto k = static_cast<std::size_t>(pair);
  ContactReport report;
  report.gap = std::numeric_limits<double>::quiet_NaN();
  if (k < reports_.size()) report = reports_[k];
  if (totals_.size() < kHead + kPerPair * (k + 1)) return report;
  report.impulse = totals_[kHead + kPerPair * k];
  report.energy_lost = totals_[kHead + kPerPair * k + 1];
  return report;
}

double ContactKeeper::unresolved() const {
  return totals_.size() > kUnresolvedTime ? totals_[kUnresolvedTime] : 0.0;
}

ImpulseFigures ContactKeeper::impulse_figures() const {
  if (!contacts_ || !contacts_->impulses() || totals_.size() < kHead + kImpulses) return {};
  return {totals_[totals_.size() - 2], totals_[totals_.size() - 1]};
}

double ContactKeeper::least_gap() const {
  const bool known = totals_.size() >= kHead && totals_[kLeastGap] < kNoGap;
  return known ? totals_[kLeastGap] : std::numeric_limits<double>::quiet_NaN();
}

ContactLosses ContactKeeper::losses() const {
  if (totals_.size() < kHead) return {};
  return {totals_[0], totals_[1]};
}

}  // namespace polhode
