// Bags that independent writers made.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "recording/import/ros/imu_messages.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Bags : public FileTest {
 protected:
  // Runs a writer that stands beside this test.
  static bool made_by(const std::string& writer, const std::string& arguments) {
    const std::string node = "NODE_PATH=$NODE_PATH:" IMUNOISE_SOURCE_DIR "/web/node_modules ";
    return std::system((node + writer.substr(0, writer.find(' ')) +
                        " " IMUNOISE_SOURCE_DIR "/tests/recording/" +
                        writer.substr(writer.find(' ') + 1) + " " + arguments + " 2> /dev/null")
                           .c_str()) == 0;
  }
  std::string ros1(const std::string& packing, int messages) const {
    const std::string file = path(packing + ".bag").string();
    return made_by("/usr/bin/python3 write_bag.py",
                   file + " " + packing + " " + std::to_string(messages))
               ? file
               : "";
  }
  std::string mcap(const std::string& packing, int messages, int topics) const {
    const std::string file = path(packing + ".mcap").string();
    return made_by("node write_mcap.js", file + " " + packing + " " + std::to_string(messages) +
                                             " " + std::to_string(topics))
               ? file
               : "";
  }
};

// What the writers' messages hold.
void expect_counted(const Replicate& bag, std::size_t messages) {
  ASSERT_EQ(bag.channels.size(), 6U);
  EXPECT_DOUBLE_EQ(bag.rate.value, 100.0);
  EXPECT_EQ(bag.channels[0].name, "gyro_x");
  EXPECT_EQ(bag.channels[0].unit.quantity, Quantity::kAngularRate);
  EXPECT_EQ(bag.channels[5].name, "acc_z");
  EXPECT_EQ(bag.channels[5].unit.quantity, Quantity::kAcceleration);
  for (std::size_t i = 0; i < messages; ++i) {
    const auto x = static_cast<double>(i);
    const double expected[] = {x, x + 0.25, x + 0.5, 9.0 + x, x / 2.0, -x};
    for (std::size_t c = 0; c < 6; ++c) {
      ASSERT_EQ(stored_doubles(bag.channels[c]).size(), messages);
      ASSERT_EQ(stored_doubles(bag.channels[c])[i], expected[c]) << i << " " << c;
    }
  }
}

const char* const kNode = "npm @mcap/core and @foxglove/rosmsg2-serialization";
const char* const kPython = "Debian's python3-rosbag and python3-sensor-msgs";

#define SKIP_WITHOUT(FILE, WRITER) \
  if ((FILE).empty()) GTEST_SKIP() << "no independent writer here: " << (WRITER)

TEST_F(Bags, McapOfEveryPacking) {
  for (const std::string packing : {"none", "lz4", "zstd"}) {
    const std::string file = mcap(packing, 100, 1);
    SKIP_WITHOUT(file, kNode);
    const auto got = import_one(file);
    ASSERT_TRUE(got) << got.error().message;
    expect_counted(got->front(), 100);
  }
}

TEST_F(Bags, SeveralTopicsOfAnImuAreListedAndOneIsChosen) {
  const std::string file = mcap("none", 100, 2);
  SKIP_WITHOUT(file, kNode);
  EXPECT_EQ(error_of(file),
            file + ": several topics of an IMU: /imu0, /imu1; choose one with --topic");
  ImportOptions options;
  options.topic = "/imu1";
  const auto got = import_one(file, options);
  ASSERT_TRUE(got) << got.error().message;
  expect_counted(got->front(), 100);
  options.topic = "/chatter";
  EXPECT_NE(error_of(file, options).find("/chatter (std_msgs/msg/String)"), std::string::npos);
}

// What is read of the first bytes is a beginning of the whole, and never less than of fewer bytes.
void expect_beginnings(const std::filesystem::path& file, const std::filesystem::path& cut) {
  const std::string bytes = bytes_in(file);
  std::size_t before = 0;
  for (std::size_t length = 100; length < bytes.size(); length += 97) {
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    const auto got = import_one(cut);
    if (!got) {
      ASSERT_EQ(before, 0U) << length << ": " << got.error().message;
      continue;
    }
    const std::size_t count = got->front().channels[0].count;
    ASSERT_GE(count, before) << length;
    expect_counted(got->front(), count);
    before = count;
  }
  EXPECT_EQ(before, 100U);
}

TEST_F(Bags, TruncatedMcapReadsUpToItsEnd) {
  for (const std::string packing : {"none", "zstd"}) {
    const std::string file = mcap(packing, 100, 1);
    SKIP_WITHOUT(file, kNode);
    expect_beginnings(file, path("cut.mcap"));
  }
}

TEST_F(Bags, Ros1OfEveryPacking) {
  for (const std::string packing : {"none", "lz4", "bz2"}) {
    const std::string file = ros1(packing, 100);
    SKIP_WITHOUT(file, kPython);
    const auto got = import_one(file);
    ASSERT_TRUE(got) << got.error().message;
    expect_counted(got->front(), 100);
  }
}

