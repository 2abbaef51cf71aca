// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/results_plan.hpp>

namespace polhode::io {

namespace {

void add_quaternion(std::vector<double>& numbers, const Quat& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;  // q and −q are the same rotation.
  for (double x : {q.w(), q.x(), q.y(), q.z()}) numbers.push_back(sign * x);
}

void add_contacts(const ResultsFrame& frame, std::vector<double>& numbers) {
  numbers.push_back(frame.losses.impacts);
  numbers.push_back(frame.losses.friction);
  const auto each = [&](auto&& value) {
    for (const ContactReport& c : frame.contacts) numbers.push_back(value(c));
  };
  each([](const ContactReport& c) { return c.gap; });
  each([](const ContactReport& c) { return c.normal_force; });
  each([](const ContactReport& c) { return c.impulse; });
  each([](const ContactReport& c) { return c.energy_lost; });
  each([](const ContactReport& c) { return static_cast<double>(c.points); });
  each([](const ContactReport& c) { return static_cast<double>(c.status); });
  for (const auto member : {&ContactReport::force, &ContactReport::friction, &ContactReport::point})
    for (const ContactReport& c : frame.contacts)
      numbers.insert(numbers.end(), (c.*member).begin(), (c.*member).end());
}

void add_solids(const ResultsFrame& frame, std::vector<double>& numbers) {
  const auto vector = [&](const Vec3& x) { numbers.insert(numbers.end(), x.begin(), x.end()); };
  const auto tensor = [&](const Mat3& T) {
    numbers.insert(numbers.end(), {T(0, 0), T(1, 1), T(2, 2), T(0, 1), T(1, 2), T(0, 2)});
  };
  for (std::size_t s = 0; s < frame.solids.size(); ++s) {
    const SolidReport& report = frame.solids[s];
    const solids::NodalFields& nodal = report.nodal;
    for (const Vec3& x : report.displacement) vector(x);
    for (const Vec3& x : report.velocity) vector(x);
    for (const Mat3& T : nodal.cauchy) tensor(T);
    numbers.insert(numbers.end(), nodal.von_mises.begin(), nodal.von_mises.end());
    numbers.insert(numbers.end(), nodal.strain_energy_density.begin(),
                   nodal.strain_energy_density.end());
    for (const ElementSample& e : report.elements) tensor(e.cauchy);
    for (const ElementSample& e : report.elements) numbers.push_back(solids::von_mises(e.cauchy));
    for (const ElementSample& e : report.elements) vector(e.principal_stretches);
    for (const ElementSample& e : report.elements) numbers.push_back(e.strain_energy_density);
    numbers.insert(numbers.end(), nodal.stress_error.begin(), nodal.stress_error.end());
    if (s < frame.solid_contacts.size())
      for (const std::vector<double>* field :
           {&frame.solid_contacts[s].pressure, &frame.solid_contacts[s].gap})
        numbers.insert(numbers.end(), field->begin(), field->end());
    for (const InterfaceReport& reaction : frame.interfaces[s]) {
      vector(reaction.force);
      vector(reaction.moment);
    }
  }
}

void add_lines(const ResultsFrame& frame, std::vector<double>& numbers) {
  const auto vectors = [&](const std::vector<Vec3>& list) {
    for (const Vec3& x : list) numbers.insert(numbers.end(), x.begin(), x.end());
  };
  const auto halves = [&](const std::vector<Vec6>& list) {
    for (const Eigen::Index first : {0, 3})
      for (const Vec6& x : list)
        numbers.insert(numbers.end(), x.data() + first, x.data() + first + 3);
  };
  for (const BeamReport& beam : frame.beams) {
    vectors(beam.position);
    for (const Quat& q : beam.orientation) add_quaternion(numbers, q);
    vectors(beam.velocity);
    halves(beam.forces);
    halves(beam.strains);
  }
  for (const CableReport& cable : frame.cables) {
    vectors(cable.position);
    numbers.insert(numbers.end(), cable.tension.begin(), cable.tension.end());
    numbers.insert(numbers.end(), cable.length.begin(), cable.length.end());
  }
}

}  // namespace

void list_numbers(const ResultsFrame& frame, std::vector<double>& numbers) {
  const auto scalar = [&](double x) { numbers.push_back(x); };
  const auto vector = [&](const Vec3& x) {
    for (int i = 0; i < 3; ++i) scalar(x[i]);
  };
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto vectors = [&](const std::vector<Vec3>& list) {
    if (!list.empty())
      numbers.insert(numbers.end(), list.front().data(), list.front().data() + 3 * list.size());
  };
  scalar(frame.t);
  vectors(frame.position);
  for (const Quat& q : frame.orientation) add_quaternion(numbers, q);
  vectors(frame.velocity);
  vectors(frame.angular_velocity);
  vectors(frame.force);
  vectors(frame.moment);
  for (const auto* list : {&frame.coordinates, &frame.rates, &frame.friction, &frame.slips,
                           &frame.stops, &frame.power, &frame.work})
    numbers.insert(numbers.end(), list->begin(), list->end());
  vectors(frame.impulse);
  vectors(frame.angular_impulse);
  numbers.insert(numbers.end(), frame.loads.begin(), frame.loads.end());
  const Balance& b = frame.balance;
  for (double x : {b.kinetic, b.potential, b.put_in, b.dissipated, b.kinetic + b.potential})
    scalar(x);
  scalar(frame.energy_drift);
  vector(b.linear_momentum);
  vector(b.angular_momentum);
  scalar(frame.dt);
  for (std::int64_t x : {frame.steps, frame.iterations, frame.rejected})
    scalar(static_cast<double>(x));
  scalar(frame.between_steps ? 1.0 : 0.0);
  if (frame.has_contacts) add_contacts(frame, numbers);
  add_solids(frame, numbers);
  add_lines(frame, numbers);
}

}  // namespace polhode::io
