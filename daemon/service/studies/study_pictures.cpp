#include "daemon/service/studies/study_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "daemon/service/api/figure_answer.h"
#include "study/report/figures/study_figure.h"

namespace imunoise::service {
namespace {

// What to do where a view has nothing to show.
std::string why_empty(const std::string& view) {
  if (view == "witnesses")
    return "no witness shares anything significant with this channel, or none was recorded";
  if (view == "replicates") return "there is one replicate; record more to compare them";
  return "the replicates are too short for this view; record longer ones";
}

Answer<void> check(const v1::GetFigureRequest& request) {
  const auto& views = report::study_views();
  if (std::find(views.begin(), views.end(), request.view()) == views.end())
    return refuse(400, fmt::format("view: '{}' is unknown; there are {}", request.view(),
                                   fmt::join(views, ", ")));
  return check_figure_size(request.width(), request.height());
}

}  // namespace

v1::Study without_pictures(v1::Study study) {
  const auto strip = [](v1::Rung& rung) {
    if (!rung.has_picture()) return;
    rung.mutable_picture()->clear_budget();
    rung.mutable_picture()->clear_compared();
  };
  for (v1::StudyAttempt& one : *study.mutable_attempts()) strip(*one.mutable_rung());
  if (!study.has_diagnosis()) return study;
  for (v1::EffectCandidate& one : *study.mutable_diagnosis()->mutable_candidates()) {
    if (one.has_next()) strip(*one.mutable_next());
  }
  return study;
}

void StudyPictures::keep_preview(const std::string& study, const v1::Study& previewed) {
  const std::lock_guard lock(mutex_);
  preview_ = {study, previewed.attempts(previewed.attempts_size() - 1)};
}

std::optional<v1::RungPicture> StudyPictures::ghost(const v1::Study& study, std::uint32_t attempt,
                                                    const v1::GetFigureRequest& request) const {
  if (attempt == study.current()) {
    for (const v1::EffectCandidate& one : study.diagnosis().candidates()) {
      if (one.term() == request.ghost() && one.next().has_picture()) return one.next().picture();
    }
  }
  const std::lock_guard lock(mutex_);
  const v1::Rung& rung = preview_.attempt.rung();
  if (preview_.study == request.study() && preview_.attempt.parent() == attempt &&
      rung.added() == request.ghost())
    return rung.picture();
  return std::nullopt;
}

Answer<v1::Text> StudyPictures::draw(const v1::Study& study,
                                     const v1::GetFigureRequest& request) const {
  if (auto good = check(request); !good) return tl::unexpected(good.error());
  const std::uint32_t attempt = request.has_attempt() ? request.attempt() : study.current();
  if (attempt >= static_cast<std::uint32_t>(study.attempts_size()))
    return refuse(404, fmt::format("attempt {}: there are {}, counted from 0", attempt,
                                   study.attempts_size()));
  if (!study.attempts(static_cast<int>(attempt)).rung().has_picture())
    return refuse(404,
                  "this model was tried by an older version of imunoise, which kept no figures; "
                  "try it again");
  report::StudyFigureOptions options{.view = request.view(),
                                     .attempt = attempt,
                                     .variance = request.variance(),
                                     .si = request.si()};
  std::optional<v1::RungPicture> preview;
  if (!request.ghost().empty()) {
    preview = ghost(study, attempt, request);
    if (!preview)
      return refuse(404,
                    fmt::format("there is no preview of '{}'; ask for it first", request.ghost()));
    options.preview = &*preview;
  }
  const auto figure = report::study_figure(study, options);
  if (!figure) return refuse(404, why_empty(request.view()));
  return figure_answer(*figure, request);
}

}  // namespace imunoise::service
