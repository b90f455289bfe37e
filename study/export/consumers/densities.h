#pragma once

#include "study/export/consumer.h"

namespace imunoise::study {

/// The keys under which a consumer takes N and K in SI.
struct DensityKeys {
  std::string_view gyro_n;
  std::string_view gyro_k;
  std::string_view accelerometer_n;
  std::string_view accelerometer_k;
};

/// N and K of both sensors as they are.
std::vector<Field> densities(const ImuNoise& imu, const DensityKeys& keys);

}  // namespace imunoise::study
