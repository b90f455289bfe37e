#include "daemon/service/studies/study_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <semaphore>

#include "daemon/config/quantity_text.h"
#include "daemon/service/studies/study_pictures.h"
#include "study/report/documents/inference_documents.h"

namespace imunoise::service {
namespace {

constexpr std::ptrdiff_t kMostWaiting = 2;  // responses that wait for a job; threads are few
constexpr double kLongestWait = 8.0;        // s

class StudyMethods {
 public:
  StudyMethods(const StudySubjects& subjects, std::uint64_t largest_recording, ComputeStudy compute)
      : jobs_(subjects.jobs),
        studies_(subjects.studies),
        records_(subjects.records),
        inputs_(subjects.inputs),
        largest_(largest_recording),
        compute_(std::move(compute)) {}

  Answer<v1::Job> open(const v1::OpenStudyRequest& request) {
    if (auto good = check_new(request.study()); !good) return tl::unexpected(good.error());
    auto input = input_of(request);
    if (!input) return tl::unexpected(input.error());
    v1::StudyRequest asked;
    v1::StudyRequest::Open& open = *asked.mutable_open();
    *open.mutable_input() = std::move(*input);
    open.set_channel(request.channel());
    *open.mutable_witnesses() = request.witnesses();
    open.set_model(request.model());
    const auto work = [this, name = request.study(), asked](const Progress& progress) {
      return kept(name, compute({}, asked, progress), &StudyStore::create);
    };
    return begun("open", request.study(), work, request.wait_s());
  }

  // A request on a study that is there.
  Answer<v1::Job> change(const std::string& operation, const std::string& name,
                         const v1::StudyRequest& asked, bool keep, double wait_s) {
    if (auto study = studies_.read(name); !study) return tl::unexpected(study.error());
    const auto work = [this, name, asked, keep](const Progress& progress) -> Result<v1::Study> {
      auto study = studies_.read(name);
      if (!study) return fail(study.error().sentence);
      auto out = compute(std::move(*study), asked, progress);
      if (keep || !out) return kept(name, std::move(out), &StudyStore::replace);
      pictures_.keep_preview(name, *out);
      return without_pictures(std::move(*out));
    };
    return begun(operation, name, work, wait_s);
  }

  Answer<v1::Job> branch(const v1::BranchStudyRequest& request) {
    if (auto study = studies_.read(request.study()); !study) return tl::unexpected(study.error());
    if (auto good = check_new(request.name()); !good) return tl::unexpected(good.error());
    const auto work = [this, request](const Progress&) -> Result<v1::Study> {
      auto study = studies_.read(request.study());
      if (!study) return fail(study.error().sentence);
      const auto count = static_cast<std::uint32_t>(study->attempts_size());
      const std::uint32_t from = request.has_from() ? request.from() : study->current();
      if (from >= count)
        return fail(fmt::format("attempt {}: there are {}, counted from 0", from, count));
      if (from != study->current()) study->clear_diagnosis();
      study->set_current(from);
      return kept(request.name(), std::move(*study), &StudyStore::create);
    };
    return begun("branch", request.study(), work, request.wait_s());
  }

  Answer<v1::Text> figure(const v1::GetFigureRequest& request) const {
    const auto study = studies_.read(request.study());
    if (!study) return tl::unexpected(study.error());
    return pictures_.draw(*study, request);
  }

 private:
  Answer<void> check_new(const std::string& name) const {
    if (auto good = check_study_name(name); !good) return good;
    if (studies_.contains(name))
      return refuse(409, fmt::format("study '{}' exists; choose another name", name));
    return {};
  }

  Answer<v1::StudyInput> input_of(const v1::OpenStudyRequest& request) const {
    v1::StudyInput out;
    if (request.input().empty()) {
      const auto path = path_to_study(request.campaign(), request.folder());
      if (!path) return tl::unexpected(path.error());
      out.add_files(path->string());
    } else {
      const auto named = std::find_if(inputs_.begin(), inputs_.end(), [&](const auto& one) {
        return one.name() == request.input();
      });
      if (named == inputs_.end())
        return refuse(
            404, fmt::format("there is no input '{}'; GET /v1/inputs lists all", request.input()));
      out = named->input();
    }
    if (request.split_into() > 1) out.set_split_into(request.split_into());
    return out;
  }

  Answer<std::filesystem::path> path_to_study(const std::string& campaign,
                                              const std::string& folder) const {
    const auto manifest = records_.manifest(campaign, folder);
    if (!manifest) return tl::unexpected(manifest.error());
    std::uint64_t bytes = 0;
    for (const v1::ChunkEntry& chunk : manifest->chunks()) bytes += chunk.bytes();
    if (bytes > largest_) {
      return refuse(409, fmt::format("the recording has {}; the limit here is {}: "
                                     "use imunoise study on another machine",
                                     config::print_bytes(static_cast<double>(bytes)),
                                     config::print_bytes(static_cast<double>(largest_))));
    }
    return records_.path_of(campaign, folder);
  }

  Result<v1::Study> compute(v1::Study study, const v1::StudyRequest& asked,
                            const Progress& progress) const {
    v1::JobOrder order;
    *order.mutable_study() = std::move(study);
    *order.mutable_request() = asked;
    for (const auto& one : records_.folders()) order.add_folders(one.string());
    order.set_cache(studies_.cache().string());
    auto out = compute_(order, progress);
    if (out && progress.stopped()) return fail("cancelled");  // before its end: nothing is kept
    return out;
  }

