// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_function.hpp>

#include "parts.hpp"

namespace polhode::python {

/// Result of a Python callable as a number. @throws nb::python_error if it is none.
inline double number_of(nb::handle result) {
  const double x = PyFloat_AsDouble(result.ptr());
  if (x == -1.0 && PyErr_Occurred()) throw nb::python_error();
  return x;
}

/// Result of a Python callable as a vector. @throws nb::type_error unless there are three.
inline Vec3 three_numbers_of(const nb::object& result) {
  const Py_ssize_t n = PySequence_Check(result.ptr()) ? PySequence_Size(result.ptr()) : -1;
  if (n != 3) {
    PyErr_Clear();
    throw nb::type_error("A force or moment in Python must return three numbers.");
  }
  Vec3 v;
  for (Py_ssize_t i = 0; i < 3; ++i) {
    const nb::object item = nb::steal(PySequence_GetItem(result.ptr(), i));
    if (!item.is_valid()) throw nb::python_error();
    v[i] = number_of(item);
  }
  return v;
}

/// Numbers that a callable reads through one Python object with arrays, which is made once: a call
/// allocates nothing. A recursive call (a simulation within a force) gets its own object.
class Reading {
 public:
  Reading() {
    const nb::module_ module = nb::module_::import_("polhode._functions");
    object_ = module.attr("BodyReading")(view(0, 3), view(3, 3), view(6, 4), view(10, 3));
  }
  void set(const PointReading& x) {
    double* to = numbers_.get();
    for (const double v :
         {x.position[0], x.position[1], x.position[2], x.velocity[0], x.velocity[1], x.velocity[2]})
      *to++ = v;
    const double sign = x.orientation.w() < 0.0 ? -1.0 : 1.0;
    for (const double v :
         {x.orientation.w(), x.orientation.x(), x.orientation.y(), x.orientation.z()})
      *to++ = sign * v;
    for (const double v : x.angular_velocity) *to++ = v;
  }
  [[nodiscard]] const nb::object& object() const { return object_; }

 private:
  nb::object view(std::size_t first, std::size_t count) {
    auto* kept = new std::shared_ptr<double[]>(numbers_);
    const nb::capsule owner(
        kept, [](void* p) noexcept { delete static_cast<std::shared_ptr<double[]>*>(p); });
    return nb::cast(nb::ndarray<nb::numpy, const double>(numbers_.get() + first, {count}, owner));
  }

  std::shared_ptr<double[]> numbers_{new double[13]()};
  nb::object object_;
};

/// A Python callable of the time and of the motion of a body's point: f(t, body). It is borrowed,
/// see CompiledModel.
class PointCall {
 public:
  PointCall(nb::handle function, nb::handle derivative)
      : function_(function), derivative_(derivative) {}
  ~PointCall() {
    const nb::gil_scoped_acquire locked;
    reading_.reset();
  }
  PointCall(const PointCall&) = delete;
  PointCall& operator=(const PointCall&) = delete;

  [[nodiscard]] Vec3 value(const PointReading& x) {
    const nb::gil_scoped_acquire locked;
    return three_numbers_of(call(function_, x));
  }

  [[nodiscard]] PointDerivative derivative(const PointReading& x) {
    const nb::gil_scoped_acquire locked;
    const nb::dict parts = nb::cast<nb::dict>(
        nb::module_::import_("polhode._functions").attr("derivative_parts")(call(derivative_, x)));
    PointDerivative d;
    const auto read = [&](const char* key, Mat3& M) {
      if (!parts.contains(key)) return;
      const nb::object rows = parts[key];
      for (int i = 0; i < 3; ++i) M.row(i) = three_numbers_of(rows[i]).transpose();
    };
    read("position", d.position);
    read("velocity", d.velocity);
    read("turn", d.turn);
    read("angular_velocity", d.angular_velocity);
    return d;
  }

 private:
  nb::object call(nb::handle function, const PointReading& x) {
    std::unique_ptr<Reading> reading = std::move(reading_);
    if (!reading) reading = std::make_unique<Reading>();
    reading->set(x);
    nb::object result = function(x.t, reading->object());
    reading_ = std::move(reading);
    return result;
  }

  nb::handle function_, derivative_;
  std::unique_ptr<Reading> reading_;  ///< Kept between calls; gone during one.
};

/// A Python callable of the time, a coordinate and its rate: f(t, q, rate). It is
/// borrowed as well.
class CoordinateCall {
 public:
  CoordinateCall(nb::handle function, nb::handle derivative)
      : function_(function), derivative_(derivative) {}

  [[nodiscard]] double value(const CoordinateReading& x) const {
    const nb::gil_scoped_acquire locked;
    return number_of(function_(x.t, x.value, x.rate));
  }
  [[nodiscard]] CoordinateDerivative derivative(const CoordinateReading& x) const {
    const nb::gil_scoped_acquire locked;
    const nb::object pair = derivative_(x.t, x.value, x.rate);
    if (!PySequence_Check(pair.ptr()) || PySequence_Size(pair.ptr()) != 2) {
      PyErr_Clear();
      throw nb::type_error(
          "A tangent along a coordinate must return two numbers: the derivatives by the coordinate "
          "and by its rate.");
    }
    return {number_of(nb::object(pair[0])), number_of(nb::object(pair[1]))};
  }

 private:
  nb::handle function_, derivative_;
};

/// @param derivative   None: by differences; False: none, zero.
/// @param coordinate   f(t, q, rate), else f(t, body).
[[nodiscard]] inline LoadFunction motion_function(const nb::object& function,
                                                  const nb::object& derivative, bool coordinate,
                                                  bool reads_velocity) {
  const bool none = derivative.is(nb::bool_(false)), own = !none && !derivative.is_none();
  if (coordinate) {
    const auto call = std::make_shared<CoordinateCall>(function, derivative);
    CoordinateFunction f;
    f.reads_velocity = reads_velocity;
    f.value = [call](const CoordinateReading& x) { return call->value(x); };
    if (none) f.derivative = [](const CoordinateReading&) { return CoordinateDerivative{}; };
    if (own) f.derivative = [call](const CoordinateReading& x) { return call->derivative(x); };
    return f;
  }
  const auto call = std::make_shared<PointCall>(function, derivative);
  PointFunction f;
  f.reads_velocity = reads_velocity;
  f.value = [call](const PointReading& x) { return call->value(x); };
  if (none) f.derivative = [](const PointReading&) { return PointDerivative{}; };
  if (own) f.derivative = [call](const PointReading& x) { return call->derivative(x); };
  return f;
}

}  // namespace polhode::python
