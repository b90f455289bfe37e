#include "daemon/service/studies/jobs.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace imunoise::service {
namespace {

constexpr std::ptrdiff_t kKept = 32;  // that are over
constexpr std::chrono::milliseconds kTellEvery{250};

v1::Job without_result(const v1::Job& job) {
  v1::Job out = job;
  out.clear_result();
  return out;
}

// Whatever is thrown must not take recording with it.
Result<v1::Study> guarded(const Jobs::Work& work, const Progress& progress) {
  try {
    return work(progress);
  } catch (const std::exception& error) {
    return fail(std::string("internal error of imunoised: ") + error.what());
  }
}

}  // namespace

bool over(const v1::Job& job) {
  return job.state() == v1::done || job.state() == v1::failed || job.state() == v1::cancelled;
}

Jobs::Jobs(std::size_t waiting, Changed changed)
    : waiting_(waiting),
      changed_(std::move(changed)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

Jobs::~Jobs() {
  thread_.request_stop();
  {
    const std::lock_guard lock(mutex_);
    for (const auto& one : entries_) one->stop.request_stop();
  }
  news_.notify_all();
}

Answer<v1::Job> Jobs::add(const std::string& operation, const std::string& study, Work work) {
  auto entry = std::make_shared<Entry>();
  {
    const std::lock_guard lock(mutex_);
    const auto queued = std::count_if(entries_.begin(), entries_.end(), [](const auto& one) {
      return one->job.state() == v1::queued;
    });
    if (static_cast<std::size_t>(queued) >= waiting_)
      return refuse(503, fmt::format("{} jobs are waiting; try again later", queued));
    entry->job.set_job(fmt::format("job-{}", ++count_));
    entry->job.set_operation(operation);
    entry->job.set_study(study);
    entry->job.set_state(v1::queued);
    entry->work = std::move(work);
    entries_.push_back(entry);
    forget_old();
  }
  v1::Job out = get(entry->job.job()).value();
  tell(out);
  news_.notify_all();
  return out;
}

void Jobs::forget_old() {
  auto more = std::count_if(entries_.begin(), entries_.end(),
                            [](const auto& one) { return over(one->job); }) -
              kKept;
  std::erase_if(entries_, [&](const auto& one) { return over(one->job) && more-- > 0; });
}

void Jobs::run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    std::shared_ptr<Entry> next;
    {
      std::unique_lock lock(mutex_);
      const auto waiting = [&] {
        const auto found = std::find_if(entries_.begin(), entries_.end(), [](const auto& one) {
          return one->job.state() == v1::queued;
        });
        if (found != entries_.end()) next = *found;
        return found != entries_.end();
      };
      if (!news_.wait(lock, stop, waiting)) return;
      next->job.set_state(v1::working);
      next->began = next->told = Clock::now();
    }
    work_on(next);
  }
}

void Jobs::work_on(const std::shared_ptr<Entry>& entry) {
  tell(without_result(get(entry->job.job()).value()));
  auto result =
      guarded(entry->work, Progress([this, entry](double fraction) { progress(*entry, fraction); },
                                    entry->stop.get_token()));
  v1::Job told;
  {
    const std::lock_guard lock(mutex_);
    v1::Job& job = entry->job;
    job.clear_left_s();
    if (result) {
      job.set_state(v1::done);
      job.set_progress(1.0);
      *job.mutable_result() = std::move(*result);
    } else if (entry->stop.stop_requested()) {
      job.set_state(v1::cancelled);
    } else {
      job.set_state(v1::failed);
      job.set_error(result.error().message);
    }
    told = without_result(job);
  }
  news_.notify_all();
  tell(told);
}

void Jobs::progress(Entry& entry, double fraction) {
  v1::Job told;
  {
    const std::lock_guard lock(mutex_);
    if (fraction <= entry.job.progress() || over(entry.job)) return;
    const auto now = Clock::now();
    entry.job.set_progress(fraction);
    const double passed = std::chrono::duration<double>(now - entry.began).count();
    entry.job.set_left_s(passed * (1.0 - fraction) / fraction);
    if (now - entry.told < kTellEvery) return;
    entry.told = now;
    told = entry.job;
  }
  tell(told);
}

std::shared_ptr<Jobs::Entry> Jobs::find(const std::string& job) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& one) { return one->job.job() == job; });
  return found == entries_.end() ? nullptr : *found;
}

Answer<v1::Job> Jobs::get(const std::string& job) const {
  return wait(job, std::chrono::duration<double>(0.0));
}

Answer<v1::Job> Jobs::wait(const std::string& job, std::chrono::duration<double> patience) const {
  std::unique_lock lock(mutex_);
  const auto entry = find(job);
  if (!entry)
    return refuse(404,
                  fmt::format("there is no job '{}'; its number is wrong, or it is too old", job));
  news_.wait_for(lock, patience, [&] { return over(entry->job); });
  return entry->job;
}

Answer<v1::Job> Jobs::cancel(const std::string& job) {
  std::optional<v1::Job> told;
  {
    const std::lock_guard lock(mutex_);
    const auto entry = find(job);
    if (!entry)
      return refuse(
          404, fmt::format("there is no job '{}'; its number is wrong, or it is too old", job));
    entry->stop.request_stop();
    if (entry->job.state() == v1::queued) {
      entry->job.set_state(v1::cancelled);
      told = entry->job;
    }
  }
  news_.notify_all();
  if (told) tell(*told);
  return get(job);
}

std::vector<v1::Job> Jobs::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<v1::Job> out;
  for (const auto& one : entries_) out.push_back(without_result(one->job));
  return out;
}

void Jobs::tell(const v1::Job& job) const {
  if (changed_) changed_(job);
}

}  // namespace imunoise::service
