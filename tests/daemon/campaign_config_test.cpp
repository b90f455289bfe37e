#include "daemon/config/campaign_config.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "daemon/config/calendar.h"
#include "daemon/config/campaign_keys.h"

namespace imunoise::config {
namespace {

const drivers::Drivers& known() {
  static const drivers::Drivers kKnown = drivers::load_drivers({IMUNOISE_DRIVER_FOLDER});
  return kKnown;
}

std::vector<std::string> problems_of(const std::string& text) {
  std::vector<std::string> out;
  for (const Problem& one : parse_campaign(text, known()).problems) {
    out.push_back(describe("a.toml", one));
  }
  return out;
}

const std::string kSound = R"toml(name = "bench"
folder = "recordings"
length = "2 h"
[[device]]
driver = "emulated"
options.device = "adis16405"
)toml";

// The sound campaign with a line more at its beginning; the only problem that it has then.
std::string problem_with(const std::string& line) {
  const auto found = problems_of(line + "\n" + kSound);
  EXPECT_EQ(found.size(), 1U) << line << ": " << ::testing::PrintToString(found);
  return found.empty() ? "" : found.front();
}

void expect_problem(const std::string& line, const std::string& words) {
  const std::string found = problem_with(line);
  EXPECT_NE(found.find(words), std::string::npos) << line << ": " << found;
}

TEST(CampaignConfig, EveryExampleIsSound) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(IMUNOISE_SOURCE_DIR "/config")) {
    if (entry.path().extension() != ".toml") continue;
    const auto read = read_campaign(entry.path(), known());
    ASSERT_TRUE(read.has_value()) << read.error().message;
    for (const Problem& one : read->problems) {
      ADD_FAILURE() << describe(entry.path().string(), one);
    }
    EXPECT_EQ(read->campaign.name(), entry.path().stem().string());
    EXPECT_FALSE(read->campaign.calibration().models().empty()) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 6U) << "one for each driver, one for an array";
}

