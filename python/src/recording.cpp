// SPDX-License-Identifier: Apache-2.0
#include "recording.hpp"

namespace polhode::python {

Recording::Recording(const Simulation& simulation)
    : layout_(io::results_layout(simulation)),
      plan_(io::plan_results(layout_)),
      columns_(plan_.channels.size()) {
  const OutputSpec& output = simulation.model().output;
  for (const ProbeSpec& spec : output.probes)
    probes_.push_back({probe_target(simulation, spec), ProbeClock(spec, output)});
}

void Recording::step(const Simulation& simulation) {
  for (ProbeRows& probe : probes_) {
    if (!probe.clock.strikes(simulation.time(), simulation.stopped())) continue;
    const std::vector<double> row = probe_row(probe.target, simulation);
    probe.numbers.insert(probe.numbers.end(), row.begin(), row.end());
  }
}

nb::dict Recording::probes() {
  nb::dict result;
  for (ProbeRows& probe : probes_) {
    const std::size_t columns = probe.target.header.size();
    const std::size_t rows = probe.numbers.size() / columns;
    result[probe.target.spec.name.c_str()] = nb::make_tuple(
        nb::cast(probe.target.header), array_of(std::move(probe.numbers), {rows, columns}));
  }
  return result;
}

void Recording::frame(const Simulation& simulation) {
  if (frames_ > 0 && simulation.time() <= last_) return;
  numbers_.clear();
  io::list_numbers(io::results_frame(simulation), numbers_);
  const double* next = numbers_.data();
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const std::size_t size = plan_.channels[i].size();
    columns_[i].insert(columns_[i].end(), next, next + size);
    next += size;
  }
  ++frames_;
  last_ = simulation.time();
}

nb::dict Recording::channels() {
  nb::dict result;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const io::Channel& channel = plan_.channels[i];
    std::vector<std::size_t> shape{frames_};
    shape.insert(shape.end(), channel.dims.begin(), channel.dims.end());
    nb::object array;
    if (channel.integer) {
      std::vector<std::int64_t> whole(columns_[i].begin(), columns_[i].end());
      array = nb::cast(array_of(std::move(whole), shape));
    } else {
      array = nb::cast(array_of(std::move(columns_[i]), shape));
    }
    result[channel.path.c_str()] = nb::make_tuple(array, channel.unit);
  }
  return result;
}

nb::dict Recording::views() const {
  nb::dict result;
  for (const io::ChannelView& view : plan_.views) {
    const io::Channel& channel = plan_.channels[view.channel];
    result[view.path.c_str()] = nb::make_tuple(channel.path, view.first, view.count, view.squeeze,
                                               view.unit.empty() ? channel.unit : view.unit);
  }
  return result;
}

nb::dict Recording::fixed() const {
  const io::FixedData data = io::fixed_data(layout_);
  nb::dict result;
  for (const auto& [path, names] : data.names) result[path.c_str()] = nb::cast(names);
  for (const auto& [path, numbers] : data.numbers)
    result[path.c_str()] = nb::cast(array_of(std::vector(numbers), {numbers.size()}));
  for (const auto& [path, rows] : data.vectors) {
    std::vector<double> numbers;
    for (const Vec3& row : rows) numbers.insert(numbers.end(), row.begin(), row.end());
    result[path.c_str()] = nb::cast(array_of(std::move(numbers), {rows.size(), 3}));
  }
  return result;
}

void bind_recording(nb::module_& m) {
  nb::class_<Recording>(m, "Recording", "Results of a run in memory.")
      .def_prop_ro("frames", &Recording::frames)
      .def("channels", &Recording::channels)
      .def("views", &Recording::views)
      .def("probes", &Recording::probes)
      .def("fixed", &Recording::fixed);
}

}  // namespace polhode::python
