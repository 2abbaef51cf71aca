// SPDX-License-Identifier: Apache-2.0
// Contact histories: transfer from step to step, to and from State::contacts.
#include <algorithm>
#include <cmath>

#include <polhode/contact/contact_set.hpp>
#include <polhode/core/error.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode::contact {

namespace {

/// Pose of a shape at the last search of candidates.
struct ReferenceRecord {
  double r[3], Lambda[9], margin;
};

/// Which two features of which two shapes meet at a point.
struct PairRecord {
  double a, b, kind, i, j;
};

/// A point with forces.
struct PointRecord {
  PairRecord pair;
  double bristle[3], normal[3], rolling[3];
  double torsion, approach, restitution, stiffness, reach, floor, force, bristle_stiffness;
  double closed, phase, slips, gap;
};

/// A point with impulses.
struct ImpulseRecord {
  PairRecord pair;
  double impulse[3], turning[3];
};

/// A point that is a row.
struct RowRecord {
  ImpulseRecord impulses;
  double closed, slips, kept, pressed, held;
  double point[3], normal[3];
};

/// The record behind others.
template <HistoryRecord R>
void append(std::vector<double>& out, const R& record) {
  out.resize(out.size() + kNumbersOf<R>);
  write_record(record, out.data() + out.size() - kNumbersOf<R>);
}

PairRecord record_of(int a, int b, const FeaturePair& f) {
  return {static_cast<double>(a), static_cast<double>(b), static_cast<double>(f.kind),
          static_cast<double>(f.i), static_cast<double>(f.j)};
}

FeaturePair pair_of(const PairRecord& r) {
  return {static_cast<GapKind>(static_cast<int>(r.kind)), static_cast<int>(r.i),
          static_cast<int>(r.j)};
}

RowRecord row_of(const ImpulseRecord& impulses, const PointHistory& h) {
  RowRecord row{impulses, h.closed ? 1.0 : 0.0, h.slips ? 1.0 : 0.0, h.kept, h.pressed, h.held, {},
                {}};
  set(row.point, h.point);
  set(row.normal, h.normal);
  return row;
}

}  // namespace

void ContactSet::save(State& state) {
  std::vector<double>& out = state.contacts;
  out.assign(1, static_cast<double>(totals_.size()));
  out.insert(out.end(), totals_.begin(), totals_.end());
  out.push_back(longest_step_);
  for (const Switch& s : switches_) out.push_back(s.off ? 1.0 : 0.0);
  for (const Reference& r : references_) {
    ReferenceRecord record;
    set(record.r, r.r);
    std::copy_n(r.Lambda.data(), 9, record.Lambda);
    record.margin = r.margin;
    append(out, record);
  }
  for (const Point& p : points_) {
    const PointHistory& h = p.data.history;
    if (!h.remembers()) continue;
    if (impulses_) {
      ImpulseRecord record;
      record.pair = record_of(p.a, p.b, p.data.pair);
      set(record.impulse, h.impulse);
      set(record.turning, h.turning);
      if (acts_by_rows())
        append(out, row_of(record, h));
      else
        append(out, record);
      continue;
    }
    PointRecord record;
    record.pair = record_of(p.a, p.b, p.data.pair);
    set(record.bristle, h.bristle);
    set(record.normal, h.normal);
    set(record.rolling, h.rolling);
    record.torsion = h.torsion;
    record.approach = h.approach;
    record.restitution = h.restitution;
    record.stiffness = h.stiffness;
    record.reach = h.reach;
    record.floor = h.floor;
    record.force = h.force;
    record.bristle_stiffness = h.bristle_stiffness;
    record.closed = h.closed ? 1.0 : 0.0;
    record.phase = static_cast<double>(h.phase);
    record.slips = h.slips ? 1.0 : 0.0;
    record.gap = h.gap;
    append(out, record);
  }
  saved_ = out;
  loaded_ = true;
}

