// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include <polhode/core/format.hpp>
#include <polhode/io/results/checksums.hpp>
#include <polhode/io/results/hdf5_id.hpp>
#include <polhode/io/results/results_format.hpp>
#include <polhode/io/results/results_reader.hpp>
#include <polhode/io/text/file_error.hpp>

#include "parts.hpp"

namespace polhode::python {

namespace {

/// An HDF5 identifier, closed by its destructor.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Reads data sets of a results file, also while a run still writes it.
class ResultsReader {
 public:
  explicit ResultsReader(std::string path)
      : path_(std::move(path)), file_(open(path_, cut_), H5Fclose) {}

  /// Warning about a file that is cut short; empty for others.
  [[nodiscard]] std::string cut_text() const { return cut_ ? cut_->cut_text() : std::string(); }

  [[nodiscard]] std::vector<std::string> paths() const {
    std::vector<std::string> list;
    const auto visit = [](hid_t, const char* name, const H5O_info_t* info, void* out) -> herr_t {
      if (info->type == H5O_TYPE_DATASET && io::results::kChecksums != std::string("/") + name)
        static_cast<std::vector<std::string>*>(out)->emplace_back(std::string("/") + name);
      return 0;
    };
    H5Ovisit(file_, H5_INDEX_NAME, H5_ITER_NATIVE, visit, &list);
    return list;
  }

  /// A data set as array, or list of texts.
  [[nodiscard]] nb::object read(const std::string& name) const {
    const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (set < 0) throw nb::key_error(name.c_str());
    const Handle space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
    std::vector<hsize_t> dims(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
    H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    const Handle creation(H5Dget_create_plist(set), H5Pclose);
    const H5D_layout_t layout = H5Pget_layout(creation);
    const bool by_frame = layout == H5D_CHUNKED || layout == H5D_VIRTUAL;
    if (cut_ && by_frame && !dims.empty()) dims[0] = std::min<hsize_t>(dims[0], cut_->frames());
    const std::vector<std::size_t> shape(dims.begin(), dims.end());
    std::size_t count = 1;
    for (const std::size_t n : shape) count *= n;
    switch (H5Tget_class(type)) {
      case H5T_STRING:
        return texts(set, type, count);
      case H5T_INTEGER: {
        std::vector<std::int64_t> values = numbers<std::int64_t>(set, H5T_NATIVE_INT64, dims);
        check(set, name, {values.begin(), values.end()}, shape, true);
        return nb::cast(array_of(std::move(values), shape));
      }
      default: {
        std::vector<double> values = numbers<double>(set, H5T_NATIVE_DOUBLE, dims);
        check(set, name, values, shape, false);
        return nb::cast(array_of(std::move(values), shape));
      }
    }
  }

  /// An attribute of a group or data set as text or number; none if there is none.
  [[nodiscard]] nb::object attribute(const std::string& object, const std::string& name) const {
    if (H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) <= 0) return nb::none();
    const Handle a(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
    const Handle type(H5Aget_type(a), H5Tclose);
    if (H5Tget_class(type) != H5T_STRING) {
      double value = 0.0;
      H5Aread(a, H5T_NATIVE_DOUBLE, &value);
      return nb::float_(value);
    }
    if (H5Tis_variable_str(type) > 0) {
      char* text = nullptr;
      H5Aread(a, type, static_cast<void*>(&text));
      nb::str result(text ? text : "");
      H5free_memory(text);
      return result;
    }
    std::string text(H5Tget_size(type), '\0');
    H5Aread(a, type, text.data());
    return nb::str(text.c_str());
  }

 private:
  /// Compares stored numbers with their checksums, in the frames that are complete.
  void check(hid_t set, const std::string& name, const std::vector<double>& values,
             const std::vector<std::size_t>& shape, bool integer) const {
    namespace r = io::results;
    if (shape.empty() || H5Aexists(set, r::kChecksumColumn) <= 0) return;
    const Handle attribute(H5Aopen(set, r::kChecksumColumn, H5P_DEFAULT), H5Aclose);
    double given = -1.0;
    H5Aread(attribute, H5T_NATIVE_DOUBLE, &given);
    const Handle sums(H5Dopen2(file_, r::kChecksums, H5P_DEFAULT), H5Dclose);
    const Handle time(H5Dopen2(file_, r::kTime, H5P_DEFAULT), H5Dclose);
    const std::vector<hsize_t> dims = extent(sums), times = extent(time);
    if (dims.size() != 2 || times.empty() ||
        !(given >= 0.0 && given < static_cast<double>(dims[1])))
      damaged(name, "has lost its checksums");
    const auto column = static_cast<std::size_t>(given);
    const std::size_t frames = std::min<std::size_t>({shape[0], times[0], dims[0]});
    const std::vector<double> all = numbers<double>(sums, H5T_NATIVE_DOUBLE, {frames, dims[1]});
    const std::size_t size = shape[0] == 0 ? 0 : values.size() / shape[0];
    for (std::size_t k = 0; k < frames; ++k)
      if (r::checksum({values.data() + k * size, size}, integer) != all[k * dims[1] + column])
        damaged(name, format("differs from its checksum in frame {}", k));
  }

  [[noreturn]] void damaged(const std::string& name, const std::string& what) const {
    throw io::FileError(path_, format("is damaged: '{}' {}", name, what),
                        "Copy the file again, or run the model again");
  }

  static std::vector<hsize_t> extent(hid_t set) {
    if (set < 0) return {};
    const Handle space(H5Dget_space(set), H5Sclose);
    const int rank = H5Sget_simple_extent_ndims(space);
    std::vector<hsize_t> dims(static_cast<std::size_t>(std::max(rank, 0)));
    if (!dims.empty()) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
    return dims;
  }

  /// @param cut  Set for a file that is cut short, whose copy of the full length is opened.
  static hid_t open(const std::string& path, std::optional<io::ResultsReader>& cut) {
    io::hdf5::prepare();
    if (!io::results::survives_a_walk(path))
      throw io::FileError(path, "is damaged: its structure is broken",
                          "Run the model again, or copy the file again");
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_file_locking(access, false, true);
    hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access);
    if (file < 0) {  // HDF5 refuses a file that is shorter than it says.
      cut.emplace(path);
      file = H5Fopen(cut->opened_path().c_str(), H5F_ACC_RDONLY, access);
    }
    if (file < 0)
      throw io::FileError(path, "cannot be opened as HDF5",
                          "Give the path of a file results.h5 that a run has written");
    return file;
  }

