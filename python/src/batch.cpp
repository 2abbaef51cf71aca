// SPDX-License-Identifier: Apache-2.0
// Many runs of one mechanism, side by side.
#include <algorithm>
#include <chrono>
#include <future>

#include <polhode/core/format.hpp>
#include <polhode/io/read/parsed_model.hpp>
#include <polhode/study/batch.hpp>

#include "parts.hpp"

namespace polhode::python {

namespace {

/// Time between looks at Python's signals.
constexpr auto kLook = std::chrono::milliseconds(50);

using Values = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

/// Paths of the parameters, and how many numbers each has: 0 for one number, else a list.
using Parameters = std::vector<std::pair<std::string, int>>;

/// Overrides of a run from its row of values.
std::vector<std::string> overrides_of(const Parameters& parameters, const double* values) {
  std::vector<std::string> texts;
  for (const auto& [path, count] : parameters) {
    if (count == 0) {
      texts.push_back(format("{}={:.17g}", path, *values++));
      continue;
    }
    std::string list;
    for (int i = 0; i < count; ++i) list += format("{}{:.17g}", i > 0 ? ", " : "", *values++);
    texts.push_back(format("{}=[{}]", path, list));
  }
  return texts;
}

/// Waits for a batch and looks at Python's signals. @returns whether Ctrl-C was pressed.
bool wait_for(std::future<Batch>& batch, std::atomic<bool>& stop) {
  bool interrupted = false;
  while (batch.wait_for(kLook) != std::future_status::ready) {
    const nb::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() == 0) continue;
    PyErr_Clear();
    interrupted = true;
    stop = true;
  }
  return interrupted;
}

/// Times, then channels as (name, unit, array), messages, which runs were alone, and why all were.
nb::tuple batch(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides, const Parameters& parameters,
                const Values& values, const std::vector<std::string>& channels, int threads,
                std::size_t together) {
  const std::size_t runs = values.shape(0), numbers = values.shape(1);
  std::atomic<bool> stop{false};
  const BatchOptions options{
      .channels = channels, .threads = threads, .together = together, .stop = &stop};
  const io::ParsedModel parsed(text, name, overrides);
  const auto model = [&](std::size_t run) {
    return parsed.read(overrides_of(parameters, values.data() + run * numbers));
  };
  Batch done;
  bool interrupted = false;
  {
    const nb::gil_scoped_release unlocked;
    std::future<Batch> batch =
        std::async(std::launch::async, [&] { return run_batch(model, runs, options); });
    interrupted = wait_for(batch, stop);
    done = batch.get();
  }
  if (interrupted) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw nb::python_error();
  }
  nb::list found;
  for (Batch::Channel& c : done.channels) {
    std::vector<std::size_t> shape{runs, done.times.size()};
    if (!c.one) shape.push_back(c.size);
    found.append(nb::make_tuple(c.text, c.unit, array_of(std::move(c.numbers), shape)));
  }
  const std::size_t frames = done.times.size();
  nb::list alone;
  for (const unsigned char of_run : done.alone) alone.append(nb::cast(of_run != 0));
  return nb::make_tuple(array_of(std::move(done.times), {frames}), found, nb::cast(done.messages),
                        alone, done.why_alone);
}

}  // namespace

void bind_batch(nb::module_& m) {
  m.def("batch", &batch, nb::arg("text"), nb::arg("name"), nb::arg("overrides"),
        nb::arg("parameters"), nb::arg("values"), nb::arg("channels"), nb::arg("threads"),
        nb::arg("together"));
}

}  // namespace polhode::python
