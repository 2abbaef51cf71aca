// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/checkpoint.hpp>

#include <cstdint>
#include <cstring>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/sha256.hpp>
#include <polhode/io/results/model_fingerprint.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/simulation/order_choice.hpp>
#include <polhode/system/state_archive.hpp>

namespace polhode::io {

namespace {

// Layout: magic (16 bytes with the format version), fingerprint (64), order and instruction set
// (48, padded with blanks), length of the state (8, little endian), state, SHA-256 of all that
// (64).
constexpr std::string_view kMagicStem = "polhode state ";
constexpr std::string_view kMagic = "polhode state 9\n";
constexpr std::size_t kDigest = 64, kMethod = 48;

/// Order and instruction set of a run: "order 6 by composition, avx512".
std::string method_text(const System& system, const Model& model) {
  const std::string name = lane_kernels(model.analysis.isa).name;
  return format("{:<48}", format("{}, {}", choose_order(system, model).text(), name));
}

}  // namespace

void write_checkpoint(const std::string& path, const Model& model, const System& system,
                      const State& state) {
  const std::string body = state_bytes(system, state);
  const std::uint64_t length = body.size();
  std::string bytes(kMagic);
  bytes += model_fingerprint(model);
  bytes += method_text(system, model);
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  bytes += body;
  bytes += sha256_hex(bytes);
  write_file_atomically(path, bytes);
}

State read_checkpoint(const std::string& path, const Model& model, const System& system,
                      std::string* note) {
  const std::string file = read_file(path);
  const std::string_view bytes = file;
  constexpr const char* kOther = "Give the checkpoint that the run wrote, usually checkpoint.pst";
  if (!bytes.starts_with(kMagicStem)) throw InputError(path, "is not a Polhode checkpoint", kOther);
  if (!bytes.starts_with(kMagic))
    throw InputError(path, "has a checkpoint format that this version does not read",
                     "Continue the run with the version that wrote it");
  std::uint64_t length = 0;
  const std::size_t head = kMagic.size() + kDigest + kMethod + sizeof length;
  if (bytes.size() >= head)
    std::memcpy(&length, bytes.data() + head - sizeof length, sizeof length);
  if (bytes.size() < head + kDigest || bytes.size() - head - kDigest != length)
    throw InputError(path,
                     format("is damaged: it has {} bytes, which is not its length", bytes.size()),
                     "Take another checkpoint");
  if (sha256_hex(bytes.substr(0, bytes.size() - kDigest)) != bytes.substr(bytes.size() - kDigest))
    throw InputError(path, "is damaged: its checksum is wrong", "Take another checkpoint");
  if (bytes.substr(kMagic.size(), kDigest) != model_fingerprint(model))
    throw InputError(path, "was written by a run of another model",
                     "Give the model and the --set values of that run; only analysis.duration, the "
                     "step and the output may differ");
  const std::string_view before = bytes.substr(kMagic.size() + kDigest, kMethod);
  const std::string now = method_text(system, model);
  const auto order = [](std::string_view text) { return text.substr(0, text.find(',')); };
  const auto isa = [](std::string_view text) {
    const std::size_t begin = text.find(", ") + 2;
    return text.substr(begin, text.find(' ', begin) - begin);
  };
  if (order(before) != order(now))
    throw InputError(
        path,
        format("was written by a run with {}, but this one has {}", order(before), order(now)),
        "Give the analysis.order, method and tolerance of that run");
  if (note != nullptr && isa(before) != isa(now))
    *note = format(
        "The run was begun with the instruction set {} and continues with {}: its last digits "
        "differ from those of a run in one go. Give --isa {} where the machine has it.",
        isa(before), isa(now), isa(before));
  return state_from_bytes(system, bytes.substr(head, length), path);
}

}  // namespace polhode::io
