#include <google/protobuf/util/json_util.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <cmath>

#include "study/report/json.h"
#include "tests/study/sample_report.h"

namespace imunoise::report {
namespace {

TEST(Json, ProtobufReadsBackTheSameMessage) {
  for (const v1::FitReport& report :
       {good_gyro(), bounded_gyro(), dense_unknown_unit(), v1::FitReport{}}) {
    v1::FitReport back;
    const auto status = google::protobuf::util::JsonStringToMessage(to_json(report), &back);
    ASSERT_TRUE(status.ok()) << status.ToString();
    EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(report, back));
  }
}

TEST(Json, KeepsProtoNamesZerosAndEnumWords) {
  const std::string json = to_json(bounded_gyro());
  EXPECT_TRUE(contains(json, "\"rate_hz\": 100,"));
  EXPECT_TRUE(contains(json, "\"default_model\": false,"));
  EXPECT_TRUE(contains(json, "\"observability\": \"upper_bound_only\""));
  EXPECT_TRUE(contains(json, "\"samples\": 1000000,"));
  EXPECT_TRUE(contains(to_json(v1::FitReport{}), "\"notes\": []"));
}

TEST(Json, LeavesOutWhatIsNotANumber) {
  v1::FitReport report;
  report.set_p_value(std::nan(""));
  report.add_terms()->add_parameters()->set_upper(-INFINITY);
  report.set_channel("NaN");
  const std::string json = to_json(report);
  EXPECT_FALSE(contains(json, "p_value"));
  EXPECT_FALSE(contains(json, "upper"));
  EXPECT_TRUE(contains(json, "\"channel\": \"NaN\""));
  EXPECT_TRUE(contains(json, "\"j_statistic\": 0"));
}

TEST(Json, SeedIsAStringBecauseReadersKeepOnly53Bits) {
  v1::SimulationReport report;
  report.set_seed(18446744073709551615ULL);
  report.set_samples(7);
  const std::string json = to_json(report);
  EXPECT_TRUE(contains(json, "\"seed\": \"18446744073709551615\""));
  EXPECT_TRUE(contains(json, "\"samples\": 7"));
}

TEST(Json, EscapesQuotesAndRepairsBytes) {
  v1::FitReport report;
  report.set_channel("a\"b\\c\n\x01\xff°");
  EXPECT_TRUE(contains(to_json(report), "\"a\\\"b\\\\c \uFFFD\uFFFD°\""));
}

#ifndef NDEBUG
TEST(JsonDeathTest, AListMustBeFinite) {
  v1::FitReport report;
  report.mutable_budget()->add_model(std::nan(""));
  EXPECT_DEATH(to_json(report), "finite");
}
#endif

}  // namespace
}  // namespace imunoise::report
