// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <polhode/contact/contact_set.hpp>
#include <polhode/simulation/contact_statistics.hpp>

namespace polhode {

namespace {

/// Layout of the totals: losses by impacts and friction, the smallest gap, the number of
/// unresolved impacts, the number of steps with overlaps near the floor of springs and the first
/// pair of shapes with one; then for each pair impulse, energy loss, whether its sensor overlaps;
/// with impulses at the end: sweeps, and steps that did not converge.
constexpr std::size_t kHead = 7, kPerPair = 3, kImpulses = 2, kMinGap = 2, kUnresolvedTime = 3,
                      kNearFloor = 4;
/// Value for no small gap so far: totals are compared, which NaN does not allow.
constexpr double kNoGap = std::numeric_limits<double>::infinity();

}  // namespace

std::size_t ContactStatistics::total_count() const {
  return kHead + kPerPair * map_->pairs.size() + (contacts_->impulses() ? kImpulses : 0);
}

void ContactStatistics::begin(State& state) {
  if (!contacts_) return;
  totals_.assign(total_count(), 0.0);
  totals_[kMinGap] = kNoGap;
  see(state);
  summed_ = true;  // there was no step
  totals_[kMinGap] = seen_.least_gap;
  note_sensors(state);
  contacts_->keep_totals(state, totals_);
}

void ContactStatistics::resume(const State& state) {
  if (!contacts_) return;
  contacts_->check_memory(state, "restart");
  totals_ = contact::ContactSet::totals_in(state);
  const std::size_t wanted = total_count();
  const ImpulseFigures search = impulse_figures();
  if (totals_.size() < kHead) totals_ = {0.0, 0.0, kNoGap, 0.0, 0.0, 0.0, 0.0};
  if (totals_.size() != wanted) totals_.resize(kHead);  // the stored pairs have changed
  totals_.resize(wanted, 0.0);
  if (!contacts_->impulses()) return;
  totals_[wanted - 2] = search.sweeps;
  totals_[wanted - 1] = search.unconverged;
}

void ContactStatistics::see(const State& state) {
  if (!contacts_) return;
  std::map<std::pair<Side, Side>, std::size_t> place;
  for (std::size_t k = 0; k < map_->pairs.size(); ++k)
    place[std::minmax(map_->pairs[k].a, map_->pairs[k].b)] = k;
  ContactReport none;
  none.gap = std::numeric_limits<double>::quiet_NaN();
  ContactsSeen& seen = seen_;
  seen.points = contacts_->touching();
  seen.wrenches = contacts_->wrenches();
  seen.reports.assign(map_->pairs.size(), none);
  seen.touching = 0;
  seen.least_gap = kNoGap;
  seen.impact_loss = seen.friction_loss = seen.unresolved = 0.0;
  seen.near_floor.reset();
  for (const contact::ShapePairReport& r : contacts_->reports()) {
    if (r.points > 0) ++seen.touching;
    const Side a = map_->body[static_cast<std::size_t>(r.a)];
    const Side b = map_->body[static_cast<std::size_t>(r.b)];
    if (!contacts_->law(r.a, r.b).sensor) seen.least_gap = std::fmin(seen.least_gap, r.gap);
    seen.impact_loss += r.impact_loss;
    seen.friction_loss += r.dissipated - r.impact_loss;
    seen.unresolved += r.unresolved;
    if (r.near_floor && !seen.near_floor) seen.near_floor = {r.a, r.b};
    const auto found = place.find(std::minmax(a, b));
    if (found == place.end()) continue;
    const double sign = a == map_->pairs[found->second].a ? 1.0 : -1.0;
    ContactReport& report = seen.reports[found->second];
    report.gap = std::fmin(report.gap, r.gap);
    report.normal_force += r.normal_force;
    report.force += sign * r.force;
    report.friction += sign * r.friction;
    report.point += r.normal_force * r.point;
    report.points += r.points;
    report.status = std::max(report.status, static_cast<int>(r.status));
    report.impulse += r.normal_force * state.dt_last;
    report.energy_lost += r.dissipated;
  }
  for (std::size_t k = 0; k < seen.reports.size(); ++k) {
    ContactReport& report = seen.reports[k];
    if (report.normal_force > 0.0) report.point /= report.normal_force;
    if (!map_->pairs[k].sensor.empty()) report.status = report.gap < 0.0 ? 1 : 0;
  }
  if (contacts_->impulses())
    seen.search = {static_cast<double>(contacts_->last_search().sweeps),
                   contacts_->last_search().converged ? 0.0 : 1.0};
  summed_ = false;
}

void ContactStatistics::after_step(State& state) {
  if (!contacts_) return;
  double* totals = totals_.data();
  totals[0] += seen_.impact_loss;
  totals[1] += seen_.friction_loss;
  totals[kUnresolvedTime] += seen_.unresolved;
  totals[kMinGap] = std::fmin(totals[kMinGap], seen_.least_gap);
  if (seen_.near_floor && totals[kNearFloor]++ == 0.0) {
    totals[kNearFloor + 1] = seen_.near_floor->first;
    totals[kNearFloor + 2] = seen_.near_floor->second;
  }
  for (std::size_t k = 0; k < seen_.reports.size(); ++k) {
    totals[kHead + kPerPair * k] += seen_.reports[k].impulse;
    totals[kHead + kPerPair * k + 1] += seen_.reports[k].energy_lost;
  }
  if (contacts_->impulses()) {
    totals[totals_.size() - 2] += seen_.search.sweeps;
    totals[totals_.size() - 1] += seen_.search.unconverged;
  }
  summed_ = true;
  note_sensors(state);
  contacts_->keep_totals(state, totals_);
}

void ContactStatistics::note_sensors(State& state) {
  for (std::size_t k = 0; k < seen_.reports.size(); ++k) {
    const std::string& sensor = map_->pairs[k].sensor;
    if (sensor.empty()) continue;
    double& overlaps = totals_[kHead + kPerPair * k + 2];
    const int status = seen_.reports[k].status;
    if ((overlaps != 0.0) == (status != 0)) continue;
    overlaps = status;
    events_.push_back({state.t, sensor, status != 0});
  }
}

ContactReport ContactStatistics::report(int pair) const {
  const auto k = static_cast<std::size_t>(pair);
  ContactReport report;
  report.gap = std::numeric_limits<double>::quiet_NaN();
  if (k < seen_.reports.size()) report = seen_.reports[k];
  if (summed_) report.impulse = report.energy_lost = 0.0;
  if (totals_.size() < kHead + kPerPair * (k + 1)) return report;
  report.impulse += totals_[kHead + kPerPair * k];
  report.energy_lost += totals_[kHead + kPerPair * k + 1];
  return report;
}

double ContactStatistics::unresolved() const {
  return totals_.size() > kUnresolvedTime ? totals_[kUnresolvedTime] : 0.0;
}

ContactStatistics::NearFloor ContactStatistics::near_floor() const {
  if (totals_.size() < kHead || totals_[kNearFloor] == 0.0) return {};
  const std::vector<contact::PlacedShape>& shapes = contacts_->shapes();
  const auto name = [&](double shape) -> std::string {
    if (!(shape >= 0.0 && shape < static_cast<double>(shapes.size()))) return "";
    return shapes[static_cast<std::size_t>(shape)].name;
  };
  return {static_cast<std::int64_t>(totals_[kNearFloor]), name(totals_[kNearFloor + 1]),
          name(totals_[kNearFloor + 2])};
}

ImpulseFigures ContactStatistics::impulse_figures() const {
  if (!contacts_ || !contacts_->impulses() || totals_.size() < kHead + kImpulses) return {};
  return {totals_[totals_.size() - 2], totals_[totals_.size() - 1]};
}

double ContactStatistics::least_gap() const {
  const bool known = totals_.size() >= kHead && totals_[kMinGap] < kNoGap;
  return known ? totals_[kMinGap] : std::numeric_limits<double>::quiet_NaN();
}

ContactLosses ContactStatistics::losses() const {
  if (totals_.size() < kHead) return {};
  return {totals_[0], totals_[1]};
}

}  // namespace polhode
