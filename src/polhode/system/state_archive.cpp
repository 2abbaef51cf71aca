// SPDX-License-Identifier: Apache-2.0
#include <polhode/system/state_archive.hpp>

#include <algorithm>
#include <bit>
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
  void operator()(int value) { (*this)(std::int64_t{value}); }
  void operator()(const std::vector<double>& values) {
    (*this)(static_cast<std::int64_t>(values.size()));
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  }
  /// A list with `count` entries or none; blocks are followed by their bodies.
  template <class T>
  void optional(const std::vector<T>& list, std::size_t /*count*/) {
    (*this)(list.empty() ? 0 : 1);
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
  void operator()(int& value) {
    std::int64_t wide = 0;
    (*this)(wide);
    value = static_cast<int>(wide);
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
    (*this)(there);
    if (there != 0 && there != 1) throw InputError(where_, "is no state", kHint);
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
    for (int i = 0; i < 3; ++i) archive(x[i][lane]);
  };
  lane3(block.r);
  lane3(block.r_rest);
  for (int i = 0; i < 4; ++i) archive(block.q[i][lane]);
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
    for (int i = 0; i < 3; ++i) archive((*x)[i][lane]);
}

template <class Archive, class Sum>
void exact_sum(Archive& archive, Sum& s) {
  archive(s.sum);
  archive(s.rest);
}

template <class Archive, class AnyLedger>
void ledger(Archive& archive, AnyLedger& l) {
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
  archive(l.errors.body);
  archive(l.errors.node);
  archive(l.errors.steps);
  archive(l.errors.hard);
  archive(l.errors.hard_time);
  archive(l.steps);
  archive(l.rejected);
  archive(l.iterations);
}

/// The whole state in a fixed order; one function serves both directions.
template <class Archive, class AnyState>
void whole_state(Archive& archive, const System& system, AnyState& state) {
  archive(state.t);
  for (int i = 0; i < system.body_count(); ++i) {
    const int slot = system.slot(i);
    body(archive, state.blocks[static_cast<std::size_t>(slot / kLanes)], slot % kLanes);
  }
  archive.optional(state.rates, state.blocks.size());
  for (int i = 0; i < system.body_count() && !state.rates.empty(); ++i) {
    const int slot = system.slot(i);
    rates_of_body(archive, state.rates[static_cast<std::size_t>(slot / kLanes)], slot % kLanes);
  }
  archive(state.rates_dt);
  archive.optional(state.node_rates, 2 * state.node_a.size());
  archive(state.lambda);
  archive(state.history);
  archive(state.node_x);
  archive(state.node_v);
  archive(state.node_a);
  archive(state.node_past);
  archive(state.element_history);
  archive.sized(state.contacts);
  archive(state.past_count);
  archive(state.past_next);
  for (int k = 0; k < kPast; ++k) archive(state.past_time[k]);
  archive(state.dt_last);
  archive(state.dt_next);
  archive(state.error_last);
  archive(state.turned);
  archive(state.easy_steps);
  ledger(archive, state.ledger);
}

}  // namespace

std::string state_bytes(const System& system, const State& state) {
  Writer writer;
  writer(system.body_count());
  whole_state(writer, system, state);
  return std::move(writer.bytes);
}

State state_from_bytes(const System& system, std::string_view bytes, std::string_view where) {
  Reader reader(bytes, where);
  int bodies = 0;
  reader(bodies);
  reader.expect(bodies, system.body_count(), "bodies");
  State state = system.initial_state();
  whole_state(reader, system, state);
  reader.expect_end();
  return state;
}

std::string state_hash(const System& system, const State& state) {
  return sha256_hex(state_bytes(system, state));
}

}  // namespace polhode
