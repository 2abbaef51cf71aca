// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/separate_overlaps.hpp>

namespace polhode {

namespace {

constexpr int kMostRounds = 1000;
/// Part of the depth by which a pair moves beyond just touching, so that rounds end.
constexpr double kBeyond = 1e-6;

std::vector<BodyStep> instants_of(const System& system, const State& state) {
  std::vector<BodyStep> instants(static_cast<std::size_t>(system.body_count()) + 1);
  for (int b = 0; b < system.body_count(); ++b)
    instants[static_cast<std::size_t>(b)] = system.instant(state, b);
  instants.back() = BodyStep::ground(1.0);
  return instants;
}

}  // namespace

std::vector<std::string> overlaps_at(const System& system, contact::ContactSet& contacts,
                                     const State& state) {
  return contacts.overlaps(instants_of(system, state));
}

SeparationReport separate_overlaps(const System& system, contact::ContactSet& contacts,
                                   State& state) {
  SeparationReport report;
  std::vector<Vec3> start;
  start.reserve(system.body_count());
  for (int b = 0; b < system.body_count(); ++b) start.push_back(system.motion(state, b).r);
  for (; report.rounds < kMostRounds; ++report.rounds) {
    const auto list = contacts.deepest_overlaps(instants_of(system, state));
    if (list.empty()) break;
    for (const contact::ShapeOverlap& o : list) {
      const int a = contacts.shapes()[static_cast<std::size_t>(o.a)].body;
      const int b = contacts.shapes()[static_cast<std::size_t>(o.b)].body;
      const auto mobility = [&](int body) {
        return body == kGround ? 0.0 : 1.0 / system.bodies()[static_cast<std::size_t>(body)].mass;
      };
      const Vec3 way = (1.0 + kBeyond) * o.depth / (mobility(a) + mobility(b)) * o.normal;
      const auto move = [&](int body, double sign) {
        if (body == kGround) return;
        BodyMotion m = system.motion(state, body);
        m.r += sign * mobility(body) * way;
        state.set_motion(system.slot(body), m);
      };
      move(a, 1.0);
      move(b, -1.0);
    }
  }
  for (int b = 0; b < system.body_count(); ++b) {
    const double distance = (system.motion(state, b).r - start[static_cast<std::size_t>(b)]).norm();
    if (distance > 0.0) report.moves.emplace_back(b, distance);
  }
  return report;
}

}  // namespace polhode
