// SPDX-License-Identifier: Apache-2.0
// Loads, drives and motions without a value: named with the time, in every engine, at orders 2 and
// 4, in statics, and at steps a hundred times apart.
#include <polhode/simulation/finite_functions.hpp>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/system/regular_state.hpp>

namespace polhode::test::finite_functions_tests {
namespace {

using testing::HasSubstr;

// The functions have no value from 0.503 s on, which is no multiple of a step.
const std::string kBody = "bodies: {a: {mass: 1, inertia: [1, 1, 1]}}\n";
const std::string kSlide =
    kBody + "joints: {j: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}\n";
const std::string kBlock =
    "materials: {m: {type: elastic, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}\n"
    "solids: {s: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}}, material: m, "
    "bonded: {ground: xmin}";

struct Case {
  std::string model;  ///< Without analysis.
  std::string named;
  bool solid = false;
};

std::vector<Case> cases() {
  const std::string load = "the load 'push'";
  return {
      {kBody + "loads: {push: {type: force, body: a, force: ['sqrt(0.503 - t)', 0, 0]}}\n", load},
      {kBody + "loads: {push: {type: force, body: a, force: ['log(0.503 - t)', 0, 0]}}\n", load},
      {kBody + "loads: {push: {type: moment, body: a, moment: [0, 'sqrt(0.503 - t)', 0]}}\n", load},
      {kBody + "loads: {push: {type: axial_force, bodies: [ground, a], at: [[1, 0, 0], [0, 0, 0]], "
               "pull: 'sqrt(0.503 - t)'}}\n",
       load},
      {kSlide + "loads: {push: {type: linear_motor, joint: j, force: 'sqrt(0.503 - t)'}}\n", load},
      {kSlide + "loads: {push: {type: linear_motor, joint: j, displacement: 'sqrt(0.503 - t) - "
                "sqrt(0.503)'}}\n",
       load},
      {kSlide + "loads: {push: {type: linear_servo, joint: j, displacement: 'sqrt(0.503 - t) - "
                "sqrt(0.503)', stiffness: 1}}\n",
       load},
      {"bodies: {a: {mass: 1, inertia: [1, 1, 1], motion: {x: 'sqrt(0.503 - t) - sqrt(0.503)', y: "
       "0, z: 0}}}\n",
       "the motion of the joint 'a.motion'"},
      {kBody + "cables: {c: {through: [[ground, [-1, 0, 0]], [a, [0, 0, 0]]], stiffness: 1000, "
               "tension: 'sqrt(0.503 - t)'}}\n",
       "the tension of the cable 'c'"},
      {kBlock + "}}\nloads: {push: {type: pressure, solid: s, surface: xmax, pressure: "
                "'sqrt(0.503 - t)'}}\n",
       load, true},
      {kBlock + ", prescribed: {push: {nodes: xmax, x: '0.1*(sqrt(0.503 - t) - sqrt(0.503))'}}}}\n",
       "the prescribed displacement 'push'", true},
  };
}

std::string message_of(const std::string& model, const std::string& analysis) {
  Simulation s(io::read_model_text(
      "format: 1\n" + model + "analysis: {" + analysis + "}\noutput: {hdf5: false}\n", "m.yaml",
      {}));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged) << model << analysis;
  EXPECT_TRUE(is_regular(s.state())) << model << analysis;
  return r.message;
}

}  // namespace

TEST(FiniteFunctions, EveryKindIsNamedWithItsTimeInEveryEngineAndOrder) {
  for (const Case& c : cases())
    for (const char* engine :
         {"", ", solver: block_lu", ", order: 4", ", solver: block_lu, order: 4", ", rho_inf: 0.8"})
      for (const double step : {0.1, 0.01, 1e-4}) {
        if ((c.solid && step < 0.01) || (*engine != '\0' && step < 0.01)) continue;
        EXPECT_EQ(message_of(c.model, format("duration: 1, step: {}{}", step, engine)),
                  c.named + " is not a finite number at t = 0.503 s. Correct its function.")
            << c.model << engine << step;
      }
}

