// Attempts on the API, and what happens. docs/api.md has the table.

#include <filesystem>
#include <fstream>

#include "daemon/service/api/routes.h"
#include "daemon/service/recordings/confined_files.h"
#include "imunoise/v1/service.pb.h"
#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

namespace fs = std::filesystem;
using testing::RawClient;
using testing::RawResponse;
using testing::Where;

class Security : public testing::Served {
 protected:
  std::string bearer(const std::string& token) const { return "Authorization: Bearer " + token; }
};

// A target that fits the route; what it names is not there.
std::string example(const service::Route& route) {
  std::string out;
  for (const service::PathPart& part : route.parts) out += "/" + (part.field ? "none" : part.name);
  return out;
}

TEST_F(Security, RolesDecideWhoMayCallWhat) {
  serve();
  const service::Routes routes(*v1::Refusal::descriptor()->file());
  for (const service::Route& route : routes.all()) {
    const auto status = [&](const Where& where, const std::vector<std::string>& headers) {
      std::vector<std::string> all = headers;
      all.emplace_back("Content-Type: application/json");
      const std::string body = route.verb == "POST" ? "{}" : "";
      return testing::send_one(where, testing::request_text(route.verb, example(route), all, body))
          .status;
    };
    const bool open = route.http.role() == v1::anyone;
    const bool look = open || route.http.role() == v1::viewer;
    const auto let_in = [](int code) { return code != 0 && code != 401 && code != 403; };
    EXPECT_EQ(let_in(status(tcp_, {})), open) << route.path;
    EXPECT_EQ(status(tcp_, {}) == 401, !open) << route.path;
    EXPECT_EQ(status(tcp_, {bearer(std::string(32, 'x'))}) == 401, !open) << route.path;
    EXPECT_EQ(status(tcp_, {"Authorization: Basic " + kOperator}) == 401, !open) << route.path;
    EXPECT_EQ(let_in(status(tcp_, {bearer(kViewer)})), look) << route.path;
    EXPECT_EQ(status(tcp_, {bearer(kViewer)}) == 403, !look) << route.path;
    EXPECT_TRUE(let_in(status(tcp_, {bearer(kOperator)}))) << route.path;
    EXPECT_TRUE(let_in(status(local_, {}))) << route.path;
  }
}

TEST_F(Security, NoTokenChangesNothing) {
  serve();
  const RawResponse response = testing::post(tcp_, "/v1/campaigns/array/stop");
  EXPECT_EQ(response.status, 401);
  EXPECT_NE(response.head.find("WWW-Authenticate: Bearer"), std::string::npos);
  EXPECT_EQ(testing::post(tcp_, "/v1/campaigns/array/stop", "{}", {bearer(kViewer)}).status, 403);
  EXPECT_EQ(control_.asked(), "");
  EXPECT_EQ(testing::post(tcp_, "/v1/campaigns/array/stop", "{}", {bearer(kOperator)}).status, 200);
  EXPECT_EQ(control_.asked(), "stop array \n");
}

TEST_F(Security, TcpWithoutTokensIsNotServed) {
  options_.tokens.reset();
  auto started = service::Service::start(options_, {control_, drivers_, calls_});
  ASSERT_FALSE(started.has_value());
  EXPECT_NE(started.error().message.find("--tokens"), std::string::npos);
  EXPECT_FALSE(fs::exists(*options_.listen.socket));
}

TEST_F(Security, PagesOfOtherSitesAreRefused) {
  options_.hosts = {"bench.example"};
  serve();
  for (const Where& where : {local_, tcp_}) {
    const auto status = [&](const std::vector<std::string>& headers) {
      std::vector<std::string> all = headers;
      all.push_back(bearer(kOperator));
      return testing::get(where, "/v1/campaigns", all).status;
    };
    EXPECT_EQ(status({"Host: evil.example"}), 403);
    EXPECT_EQ(status({"Host: "}), 403);
    EXPECT_EQ(status({"Origin: http://evil.example"}), 403);
    EXPECT_EQ(status({"Origin: null"}), 403);
    EXPECT_EQ(status({"Host: localhost:8080", "Origin: http://localhost:3000"}), 403);
    EXPECT_EQ(status({"Host: localhost:8080", "Origin: http://localhost:8080"}), 200);
    EXPECT_EQ(status({"Host: bench.example"}), 200);
  }
  EXPECT_EQ(testing::get(tcp_, "/healthz", {"Host: evil.example"}).status, 403);
  EXPECT_EQ(testing::send_one(local_, "GET /healthz HTTP/1.0\r\n\r\n").status, 403)
      << "no Host at all";
}

