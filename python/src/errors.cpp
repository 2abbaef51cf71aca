// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/file_error.hpp>

#include "parts.hpp"

namespace polhode::python {

namespace {

nb::object errors() { return nb::module_::import_("polhode._errors"); }

nb::tuple fault(const io::Diagnostic& d) {
  return nb::make_tuple(d.place.file, d.place.line, d.place.column, d.path, d.what, d.hint,
                        d.excerpt);
}

/// Raises polhode.ModelError with one tuple for each fault.
void raise_model_error(const nb::list& faults) {
  const nb::object error = errors().attr("ModelError")(faults);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const io::ModelErrors& e) {
    nb::list faults;
    for (const io::Diagnostic& d : e.diagnostics()) faults.append(fault(d));
    raise_model_error(faults);
  } catch (const InputError& e) {
    io::Diagnostic d;
    d.path = e.where();
    d.what = e.what_is_wrong();
    d.hint = e.hint();
    nb::list faults;
    faults.append(fault(d));
    raise_model_error(faults);
  } catch (const io::FileError& e) {
    PyErr_SetString(PyExc_OSError, e.what());
  }
}

}  // namespace

void bind_errors(nb::module_&) { nb::register_exception_translator(translate); }

}  // namespace polhode::python