  /// Numbers of the first part of a data set, of that shape.
  template <class T>
  [[nodiscard]] std::vector<T> numbers(hid_t set, hid_t type,
                                       const std::vector<hsize_t>& part) const {
    std::size_t count = 1;
    for (const hsize_t n : part) count *= n;
    std::vector<T> values(count);
    if (count == 0) return values;
    const auto rank = static_cast<int>(part.size());
    const Handle memory(
        rank == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(rank, part.data(), nullptr), H5Sclose);
    const Handle source(H5Dget_space(set), H5Sclose);
    const std::vector<hsize_t> start(part.size(), 0);
    if (rank > 0)
      H5Sselect_hyperslab(source, H5S_SELECT_SET, start.data(), nullptr, part.data(), nullptr);
    if (H5Dread(set, type, memory, source, H5P_DEFAULT, values.data()) < 0)
      throw io::FileError(path_, "a data set cannot be read", "Run the model again");
    return values;
  }

  [[nodiscard]] static nb::object texts(hid_t set, hid_t type, std::size_t count) {
    nb::list list;
    if (count == 0) return list;
    if (H5Tis_variable_str(type) > 0) {
      std::vector<char*> pointers(count);
      H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, static_cast<void*>(pointers.data()));
      for (char* text : pointers) {
        list.append(nb::str(text ? text : ""));
        H5free_memory(text);
      }
      return list;
    }
    const std::size_t size = H5Tget_size(type);
    std::string all(size * count, '\0');
    H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data());
    for (std::size_t i = 0; i < count; ++i)
      list.append(nb::str(all.substr(i * size, size).c_str()));
    return list;
  }

  std::string path_;
  std::optional<io::ResultsReader> cut_;  ///< Outlives the open file.
  Handle file_;
};

}  // namespace

void bind_results_reader(nb::module_& m) {
  m.attr("results_format_version") = io::results::kFormatVersion;
  nb::class_<ResultsReader>(m, "ResultsReader", "Reads a file results.h5.")
      .def(nb::init<std::string>(), nb::arg("path"))
      .def("cut_text", &ResultsReader::cut_text)
      .def("paths", &ResultsReader::paths)
      .def("read", &ResultsReader::read, nb::arg("path"))
      .def("attribute", &ResultsReader::attribute, nb::arg("object"), nb::arg("name"));
}

}  // namespace polhode::python
