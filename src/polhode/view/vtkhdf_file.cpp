// SPDX-License-Identifier: Apache-2.0
#include <polhode/view/vtkhdf_file.hpp>

#include <array>

#include <polhode/core/format.hpp>
#include <polhode/io/text/file_error.hpp>

namespace polhode {

namespace {

using io::hdf5::Id;

void check_written(bool good, const std::string& path) {
  if (!good)
    throw io::FileError(path, "cannot be written", "Free disk space, or name another file");
}

Id new_group(hid_t parent, const std::string& name, bool ordered = false) {
  Id how(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  if (ordered) H5Pset_link_creation_order(how.get(), H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, how.get(), H5P_DEFAULT), H5Gclose};
}

void text_attribute(hid_t object, const char* name, const std::string& text) {
  const Id type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.get(), text.size());
  H5Tset_strpad(type.get(), H5T_STR_NULLPAD);
  const Id attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
  H5Awrite(attribute.get(), type.get(), text.data());
}

void number_attribute(hid_t object, const char* name, const std::vector<std::int64_t>& values) {
  const hsize_t size = values.size();
  const Id space(size == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, nullptr), H5Sclose);
  const Id attribute(H5Acreate2(object, name, H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                     H5Aclose);
  H5Awrite(attribute.get(), H5T_NATIVE_INT64, values.data());
}

/// Writes the type, and the version of the format that it requires.
void describe(hid_t group, const std::string& type) {
  number_attribute(group, "Version", {2, 3});
  text_attribute(group, "Type", type);
}

/// Rows of `width` numbers, deflated in chunks of about 64 KB; a single number is no row.
template <class T>
bool write_rows(hid_t group, const std::string& name, hid_t stored, hid_t native,
                const std::vector<T>& values, std::size_t width = 1, bool table = false) {
  const std::array<hsize_t, 2> dims = {values.size() / width, width};
  const int rank = width > 1 || table ? 2 : 1;
  const Id space(H5Screate_simple(rank, dims.data(), nullptr), H5Sclose);
  const Id how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (values.size() > 64) {
    const std::array<hsize_t, 2> piece = {std::min<hsize_t>(dims[0], 1 + 8192 / width), width};
    H5Pset_chunk(how.get(), rank, piece.data());
    H5Pset_shuffle(how.get());
    H5Pset_deflate(how.get(), 4);
  }
  const Id set(
      H5Dcreate2(group, name.c_str(), stored, space.get(), H5P_DEFAULT, how.get(), H5P_DEFAULT),
      H5Dclose);
  return set.valid() && (values.empty() || H5Dwrite(set.get(), native, H5S_ALL, H5S_ALL,
                                                    H5P_DEFAULT, values.data()) >= 0);
}

bool write_numbers(hid_t group, const std::string& name, const std::vector<double>& values,
                   std::size_t width = 1) {
  return write_rows(group, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, width);
}

bool write_indices(hid_t group, const std::string& name, const std::vector<std::int64_t>& values,
                   bool table = false) {
  return write_rows(group, name, H5T_STD_I64LE, H5T_NATIVE_INT64, values, 1, table);
}

/// Starts 0, by, 2 by, ... of the parts of the frames.
std::vector<std::int64_t> begins(std::size_t frames, std::size_t by) {
  std::vector<std::int64_t> list;
  for (std::size_t f = 0; f < frames; ++f) list.push_back(static_cast<std::int64_t>(f * by));
  return list;
}

/// Name that is valid in a path and an assembly.
std::string block_name(const std::string& name) {
  std::string result;
  for (const char c : name) result += c == '/' || c == '.' ? '_' : c;
  return result;
}

}  // namespace

