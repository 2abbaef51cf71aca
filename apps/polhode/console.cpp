// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <polhode/core/format.hpp>
#include <polhode/io/read/model_places.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode::cli {

namespace {

/// Positions in the model that was read last: a command reads one, then errors are about it.
io::ModelPlaces& places_of_last() {
  static io::ModelPlaces places;
  return places;
}

}  // namespace

Model load_model(const ModelArguments& arguments) {
  (void)io::read_file(arguments.file);  // A missing file is an error of input, not of the model.
  Model model = io::read_model(arguments.file, arguments.overrides);
  places_of_last() = io::ModelPlaces(model, arguments.overrides);
  return model;
}

std::string located_text(const InputError& error) {
  const std::optional<io::Diagnostic> found = places_of_last().located(error);
  return found ? found->text() : error.what();
}

std::string located_text(const SolveError& error) {
  const std::optional<io::Diagnostic> found = places_of_last().located(error);
  return found ? found->text() : error.what();
}

void open_standard_files() {
  for (int number = STDIN_FILENO; number <= STDERR_FILENO; ++number) {
    if (::fcntl(number, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. It is open for the wrong direction.
    const int how = number == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", how) != number) std::abort();
  }
}

void say(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

void print(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw io::FileError::from_errno("stdout", "cannot be written");
}

bool shows_colours() {
  const char* none = std::getenv("NO_COLOR");
  return ::isatty(STDOUT_FILENO) == 1 && (none == nullptr || *none == '\0');
}

namespace {

/// Whether a cell is a number, with or without a unit: "12", "-1.5e-3", "3.2 ms"; but not a version
/// or a sentence.
bool is_number(const std::string& cell) {
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  const std::string_view rest(end);
  return end != cell.c_str() && (rest.empty() || (rest[0] == ' ' && rest.size() <= 6));
}

}  // namespace

std::string table(const std::vector<std::vector<std::string>>& rows, const std::string& indent,
                  bool numbers_right) {
  std::vector<std::size_t> widths;
  // Letters beyond ASCII have several bytes, but one column.
  const auto width = [](const std::string& cell) {
    return static_cast<std::size_t>(
        std::count_if(cell.begin(), cell.end(), [](char c) { return (c & 0xC0) != 0x80; }));
  };
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (widths.size() <= i) widths.push_back(0);
      widths[i] = std::max(widths[i], width(row[i]));
    }
  std::string text;
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string space(widths[i] - width(row[i]), ' ');
      const bool number = numbers_right && is_number(row[i]);
      line += (i == 0 ? "" : "  ") + (number ? space + row[i] : row[i] + space);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string seconds(double value) {
  const double size = std::abs(value);
  if (size == 0.0) return "0 s";
  constexpr double kRoundsUp = 0.9995;  // 999.5 has four digits when it is rounded
  if (size < kRoundsUp * 1e-6) return format("{:.3g} ns", 1e9 * value);
  if (size < kRoundsUp * 1e-3) return format("{:.3g} µs", 1e6 * value);
  if (size < kRoundsUp) return format("{:.3g} ms", 1e3 * value);
  return value < 1000 ? format("{:.3g} s", value) : format("{:.0f} s", value);
}

double wall_clock() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(bool wanted, double duration)
    : on_(wanted && ::isatty(STDERR_FILENO) == 1), duration_(duration), start_(wall_clock()) {}

void Progress::show(const Simulation& simulation) {
  if (!on_) return;
  const double now = wall_clock();
  if (first_t_ < 0.0) first_t_ = simulation.time();
  if (now < next_) return;
  next_ = now + 0.2;
  const double t = simulation.time();
  const double done = t - first_t_;
  std::string line =
      format("{:5.1f} %  t = {:.4g} s of {:.4g} s", 100.0 * t / duration_, t, duration_);
  const Ledger& ledger = simulation.state().ledger;
  if (ledger.steps > 0)
    line += format("  step {}  {:.1f} iterations", seconds(simulation.state().dt_last),
                   static_cast<double>(ledger.iterations) / static_cast<double>(ledger.steps));
  if (done > 0.0 && now > start_ + 1.0)
    line += format("  {} left", seconds((now - start_) * (duration_ - t) / done));
  std::fprintf(stderr, "\r\033[K%s", line.c_str());
  std::fflush(stderr);
  visible_ = true;
}

void Progress::clear() {
  if (visible_) std::fprintf(stderr, "\r\033[K");
  visible_ = false;
}

}  // namespace polhode::cli