TEST_F(Security, AFormOfAPageIsNoRequest) {
  serve();
  for (const char* const type :
       {"Content-Type: text/plain", "Content-Type: application/x-www-form-urlencoded", "X: y"}) {
    EXPECT_EQ(testing::send_one(local_, testing::request_text("POST", "/v1/campaigns/array/stop",
                                                              {type}, R"({"recording":""})"))
                  .status,
              415)
        << type;
  }
  EXPECT_EQ(testing::get(local_, "/v1/campaigns/array/stop").status, 405)
      << "a link changes nothing";
  EXPECT_EQ(control_.asked(), "");
}

TEST_F(Security, PathsLeadNowhereElse) {
  record("monday");
  std::ofstream(folder_.path() / "data/manifest.json") << "{\"version\": 1}";
  fs::create_directories(folder_.path() / "data/secret");
  std::ofstream(folder_.path() / "data/secret/manifest.json") << "{\"version\": 1}";
  serve();
  for (const char* const path :
       {"..", "../secret", "%2e%2e", "%2e%2e/secret", "..%2fsecret", "%2e%2e%2fsecret",
        "monday/../../secret", "./monday", "monday/.", "%2fetc", "..%5csecret", "monday%00",
        "//etc", "%252e%252e/secret"}) {
    for (const char* const resource : {"recordings", "calibrations", "arrays"}) {
      const RawResponse response =
          testing::get(local_, std::string("/v1/") + resource + "/array/" + path);
      EXPECT_TRUE(response.status == 400 || response.status == 404) << path << response.body;
    }
  }
  for (const char* const folder : {"../secret", "/etc", "", ".", "..", "monday/../../secret",
                                   "monday/", "..\\secret", "../../data/secret"}) {
    const RawResponse response =
        testing::post(local_, "/v1/studies",
                      json({{"study", "s"}, {"campaign", "array"}, {"folder", folder}}).dump());
    EXPECT_TRUE(response.status == 400 || response.status == 404) << folder << response.body;
  }
  for (const char* const name : {"..%2fs", "%2e%2e", "s%2f..%2f..%2fx"})
    EXPECT_EQ(testing::get(local_, std::string("/v1/studies/") + name).status, 400) << name;
  EXPECT_EQ(get_json("/v1/recordings/array/monday")["version"], 2) << "the way there is open";
}

TEST_F(Security, LinksInTheDataFolderAreNotFollowed) {
  record("monday");
  const fs::path data = folder_.path() / "data";
  fs::create_directories(data / "secret");
  std::ofstream(data / "secret/manifest.json") << R"({"version": 1, "campaign": "secret"})";
  fs::create_directory_symlink(data / "secret", data / "array/link");
  fs::create_directories(data / "array/file");
  fs::create_symlink(data / "secret/manifest.json", data / "array/file/manifest.json");
  fs::create_directories(data / "array/twice");
  fs::create_directory_symlink("../../array/monday", data / "array/twice/inside");
  fs::create_symlink("/etc/passwd", data / "array/monday/calibration.json");
  serve();
  ASSERT_EQ(get_json("/v1/recordings")["recordings"].size(), 1U);
  EXPECT_EQ(get_json("/v1/recordings")["recordings"][0]["folder"], "monday");
  for (const char* const name : {"link", "file", "twice/inside", "link/manifest.json"})
    refusal("/v1/recordings/array/" + std::string(name), 404);
  refusal("/v1/calibrations/array/monday", 404);
  EXPECT_FALSE(get_json("/v1/recordings")["recordings"][0]["calibrated"]);
  fs::create_directories(options_.studies);
  fs::create_symlink("/etc/passwd", options_.studies / "x.study");
  EXPECT_NE(refusal("/v1/studies/x", 500).find("no links in data folders"), std::string::npos);
}

TEST_F(Security, AStudyOfALinkedChunkIsRefused) {
  record("monday");
  const fs::path monday = folder_.path() / "data/array/monday";
  fs::path chunk;
  for (const auto& entry : fs::recursive_directory_iterator(monday / "replicate-1")) {
    if (entry.path().extension() == ".h5") chunk = entry.path();
  }
  ASSERT_FALSE(chunk.empty());
  fs::rename(chunk, folder_.path() / "elsewhere.h5");
  fs::create_symlink(folder_.path() / "elsewhere.h5", chunk);
  serve();
  const json job = post_json("/v1/studies", {{"study", "s"},
                                             {"campaign", "array"},
                                             {"folder", "monday"},
                                             {"channel", "gyro_x"},
                                             {"model", "WN"},
                                             {"wait_s", 8}});
  EXPECT_EQ(job["state"], "failed") << job;
}