VtkHdfFile::VtkHdfFile(std::string path, std::vector<double> times)
    : path_(std::move(path)), unfinished_(path_), times_(std::move(times)) {
  file_ =
      Id(H5Fcreate(unfinished_.path().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  check_written(file_.valid(), path_);
  root_ = new_group(file_.get(), "VTKHDF", true);
  describe(root_.get(), "PartitionedDataSetCollection");
  assembly_ = new_group(root_.get(), "Assembly", true);
}

VtkHdfFile::~VtkHdfFile() {
  for (Id* id : {&assembly_, &root_, &file_}) id->close();
}

void VtkHdfFile::add_fields(hid_t grid, hid_t steps, const char* group,
                            const std::vector<VtkHdfField>& fields, std::size_t entries) {
  const Id data = new_group(grid, group), places = new_group(steps, format("{}Offsets", group));
  for (const VtkHdfField& field : fields) {
    check_written(write_numbers(data.get(), field.name, field.values(), field.width) &&
                      write_indices(places.get(), field.name, begins(times_.size(), entries)),
                  path_);
    const Id set(H5Dopen2(data.get(), field.name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!field.unit.empty()) text_attribute(set.get(), "unit", field.unit);
  }
}

void VtkHdfFile::add(const VtkHdfGrid& grid) {
  std::string name = block_name(grid.name);
  while (!names_.insert(name).second) name += "_";
  const std::size_t frames = times_.size();
  const Id group = new_group(root_.get(), name);
  check_written(group.valid(), path_);
  describe(group.get(), "UnstructuredGrid");
  number_attribute(group.get(), "Index", {static_cast<std::int64_t>(names_.size() - 1)});
  const std::vector<std::int64_t> zeros(frames, 0);
  const auto one = [](std::size_t n) { return std::vector{static_cast<std::int64_t>(n)}; };
  bool good =
      write_numbers(group.get(), "Points", grid.positions(), 3) &&
      write_indices(group.get(), "NumberOfPoints", one(grid.points)) &&
      write_indices(group.get(), "NumberOfCells", one(grid.types.size())) &&
      write_indices(group.get(), "NumberOfConnectivityIds", one(grid.connectivity.size())) &&
      write_indices(group.get(), "Connectivity", grid.connectivity) &&
      write_indices(group.get(), "Offsets", grid.offsets) &&
      write_rows(group.get(), "Types", H5T_STD_U8LE, H5T_NATIVE_UINT8, grid.types);
  const Id steps = new_group(group.get(), "Steps");
  number_attribute(steps.get(), "NSteps", {static_cast<std::int64_t>(frames)});
  good = good && write_numbers(steps.get(), "Values", times_) &&
         write_indices(steps.get(), "PartOffsets", zeros) &&
         write_indices(steps.get(), "NumberOfParts", std::vector<std::int64_t>(frames, 1)) &&
         write_indices(steps.get(), "PointOffsets", begins(frames, grid.points)) &&
         write_indices(steps.get(), "CellOffsets", zeros, true) &&
         write_indices(steps.get(), "ConnectivityIdOffsets", zeros, true);
  check_written(good, path_);
  add_fields(group.get(), steps.get(), "PointData", grid.point_data, grid.points);
  add_fields(group.get(), steps.get(), "CellData", grid.cell_data, grid.types.size());
  {
    const Id data(H5Gopen2(group.get(), "CellData", H5P_DEFAULT), H5Gclose);
    const Id places(H5Gopen2(steps.get(), "CellDataOffsets", H5P_DEFAULT), H5Gclose);
    for (const auto& [field, values] : grid.fixed_cell_data)
      check_written(
          write_numbers(data.get(), field, values) && write_indices(places.get(), field, zeros),
          path_);
  }
  H5Lcreate_soft(format("/VTKHDF/{}", name).c_str(), assembly_.get(), name.c_str(), H5P_DEFAULT,
                 H5P_DEFAULT);
}

void VtkHdfFile::close() {
  bool good = assembly_.close() >= 0;
  good = root_.close() >= 0 && good;
  good = file_.close() >= 0 && good;
  check_written(good, path_);
  unfinished_.keep(false);
}

}  // namespace polhode
