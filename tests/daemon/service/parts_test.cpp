// What the service is made of, one by one: targets, hosts, tokens, rates, event queues, JSON.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "daemon/service/access/http_target.h"
#include "daemon/service/access/origin.h"
#include "daemon/service/access/request_rate.h"
#include "daemon/service/access/tokens.h"
#include "daemon/service/api/json.h"
#include "daemon/service/campaigns/campaign_state.h"
#include "daemon/service/http/event_queue.h"
#include "daemon/service/http/listen_address.h"
#include "daemon/service/studies/study_store.h"
#include "imunoise/v1/service.pb.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::service {
namespace {

using Words = std::vector<std::string>;

TEST(Target, HasSegmentsAndAQuery) {
  const auto target =
      parse_target("/v1/recordings/b%C3%A4nk/2026-03-01T060000Z?a=1&b=x+y%26z&c&a=2");
  ASSERT_TRUE(target.has_value()) << target.error().message;
  EXPECT_EQ(target->segments, (Words{"v1", "recordings", "bänk", "2026-03-01T060000Z"}));
  const std::vector<std::pair<std::string, std::string>> query{
      {"a", "1"}, {"b", "x y&z"}, {"c", ""}, {"a", "2"}};
  EXPECT_EQ(target->query, query);
  EXPECT_TRUE(parse_target("/")->segments.empty());
  EXPECT_EQ(parse_target("/a?")->segments, Words{"a"});
}

TEST(Target, LetsNothingThroughThatLeadsElsewhere) {
  for (const char* const bad : {"",
                                "v1",
                                "http://localhost/v1",
                                "*",
                                "//",
                                "/v1//x",
                                "/v1/",
                                "/.",
                                "/..",
                                "/v1/../etc",
                                "/v1/%2e%2e/etc",
                                "/v1/%2E./etc",
                                "/v1/..%2fetc",
                                "/v1/%2fetc",
                                "/v1/a%5cb",
                                "/v1/a\\b",
                                "/v1/%00",
                                "/v1/a%0d%0ab",
                                "/v1/%c0%ae%c0%ae/",
                                "/v1/%ff",
                                "/v1/%ed%a0%80",
                                "/v1/%c2%85",
                                "/v1/%7f",
                                "/%",
                                "/%4",
                                "/%zz",
                                "/a#b",
                                "/a?x=%",
                                "/a?x=%ff",
                                "/a?=1"}) {
    EXPECT_FALSE(parse_target(bad).has_value()) << bad;
  }
  EXPECT_TRUE(parse_target("/" + std::string(4095, 'a')).has_value());
  EXPECT_FALSE(parse_target("/" + std::string(4096, 'a')).has_value());
  std::string deep;
  for (int i = 0; i < 33; ++i) deep += "/a";
  EXPECT_FALSE(parse_target(deep).has_value());
  EXPECT_TRUE(parse_target(deep.substr(2)).has_value());
  std::string many = "/?";
  for (int i = 0; i < 65; ++i) many += "a=1&";
  EXPECT_FALSE(parse_target(many).has_value());
  EXPECT_EQ(parse_target("/%252e%252e")->segments, Words{"%2e%2e"}) << "decoded once, no more";
}

TEST(Origin, KnowsItsOwnNamesAlone) {
  for (const char* const good :
       {"localhost", "LOCALHOST:8080", "127.0.0.1:1", "[::1]", "[::1]:8080"})
    EXPECT_TRUE(known_host(good, {})) << good;
  for (const char* const bad :
       {"", "evil.example", "localhost.evil.example", "localhost:80:90", "127.0.0.1.evil",
        "localhost:", "localhost:8080x", "[::1", "10.0.0.1"})
    EXPECT_FALSE(known_host(bad, {})) << bad;
  EXPECT_TRUE(known_host("bench:8080", {"Bench"}));
  EXPECT_FALSE(known_host("bench2", {"bench"}));
}

TEST(Origin, IsThatOfTheHost) {
  EXPECT_TRUE(same_origin("", "localhost"));
  EXPECT_TRUE(same_origin("http://localhost:8080", "localhost:8080"));
  EXPECT_TRUE(same_origin("https://Localhost:8080", "localhost:8080"));
  for (const char* const bad :
       {"null", "http://evil.example", "http://localhost", "http://localhost:81",
        "ftp://localhost:8080", "http://localhost:8080.evil", "localhost:8080"})
    EXPECT_FALSE(same_origin(bad, "localhost:8080")) << bad;
}

TEST(ListenAddress, IsLoopback) {
  EXPECT_EQ(parse_listen("127.0.0.1:8080")->port, 8080);
  EXPECT_TRUE(parse_listen("[::1]:1")->six);
  EXPECT_EQ(parse_listen("localhost:0")->port, 0);
  for (const char* const bad :
       {"", "8080", "0.0.0.0:8080", "[::]:8080", "192.168.0.1:80", "127.0.0.1",
        "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:65536", "::1:8080"})
    EXPECT_FALSE(parse_listen(bad).has_value()) << bad;
}

const std::string kViewer(32, 'v');
const std::string kOperator(40, 'o');

TEST(Tokens, HaveRoles) {
  const auto tokens = Tokens::parse("# people\nviewer " + kViewer + " of the page\n\n  operator\t" +
                                    kOperator + " # anna\n");
  ASSERT_TRUE(tokens.has_value()) << tokens.error().message;
  EXPECT_EQ(tokens->role_of(kViewer), v1::viewer);
  EXPECT_EQ(tokens->role_of(kOperator), v1::operator_);
  for (const std::string& bad :
       {std::string(), kViewer.substr(1), kViewer + "v", "w" + kViewer.substr(1),
        kViewer.substr(1) + "w", std::string(32, '\0')})
    EXPECT_FALSE(tokens->role_of(bad).has_value()) << bad;
}

TEST(Tokens, WrongFilesAreRefusedWithoutTellingTokens) {
  const auto refuses = [](const std::string& text, const std::string& words) {
    const auto tokens = Tokens::parse(text);
    ASSERT_FALSE(tokens.has_value()) << text;
    EXPECT_NE(tokens.error().message.find(words), std::string::npos) << tokens.error().message;
    EXPECT_EQ(tokens.error().message.find("vvv"), std::string::npos) << tokens.error().message;
  };
  refuses("", "contains no token");
  refuses("viewer " + kViewer.substr(1), "1: a token has 32");
  refuses("viewer\n", "1: a token has 32");
  refuses("viewer " + kViewer + "\xc3\xa4\n", "1: a token has 32");
  refuses("\nadmin " + kViewer, "2: begin the line");
  refuses("viewer " + kViewer + "\noperator " + kViewer, "2: duplicate token; remove one");
}

TEST(Tokens, FilesThatOthersReadAreRefused) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "tokens";
  std::ofstream(file) << "viewer " << kViewer << "\n";
  for (const mode_t mode : {0600U, 0640U, 0400U}) {
    ::chmod(file.c_str(), mode);
    EXPECT_TRUE(Tokens::read(file).has_value()) << std::oct << mode;
  }
  for (const mode_t mode : {0644U, 0660U, 0601U}) {
    ::chmod(file.c_str(), mode);
    EXPECT_FALSE(Tokens::read(file).has_value()) << std::oct << mode;
  }
  EXPECT_FALSE(Tokens::read(folder.path() / "absent").has_value());
}

