// SPDX-License-Identifier: Apache-2.0
// Joint coordinates of an engine, and the equations in them.
#include <algorithm>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/math/quaternion.hpp>

#include "engine.hpp"

namespace polhode::python {

namespace {

using Input = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using List = std::vector<double>;

/// Numbers of an array of `columns` columns; `rows` is set to their number.
List numbers_of(const Input& given, const char* name, std::size_t columns, std::size_t* rows) {
  const std::size_t last = given.ndim() == 0 ? 0 : given.shape(given.ndim() - 1);
  const bool several = rows && given.ndim() == 2;
  if (last != columns || (given.ndim() != 1 && !several)) {
    std::string shape;
    for (std::size_t k = 0; k < given.ndim(); ++k)
      shape += format("{}{}", k == 0 ? "" : ", ", given.shape(k));
    if (given.ndim() == 1) shape += ",";
    throw nb::value_error(
        format("{} has the shape ({}), but there are {} coordinates", name, shape, columns)
            .c_str());
  }
  if (several) *rows = given.shape(0);
  List list(given.data(), given.data() + given.size());
  for (const double x : list)
    if (!std::isfinite(x)) throw nb::value_error(format("{} is not finite", name).c_str());
  return list;
}

Array row_of(List numbers) {
  const std::size_t n = numbers.size();
  return array_of(std::move(numbers), {n});
}

/// The positions and velocities at which a function of the coordinates is evaluated.
class Evaluation {
 public:
  explicit Evaluation(Engine& engine)
      : of_(engine.coordinates()), use_(engine), motions(engine.motions()) {}

  [[nodiscard]] const JointSpace& space() const { return of_.space(); }
  [[nodiscard]] std::size_t size() const { return of_.size(); }
  [[nodiscard]] List positions() const {
    return of_.positions(use_->system(), use_->state(), motions);
  }
  /// Goes to given coordinates and rates; those that are not given stay.
  void go(const std::optional<Input>& q, const std::optional<Input>& qd = std::nullopt) {
    if (!q && !qd) return;
    const List to = q ? numbers_of(*q, "q", size(), nullptr) : positions();
    const List rates = qd ? numbers_of(*qd, "qd", size(), nullptr) : space().rates(motions);
    motions = space().place(motions, to, rates);
  }

 private:
  const Coordinates& of_;
  Engine::Use use_;

