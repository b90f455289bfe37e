// common_course: a smooth course of any form, the same in every replicate.
//
// Half waves cos(πk(t + ½)/T), k = 1 .. terms, T the second longest recording in samples: over a
// whole recording these are the slowest functions of the cosine transform. What lies beyond T is in
// one recording alone, which shows no more what is common: the course stays as it is.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/effect/columns.h"
#include "core/search/search_view.h"
#include "core/support/distributions.h"

namespace imunoise::effects {

const Effect& common_course();

namespace {

using Index = Eigen::Index;

enum CommonCourseParameter : std::size_t { kCourseTerms, kCourseAmplitude };

constexpr int kMostHalfWaves = 12;

// Samples that two recordings have, each from its first to the last that is left of it; those of
// the recording where there is one only.
Index common_length(const Subject& subject) {
  std::vector<Index> lengths(subject.parts.back().recorded + 1, 0);
  for (std::size_t k = 0; k < subject.replicates(); ++k) {
    Index& one = lengths[subject.parts[k].recorded];
    one = std::max(one, subject.parts[k].first + subject.length(k));
  }
  std::sort(lengths.begin(), lengths.end(), std::greater<>());
  return lengths.size() > 1 ? lengths[1] : lengths[0];
}

ShapeFrom course_shape(const EffectTerm& term, const Subject& subject) {
  return [length = common_length(subject), count = static_cast<int>(term[kCourseTerms])](
             Index first) { return half_waves(length, count, first); };
}

Regressors course_regressors(const EffectTerm& term, const Subject& subject) {
  std::vector<std::string> names;
  for (int k = 1; k <= static_cast<int>(term[kCourseTerms]); ++k)
    names.push_back("half_wave_" + std::to_string(k));
  return shaped(subject, false, names, course_shape(term, subject));
}

void add_course(const EffectTerm& term, const Subject& subject, std::size_t replicate,
                const Eigen::VectorXd& coefficients, Eigen::VectorXd& to) {
  course_shape(term, subject)(subject.parts[replicate].first).add(coefficients, to);
}

// Half waves of one size; the signs change in pairs, so that they do not meet in a peak.
void simulate_course(const EffectTerm& term, const SimulatedReplicate& at,
                     Eigen::VectorXd& samples) {
  const auto count = static_cast<Index>(term[kCourseTerms]);
  const double size = term[kCourseAmplitude] * std::sqrt(2.0 / static_cast<double>(count));
  Eigen::VectorXd coefficients(count);
  for (Index k = 0; k < count; ++k) coefficients(k) = k / 2 % 2 == 0 ? size : -size;
  add_course(term, at.beside, at.replicate, coefficients, samples);
}

// What the slowest half waves gain with one coefficient for all replicates, against what more they
// gain with one for each: a course is common if the first stands out of the second (F test:
// noise of the fit that took the place of a course enlarges neither more). Gains are half a χ².
struct CommonGain {
  int terms = 0;
  double shared = 0.0;  // nats
  double log_p = 0.0;
};

CommonGain best_common_gain(const SearchView& view) {
  const Subject& subject = view.subject();
  const auto others = static_cast<double>(subject.replicates() - 1);
  const auto length = static_cast<double>(common_length(subject));
  CommonGain best;
  double shared = 0.0;
  double apart = 0.0;
  for (int k = 1; k <= kMostHalfWaves; ++k) {
    const double step = std::numbers::pi * k / length;
    const Eigen::VectorXd whitened = view.slow().whitened(view.over_time(
        [&](double t) { return std::cos(step * std::min(t * subject.rate.value + 0.5, length)); }));
    const double together = view.slow().gain(whitened, false);
    shared += together;
    apart += view.slow().gain(whitened, true) - together;
    if (k < 2) continue;  // one half wave is a ramp
    const double log_p = log_f_tail(shared * others / apart, k, k * others);
    if (log_p < best.log_p) best = {k, shared, log_p};
  }
  return best;
}

Suggestions search_common_course(const SearchView& view) {
  const Subject& subject = view.subject();
  if (subject.parts.back().recorded == 0) return {};  // one recording has nothing in common
  constexpr double kCommon = -6.9;                    // log of 1/1000
  const CommonGain best = best_common_gain(view);
  const int terms = std::max(best.terms, 2);
  return {{.cause = "common_course",
           .added = EffectTerm(common_course(), "", {{"terms", terms}}),
           .score_nats = best.log_p < kCommon ? best.shared : 0.0,
           .dof = static_cast<double>(terms),
           .search = {.log_places = std::log(kMostHalfWaves - 1.0)}}};
}

// Root mean square of the course over what two recordings have, less what noise adds.
std::vector<ReportedNumber> course_numbers(const FittedEffect& effect) {
  const Regression& regression = effect.model.regression;
  const Index first = regression.first(effect.number);
  const Index count = regression.first(effect.number + 1) - first;
  const EffectCoefficients& found = effect.model.fit.effects;
  const Eigen::VectorXd value = found.value.segment(first, count);
  const Eigen::MatrixXd covariance = found.covariance.block(first, first, count, count);
  const double size = std::sqrt(0.5 * std::max(0.0, value.squaredNorm() - covariance.trace()));
  const double error = size > 0.0 ? 0.5 * std::sqrt(value.dot(covariance * value)) / size
                                  : std::sqrt(0.5 * covariance.trace());
  return {with_error({"amplitude", size, unit_of(effect.term(), effect.subject())}, error)};
}

}  // namespace

const Effect& common_course() {
  static const Effect kCommonCourse{
      .name = "common_course",
      .title = "course common to all replicates",
      .meaning =
          "Adds a smooth course that is the same in every replicate, from its first sample on; "
          "beyond the second longest it stays as it is.",
      .parameters = {{.name = "terms",
                      .meaning = "number of half waves that make the course",
                      .form = ParameterForm::kWholeNumber,
                      .required = true,
                      .lower = 1,
                      .upper = kMostHalfWaves},
                     {.name = "amplitude",
                      .meaning = "root mean square of the course",
                      .reported = "amplitude",
                      .truth = true}},
      .coefficient = "amplitude",
      .causes = {{.id = "common_course",
                  .title = "course common to all replicates",
                  .physics = "The same happens after every power-on, and no recorded channel shows "
                             "it: the device heats itself, or the laboratory follows a schedule.",
                  .record_next = "another course: power on at other times of the day, from another "
                                 "temperature, with the temperature of the sensor itself",
                  .looks_like = {"warm_up", "rate_ramp", "temperature"},
                  .family = "common_course",
                  .slow = true}},
      .regressors = course_regressors,
      .add = add_course,
      .simulate = simulate_course,
      .search = search_common_course,
      .numbers = course_numbers,
  };
  return kCommonCourse;
}

}  // namespace imunoise::effects
