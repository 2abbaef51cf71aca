// SPDX-License-Identifier: Apache-2.0
// The N-four-bar mechanism with 40 cells, 1 s in steps of 10 ms: prints where B0 is, and the hash
// of the motion of all bodies. scripts/web.sh compares them between WebAssembly and a native build.
#include <cstdio>
#include <exception>
#include <string>

#include <polhode/core/sha256.hpp>
#include <polhode/simulation/simulation.hpp>
#include <support/models.hpp>

int main() try {
  polhode::Model model = polhode::test::n_four_bar(40);
  model.analysis.duration = 1.0;
  model.analysis.step = 0.01;
  model.analysis.isa = "baseline";
  polhode::Simulation simulation(model);
  const polhode::RunSummary summary = simulation.run();
  const polhode::Vec3 b0 = simulation.point(0, polhode::test::kFourBarB0).position;
  polhode::Sha256 motion;
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i) {
    const polhode::BodyMotion m = simulation.body(i);
    for (const polhode::Vec3& x : {m.r, m.v, m.W}) motion.update(x.data(), sizeof(double) * 3);
    motion.update(m.q.coeffs().data(), sizeof(double) * 4);
  }
  std::printf("B0 at %g s, %lld steps: %.17g %.17g %.17g\nmotion %s\n", summary.t,
              static_cast<long long>(summary.steps), b0.x(), b0.y(), b0.z(), motion.hex().c_str());
  return summary.end == polhode::RunEnd::finished ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
