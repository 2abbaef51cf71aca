// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::cli {

/// A model file given to a command, with its --set values.
struct ModelArguments {
  std::string file;
  std::vector<std::string> overrides;
};

/// Reads the model. @throws FileError if there is no such file; ModelErrors if it is wrong.
[[nodiscard]] Model load_model(const ModelArguments& arguments);

/// The message of an error that is found after reading, with its place in the model's file.
[[nodiscard]] std::string located_text(const InputError& error);
[[nodiscard]] std::string located_text(const SolveError& error);

/// Opens those of the descriptors 0 to 2 that are closed, so that no file of a run gets the number,
/// and with it the text, of the console. Reading and writing them stays an error.
void open_standard_files();

/// Prints a line on stderr.
void say(const std::string& line);
/// Prints text on stdout, unchanged. @throws FileError if stdout cannot be written.
void print(const std::string& text);

/// Whether stdout is a terminal for which NO_COLOR is not set (https://no-color.org).
[[nodiscard]] bool shows_colours();

/// Table with columns of the width of their widest cell; numbers, with or without a unit, are
/// aligned right.
[[nodiscard]] std::string table(const std::vector<std::vector<std::string>>& rows,
                                const std::string& indent = "  ", bool numbers_right = true);

/// Time with 3 significant figures and a suitable unit: 1.23 s, 45 ms.
[[nodiscard]] std::string seconds(double value);

/// A progress line on stderr that is overwritten during a run; only on a terminal.
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

/// Monotonic time [s].
[[nodiscard]] double wall_clock();

}  // namespace polhode::cli
