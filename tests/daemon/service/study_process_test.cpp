// Studies computed by imunoised as a child, and children that go wrong.

#include "daemon/app/study_process.h"

#include <google/protobuf/util/message_differencer.h>

#include <atomic>
#include <sstream>

#include "tests/daemon/service/served.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;

const std::vector<std::string> kProgram = {IMUNOISED, app::kComputeWord};

class StudyProcess : public testing::Served {
 protected:
  v1::JobOrder opening() const {
    v1::JobOrder out;
    const auto folder = folder_.path() / "data/array";
    out.add_folders(folder.string());
    v1::StudyRequest::Open& open = *out.mutable_request()->mutable_open();
    open.mutable_input()->add_files((folder / "monday").string());
    open.set_channel("gyro_x");
    open.set_model("WN");
    return out;
  }
  // The job that opens a study over the API.
  json opened(std::vector<std::string> command) {
    options_.compute = app::compute_in_child(calls_, std::move(command));
    serve();
    return open_study("s");
  }
};

TEST_F(StudyProcess, ComesToTheSameAsHere) {
  record("monday");
  std::atomic<int> told = 0;
  const auto there =
      app::compute_in_child(calls_, kProgram)(opening(), Progress([&](double) { ++told; }));
  const auto here = service::compute_here(opening(), {});
  ASSERT_TRUE(there.has_value()) << there.error().message;
  ASSERT_TRUE(here.has_value()) << here.error().message;
  EXPECT_TRUE(google::protobuf::util::MessageDifferencer::Equals(*there, *here));
  EXPECT_GT(told, 0);

  v1::JobOrder wrong = opening();
  wrong.mutable_request()->mutable_open()->set_channel("gyro_w");
  EXPECT_EQ(app::compute_in_child(calls_, kProgram)(wrong, {}).error().message,
            service::compute_here(wrong, {}).error().message);
}

TEST_F(StudyProcess, ReadsNothingOutsideItsFolders) {
  record("monday");
  v1::JobOrder order = opening();
  order.set_folders(0, (folder_.path() / "data/other").string());
  EXPECT_FALSE(app::compute_in_child(calls_, kProgram)(order, {}).has_value());
  const auto cache = folder_.path() / "cache";
  EXPECT_FALSE(std::filesystem::exists(cache));

  // Not even what a recording showed before.
  v1::JobOrder adding = opening();
  adding.set_cache(cache.string());
  *adding.mutable_study() = service::compute_here(adding, {}).value();
  EXPECT_FALSE(std::filesystem::is_empty(cache));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "data/array/monday/.imunoise"));
  adding.mutable_request()->mutable_add()->set_term("RW");
  EXPECT_TRUE(app::compute_in_child(calls_, kProgram)(adding, {}).has_value());
  adding.set_folders(0, (folder_.path() / "data/other").string());
  EXPECT_FALSE(app::compute_in_child(calls_, kProgram)(adding, {}).has_value());
}

TEST_F(StudyProcess, EndsWhenItIsAsked) {
  record("monday");
  std::stop_source stop;
  v1::JobOrder order = opening();
  order.mutable_study()->CopyFrom(service::compute_here(order, {}).value());
  order.mutable_request()->mutable_candidates();
  const std::jthread stopper([&] {
    std::this_thread::sleep_for(100ms);
    stop.request_stop();
  });
  const auto begin = std::chrono::steady_clock::now();
  const auto done = app::compute_in_child(calls_, kProgram)(order, Progress({}, stop.get_token()));
  ASSERT_FALSE(done.has_value());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 2s);
}

TEST_F(StudyProcess, IsWhatAJobOfTheDaemonIs) {
  record("monday");
  const json job = opened(kProgram);
  EXPECT_EQ(job["state"], "done") << job;
  EXPECT_EQ(get_json("/v1/studies/s")["attempts"].size(), 1U);
}

TEST_F(StudyProcess, MayCrash) {
  record("monday");
  const json job = opened({"/bin/sh", "-c", "kill -KILL $$"});
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["error"], "the process that computed it: /bin/sh: ended by signal 9: ");
  refusal("/v1/studies/s", 404);
  EXPECT_EQ(get_json("/healthz")["status"], "ok");
}

TEST_F(StudyProcess, MayEndWithoutAWord) {
  record("monday");
  EXPECT_EQ(opened({"/bin/sh", "-c", "echo nonsense"})["error"], "it ended without a message");
}

TEST(StudyProcessItself, RefusesWhatIsNoOrder) {
  std::istringstream in("{]");
  std::ostringstream out;
  EXPECT_EQ(app::compute_for_parent(in, out), 2);
  EXPECT_EQ(out.str(), "");
}

}  // namespace
}  // namespace imunoise