void ContactSet::check_memory(const State& state, const std::string& where) const {
  const std::vector<double>& in = state.contacts;
  const auto require = [&](bool holds) {
    if (!holds)
      throw InputError(where, "has contacts that this model cannot have",
                       "Take another checkpoint; this one is damaged");
  };
  const auto is_whole = [](double x, double least, double most) {
    return x >= least && x <= most && x == std::floor(x);
  };
  if (in.empty()) return;
  require(is_whole(in[0], 0.0, static_cast<double>(in.size() - 1)));
  const std::size_t head = 2 + static_cast<std::size_t>(in[0]) + switches_.size();
  if (in.size() == head) return;
  const std::size_t points = head + kNumbersOf<ReferenceRecord> * references_.size();
  const std::size_t count = acts_by_rows() ? kNumbersOf<RowRecord>
                            : impulses_    ? kNumbersOf<ImpulseRecord>
                                           : kNumbersOf<PointRecord>;
  require(in.size() >= points && (in.size() - points) % count == 0);
  require(std::all_of(in.begin() + static_cast<std::ptrdiff_t>(head),
                      in.begin() + static_cast<std::ptrdiff_t>(points),
                      [](double x) { return std::isfinite(x); }));
  const double last_shape = static_cast<double>(shapes_.size()) - 1.0, last_feature = 0x7fffffff;
  for (std::size_t at = points; at < in.size(); at += count) {
    const auto pair = read_record<PairRecord>(in.data() + at);
    require(is_whole(pair.a, 0.0, last_shape) && is_whole(pair.b, 0.0, last_shape) &&
            is_whole(pair.kind, 0.0, static_cast<double>(GapKind::rim_bar)) &&
            is_whole(pair.i, -1.0, last_feature) && is_whole(pair.j, -1.0, last_feature));
    if (!impulses_)
      require(is_whole(read_record<PointRecord>(in.data() + at).phase, 0.0,
                       static_cast<double>(ContactPhase::restitution)));
  }
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
  const std::size_t references = head + kNumbersOf<ReferenceRecord> * references_.size();
  if (in.size() < references) return;
  for (std::size_t k = 0; k < references_.size(); ++k) {
    const auto record =
        read_record<ReferenceRecord>(in.data() + head + kNumbersOf<ReferenceRecord> * k);
    references_[k].r = Vec3(record.r);
    references_[k].Lambda = Mat3(record.Lambda);
    references_[k].margin = record.margin;
  }
  // Points that carry only their histories: find_candidates() hands these on.
  const std::size_t count = acts_by_rows() ? kNumbersOf<RowRecord>
                            : impulses_    ? kNumbersOf<ImpulseRecord>
                                           : kNumbersOf<PointRecord>;
  for (std::size_t at = references; at + count <= in.size(); at += count) {
    const double* here = in.data() + at;
    const auto pair = read_record<PairRecord>(here);
    Point p;
    p.a = static_cast<int>(pair.a);
    p.b = static_cast<int>(pair.b);
    p.data.pair = pair_of(pair);
    PointHistory& h = p.data.history;
    if (impulses_) {
      const auto record = read_record<ImpulseRecord>(here);
      h.impulse = Vec3(record.impulse);
      h.turning = Vec3(record.turning);
      if (acts_by_rows()) {
        const auto row = read_record<RowRecord>(here);
        h.closed = row.closed != 0.0;
        h.slips = row.slips != 0.0;
        h.kept = row.kept;
        h.pressed = row.pressed;
        h.held = row.held;
        h.point = Vec3(row.point);
        h.normal = Vec3(row.normal);
      }
      points_.push_back(p);
      continue;
    }
    const auto record = read_record<PointRecord>(here);
    h.bristle = Vec3(record.bristle);
    h.normal = Vec3(record.normal);
    h.rolling = Vec3(record.rolling);
    h.torsion = record.torsion;
    h.approach = record.approach;
    h.restitution = record.restitution;
    h.stiffness = record.stiffness;
    h.reach = record.reach;
    h.floor = record.floor;
    h.force = record.force;
    h.bristle_stiffness = record.bristle_stiffness;
    h.closed = record.closed != 0.0;
    h.phase = static_cast<ContactPhase>(static_cast<int>(record.phase));
    h.slips = record.slips != 0.0;
    h.gap = record.gap;
    points_.push_back(p);
  }
}

std::vector<ClosedRow> ContactSet::closed_rows(const State& state) const {
  std::vector<ClosedRow> rows;
  const std::vector<double>& in = state.contacts;
  if (!acts_by_rows() || in.empty()) return rows;
  const std::size_t first = 2 + static_cast<std::size_t>(in[0]) + switches_.size() +
                            kNumbersOf<ReferenceRecord> * references_.size();
  for (std::size_t at = first; at + kNumbersOf<RowRecord> <= in.size();
       at += kNumbersOf<RowRecord>) {
    const auto row = read_record<RowRecord>(in.data() + at);
    if (row.closed == 0.0 || !(row.pressed > 0.0)) continue;
    const PairRecord& pair = row.impulses.pair;
    const auto body = [&](double shape) { return shapes_[static_cast<std::size_t>(shape)].body; };
    rows.push_back({.features = {pair.a, pair.b, pair.kind, pair.i, pair.j},
                    .bodies = {body(pair.a), body(pair.b)},
                    .point = Vec3(row.point),
                    .normal = Vec3(row.normal),
                    .impulse = Vec3(row.impulses.impulse),
                    .turning = Vec3(row.impulses.turning),
                    .pressed = row.pressed,
                    .held = row.held,
                    .slips = row.slips != 0.0});
  }
  return rows;
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