 public:
  JointSpace::Motions motions;
};

nb::list coordinates(Engine& engine) {
  const Coordinates& of = engine.coordinates();
  nb::list list;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const IndependentCoordinate& c = of.space().coordinates()[k];
    list.append(nb::make_tuple(c.name, c.joint, c.body, c.coordinate, c.turns, of.limits().lower[k],
                               of.limits().upper[k]));
  }
  return list;
}

Array positions(Engine& engine) { return row_of(Evaluation(engine).positions()); }

Array rates(Engine& engine) {
  const Evaluation at(engine);
  return row_of(at.space().rates(at.motions));
}

Array second_rates(Engine& engine) {
  const Coordinates& of = engine.coordinates();
  const Engine::Use simulation = engine.use();
  const int bodies = static_cast<int>(engine.model().bodies.size());
  JointSpace::Motions motions;
  std::vector<Vec3> linear, angular;
  for (int b = 0; b < bodies; ++b) {
    motions.push_back(simulation->body(b));
    linear.push_back(simulation->point(b, Vec3::Zero()).acceleration);
    angular.push_back(simulation->angular_acceleration(b));
  }
  return row_of(of.space().second_rates(motions, linear, angular));
}

void set_coordinates(Engine& engine, const std::optional<Input>& q,
                     const std::optional<Input>& qd) {
  const std::size_t n = engine.coordinates().size();
  std::optional<List> positions, rates;
  if (q) positions = numbers_of(*q, "q", n, nullptr);
  if (qd) rates = numbers_of(*qd, "qd", n, nullptr);
  engine.set_coordinates(positions, rates);
}

Array mass_matrix(Engine& engine, const std::optional<Input>& q) {
  Evaluation at(engine);
  at.go(q);
  const std::size_t n = at.size();
  return array_of(at.space().mass_matrix(at.motions), {n, n});
}

Array gravity_forces(Engine& engine, const std::optional<Input>& q) {
  Evaluation at(engine);
  at.go(q);
  return row_of(at.space().gravity_forces(at.motions));
}

Array velocity_forces(Engine& engine, const std::optional<Input>& q,
                      const std::optional<Input>& qd) {
  Evaluation at(engine);
  at.go(q, qd);
  return row_of(at.space().velocity_forces(at.motions));
}

Vec3 three(const List& x, const char* name) {
  if (x.size() != 3) throw nb::value_error(format("{} must be three numbers", name).c_str());
  return {x[0], x[1], x[2]};
}

int body_of(const Engine& engine, int body) {
  (void)engine.model().bodies.at(static_cast<std::size_t>(body));
  return body;
}

/// A point in the coordinates that the user writes, from the centre of mass.
Vec3 from_centre(const Engine& engine, int body, const List& point) {
  return three(point, "point") - engine.model().bodies.at(static_cast<std::size_t>(body)).com;
}

Array jacobian(Engine& engine, int body, const List& point, const std::optional<Input>& q) {
  Evaluation at(engine);
  at.go(q);
  const std::size_t n = at.size();
  return array_of(
      at.space().jacobian(at.motions, body_of(engine, body), from_centre(engine, body, point)),
      {6, n});
}

/// Row by row of T positions, which follow each other.
Array inverse_dynamics(Engine& engine, const Input& second, const std::optional<Input>& q,
                       const std::optional<Input>& qd) {
  Evaluation at(engine);
  const std::size_t n = at.size();
  std::size_t rows = 1;
  std::vector<std::size_t> shape{n};
  const auto take = [&](const Input& given, const char* name) {
    std::size_t count = 1;
    List list = numbers_of(given, name, n, &count);
    if (given.ndim() == 2) {
      if (shape.size() == 2 && count != rows)
        throw nb::value_error(format("{} has {} rows, not {}", name, count, rows).c_str());
      rows = count;
      shape = {rows, n};
    }
    return list;
  };
  const List a = take(second, "qdd");
  const bool stays = !q && !qd;
  const List x = q ? take(*q, "q") : stays ? List(n) : at.positions();
  const List v = qd ? take(*qd, "qd") : stays ? List(n) : at.space().rates(at.motions);
  const auto row = [&](const List& list, std::size_t i) {
    return std::span(list).subspan(list.size() > n ? i * n : 0, n);
  };
  List forces;
  {
    const nb::gil_scoped_release unlocked;
    for (std::size_t i = 0; i < rows; ++i) {
      if (!stays && (i == 0 || x.size() > n || v.size() > n))
        at.motions = at.space().place(at.motions, row(x, i), row(v, i));
      const List one = at.space().inverse_dynamics(at.motions, row(a, i));
      forces.insert(forces.end(), one.begin(), one.end());
    }
  }
  return array_of(std::move(forces), shape);
}

/// Positions (T, bodies, 3) and orientations (T, bodies, 4) at T positions.
nb::tuple forward_kinematics(Engine& engine, const Input& q) {
  Evaluation at(engine);
  std::size_t rows = 1;
  const List x = numbers_of(q, "q", at.size(), &rows);
  List r, o;
  {
    const nb::gil_scoped_release unlocked;
    for (std::size_t i = 0; i < rows; ++i) {
      at.motions = at.space().place(at.motions, std::span(x).subspan(i * at.size(), at.size()));
      for (const BodyMotion& m : at.motions) {
        r.insert(r.end(), m.r.begin(), m.r.end());
        const Quat turn = shown(m.q);
        o.insert(o.end(), {turn.w(), turn.x(), turn.y(), turn.z()});
      }
    }
  }
  const std::size_t bodies = at.motions.size();
  return nb::make_tuple(array_of(std::move(r), {rows, bodies, 3}),
                        array_of(std::move(o), {rows, bodies, 4}));
}

/// @returns coordinates, distance [m] and angle [rad] that remain, and whether these are round-off.
nb::tuple reach(Engine& engine, int body, const List& point, const std::optional<List>& position,
                const std::optional<List>& orientation, const std::optional<Input>& q) {
  Evaluation at(engine);
  const List near = q ? numbers_of(*q, "q", at.size(), nullptr) : at.positions();
  if (q) at.motions = at.space().place(at.motions, near);
  PoseTarget target;
  target.body = body_of(engine, body);
  target.point = from_centre(engine, body, point);
  if (position) target.position = three(*position, "position");
  if (orientation) {
    const List& o = *orientation;
    if (o.size() != 4) throw nb::value_error("orientation must be four numbers, [w, x, y, z]");
    target.orientation = Quat(o[0], o[1], o[2], o[3]).normalized();
  }
  PoseReached found;
  {
    const nb::gil_scoped_release unlocked;
    found = polhode::reach(at.space(), engine.coordinates().limits(), at.motions, near, target);
  }
  return nb::make_tuple(row_of(std::move(found.positions)), found.distance, found.angle,
                        found.reached);
}

Array held(Engine& engine) {
  const auto numbers = engine.held();
  return row_of(numbers ? numbers->now : List());
}

void hold(Engine& engine, const Input& given) {
  const auto numbers = engine.held();
  const std::size_t n = numbers ? numbers->now.size() : 0;
  if (given.ndim() != 1 || given.size() != n)
    throw nb::value_error(format("tau must be an array of {} numbers", n).c_str());
  for (std::size_t i = 0; i < n; ++i)
    if (!std::isfinite(given.data()[i])) throw nb::value_error("tau is not finite");
  const Engine::Use used(engine);
  std::copy_n(given.data(), n, numbers->now.begin());
}

}  // namespace

void bind_joint_space(nb::class_<Engine>& engine) {
  engine.def_prop_ro("coordinates", &coordinates)
      .def_prop_ro("q", &positions, nb::rv_policy::move)
      .def_prop_ro("qd", &rates, nb::rv_policy::move)
      .def_prop_ro("qdd", &second_rates, nb::rv_policy::move)
      .def("set_coordinates", &set_coordinates, nb::arg("q").none(), nb::arg("qd").none())
      .def("reset", &Engine::reset)
      .def("held", &held)
      .def("hold", &hold, nb::arg("tau"))
      .def("mass_matrix", &mass_matrix, nb::arg("q").none())
      .def("gravity_forces", &gravity_forces, nb::arg("q").none())
      .def("velocity_forces", &velocity_forces, nb::arg("q").none(), nb::arg("qd").none())
      .def("jacobian", &jacobian, nb::arg("body"), nb::arg("point"), nb::arg("q").none())
      .def("inverse_dynamics", &inverse_dynamics, nb::arg("qdd"), nb::arg("q").none(),
           nb::arg("qd").none())
      .def("forward_kinematics", &forward_kinematics, nb::arg("q"))
      .def("reach", &reach, nb::arg("body"), nb::arg("point"), nb::arg("position").none(),
           nb::arg("orientation").none(), nb::arg("q").none());
}

}  // namespace polhode::python