TEST(FiniteFunctions, EveryKindIsNamedInStatics) {
  for (const Case& c : cases())
    for (const char* history : {"", ", history: 1"})
      EXPECT_EQ(message_of(c.model, std::string("type: statics") + history),
                c.named + " is not a finite number at t = 0.503 s. Correct its function.")
          << c.model << history;
}

// With contact there are two more engines: bodies with contact alone, and the non-smooth one.
TEST(FiniteFunctions, LoadsAreNamedByTheEnginesOfContact) {
  for (const char* law : {"barrier", "linear", "rigid", "nonsmooth"})
    EXPECT_EQ(message_of(std::string("bodies: {floor: {fixed: true, shape: {plane: z}}, a: {shape: "
                                     "{sphere: 0.2}, density: 1000, position: [0, 0, 1]}}\nloads: "
                                     "{push: {type: force, body: a, force: ['sqrt(0.503 - t)', 0, "
                                     "0]}}\ncontacts: {default: {law: ") +
                             law + "}}\n",
                         "duration: 1, step: 0.01"),
              "the load 'push' is not a finite number at t = 0.503 s. Correct its function.")
        << law;
}

// At 1 m/s a law of the coordinate that has no value beyond 0.5 m has none from t = 0.5 s on; once
// its mean over a step was computed without end.
TEST(FiniteFunctions, LawsOfACoordinateAreNamedWithTheTimeAtWhichTheyEnd) {
  const std::string moving =
      "bodies: {a: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}}\njoints: {j: {type: "
      "prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}\nloads: {push: {type: "
      "translational_spring, joint: j, spring_force: '0*sqrt(0.5 - x)'}}\n";
  for (const char* engine : {"", ", solver: block_lu", ", order: 4"})
    for (const double step : {0.1, 0.01, 1e-4})
      EXPECT_EQ(message_of(moving, format("duration: 1, step: {}{}", step, engine)),
                "the load 'push' is not a finite number at t = 0.5 s. Correct its function.")
          << engine << step;
}

TEST(FiniteFunctions, FunctionsInCodeAreNamedWithTheTimeAtWhichTheyEnd) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const std::string moving =
      "format: 1\nbodies: {a: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}}\n"
      "joints: {j: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}\nloads: ";
  for (const int order : {2, 4})
    for (const double step : {0.1, 0.01, 1e-4}) {
      const std::string analysis =
          format("\nanalysis: {{duration: 1, step: {}, order: {}}}\n", step, order);
      Model of_point = io::read_model_text(
          moving + "{push: {type: force, body: a, force: [0, 0, 0]}}" + analysis, "m.yaml", {});
      PointFunction force;
      force.reads_velocity = false;
      force.value = [=](const PointReading& x) -> Vec3 {
        return {x.position.x() < 0.5 ? 0.0 : kNone, 0.0, 0.0};
      };
      of_point.loads[0].of_motion = force;
      Model of_coordinate = io::read_model_text(
          moving + "{push: {type: linear_motor, joint: j, force: 0}}" + analysis, "m.yaml", {});
      CoordinateFunction along;
      along.reads_velocity = false;
      along.value = [=](const CoordinateReading& x) {
        return x.value < 0.5 ? 0.0 : std::numeric_limits<double>::infinity();
      };
      of_coordinate.loads[0].of_motion = along;
      for (const Model& model : {of_point, of_coordinate}) {
        Simulation s(model);
        const RunSummary r = s.run();
        EXPECT_EQ(r.message,
                  "the load 'push' is not a finite number at t = 0.5 s. Correct its function.")
            << order << ' ' << step;
      }
    }
}

