// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <polhode/model/model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::cli {

/// A model file as a command names it, with its --set values.
struct ModelArguments {
  std::string file;
  std::vector<std::string> overrides;
};

/// Reads the model. @throws FileError if there is no such file; ModelErrors if it is wrong.
[[nodiscard]] Model load_model(const ModelArguments& arguments);

/// Narration: one line on stderr.
void say(const std::string& line);
/// Text on stdout, as it is. @throws FileError if stdout takes no more.
void print(const std::string& text);

/// Columns side by side, each as wide as its widest cell; numbers, with a unit or without, to the
/// right.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                const std::string& indent = "  ", bool numbers_right = true);

/// 3 significant figures and a unit that suits: 1.23 s, 45 ms.
[[nodiscard]] std::string seconds(double value);

/// A line on stderr that is written over and over while a run goes on; only on a terminal.
class Progress {
 public:
  Progress(bool wanted, double duration);
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  void show(const Simulation& simulation);
  void clear();

 private:
  bool on_;
  bool visible_ = false;
  double duration_, start_, next_ = 0.0;
  double first_t_ = -1.0;
};

/// Seconds of a clock that never jumps.
[[nodiscard]] double wall_clock();

}  // namespace polhode::cli
