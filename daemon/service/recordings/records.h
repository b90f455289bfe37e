#pragma once

// The recordings of all campaigns and what is known of them, through the catalogue.

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/catalogue/catalogue.h"
#include "daemon/service/api/answer.h"
#include "daemon/service/recordings/recorded_samples.h"
#include "imunoise/v1/campaign.pb.h"
#include "imunoise/v1/service.pb.h"
#include "recording/store/disk/watched_files.h"

namespace imunoise::service {

/// Thread-safe. The catalogue is kept in memory, and follows the files when it is asked, but not
/// more often than `freshness`. Benches of the catalogue are the campaigns.
class Records {
 public:
  using Campaigns = std::function<std::vector<v1::Campaign>()>;

  /// `campaigns` is asked each time: they may change. What hangs is among the `calls`. Of
  /// larger devices (bytes in one replicate) no samples are shown. Error: the database's.
  static Result<std::unique_ptr<Records>> open(Campaigns campaigns,
                                               std::chrono::milliseconds freshness,
                                               recording::DiskCalls& calls,
                                               std::uint64_t largest_shown);

  /// Of one campaign, or of all (empty). Error: 404, there is no such campaign.
  Answer<v1::RecordingList> recordings(const std::string& campaign);
  Answer<v1::CalibrationList> calibrations(const std::string& campaign);
  Answer<v1::ArrayList> arrays(const std::string& campaign);
  Answer<v1::History> history(const v1::GetHistoryRequest& request);
  /// All devices of a type. Error: 404 for a type, channel or parameter that is not there.
  Answer<v1::Fleet> fleet(const v1::GetFleetRequest& request);
  /// One parameter of them as SVG. Error: also 400 for a size that is none.
  Answer<v1::Text> fleet_figure(const v1::GetFleetFigureRequest& request);
  /// One parameter of it as SVG. Error: that of history(); 400 for a size that is none; 404 for a
  /// parameter that is not there, or that was calibrated only once.
  Answer<v1::Text> history_figure(const v1::GetHistoryFigureRequest& request);

  // Error: 404 where there is none, 400 for a name that leads elsewhere, 500 for a damaged file.
  Answer<v1::Manifest> manifest(const std::string& campaign, const std::string& folder) const;
  Answer<v1::Calibration> calibration(const std::string& campaign, const std::string& folder) const;
  /// The bytes of its file.
  Answer<std::string> calibration_text(const std::string& campaign,
                                       const std::string& folder) const;
  /// A figure of an array in it. Error: also 400 for a view that is none.
  Answer<v1::Text> array_figure(const v1::GetArrayFigureRequest& request) const;
  /// Samples of a recording (RecordedSamples).
  Answer<v1::SampleRanges> samples(const v1::GetSamplesRequest& request);
  /// Its folder, beneath one of folders().
  Answer<std::filesystem::path> path_of(const std::string& campaign,
                                        const std::string& folder) const;
  /// Of each campaign one: all that can be read through this.
  std::vector<std::filesystem::path> folders() const;

 private:
  using Roots = std::map<std::string, std::filesystem::path>;  // by campaign
  struct View {
    View(Roots roots, recording::DiskCalls& calls);
    const Roots roots;
    const std::unique_ptr<recording::FileSystem> confined;  // nothing leads out of the roots
    recording::WatchedFiles files;
  };

  Records(Campaigns campaigns, catalogue::Catalogue catalogue, std::chrono::milliseconds freshness,
          recording::DiskCalls& calls, std::uint64_t largest_shown)
      : samples_(largest_shown),
        campaigns_(std::move(campaigns)),
        freshness_(freshness),
        calls_(calls),
        catalogue_(std::move(catalogue)) {}
  std::shared_ptr<View> view() const;  // of the campaigns as they are now
  Answer<void> check_campaign(const std::string& campaign) const;
  bool is_there(const std::filesystem::path& root) const;
  Answer<void> refresh();  // with the mutex held

  RecordedSamples samples_;
  const Campaigns campaigns_;
  const std::chrono::milliseconds freshness_;
  recording::DiskCalls& calls_;
  mutable std::mutex viewing_;
  mutable std::shared_ptr<View> view_;
  std::mutex mutex_;  // guards what follows
  catalogue::Catalogue catalogue_;
  std::shared_ptr<const View> catalogued_;  // what the catalogue is of
  std::optional<std::chrono::steady_clock::time_point> refreshed_;
};

}  // namespace imunoise::service