TEST(FiniteFunctions, AreRefusedWithoutAValueAtTheStart) {
  const auto refusal = [](const std::string& model) {
    try {
      Simulation s(io::read_model_text(
          "format: 1\n" + model + "analysis: {duration: 1, step: 0.1}\n", "m.yaml", {}));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal(kBody + "loads: {push: {type: force, body: a, force: ['1/t', 0, 0]}}\n"),
            "loads.push: is not a finite number at the start, t = 0. Correct its function.");
  EXPECT_EQ(refusal(kSlide + "loads: {push: {type: linear_motor, joint: j, force: 'log(t)'}}\n"),
            "loads.push: is not a finite number at the start, t = 0. Correct its function.");
  EXPECT_EQ(refusal(kBody + "loads: {push: {type: force, body: a, force: ['1/(t + 1)', 0, 0]}}\n"),
            "accepted");
}

TEST(FiniteFunctions, DrivesThatStartWithAnInfiniteRateAreRefused) {
  const auto answer = [](const std::string& model, const std::string& analysis) {
    try {
      Simulation s(io::read_model_text("format: 1\n" + model + analysis, "m.yaml", {}));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("accepted");
  };
  const auto motor = [](const std::string& x) {
    return kSlide + "loads: {push: {type: linear_motor, joint: j, displacement: '" + x + "'}}\n";
  };
  const auto motion = [](const std::string& x) {
    return "bodies: {a: {mass: 1, inertia: [1, 1, 1], motion: {z: '" + x + "'}}}\n";
  };
  const std::string hint =
      ": starts with an infinite rate. Begin with a finite rate, as 'smoothstep' does.";
  for (const char* analysis :
       {"analysis: {duration: 1, step: 1e-1}\n", "analysis: {duration: 1, step: 1e-2}\n",
        "analysis: {duration: 1, step: 1e-4}\n", "analysis: {duration: 1000, order: 4, step: 1}\n",
        "analysis: {duration: 1 ms, tolerance: 1e-6}\n"}) {
    EXPECT_EQ(answer(motor("0.1*sqrt(t)"), analysis), "loads.push" + hint) << analysis;
    EXPECT_EQ(answer(motor("0.1*t^0.75"), analysis), "loads.push" + hint) << analysis;
    EXPECT_EQ(answer(motion("2 + sqrt(t)"), analysis), "joints.a.motion" + hint) << analysis;
    for (const char* fine : {"0.1*t^1.5", "0.1*sin(1e6*t)", "0.1*smoothstep(t, 0, 1e-3)"}) {
      EXPECT_EQ(answer(motor(fine), analysis), "accepted") << fine << ", " << analysis;
      EXPECT_EQ(answer(motion(fine), analysis), "accepted") << fine << ", " << analysis;
    }
  }
}

// The integral of 1/|t - 0.503| does not exist, those of the square root of that, of a logarithm
// and of a narrow pulse do, and 0/0 may have a limit.
TEST(FiniteFunctions, RunsOverAPoleAreNotTrusted) {
  const auto reasons = [](const std::string& force, double step) {
    Simulation s(io::read_model_text(
        "format: 1\n" + kBody + "loads: {push: {type: force, body: a, force: ['" + force +
            format("', 0, 0]}}}}\nanalysis: {{duration: 1, step: {}}}\n", step),
        "m.yaml", {}));
    std::string text;
    for (const std::string& reason : s.run().distrust) text += reason;
    return text;
  };
  for (const double step : {0.1, 0.01, 1e-4})
    for (const char* pole : {"1/(0.503 - t)", "1/(0.503 - t)^2", "1/sin(10*(t - 0.503))"})
      EXPECT_THAT(reasons(pole, step),
                  HasSubstr("the load 'push' grows beyond all bounds at t = 0."))
          << pole;
  EXPECT_THAT(reasons("1/(0.503 - t)", 0.01), HasSubstr("at t = 0.503 s. Correct its function"));
  const Model none = io::read_model_text(
      "format: 1\n" + kBody +
          "loads:\n  a: {type: force, body: a, force: ['1/sqrt(abs(0.503 - t))', 0, 0]}\n"
          "  b: {type: force, body: a, force: ['log(abs(0.503 - t))', 0, 0]}\n"
          "  c: {type: force, body: a, force: ['exp(-((t - 0.5)/1e-7)^2)', 0, 0]}\n"
          "  d: {type: force, body: a, force: ['sin(t - 0.503)/(t - 0.503)', 0, 0]}\n"
          "  e: {type: force, body: a, force: ['t > 0.5 ? exp(-t) : 0', 't > 0.5 ? 1 : 1e-9', 5]}\n"
          "  f: {type: force, body: a, force: ['exp(30*t)', 'sin(50*t)^3', 't^2']}\n"
          "analysis: {duration: 1, step: 0.01}\n",
      "m.yaml", {});
  EXPECT_EQ(endless_in(none, 1.0).text, "");
}

}  // namespace polhode::test::finite_functions_tests
