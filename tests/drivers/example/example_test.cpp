// The example of the driver guide: installed headers, its own build, loaded, read.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "drivers/host/device.h"
#include "drivers/host/load.h"

namespace imunoise::drivers {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

class ExampleDriver : public ::testing::Test {
 protected:
  ExampleDriver()
      : folder_(fs::temp_directory_path() / ("imunoise_example_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~ExampleDriver() override { fs::remove_all(folder_); }

  void run(const std::string& arguments) const {
    const fs::path log = folder_ / "log.txt";
    const std::string command =
        "'" IMUNOISE_CMAKE "' " + arguments + " > '" + log.string() + "' 2>&1";
    const int status = std::system(command.c_str());
    std::ifstream said(log);
    ASSERT_EQ(status, 0) << command << "\n"
                         << std::string(std::istreambuf_iterator<char>(said), {});
  }

  fs::path folder_;
};

TEST_F(ExampleDriver, BuildsAgainstTheInstalledHeadersAndDelivers) {
  const std::string prefix = (folder_ / "prefix").string();
  const std::string build = (folder_ / "build").string();
  run("--install '" IMUNOISE_BINARY_DIR "' --component driver_headers --prefix '" + prefix + "'");
  run("-S '" IMUNOISE_SOURCE_DIR "/docs/examples/driver' -B '" + build +
      "' -DCMAKE_CXX_COMPILER='" IMUNOISE_CXX "' -DCMAKE_PREFIX_PATH='" + prefix +
      "' -DCMAKE_CXX_FLAGS='-Wall -Wextra -Wpedantic -Wconversion -Werror'");
  run("--build '" + build + "'");

  const Drivers drivers = load_drivers({build});
  ASSERT_TRUE(drivers.refused.empty()) << drivers.refused[0].reason;
  const auto driver = drivers.find("pendulum");
  ASSERT_TRUE(driver) << driver.error().message;
  const std::vector<OptionText> options = {{"rate", "1000"}};
  const auto device = Device::open(**driver, options);
  ASSERT_TRUE(device) << device.error().message;
  const Stream& stream = (*device)->info().streams[0];
  EXPECT_EQ(stream.nominal_rate_hz, 1000.0);

  SampleBlock block = (*device)->make_block(64);
  std::uint64_t next = 0;
  std::uint64_t refused = 0;
  while (next < 300) {
    const auto outcome = (*device)->read(10s, block);
    ASSERT_TRUE(outcome) << outcome.error().message;
    ASSERT_EQ(*outcome, ReadOutcome::kSamples);
    refused += block.refused(IMUNOISE_REFUSED_STALE, 0);
    for (std::size_t i = 0; i < block.rows(); ++i) {
      if (next % 100 == 99) ++next;  // the example refuses these
      ASSERT_EQ(block.counter()[i], next++);
      EXPECT_LE(std::abs(block.column<std::int16_t>(0)[i]), 1000);
    }
  }
  EXPECT_EQ(refused, next / 100);
}

}  // namespace
}  // namespace imunoise::drivers
