#pragma once

// HDF5 files as h5py and xarray write them, and the same with damaged bytes.

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "recording/hdf5/attributes.h"
#include "tests/support/damage.h"

namespace imunoise::recording {

/// Which of HDF5's formats a file has: h5py writes the earliest, our chunks have the one of 1.10.
enum class Hdf5Bounds { kEarliest, kV110 };

/// A string of variable length, as h5py writes every str.
inline void write_text(hid_t object, const char* name, const char* text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  ASSERT_GE(H5Tset_size(type.get(), H5T_VARIABLE), 0);
  ASSERT_GE(H5Tset_cset(type.get(), H5T_CSET_UTF8), 0);
  const Hdf5Handle attribute(
      H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  ASSERT_GE(H5Awrite(attribute.get(), type.get(), &text), 0);
}

/// Two channels, chunked and deflated, and a column of times; the bytes of the file.
inline std::string hdf5_like_h5py(const std::filesystem::path& place, Hdf5Bounds bounds) {
  constexpr hsize_t kSamples = 120;
  {
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    if (bounds == Hdf5Bounds::kV110)
      H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110);
    const Hdf5Handle file(H5Fcreate(place.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()),
                          H5Fclose);
    write_text(file.get(), "Conventions", "CF-1.8");
    const Hdf5Handle space(H5Screate_simple(1, &kSamples, nullptr), H5Sclose);
    std::array<double, kSamples> numbers = {};
    for (std::size_t i = 0; i < kSamples; ++i) numbers[i] = 0.01 * static_cast<double>(i);
    for (const auto& [name, unit, chunk] :
         {std::tuple("gyro_x", "deg/s", 50), std::tuple("acc_x", "m/s^2", 120),
          std::tuple("time", "s", 0)}) {
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      const auto size = static_cast<hsize_t>(chunk);
      if (chunk > 0) {
        H5Pset_chunk(properties.get(), 1, &size);
        H5Pset_shuffle(properties.get());
        H5Pset_deflate(properties.get(), 4);
      }
      const Hdf5Handle dataset(H5Dcreate2(file.get(), name, H5T_IEEE_F64LE, space.get(),
                                          H5P_DEFAULT, properties.get(), H5P_DEFAULT),
                               H5Dclose);
      H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
      write_text(dataset.get(), "units", unit);
      write_text(dataset.get(), "long_name", "an angular rate or an acceleration");
      EXPECT_TRUE(write_attribute(dataset.get(), "scale_factor", 0.5));
    }
  }
  std::ifstream in(place, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes with a few of them damaged. `seed` decides which; the same on every machine.
inline std::string mutant(std::string bytes, std::uint32_t seed) {
  std::mt19937 random(seed);
  // Half of the mutants are damaged where strings of variable length lie.
  const std::size_t heap = bytes.find("GCOL");
  const bool in_heap = random() % 2 == 0 && heap != std::string::npos;
  const std::size_t begin = in_heap ? heap : 0;
  const std::size_t length =
      in_heap ? std::min<std::size_t>(256, bytes.size() - heap) : bytes.size();
  for (std::uint32_t left = 1 + random() % 4; left > 0; --left) {
    const std::size_t at = begin + random() % length;
    damage(bytes, at, random, [&] {
      for (std::size_t i = at; i < std::min(at + 4, bytes.size()); ++i) bytes[i] = '\xff';
    });
  }
  return bytes;
}

}  // namespace imunoise::recording
