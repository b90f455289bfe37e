#include "recording/import/hdf5/hdf5_dataset.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "recording/hdf5/attributes.h"
#include "recording/hdf5/dataset.h"

namespace imunoise::recording {
namespace {

// Of a dataset with so many numbers along its dimension `time`: about a million, in whole chunks,
// because HDF5 unpacks a chunk as a whole.
hsize_t numbers_in_piece(hid_t dataset, int time, hsize_t count) {
  constexpr hsize_t kMany = hsize_t{1} << 20U;
  const Hdf5Handle how(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, 2> chunk = {1, 1};
  if (how && H5Pget_layout(how.get()) == H5D_CHUNKED)
    H5Pget_chunk(how.get(), static_cast<int>(chunk.size()), chunk.data());
  const hsize_t whole = std::clamp<hsize_t>(chunk.at(static_cast<std::size_t>(time)), 1, count);
  return whole * std::max<hsize_t>(1, kMany / whole);
}

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

// Of records.
std::vector<std::string> numbers_in(hid_t type) {
  std::vector<std::string> out;
  const int count = H5Tget_nmembers(type);
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<unsigned>(i);
    const Hdf5Handle member(H5Tget_member_type(type, at), H5Tclose);
    char* const name = H5Tget_member_name(type, at);
    if (name != nullptr && member && is_number(member.get())) out.emplace_back(name);
    H5free_memory(name);
  }
  return out;
}

// One member of records, as memory has it.
Hdf5Handle record_of(const std::string& member, hid_t number) {
  Hdf5Handle out(H5Tcreate(H5T_COMPOUND, H5Tget_size(number)), H5Tclose);
  if (out) H5Tinsert(out.get(), member.c_str(), 0, number);
  return out;
}

}  // namespace

Hdf5Dataset::Form Hdf5Dataset::form(hid_t file, const std::string& name) {
  Form out;
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) return out;
  const Hdf5Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const Hdf5Handle space(H5Dget_space(dataset.get()), H5Sclose);
  if (!type || !space) return out;
  out.known = true;
  out.numbers = is_number(type.get());
  out.dimensions = H5Sget_simple_extent_ndims(space.get());
  if (H5Tget_class(type.get()) == H5T_COMPOUND && out.dimensions == 1)
    out.members = numbers_in(type.get());
  double number = 0.0;
  if (out.numbers && H5Sget_simple_extent_type(space.get()) == H5S_SCALAR &&
      H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &number) >= 0)
    out.single = number;
  return out;
}

Result<Hdf5Dataset> Hdf5Dataset::open(hid_t file, const std::string& name,
                                      const std::string& member) {
  Result<OpenDataset> opened = open_dataset(file, name, 2);
  if (!opened) return tl::make_unexpected(opened.error());
  if (!member.empty()) {
    const Hdf5Handle type(H5Dget_type(opened->id.get()), H5Tclose);
    const int at = type ? H5Tget_member_index(type.get(), member.c_str()) : -1;
    const Hdf5Handle number(at < 0 ? -1 : H5Tget_member_type(type.get(), static_cast<unsigned>(at)),
                            H5Tclose);
    if (!number) return fail(fmt::format("dataset {}: has no {}", name, member));
    opened->type_class = H5Tget_class(number.get());
    opened->has_sign = opened->type_class == H5T_INTEGER && H5Tget_sign(number.get()) == H5T_SGN_2;
    opened->width = H5Tget_size(number.get());
  }
  if (opened->type_class != H5T_INTEGER && opened->type_class != H5T_FLOAT) {
    return fail(
        fmt::format("dataset {}: holds no numbers (integers or floats); convert it, or choose "
                    "others with --channel",
                    name));
  }
  if (opened->size == 0 || opened->columns == 0)
    return fail(fmt::format("dataset {}: holds no samples", name));
  const bool counts = opened->type_class == H5T_INTEGER && opened->has_sign;
  const Kind kind = counts && opened->width == 2   ? Kind::kInt16
                    : counts && opened->width == 4 ? Kind::kInt32
                                                   : Kind::kOther;
  return Hdf5Dataset(name, member, std::move(opened->id),
                     {opened->size / opened->columns, opened->columns}, kind);
}

template <class Number>
Result<void> Hdf5Dataset::each_piece(
    hid_t memory_type, std::uint64_t column, bool across,
    const std::function<bool(std::vector<Number>& piece)>& take) const {
  const auto trouble = [&] {
    return fail(
        fmt::format("dataset {}: cannot be read: a chunk is damaged, or needs a filter that "
                    "is not installed; copy the file again or h5repack it",
                    name_));
  };
  const hsize_t count = across ? shape_.columns : shape_.rows;
  const Hdf5Handle space(H5Dget_space(id()), H5Sclose);
  if (!space) return trouble();
  const Hdf5Handle record = member_.empty() ? Hdf5Handle() : record_of(member_, memory_type);
  const hid_t memory = record ? record.get() : memory_type;
  const bool plane = H5Sget_simple_extent_ndims(space.get()) == 2;
  const hsize_t most = numbers_in_piece(id(), across && plane ? 1 : 0, count);
  std::vector<Number> piece;
  for (hsize_t first = 0; first < count; first += most) {
    const hsize_t size = std::min(most, count - first);
    const Hdf5Handle room(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const std::array<hsize_t, 2> begin = {across ? column : first, across ? first : column};
    const std::array<hsize_t, 2> extent = {across ? 1 : size, across ? size : 1};
    piece.resize(size);
    if (!room ||
        H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, begin.data(), nullptr, extent.data(),
                            nullptr) < 0 ||
        H5Dread(id(), memory, room.get(), space.get(), H5P_DEFAULT, piece.data()) < 0)
      return trouble();
    if (!take(piece)) return {};
  }
  return {};
}

Result<bool> Hdf5Dataset::misses(double fill, std::uint64_t column, bool across) const {
  bool out = false;
  const auto read = each_piece<std::int32_t>(
      H5T_NATIVE_INT32, column, across, [&](const std::vector<std::int32_t>& piece) {
        out = std::any_of(piece.begin(), piece.end(),
                          [&](std::int32_t value) { return static_cast<double>(value) == fill; });
        return !out;
      });
  if (!read) return tl::make_unexpected(read.error());
  return out;
}

Result<void> Hdf5Dataset::read(std::uint64_t column, bool across,
                               const std::function<bool(Samples piece)>& take) const {
  const Result<std::optional<double>> fill = read_number_attribute(id(), "_FillValue");
  if (!fill) return fail(fmt::format("dataset {}: {}", name_, fill.error().message));
  Kind kind = kind_;
  if (*fill && kind != Kind::kOther) {
    const Result<bool> missing = misses(**fill, column, across);
    if (!missing) return tl::make_unexpected(missing.error());
    if (*missing) kind = Kind::kOther;
  }
  const auto as_it_is = [&](auto& piece) { return take(Samples(std::move(piece))); };
  if (kind == Kind::kInt16)
    return each_piece<std::int16_t>(H5T_NATIVE_INT16, column, across, as_it_is);
  if (kind == Kind::kInt32)
    return each_piece<std::int32_t>(H5T_NATIVE_INT32, column, across, as_it_is);
  return each_piece<double>(H5T_NATIVE_DOUBLE, column, across, [&](std::vector<double>& piece) {
    for (double& value : piece) {
      if (*fill && value == **fill) value = std::numeric_limits<double>::quiet_NaN();
    }
    return as_it_is(piece);
  });
}

}  // namespace imunoise::recording
