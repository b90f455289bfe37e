// Calibrations of small recordings, made by the recorder itself.

#include <gtest/gtest.h>

#include <cmath>
#include <mutex>

#include "recording/store/manifest/manifest.h"
#include "study/calibration/calibrate.h"
#include "study/calibration/calibration_file.h"
#include "study/report/json.h"
#include "study/report/view/verdict.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::study {
namespace {

using testing::SimulatedRecording;

constexpr double kSigma2 = 4e-6;  // of gyro_x, (rad/s)²

// gyro_x is white, gyro_y walks, gyro_z never changes, temperature stands beside them.
SimulatedRecording three_gyros(const std::filesystem::path& folder) {
  SimulatedRecording out;
  out.folder = folder;
  out.samples = 4096;
  out.replicates = 3;
  out.channels = {{"gyro_x", "rad/s", "WN(sigma2=4e-6)"},
                  {"gyro_y", "rad/s", "WN(sigma2=4e-6) + RW(gamma2=4e-8)"},
                  {"gyro_z", "rad/s", ""},
                  {"temperature", "K", "WN(sigma2=1e-4)"}};
  return out;
}

class Calibrated : public ::testing::Test {
 protected:
  Calibrated() { testing::record(three_gyros(folder_.path())); }

  v1::Calibration calibrated(const CalibrateOptions& options) const {
    auto out = calibrate(files_, folder_.path(), options);
    EXPECT_TRUE(out) << out.error().message;
    return out.value_or(v1::Calibration());
  }
  std::string error_of(const CalibrateOptions& options) const {
    const auto out = calibrate(files_, folder_.path(), options);
    return out ? "no error" : out.error().message;
  }

  recording::FileSystem& files_ = recording::posix_file_system();
  testing::TemporaryFolder folder_;
};

double coefficient(const v1::FitReport& fit, const std::string& symbol) {
  for (const v1::Term& term : fit.terms()) {
    for (const v1::Coefficient& one : term.coefficients()) {
      if (one.symbol() == symbol && one.lower() <= one.value() && one.value() <= one.upper())
        return one.value();
    }
  }
  return 0.0;
}

TEST_F(Calibrated, EveryChannelHasItsNoiseAndWhatWentWrong) {
  CalibrateOptions options;
  options.models = {"WN + RW"};
  options.made_ns = 77;
  const v1::Calibration got = calibrated(options);
  EXPECT_EQ(got.version(), kCalibrationVersion);
  EXPECT_EQ(got.started_ns(), testing::kSimulatedStart);
  EXPECT_EQ(got.made_ns(), 77);
  ASSERT_EQ(got.settings().models_size(), 1);
  EXPECT_EQ(got.settings().models(0), "WN + RW");
  ASSERT_EQ(got.channels_size(), 3) << "no noise model of a temperature unless it is asked for";

  const v1::ChannelCalibration& x = got.channels(0);
  EXPECT_EQ(x.device(), "imu0");
  EXPECT_EQ(x.stream(), "imu");
  EXPECT_EQ(x.channel(), "gyro_x");
  EXPECT_TRUE(x.troubles().empty());
  EXPECT_FALSE(x.has_choice());
  EXPECT_EQ(x.wavelet().replicates_size(), 3);
  EXPECT_NEAR(x.wavelet().variance(0), kSigma2 / 2, 0.1 * kSigma2 / 2);
  // N = σ/√rate; 12,288 samples know it to 0.7 %.
  EXPECT_NEAR(coefficient(x.fit(), "N"), std::sqrt(kSigma2 / 100.0), 0.03 * 2e-4);
  EXPECT_EQ(x.stationarity().replicates(), 3U);
  EXPECT_EQ(x.diagnosis().verdict(), v1::none) << x.diagnosis().summary();
  EXPECT_EQ(x.diagnosis().witnesses_size(), 2) << "gyro_y and temperature";

  // K = γ·√rate.
  EXPECT_NEAR(coefficient(got.channels(1).fit(), "K"), 2e-4 * 10.0, 0.15 * 2e-3);

  const v1::ChannelCalibration& z = got.channels(2);
  ASSERT_FALSE(z.troubles().empty());
  EXPECT_EQ(z.troubles(0).step(), "fit");
  EXPECT_NE(z.troubles(0).message().find("never changes"), std::string::npos);
  EXPECT_EQ(z.troubles_size(), 1) << "one cause is told once";
  EXPECT_FALSE(z.has_fit());
  EXPECT_TRUE(z.has_wavelet());
  EXPECT_NE(got.summary().find("2 of 3 channels have a model"), std::string::npos) << got.summary();
}

TEST_F(Calibrated, AModelIsChosenWhereNoneIsNamed) {
  CalibrateOptions options;
  options.channels = {"gyro_y"};
  options.diagnose = false;
  const v1::Calibration got = calibrated(options);
  ASSERT_EQ(got.channels_size(), 1);
  const v1::ChannelCalibration& y = got.channels(0);
  EXPECT_GT(y.choice().candidates_size(), 2);
  EXPECT_EQ(y.fit().model(), "WN + RW") << "the simplest that is not worse";
  EXPECT_FALSE(y.fit().default_model());
  EXPECT_FALSE(y.has_diagnosis());
}

TEST_F(Calibrated, ChannelsOfOneQuantityAreAnArrayWhenThatIsAsked) {
  CalibrateOptions options;
  options.models = {"WN + RW"};
  options.diagnose = false;
  options.array = true;
  options.channels = {"gyro_x", "gyro_y"};
  const v1::Calibration got = calibrated(options);
  ASSERT_EQ(got.arrays_size(), 1);
  EXPECT_EQ(got.arrays(0).channels_size(), 2);
  EXPECT_TRUE(got.arrays(0).troubles().empty());
  ASSERT_EQ(got.arrays(0).report().pairs_size(), 1);
  EXPECT_FALSE(got.arrays(0).report().pairs(0).dependent());

  options.channels = {"gyro_x", "gyro_z"};
  const v1::Calibration stuck = calibrated(options);
  ASSERT_EQ(stuck.arrays_size(), 1);
  EXPECT_EQ(stuck.arrays(0).troubles(0).step(), "array");
}

TEST_F(Calibrated, AChunkThatIsDamagedIsTold) {
  CalibrateOptions options;
  options.models = {"WN"};
  options.diagnose = false;
  const auto chunk = folder_.path() / "replicate-2" / "imu0" / "000001.h5";
  ASSERT_TRUE(recording::replace_file(files_, chunk, "no chunk"));
  const v1::Calibration got = calibrated(options);
  ASSERT_EQ(got.channels_size(), 3);
  for (const v1::ChannelCalibration& one : got.channels()) {
    ASSERT_EQ(one.troubles_size(), 1);
    EXPECT_EQ(one.troubles(0).step(), "read");
    EXPECT_NE(one.troubles(0).message().find("000001.h5"), std::string::npos);
  }
}

TEST_F(Calibrated, SaysWhatItCannotDo) {
  const auto expect = [&](const CalibrateOptions& options, const std::string& words) {
    EXPECT_NE(error_of(options).find(words), std::string::npos) << error_of(options);
  };
  CalibrateOptions unreadable;
  unreadable.models = {"WN + RX"};
  expect(unreadable, "RX");
  CalibrateOptions absent;
  absent.channels = {"gyro_x", "gyro_w"};
  expect(absent, "no channel 'gyro_w' (it has: gyro_x, gyro_y, gyro_z, temperature)");
  const auto nowhere = calibrate(files_, folder_.path() / "replicate-1", {});
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("is not a recording"), std::string::npos);
}

