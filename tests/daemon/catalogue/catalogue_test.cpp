// The catalogue follows the files, whatever happens to them and to it.

#include "daemon/catalogue/catalogue.h"

#include <gtest/gtest.h>

#include <fstream>

#include "daemon/catalogue/scan.h"
#include "tests/daemon/catalogue/bench_folder.h"
#include "tests/daemon/catalogue/empty_place.h"

namespace imunoise::catalogue {
namespace {

using testing::kDay;
using testing::kSimulatedStart;

class CatalogueOf : public testing::BenchFolder {
 protected:
  void SetUp() override {
    const testing::EmptyPlace place = testing::empty_place(root_);
    if (!place.trouble.empty()) GTEST_SKIP() << place.trouble;
    where_ = place.where;
  }
  Catalogue opened(const std::string& bench = "") const {
    auto out = Catalogue::open(where_, bench);
    EXPECT_TRUE(out) << out.error().message;
    return std::move(*out);
  }
  Changes refreshed(Catalogue& catalogue) const {
    const auto out = catalogue.refresh(files_, root_);
    EXPECT_TRUE(out) << out.error().message;
    return out.value_or(Changes());
  }
  // Everything that can be asked of it, as text.
  static std::string everything(Catalogue& catalogue) {
    std::string out =
        catalogue.recordings()->DebugString() + catalogue.calibrations()->DebugString();
    const auto parameters = catalogue.parameters("simulated:0042");
    for (const v1::ParameterHistory& one : *parameters) out += one.DebugString();
    return out;
  }
  std::string where_;
};

TEST_F(CatalogueOf, KnowsWhatTheFilesSay) {
  add_recording("monday", 0);
  add_recording("deep/in/tuesday", 1);
  add_calibration("monday", {2e-4, 1.98e-4, 2.02e-4});
  Catalogue catalogue = opened();
  EXPECT_EQ(refreshed(catalogue), (Changes{2, 0, 0}));

  const auto recordings = catalogue.recordings();
  ASSERT_TRUE(recordings) << recordings.error().message;
  ASSERT_EQ(recordings->recordings_size(), 2);
  const v1::CataloguedRecording& monday = recordings->recordings(0);
  EXPECT_EQ(monday.folder(), "monday");
  EXPECT_EQ(monday.campaign(), "monthly");
  EXPECT_EQ(monday.started_ns(), kSimulatedStart);
  EXPECT_TRUE(monday.closed());
  EXPECT_EQ(monday.replicates(), 2U);
  EXPECT_EQ(monday.samples(), 10'000U);
  EXPECT_EQ(monday.bytes(), 24'690U);
  EXPECT_TRUE(monday.calibrated());
  ASSERT_EQ(monday.devices_size(), 1);
  EXPECT_EQ(monday.devices(0).id(), "simulated:0042");
  EXPECT_EQ(recordings->recordings(1).folder(), "deep/in/tuesday");
  EXPECT_FALSE(recordings->recordings(1).calibrated());

  const auto calibrations = catalogue.calibrations();
  ASSERT_TRUE(calibrations);
  ASSERT_EQ(calibrations->calibrations_size(), 1);
  const v1::CataloguedCalibration& one = calibrations->calibrations(0);
  EXPECT_EQ(one.made_ns(), kSimulatedStart + kDay);
  EXPECT_EQ(one.model(), "WN + RW");
  EXPECT_EQ(one.channels(), 1U);
  EXPECT_EQ(one.fitted(), 1U);
  EXPECT_FALSE(one.outdated());

  const auto parameters = catalogue.parameters("simulated:0042");
  ASSERT_TRUE(parameters);
  ASSERT_EQ(parameters->size(), 2U);
  const v1::ParameterHistory& n = (*parameters)[1];  // RW before WN
  EXPECT_EQ(n.channel(), "gyro_x") << "by its own name";
  EXPECT_EQ(n.term(), "WN");
  EXPECT_EQ(n.parameter(), "N");
  EXPECT_EQ(n.unit(), "rad/s/√Hz");
  EXPECT_EQ(n.datasheet_unit(), "°/√h");
  EXPECT_NEAR(n.to_datasheet(), 3437.75, 1e-9);
  ASSERT_EQ(n.points_size(), 1);
  EXPECT_EQ(n.points(0).value(), 2e-4);
  EXPECT_EQ(n.points(0).lower(), 1.98e-4);
  EXPECT_EQ(n.points(0).upper(), 2.02e-4);
  EXPECT_EQ(n.points(0).started_ns(), kSimulatedStart);
}

TEST_F(CatalogueOf, AddingTwiceChangesNothing) {
  add_recording("monday", 0);
  add_calibration("monday", {});
  Catalogue catalogue = opened();
  refreshed(catalogue);
  const std::string before = everything(catalogue);
  EXPECT_EQ(refreshed(catalogue), (Changes{0, 1, 0}));
  EXPECT_EQ(everything(catalogue), before);
  const auto again = catalogue.rebuild(files_, root_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(*again, (Changes{1, 0, 0}));
  EXPECT_EQ(everything(catalogue), before);
}

TEST_F(CatalogueOf, FollowsTheFiles) {
  add_recording("monday", 0);
  add_recording("tuesday", 1);
  Catalogue catalogue = opened();
  refreshed(catalogue);
  add_calibration("monday", {});
  EXPECT_EQ(refreshed(catalogue), (Changes{1, 1, 0}));
  EXPECT_TRUE(catalogue.recordings()->recordings(0).calibrated());

  v1::Manifest grown = manifest("monday");
  v1::ChunkEntry& chunk = *grown.add_chunks();
  chunk.set_file("replicate-3/imu0/000001.h5");
  chunk.set_crc32c("00000003");
  write("monday", grown);
  EXPECT_EQ(refreshed(catalogue), (Changes{1, 1, 0}));
  EXPECT_EQ(catalogue.recordings()->recordings(0).replicates(), 3U);
  EXPECT_TRUE(catalogue.calibrations()->calibrations(0).outdated());

  std::filesystem::remove_all(root_ / "monday");
  EXPECT_EQ(refreshed(catalogue), (Changes{0, 1, 1}));
  EXPECT_EQ(catalogue.recordings()->recordings_size(), 1);
  EXPECT_TRUE(catalogue.parameters("simulated:0042")->empty());
}

TEST_F(CatalogueOf, IsMadeAgainWhenItIsOldOrEmpty) {
  add_recording("monday", 0);
  add_calibration("monday", {});
  std::string before;
  {
    Catalogue catalogue = opened();
    refreshed(catalogue);
    before = everything(catalogue);
  }
  const auto database = Database::open(where_);
  ASSERT_TRUE((*database)->execute("update imunoise_schema set version = 0"));
  Catalogue old = opened();
  EXPECT_EQ(refreshed(old), (Changes{1, 0, 0}));
  EXPECT_EQ(everything(old), before);
  ASSERT_TRUE((*database)->execute("delete from recordings"));
  ASSERT_TRUE((*database)->execute("delete from parameters where parameter = 'N'"));
  refreshed(old);
  EXPECT_EQ(everything(old), before);
}

TEST_F(CatalogueOf, TellsWhatItCannotRead) {
  add_recording("broken", 0);
  add_recording("calibrated", 1);
  std::ofstream(root_ / "broken" / "manifest.json") << "{";
  std::ofstream(root_ / "calibrated" / "calibration.json") << "{";
  std::filesystem::create_directories(root_ / "lost" / "replicate-1");
  Catalogue catalogue = opened();
  refreshed(catalogue);
  const auto recordings = catalogue.recordings();
  ASSERT_EQ(recordings->recordings_size(), 3);
  EXPECT_NE(recordings->recordings(0).trouble().find("broken/manifest.json"), std::string::npos);
  EXPECT_NE(recordings->recordings(1).trouble().find("--repair"), std::string::npos);
  EXPECT_EQ(recordings->recordings(2).trouble(), "");
  const auto calibrations = catalogue.calibrations();
  ASSERT_EQ(calibrations->calibrations_size(), 1);
  EXPECT_NE(calibrations->calibrations(0).trouble().find("imunoise calibrate"), std::string::npos);
}

TEST_F(CatalogueOf, BenchesShareOneWithoutTouchingEachOther) {
  add_recording("monday", 0);
  add_calibration("monday", {});
  Catalogue north = opened("north");
  Catalogue south = opened("south");
  refreshed(north);
  refreshed(south);
  EXPECT_EQ(north.recordings()->recordings_size(), 2);
  EXPECT_EQ((*south.parameters("simulated:0042"))[0].points_size(), 1)
      << "one recording, twice in view, is one calibration";
  std::filesystem::remove_all(root_ / "monday");
  EXPECT_EQ(refreshed(south), (Changes{0, 0, 1}));
  ASSERT_EQ(north.recordings()->recordings_size(), 1);
  EXPECT_EQ(north.recordings()->recordings(0).bench(), "north");
}

TEST_F(CatalogueOf, FindsADeviceByWhatPeopleCallIt) {
  add_recording("monday", 0, "0042");
  add_recording("tuesday", 1, "0043");
  add_recording("wednesday", 2, "");
  Catalogue catalogue = opened();
  refreshed(catalogue);
  EXPECT_EQ(catalogue.device("simulated:0042")->serial(), "0042");
  EXPECT_EQ(catalogue.device("0043")->id(), "simulated:0043");
  EXPECT_EQ(catalogue.device("imu0")->serial(), "") << "an id, before other devices' names";
  const auto unknown = catalogue.device("imu9");
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().message,
            "device 'imu9': there is none; there are imu0, simulated:0042, simulated:0043");
  std::filesystem::remove_all(root_ / "wednesday");
  refreshed(catalogue);
  const auto several = catalogue.device("imu0");
  ASSERT_FALSE(several);
  EXPECT_NE(several.error().message.find("give one of simulated:0042, simulated:0043"),
            std::string::npos);
}

TEST_F(CatalogueOf, LinksAndHiddenFoldersAreNotFollowed) {
  add_recording("monday", 0);
  add_recording(".trash/old", 0);
  std::filesystem::create_directory_symlink(root_, root_ / "loop");
  std::filesystem::create_directory_symlink(root_ / "monday", root_ / "alias");
  const auto found = find_recordings(files_, root_);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, std::vector<std::string>{"monday"});
  EXPECT_EQ(*find_recordings(files_, root_ / "monday"), std::vector<std::string>{"."});
  EXPECT_FALSE(find_recordings(files_, root_ / "absent"));
}

TEST_F(CatalogueOf, AStopIsHeeded) {
  add_recording("monday", 0);
  Catalogue catalogue = opened();
  std::stop_source source;
  source.request_stop();
  const auto stopped = catalogue.refresh(files_, root_, Progress(nullptr, source.get_token()));
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().message, "stopped");
}

}  // namespace
}  // namespace imunoise::catalogue
