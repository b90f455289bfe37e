#pragma once

// The twelve quantities of a measurement by name and number.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "drivers/emulator/measurement/sample_source.h"

namespace imunoise::emulator {

/// Index in kQuantities.
using QuantityIndex = std::size_t;

inline constexpr std::array<std::string_view, 12> kQuantities = {
    "gyro_x", "gyro_y", "gyro_z", "acc_x",       "acc_y",  "acc_z",
    "mag_x",  "mag_y",  "mag_z",  "temperature", "supply", "auxiliary"};
inline constexpr QuantityIndex kTemperature = 9;
inline constexpr QuantityIndex kSupply = 10;

double& at(Measurement& measurement, QuantityIndex quantity);
double at(const Measurement& measurement, QuantityIndex quantity);

/// Nothing for other names.
std::optional<QuantityIndex> find_quantity(std::string_view name);
/// The quantities that a name stands for: "gyro_x", or all three axes of "gyro". Error: no such
/// name, with those there are.
Result<std::vector<QuantityIndex>> quantities_of(std::string_view name);

}  // namespace imunoise::emulator
