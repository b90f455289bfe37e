#pragma once

// Figures of studies, and what they are drawn from, which stays in the service.

#include <mutex>
#include <optional>
#include <string>

#include "daemon/service/api/answer.h"
#include "imunoise/v1/service.pb.h"

namespace imunoise::service {

/// A study without the measurements that its figures are drawn from: what clients get. The terms of
/// its models stay, without the scales of their curves.
v1::Study without_pictures(v1::Study study);

/// Thread-safe.
class StudyPictures {
 public:
  /// Keeps the picture of the model that a preview came to, until the next preview.
  void keep_preview(const std::string& study, const v1::Study& previewed);

  /// Error: 400 for a view or a size that is none, 404 for an attempt or a ghost that is not there
  /// and where the data show nothing in this view.
  Answer<v1::Text> draw(const v1::Study& study, const v1::GetFigureRequest& request) const;

 private:
  struct Preview {
    std::string study;
    v1::StudyAttempt attempt;
  };
  std::optional<v1::RungPicture> ghost(const v1::Study& study, std::uint32_t attempt,
                                       const v1::GetFigureRequest& request) const;

  mutable std::mutex mutex_;
  Preview preview_;
};

}  // namespace imunoise::service