std::string contents(const std::string& path) {
  std::ifstream file(IMUNOISE_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// A key of the manual that the reader does not know, or that the guide or the example lacks.
TEST(CampaignConfig, TheManualHasTheKeysThatAreRead) {
  const std::string guide = contents("docs/campaigns.md");
  const std::string example = contents("config/emulated.toml");
  for (const CampaignKey& key : campaign_keys()) {
    const std::string name(key.name);
    const std::string table =
        key.table == "device" ? "[[device]]" : "[" + std::string(key.table) + "]";
    const std::string text = (key.table.empty() ? "" : table + "\n") + name + " = 1979-05-27\n";
    for (const std::string& one : problems_of(text)) {
      EXPECT_EQ(one.find(name + ": unknown"), std::string::npos) << one;
    }
    EXPECT_NE(guide.find("`" + name + "`"), std::string::npos) << name;
    EXPECT_TRUE(example.find(name + " =") != std::string::npos ||
                example.find(name + ".") != std::string::npos)
        << name;
  }
}

TEST(CampaignConfig, EveryDriverThatRecordsHasAnExample) {
  for (const drivers::Driver& driver : known().found) {
    if (driver.info.name == "wire") continue;  // bytes that were captured: docs/replay.md
    EXPECT_TRUE(
        std::filesystem::exists(IMUNOISE_SOURCE_DIR "/config/" + driver.info.name + ".toml"))
        << driver.info.name;
  }
}

TEST(CampaignConfig, TakesWhatIsWritten) {
  const auto read = parse_campaign(R"toml(
name = "array"
folder = "recordings/array"
replicates = 6
length = "1 h 30 min"
settling = "10 min"
pause = "30 s"
patience = "2 min"
reserve = "20 GB"
wire = true
[calibration]
models = ["WN + RW", "WN + AR1"]
array = true
array_model = "WN + RW[corr]"
[schedule]
every = "1 d"
[retention]
recordings = 30
age = "90 d"
[stillness]
repeat_disturbed = true
repeats = 2
[[device]]
driver = "emulated"
options = { device = "xsens", rate = 100, model = ["gyro: WN(sigma2=1e-6)", "acc: WN(sigma2=1)"] }
[[device]]
driver = "emulated"
options = { device = "adis16405", speed = 0.5 }
)toml",
                                   known());
  ASSERT_TRUE(read.problems.empty()) << describe("", read.problems.front());
  const v1::Campaign& campaign = read.campaign;
  EXPECT_EQ(campaign.replicates(), 6U);
  EXPECT_EQ(campaign.length_s(), 5400.0);
  EXPECT_EQ(campaign.settling_s(), 600.0);
  EXPECT_EQ(campaign.pause_s(), 30.0);
  EXPECT_EQ(campaign.patience_s(), 120.0);
  EXPECT_TRUE(campaign.calibration().enabled());
  EXPECT_EQ(campaign.calibration().models(1), "WN + AR1");
  EXPECT_TRUE(campaign.calibration().diagnose());
  EXPECT_EQ(campaign.calibration().array_model(), "WN + RW[corr]");
  EXPECT_EQ(campaign.reserve_bytes(), 20'000'000'000U);
  EXPECT_TRUE(campaign.wire());
  EXPECT_EQ(campaign.schedule().every_s(), 86400.0);
  EXPECT_EQ(campaign.retention().recordings(), 30U);
  EXPECT_EQ(campaign.retention().age_s(), 90.0 * 86400.0);
  EXPECT_TRUE(campaign.stillness().repeat_disturbed());
  EXPECT_EQ(campaign.stillness().repeats(), 2U);
  ASSERT_EQ(campaign.devices_size(), 2);
  EXPECT_EQ(campaign.devices(0).name(), "emulated");
  EXPECT_EQ(campaign.devices(1).name(), "emulated-2");
  ASSERT_EQ(campaign.devices(0).options_size(), 4);
  EXPECT_EQ(campaign.devices(0).options(1).value(), "100");
  EXPECT_EQ(campaign.devices(0).options(3).value(), "acc: WN(sigma2=1)");
  EXPECT_EQ(campaign.devices(1).options(1).value(), "0.5");
}

TEST(CampaignConfig, HasDefaultsForTheRest) {
  const auto read = parse_campaign(kSound, known());
  ASSERT_TRUE(read.problems.empty()) << describe("", read.problems.front());
  EXPECT_EQ(read.campaign.replicates(), 1U);
  EXPECT_EQ(read.campaign.settling_s(), 0.0);
  EXPECT_FALSE(read.campaign.schedule().has_every_s());
  EXPECT_TRUE(read.campaign.schedule().calendar().empty());
  EXPECT_TRUE(read.campaign.calibration().enabled());
  EXPECT_TRUE(read.campaign.calibration().models().empty());
  EXPECT_EQ(read.campaign.reserve_bytes(), 1'000'000'000U);
}

TEST(CampaignConfig, ModelsHaveEffectsThatACalibrationCanUse) {
  const auto problems = [](const std::string& calibration) {
    return problems_of(std::string(kSound) + "[calibration]\n" + calibration);
  };
  EXPECT_TRUE(problems("models = ['WN + RW + line(f=23.4)', 'WN + line(f=23.4)']").empty());
  const std::map<std::string, std::string> refused = {
      {"models = ['WN + own_powers']", "own_powers changes the noise itself"},
      {"models = ['WN + line(g=2)']", "'g=2' is not known here"},
      {"models = ['WN + line(f=2)', 'WN + RW']", "have different effects"},
      {"array = true\narray_model = 'WN + ramp'", "ramp is an effect"},
  };
  for (const auto& [written, says] : refused) {
    const std::vector<std::string> found = problems(written);
    ASSERT_FALSE(found.empty()) << written;
    EXPECT_EQ(found.front().substr(0, 7), "a.toml:") << found.front();
    EXPECT_NE(found.front().find("calibration."), std::string::npos) << found.front();
    EXPECT_NE(found.front().find(says), std::string::npos) << found.front();
  }
}

TEST(CampaignConfig, TellsAllProblemsWithTheirPlaces) {
  const auto found = problems_of(R"toml(name = "a bench"
folder = 3
replicate = 6
length = "2"
calibration = { models = ["WN + RV"] }

[schedule]
evry = "6h"

[[device]]
driver = "emulated"
options.device = "adis16504"
options.sed = 7

[[device]]
driver = "emulatd"
)toml");
  const std::vector<std::string> expected = {
      "a.toml:1:1: name: 'a bench' cannot name a folder",
      "a.toml:2:10: folder: is a whole number; give a text",
      "a.toml:3:1: replicate: unknown; did you mean 'replicates'?",
      "a.toml:4:1: length: '2': a unit is missing",
      "a.toml:5:27: calibration.models: ",
      "a.toml:7:2: schedule: is empty",
      "a.toml:8:1: schedule.evry: unknown; did you mean 'every'?",
      "a.toml:12:18: device 1.options.device: 'adis16504' is none of: adis16405, xsens, can",
      "a.toml:13:9: device 1.options.sed: driver emulated: unknown; did you mean 'seed'?",
      "a.toml:16:1: device 2.driver: 'emulatd' is unknown; did you mean 'emulated'?",
  };
  ASSERT_EQ(found.size(), expected.size()) << ::testing::PrintToString(found);
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(found[k].substr(0, expected[k].size()), expected[k]);
  }
}

TEST(CampaignConfig, SaysWhatWouldBeRight) {
  expect_problem("replicates = 0", "give 1 to");
  expect_problem("replicates = 2.5", "is a number; give a whole number");
  expect_problem("reserve = \"20\"", "unit is missing");
  expect_problem("pause = 30", "a time with its unit");
  expect_problem("wire = \"yes\"", "give true or false");
  expect_problem("calibration = { models = \"WN\" }", "a list of texts");
  expect_problem("calibration = { array_model = \"WN\" }", "array = true");
  expect_problem("settling = 2026-01-01", "is a date");
  expect_problem("schedule = { every = \"1 h\" }", "takes 2 h");
  expect_problem("schedule = { every = \"6 h\", calendar = \"Mon\" }", "give only one");
  for (const char* const good :
       {"daily", "Mon 02:00", "Mon,Wed..Fri *-*-1,5 11:12:13", "*:0/15", "2026-11-29",
        "*-*~01 Europe/Zurich", "Wed, 17:48", "Mon-Fri 02:00", "02:00 utc", "2003-02..04-05",
        "Sat,Sun 12:00 UTC", "weekly UTC", "@1395716396"})
    EXPECT_TRUE(may_be_calendar(good)) << good;
  for (const char* const wrong : {"Mon; rm", "Mon..Fry 02:00", "every tuesday", "02",
                                  "Mon 2:", "25:00", "*-13-1", "1,,2:00", "/5:00"})
    expect_problem(fmt::format("schedule = {{ calendar = \"{}\" }}", wrong),
                   "systemd-analyze calendar");
  expect_problem("schedule = \"now\"", "a table, headed [schedule]");
  expect_problem("stillness = { repeats = 2 }", "repeat_disturbed = true");
  expect_problem("retention = { age = \"0 d\" }", "age");
}

TEST(CampaignConfig, ChecksDevicesAgainstTheirDrivers) {
  const std::string head = "name = \"a\"\nfolder = \"f\"\nlength = \"2 h\"\n";
  const auto first = [&](const std::string& devices) {
    const auto found = problems_of(head + devices);
    return found.empty() ? "" : found.front();
  };
  const auto expect = [&](const std::string& devices, const std::string& words) {
    EXPECT_NE(first(devices).find(words), std::string::npos) << devices << ": " << first(devices);
  };
  expect("", "device: is missing; give a table headed [[device]]");
  expect("device = 3", "is a whole number; give tables");
  expect("device = []", "device: is empty");
  expect("[[device]]\n", "a.toml:4:1: device 1.driver: is missing");
  expect("[[device]]\ndriver = \"emulated\"\n", "options: device is missing");
  expect("[[device]]\ndriver = \"replay\"\noptions = { file = [1979-05-27] }", "is a date");
  expect("[[device]]\ndriver = \"emulated\"\noptions = { device = [\"can\", \"xsens\"] }",
         "takes one value");
  expect("[[device]]\ndriver = \"emulated\"\noptions = { device = \"can\", seed = -1 }",
         "out of bounds");
  expect(
      "[[device]]\ndriver = \"can\"\nname = \"x\"\noptions.interface = \"can0\"\n"
      "[[device]]\nname = \"x\"\ndriver = \"can\"\noptions.interface = \"can1\"\n",
      "a.toml:9:1: device 2.name: another device is 'x' already");
}

TEST(CampaignConfig, WhatIsNoTomlHasAPlaceToo) {
  const auto found = problems_of("name = \"a\"\nlength = \n");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().substr(0, 9), "a.toml:2:") << found.front();
}

// A parser calls itself for each level: 20,000 of them were a stack overflow.
TEST(CampaignConfig, DepthHasALimit) {
  const auto many = [](const std::string& part, int count) {
    std::string out;
    for (int i = 0; i < count; ++i) out += part;
    return out;
  };
  // What ends these texts for us ends them for the parser, too.
  const std::string texts =
      R"toml(t = ['''it''', "a\"", """a \""" """"", '''b''''', '', ""] # ")toml"
      "\n";
  EXPECT_NE(problem_with(texts).find("t: unknown"), std::string::npos);
  for (const std::string& deep :
       {"a" + many(".a", 20000) + " = 1", "[a" + many(" . a", 20000) + "]",
        "[[" + many("\"a\".", 20000) + "b]]", "a" + many(".'b'", 20000) + " = 1",
        texts + "a" + many(".a", 20000) + " = 1", "x = {y = {a" + many(".a", 20000) + " = 1}}"}) {
    const auto found = problems_of(deep);
    ASSERT_EQ(found.size(), 1U) << deep.substr(0, 100);
    EXPECT_NE(found.front().find("a key has more than 16 parts"), std::string::npos)
        << deep.substr(0, 100) << found.front();
  }
  EXPECT_EQ(problems_of("\n  b.a" + many(".a", 20000)).front().substr(0, 13), "a.toml:2:34: ");
  for (const std::string& deep : {"x = " + many("[", 20000), "x = " + many("{a = ", 20000)}) {
    const auto found = problems_of(deep);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NE(found.front().find("nested more than 16 deep"), std::string::npos) << found.front();
  }
  const std::string dots = many(".", 100);
  EXPECT_TRUE(problems_of("# " + dots + "\n" + kSound).empty());
  const std::string flat = "t = ['" + dots + "', \"" + dots + "\", '''\n" + dots + "'''" +
                           many(", 1.5", 40) + many(", [{a.b = 1}]", 40) + "]";
  EXPECT_NE(problem_with(flat).find("t: unknown"), std::string::npos);
}

TEST(CampaignConfig, FilesThatCannotBeRead) {
  const auto absent = read_campaign("absent.toml", known());
  ASSERT_FALSE(absent.has_value());
  EXPECT_NE(absent.error().message.find("absent.toml: cannot be read"), std::string::npos);
  EXPECT_FALSE(read_campaign(std::filesystem::temp_directory_path(), known()).has_value());
}

}  // namespace
}  // namespace imunoise::config
