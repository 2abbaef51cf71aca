// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <polhode/beams/beam_element.hpp>
#include <polhode/beams/cable.hpp>
#include <polhode/beams/running_cable.hpp>
#include <polhode/equations/node_motion.hpp>
#include <polhode/simulation/beam_report.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode {

namespace {

/// A quantity of each listed interaction at a state; Item is their type.
template <class Item, class What>
auto of_each(const System& system, const State& state, const std::vector<int>& interactions,
             What&& what) {
  std::vector<decltype(what(std::declval<const Item&>(), std::declval<const PairStep&>()))> values;
  for (int i : interactions) {
    const InteractionRef& ref = system.interactions()[static_cast<std::size_t>(i)];
    const Item& item = items_of<Item>(system.group(ref.group))[static_cast<std::size_t>(ref.item)];
    const PairView view = system.instant(state, ref, nullptr);
    values.push_back(what(item, view.step()));
  }
  return values;
}

}  // namespace

BeamReport beam_report(const Simulation& simulation, const BeamSpec& spec,
                       const std::vector<int>& elements) {
  BeamReport report;
  for (int k = 0; k < spec.node_count(); ++k) {
    const BodyMotion node = simulation.body(spec.first_node + k);
    report.position.push_back(node.r);
    report.velocity.push_back(node.v);
    report.orientation.push_back(node.q);
  }
  report.forces = of_each<BeamElement>(
      simulation.system(), simulation.state(), elements,
      [](const BeamElement& item, const PairStep& step) { return item.section_forces(step); });
  report.strains = of_each<BeamElement>(
      simulation.system(), simulation.state(), elements,
      [](const BeamElement& item, const PairStep& step) { return item.strains(step); });
  return report;
}

namespace {

void add_ends(CableReport& report, const Simulation& simulation, const CableLineSpec& spec) {
  const auto add = [&](const AttachmentSpec& at) {
    Simulation::PointMotion end{at.Z, Vec3::Zero(), Vec3::Zero()};
    if (at.body != kGround) end = simulation.point(at.body, at.Z);
    report.position.push_back(end.position);
    report.velocity.push_back(end.velocity);
  };
  add(spec.pieces.front().a);
  for (const CableLineSpec::Piece& piece : spec.pieces) add(piece.b);
}

/// Moves the points between those of the cable to its present line. On an obstacle they have the
/// velocity of its body, elsewhere one between those of the neighbouring points.
void lay_around(CableReport& report, const Simulation& simulation, const CableLineSpec& spec,
                const CableLineNow& line) {
  report.length = line.lengths;
  std::size_t before = 0;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const int body = spec.pieces[i > 0 ? i - 1 : 0].b.body;
    report.position[i] = line.points[i];
    if (line.winding[i] == CableLineNow::kPoint) {
      const Vec3 first = report.velocity[before], last = report.velocity[i];
      for (std::size_t k = before + 1; k < i; ++k)
        if (line.winding[k] == CableLineNow::kFree)
          report.velocity[k] = first + static_cast<double>(k - before) /
                                           static_cast<double>(i - before) * (last - first);
      before = i;
    } else if (line.winding[i] >= 0 && body == kGround) {
      report.velocity[i].setZero();
    } else if (line.winding[i] >= 0) {
      const BodyMotion m = simulation.body(body);
      report.velocity[i] = m.v + (m.q * m.W).cross(line.points[i] - m.r);
    }
  }
}

}  // namespace

CableReport running_cable_report(const Simulation& simulation, const CableLineSpec& spec,
                                 const RunningCable& cable, int group) {
  CableReport report;
  add_ends(report, simulation, spec);
  StepContext still;
  still.t_n = simulation.time();
  const NodeStep instant = node_instant(simulation.system(), simulation.state(), still);
  report.whole = cable.report(instant, simulation.state().element_history.data() +
                                           simulation.system().nodes().first_history(group));
  if (!spec.around.empty()) lay_around(report, simulation, spec, cable.line(instant));
  for (std::size_t k = 0; k < spec.pieces.size(); ++k) {
    report.tension.push_back(spec.around.empty() ? report.whole->tensions[k]
                                                 : report.whole->tension);
    if (spec.around.empty())
      report.length.push_back((report.position[k + 1] - report.position[k]).norm());
    report.strain.push_back(report.whole->length / spec.length() - 1.0);
  }
  return report;
}

CableReport cable_report(const Simulation& simulation, const CableLineSpec& spec,
                         const std::vector<int>& pieces) {
  CableReport report;
  add_ends(report, simulation, spec);
  report.tension =
      of_each<Cable>(simulation.system(), simulation.state(), pieces,
                     [](const Cable& item, const PairStep& step) { return item.tension(step); });
  report.length =
      of_each<Cable>(simulation.system(), simulation.state(), pieces,
                     [](const Cable& item, const PairStep& step) { return item.length(step); });
  for (std::size_t k = 0; k < spec.pieces.size(); ++k)
    report.strain.push_back(report.length[k] / spec.pieces[k].free_length - 1.0);
  return report;
}

}  // namespace polhode
