// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/inerter.hpp>

#include <limits>

#include <polhode/loads/registry.hpp>

namespace polhode {

namespace {

template <class Item>
void add_inerter(System& system, const LoadDescription& load) {
  for (std::size_t part = 0; part < load.coupled.size(); ++part)
    system.group<Item>().add(load, part);
}

template <class Item>
std::vector<double> report_of_inerter(const InteractionGroup& group, int item,
                                      const PairStep& step) {
  return items_of<Item>(group)[static_cast<std::size_t>(item)].report(step);
}

}  // namespace

std::vector<double> Inerter::report(const PairStep& step) const {
  const CoordinateMotion q = motion(step);
  const double rate = coordinate_rate_at_n1(coordinate(), step.a, step.b);
  return numbers(on_b(coordinate(), q, step.lambda[0]),
                 {q.at_n1, rate, 0.5 * inertance_ * rate * rate});
}

LoadKind inerter_kind(const char* name, const char* of, const char* unit, bool turns) {
  LoadKind kind;
  kind.name = name;
  kind.meaning = std::string("inertia of a mass that moves with ") + of +
                 " of a joint, as of the rotor of a geared motor";
  kind.place = LoadPlace::joint;
  kind.parameters = {{"inertance",
                      unit,
                      {},
                      std::numeric_limits<double>::min(),
                      std::numeric_limits<double>::infinity(),
                      turns ? "moment per angular acceleration: the rotor's inertia times the "
                              "squared ratio of its gear"
                            : "force per acceleration"}};
  kind.needs_one_of = {"inertance"};
  kind.turns = turns;
  kind.add = turns ? add_inerter<RotaryInerter> : add_inerter<LinearInerter>;
  kind.channels = {{turns ? "moment" : "force", turns ? "N m" : "N", 3},
                   {turns ? "angle" : "displacement", turns ? "rad" : "m"},
                   {"rate", turns ? "rad/s" : "m/s"},
                   {"energy", "J"}};
  kind.report = turns ? report_of_inerter<RotaryInerter> : report_of_inerter<LinearInerter>;
  kind.parts = 2;
  kind.switches = false;
  return kind;
}

}  // namespace polhode
