// HDF5 files of any contents that the library itself would write: types, ranks, attributes and
// layouts chosen by the fuzzer. (Damaged bytes would test the library instead, which has its own
// trouble with them.)

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "recording/hdf5/handle.h"
#include "recording/import/hdf5/hdf5_table.h"
#include "tests/fuzz/import/memory_file.h"

using namespace imunoise;
using namespace imunoise::recording;

namespace {

// Hands out the fuzzer's bytes; zeros when they are used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  std::uint8_t next() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  bool empty() const { return left_ == 0; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

Hdf5Handle any_type(Bytes& bytes) {
  const std::array types = {H5T_STD_I16LE,  H5T_STD_I16BE, H5T_STD_I32LE,  H5T_STD_I64LE,
                            H5T_STD_U16LE,  H5T_STD_I8LE,  H5T_IEEE_F32LE, H5T_IEEE_F64BE,
                            H5T_IEEE_F64LE, H5T_C_S1,      H5T_STD_B16LE,  H5T_STD_REF_OBJ};
  const std::uint8_t choice = bytes.next();
  Hdf5Handle type(H5Tcopy(types[choice % types.size()]), H5Tclose);
  const std::uint8_t shape = bytes.next();
  if (H5Tget_class(type.get()) == H5T_STRING) {
    H5Tset_size(type.get(), shape % 4U == 0 ? H5T_VARIABLE : 1U + shape);
    if ((shape & 64U) != 0) H5Tset_cset(type.get(), H5T_CSET_UTF8);
  } else if (H5Tget_class(type.get()) == H5T_INTEGER && shape < 16) {
    H5Tset_precision(type.get(), 1U + shape);
  }
  return type;
}

Hdf5Handle any_space(Bytes& bytes) {
  const std::uint8_t choice = bytes.next();
  if (choice % 8U == 0) return {H5Screate(H5S_SCALAR), H5Sclose};
  if (choice % 8U == 1) return {H5Screate(H5S_NULL), H5Sclose};
  const int rank = choice % 8U == 2 ? 2 : 1;
  const std::array<hsize_t, 2> shape = {
      choice % 8U == 3 ? hsize_t{1} << (choice >> 3U) : choice >> 3U, 2};
  return {H5Screate_simple(rank, shape.data(), nullptr), H5Sclose};
}

// Room for any small object of this space and type, filled from the fuzzer; empty when it is too
// big or holds pointers.
std::vector<std::uint8_t> any_values(Bytes& bytes, hid_t type, hid_t space) {
  const hssize_t points = H5Sget_simple_extent_npoints(space);
  const std::size_t width = H5Tget_size(type);
  if (points <= 0 || points > 4096 || H5Tis_variable_str(type) > 0) return {};
  std::vector<std::uint8_t> values(static_cast<std::size_t>(points) * width);
  for (std::size_t i = 0; i < values.size() && !bytes.empty(); ++i) values[i] = bytes.next();
  return values;
}

void add_attribute(Bytes& bytes, hid_t object) {
  const std::array names = {"rate_hz", "scale_factor", "add_offset", "units", "_FillValue"};
  const char* const name = names[bytes.next() % names.size()];
  const Hdf5Handle type = any_type(bytes);
  const Hdf5Handle space = any_space(bytes);
  const Hdf5Handle attribute(
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute) return;
  const std::vector<std::uint8_t> values = any_values(bytes, type.get(), space.get());
  if (!values.empty()) H5Awrite(attribute.get(), type.get(), values.data());
}

void add_dataset(Bytes& bytes, hid_t file) {
  const std::array names = {"x", "y", "time", "z"};
  const char* const name = names[bytes.next() % names.size()];
  const Hdf5Handle type = any_type(bytes);
  const Hdf5Handle space = any_space(bytes);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const std::uint8_t layout = bytes.next();
  const std::array<hsize_t, 2> chunk = {1U + layout / 4U, 1};
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (layout % 4U == 1 && rank > 0) H5Pset_chunk(properties.get(), rank, chunk.data());
  if (layout % 4U == 1 && (layout & 64U) != 0) H5Pset_deflate(properties.get(), 1);
  if (layout % 4U == 2) H5Pset_layout(properties.get(), H5D_COMPACT);
  if (layout % 4U == 3) H5Pset_external(properties.get(), "/dev/zero", 0, H5F_UNLIMITED);
  const Hdf5Handle dataset(
      H5Dcreate2(file, name, type.get(), space.get(), H5P_DEFAULT, properties.get(), H5P_DEFAULT),
      H5Dclose);
  if (!dataset) return;
  const std::vector<std::uint8_t> values = any_values(bytes, type.get(), space.get());
  if (!values.empty() && layout % 4U != 3) {
    H5Dwrite(dataset.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  }
  for (std::uint8_t left = bytes.next() % 4U; left > 0; --left) add_attribute(bytes, dataset.get());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const QuietHdf5 quiet;
  Bytes bytes(data, size);
  // HDF5 resolves links, which a file in memory does not survive: a file on disk, then.
  const std::filesystem::path place = std::filesystem::temp_directory_path() /
                                      ("imunoise-fuzz-" + std::to_string(::getpid()) + ".h5");
  {
    const Hdf5Handle file(H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                          H5Fclose);
    if (!file) std::abort();
    for (std::uint8_t left = bytes.next() % 3U; left > 0; --left) add_attribute(bytes, file.get());
    for (int left = 6; left > 0 && !bytes.empty(); --left) add_dataset(bytes, file.get());
  }
  ImportOptions options;
  if (size % 2U != 0) options.rate = Hertz{100.0};
  // In this process: the fuzzer sees no path that a child takes.
  const auto reader = Hdf5Source::open(place);
  if (!reader) std::abort();
  std::atomic<double> done = 0.0;
  const Progress whole;
  FileProgress progress(whole, done, 1);
  // What its numbers are worth is the preflight's to say.
  if (auto got = read_hdf5_table(place.string(), **reader, options, progress)) {
    for (const Column& column : got->columns) {
      if (imunoise::recording::size(column.samples) == 0) std::abort();
    }
  }
  std::filesystem::remove(place);
  return 0;
}