  using Keep = Result<void> (StudyStore::*)(const std::string& name, const v1::Study& study);
  Result<v1::Study> kept(const std::string& name, Result<v1::Study> study, Keep keep) {
    if (!study) return study;
    if (auto done = (studies_.*keep)(name, *study); !done) return tl::unexpected(done.error());
    return without_pictures(std::move(*study));
  }

  // The job, or what became of it while the response waited.
  Answer<v1::Job> begun(const std::string& operation, const std::string& study, Jobs::Work work,
                        double wait_s) {
    if (!(wait_s >= 0.0 && wait_s <= kLongestWait))
      return refuse(400, fmt::format("wait_s: 0 to {} s", kLongestWait));
    auto job = jobs_.add(operation, study, std::move(work));
    if (!job || wait_s == 0.0 || !waiting_.try_acquire()) return job;
    job = jobs_.wait(job->job(), std::chrono::duration<double>(wait_s));
    waiting_.release();
    return job;
  }

  Jobs& jobs_;
  StudyStore& studies_;
  const Records& records_;
  const std::vector<v1::NamedInput>& inputs_;
  StudyPictures pictures_;
  const std::uint64_t largest_;
  const ComputeStudy compute_;
  std::counting_semaphore<> waiting_{kMostWaiting};
};

v1::StudyRequest add_request(const auto& request) {
  v1::StudyRequest out;
  out.mutable_add()->set_term(request.term());
  if (request.has_branch_from()) out.mutable_add()->set_branch_from(request.branch_from());
  return out;
}

void add_steps(Methods& methods, const std::shared_ptr<StudyMethods>& steps) {
  methods.on_waiting<v1::OpenStudyRequest>(
      [steps](const v1::OpenStudyRequest& request) { return steps->open(request); });
  methods.on_waiting<v1::SeekCandidatesRequest>([steps](const v1::SeekCandidatesRequest& request) {
    v1::StudyRequest asked;
    asked.mutable_candidates();
    return steps->change("candidates", request.study(), asked, true, request.wait_s());
  });
  methods.on_waiting<v1::PreviewTermRequest>([steps](const v1::PreviewTermRequest& request) {
    return steps->change("preview", request.study(), add_request(request), false, request.wait_s());
  });
  methods.on_waiting<v1::AddTermRequest>([steps](const v1::AddTermRequest& request) {
    return steps->change("add", request.study(), add_request(request), true, request.wait_s());
  });
  methods.on_waiting<v1::UndoTermRequest>([steps](const v1::UndoTermRequest& request) {
    v1::StudyRequest asked;
    asked.mutable_undo();
    return steps->change("undo", request.study(), asked, true, request.wait_s());
  });
  methods.on_waiting<v1::RedoTermRequest>([steps](const v1::RedoTermRequest& request) {
    v1::StudyRequest asked;
    asked.mutable_redo();
    return steps->change("redo", request.study(), asked, true, request.wait_s());
  });
  methods.on_waiting<v1::TryModelRequest>([steps](const v1::TryModelRequest& request) {
    v1::StudyRequest asked;
    asked.mutable_try_model()->set_model(request.model());
    return steps->change("try", request.study(), asked, true, request.wait_s());
  });
  methods.on_waiting<v1::GetFigureRequest>(
      [steps](const v1::GetFigureRequest& request) { return steps->figure(request); });
  methods.on_waiting<v1::BranchStudyRequest>(
      [steps](const v1::BranchStudyRequest& request) { return steps->branch(request); });
}

}  // namespace

void add_study_methods(Methods& methods, const StudySubjects& subjects,
                       std::uint64_t largest_recording, ComputeStudy compute) {
  StudyStore& studies = subjects.studies;
  Jobs& jobs = subjects.jobs;
  add_steps(methods,
            std::make_shared<StudyMethods>(subjects, largest_recording, std::move(compute)));
  methods.on<v1::ListInputsRequest>(
      [&inputs = subjects.inputs](const v1::ListInputsRequest&) -> Answer<v1::InputList> {
        v1::InputList out;
        *out.mutable_inputs() = {inputs.begin(), inputs.end()};
        return out;
      });
  methods.on_waiting<v1::ListStudiesRequest>(
      [&studies](const v1::ListStudiesRequest&) { return studies.list(); });
  methods.on_waiting<v1::GetStudyRequest>(
      [&studies](const v1::GetStudyRequest& request) -> Answer<v1::Study> {
        auto study = studies.read(request.study());
        if (!study) return study;
        return without_pictures(std::move(*study));
      });
  methods.on_waiting<v1::GetStudyReportRequest>(
      [&studies](const v1::GetStudyReportRequest& request) -> Answer<v1::Text> {
        const auto study = studies.read(request.study());
        if (!study) return tl::unexpected(study.error());
        v1::Text out;
        out.set_text(report::html_page(report::document(*study, report::Digits::kTypeset)));
        return out;
      });
  methods.on_waiting<v1::DeleteStudyRequest>(
      [&studies](const v1::DeleteStudyRequest& request) -> Answer<v1::DeletedStudy> {
        if (auto done = studies.remove(request.study()); !done) return tl::unexpected(done.error());
        return v1::DeletedStudy();
      });
  methods.on<v1::ListJobsRequest>([&jobs](const v1::ListJobsRequest&) -> Answer<v1::JobList> {
    v1::JobList out;
    for (const v1::Job& job : jobs.list()) *out.add_jobs() = job;
    return out;
  });
  methods.on<v1::GetJobRequest>(
      [&jobs](const v1::GetJobRequest& request) { return jobs.get(request.job()); });
  methods.on<v1::CancelJobRequest>(
      [&jobs](const v1::CancelJobRequest& request) { return jobs.cancel(request.job()); });
}

}  // namespace imunoise::service
