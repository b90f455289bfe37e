// What becomes of a complete recording, with scripts in the place of `imunoise calibrate`.

#include "daemon/app/aftercare.h"

#include <chrono>
#include <fstream>
#include <thread>

#include "tests/daemon/catalogue/bench_folder.h"

namespace imunoise::app {
namespace {

namespace fs = std::filesystem;

class Cared : public testing::BenchFolder {
 protected:
  Cared() {
    campaign_.set_name("monthly");
    campaign_.set_folder(root_.string());
    campaign_.mutable_calibration()->add_models("WN + RW");
    campaign_.mutable_calibration()->set_diagnose(true);
  }

  // A program that notes its arguments and then does `what`.
  Aftercare with(const std::string& what) {
    const fs::path program = root_ / "imunoise";
    std::ofstream(program) << "#!/bin/sh\nprintf '%s|' \"$@\" >> " << root_ / "asked"
                           << "\necho >> " << root_ / "asked"
                           << "\n"
                           << what << "\n";
    fs::permissions(program, fs::perms::owner_all);
    return Aftercare(files_, calls_, program);
  }
  std::string asked() const {
    std::ifstream file(root_ / "asked");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // A calibration that the script may copy into place.
  fs::path prepared(const std::string& folder) {
    v1::Calibration made;
    made.set_version(study::kCalibrationVersion);
    made.set_fingerprint(recording::fingerprint(manifest(folder)));
    made.mutable_settings()->add_models("WN + RW");
    made.mutable_settings()->set_diagnose(true);
    made.set_summary("1 of 1 channels have a model.");
    fs::create_directories(root_ / "prepared");
    EXPECT_TRUE(study::write_calibration(files_, root_ / "prepared", made));
    return root_ / "prepared" / study::kCalibrationName;
  }

  recording::DiskCalls calls_;
  std::chrono::steady_clock::time_point pending_at_;
  v1::Campaign campaign_;
};

TEST_F(Cared, ARecordingIsCalibratedOnceAsItsCampaignSays) {
  add_recording("a", 0);
  const fs::path folder = root_ / "a";
  Aftercare aftercare = with("cp " + prepared("a").string() + " \"$2\"");
  const auto told = aftercare.calibrate(campaign_, folder, {});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_EQ(*told, "1 of 1 channels have a model.");
  EXPECT_EQ(asked(), "calibrate|" + folder.string() + "|--model|WN + RW|\n");
  EXPECT_EQ(aftercare.calibrate(campaign_, folder, {}).value(), "");
  EXPECT_EQ(asked(), "calibrate|" + folder.string() + "|--model|WN + RW|\n") << "once";
}

TEST_F(Cared, AnotherCalibrationIsAskedForWhenTheCampaignOrTheRecordingChanged) {
  add_recording("a", 0);
  Aftercare aftercare = with("cp " + prepared("a").string() + " \"$2\"");
  ASSERT_TRUE(aftercare.calibrate(campaign_, root_ / "a", {}));
  fs::remove(root_ / "asked");
  v1::CampaignCalibration& how = *campaign_.mutable_calibration();
  how.add_models("WN");
  how.set_diagnose(false);
  how.set_array(true);
  how.set_array_model("WN + RW[corr]");
  ASSERT_TRUE(aftercare.calibrate(campaign_, root_ / "a", {}));
  EXPECT_EQ(asked(), "calibrate|" + (root_ / "a").string() +
                         "|--model|WN + RW|--model|WN|--no-diagnose|--array|--array-model|"
                         "WN + RW[corr]|\n");
}

TEST_F(Cared, WhatCalibrationSaysInItsTroubleIsTold) {
  add_recording("a", 0);
  const auto failed =
      with("echo 'gyro_x: too short' >&2; exit 1").calibrate(campaign_, root_ / "a", {});
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("exit status 1: gyro_x: too short"), std::string::npos)
      << failed.error().message;
  const auto lazy = with("exit 0").calibrate(campaign_, root_ / "a", {});
  ASSERT_FALSE(lazy);
  EXPECT_NE(lazy.error().message.find("ended without a result"), std::string::npos);
}

TEST_F(Cared, ACalibrationThatDoesNothingHangs) {
  add_recording("a", 0);
  const fs::path folder = root_ / "a";
  Aftercare aftercare = with("exec sleep 0.6");
  std::vector<recording::DiskCall> pending;
  const std::jthread looks([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    pending = calls_.pending();
    pending_at_ = std::chrono::steady_clock::now();
  });
  EXPECT_FALSE(aftercare.calibrate(campaign_, folder, {}));
  ASSERT_EQ(pending.size(), 1U);
  EXPECT_EQ(pending[0].what, "calibration");
  EXPECT_EQ(pending[0].path, folder);
  EXPECT_GT(pending_at_ - pending[0].since, std::chrono::milliseconds(200));
  EXPECT_TRUE(calls_.pending().empty());
}

TEST_F(Cared, AnUpdateOfTheCatalogueIsAmongTheCalls) {
  add_recording("a", 0);
  Aftercare aftercare = with("exit 1");
  std::vector<std::string> seen;
  const Progress looks([&](double) {
    for (const recording::DiskCall& one : calls_.pending()) seen.emplace_back(one.what);
  });
  ASSERT_TRUE(aftercare.publish(campaign_, root_ / "a", looks));
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.front(), "update of the catalogue");
  EXPECT_TRUE(calls_.pending().empty());
}

TEST_F(Cared, ADeviceThatDriftsIsTold) {
  Aftercare aftercare = with("exit 1");
  for (int day = 0; day < 8; ++day) {
    const std::string folder = "day-" + std::to_string(day);
    add_recording(folder, day);
    add_calibration(folder, {2e-4 * (1.0 + 0.002 * (day % 3)), 1.98e-4, 2.02e-4});
  }
  EXPECT_EQ(aftercare.publish(campaign_, root_ / "day-7", {}).value(), "");
  EXPECT_TRUE(fs::exists(root_ / "catalogue.sqlite"));
  add_recording("day-8", 8);
  add_calibration("day-8", {4e-4, 3.96e-4, 4.04e-4});
  const auto told = aftercare.publish(campaign_, root_ / "day-8", {});
  ASSERT_TRUE(told) << told.error().message;
  EXPECT_NE(told->find("imu0 drifts: "), std::string::npos) << *told;
  EXPECT_EQ(aftercare.publish(campaign_, root_ / "day-8", {}).value(), "") << "once";
}

}  // namespace
}  // namespace imunoise::app
