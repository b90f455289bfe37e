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

template <class Number>
void expect_both_read(hid_t stored, hid_t memory, std::size_t size) {
  SCOPED_TRACE(size);
  const std::vector<Number> numbers = lively<Number>(size);
  NewMemoryFile file;
  {
    const Hdf5Handle ours = write_dataset(file.id(), "ours", stored, memory, numbers.data(), size);
    ASSERT_TRUE(ours);
    std::vector<Number> read(size);
    ASSERT_GE(H5Dread(ours.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, read.data()), 0);
    EXPECT_EQ(read, numbers);
    // The other way round: the same dataset, written anew through HDF5's filters.
    ASSERT_GE(H5Dwrite(ours.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()), 0);
  }
  const auto theirs = open_dataset(file.id(), "ours");
  ASSERT_TRUE(theirs) << theirs.error().message;
  std::vector<Number> read(size);
  EXPECT_TRUE(read_dataset(*theirs, memory, read.data()));
  EXPECT_EQ(read, numbers);
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
  const auto stored = filters.encode(bytes);
  ASSERT_TRUE(stored);
  std::vector<std::uint8_t> spoiled(stored->begin(), stored->end());
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