TEST_F(Security, AGibibyteIsNotTaken) {
  serve();
  RawClient announced(tcp_);
  announced.send("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\n" + bearer(kOperator) +
                 "\r\nContent-Type: application/json\r\nContent-Length: 1073741824\r\n\r\n");
  EXPECT_EQ(announced.receive().status, 413);
  RawClient chunked(tcp_);
  chunked.send("POST /v1/studies HTTP/1.1\r\nHost: localhost\r\n" + bearer(kOperator) +
               "\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n");
  const std::string chunk = "10000\r\n" + std::string(65536, ' ') + "\r\n";
  std::size_t sent = 0;
  while (sent < (std::size_t{1} << 30U) && chunked.send(chunk)) sent += chunk.size();
  EXPECT_LT(sent, std::size_t{32} << 20U);
  EXPECT_EQ(testing::get(local_, "/healthz").status, 200);
}

TEST_F(Security, DeepJsonIsRefused) {
  serve();
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += R"({"study":)";
  EXPECT_EQ(testing::post(local_, "/v1/studies", deep).status, 400);
  EXPECT_EQ(testing::post(local_, "/v1/studies", std::string(100'000, '[')).status, 400);
}

TEST_F(Security, StrangersLeaveConnectionsToOthers) {
  serve();
  std::vector<RawClient> silent;
  for (std::size_t i = 0; i < options_.http.connections; ++i) silent.emplace_back(tcp_);
  EXPECT_EQ(testing::get(tcp_, "/v1/campaigns", {bearer(kViewer)}).status, 200);
  RawClient known(tcp_);
  const std::string request =
      testing::request_text("GET", "/v1/campaigns", {bearer(kViewer), "Connection: keep-alive"});
  known.send(request);
  EXPECT_EQ(known.receive().status, 200);
  for (std::size_t i = 0; i < options_.http.connections; ++i) silent.emplace_back(tcp_);
  known.send(request);
  EXPECT_EQ(known.receive().status, 200) << "who showed a token stays";
}

TEST_F(Security, StrangersLeaveRequestsToOthers) {
  options_.requests_per_second = 1.0;
  options_.burst = 5.0;
  serve();
  for (int i = 0; i < 10; ++i) testing::get(tcp_, "/healthz");
  EXPECT_EQ(testing::get(tcp_, "/healthz").status, 429);
  EXPECT_EQ(testing::get(tcp_, "/v1/campaigns", {bearer("guess" + kViewer)}).status, 429);
  EXPECT_EQ(testing::get(tcp_, "/v1/campaigns", {bearer(kViewer)}).status, 200);
}

TEST_F(Security, WhoAsksTooOftenWaits) {
  options_.requests_per_second = 1.0;
  options_.burst = 5.0;
  serve();
  int refused = 0;
  for (int i = 0; i < 10; ++i) refused += testing::get(tcp_, "/healthz").status == 429 ? 1 : 0;
  EXPECT_GE(refused, 4);
  EXPECT_EQ(testing::get(local_, "/healthz").status, 200) << "others are not refused";
}

TEST(ConfinedFiles, AreReadBeneathTheirFoldersOnly) {
  const testing::TemporaryFolder folder;
  const fs::path root = folder.path() / "root";
  fs::create_directories(root / "a");
  std::ofstream(root / "a/file") << "text";
  std::ofstream(folder.path() / "outside") << "secret";
  fs::create_symlink(folder.path() / "outside", root / "link");
  fs::create_directory_symlink(root / "a", root / "folder");
  fs::create_directory_symlink(root, folder.path() / "way");
  ASSERT_EQ(::mkfifo((root / "pipe").c_str(), 0600), 0);
  const auto files = service::confined_files({root, folder.path() / "way"});
  EXPECT_EQ(files->read(root / "a/file").value(), "text");
  EXPECT_EQ(files->read(folder.path() / "way/a/file").value(), "text")
      << "a link to the root itself";
  EXPECT_EQ(files->list(root).value(), (std::vector<std::string>{"a/", "pipe"}));
  EXPECT_EQ(files->list(root / "a").value(), std::vector<std::string>{"file"});
  for (const fs::path& bad :
       {root / "link", root / "folder/file", root / "../outside", root / "a/../../outside",
        folder.path() / "outside", root / "pipe", root / "a", root / "absent",
        folder.path() / "rootless", fs::path("/etc/passwd"), fs::path("a/file")})
    EXPECT_FALSE(files->read(bad).has_value()) << bad;
  EXPECT_FALSE(files->list(root / "folder").has_value());
  EXPECT_FALSE(files->create(root / "new").has_value());
  EXPECT_FALSE(files->remove(root / "a/file").has_value());
  EXPECT_FALSE(files->rename(root / "a/file", root / "b").has_value());
  EXPECT_FALSE(files->make_folder(root / "b").has_value());
  EXPECT_TRUE(fs::exists(root / "a/file"));
}

}  // namespace
}  // namespace imunoise
