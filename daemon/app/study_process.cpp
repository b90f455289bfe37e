#include "daemon/app/study_process.h"

#include <google/protobuf/util/json_util.h>

#include <istream>
#include <iterator>
#include <mutex>
#include <ostream>
#include <utility>

#include "core/support/memory.h"
#include "daemon/process/program.h"
#include "study/report/json.h"

namespace imunoise::app {
namespace {

using google::protobuf::util::JsonStringToMessage;

constexpr double kStep = 0.002;  // of progress, that is worth a line

// From any thread.
class Reports {
 public:
  explicit Reports(std::ostream& out) : out_(out) {}

  void say(const v1::JobReport& report) {
    const std::lock_guard lock(mutex_);
    write(report);
  }
  void progress(double fraction) {
    const std::lock_guard lock(mutex_);
    if (fraction < told_ + kStep) return;
    told_ = fraction;
    v1::JobReport report;
    report.set_progress(fraction);
    write(report);
  }

 private:
  void write(const v1::JobReport& report) {
    out_ << report::to_json(report, report::JsonLayout::kOneLine) << "\n" << std::flush;
  }

  std::ostream& out_;
  std::mutex mutex_;
  double told_ = 0.0;
};

}  // namespace

int compute_for_parent(std::istream& in, std::ostream& out) {
  keep_freed_memory();
  const std::string text(std::istreambuf_iterator<char>(in), {});
  v1::JobOrder order;
  if (!JsonStringToMessage(text, &order).ok()) return 2;
  Reports reports(out);
  auto result =
      service::compute_here(order, Progress([&](double fraction) { reports.progress(fraction); }));
  v1::JobReport report;
  if (result) {
    *report.mutable_result() = std::move(*result);
  } else {
    report.set_error(result.error().message);
  }
  reports.say(report);
  return 0;
}

service::ComputeStudy compute_in_child(recording::DiskCalls& calls,
                                       std::vector<std::string> command) {
  return [&calls, command = std::move(command)](const v1::JobOrder& order,
                                                const Progress& progress) -> Result<v1::Study> {
    Result<v1::Study> out = fail("it ended without a message");
    const auto hear = [&](std::string_view line) {
      v1::JobReport report;
      if (!JsonStringToMessage({line.data(), line.size()}, &report).ok()) return;
      if (report.has_progress()) progress.report(report.progress());
      if (report.has_error()) out = fail(report.error());
      if (report.has_result()) out = std::move(*report.mutable_result());
    };
    recording::DiskCalls::Watch watch(calls, "computation on a study", order.cache());
    const process::Talk talk{report::to_json(order, report::JsonLayout::kOneLine), hear,
                             [&] { watch.progress(); }};
    const auto done = process::run_program(command, progress, talk);
    if (!done) return fail("the process that computed it: " + done.error().message);
    return out;
  };
}

}  // namespace imunoise::app
