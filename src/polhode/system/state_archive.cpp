// SPDX-License-Identifier: Apache-2.0
#include <polhode/system/state_archive.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/sha256.hpp>

namespace polhode {

namespace {

static_assert(std::endian::native == std::endian::little,
              "state archives are little endian; write the bytes in that order here");

class Writer {
 public:
  template <class T>
  void operator()(const T& value) {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) == 8);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  /// A number of the motion.
  void motion(double value) { (*this)(value); }
  void motions(const std::vector<double>& values) { (*this)(values); }
  /// A length that is 1.
  void unit(double /*length*/) const {}
  /// A whole number from `least` to `most`.
  void whole(std::int64_t value, std::int64_t /*least*/, std::int64_t /*most*/) { (*this)(value); }
  void operator()(const std::vector<double>& values) {
    (*this)(static_cast<std::int64_t>(values.size()));
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  }
  /// A list with `count` entries or none; blocks are followed by their bodies.
  template <class T>
  void optional(const std::vector<T>& list, std::size_t /*count*/) {
    whole(list.empty() ? 0 : 1, 0, 1);
    if constexpr (std::is_arithmetic_v<T>)
      if (!list.empty()) (*this)(list);
  }
  /// A list of any length.
  void sized(const std::vector<double>& values) { (*this)(values); }
  std::string bytes;
};

class Reader {
 public:
  Reader(std::string_view bytes, std::string_view where) : bytes_(bytes), where_(where) {}

  template <class T>
  void operator()(T& value) {
    static_assert(std::is_arithmetic_v<T> && sizeof(T) == 8);
    take(&value, sizeof(T));
  }
  void motion(double& value) {
    (*this)(value);
    if (!(std::abs(value) < kLargest)) throw InputError(where_, "is no state", kHint);
  }
  void motions(std::vector<double>& values) {
    (*this)(values);
    for (const double value : values)
      if (!(std::abs(value) < kLargest)) throw InputError(where_, "is no state", kHint);
  }
  void unit(double length) const {
    if (!(std::abs(length - 1.0) < kUnitSlack)) throw InputError(where_, "is no state", kHint);
  }
  template <class Whole>
  void whole(Whole& value, std::int64_t least, std::int64_t most) {
    std::int64_t wide = 0;
    (*this)(wide);
    if (wide < least || wide > most) throw InputError(where_, "is no state", kHint);
    value = static_cast<Whole>(wide);
  }
  /// A list of the length required by the system.
  void operator()(std::vector<double>& values) {
    std::int64_t count = 0;
    (*this)(count);
    expect(count, static_cast<std::int64_t>(values.size()), "numbers in a list");
    take(values.data(), values.size() * sizeof(double));
  }
  template <class T>
  void optional(std::vector<T>& list, std::size_t count) {
    int there = 0;
    whole(there, 0, 1);
    list.assign(there == 1 ? count : 0, T{});
    if constexpr (std::is_arithmetic_v<T>)
      if (!list.empty()) (*this)(list);
  }
  void sized(std::vector<double>& values) {
    std::int64_t count = 0;
    (*this)(count);
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() / sizeof(double))
      throw InputError(where_, "ends in the middle of a list", kHint);
    values.resize(static_cast<std::size_t>(count));
    take(values.data(), values.size() * sizeof(double));
  }
  void expect(std::int64_t found, std::int64_t wanted, const char* what) const {
    if (found != wanted)
      throw InputError(where_, format("holds {} {}, but the model has {}", found, what, wanted),
                       "Give the model that the state was written with");
  }
  void expect_end() const {
    if (!bytes_.empty()) throw InputError(where_, "is longer than a state", kHint);
  }

 private:
  static constexpr const char* kHint = "Take another checkpoint; this one is damaged";
  /// Bound of the numbers of a motion, so that their squares and differences are finite.
  static constexpr double kLargest = 1e150;
  /// Bound of the rounding of unit quaternions, which runs keep at 1e-15.
  static constexpr double kUnitSlack = 1e-6;

  void take(void* target, std::size_t size) {
    if (size > bytes_.size()) throw InputError(where_, "ends in the middle of a state", kHint);
    std::copy_n(bytes_.data(), size, static_cast<char*>(target));  // memcpy must not get null
    bytes_.remove_prefix(size);
  }

  std::string_view bytes_;
  std::string_view where_;
};

/// All numbers of one body, in a fixed order.
template <class Archive, class Block>
void body(Archive& archive, Block& block, int lane) {
  const auto lane3 = [&](auto& x) {
    for (int i = 0; i < 3; ++i) archive.motion(x[i][lane]);
  };
  lane3(block.r);
  lane3(block.r_rest);
  double square = 0.0;
  for (int i = 0; i < 4; ++i) {
    archive.motion(block.q[i][lane]);
    square += block.q[i][lane] * block.q[i][lane];
  }
  archive.unit(std::sqrt(square));
  lane3(block.v);
  lane3(block.W);
  lane3(block.a);
  lane3(block.A);
  lane3(block.h_dot);
  for (int k = 0; k < kPast; ++k) {
    lane3(block.past_v[k]);
    lane3(block.past_W[k]);
  }
}

template <class Archive, class Block>
void rates_of_body(Archive& archive, Block& block, int lane) {
  for (auto* x :
       {&block.a, &block.A, &block.h_dot, &block.a_rate, &block.A_rate, &block.h_dot_rate})
    for (int i = 0; i < 3; ++i) archive.motion((*x)[i][lane]);
}

