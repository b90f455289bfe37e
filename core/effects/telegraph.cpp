// telegraph: jumps between two levels, the same two in all replicates.

#include <algorithm>
#include <cmath>

#include "core/effect/columns.h"
#include "core/effects/draws.h"
#include "core/effects/two_levels.h"
#include "core/search/search_view.h"

namespace imunoise::effects {

const Effect& telegraph();

namespace {

using Index = Eigen::Index;

enum TelegraphParameter : std::size_t { kTelegraphHeight, kTelegraphDwell };

const std::vector<TwoLevelCourse>* courses_in(const EffectTerm& term, const Subject& subject) {
  const auto* found = subject.found_by<FoundCourses>(term);
  return found == nullptr ? nullptr : &found->courses;
}

Regressors telegraph_regressors(const EffectTerm& term, const Subject& subject) {
  const std::vector<TwoLevelCourse>* const courses = courses_in(term, subject);
  if (courses == nullptr) return {std::vector<Columns>(subject.replicates()), {}};
  return in_all(subject, false, {"height"}, [&](std::size_t k) {
    return Columns{{(*courses)[k].cosines}, {}, {}};
  });
}

struct Weighed {
  FittedModel model;
  double worth;  // log-likelihood less what the places of jumps cost
};

// Levels that stand out of white noise, and few jumps between them.
bool stands_out(const TwoLevels& found, double white_deviation) {
  constexpr double kStrong = 1.5;
  constexpr double kMostJumps = 64.0;  // of a replicate, which has 512 places
  return found.height > kStrong * white_deviation &&
         static_cast<double>(found.jumps) < kMostJumps * static_cast<double>(found.courses.size());
}

// The courses are sought under a noise, and again under that which they leave: noise that took
// their place hides them. With a deviation of white noise, none where they do not stand out of it.
std::optional<Weighed> sought_under(JointFit under, const EffectTerm& term,
                                    const Regression& regression,
                                    const std::vector<Model>& own_noise, double white_deviation) {
  constexpr int kRounds = 3;
  std::optional<Weighed> best;
  for (int round = 0; round < kRounds; ++round) {
    TwoLevels found = find_two_levels(step_products(current_of(regression, under)));
    if (white_deviation > 0.0 && !stands_out(found, white_deviation)) break;
    auto subject = std::make_shared<Subject>(regression.subject());
    subject->own_nats.resize(subject->replicates(), 0.0);
    for (std::size_t k = 0; k < subject->replicates(); ++k)
      subject->own_nats[k] += found.courses[k].log_places - found.courses[k].log_width;
    const double price = log_places(found.courses);
    subject->keep(term, std::make_shared<FoundCourses>(std::move(found.courses)));
    Regression grown = regression.on(subject).with(term);
    JointFit with = joint_fit(grown, under.model.noise, {}, Begin::kAnywhere, own_noise);
    under = {.model = {with.model.noise, regression.effects()},
             .effects = regression.under(with.model.noise)};
    const double worth = with.log_likelihood - price;
    if (best && worth < best->worth + 1e-6) break;
    best = Weighed{{std::move(grown), std::move(with)}, worth};
  }
  return best;
}

double white_power(const Model& noise) {
  double out = 0.0;
  for (const Term& term : noise.terms) {
    if (std::holds_alternative<WhiteNoise>(term.process)) out += values(term.process).front();
  }
  return out;
}

// The fit with white noise almost alone: strong jumps make noise that walks of themselves, under
// which only the jumps' edges show.
JointFit almost_white(JointFit fit) {
  constexpr double kAlmost = 1e-6;
  for (Term& term : fit.model.noise.terms) {
    if (std::holds_alternative<WhiteNoise>(term.process)) continue;
    std::vector<double> all = values(term.process);
    all.front() *= kAlmost;
    set_values(term.process, all);
  }
  fit.own_noise.clear();
  return fit;
}

FittedModel fit_with_telegraph(const EffectTerm& term, const Regression& regression,
                               const JointFit& fit) {
  constexpr double kShare = 0.1;     // of the innovations' power that is white
  constexpr double kClearly = 10.0;  // nats
  std::optional<Weighed> best = sought_under(fit, term, regression, fit.own_noise, 0.0);
  const Model& noise = fit.model.noise;
  const double white = white_power(noise);
  const double all = innovation_deviation(noise);
  if (noise.terms.size() > 1 && white > kShare * all * all) {
    auto other = sought_under(almost_white(fit), term, regression, fit.own_noise, std::sqrt(white));
    if (other && other->worth > best->worth + kClearly) best = std::move(other);
  }
  return std::move(best->model);
}

void simulate_telegraph(const EffectTerm& term, const SimulatedReplicate& at,
                        Eigen::VectorXd& samples) {
  const double dwell = term[kTelegraphDwell] * at.beside.rate.value;
  double level = std::copysign(0.5 * term[kTelegraphHeight], at.random.normal());
  const auto n = static_cast<double>(samples.size());
  for (double begin = 0.0; begin < n; level = -level) {
    const double end = std::min(n, begin - dwell * std::log(uniform_number(at.random)));
    const auto first = static_cast<Index>(std::ceil(begin));
    samples.segment(first, static_cast<Index>(std::ceil(end)) - first).array() += level;
    begin = end;
  }
}

// With one jump it is a step.
Suggestions search_telegraph(const SearchView& view) {
  constexpr std::size_t kFewestJumps = 2;
  const EffectTerm term(telegraph());
  const auto& effects = view.current().regression.effects();
  if (std::find(effects.begin(), effects.end(), term) != effects.end()) return {};
  const TwoLevels found = find_two_levels(view.steps());
  return {{.cause = "telegraph",
           .added = term,
           .score_nats = found.jumps < kFewestJumps ? 0.0 : found.gain_nats,
           .search = {.log_places = log_places(found.courses)}}};
}

// Would it show if there were a third level half-way? Of three that are visited alike two explain
// three quarters. The rest, a third of what they explain under the noise that they leave, must pay
// for its jumps as the others do; else noise that walks hides it.
bool levels_show(const TriedTerm& tried) {
  constexpr double kThird = 1.0 / 3.0;
  const Regression& regression = tried.fitted.regression;
  const Index at = regression.first(regression.effects().size() - 1);
  const EffectCoefficients& found = tried.fitted.fit.effects;
  const double explained = 0.5 * found.value(at) * found.value(at) / found.covariance(at, at);
  return kThird * explained > tried.suggestion.search.log_places;
}

// A level that is taken once, in one replicate, may be anything that comes and goes.
bool comes_and_goes_once(const std::vector<TwoLevelCourse>& courses) {
  std::size_t jumps = 0;
  for (const TwoLevelCourse& one : courses) jumps += one.jumps.size();
  return jumps <= 2;
}

bool leaves_once(const std::vector<TwoLevelCourse>& courses) {
  return std::all_of(courses.begin(), courses.end(),
                     [](const TwoLevelCourse& one) { return one.jumps.size() <= 1; });
}

// By how much the noise is louder in a replicate with jumps than the model says: there, chance
// gains so much more. By the median, which jumps do not move.
double loudest(const Current& current, const std::vector<TwoLevelCourse>& courses) {
  constexpr double kMedian = 0.4549;  // of the square of a normal number
  double out = 1.0;
  const Innovations all = innovations(current.regression, current.fit);
  for (std::size_t i = 0; i < all.white.size(); ++i) {
    if (courses[all.replicates[i]].jumps.empty()) continue;
    Eigen::VectorXd squares = all.white[i].array().square();
    double* const middle = squares.data() + squares.size() / 2;
    std::nth_element(squares.data(), middle, squares.data() + squares.size());
    out = std::max(out, *middle / kMedian);
  }
  return out;
}

void review_telegraph(const Current& current, TriedTerm& tried) {
  const std::vector<TwoLevelCourse>& courses =
      *courses_in(*tried.term(), tried.fitted.regression.subject());
  tried.suggestion.inflation = loudest(current, courses);
  tried.suggestion.search.log_places = log_places(courses);
  // A level that is left and never taken again was no level of two.
  if (leaves_once(courses)) tried.cause = "step";
  if (!levels_show(tried) || comes_and_goes_once(courses)) tried.could_be.push_back("step");
  // Dwells too short to be seen move the levels between the others a little.
  constexpr double kLittle = 0.05;
  constexpr double kMoreThanTwo = 0.01;
  const TestOutcome more = more_levels(tried.fitted, courses);
  tried.steady =
      more.p_value > kMoreThanTwo || 0.5 * more.statistic < kLittle * tried.likelihood_gain;
}

// When the courses leave their first level.
void add_first_jump(const Subject& subject, const std::vector<TwoLevelCourse>& courses,
                    std::vector<ReportedNumber>& out) {
  for (std::size_t k = 0; k < courses.size(); ++k) {
    if (courses[k].jumps.empty()) continue;
    const double after = static_cast<double>(courses[k].jumps.front()) / subject.rate.value;
    out.push_back({"time_s", subject.begins(k) + after, "s"});
    out.push_back({"replicate", static_cast<double>(subject.parts[k].recorded + 1), "1"});
    return;
  }
}

// A level that is left once may be a step: only jumps that repeat have a dwell time.
std::vector<ReportedNumber> telegraph_numbers(const FittedEffect& effect) {
  std::vector<ReportedNumber> out = coefficient_numbers(effect);
  const Subject& subject = effect.subject();
  const std::vector<TwoLevelCourse>* const courses = courses_in(effect.term(), subject);
  if (courses == nullptr) return out;
  double jumps = 0.0;
  double seconds = 0.0;
  for (std::size_t k = 0; k < courses->size(); ++k) {
    jumps += static_cast<double>((*courses)[k].jumps.size());
    seconds += subject.seconds(k);
  }
  out.push_back({"jumps", jumps, "1"});
  if (!leaves_once(*courses) && !comes_and_goes_once(*courses))
    out.push_back({"dwell_s", seconds / jumps, "s"});
  return out;
}

void place_of_step(const TriedTerm& tried, std::vector<ReportedNumber>& first,
                   std::vector<ReportedNumber>&) {
  const Subject& subject = tried.fitted.regression.subject();
  if (tried.cause == "step") add_first_jump(subject, *courses_in(*tried.term(), subject), first);
}

}  // namespace

const Effect& telegraph() {
  static const Effect kTelegraph{
      .name = "telegraph",
      .title = "random telegraph noise",
      .meaning =
          "Jumps between two levels, the same in all replicates, at times that are found in "
          "each.",
      .parameters = {{.name = "height",
                      .meaning = "distance of the levels",
                      .reported = "height",
                      .truth = true},
                     {.name = "dwell",
                      .meaning = "mean time between jumps",
                      .unit = "s",
                      .reported = "dwell_s",
                      .truth = true}},
      .coefficient = "height",
      .causes = {{.id = "telegraph",
                  .title = "random telegraph noise",
                  .physics = "A charge trap fills and empties: the bias jumps between two levels.",
                  .record_next = "longer than a hundred jumps, at constant temperature",
                  .looks_like = {"gauss_markov", "step"},
                  .family = "telegraph"}},
      .regressors = telegraph_regressors,
      .fit_with = fit_with_telegraph,
      .simulate = simulate_telegraph,
      .search = search_telegraph,
      .review = review_telegraph,
      .numbers = telegraph_numbers,
      .more_numbers = place_of_step,
  };
  return kTelegraph;
}

}  // namespace imunoise::effects
