// SPDX-License-Identifier: Apache-2.0
// Contact histories: transfer from step to step, to and from State::contacts.
#include <algorithm>

#include <polhode/contact/contact_set.hpp>

namespace polhode::contact {

namespace {

/// Numbers per point in State::contacts, which follow those of the references.
constexpr std::size_t kPointNumbers = 26, kImpulseNumbers = 11;
constexpr std::size_t kReferenceNumbers = 13;

}  // namespace

void ContactSet::save(State& state) {
  std::vector<double>& out = state.contacts;
  out.assign(1, static_cast<double>(totals_.size()));
  out.insert(out.end(), totals_.begin(), totals_.end());
  out.push_back(longest_step_);
  for (const Switch& s : switches_) out.push_back(s.off ? 1.0 : 0.0);
  const auto put = [&](const auto& x) { out.insert(out.end(), x.data(), x.data() + x.size()); };
  for (const Reference& r : references_) {
    put(r.r);
    put(r.Lambda);
    out.push_back(r.margin);
  }
  for (const Point& p : points_) {
    const PointHistory& h = p.data.history;
    if (!h.remembers()) continue;
    const FeaturePair& f = p.data.pair;
    for (const double x :
         {static_cast<double>(p.a), static_cast<double>(p.b), static_cast<double>(f.kind),
          static_cast<double>(f.i), static_cast<double>(f.j)})
      out.push_back(x);
    if (impulses_) {
      put(h.impulse);
      put(h.turning);
      continue;
    }
    put(h.bristle);
    put(h.normal);
    put(h.rolling);
    for (const double x : {h.torsion, h.approach, h.restitution, h.stiffness, h.reach, h.floor,
                           h.force, h.bristle_stiffness, h.closed ? 1.0 : 0.0,
                           static_cast<double>(h.phase), h.slips ? 1.0 : 0.0, h.gap})
      out.push_back(x);
  }
  saved_ = out;
  loaded_ = true;
}

void ContactSet::load(const State& state) {
  const std::vector<double>& in = state.contacts;
  points_.clear();
  pairs_.clear();
  loaded_ = true;
  saved_ = in;
  for (Reference& r : references_) r.margin = -1.0;
  longest_step_ = 0.0;
  for (Switch& s : switches_) s.off = s.starts_off;
  if (in.empty()) return;
  totals_ = totals_in(state);
  const std::size_t first = 2 + totals_.size(), head = first + switches_.size();
  if (in.size() < head) return;
  longest_step_ = in[first - 1];
  for (std::size_t k = 0; k < switches_.size(); ++k) switches_[k].off = in[first + k] != 0.0;
  const std::size_t references = head + kReferenceNumbers * references_.size();
  if (in.size() < references) return;
  for (std::size_t k = 0; k < references_.size(); ++k) {
    const double* x = in.data() + head + kReferenceNumbers * k;
    references_[k].r = Eigen::Map<const Vec3>(x);
    references_[k].Lambda = Eigen::Map<const Mat3>(x + 3);
    references_[k].margin = x[12];
  }
  // Points that carry only their histories: find_candidates() hands these on.
  const std::size_t count = impulses_ ? kImpulseNumbers : kPointNumbers;
  for (std::size_t at = references; at + count <= in.size(); at += count) {
    const double* x = in.data() + at;
    Point p;
    p.a = static_cast<int>(x[0]);
    p.b = static_cast<int>(x[1]);
    p.data.pair = {static_cast<GapKind>(static_cast<int>(x[2])), static_cast<int>(x[3]),
                   static_cast<int>(x[4])};
    PointHistory& h = p.data.history;
    if (impulses_) {
      h.impulse = Eigen::Map<const Vec3>(x + 5);
      h.turning = Eigen::Map<const Vec3>(x + 8);
      points_.push_back(p);
      continue;
    }
    h.bristle = Eigen::Map<const Vec3>(x + 5);
    h.normal = Eigen::Map<const Vec3>(x + 8);
    h.rolling = Eigen::Map<const Vec3>(x + 11);
    h.torsion = x[14];
    h.approach = x[15];
    h.restitution = x[16];
    h.stiffness = x[17];
    h.reach = x[18];
    h.floor = x[19];
    h.force = x[20];
    h.bristle_stiffness = x[21];
    h.closed = x[22] != 0.0;
    h.phase = static_cast<ContactPhase>(static_cast<int>(x[23]));
    h.slips = x[24] != 0.0;
    h.gap = x[25];
    points_.push_back(p);
  }
}

void ContactSet::keep_totals(State& state, const std::vector<double>& totals) {
  totals_ = totals;
  if (state.contacts.size() <= totals.size()) return;  // nothing was saved yet
  const bool own = saved_ == state.contacts;  // otherwise the points are those of another step
  const auto before = static_cast<std::ptrdiff_t>(state.contacts[0]);
  state.contacts.erase(state.contacts.begin() + 1, state.contacts.begin() + 1 + before);
  state.contacts[0] = static_cast<double>(totals.size());
  state.contacts.insert(state.contacts.begin() + 1, totals.begin(), totals.end());
  if (own) saved_ = state.contacts;
}

std::vector<double> ContactSet::totals_in(const State& state) {
  if (state.contacts.empty()) return {};
  const double count = std::min(state.contacts[0], static_cast<double>(state.contacts.size() - 1));
  return {state.contacts.begin() + 1, state.contacts.begin() + 1 + static_cast<int>(count)};
}

}  // namespace polhode::contact
