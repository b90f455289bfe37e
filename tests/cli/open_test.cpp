// `imunoise open`: the page and its API for files, on this machine, for one browser.

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/daemon/service/raw_client.h"

namespace imunoise {
namespace {

using nlohmann::json;
using testing::RawResponse;

class Open : public testing::Program {
 protected:
  ~Open() override { end(); }

  // Starts it on files, and reads the address that it prints.
  void open(const std::string& arguments) {
    const std::string command =
        "cd '" + folder_.string() +
        "' && sh -c 'echo $$; exec \"$0\" open --no-browser --studies new/s " + arguments +
        " 2> stderr' '" IMUNOISE_BINARY "'";
    pipe_ = popen(command.c_str(), "r");
    ASSERT_NE(pipe_, nullptr);
    char line[512];
    ASSERT_NE(std::fgets(line, sizeof line, pipe_), nullptr);
    pid_ = std::stoi(line);
    ASSERT_NE(std::fgets(line, sizeof line, pipe_), nullptr) << read("stderr");
    url_ = line;
    const std::size_t colon = url_.rfind(':', url_.find('#'));
    where_.port = static_cast<std::uint16_t>(std::stoi(url_.substr(colon + 1)));
  }
  // As Ctrl-C does; the exit status.
  int end() {
    if (pipe_ == nullptr) return -1;
    ::kill(pid_, SIGINT);
    const int status = pclose(pipe_);
    pipe_ = nullptr;
    return WEXITSTATUS(status);
  }
  std::string token() const {
    const std::size_t at = url_.find("token=") + 6;
    return url_.substr(at, url_.find('\n') - at);
  }

  std::FILE* pipe_ = nullptr;
  pid_t pid_ = 0;
  std::string url_;
  testing::Where where_;
};

TEST_F(Open, ItsAddressLetsOneBrowserStudyTheFiles) {
  ASSERT_EQ(run("simulate --model 'WN(sigma2=1e-6)' --rate 50 --samples 2000 --replicates 2 "
                "--unit rad/s --channel gyro_x --out run.h5")
                .status,
            0);
  open("run_1.h5 run_2.h5");
  EXPECT_EQ(url_.rfind("http://127.0.0.1:", 0), 0U) << url_;
  EXPECT_EQ(testing::get(where_, "/v1/inputs").status, 401) << "nobody without the token";
  const std::string body = json({{"token", token()}}).dump();
  const RawResponse session = testing::post(where_, "/v1/session", body);
  ASSERT_EQ(session.status, 200) << session.body;
  EXPECT_EQ(json::parse(session.body)["bench"], false);
  EXPECT_EQ(testing::post(where_, "/v1/session", body).status, 401) << "once";

  const std::size_t at = session.head.find("Set-Cookie: ") + 12;
  const std::string cookie = "Cookie: " + session.head.substr(at, session.head.find(';', at) - at);
  const json input = json::parse(testing::get(where_, "/v1/inputs", {cookie}).body)["inputs"][0];
  EXPECT_EQ(input["input"]["files"].size(), 2U);
  EXPECT_EQ(input["channels"], json({"gyro_x"}));
  const json job = json::parse(testing::post(where_, "/v1/studies",
                                             json({{"study", "s"},
                                                   {"input", input["name"]},
                                                   {"channel", "gyro_x"},
                                                   {"model", "WN"},
                                                   {"wait_s", 8}})
                                                 .dump(),
                                             {cookie})
                                   .body);
  EXPECT_EQ(job["state"], "done") << job;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "new/s/s.study"));
  EXPECT_EQ(testing::get(where_, "/v1/studies/s/figure?view=averaging_times", {cookie}).status,
            200);
  EXPECT_EQ(end(), 0);
}

TEST_F(Open, FilesThatCannotBeReadAreToldAtOnce) {
  const testing::Outcome missing = run("open nothing.h5 --no-browser");
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.errors.find("nothing.h5"), std::string::npos) << missing.errors;
  const testing::Outcome study = run("open nothing.study --no-browser");
  EXPECT_EQ(study.status, 2);
  EXPECT_NE(study.errors.find("nothing.study"), std::string::npos) << study.errors;
}

}  // namespace
}  // namespace imunoise
