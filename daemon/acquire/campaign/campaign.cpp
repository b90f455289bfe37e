#include "daemon/acquire/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/support/counted.h"
#include "daemon/acquire/campaign/recordings.h"
#include "daemon/acquire/open_devices.h"
#include "recording/store/format/layout.h"
#include "recording/store/manifest/manifest.h"
#include "recording/store/recovery/recover.h"

namespace imunoise::acquire {
namespace {

constexpr std::chrono::seconds kFirstPause{5};  // after something went wrong
constexpr std::chrono::seconds kLongestPause{300};

class Run {
 public:
  Run(const v1::Campaign& campaign, RunMode mode, const CampaignSurroundings& with,
      const std::stop_token& stop)
      : campaign_(campaign),
        with_(with),
        stop_(stop),
        mode_(mode),
        stopped_(stop, End{ending_}),
        left_(with.leave, End{ending_}),
        leaps_(with.clock) {}

  void run() {
    while (!ending_.stop_requested()) {
      follow_clock();
      auto found = newest_recording(with_.files, campaign_, with_.clock, last_);
      if (!found) {
        hold_up(found.error().message);
        continue;
      }
      newest_ = std::move(*found);
      look_after_recorded();
      const Time now = with_.clock.now();
      const auto state = newest_ ? std::optional(newest_->state) : std::nullopt;
      if (mode_ == RunMode::kOnce && !memory_.once_since) memory_.once_since = only_start(now);
      const Step step = next_step(campaign_, state, memory_, now);
      if (step.phase == v1::recording) {
        if (auto done = take_folder(); !done) {
          hold_up(done.error().message);
          continue;
        }
      }
      if (step.new_recording) folder_of_next_ = folder_at(now);
      if (worth_telling(step.phase)) tell(step, std::exchange(news_, {}));
      if (step.phase == v1::finished) return;
      take(step, now);
    }
  }

 private:
  struct End {
    std::stop_source& of;
    void operator()() const { of.request_stop(); }
  };
  // What is remembered, and what is told of it, keep their distance from the present when the clock
  // is set.
  void follow_clock() {
    const auto leap = leaps_.look();
    if (!leap) return;
    shift(memory_, *leap);
    add_news(fmt::format("the clock of this machine was {}; the schedule follows it",
                         describe_leap(*leap)));
  }

  // The folder of a disk that is no longer mounted is empty: what follows lies elsewhere.
  void look_after_recorded() {
    if (recorded_.empty()) return;
    const auto there = with_.files.exists(recorded_ / recording::kManifestName);
    if (!there || *there) return;
    add_news(
        fmt::format("recording {} not found; if you did not delete it, check that its disk is "
                    "mounted: the campaign goes on recording where that folder was",
                    recorded_.string()));
    recorded_.clear();
  }

  std::filesystem::path folder_at(Time started) const {
    return std::filesystem::path(campaign_.folder()) / recording_name(started);
  }

  // What holds it up was told when it came about.
  bool worth_telling(v1::CampaignPhase phase) const {
    return phase != v1::held_up && (phase != v1::calibrating || with_.calibrate) &&
           (phase != v1::publishing || with_.publish);
  }

  // Of the only recording: the newest, while it is unfinished.
  Time only_start(Time now) const {
    const bool unfinished =
        newest_ && good_replicates(campaign_, newest_->state.notes) < campaign_.replicates();
    return unfinished ? newest_->state.started : std::chrono::floor<std::chrono::seconds>(now);
  }

  void take(const Step& step, Time now) {
    switch (step.phase) {
      case v1::settling:
        if (!memory_.at_rest_since) memory_.at_rest_since = now;
        [[fallthrough]];
      case v1::pausing:
      case v1::waiting:
      case v1::held_up:
        with_.clock.wait_until(*step.until, ending_.get_token());
        break;
      case v1::recording:
        record(step);
        break;
      case v1::calibrating:
        if (auto done = close_newest(); !done) return hold_up(done.error().message);
        memory_.calibrated = true;  // what fails is told; the recording is there to try by hand
        call(with_.calibrate, "calibration");
        break;
      case v1::publishing:
        memory_.published = true;
        memory_.at_rest_since.reset();
        memory_.replicate_ended.reset();
        call(with_.publish, "publishing");
        tidy();
        break;
      default:
        break;
    }
  }

  void record(const Step& step) {
    ReplicateTask task{newest_ ? newest_->folder : std::filesystem::path(), step.attempt,
                       campaign_.replicates() - step.replicate, std::exchange(unfinished_, {})};
    if (step.new_recording) {
      leave_unfinished();
      task.folder = folder_of_next_;
      memory_.calibrated = memory_.published = false;
    }
    last_ = task.folder;
    const auto note = with_.recorder.record(campaign_, task, Progress({}, stop_));
    follow_clock();
    if (stop_.stop_requested()) {
      const bool lost = !note && note.error().message != kStoppedOpening;
      if (lost) tell({.phase = v1::finished}, note.error().message);
      return;
    }
    if (!note) {
      unfinished_ = note.error().message;
      return hold_up(unfinished_);
    }
    recorded_ = task.folder;
    memory_.replicate_ended = with_.clock.now();
    if (note->state() != v1::complete) return hold_up(note->reason());
    pause_ = kFirstPause;
    add_news(describe(*note));
  }

