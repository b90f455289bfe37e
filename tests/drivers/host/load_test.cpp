// Which shared objects the host takes, and what it says of the others.

#include "drivers/host/load.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "drivers/host/device.h"

namespace imunoise::drivers {
namespace {

namespace fs = std::filesystem;

const fs::path kPlugins = IMUNOISE_TEST_PLUGINS;

struct Spoiled {
  const char* plugin;
  const char* reason;  // part of it
};

void PrintTo(const Spoiled& spoiled, std::ostream* out) { *out << spoiled.plugin; }

class SpoiledPlugin : public ::testing::TestWithParam<Spoiled> {};

TEST_P(SpoiledPlugin, IsRefusedWithTheReason) {
  const Drivers drivers = load_drivers({kPlugins / GetParam().plugin});
  EXPECT_TRUE(drivers.found.empty());
  ASSERT_EQ(drivers.refused.size(), 1U);
  EXPECT_EQ(drivers.refused[0].file.stem(), std::string("imunoise-") + GetParam().plugin);
  EXPECT_NE(drivers.refused[0].reason.find(GetParam().reason), std::string::npos)
      << drivers.refused[0].reason;
}

INSTANTIATE_TEST_SUITE_P(
    All, SpoiledPlugin,
    ::testing::Values(Spoiled{"null_table", "no driver for ABI 1"},
                      Spoiled{"other_abi", "speaks ABI 2, this program ABI 1"},
                      Spoiled{"small_table", "its table has 95 bytes, ABI 1 needs 96"},
                      Spoiled{"no_read", "lacks one of open, describe, read"},
                      Spoiled{"no_driver_name", "the driver: has no name"},
                      Spoiled{"shouting_name", "'Sound' has other characters"},
                      Spoiled{"endless_text", "description: a text has no end"},
                      Spoiled{"control_text", "version: a text has control characters"},
                      Spoiled{"wild_stream_count", "claims 4000000000 streams"},
                      Spoiled{"null_streams", "its streams are NULL"},
                      Spoiled{"small_stream", "stream 0: its struct is too small"},
                      Spoiled{"nan_rate", "stream 0: nominal rate is nan Hz"},
                      Spoiled{"negative_tick", "stream 0: device time ticks every -1 s"},
                      Spoiled{"no_channels", "stream 0: has no channels"},
                      Spoiled{"null_channel", "stream 0: channel 1: is NULL"},
                      Spoiled{"twin_channels", "stream 0: channel 1: its name 'gyro_x' is taken"},
                      Spoiled{"unknown_type", "stream 0: channel 0: unknown number type 9"},
                      Spoiled{"no_channel_name", "stream 0: channel 0: has no name"},
                      Spoiled{"slash_in_name", "contains '/'"},
                      Spoiled{"no_units", "channel 0: has no units"},
                      Spoiled{"zero_scale", "channel 0: scale_factor is 0"},
                      Spoiled{"infinite_offset", "channel 0: add_offset is inf"},
                      Spoiled{"unknown_option_type", "option 0: unknown option type 77"},
                      Spoiled{"bad_default", "option 0: its default: 'fast' is not a whole number"},
                      Spoiled{"default_out_of_bounds", "2000 Hz is out of bounds"},
                      Spoiled{"required_default", "is required, yet has a default"},
                      Spoiled{"no_bounds", "allows values from nan"},
                      Spoiled{"null_choices", "its choices are NULL"},
                      Spoiled{"no_entry", "has no function imunoise_driver_entry"},
                      Spoiled{"unresolved", "nobody_has_this"}),
    [](const auto& instance) { return std::string(instance.param.plugin); });

TEST(LoadDrivers, TakesASoundDriverInC) {
  const Drivers drivers = load_drivers({kPlugins / "sound"});
  ASSERT_TRUE(drivers.refused.empty()) << drivers.refused[0].reason;
  ASSERT_EQ(drivers.found.size(), 1U);
  const DriverInfo& info = drivers.found[0].info;
  EXPECT_EQ(info.name, "sound");
  EXPECT_EQ(info.version, "1.0");
  ASSERT_EQ(info.options.size(), 1U);
  EXPECT_EQ(info.options[0].unit, "Hz");
  EXPECT_EQ(info.options[0].by_default, "100");
  EXPECT_EQ(info.options[0].maximum, 1000.0);
  ASSERT_EQ(info.streams.size(), 1U);
  EXPECT_EQ(info.streams[0].counter_maximum, 65535U);
  ASSERT_EQ(info.streams[0].channels.size(), 2U);
  EXPECT_EQ(info.streams[0].channels[0].type, NumberType::kInt16);
  EXPECT_EQ(info.streams[0].channels[0].scale_factor, 0.5);
  EXPECT_EQ(info.streams[0].channels[1].add_offset, 273.15);
  const auto device = Device::open(drivers.found[0]);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "driver sound: there is no hardware behind this");
}

TEST(LoadDrivers, TheFirstOfANameWins) {
  const fs::path copy = fs::temp_directory_path() / ("imunoise_twin_" + std::to_string(getpid()));
  fs::create_directories(copy);
  fs::copy_file(kPlugins / "sound/imunoise-sound.so", copy / "imunoise-twin.so",
                fs::copy_options::overwrite_existing);
  const Drivers drivers = load_drivers({kPlugins / "sound", copy});
  fs::remove_all(copy);
  ASSERT_EQ(drivers.found.size(), 1U);
  EXPECT_EQ(drivers.found[0].file, kPlugins / "sound/imunoise-sound.so");
  ASSERT_EQ(drivers.refused.size(), 1U);
  EXPECT_EQ(drivers.refused[0].reason,
            "the name 'sound' is taken by " + (kPlugins / "sound/imunoise-sound.so").string());
}

TEST(LoadDrivers, SaysWhatDlopenSaysOfOtherFiles) {
  const fs::path folder = fs::temp_directory_path() / ("imunoise_text_" + std::to_string(getpid()));
  fs::create_directories(folder);
  std::ofstream(folder / "imunoise-text.so") << "no shared object at all\n";
  std::ofstream(folder / "other.so") << "nor does it look like a driver\n";
  const Drivers drivers = load_drivers({folder, folder / "does_not_exist"});
  fs::remove_all(folder);
  ASSERT_EQ(drivers.refused.size(), 1U);
  EXPECT_NE(drivers.refused[0].reason.find("imunoise-text.so: "), std::string::npos)
      << drivers.refused[0].reason;
}

TEST(LoadDrivers, FindsByNameOrSaysWhyNot) {
  const Drivers drivers = load_drivers({kPlugins / "sound", kPlugins / "nan_rate"});
  ASSERT_TRUE(drivers.find("sound"));
  EXPECT_EQ(*drivers.find("sound"), &drivers.found[0]);
  EXPECT_EQ(drivers.find("other").error().message,
            "no driver 'other'; there are: sound (see imunoise drivers)");
  EXPECT_NE(
      drivers.find("nan_rate").error().message.find("cannot be loaded: stream 0: nominal rate"),
      std::string::npos);
}

TEST(DriverFolders, FirstTheCallersThenTheEnvironmentsEachOnce) {
  ::setenv("IMUNOISE_DRIVER_PATH", "/one::/two/../two:/first", 1);
  const std::vector<fs::path> first = {"/first"};
  const std::vector<fs::path> folders = driver_folders(first);
  ::unsetenv("IMUNOISE_DRIVER_PATH");
  ASSERT_EQ(folders.size(), 5U);
  EXPECT_EQ(folders[0], "/first");
  EXPECT_EQ(folders[1], "/one");
  EXPECT_EQ(folders[2], "/two");
  EXPECT_EQ(folders[3].filename(), "drivers");
}

}  // namespace
}  // namespace imunoise::drivers
