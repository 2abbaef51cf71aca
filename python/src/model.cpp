// SPDX-License-Identifier: Apache-2.0
#include <charconv>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/held_value.hpp>
#include <polhode/core/names.hpp>
#include <polhode/core/time_sum.hpp>
#include <polhode/io/exporters/export_model.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/read/time_function.hpp>
#include <polhode/io/schema/schema.hpp>
#include <polhode/io/text/file_error.hpp>
#include <polhode/io/text/source_tree.hpp>
#include <polhode/loads/registry.hpp>

#include <nanobind/stl/string_view.h>

#include "compiled_model.hpp"
#include "time_call.hpp"

namespace polhode::python {

namespace {

template <class Number>
bool reads_as(const std::string& text, Number& value) {
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  return fault == std::errc() && end == text.data() + text.size();
}

nb::object scalar(const io::SourceNode& node) {
  if (node.in_quotes) return nb::str(node.text.c_str(), node.text.size());
  if (node.text == "true" || node.text == "false") return nb::bool_(node.text == "true");
  std::int64_t whole = 0;
  if (reads_as(node.text, whole)) return nb::int_(whole);
  double number = 0.0;
  const bool digits = node.text.find_first_not_of("0123456789.+-eE") == std::string::npos;
  if (digits && reads_as(node.text, number)) return nb::float_(number);
  return nb::str(node.text.c_str(), node.text.size());
}

nb::object tree(const io::SourceNode& node) {
  switch (node.kind) {
    case io::SourceNode::Kind::kEmpty:
      return nb::none();
    case io::SourceNode::Kind::kText:
      return scalar(node);
    case io::SourceNode::Kind::kList: {
      nb::list list;
      for (const io::SourceNode& child : node.children) list.append(tree(child));
      return list;
    }
    case io::SourceNode::Kind::kMap:
      break;
  }
  nb::dict map;
  for (std::size_t i = 0; i < node.keys.size(); ++i)
    map[nb::str(node.keys[i].name.c_str())] = tree(node.children[i]);
  return map;
}

/// Sets a Python callable as function of a load: its vector or one component of it, or the drive
/// of a motor.
/// @param component  Of the vector; −1: all three, or a motor's number.
///
/// Functions of a load of a part are in the part's axes. Components given one by one are set one
/// after the other, hence added to the placeholder, zero.
void set_function(CompiledModel& compiled, const std::string& load, int component,
                  const nb::object& function) {
  Model& model = compiled.model;
  compiled.calls.attr("append")(function);
  LoadSpec& spec = model.loads.at(static_cast<std::size_t>(model.load_index(load)));
  if (spec.value) {
    const auto call = std::make_shared<TimeCall>(function, 1);
    spec.value = scaled(std::make_shared<CalledFunction>(call, 0), spec.part_axes.sense);
    return;
  }
  const bool axial = spec.solid < 0 && load_kind(spec.type).vector == "moment";
  const Mat3 T = spec.part_axes.vector_map(spec.body_fixed, axial);
  if (!spec.vector) spec.vector.emplace();
  TimeVector given;
  const auto call = std::make_shared<TimeCall>(function, component < 0 ? 3 : 1);
  for (std::size_t i = 0; i < 3; ++i) {
    if (component < 0)
      given[i] = std::make_shared<CalledFunction>(call, i);
    else if (component == static_cast<int>(i))
      given[i] = std::make_shared<CalledFunction>(call, 0);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    TimeFunctionPtr turned = given[i];
    if (!T.isIdentity(0.0))
      turned = std::make_shared<TimeSum>(given, std::array{T(row, 0), T(row, 1), T(row, 2)});
    TimeFunctionPtr& here = spec.vector->at(i);
    if (component < 0 || !here)
      here = turned;
    else if (turned)
      here =
          std::make_shared<TimeSum>(TimeVector{here, turned, nullptr}, std::array{1.0, 1.0, 0.0});
  }
}

/// Sets a Python callable of the motion as force, moment or drive of a motor.
void set_motion_function(CompiledModel& compiled, const std::string& load,
                         const nb::object& function, const nb::object& tangent, bool coordinate,
                         bool reads_velocity) {
  Model& model = compiled.model;
  compiled.calls.attr("append")(nb::make_tuple(function, tangent));
  LoadSpec& spec = model.loads.at(static_cast<std::size_t>(model.load_index(load)));
  spec.of_motion = motion_function(function, tangent, coordinate, reads_velocity);
}

/// Adds a constant to the function of a load: to its drive (component −1) or to a component of its
/// vector.
void add_offset(CompiledModel& compiled, const std::string& load, int component, double offset) {
  Model& model = compiled.model;
  LoadSpec& spec = model.loads.at(static_cast<std::size_t>(model.load_index(load)));
  const auto constant = std::make_shared<io::ConstantFunction>(offset);
  const auto raised = [&](const TimeFunctionPtr& f) -> TimeFunctionPtr {
    if (const HeldValue* held = held_value(f))
      return std::make_shared<HeldValue>(held->numbers(), held->index(), held->offset() + offset);
    return std::make_shared<TimeSum>(TimeVector{f, constant, nullptr}, std::array{1.0, 1.0, 0.0});
  };
  if (component < 0 && spec.value)
    spec.value = raised(spec.value);
  else if (component >= 0 && component < 3 && spec.vector)
    spec.vector->at(static_cast<std::size_t>(component)) =
        raised(spec.vector->at(static_cast<std::size_t>(component)));
  else
    throw InputError(format("loads.{}", load), "has no such input",
                     "Name a component of a force or moment, x, y or z, or the drive of a motor");
}

/// Writes a model at its start as a file of another program. @returns the notes: kind, path, what.
nb::list export_file(const CompiledModel& compiled, const std::string& path, bool partial) {
  const Simulation simulation(compiled.model);
  const io::Exported written = io::export_model(simulation, {path, partial});
  io::write_file_atomically(path, written.text, false);
  nb::list notes;
  for (const io::ExportNote& n : written.notes)
    notes.append(nb::make_tuple(io::word_of(n.kind), n.path, n.what));
  return notes;
}

}  // namespace

void bind_model(nb::module_& m) {
  m.def("schema_text", &io::json_schema, "JSON Schema of the model file.");
  m.def("read_text", &io::read_file, nb::arg("path"), "The text of a file.");
  m.def(
      "parse",
      [](std::string text, std::string name) {
        return tree(io::SourceTree::parse(std::move(text), std::move(name)).root());
      },
      nb::arg("text"), nb::arg("name"), "A model text as dicts, lists, numbers and texts.");
  m.def(
      "expanded",
      [](const std::string& path, const io::Overrides& overrides) {
        return io::expanded_model(path, overrides).text;
      },
      nb::arg("path"), nb::arg("overrides"),
      "The text of a model file, with the content of a robot's file that it imports or is.");
  m.def("closest", &closest, nb::arg("word"), nb::arg("candidates"),
        "The candidate nearest to a mistyped word, or an empty text.");
  nb::class_<CompiledModel>(m, "CompiledModel", "A model that was read and checked.",
                            nb::type_slots(CallSlots<CompiledModel>::slots))
      .def_prop_ro("title", [](const CompiledModel& c) { return c.model.title; })
      .def_prop_ro("analysis", [](const CompiledModel& c) { return c.model.analysis.type; })
      .def("set_function", &set_function, nb::arg("load"), nb::arg("component"),
           nb::arg("function"))
      .def("set_motion_function", &set_motion_function, nb::arg("load"), nb::arg("function"),
           nb::arg("tangent").none(), nb::arg("coordinate"), nb::arg("reads_velocity"))
      .def("copy",
           [](const CompiledModel& c) {
             return CompiledModel{c.model, nb::list(c.calls), c.preferred};
           })
      .def("add_offset", &add_offset, nb::arg("load"), nb::arg("component"), nb::arg("offset"))
      .def_prop_ro("step", [](const CompiledModel& c) { return c.model.analysis.step; })
      .def_prop_ro("duration", [](const CompiledModel& c) { return c.model.analysis.duration; });
  m.def("export_file", &export_file, nb::arg("model"), nb::arg("path"), nb::arg("partial"),
        "Writes a model as a file of another program, and returns notes of kind, path and text.");
  m.def(
      "compile",
      [](const std::string& text, const std::string& name, const io::Overrides& overrides) {
        CompiledModel compiled;
        const nb::gil_scoped_release unlocked;
        compiled.model = io::read_model_text(text, name, overrides);
        return compiled;
      },
      nb::arg("text"), nb::arg("name"), nb::arg("overrides"), "Reads and checks a model text.");
}

}  // namespace polhode::python
