// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/checkpoint.hpp>

#include <cstdint>
#include <cstring>

#include <polhode/assembly/state_archive.hpp>
#include <polhode/base/error.hpp>
#include <polhode/base/format.hpp>
#include <polhode/base/sha256.hpp>
#include <polhode/io/file_error.hpp>

namespace polhode {

namespace {

// Layout: magic (16 bytes with the format version), fingerprint (64), length of the state (8,
// little endian), state, SHA-256 of all that (64).
constexpr std::string_view kMagicStem = "polhode state ";
constexpr std::string_view kMagic = "polhode state 2\n";
constexpr std::size_t kDigest = 64;

/// Feeds values into a hash, each with its length, so that neighbours cannot run together.
class Fingerprint {
 public:
  void text(std::string_view value) {
    number(static_cast<double>(value.size()));
    hash_.update(value);
  }
  void number(double value) { hash_.update(&value, sizeof value); }
  template <class Derived>
  void numbers(const Eigen::MatrixBase<Derived>& values) {
    for (Eigen::Index j = 0; j < values.cols(); ++j)
      for (Eigen::Index i = 0; i < values.rows(); ++i) number(values(i, j));
  }
  void map(const std::map<std::string, double>& values) {
    number(static_cast<double>(values.size()));
    for (const auto& [key, value] : values) {
      text(key);
      number(value);
    }
  }
  void function(const TimeFunction& f) {
    for (double t : {0.0, 0.123, 1.0, 7.77, 100.0}) number(f(t));
  }
  std::string hex() { return hash_.hex(); }

 private:
  Sha256 hash_;
};

void add(Fingerprint& f, const BodySpec& b) {
  f.text(b.name);
  f.number(b.fixed);
  f.number(b.point_mass);
  f.number(b.mass);
  f.numbers(b.inertia);
  f.numbers(b.position);
  f.numbers(b.orientation.coeffs());
  f.numbers(b.velocity);
  f.numbers(b.angular_velocity);
}

void add(Fingerprint& f, const JointSpec& j) {
  f.text(j.name);
  f.text(j.type);
  f.number(j.a);
  f.number(j.b);
  f.numbers(j.Z_a);
  f.numbers(j.Z_b);
  f.numbers(j.R_a);
  f.numbers(j.R_b);
  for (const std::string& freedom : j.free) f.text(freedom);
  f.map(j.parameters);
}

void add(Fingerprint& f, const LoadSpec& l) {
  f.text(l.name);
  f.text(l.type);
  f.number(l.a);
  f.number(l.b);
  f.text(l.joint);
  f.numbers(l.Z_a);
  f.numbers(l.Z_b);
  f.number(l.body_fixed);
  f.number(l.vector.has_value());
  if (l.vector)
    for (const TimeFunctionPtr& component : *l.vector) {
      f.number(component != nullptr);
      if (component) f.function(*component);
    }
  f.map(l.parameters);
}

void add(Fingerprint& f, const ContactLawSpec& law) {
  f.text(law.potential);
  f.text(law.rebound);
  for (const double x : {law.gap_tolerance, law.stiffness, law.reference_load, law.restitution,
                         law.friction, law.static_friction, law.friction_across, law.rolling,
                         law.torsion, law.friction_stiffness, law.friction_damping})
    f.number(x);
  f.numbers(law.direction);
}

/// Laws and what they belong to; what is recorded of contacts may differ.
void add(Fingerprint& f, const Model& model) {
  const ContactsSpec& contacts = model.contacts;
  f.number(contacts.present);
  if (!contacts.present) return;
  add(f, contacts.standard);
  f.number(contacts.sweeps);
  f.number(contacts.sweep_tolerance);
  f.number(static_cast<double>(contacts.friction));
  f.number(static_cast<double>(contacts.restitution));
  f.number(contacts.joint_neighbours);
  for (const ContactMaterialSpec& m : contacts.materials) {
    f.text(m.name);
    f.number(m.friction);
    f.number(m.restitution);
  }
  for (const ContactPairSpec& pair : contacts.pairs) {
    for (const int x : {pair.of_materials ? 1 : 0, pair.sensor ? 1 : 0, pair.a, pair.b})
      f.number(x);
    add(f, pair.law);
  }
  for (const auto& [a, b] : contacts.excluded) {
    f.number(a);
    f.number(b);
  }
  for (const BodySpec& body : model.bodies)
    for (const ShapeSpec& shape : body.shapes) {
      f.text(shape.type);
      for (const double x : shape.sizes) f.number(x);
      f.numbers(shape.position);
      f.numbers(shape.orientation.coeffs());
    }
  for (const CableLineSpec& cable : model.cables)
    if (cable.contact) f.number(cable.contact->radius);
}

}  // namespace

std::string model_fingerprint(const Model& model) {
  Fingerprint f;
  f.numbers(model.gravity);
  for (const auto& body : model.bodies) add(f, body);
  for (const auto& joint : model.joints) add(f, joint);
  for (const auto& load : model.loads) add(f, load);
  add(f, model);
  const AnalysisSpec& a = model.analysis;
  f.text(a.type);
  f.number(a.rho_inf);
  f.text(a.momentum_rate);
  f.number(a.conserving);
  return f.hex();
}

void write_checkpoint(const std::string& path, const Model& model, const System& system,
                      const State& state) {
  const std::string body = state_bytes(system, state);
  const std::uint64_t length = body.size();
  std::string bytes(kMagic);
  bytes += model_fingerprint(model);
  bytes.append(reinterpret_cast<const char*>(&length), sizeof length);
  bytes += body;
  bytes += sha256_hex(bytes);
  write_file_atomically(path, bytes);
}

State read_checkpoint(const std::string& path, const Model& model, const System& system) {
  const std::string file = read_file(path);
  const std::string_view bytes = file;
  constexpr const char* kOther = "Give the checkpoint that the run wrote, usually checkpoint.pst";
  if (!bytes.starts_with(kMagicStem)) throw InputError(path, "is not a Polhode checkpoint", kOther);
  if (!bytes.starts_with(kMagic))
    throw InputError(path, "has a checkpoint format that this version does not read",
                     "Continue the run with the version that wrote it");
  std::uint64_t length = 0;
  const std::size_t head = kMagic.size() + kDigest + sizeof length;
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
  return state_from_bytes(system, bytes.substr(head, length), path);
}

}  // namespace polhode
