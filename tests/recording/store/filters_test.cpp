// Our filters against HDF5's own: each reads what the other wrote.

#include "recording/hdf5/filters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "recording/hdf5/dataset.h"
#include "recording/hdf5/memory_file.h"

namespace imunoise::recording {
namespace {

template <class Number>
std::vector<Number> lively(std::size_t size) {
  std::mt19937_64 engine(size);
  std::vector<Number> out(size);
  for (std::size_t i = 0; i < size; ++i) {
    out[i] =
        static_cast<Number>(static_cast<Number>(i / 3) * 1000 + static_cast<Number>(engine() % 97));
  }
  return out;
}

// Both read what both wrote: in the file that is written, and in the file that is opened again.
template <class Number>
void expect_both_read(hid_t stored, hid_t memory, std::size_t size) {
  SCOPED_TRACE(size);
  const std::vector<Number> numbers = lively<Number>(size);
  const auto expect_read = [&](hid_t file, const char* name) {
    SCOPED_TRACE(name);
    const auto dataset = open_dataset(file, name);
    ASSERT_TRUE(dataset) << dataset.error().message;
    std::vector<Number> by_hdf5(size);
    ASSERT_GE(H5Dread(dataset->id.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, by_hdf5.data()), 0);
    EXPECT_TRUE(by_hdf5 == numbers);
    std::vector<Number> by_us(size);
    EXPECT_TRUE(read_dataset(*dataset, memory, by_us.data()));
    EXPECT_TRUE(by_us == numbers);
  };
  NewMemoryFile file;
  ASSERT_TRUE(write_dataset(file.id(), "ours", stored, memory, numbers.data(), size));
  {
    const Hdf5Handle theirs =
        write_dataset(file.id(), "theirs", stored, memory, numbers.data(), size);
    ASSERT_GE(H5Dwrite(theirs.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  }
  expect_read(file.id(), "ours");
  expect_read(file.id(), "theirs");
  const auto image = file.finish();
  ASSERT_TRUE(image);
  const Hdf5Handle again = open_memory_file(*image);
  ASSERT_TRUE(again);
  expect_read(again.get(), "ours");
  expect_read(again.get(), "theirs");
}

TEST(ChunkFilters, Hdf5ReadsWhatTheyWriteAndTheyWhatHdf5Writes) {
  for (const std::size_t size : {1U, 7U, 4095U, 4097U, 65'536U, 65'537U, 200'001U}) {
    expect_both_read<std::int16_t>(H5T_STD_I16LE, H5T_NATIVE_INT16, size);
    expect_both_read<std::int32_t>(H5T_STD_I32LE, H5T_NATIVE_INT32, size);
    expect_both_read<std::int64_t>(H5T_STD_I64LE, H5T_NATIVE_INT64, size);
    expect_both_read<float>(H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, size);
    expect_both_read<double>(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, size);
  }
}

TEST(ChunkFilters, SeeEveryFlippedBit) {
  const std::vector<std::int16_t> numbers = lively<std::int16_t>(300);
  const std::span<const std::uint8_t> bytes(
      static_cast<const std::uint8_t*>(static_cast<const void*>(numbers.data())),
      numbers.size() * sizeof(std::int16_t));
  ChunkFilters filters(400, sizeof(std::int16_t));
  std::vector<std::uint8_t> spoiled = filters.encode(bytes);
  ASSERT_FALSE(spoiled.empty());
  std::vector<std::uint8_t> out(bytes.size());
  ASSERT_TRUE(filters.decode(spoiled, out));
  EXPECT_TRUE(std::equal(out.begin(), out.end(), bytes.begin()));
  for (std::size_t bit = 0; bit < 8 * spoiled.size(); ++bit) {
    spoiled[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    EXPECT_FALSE(filters.decode(spoiled, out)) << bit;
    spoiled[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
  for (std::size_t size = 0; size < spoiled.size(); ++size) {
    EXPECT_FALSE(filters.decode(std::span(spoiled).first(size), out)) << size;
  }
}

}  // namespace
}  // namespace imunoise::recording
