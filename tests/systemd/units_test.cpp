// The service as cmake --install puts it into an empty root: systemd's own tools judge it.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace imunoise {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status;
  std::string out;  // and errors
};

Outcome run(const std::string& command) {
  std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  Outcome out{};
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    out.out.append(buffer.data(), n);
  }
  out.status = WEXITSTATUS(pclose(pipe));
  return out;
}

std::string read(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Units : public ::testing::Test {
 protected:
  Units() : root_(fs::temp_directory_path() / ("imunoise_units_" + std::to_string(getpid()))) {
    fs::remove_all(root_);
  }
  ~Units() override { fs::remove_all(root_); }

  void SetUp() override {
    if (run("systemd-analyze --version").status != 0) GTEST_SKIP() << "SKIPPED: no systemd here";
    const Outcome done = run("DESTDIR='" + root_.string() +
                             "' '" IMUNOISE_CMAKE "' --install '" IMUNOISE_BINARY_DIR
                             "' --prefix /usr --component service");
    ASSERT_EQ(done.status, 0) << done.out;
    fs::create_directories(root_ / "etc");
  }
  fs::path unit(const std::string& name) const { return root_ / "usr/lib/systemd/system" / name; }
  Outcome in_root(const std::string& tool, const std::string& arguments) const {
    return run(tool + " --root='" + root_.string() + "' " + arguments);
  }

  fs::path root_;
};

TEST_F(Units, AreExposedAtMostOnePointFive) {
  for (const char* const name : {"imunoised.service", "imunoise-campaign@.service"}) {
    const Outcome done = run("systemd-analyze security --no-pager --offline=true --threshold=15 '" +
                             unit(name).string() + "'");
    EXPECT_EQ(done.status, 0) << done.out;
    EXPECT_NE(done.out.find("Overall exposure level"), std::string::npos) << done.out;
  }
}

TEST_F(Units, AreUnderstoodByTheServiceManager) {
  if (!fs::exists("/lib/systemd/system/sysinit.target")) {
    GTEST_SKIP() << "SKIPPED: systemd's own units are not here";
  }
  fs::copy("/lib/systemd/system", unit(""),
           fs::copy_options::recursive | fs::copy_options::skip_existing |
               fs::copy_options::copy_symlinks);
  const std::string service = read(unit("imunoised.service"));
  for (const std::string command : {"ExecStart=/", "ExecReload=/"}) {
    const std::size_t found = service.find(command);
    ASSERT_NE(found, std::string::npos) << command;
    const std::size_t begin = found + command.size();
    const fs::path program = root_ / service.substr(begin, service.find(' ', begin) - begin);
    fs::create_directories(program.parent_path());
    fs::copy("/bin/true", program);
  }
  const Outcome done =
      in_root("systemd-analyze verify",
              "imunoised.service imunoise-campaign@x.service imunoise-campaign@x.timer");
  EXPECT_EQ(done.status, 0) << done.out;
  EXPECT_EQ(done.out.find("imunoise"), std::string::npos) << done.out;  // unknown keys are warnings
}

TEST_F(Units, MakeTheirUserAndFolders) {
  ASSERT_EQ(in_root("systemd-sysusers", "").status, 0);
  EXPECT_NE(read(root_ / "etc/passwd").find("imunoise:"), std::string::npos);
  if (geteuid() != 0) GTEST_SKIP() << "SKIPPED: only root gives folders to others";
  const Outcome done = in_root("systemd-tmpfiles", "--create");
  EXPECT_EQ(done.status, 0) << done.out;
  EXPECT_TRUE(fs::is_directory(root_ / "etc/imunoise"));
  EXPECT_EQ(fs::status(root_ / "var/lib/imunoise").permissions(), fs::perms(0750));
}

TEST_F(Units, CalendarsOfTimerAndExamplesAreCalendars) {
  std::set<std::string> calendars;
  std::istringstream timer(read(unit("imunoise-campaign@.timer")));
  for (std::string line; std::getline(timer, line);) {
    if (line.starts_with("OnCalendar=")) calendars.insert(line.substr(11));
  }
  for (const auto& entry : fs::directory_iterator(root_ / "usr/share/doc/imunoise/examples")) {
    std::istringstream example(read(entry.path()));
    for (std::string line; std::getline(example, line);) {
      const std::size_t at = line.find("calendar = \"");
      if (at == std::string::npos) continue;
      calendars.insert(line.substr(at + 12, line.find('"', at + 12) - at - 12));
    }
  }
  EXPECT_GE(calendars.size(), 2U);
  for (const std::string& one : calendars) {
    EXPECT_EQ(run("systemd-analyze calendar '" + one + "'").status, 0) << one;
  }
}

// The lines of rules that match devices.
std::vector<std::string> matches_in(const fs::path& rules) {
  std::vector<std::string> out;
  std::istringstream lines(read(rules));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("SUBSYSTEM==")) out.push_back(line);
  }
  return out;
}

// Every device that a rule speaks of is left alone by ModemManager. What is installed takes no chip
// that other things are built of: their rules are an example, with a serial number.
TEST_F(Units, RulesKnowSensorsAndNoOtherThings) {
  const auto rules = matches_in(root_ / "usr/lib/udev/rules.d/60-imunoise.rules");
  const auto example =
      matches_in(root_ / "usr/share/doc/imunoise/examples/61-imunoise-bridge.rules");
  EXPECT_EQ(rules.size(), 4U);
  EXPECT_EQ(example.size(), 2U);
  for (const auto& list : {rules, example}) {
    for (const std::string& line : list)
      EXPECT_NE(line.find("ENV{ID_MM_DEVICE_IGNORE}=\"1\""), std::string::npos) << line;
  }
  for (const std::string& line : rules) {
    const bool maker = line.find("{idVendor}==\"2639\"") != std::string::npos;
    const bool its_range = line.find("{idProduct}==\"d38[8-9a-f]\"") != std::string::npos;
    EXPECT_TRUE(maker || its_range) << line << ": takes devices of others";
  }
  for (const std::string& line : example)
    EXPECT_NE(line.find("ATTR{serial}=="), std::string::npos) << line;
  const std::string all = example[0] + example[1];
  for (const char* const id : {"6010|6014", "\"10c4\"", "\"87a0\""})
    EXPECT_NE(all.find(id), std::string::npos) << id;
}

}  // namespace
}  // namespace imunoise
