// The methods of the API that open, improve and delete studies, over a real socket.

#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using ApiStudies = testing::Served;

TEST_F(ApiStudies, AStudyIsOpenedImprovedAndTakenBack) {
  serve();
  record("monday");
  const json opened = open_study("gyro");
  ASSERT_EQ(opened["state"], "done") << opened;
  EXPECT_EQ(opened["result"]["channel"], "gyro_x");
  EXPECT_TRUE(opened["result"]["attempts"][0]["rung"].contains("unexplained"));

  const json preview = finished("/v1/studies/gyro/preview", {{"term", "RW"}});
  ASSERT_EQ(preview["state"], "done") << preview;
  EXPECT_EQ(preview["result"]["attempts"].size(), 2U);
  EXPECT_EQ(get_json("/v1/studies/gyro")["attempts"].size(), 1U) << "a preview is not kept";

  const json added = finished("/v1/studies/gyro/add", {{"term", "RW"}});
  ASSERT_EQ(added["state"], "done") << added;
  EXPECT_EQ(added["result"]["attempts"], preview["result"]["attempts"]);
  const json& attempts = added["result"]["attempts"];
  EXPECT_LT(attempts[1]["rung"]["unexplained"], attempts[0]["rung"]["unexplained"]);
  EXPECT_EQ(get_json("/v1/studies/gyro")["current"], 1);

  const json branched =
      post_json("/v1/studies/gyro/branch", {{"name", "other"}, {"from", 0}, {"wait_s", 8}});
  ASSERT_EQ(branched["state"], "done") << branched;
  EXPECT_EQ(get_json("/v1/studies/other")["current"], 0);

  const json undone = post_json("/v1/studies/gyro/undo", {{"wait_s", 8}});
  ASSERT_EQ(undone["state"], "done") << undone;
  EXPECT_EQ(get_json("/v1/studies/gyro")["current"], 0);
  EXPECT_TRUE(get_json("/v1/studies/gyro")["attempts"][1]["undone"]);
  EXPECT_EQ(post_json("/v1/studies/gyro/undo", {{"wait_s", 8}})["state"], "failed");

  const json all = get_json("/v1/studies");
  ASSERT_EQ(all["studies"].size(), 2U);
  EXPECT_EQ(all["studies"][0]["study"], "gyro");
  EXPECT_EQ(all["studies"][0]["model"], "WN");
  EXPECT_EQ(all["studies"][0]["attempts"], 2);
  EXPECT_EQ(get_json("/v1/jobs")["jobs"].size(), 6U);
}

TEST_F(ApiStudies, CandidatesAreSoughtInTheBackground) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const json begun = post_json("/v1/studies/gyro/candidates", json::object(), 202);
  EXPECT_EQ(begun["operation"], "candidates");
  const json job = job_over(begun["job"]);
  ASSERT_EQ(job["state"], "done") << job["error"];
  EXPECT_EQ(job["progress"], 1);
  EXPECT_EQ(get_json("/v1/studies/gyro")["diagnosis"]["verdict"],
            job["result"]["diagnosis"]["verdict"]);
  EXPECT_EQ(job["result"]["diagnosis"]["verdict"], "found")
      << job["result"]["diagnosis"]["summary"];
}

TEST_F(ApiStudies, JobsAreCancelled) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  const json first = post_json("/v1/studies/gyro/candidates", json::object(), 202);
  const json second = post_json("/v1/studies/gyro/candidates", json::object(), 202);
  EXPECT_EQ(post_json("/v1/jobs/" + second["job"].get<std::string>() + "/cancel",
                      json::object())["state"],
            "cancelled");
  testing::post(local_, "/v1/jobs/" + first["job"].get<std::string>() + "/cancel");
  const std::string state = job_over(first["job"])["state"];
  EXPECT_EQ(state, "cancelled");
  EXPECT_FALSE(get_json("/v1/studies/gyro").contains("diagnosis"));
  post_json("/v1/jobs/job-99/cancel", json::object(), 404);
  refusal("/v1/jobs/job-99", 404);
}