TEST_F(Bags, ThatEndTooSoonSaySo) {
  const std::string file = mcap("none", 100, 1);
  SKIP_WITHOUT(file, kNode);
  const std::string bytes = bytes_in(file);
  const auto whole = import_one(file);
  ASSERT_TRUE(whole) << whole.error().message;
  for (const Finding& one : whole->front().preflight->findings)
    EXPECT_EQ(one.text.find("truncated"), std::string::npos) << one.text;
  ImportOptions strict;
  strict.strict = true;
  const auto cut = write("cut.mcap", bytes.substr(0, bytes.size() * 3 / 4));
  EXPECT_TRUE(import_one(cut));
  EXPECT_NE(error_of(cut, strict).find("truncated"), std::string::npos) << error_of(cut, strict);
}

// A message as ROS 1 lays it out (sensor_msgs/Imu): sequence, time, frame_id, 37 numbers.
std::string ros1_message(std::uint32_t seconds) {
  std::string out(16, '\0');
  std::memcpy(out.data() + 4, &seconds, sizeof seconds);
  return out.append(37 * sizeof(double), '\0');
}

TEST(ImuCollector, LeavesOutAndCountsWhatIsNoMessage) {
  const ImportOptions options;
  ImuCollector collector("a.bag", options);
  collector.topic(1, "/imu", "sensor_msgs/Imu");
  collector.add(1, Encoding::kRos1, "short", 5);
  for (std::uint32_t i = 1; i <= 3; ++i) collector.add(1, Encoding::kRos1, ros1_message(i), 5);
  collector.add(1, Encoding::kRos1, ros1_message(4).substr(0, 100), 5);
  const auto table = collector.finish();
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->unreadable, 2U);
  EXPECT_EQ(table->first_unreadable, "topic /imu: message 0 is not a whole sensor_msgs/Imu");
  EXPECT_EQ(size(table->columns.front().samples), 3U);
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(table->time->stamps),
            (std::vector<std::int64_t>{1'000'000'000, 2'000'000'000, 3'000'000'000}));
}

TEST_F(Bags, TruncatedRos1ReadsUpToItsEnd) {
  for (const std::string packing : {"none", "lz4", "bz2"}) {
    const std::string file = ros1(packing, 100);
    SKIP_WITHOUT(file, kPython);
    expect_beginnings(file, path("cut.bag"));
  }
}

TEST_F(Bags, Ros2InSqliteAndItsTruncations) {
  const std::string file = path("a.db3").string();
  if (!made_by("/usr/bin/python3 write_db3.py", file + " 100")) {
    GTEST_SKIP() << "no independent writer here: Python";
  }
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  expect_counted(got->front(), 100);
  const std::string bytes = bytes_in(file);
  for (std::size_t length = 16; length < bytes.size(); length += 997) {
    EXPECT_NE(error_of(write("cut.db3", bytes.substr(0, length))).find("cut.db3: "),
              std::string::npos)
        << length;
  }
}

TEST_F(Bags, RatesAndAccelerationsInTwoTopicsAreJoined) {
  const std::string file = path("split.db3").string();
  if (!made_by("/usr/bin/python3 write_db3.py", file + " 100 0 split"))
    GTEST_SKIP() << "no independent writer here: Python";
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  expect_counted(got->front(), 100);
  ImportOptions named;
  named.channels = {"gyro_x"};
  const auto rate = import_one(file, named);
  ASSERT_TRUE(rate) << rate.error().message;
  ASSERT_EQ(rate->front().channels.size(), 1U);
  EXPECT_EQ(rate->front().channels[0].name, "gyro_x");
  ImportOptions one;
  one.topic = "/accel";
  const auto alone = import_one(file, one);
  ASSERT_TRUE(alone) << alone.error().message;
  ASSERT_EQ(alone->front().channels.size(), 3U) << "its rates are all 0";
  EXPECT_EQ(alone->front().channels[0].name, "acc_x");
}

TEST_F(Bags, PiecesInAFolderAreOneRecording) {
  std::filesystem::create_directory(path("bag"));
  write("bag/metadata.yaml", "rosbag2_bagfile_information:\n");
  int first = 0;
  for (const std::string name : {"bag_2.db3", "bag_9.db3", "bag_10.db3", "bag_11.db3"}) {
    const std::string how = std::to_string(first) + (name == "bag_9.db3" ? " packed" : "");
    if (!made_by("/usr/bin/python3 write_db3.py", path("bag/" + name).string() + " 30 " + how))
      GTEST_SKIP() << "no independent writer here: Python, zstd";
    first += 30;
  }
  if (std::system(("zstd -q --rm " + path("bag/bag_11.db3").string() + " -o " +
                   path("bag/bag_11.db3.zstd").string())
                      .c_str()) != 0)
    GTEST_SKIP() << "no zstd here";
  for (const std::string folder : {"bag", "bag/"}) {
    const auto got = import_one(path(folder));
    ASSERT_TRUE(got) << got.error().message;
    ASSERT_EQ(got->size(), 1U);
    EXPECT_EQ(got->front().name, "bag");
    expect_counted(got->front(), 120);
  }
  if (!made_by("node write_mcap.js", path("bag/bag_12.mcap").string() + " none 30 2"))
    GTEST_SKIP() << "no independent writer here: npm @mcap/core";
  expect_parts(error_of(path("bag")), {"bag_12.mcap", "several topics"});
}

}  // namespace
}  // namespace imunoise::recording
