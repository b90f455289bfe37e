#pragma once

// HDF5's types for the numbers of a stream.

#include <hdf5.h>

#include <cstdint>
#include <type_traits>

namespace imunoise::recording {

/// HDF5's name of a C++ number type in memory, and of its little-endian form in the file.
struct Hdf5Types {
  hid_t memory;
  hid_t stored;
};

template <class Number>
Hdf5Types hdf5_types() {
  if constexpr (std::is_same_v<Number, std::int16_t>) return {H5T_NATIVE_INT16, H5T_STD_I16LE};
  if constexpr (std::is_same_v<Number, std::int32_t>) return {H5T_NATIVE_INT32, H5T_STD_I32LE};
  if constexpr (std::is_same_v<Number, std::int64_t>) return {H5T_NATIVE_INT64, H5T_STD_I64LE};
  if constexpr (std::is_same_v<Number, std::uint32_t>) return {H5T_NATIVE_UINT32, H5T_STD_U32LE};
  if constexpr (std::is_same_v<Number, float>) return {H5T_NATIVE_FLOAT, H5T_IEEE_F32LE};
  if constexpr (std::is_same_v<Number, double>) return {H5T_NATIVE_DOUBLE, H5T_IEEE_F64LE};
}

}  // namespace imunoise::recording
