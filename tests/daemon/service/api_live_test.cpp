// Replicates while they are recorded: latest samples, figures, how much longer.

#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using testing::RawResponse;

class ApiLive : public testing::Served {
 protected:
  // White noise of N = 1e-3 rad/s/√Hz at 100 Hz, an hour of it, exactly as expected.
  void show_white_noise() {
    constexpr double kRate = 100.0;
    constexpr double kSamples = 360'000.0;
    v1::LiveReplicate live;
    live.set_campaign("array");
    v1::LiveDevice& device = *live.add_devices();
    device.set_device("imu0");
    v1::LiveStream& stream = *device.add_streams();
    stream.set_stream("imu");
    stream.set_nominal_hz(kRate);
    stream.set_samples(static_cast<std::uint64_t>(kSamples));
    v1::LiveChannel& channel = *device.add_channels();
    channel.set_stream("imu");
    channel.set_channel("gyro_x");
    channel.set_units("rad/s");
    for (double two_m = 2.0; two_m < kSamples / 2.0; two_m *= 2.0) {
      v1::LiveScale& scale = *channel.add_scales();
      scale.set_tau_s(two_m / kRate);
      scale.set_deviation(std::sqrt(1e-6 * kRate / two_m / 2.0 * 2.0));
      scale.set_degrees_of_freedom(kSamples / two_m);
      scale.set_lower(0.9 * scale.deviation());
      scale.set_upper(1.1 * scale.deviation());
    }
    control_.show({live});
  }
  static inline const std::string kChannel = "campaign=array&device=imu0&stream=imu&channel=gyro_x";
};

TEST_F(ApiLive, TellsHowMuchLongerForEachParameter) {
  serve();
  show_white_noise();
  const json known = get_json("/v1/live/parameters?" + kChannel);
  EXPECT_EQ(known["model"], "WN + FN + RW");
  EXPECT_EQ(known["trouble"], "");
  ASSERT_EQ(known["parameters"].size(), 3U) << known.dump(1);
  const json& n = known["parameters"][0];
  EXPECT_EQ(n["coefficient"]["symbol"], "N");
  EXPECT_NEAR(n["coefficient"]["value"].get<double>(), 1e-3, 2e-5);
  EXPECT_EQ(n["observability"], "observed");
  EXPECT_LT(n["precision"].get<double>(), 0.05);
  EXPECT_EQ(n["enough_in_s"], 0.0);
  EXPECT_NE(n["sentence"].get<std::string>().find("long enough"), std::string::npos);
  const json& k = known["parameters"][2];
  EXPECT_EQ(k["observability"], "upper_bound_only") << k;
  EXPECT_NE(k["sentence"].get<std::string>().find("not seen yet; "), std::string::npos);
}

TEST_F(ApiLive, TheTimeLeftFallsWithTheSquareOfThePrecision) {
  serve();
  show_white_noise();
  const std::string wanted = "/v1/live/parameters?" + kChannel + "&model=WN&precision=";
  const double one = get_json(wanted + "0.001")["parameters"][0]["enough_in_s"];
  const double two = get_json(wanted + "0.002")["parameters"][0]["enough_in_s"];
  EXPECT_NEAR((one + 3600.0) / (two + 3600.0), 4.0, 1e-6);
  EXPECT_GT(two, 0.0);
  refusal(wanted + "2", 400);
  refusal(wanted + "-1", 400);
  refusal("/v1/live/parameters?" + kChannel + "&model=nonsense", 400);
  EXPECT_NE(refusal("/v1/live/parameters?campaign=array&device=other", 404).find("GET /v1/live"),
            std::string::npos);
}

TEST_F(ApiLive, TheAllanDeviationSoFarIsDrawn) {
  serve();
  show_white_noise();
  const RawResponse drawn = testing::get(local_, "/v1/live/figure?" + kChannel + "&width=640");
  EXPECT_EQ(drawn.status, 200) << drawn.body;
  EXPECT_NE(drawn.body.find("Allan deviation, °/h"), std::string::npos);
  EXPECT_EQ(drawn.body.find("style="), std::string::npos) << "the page's policy forbids it";
  refusal("/v1/live/figure?campaign=array&device=imu0&stream=imu&channel=other", 404);
  refusal("/v1/live/figure?" + kChannel + "&width=100", 400);
}

TEST_F(ApiLive, LatestSamplesAreThoseOfAcquisition) {
  serve();
  v1::SampleRanges samples;
  samples.set_next(7);
  samples.add_time_s(0.25);
  v1::RangeChannel& channel = *samples.add_channels();
  channel.set_channel("gyro_x");
  channel.add_lower(-0.1F);
  channel.add_upper(0.1F);
  control_.show("imu0", samples);
  const json got = get_json("/v1/live/samples?campaign=array&device=imu0&samples_each=4&from=6");
  EXPECT_EQ(got["next"], "7");
  EXPECT_EQ(got["time_s"], json({0.25}));
  EXPECT_EQ(got["channels"][0]["lower"], json({-0.1})) << "as short as a float is";
  EXPECT_EQ(refusal("/v1/live/samples?campaign=array&device=imu1", 404), "no such device");
}

}  // namespace
}  // namespace imunoise
