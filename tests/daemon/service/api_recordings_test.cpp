// What recordings show beside their numbers: samples, fleets, arrays.

#include "study/calibration/calibration_file.h"
#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using testing::RawResponse;

class ApiRecordings : public testing::Served {
 protected:
  // A calibration of "array/monday" with an array of two sensors.
  void add_array() const {
    v1::Calibration calibration;
    calibration.set_version(1);
    v1::ArrayReport& report = *calibration.add_arrays()->mutable_report();
    report.add_sensors("gyro_x");
    report.add_sensors("gyro_y");
    for (int k = 0; k < 2; ++k) {
      v1::VirtualSensor& one = k == 0 ? *report.mutable_virtual_sensor() : *report.add_trade_offs();
      for (const char* const name : {"gyro_x", "gyro_y"}) {
        v1::SensorWeight& weight = *one.add_weights();
        weight.set_sensor(name);
        weight.set_weight(0.5);
        weight.set_standard_error(0.1);
      }
      for (const double tau : {0.02, 0.04, 0.08}) {
        v1::ScaleGain& gain = *one.add_scale_gains();
        gain.set_tau_s(tau);
        gain.set_predicted(k == 0 ? 0.8 : 0.4);
      }
    }
    ASSERT_TRUE(study::write_calibration(recording::posix_file_system(),
                                         folder_.path() / "data/array/monday", calibration));
  }
};

TEST_F(ApiRecordings, SamplesAreRangesOfAllOfThem) {
  serve();
  record("monday");
  const std::string all = "/v1/samples?campaign=array&folder=monday&device=imu0";
  const json whole = get_json(all + "&ranges=10");
  EXPECT_EQ(whole["replicate"], 1);
  EXPECT_EQ(whole["channels"][0]["channel"], "gyro_x");
  EXPECT_LE(whole["time_s"].size(), 10U);
  EXPECT_GE(whole["time_s"].size(), 5U);
  EXPECT_GE(whole["time_s"].size() * whole["samples_each"].get<std::size_t>(), 2048U);
  const double length = whole["length_s"];
  EXPECT_NEAR(length, 2047.0 / 100.0, 0.01);
  // Nothing that stands out is lost: the extremes of few ranges are those of all samples.
  const json each = get_json(all + "&ranges=4000&channel=gyro_x");
  ASSERT_EQ(each["time_s"].size(), 2048U);
  EXPECT_EQ(each["samples_each"], 1);
  const auto greatest = [](const json& of) {
    double out = -1e9;
    for (const json& one : of["channels"][0]["upper"]) out = std::max(out, one.get<double>());
    return out;
  };
  EXPECT_DOUBLE_EQ(greatest(whole), greatest(each));
  const json part = get_json(all + "&from_s=5&until_s=6&ranges=4000");
  EXPECT_LE(part["time_s"][0], 5.0);
  EXPECT_GE(part["time_s"].back(), 5.99);
  EXPECT_LT(part["time_s"].size(), 300U);
}

TEST_F(ApiRecordings, SamplesThatAreNotThereAreRefused) {
  serve();
  record("monday");
  const std::string all = "/v1/samples?campaign=array&folder=monday&device=imu0";
  refusal("/v1/samples?campaign=array&folder=sunday&device=imu0", 404);
  refusal("/v1/samples?campaign=array&folder=..&device=imu0", 400);
  refusal("/v1/samples?campaign=array&folder=monday&device=imu9", 404);
  refusal(all + "&stream=other", 404);
  refusal(all + "&channel=other", 404);
  refusal(all + "&replicate=9", 404);
  refusal(all + "&ranges=4001", 400);
  refusal(all + "&from_s=2&until_s=1", 400);
  refusal(all + "&from_s=nan", 400);
}

TEST_F(ApiRecordings, LargeRecordingsAreNotShown) {
  options_.largest_study = 1000;
  serve();
  record("monday");
  EXPECT_NE(
      refusal("/v1/samples?campaign=array&folder=monday&device=imu0", 409).find("imunoise wv"),
      std::string::npos);
}

TEST_F(ApiRecordings, FiguresOfAnArrayFollowItsEmphasis) {
  serve();
  record("monday");
  add_array();
  const std::string figure = "/v1/array/figure?campaign=array&folder=monday&view=";
  const RawResponse gain = testing::get(local_, figure + "gain");
  EXPECT_EQ(gain.status, 200) << gain.body;
  EXPECT_NE(gain.body, testing::get(local_, figure + "gain&emphasis=0").body);
  EXPECT_EQ(testing::get(local_, figure + "weights").status, 200);
  refusal(figure + "correlations", 404);
  refusal(figure + "gain&emphasis=1", 404);
  refusal(figure + "gain&array=1", 404);
  refusal(figure + "nothing", 400);
  refusal("/v1/array/figure?campaign=array&folder=sunday&view=gain", 404);
}

TEST_F(ApiRecordings, NoiseValuesAreExportedForEveryProgram) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const json consumers = get_json("/v1/consumers")["consumers"];
  ASSERT_GE(consumers.size(), 10U);
  for (const json& one : consumers) {
    const std::string name = one["name"];
    const RawResponse got = testing::get(local_, "/v1/studies/gyro/export?consumer=" + name);
    EXPECT_EQ(got.status, 200) << name << ": " << got.body;
    EXPECT_NE(got.body.find("gyro.study"), std::string::npos) << name;
  }
  EXPECT_NE(refusal("/v1/studies/gyro/export?consumer=none", 404).find("kalibr"),
            std::string::npos);
  refusal("/v1/studies/other/export?consumer=kalibr", 404);
  const std::string calibration = "/v1/export?campaign=array&folder=monday&consumer=kalibr";
  EXPECT_NE(refusal(calibration, 404).find("imunoise calibrate"), std::string::npos);
  add_array();
  refusal(calibration, 404);  // a calibration without a fit
}

TEST_F(ApiRecordings, AStudyHasAReport) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const RawResponse report = testing::get(local_, "/v1/studies/gyro/report");
  EXPECT_EQ(report.status, 200);
  EXPECT_NE(report.body.find("<svg"), std::string::npos);
  EXPECT_NE(report.body.find("gyro_x"), std::string::npos);
  refusal("/v1/studies/other/report", 404);
}

TEST_F(ApiRecordings, AFleetNeedsCalibrations) {
  serve();
  record("monday");
  EXPECT_NE(refusal("/v1/fleet", 404).find("imunoise calibrate"), std::string::npos);
  refusal("/v1/fleet/figure?channel=gyro_x", 404);
}

}  // namespace
}  // namespace imunoise
