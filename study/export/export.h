#pragma once

// From fits to the file of another program.

#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/array.pb.h"
#include "imunoise/v1/noise.pb.h"
#include "study/export/conservative.h"
#include "study/export/consumer.h"
#include "study/export/source.h"

namespace imunoise::study {

/// Where fits come from: what the file says of its origin.
struct ExportSource {
  std::string name;
  std::string sha256;  ///< of its bytes, hexadecimal; empty: unknown
};

struct ExportOptions {
  std::optional<AxisRule> axes;  ///< unset: the consumer's
  bool conservative = false;     ///< N and K bound the whole model's error over the horizon
  Horizon horizon{};
  std::optional<double> step;  ///< s, of the consumer's filter; unset: the consumer's
};

/// The axes of one IMU. Error: no gyro and no accelerometer, more than three channels of one
/// quantity, two of one axis, or a model that cannot be read.
Result<ImuNoise> imu_noise(const std::vector<SourceFit>& fits);

/// The file for a consumer. Error: a consumer without noise values, a rule for axes that it cannot
/// hold, a step that it has not. Thread-safe.
Result<std::string> export_noise(const ImuNoise& imu, const Consumer& to,
                                 const ExportSource& source, const ExportOptions& options);

/// What the file holds, without its syntax; the same errors.
Result<Sheet> export_sheet(const ImuNoise& imu, const Consumer& to, const ExportSource& source,
                           const ExportOptions& options);

/// The file of an array, for a consumer of matrices. Error: another consumer, a model that cannot
/// be read.
Result<std::string> export_array(const v1::ArrayReport& report, const Consumer& to,
                                 const ExportSource& source);

}  // namespace imunoise::study
