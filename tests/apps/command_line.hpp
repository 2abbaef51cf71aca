// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <support/paths.hpp>
#include <support/program.hpp>

namespace polhode::test {

inline constexpr const char* kPendulum = R"(format: 1
title: Double pendulum
gravity: [0, 0, -9.81]
bodies:
  upper: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [0.5, 0, 0]}
  lower: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [1.5, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: y}
  B: {type: spherical, bodies: [upper, lower], at: [1, 0, 0]}
analysis: {type: dynamics, duration: 1 s, step: 10 ms}
output:
  every: 20 ms
  paraview: true
  probes:
    tip: {body: lower, point: [0.5, 0, 0], every: 50 ms}
    A: {joint: A}
)";

/// Folder with a model, in which the program is run.
class CommandLine : public testing::Test {
 protected:
  CommandLine() { write("model.yaml", kPendulum); }

  void SetUp() override {
    if (cli_program().empty()) GTEST_SKIP() << "the command line is not built";
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] std::string read(const std::string& name) const { return text_of(folder_ / name); }
  [[nodiscard]] bool exists(const std::string& name) const {
    return std::filesystem::exists(folder_ / name);
  }
  Program start(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), cli_program());
    return {arguments, folder_ / ""};
  }
  ProgramResult run(const std::vector<std::string>& arguments) const {
    return start(arguments).wait();
  }
  /// The text of a key in the JSON object that a run printed.
  static std::string value(const std::string& json, const std::string& key) {
    const std::size_t at = json.find("\"" + key + "\": ");
    if (at == std::string::npos) return "missing";
    const std::size_t begin = at + key.size() + 4;
    std::string text = json.substr(begin, json.find('\n', begin) - begin);
    if (text.back() == ',') text.pop_back();
    return text;
  }

  Scratch folder_;
};

}  // namespace polhode::test
