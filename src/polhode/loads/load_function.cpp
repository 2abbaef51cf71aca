// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/load_function.hpp>

namespace polhode {

bool PartAxes::is_world() const {
  return origin.isZero(0.0) && axes.isIdentity(0.0) && body_axes.isIdentity(0.0) && sense == 1.0;
}

PartAxes PartAxes::within(const PartAxes& outer) const {
  return {outer.origin + outer.axes * origin, outer.axes * axes, outer.body_axes * body_axes,
          outer.sense * sense};
}

Mat3 PartAxes::vector_map(bool body_fixed, bool axial) const {
  const Mat3& map = body_fixed ? body_axes : axes;
  return axial && map.determinant() < 0.0 ? Mat3(-map) : map;
}

namespace {

PointFunction placed(const PointFunction& f, const PartAxes& part, const Mat3& out) {
  const Mat3 in = part.axes.transpose(), turn_in = part.vector_map(false, true).transpose();
  const auto read = [=](const PointReading& x) {
    return PointReading{
        .t = x.t,
        .position = in * (x.position - part.origin),
        .velocity = in * x.velocity,
        .orientation =
            Quat(Mat3(in * x.orientation.toRotationMatrix() * part.body_axes)).normalized(),
        .angular_velocity = turn_in * x.angular_velocity};
  };
  PointFunction g;
  g.reads_velocity = f.reads_velocity;
  g.value = [=](const PointReading& x) -> Vec3 { return out * f.value(read(x)); };
  if (f.derivative)
    g.derivative = [=](const PointReading& x) -> PointDerivative {
      const PointDerivative d = f.derivative(read(x));
      return {out * d.position * in, out * d.velocity * in, out * d.turn * turn_in,
              out * d.angular_velocity * turn_in};
    };
  return g;
}

CoordinateFunction placed(const CoordinateFunction& f, double sense) {
  const auto read = [=](const CoordinateReading& x) {
    return CoordinateReading{x.t, sense * x.value, sense * x.rate};
  };
  CoordinateFunction g;
  g.reads_velocity = f.reads_velocity;
  g.value = [=](const CoordinateReading& x) { return sense * f.value(read(x)); };
  if (f.derivative)  // both the coordinate and the force along it change sign
    g.derivative = [=](const CoordinateReading& x) { return f.derivative(read(x)); };
  return g;
}

}  // namespace

LoadFunction placed(const LoadFunction& function, const PartAxes& part, bool body_fixed,
                    bool axial) {
  if (part.is_world()) return function;
  if (const auto* f = std::get_if<PointFunction>(&function))
    return placed(*f, part, part.vector_map(body_fixed, axial));
  if (const auto* f = std::get_if<CoordinateFunction>(&function)) return placed(*f, part.sense);
  return function;
}

}  // namespace polhode
