// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/model/model.hpp>

#include "parts.hpp"

namespace polhode::python {

/// A model that was read, with the Python callables of its loads.
///
/// The loads borrow the callables; the list owns them, here and in each Engine made from the model,
/// and shows them to Python's collector of cycles: a force may know the simulation that calls it.
struct CompiledModel {
  Model model;
  nb::object calls = nb::list();
  /// Joint coordinates that are to be independent.
  std::vector<std::string> preferred{};
};

/// Slots by which Python's collector sees the member `calls` of a bound type.
template <class T>
struct CallSlots {
  static int traverse(PyObject* self, visitproc visit, void* arg) {
#if PY_VERSION_HEX >= 0x03090000
    Py_VISIT(Py_TYPE(self));
#endif
    if (nb::inst_ready(self)) Py_VISIT(nb::inst_ptr<T>(self)->calls.ptr());
    return 0;
  }
  static int clear(PyObject* self) {
    if (nb::inst_ready(self)) nb::inst_ptr<T>(self)->calls.reset();
    return 0;
  }
  inline static PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(&traverse)},
                                       {Py_tp_clear, reinterpret_cast<void*>(&clear)},
                                       {0, nullptr}};
};

}  // namespace polhode::python