TEST(Tokens, ComeAsBearers) {
  EXPECT_EQ(bearer_token("Bearer abc"), "abc");
  EXPECT_EQ(bearer_token("bearer abc"), "abc");
  for (const char* const bad : {"", "abc", "Basic abc", "Bearer", "Bearerabc"})
    EXPECT_FALSE(bearer_token(bad).has_value()) << bad;
}

TEST(RequestRate, IsOneForEachPeer) {
  RequestRate rate(10.0, 3.0);
  const RequestRate::Time begin{};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(rate.pass("a", begin));
  EXPECT_FALSE(rate.pass("a", begin));
  EXPECT_TRUE(rate.pass("b", begin));
  EXPECT_FALSE(rate.pass("a", begin + std::chrono::milliseconds(90)));
  EXPECT_TRUE(rate.pass("a", begin + std::chrono::milliseconds(200)));
  const auto later = begin + std::chrono::hours(1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(rate.pass("a", later));
  EXPECT_FALSE(rate.pass("a", later)) << "no more than the burst is saved up";
}

std::shared_ptr<const std::string> text(const std::string& words) {
  return std::make_shared<const std::string>(words);
}

TEST(EventQueue, KeepsOrderAndWakesItsReader) {
  EventQueue queue(3, 100);
  int woken = 0;
  queue.on_news([&] { ++woken; });
  queue.push(text("a"));
  queue.push(text("b"));
  EXPECT_EQ(woken, 2);
  EXPECT_EQ(queue.take().text, "ab");
  EXPECT_EQ(queue.take().text, "");
  queue.close();
  EXPECT_FALSE(queue.open());
  queue.push(text("c"));
  EXPECT_EQ(woken, 2);
  const auto taken = queue.take();
  EXPECT_TRUE(taken.ended && !taken.overflow && taken.text.empty());
}

TEST(EventQueue, EndsWhenItsReaderIsTooSlow) {
  EventQueue many(2, 100);
  for (int i = 0; i < 2; ++i) many.push(text("x"));
  EXPECT_TRUE(many.open());
  many.push(text("x"));
  EXPECT_TRUE(many.take().overflow);
  EventQueue large(100, 10);
  large.push(text(std::string(10, 'x')));
  EXPECT_TRUE(large.open());
  large.push(text("x"));
  EXPECT_FALSE(large.open());
}

class Requests : public ::testing::Test {
 protected:
  Result<std::unique_ptr<google::protobuf::Message>> request(const std::string& verb,
                                                             const std::string& path,
                                                             const std::string& body = "") const {
    const Target target = parse_target(path).value();
    const Found found = routes_.find(verb, target);
    EXPECT_NE(found.route, nullptr) << path;
    return request_of(*found.route, found.fields, target.query, body);
  }
  void refuses(const std::string& verb, const std::string& path, const std::string& body,
               const std::string& words) const {
    const auto done = request(verb, path, body);
    ASSERT_FALSE(done.has_value()) << path << body;
    EXPECT_NE(done.error().message.find(words), std::string::npos) << done.error().message;
  }
  Routes routes_{*v1::Refusal::descriptor()->file()};
};

TEST_F(Requests, TakeTheirFieldsFromPathQueryAndBody) {
  const auto recording = request("GET", "/v1/recordings/array/2026/x");
  EXPECT_EQ((*recording)->ShortDebugString(), "campaign: \"array\" folder: \"2026/x\"");
  const auto history = request("GET", "/v1/history?device=7&channel=a&channel=b&level=0.05");
  EXPECT_EQ((*history)->ShortDebugString(),
            "device: \"7\" channel: \"a\" channel: \"b\" level: 0.05");
  const auto add = request("POST", "/v1/studies/s/add", R"({"term": "QN", "branch_from": 2})");
  EXPECT_EQ((*add)->ShortDebugString(), "study: \"s\" term: \"QN\" branch_from: 2");
  EXPECT_EQ((*request("DELETE", "/v1/studies/s"))->ShortDebugString(), "study: \"s\"");
  EXPECT_TRUE(request("POST", "/v1/studies/s/undo").has_value());
  EXPECT_TRUE(request("POST", "/v1/studies/s/undo", R"({"study": "s"})").has_value());
}

TEST_F(Requests, RefuseWhatTheyDoNotKnow) {
  refuses("GET", "/v1/history?devise=7", "", "'devise' is unknown; there are device, channel");
  refuses("GET", "/v1/campaigns?x=1", "", "there are none");
  refuses("GET", "/v1/history?level=nan", "", "level");
  refuses("GET", "/v1/history?level=1x", "", "level");
  refuses("GET", "/v1/history", "{}", "not a body");
  refuses("POST", "/v1/studies/s/undo?wait_s=1", "", "not a query");
  refuses("POST", "/v1/studies/s/undo", "{", "body");
  refuses("POST", "/v1/studies/s/undo", "[]", "body");
  refuses("POST", "/v1/studies/s/undo", R"({"wait": 1})", "wait");
  refuses("POST", "/v1/studies/s/undo", R"({"study": "t"})", "the path says 's', the body 't'");
}

TEST_F(Requests, FindTheirRoutes) {
  const auto find = [&](const char* verb, const char* path) {
    return routes_.find(verb, parse_target(path).value());
  };
  EXPECT_EQ(find("GET", "/v1/campaigns/a").route->path, "/v1/campaigns/{campaign}");
  EXPECT_EQ(find("PUT", "/v1/campaigns/a").allowed, "GET");
  EXPECT_EQ(find("GET", "/v1/studies").allowed, "GET");
  EXPECT_EQ(find("DELETE", "/v1/studies").allowed, "GET, POST");
  EXPECT_EQ(find("POST", "/v1/studies/s").allowed, "GET, DELETE");
  for (const char* const absent :
       {"/", "/v1", "/v1/campaigns/a/b", "/v1/recordings/a", "/v2/campaigns"})
    EXPECT_EQ(find("GET", absent).allowed, "") << absent;
}

// Whatever a job that read it before then makes of it.
TEST(StudyStore, ADeletedStudyDoesNotComeBack) {
  const testing::TemporaryFolder folder;
  recording::DiskCalls calls;
  StudyStore studies(folder.path() / "studies", calls);
  ASSERT_TRUE(studies.create("s", {}).has_value());
  EXPECT_EQ(studies.create("s", {}).error().message, "a study of this name exists");
  EXPECT_TRUE(studies.replace("s", {}).has_value());
  ASSERT_TRUE(studies.remove("s").has_value());
  EXPECT_EQ(studies.remove("s").error().status, 404U);
  EXPECT_EQ(studies.replace("s", {}).error().message,
            "the study was deleted while the command ran");
  EXPECT_FALSE(studies.contains("s"));
}

class TimeLeft : public ::testing::Test {
 protected:
  TimeLeft() {
    control_.running = true;
    control_.campaign.set_replicates(3);
    control_.campaign.set_length_s(100);
    control_.campaign.set_pause_s(10);
    control_.campaign.set_settling_s(30);
  }
  v1::CampaignState at(double seconds) const {
    return campaign_state(control_, static_cast<std::int64_t>(seconds * 1e9));
  }
  CampaignSnapshot control_;
};

TEST_F(TimeLeft, CountsReplicatesAndPauses) {
  control_.status.set_phase(v1::recording);
  control_.status.set_recording("data/array/2026-03-01T060000Z");
  control_.status.set_replicate(2);
  control_.status.set_since_ns(1'000'000'000'000);
  EXPECT_DOUBLE_EQ(at(1000).left_s(), 100 + 10 + 100);
  EXPECT_DOUBLE_EQ(at(1000).progress(), 1.0 - 210.0 / 350.0);
  EXPECT_DOUBLE_EQ(at(1040).left_s(), 60 + 10 + 100);
  EXPECT_DOUBLE_EQ(at(2000).left_s(), 10 + 100) << "it takes longer than it was meant to";
  EXPECT_EQ(at(1000).recording(), "2026-03-01T060000Z");
  control_.status.set_replicate(3);
  EXPECT_DOUBLE_EQ(at(1040).left_s(), 60);
  control_.running = false;
  EXPECT_FALSE(at(1040).has_left_s());
  EXPECT_EQ(at(1040).recording(), "");
}

TEST_F(TimeLeft, IsUnknownWhileItWaits) {
  control_.status.set_phase(v1::settling);
  control_.status.set_until_ns(1'020'000'000'000);
  EXPECT_DOUBLE_EQ(at(1000).left_s(), 20 + 320);
  control_.status.set_recording("data/array/2026-03-01T060000Z");
  EXPECT_FALSE(at(1000).has_left_s()) << "some replicates are there already";
  for (const auto phase : {v1::waiting, v1::held_up, v1::pausing, v1::finished}) {
    control_.status.set_phase(phase);
    EXPECT_FALSE(at(1000).has_left_s() || at(1000).has_progress());
  }
}

}  // namespace
}  // namespace imunoise::service
