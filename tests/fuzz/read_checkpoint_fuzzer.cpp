// SPDX-License-Identifier: Apache-2.0
// Feeds forged states, with a checksum that fits, to the reader of checkpoints, and continues the
// run with what it accepts. The only accepted outcomes are a run and errors with messages: no
// crash, no other exception.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <polhode/system/state_archive.hpp>

namespace {

using namespace polhode;

/// Bodies with a joint that has stops, contact with friction, and an event.
const char* const kModel = R"(format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  box: {shape: {box: [0.2, 0.2, 0.2]}, density: 1000, position: [0, 0, 0.13], velocity: [1, 0, 0]}
  ball: {shape: {sphere: 0.2}, density: 1000, position: [0.5, 0, 0.12], velocity: [-1, 0, 0]}
  arm: {mass: 1, inertia: [1, 1, 1], position: [2, 0, 1]}
joints: {hinge: {type: revolute, bodies: [ground, arm], at: [1, 0, 1], axis: y, limits: {lower: -1, upper: 1}}}
contacts: {default: {friction: 0.3}}
events: {late: {at: 0.5, off: [hinge]}}
analysis: {duration: 1, step: 2 ms}
)";

struct Middle {
  Simulation simulation{io::read_model_text(kModel, "fuzz.yaml")};
  std::string bytes;
  Middle() {
    for (int k = 0; k < 60; ++k) (void)simulation.step(1.0);  // The box touches the floor.
    bytes = state_bytes(simulation.system(), simulation.state());
  }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Middle middle;
  // Each ten bytes: a place, and the number that stands there instead; the rest cuts the state.
  std::string bytes = middle.bytes;
  for (; size >= 10; data += 10, size -= 10) {
    const std::size_t place = (data[0] + 256U * data[1]) % (bytes.size() / 8);
    std::memcpy(bytes.data() + 8 * place, data + 2, 8);
  }
  if (size >= 2) bytes.resize((data[0] + 256U * data[1]) % bytes.size());
  try {
    const System& system = middle.simulation.system();
    Simulation other(Model(middle.simulation.model()), state_from_bytes(system, bytes, "fuzz"));
    for (int k = 0; k < 2; ++k)
      if (!other.step(other.time() + 1.0).accepted) break;
    (void)other.summary();
  } catch (const InputError&) {
  } catch (const SolveError&) {
  }
  return 0;
}
