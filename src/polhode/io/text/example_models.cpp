// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/text/example_models.hpp>

#include <charconv>
#include <cmath>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/types.hpp>
#include <polhode/io/text/diagnostics.hpp>

namespace polhode::io {

namespace {

using Values = std::map<std::string, std::string>;

constexpr int kMaxBodies = 10'000'000;

/// The count of that name. @throws InputError unless it is a whole number from 1 on.
int count(const Values& values, const std::string& name, int most = kMaxBodies) {
  const std::string& text = values.at(name);
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 1 || value > most)
    throw InputError(name, format("must be a whole number from 1 to {}, but is '{}'", most, text),
                     format("Write for instance --set {}=40", name));
  return value;
}

std::string list(const Vec3& x) { return format("[{}, {}, {}]", x[0], x[1], x[2]); }

/// Text of a model, line by line.
class ModelText {
 public:
  ModelText(const std::string& title, const Vec3& gravity) {
    text_ = format("format: 1\ntitle: {}\ngravity: {}\n\nbodies:\n", title, list(gravity));
  }
  /// @returns the body's name: b0, b1, ...
  int body(const Vec3& inertia, const Vec3& position, const std::string& more = "") {
    text_ += format("  b{}: {{mass: 1, inertia: {}, position: {}{}}}\n", bodies_, list(inertia),
                    list(position), more);
    return bodies_++;
  }
  void begin_joints() { text_ += "\njoints:\n"; }
  /// @param axis  Empty for a joint that has none.
  void joint(const char* type, int a, int b, const Vec3& at, const std::string& axis) {
    text_ += format("  j{}: {{type: {}, bodies: [{}, b{}], at: {}{}}}\n", joints_++, type,
                    a < 0 ? "ground" : format("b{}", a), b, list(at),
                    axis.empty() ? "" : ", axis: " + axis);
  }
  /// @param probes  Quantities of interest, as in a model file.
  std::string end(const std::string& analysis, const std::string& every,
                  const std::string& probes) {
    text_ += "\nanalysis: {type: dynamics, " + analysis + "}\n";
    text_ += format("output: {{every: {}, probes: {{{}}}}}\n", every, probes);
    return std::move(text_);
  }

