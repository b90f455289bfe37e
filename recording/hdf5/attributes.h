#pragma once

// Attributes of HDF5 files, groups and datasets: one number or one string each.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/hdf5/handle.h"

namespace imunoise::recording {

/// The number in attribute `name` of `object` (any integer or float, one element); nothing when
/// there is no such attribute. Error, without file and object: another type or shape.
Result<std::optional<double>> read_number_attribute(hid_t object, const char* name);

/// The whole number, not negative, in attribute `name`, exact up to 64 bits; nothing when there is
/// none. Error, without file and object: another type or shape, a negative number.
Result<std::optional<std::uint64_t>> read_count_attribute(hid_t object, const char* name);

/// The string in attribute `name` (fixed or variable length, one element); nothing when there is
/// none. Error, without file and object: another type or shape, more than 4096 bytes.
Result<std::optional<std::string>> read_string_attribute(hid_t object, const char* name);

/// Names of all attributes of `object`, sorted. Nothing when HDF5 cannot list them.
std::vector<std::string> attribute_names(hid_t object);

/// Writes a scalar attribute. False when HDF5 refuses.
[[nodiscard]] bool write_attribute(hid_t object, const std::string& name, double value);
[[nodiscard]] bool write_attribute(hid_t object, const std::string& name, std::uint64_t value);
[[nodiscard]] bool write_attribute(hid_t object, const std::string& name, std::string_view value);

}  // namespace imunoise::recording