TEST_F(Calibrated, ProgressGoesToTheEndAndAStopIsHeeded) {
  CalibrateOptions options;
  options.models = {"WN + RW"};
  std::mutex told;
  double last = 0.0;
  std::stop_source source;
  const Progress progress([&](double fraction) {
    const std::scoped_lock lock(told);
    EXPECT_LE(fraction, 1.0);
    last = std::max(last, fraction);
  });
  ASSERT_TRUE(calibrate(files_, folder_.path(), options, progress));
  EXPECT_NEAR(last, 1.0, 1e-9);
  const Progress stops(
      [&](double fraction) {
        if (fraction > 0.3) source.request_stop();
      },
      source.get_token());
  const auto stopped = calibrate(files_, folder_.path(), options, stops);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped");
}

// A model that does not fit is no end: which one would is told.
TEST_F(Calibrated, WhatAModelLacksIsTold) {
  CalibrateOptions options;
  options.models = {"WN"};
  const v1::Calibration got = calibrated(options);
  int failing = 0;
  for (const v1::ChannelCalibration& one : got.channels()) {
    if (!one.has_fit()) continue;
    const bool fails = report::verdict(one.fit()) == report::Verdict::kFails;
    EXPECT_EQ(!one.missing().empty(), fails) << one.channel();
    if (!fails) continue;
    ++failing;
    EXPECT_NE(got.summary().find(one.channel() + ": "), std::string::npos) << got.summary();
  }
  EXPECT_GT(failing, 0) << got.summary();
  EXPECT_NE(got.summary().find("does not fit ("), std::string::npos) << got.summary();
}

TEST_F(Calibrated, TheFileIsReadAsItWasWritten) {
  const auto none = read_calibration(files_, folder_.path());
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
  CalibrateOptions options;
  options.models = {"WN + RW"};
  const v1::Calibration made = calibrated(options);
  ASSERT_TRUE(write_calibration(files_, folder_.path(), made));
  const auto back = read_calibration(files_, folder_.path());
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(report::to_json(**back), report::to_json(made));
  const auto manifest = recording::read_manifest(files_, folder_.path());
  EXPECT_EQ((*back)->fingerprint(), recording::fingerprint(**manifest));

  const auto refused = [&](const std::string& text, const std::string& words) {
    ASSERT_TRUE(recording::replace_file(files_, folder_.path() / kCalibrationName, text));
    const auto read = read_calibration(files_, folder_.path());
    ASSERT_FALSE(read) << text;
    EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().message.find("imunoise calibrate"), std::string::npos);
  };
  refused("{", "not a calibration");
  refused("{\"version\": 1, \"colour\": 2}", "colour");
  refused("{\"version\": 9}", "version 9");
}

TEST(Fingerprint, ChangesWithEveryChunk) {
  v1::Manifest manifest;
  const std::string empty = recording::fingerprint(manifest);
  v1::ChunkEntry& chunk = *manifest.add_chunks();
  chunk.set_file("replicate-1/imu0/000001.h5");
  chunk.set_crc32c("00000001");
  const std::string one = recording::fingerprint(manifest);
  EXPECT_NE(one, empty);
  chunk.set_crc32c("00000002");
  EXPECT_NE(recording::fingerprint(manifest), one);
}

}  // namespace
}  // namespace imunoise::study