 private:
  std::string text_;
  int bodies_ = 0, joints_ = 0;
};

constexpr const char* kTurning = ", velocity: [0.5, 0, 0], angular_velocity: [0, 0, -1]";
constexpr const char* kSliding = ", velocity: [1, 0, 0]";

/// N square cells of unit bars: N + 1 uprights on the ground, N bars across their tops, all joints
/// revolute. All uprights rotate at 1 rad/s at the start.
std::string n_four_bar(const Values& values) {
  const int N = count(values, "N");
  const double J = 1.0 / 12.0, thin = 1e-3;
  ModelText m(format("N-four-bar mechanism, N = {}", N), {0, -9.81, 0});
  std::vector<int> uprights, bars;
  for (int i = 0; i <= N; ++i) uprights.push_back(m.body({J, thin, J}, Vec3(i, 0.5, 0), kTurning));
  for (int i = 0; i < N; ++i) bars.push_back(m.body({thin, J, J}, Vec3(i + 0.5, 1, 0), kSliding));
  m.begin_joints();
  for (int i = 0; i <= N; ++i) m.joint("revolute", kGround, uprights[i], Vec3(i, 0, 0), "z");
  for (int i = 0; i < N; ++i) {
    m.joint("revolute", uprights[i], bars[i], Vec3(i, 1, 0), "z");
    // The bar is named first: a positive angle rotates the upright.
    m.joint("revolute", bars[i], uprights[i + 1], Vec3(i + 1, 1, 0), "z");
  }
  return m.end("duration: 10 s, step: 10 ms", "500 ms",
               "corner: {body: b0, point: [0, 0.5, 0]}, crank: {joint: j0}");
}

constexpr double kRod = 0.1;  ///< Length of the rods of chains and trees [m].

/// Inertia of a rod along x with a small one about its own axis.
Vec3 rod_inertia() {
  const double across = kRod * kRod / 12 + 1e-3;
  return {1e-3, across, across};
}

/// Hinge axes of neighbours point in different directions, so that chains move in space.
const char* hinge_axis(int i) { return i % 2 == 1 ? "[0, 1, 0]" : "[0.2, 1, 0.3]"; }

std::string chain(const Values& values) {
  const int N = count(values, "N");
  const std::string& joint = values.at("joint");
  if (joint != "revolute" && joint != "spherical")
    throw InputError("joint", format("'{}' is not known", joint), "Use revolute or spherical");
  ModelText m(format("Chain of {} rods, {} joints", N, joint), {0, 0, -9.81});
  for (int i = 0; i < N; ++i) m.body(rod_inertia(), Vec3(kRod * (i + 0.5), 0, 0));
  m.begin_joints();
  for (int i = 0; i < N; ++i)
    m.joint(joint.c_str(), i - 1, i, Vec3(kRod * i, 0, 0),
            joint == "revolute" ? hinge_axis(i) : "");
  return m.end(
      "duration: 1 s, step: 5 ms", "50 ms",
      format("tip: {{body: b{}, point: [{}, 0, 0]}}, hook: {{joint: j0}}", N - 1, kRod / 2));
}

/// Rod i is attached to the end of rod (i − 1)/2; every rod lies along x at the start, its end
/// slightly to the side, where its two children begin.
std::string binary_tree(const Values& values) {
  const int N = count(values, "N");
  ModelText m(format("Binary tree of {} rods", N), {0, 0, -9.81});
  std::vector<Vec3> begins, ends;
  for (int i = 0; i < N; ++i) {
    const Vec3 begin = i == 0 ? Vec3(0, 0, 0) : ends[(i - 1) / 2];
    const double aside = i == 0 ? 0.0 : i % 2 == 1 ? 0.03 : -0.03;
    const Vec3 end = begin + Vec3(kRod, aside, 0);
    m.body(rod_inertia(), 0.5 * (begin + end));
    begins.push_back(begin);
    ends.push_back(end);
  }
  m.begin_joints();
  for (int i = 0; i < N; ++i)
    m.joint("revolute", i == 0 ? kGround : (i - 1) / 2, i, begins[i], hinge_axis(i));
  return m.end("duration: 1 s, step: 5 ms", "50 ms",
               format("tip: {{body: b{}, point: {}}}, hook: {{joint: j0}}", N - 1,
                      list(0.5 * (ends.back() - begins.back()))));
}

/// Balls of 1 kg and 0.1 m radius above a bin that is four layers of them high, slightly off a
/// lattice; all at rest at the start.
std::string spheres_in_a_bin(const Values& values) {
  const int n = count(values, "N", 1'000'000);
  const double side = 0.25 * std::ceil(std::sqrt(n / 4.0));
  const int row = static_cast<int>((side - 0.21) / 0.22) + 1;
  const double x0 = -0.11 * (row - 1), half = 0.5 * side;
  std::string text = format(
      "format: 1\ntitle: {} spheres in a bin\ngravity: [0, 0, -9.81]\n\nbodies:\n"
      "  bin:\n    fixed: true\n    shape:\n      - {{plane: z}}\n"
      "      - {{plane: x, position: [{}, 0, 0]}}\n      - {{plane: -x, position: [{}, 0, 0]}}\n"
      "      - {{plane: y, position: [0, {}, 0]}}\n      - {{plane: -y, position: [0, {}, 0]}}\n",
      n, -half, half, -half, half);
  for (int i = 0; i < n; ++i) {
    const int column = i % row, line = i / row % row, layer = i / (row * row);
    const Vec3 x(x0 + 0.22 * column + 0.005 * std::sin(12.9898 * i),
                 x0 + 0.22 * line + 0.005 * std::sin(78.233 * i),
                 0.12 + 0.22 * layer + 0.005 * std::sin(37.719 * i));
    text += format("  b{}: {{shape: {{sphere: 0.2}}, mass: 1, position: {}}}\n", i, list(x));
  }
  return text +
         "\ncontacts:\n  default: {friction: 0.5}\n\n"
         "analysis: {type: dynamics, duration: 3 s, step: 2 ms}\n"
         "output: {every: 50 ms, probes: {first: {body: b0}, last: {body: b" +
         format("{}", n - 1) + "}}}\n";
}

}  // namespace

const std::vector<ModelGenerator>& model_generators() {
  static const std::vector<ModelGenerator> generators{
      {"n_four_bar",
       "N four-bar cells side by side, all hinges in space: passes singular positions",
       {{"N", "40", "number of cells"}},
       n_four_bar},
      {"chain",
       "a chain of rods that swings down",
       {{"N", "10", "number of rods"}, {"joint", "revolute", "revolute or spherical"}},
       chain},
      {"binary_tree",
       "rods that branch in two at every end",
       {{"N", "63", "number of rods"}},
       binary_tree},
      {"spheres_in_a_bin",
       "balls that fall into a bin and come to rest",
       {{"N", "100", "number of balls"}},
       spheres_in_a_bin},
  };
  return generators;
}

std::string generate_model(const ModelGenerator& generator, const Values& values) {
  Values all;
  std::vector<std::string> names;
  for (const GeneratorParameter& p : generator.parameters) {
    all[p.name] = p.standard;
    names.push_back(p.name);
  }
  for (const auto& [name, value] : values) {
    if (!all.contains(name))
      throw InputError(generator.name, format("has no parameter '{}'", name),
                       format("{}It has: {}", did_you_mean(name, names), name_list(names)));
    all[name] = value;
  }
  return generator.text(all);
}

}  // namespace polhode::io
