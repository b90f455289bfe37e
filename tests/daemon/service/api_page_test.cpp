// What the page needs beside the other methods: figures, redo, files, sessions, its own files.

#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using ApiPage = testing::Served;
using testing::RawResponse;

std::string header_of(const RawResponse& response, const std::string& name) {
  const std::size_t at = response.head.find("\r\n" + name + ": ");
  if (at == std::string::npos) return "";
  const std::size_t from = at + name.size() + 4;
  return response.head.substr(from, response.head.find("\r\n", from) - from);
}

std::size_t count(const std::string& text, const std::string& words) {
  std::size_t out = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++out;
  return out;
}

TEST_F(ApiPage, FiguresAreDrawnOfEveryView) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const std::string figure = "/v1/studies/gyro/figure?view=";
  const RawResponse budget = testing::get(local_, figure + "averaging_times&width=640&height=420");
  EXPECT_EQ(budget.status, 200) << budget.body;
  EXPECT_EQ(header_of(budget, "Content-Type"), "image/svg+xml");
  EXPECT_NE(budget.body.find("width=\"640\" height=\"420\""), std::string::npos);
  EXPECT_NE(budget.body.find("data-term=\"WN\""), std::string::npos);
  EXPECT_NE(budget.body.find("Allan deviation, °/h"), std::string::npos);
  EXPECT_EQ(budget.body.find("style="), std::string::npos) << "the page's policy forbids it";
  for (const char* const view : {"spectrum", "time", "distribution", "replicates"})
    EXPECT_EQ(testing::get(local_, figure + view).status, 200) << view;
  EXPECT_NE(testing::get(local_, figure + "averaging_times&variance=true")
                .body.find("wavelet variance ν"),
            std::string::npos);
  EXPECT_NE(refusal(figure + "nothing", 400).find("averaging_times"), std::string::npos);
  refusal(figure + "spectrum&width=100", 400);
  refusal(figure + "spectrum&width=4001", 400);
  refusal(figure + "spectrum&attempt=1", 404);
  refusal(figure + "spectrum&ghost=QN", 404);
  refusal("/v1/studies/other/figure?view=spectrum", 404);
}

TEST_F(ApiPage, APreviewIsDrawnAsAGhost) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  ASSERT_EQ(finished("/v1/studies/gyro/preview", {{"term", "RW"}})["state"], "done");
  const std::string figure = "/v1/studies/gyro/figure?view=averaging_times";
  const std::string plain = testing::get(local_, figure).body;
  const RawResponse with = testing::get(local_, figure + "&ghost=RW");
  ASSERT_EQ(with.status, 200) << with.body;
  EXPECT_EQ(count(plain, "data-role=\"ghost\""), 0U);
  EXPECT_EQ(count(with.body, "data-role=\"ghost\""), 2U) << "the curve and what it leaves";
  const std::string in_si = testing::get(local_, figure + "&si=true").body;
  EXPECT_NE(in_si.find("Allan deviation, rad/s"), std::string::npos);
  EXPECT_EQ(in_si.find("°/h"), std::string::npos);
}

TEST_F(ApiPage, ClientsGetNoMeasurementsWithAStudy) {
  serve();
  record("monday");
  const json opened = open_study("gyro");
  const json study = get_json("/v1/studies/gyro");
  EXPECT_EQ(opened["result"]["attempts"], study["attempts"]);
  const json& picture = study["attempts"][0]["rung"]["picture"];
  EXPECT_FALSE(picture.contains("budget"));
  EXPECT_FALSE(picture.contains("compared"));
  EXPECT_EQ(picture["terms"][0]["name"], "WN") << picture;
}

TEST_F(ApiPage, WhatWasUndoneIsDoneAgain) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  EXPECT_EQ(finished("/v1/studies/gyro/redo", json::object())["state"], "failed");
  finished("/v1/studies/gyro/add", {{"term", "RW"}});
  finished("/v1/studies/gyro/undo", json::object());
  EXPECT_EQ(finished("/v1/studies/gyro/redo", json::object())["state"], "done");
  EXPECT_EQ(get_json("/v1/studies/gyro")["current"], 1);
  EXPECT_EQ(finished("/v1/studies/gyro/try", {{"model", "WN + QN"}})["state"], "done");
  EXPECT_EQ(get_json("/v1/studies/gyro")["current"], 2);
}

TEST_F(ApiPage, StudiesAreMadeOfFilesThatTheServiceWasStartedWith) {
  record("monday");
  v1::NamedInput input;
  input.set_name("runs");
  input.mutable_input()->add_files((folder_.path() / "data/array/monday").string());
  input.add_channels("gyro_x");
  options_.inputs = {input};
  serve();
  EXPECT_EQ(get_json("/v1/inputs")["inputs"][0]["channels"], json({"gyro_x"}));
  const json opened = finished(
      "/v1/studies", {{"study", "s"}, {"input", "runs"}, {"channel", "gyro_x"}, {"model", "WN"}});
  EXPECT_EQ(opened["state"], "done") << opened;
  EXPECT_NE(post_json("/v1/studies", {{"study", "t"}, {"input", "/etc"}}, 404)["error"]
                .get<std::string>()
                .find("GET /v1/inputs"),
            std::string::npos);
}

class ApiSession : public testing::Served {
 protected:
  RawResponse open(const std::string& token) const {
    return testing::post(tcp_, "/v1/session", json({{"token", token}}).dump());
  }
  static std::string cookie(const RawResponse& response) {
    const std::string whole = header_of(response, "Set-Cookie");
    return "Cookie: " + whole.substr(0, whole.find(';'));
  }
  json who(const std::vector<std::string>& headers) const {
    return json::parse(testing::get(tcp_, "/v1/session", headers).body);
  }
};

TEST_F(ApiSession, ATokenIsExchangedForACookieThatScriptsCannotRead) {
  serve();
  EXPECT_EQ(open(std::string(32, 'x')).status, 401);
  const RawResponse opened = open(kViewer);
  ASSERT_EQ(opened.status, 200) << opened.body;
  const std::string set = header_of(opened, "Set-Cookie");
  EXPECT_NE(set.find("; HttpOnly; SameSite=Strict"), std::string::npos) << set;
  EXPECT_EQ(set.find(kViewer), std::string::npos);
  EXPECT_EQ(testing::get(tcp_, "/v1/campaigns").status, 401);
  EXPECT_EQ(testing::get(tcp_, "/v1/campaigns", {cookie(opened)}).status, 200);
  EXPECT_EQ(testing::post(tcp_, "/v1/campaigns/array/start", "{}", {cookie(opened)}).status, 403);
  EXPECT_EQ(who({cookie(opened)})["role"], "viewer");
  EXPECT_EQ(who({})["role"], "role_unspecified");
  EXPECT_EQ(who({cookie(opened) + "0"})["role"], "role_unspecified");
  EXPECT_EQ(who({cookie(open(kOperator))})["role"], "operator");
}

TEST_F(ApiSession, AnInvitationIsGoodForOneSession) {
  options_.tokens.reset();
  options_.by_invitation = true;
  serve();
  const std::string token = service_->invite();
  const RawResponse first = open(token);
  EXPECT_EQ(first.status, 200);
  EXPECT_EQ(open(token).status, 401);
  EXPECT_EQ(who({cookie(first)})["role"], "operator");
  EXPECT_NE(service_->invite(), token);
}

}  // namespace
}  // namespace imunoise