template <class Archive, class Sum>
void exact_sum(Archive& archive, Sum& s) {
  archive(s.sum);
  archive(s.rest);
}

constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();

template <class Archive, class AnyLedger>
void ledger(Archive& archive, const System& system, AnyLedger& l) {
  archive(l.initial_energy);
  archive(l.initial_potential);
  for (int i = 0; i < 3; ++i) archive(l.initial_p[i]);
  for (int i = 0; i < 3; ++i) archive(l.initial_l[i]);
  exact_sum(archive, l.dissipated);
  exact_sum(archive, l.put_in);
  for (int i = 0; i < 3; ++i) exact_sum(archive, l.impulse[i]);
  for (int i = 0; i < 3; ++i) exact_sum(archive, l.angular_impulse[i]);
  archive(l.energy_scale);
  archive(l.p_scale);
  archive(l.l_scale);
  archive(l.energy_drift);
  archive(l.p_drift);
  archive(l.l_drift);
  archive(l.energy_noise);
  archive(l.p_noise);
  archive(l.l_noise);
  archive(l.constraint_max);
  archive(l.errors.largest);
  archive(l.errors.sum);
  archive(l.errors.time);
  archive.whole(l.errors.body, -1, system.body_count() - 1);
  archive.whole(l.errors.node, -1,
                static_cast<std::int64_t>(system.initial_state().node_x.size() / 3) - 1);
  archive.whole(l.errors.steps, 0, kMost);
  archive.whole(l.errors.hard, 0, kMost);
  archive(l.errors.hard_time);
  archive.whole(l.impacts.steps, 0, kMost);
  archive(l.impacts.largest);
  archive(l.impacts.time);
  archive.whole(l.impacts.a, -1, system.body_count() - 1);
  archive.whole(l.impacts.b, -1, system.body_count() - 1);
  archive.whole(l.impacts.group, -1, system.nodes().group_count() - 1);
  archive.whole(l.steps, 0, kMost);
  archive.whole(l.rejected, 0, kMost);
  archive.whole(l.iterations, 0, kMost);
}

/// The whole state in a fixed order; one function serves both directions.
template <class Archive, class AnyState>
void whole_state(Archive& archive, const System& system, AnyState& state) {
  archive.motion(state.t);
  for (int i = 0; i < system.body_count(); ++i) {
    const int slot = system.slot(i);
    body(archive, state.blocks[static_cast<std::size_t>(slot / kLanes)], slot % kLanes);
  }
  archive.optional(state.rates, state.blocks.size());
  for (int i = 0; i < system.body_count() && !state.rates.empty(); ++i) {
    const int slot = system.slot(i);
    rates_of_body(archive, state.rates[static_cast<std::size_t>(slot / kLanes)], slot % kLanes);
  }
  archive.motion(state.rates_dt);
  archive.optional(state.node_rates, 2 * state.node_a.size());
  archive(state.lambda);
  archive(state.history);
  archive.motions(state.node_x);
  archive.motions(state.node_v);
  archive.motions(state.node_a);
  archive.motions(state.node_past);
  archive(state.element_history);
  archive.sized(state.contacts);
  archive.whole(state.past_count, 0, kPast);
  archive.whole(state.past_next, 0, kPast - 1);
  for (int k = 0; k < kPast; ++k) archive.motion(state.past_time[k]);
  archive.motion(state.dt_last);
  archive.motion(state.dt_next);
  archive(state.error_last);
  archive(state.turned);
  archive.whole(state.easy_steps, -1, std::numeric_limits<int>::max());
  archive.whole(state.columns, 0, 6);
  archive.whole(state.steps_to_compare, 0, std::numeric_limits<int>::max());
  archive.whole(state.steps_compared, 0, std::numeric_limits<int>::max());
  ledger(archive, system, state.ledger);
}

constexpr std::size_t kDigest = 64;

}  // namespace

std::string state_bytes(const System& system, const State& state) {
  Writer writer;
  writer(std::int64_t{system.body_count()});
  whole_state(writer, system, state);
  return std::move(writer.bytes);
}

State state_from_bytes(const System& system, std::string_view bytes, std::string_view where) {
  Reader reader(bytes, where);
  std::int64_t bodies = 0;
  reader(bodies);
  reader.expect(bodies, system.body_count(), "bodies");
  State state = system.initial_state();
  whole_state(reader, system, state);
  reader.expect_end();
  return state;
}

std::string sealed_state(const System& system, const State& state) {
  std::string bytes = state_bytes(system, state);
  bytes += sha256_hex(bytes);
  return bytes;
}

State state_from_sealed(const System& system, std::string_view bytes, std::string_view where) {
  constexpr const char* kHint = "Take it again from a simulation of the same model";
  if (bytes.size() < kDigest) throw InputError(where, "is no state", kHint);
  const std::string_view state = bytes.substr(0, bytes.size() - kDigest);
  if (sha256_hex(state) != bytes.substr(state.size()))
    throw InputError(where, "is damaged: its checksum is wrong", kHint);
  return state_from_bytes(system, state, where);
}

std::string state_hash(const System& system, const State& state) {
  return sha256_hex(state_bytes(system, state));
}

}  // namespace polhode