  // The next recording is due, and the newest lacks replicates: it is not calibrated.
  void leave_unfinished() {
    const std::uint32_t good = newest_ ? good_replicates(campaign_, newest_->state.notes) : 0;
    if (!newest_ || good >= campaign_.replicates() || given_up_ == newest_->folder) return;
    given_up_ = newest_->folder;
    add_news(
        fmt::format("recording {} stays unfinished with {} of {} replicates, because the next one "
                    "is due; increase 'every': opening a device takes time, too",
                    newest_->folder.string(), good, campaign_.replicates()));
    tidy();
  }

  // The campaign's folder, from the first replicate to the end of the run: another daemon would add
  // its replicates to the recording that this one has begun.
  Result<void> take_folder() {
    if (auto done = recording::make_folders(with_.files, campaign_.folder()); !done) return done;
    if (own_folder_) return {};
    auto lock = with_.files.lock(campaign_.folder());
    if (!lock) return tl::make_unexpected(lock.error());
    own_folder_ = std::move(*lock);
    return {};
  }

  // What the last replicate left in journals, because the disk took no chunk, becomes chunks.
  Result<void> close_newest() {
    const auto manifest = recording::read_manifest(with_.files, newest_->folder);
    if (!manifest) return tl::make_unexpected(manifest.error());
    if (*manifest && (*manifest)->closed()) return {};
    const auto lock = with_.files.lock(newest_->folder);
    if (!lock) return tl::make_unexpected(lock.error());
    const auto done =
        recording::recover_recording(with_.files, newest_->folder, recording::Recovery::kUnsettled);
    return done ? Result<void>() : tl::make_unexpected(done.error());
  }

  static std::string describe(const v1::ReplicateNote& note) {
    std::string out;
    for (const v1::MissingDevice& one : note.missing()) {
      out += fmt::format("{}{} {} ({})", out.empty() ? "" : "; ", one.device(),
                         one.joined_ns() > 0 ? "came late" : "is missing", one.reason());
    }
    if (note.disturbances_size() > 0) {
      out += fmt::format(
          "{}the sensors moved {}, first at {}", out.empty() ? "" : "; ",
          counted(note.disturbances_size(), "time"),
          recording_name(Time(std::chrono::nanoseconds(note.disturbances(0).begin_ns()))));
    }
    return out;
  }

  void call(const RecordingHook& hook, std::string_view what) {
    if (!hook) return;
    const auto done = hook(campaign_, newest_->folder, Progress({}, ending_.get_token()));
    add_news(done ? *done : fmt::format("{}: {}", what, done.error().message));
  }

  void add_news(const std::string& text) {
    if (!text.empty()) news_ += (news_.empty() ? "" : "; ") + text;
  }

  void tidy() {
    const auto tidied = tidy_recordings(with_.files, campaign_, with_.clock);
    if (!tidied) return add_news(tidied.error().message);
    if (std::count(tidied->removed.begin(), tidied->removed.end(), recorded_) > 0)
      recorded_.clear();
    if (!tidied->removed.empty())
      add_news(
          fmt::format("deleted {} ([retention])", counted(tidied->removed.size(), "recording")));
    if (tidied->doubtful > 0) {
      add_news(
          fmt::format("{} recordings look older than retention.age but are kept, because the "
                      "clock of this machine is not, or was not, set by a time service "
                      "(see timedatectl). Delete old recordings by hand",
                      tidied->doubtful));
    }
  }

  void hold_up(const std::string& reason) {
    follow_clock();
    memory_.held_up_until = with_.clock.now() + pause_;
    pause_ = std::min(2 * pause_, kLongestPause);
    tell({.phase = v1::held_up, .until = memory_.held_up_until}, reason);
    with_.clock.wait_until(*memory_.held_up_until, ending_.get_token());
  }

  void tell(const Step& step, const std::string& reason) const {
    if (!with_.tell) return;
    v1::CampaignStatus status;
    status.set_campaign(campaign_.name());
    status.set_phase(step.phase);
    if (step.phase == v1::recording && step.new_recording) {
      status.set_recording(folder_of_next_.string());
    } else if (newest_ && !step.new_recording) {
      status.set_recording(newest_->folder.string());
    }
    status.set_replicate(step.replicate);
    status.set_replicates(campaign_.replicates());
    status.set_attempt(step.attempt);
    status.set_since_ns(ns(with_.clock.now()));
    if (step.until) status.set_until_ns(ns(*step.until));
    status.set_reason(reason);
    with_.tell(status);
  }

  const v1::Campaign& campaign_;
  const CampaignSurroundings& with_;
  const std::stop_token& stop_;  // also of a replicate that is being recorded
  RunMode mode_;
  std::stop_source ending_;  // of everything else
  std::stop_callback<End> stopped_;
  std::stop_callback<End> left_;
  Memory memory_;
  LeapWatch leaps_;
  std::optional<FoundRecording> newest_;
  std::filesystem::path last_;      // where this process recorded last
  std::filesystem::path recorded_;  // whose replicate it closed last
  std::filesystem::path given_up_;  // unfinished, as was told
  std::string unfinished_;          // why the last replicate may have stayed open
  std::unique_ptr<recording::FolderLock> own_folder_;
  std::filesystem::path folder_of_next_;
  std::chrono::seconds pause_ = kFirstPause;
  std::string news_;  // what the next status tells of the step before it
};

}  // namespace

void run_campaign(const v1::Campaign& campaign, RunMode mode,
                  const CampaignSurroundings& surroundings, const std::stop_token& stop) {
  Run(campaign, mode, surroundings, stop).run();
}

}  // namespace imunoise::acquire