TEST_F(ApiStudies, OnlySoManyJobsWait) {
  options_.waiting_jobs = 2;
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  int refused = 0;
  for (int i = 0; i < 6; ++i) {
    refused += testing::post(local_, "/v1/studies/gyro/candidates").status == 503 ? 1 : 0;
  }
  EXPECT_GE(refused, 3) << "one works, two wait";
}

TEST_F(ApiStudies, StudiesThatCannotBe) {
  serve();
  record("monday");
  const auto open = [&](json body, int status) {
    json all = {{"study", "s"},  {"campaign", "array"}, {"folder", "monday"},
                {"model", "WN"}, {"channel", "gyro_x"}, {"wait_s", 8}};
    all.update(body);
    const json done = post_json("/v1/studies", all, status);
    return done.value("error", "");
  };
  open({{"study", ""}}, 400);
  open({{"study", "../s"}}, 400);
  open({{"study", ".s"}}, 400);
  open({{"study", std::string(65, 's')}}, 400);
  open({{"folder", "sunday"}}, 404);
  open({{"campaign", "x"}}, 404);
  open({{"wait_s", 9}}, 400);
  open({{"wait_s", -1}}, 400);
  EXPECT_NE(open({{"channel", "gyro_w"}}, 200).find("it has: gyro_x"), std::string::npos);
  EXPECT_NE(open({{"model", "WM"}}, 200).find("WM"), std::string::npos);
  refusal("/v1/studies/s", 404);
  refusal("/v1/studies/.s", 400);
  post_json("/v1/studies/s/add", {{"term", "QN"}}, 404);
  EXPECT_TRUE(get_json("/v1/studies")["studies"].empty());
}

TEST_F(ApiStudies, LargeRecordingsAreStudiedElsewhere) {
  options_.largest_study = 1000;
  serve();
  record("monday");
  const json refused =
      post_json("/v1/studies", {{"study", "s"}, {"campaign", "array"}, {"folder", "monday"}}, 409);
  const std::string error = refused["error"];
  EXPECT_NE(error.find("imunoise study on another machine"), std::string::npos) << error;
}

TEST_F(ApiStudies, ANameIsTakenOnce) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  EXPECT_EQ(
      post_json("/v1/studies", {{"study", "gyro"}, {"campaign", "array"}, {"folder", "monday"}},
                409)["error"],
      "study 'gyro' exists; choose another name");
  post_json("/v1/studies/gyro/branch", {{"name", "gyro"}}, 409);
  EXPECT_EQ(
      post_json("/v1/studies/gyro/branch", {{"name", "b"}, {"from", 7}, {"wait_s", 8}})["error"],
      "attempt 7: there are 1, counted from 0");
}

TEST_F(ApiStudies, AStudyIsDeletedForGood) {
  serve();
  record("monday");
  ASSERT_EQ(open_study("gyro")["state"], "done");
  EXPECT_TRUE(delete_json("/v1/studies/gyro").empty());
  refusal("/v1/studies/gyro", 404);
  EXPECT_TRUE(get_json("/v1/studies")["studies"].empty());
  EXPECT_EQ(delete_json("/v1/studies/gyro", 404)["error"], "there is no study 'gyro'");
  delete_json("/v1/studies/.s", 400);
  delete_json("/v1/jobs/job-1", 405);
  EXPECT_EQ(open_study("gyro")["state"], "done") << "the name is free again";
}

TEST_F(ApiStudies, ADamagedStudyCanBeDeletedAndALinkTakesNothingWithIt) {
  serve();
  std::filesystem::create_directories(options_.studies);
  const auto outside = folder_.path() / "outside";
  std::ofstream(outside) << "{";
  std::filesystem::create_symlink(outside, options_.studies / "link.study");
  std::ofstream(options_.studies / "damaged.study") << "{";
  for (const char* const name : {"link", "damaged"}) {
    refusal(std::string("/v1/studies/") + name, 500);
    delete_json(std::string("/v1/studies/") + name);
  }
  EXPECT_TRUE(std::filesystem::is_empty(options_.studies));
  EXPECT_TRUE(std::filesystem::exists(outside));
}

}  // namespace
}  // namespace imunoise
