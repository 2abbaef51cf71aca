// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/results_plan.hpp>
#include <polhode/loads/registry.hpp>

namespace polhode::io {

namespace {

constexpr StoredQuantity kBodyQuantities[] = {{"position", 3, "m"},
                                              {"orientation", 4, "-"},
                                              {"velocity", 3, "m/s"},
                                              {"angular_velocity", 3, "rad/s"}};
constexpr StoredQuantity kReactions[] = {{"force", 3, "N"}, {"moment", 3, "N m"}};
constexpr StoredQuantity kImpulses[] = {{"impulse", 3, "N s"}, {"angular_impulse", 3, "N m s"}};
constexpr StoredQuantity kCoordinates[] = {{"coordinates", 1, "rad or m"},
                                           {"rates", 1, "rad/s or m/s"}};
constexpr StoredQuantity kEnergies[] = {{"kinetic", 1, "J"}, {"potential", 1, "J"},
                                        {"put_in", 1, "J"},  {"dissipated", 1, "J"},
                                        {"total", 1, "J"},   {"drift", 1, "-"}};

constexpr StoredQuantity kContactNumbers[] = {
    {"gap", 1, "m"}, {"normal_force", 1, "N"}, {"impulse", 1, "N s"}, {"energy_lost", 1, "J"}};
constexpr StoredQuantity kContactCounts[] = {{"points", 1, "-"}, {"status", 1, "-"}};
constexpr StoredQuantity kContactVectors[] = {
    {"force", 3, "N"}, {"friction", 3, "N"}, {"point", 3, "m"}};

constexpr StoredQuantity kNodeQuantities[] = {{"displacement", 3, "m"},
                                              {"velocity", 3, "m/s"},
                                              {"cauchy", 6, "Pa"},
                                              {"von_mises", 1, "Pa"},
                                              {"strain_energy_density", 1, "J/m^3"}};
constexpr StoredQuantity kContactFields[] = {{"contact_pressure", 1, "Pa"},
                                             {"contact_gap", 1, "m"}};
constexpr StoredQuantity kElementQuantities[] = {{"cauchy", 6, "Pa"},
                                                 {"von_mises", 1, "Pa"},
                                                 {"principal_stretches", 3, "-"},
                                                 {"strain_energy_density", 1, "J/m^3"},
                                                 {"stress_error", 1, "Pa"}};

constexpr StoredQuantity kBeamNodeQuantities[] = {
    {"position", 3, "m"}, {"orientation", 4, "-"}, {"velocity", 3, "m/s"}};
constexpr StoredQuantity kBeamElementQuantities[] = {
    {"force", 3, "N"}, {"moment", 3, "N m"}, {"strain", 3, "-"}, {"curvature", 3, "1/m"}};
constexpr StoredQuantity kPieceQuantities[] = {{"tension", 1, "N"}, {"length", 1, "m"}};

/// Adds all numbers of all loads as one channel, with a named view for each load.
void add_loads(FilePlan& p, const ResultsLayout& layout, bool named) {
  namespace r = results;
  const auto numbers = static_cast<std::size_t>(layout.load_numbers());
  if (numbers == 0) return;
  p.add(r::kPackedLoads, {"values", 1, "SI"}, {numbers});
  std::size_t first = 0;
  for (const auto& load : layout.loads)
    for (const LoadChannel& channel : load_kind(load.type).channels) {
      const auto size = static_cast<std::size_t>(channel.size);
      if (named) {
        p.view(r::kLoads, load.name, {channel.name.c_str(), size, ""}, first, size, size == 1);
        p.views.back().unit = channel.unit;
      }
      first += size;
    }
}

/// Friction, stops and drives of joints, in the order of results_frame().
void plan_resistance(const ResultsLayout& layout, FilePlan& p, bool named) {
  namespace r = results;
  const auto add = [&](const StoredQuantity& q, auto&& count_of, bool integer) {
    std::size_t numbers = 0;
    for (const auto& joint : layout.joints) numbers += static_cast<std::size_t>(count_of(joint));
    if (numbers == 0) return;
    p.add(r::kPackedJoints, q, {numbers}, integer);
    std::size_t first = 0;
    for (const auto& joint : layout.joints) {
      const auto count = static_cast<std::size_t>(count_of(joint));
      if (named && count > 0) p.view(r::kJoints, joint.name, q, first, count, integer);
      first += count;
    }
  };
  using Entry = ResultsLayout::JointEntry;
  add(
      {"friction", 1, "N or N m"}, [](const Entry& joint) { return joint.friction; }, false);
  add(
      {"slips", 1, "-"}, [](const Entry& joint) { return joint.friction > 0 ? 1 : 0; }, true);
  add(
      {"stops", 1, "N or N m"}, [](const Entry& joint) { return joint.stops; }, false);
  const auto driven = [](const Entry& joint) { return joint.driven ? 1 : 0; };
  add({"power", 1, "W"}, driven, true);
  add({"work", 1, "J"}, driven, true);
}

/// Adds losses by impacts and friction, and the pairs, in the order of add_contacts().
void plan_contacts(const ResultsLayout& layout, FilePlan& p) {
  namespace r = results;
  if (!layout.has_contacts) return;
  p.add(r::kEnergy, {"lost_in_impacts", 1, "J"}, {});
  p.add(r::kEnergy, {"lost_by_friction", 1, "J"}, {});
  const std::size_t pairs = layout.contacts.size();
  if (pairs == 0) return;
  const auto add = [&](const StoredQuantity& q, std::vector<std::size_t> dims, bool integer) {
    p.add(r::kPackedContacts, q, std::move(dims), integer);
    for (std::size_t i = 0; i < pairs && pairs <= static_cast<std::size_t>(r::kMaxNamed); ++i)
      p.view(r::kContacts, layout.contacts[i], q, i, 1, true);
  };
  for (const StoredQuantity& q : kContactNumbers) add(q, {pairs}, false);
  for (const StoredQuantity& q : kContactCounts) add(q, {pairs}, true);
  for (const StoredQuantity& q : kContactVectors) add(q, {pairs, q.size}, false);
}

void plan_solids(const ResultsLayout& layout, FilePlan& p) {
  for (const auto& solid : layout.solids) {
    p.add_all(part(solid.name, "nodes"), kNodeQuantities, solid.mesh->nodes.size());
    p.add_all(part(solid.name, "elements"), kElementQuantities,
              static_cast<std::size_t>(solid.mesh->element_count()));
    if (solid.touches)
      p.add_all(part(solid.name, "nodes"), kContactFields, solid.mesh->nodes.size());
    for (const std::string& interface : solid.interfaces)
      for (const StoredQuantity& q : kReactions)
        p.add(part(solid.name, "interfaces/" + interface), q, {q.size});
  }
}

void plan_lines(const ResultsLayout& layout, FilePlan& p) {
  for (const auto& beam : layout.beams) {
    const std::string group = join(results::kBeams, beam.name);
    p.add_all(join(group, "nodes"), kBeamNodeQuantities, beam.reference.size());
    p.add_all(join(group, "elements"), kBeamElementQuantities, beam.reference.size() - 1);
  }
  for (const auto& cable : layout.cables) {
    const std::string group = join(results::kCables, cable.name);
    p.add(group, {"position", 3, "m"}, {cable.pieces + 1, 3});
    p.add_all(group, kPieceQuantities, cable.pieces);
  }
}

/// Initial positions of the nodes and the nodes of each element.
void fix_mesh(const ResultsLayout::SolidEntry& solid, FixedData& data) {
  std::vector<std::int64_t> connectivity, offsets{0}, types;
  for (int e = 0; e < solid.mesh->element_count(); ++e) {
    for (const int node : solid.mesh->element_nodes(e)) connectivity.push_back(node);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(solid.mesh->element_shape(e).vtk);
  }
  data.vectors.emplace_back(part(solid.name, "nodes/reference"), solid.reference);
  data.numbers.emplace_back(part(solid.name, "elements/connectivity"), connectivity);
  data.numbers.emplace_back(part(solid.name, "elements/offsets"), offsets);
  data.numbers.emplace_back(part(solid.name, "elements/vtk_type"), types);
}

/// Names and types of joints or loads, and their ranges in the packed numbers.
template <class Entry, class Size>
void fix_entries(const char* group, const std::vector<Entry>& entries, Size&& size,
                 FixedData& data) {
  std::vector<std::string> names, types;
  std::vector<std::int64_t> first, count;
  std::int64_t next = 0;
  for (const Entry& entry : entries) {
    names.push_back(entry.name);
    types.push_back(entry.type);
    first.push_back(next);
    count.push_back(size(entry));
    next += count.back();
  }
  data.names.emplace_back(join(group, "names"), names);
  data.names.emplace_back(join(group, "types"), types);
  data.numbers.emplace_back(join(group, "first"), first);
  data.numbers.emplace_back(join(group, "count"), count);
}

}  // namespace

FilePlan plan_results(const ResultsLayout& layout) {
  namespace r = results;
  FilePlan p;
  const std::size_t bodies = layout.bodies.size();
  const std::size_t joints = layout.joints.size();
  std::size_t own_views = joints + layout.loads.size();
  for (std::size_t i = 0; i < bodies; ++i) own_views += layout.is_node(i) ? 0 : 1;
  const bool named = own_views <= r::kMaxNamed;
  p.channels.push_back({r::kTime, {}, "s", false});
  for (const StoredQuantity& q : kBodyQuantities) {
    if (bodies == 0) break;
    p.add(r::kPackedBodies, q, {bodies, q.size});
    for (std::size_t i = 0; named && i < bodies; ++i)
      if (!layout.is_node(i)) p.view(r::kBodies, layout.bodies[i], q, i, 1, true);
  }
  for (const StoredQuantity& q : kReactions) {
    if (joints == 0) break;
    p.add(r::kPackedJoints, q, {joints, q.size});
    for (std::size_t i = 0; named && i < joints; ++i)
      p.view(r::kJoints, layout.joints[i].name, q, i, 1, true);
  }
  const auto coordinates = static_cast<std::size_t>(layout.coordinates());
  for (const StoredQuantity& q : kCoordinates) {
    if (coordinates == 0) break;
    p.add(r::kPackedJoints, q, {coordinates});
    std::size_t first = 0;
    for (const auto& joint : layout.joints) {
      const auto count = static_cast<std::size_t>(joint.coordinates);
      if (named && count > 0) p.view(r::kJoints, joint.name, q, first, count, false);
      first += count;
    }
  }
  plan_resistance(layout, p, named);
  for (const StoredQuantity& q : kImpulses) {
    if (!layout.impulses) break;
    p.add(r::kPackedJoints, q, {joints, q.size});
    for (std::size_t i = 0; named && i < joints; ++i)
      p.view(r::kJoints, layout.joints[i].name, q, i, 1, true);
  }
  add_loads(p, layout, named);
  for (const StoredQuantity& q : kEnergies) p.add(r::kEnergy, q, {});
  p.add(r::kMomentum, {"linear", 3, "kg m/s"}, {3});
  p.add(r::kMomentum, {"angular", 3, "kg m^2/s"}, {3});
  p.add(r::kSolver, {"dt", 1, "s"}, {});
  p.add(r::kSolver, {"steps", 1, "-"}, {}, true);
  p.add(r::kSolver, {"iterations", 1, "-"}, {}, true);
  p.add(r::kSolver, {"rejected", 1, "-"}, {}, true);
  p.add(r::kSolver, {"between_steps", 1, "-"}, {}, true);
  plan_contacts(layout, p);
  plan_solids(layout, p);
  plan_lines(layout, p);
  return p;
}

FixedData fixed_data(const ResultsLayout& layout) {
  namespace r = results;
  FixedData data;
  for (const auto& solid : layout.solids) fix_mesh(solid, data);
  for (const auto& beam : layout.beams)
    data.vectors.emplace_back(format("{}/{}/nodes/reference", r::kBeams, beam.name),
                              beam.reference);
  data.names.emplace_back(join(r::kPackedBodies, "names"), layout.bodies);
  fix_entries(
      r::kPackedJoints, layout.joints, [](const auto& e) { return e.coordinates; }, data);
  if (layout.load_numbers() > 0)
    fix_entries(
        r::kPackedLoads, layout.loads,
        [](const auto& e) { return load_kind(e.type).report_size(); }, data);
  if (!layout.contacts.empty())
    data.names.emplace_back(join(r::kPackedContacts, "names"), layout.contacts);
  return data;
}

}  // namespace polhode::io
