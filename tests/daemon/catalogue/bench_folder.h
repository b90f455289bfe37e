#pragma once

// A bench's folder of recordings and calibrations, as files: no samples, for none are looked at.

#include <gtest/gtest.h>

#include <cmath>

#include "study/calibration/calibration_file.h"
#include "tests/recording/store/whole_manifest.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::testing {

inline constexpr std::int64_t kDay = 86'400'000'000'000;  // ns

/// One coefficient N of gyro_x, as a calibration knows it.
struct KnownN {
  double value = 2e-4;
  double lower = 1.98e-4;
  double upper = 2.02e-4;
};

class BenchFolder : public ::testing::Test {
 protected:
  /// A recording of device imu0 (driver simulated), made `day` days after the first.
  void add_recording(const std::string& folder, int day, const std::string& serial = "0042") {
    std::filesystem::create_directories(root_ / folder);
    v1::Manifest manifest;
    manifest.set_campaign("monthly");
    manifest.set_started_ns(kSimulatedStart + day * kDay);
    manifest.set_closed(true);
    v1::RecordedDevice& device = *manifest.add_devices();
    device.set_name("imu0");
    device.set_driver("simulated");
    device.set_serial(serial);
    v1::RecordedStream& stream = *device.add_streams();
    stream.set_name("imu");
    stream.set_rate_hz(100.0);
    v1::RecordedChannel& channel = *stream.add_channels();
    channel.set_name("gyro_x");
    channel.set_dtype("<i2");
    for (int replicate = 1; replicate <= 2; ++replicate) {
      v1::ChunkEntry& chunk = *manifest.add_chunks();
      chunk.set_file("replicate-" + std::to_string(replicate) + "/imu0/000001.h5");
      chunk.set_crc32c("0000000" + std::to_string(replicate));
      chunk.set_samples(5000);
      chunk.set_bytes(12'345);
    }
    write(folder, manifest);
  }
  void write(const std::string& folder, const v1::Manifest& manifest) {
    ASSERT_TRUE(recording::write_manifest(files_, root_ / folder, manifest));
  }
  v1::Manifest manifest(const std::string& folder) {
    return recording::read_manifest(files_, root_ / folder).value().value();
  }

  /// Its calibration: N of gyro_x, and K of which only a bound is known.
  void add_calibration(const std::string& folder, const KnownN& n,
                       const std::string& model = "WN + RW") {
    v1::Calibration calibration;
    calibration.set_version(1);
    const v1::Manifest of = manifest(folder);
    calibration.set_fingerprint(recording::fingerprint(of));
    calibration.set_started_ns(of.started_ns());
    calibration.set_made_ns(of.started_ns() + kDay);
    calibration.mutable_settings()->add_models(model);
    calibration.set_summary("1 of 1 channels have a model.");
    v1::ChannelCalibration& channel = *calibration.add_channels();
    channel.set_device("imu0");
    channel.set_stream("imu");
    channel.set_channel("imu0/imu/gyro_x");
    channel.mutable_fit()->set_model(model);
    add_term("WN", "N", "angle random walk", "rad/s/√Hz", n, channel);
    add_term("RW", "K", "rate random walk", "rad/s²/√Hz", {1e-7, 0.0, 3e-7}, channel);
    ASSERT_TRUE(study::write_calibration(files_, root_ / folder, calibration));
  }

  recording::FileSystem& files_ = recording::posix_file_system();
  TemporaryFolder folder_;
  const std::filesystem::path& root_ = folder_.path();

 private:
  static void add_term(const char* name, const char* symbol, const char* title, const char* unit,
                       const KnownN& known, v1::ChannelCalibration& to) {
    v1::Term& term = *to.mutable_fit()->add_terms();
    term.set_name(name);
    v1::Coefficient& one = *term.add_coefficients();
    one.set_symbol(symbol);
    one.set_title(title);
    one.set_value(known.value);
    one.set_lower(known.lower);
    one.set_upper(known.upper);
    one.set_unit(unit);
    one.set_datasheet_value(known.value * 3437.75);
    one.set_datasheet_unit("°/√h");
  }
};

}  // namespace imunoise::testing
