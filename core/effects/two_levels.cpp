#include "core/effects/two_levels.h"

#include <algorithm>
#include <cmath>

#include "core/search/evidence.h"
#include "core/spectrum/cosine_transform.h"
#include "core/support/linear_algebra.h"
#include "core/support/parallel.h"

namespace imunoise {
namespace {

using Index = Eigen::Index;

constexpr Index kGrid = 512;  // places of a replicate where a jump is tried

// Steps at the grid's places 0 … kGrid, of which the first and last are nothing.
class Grid {
 public:
  explicit Grid(const StepProducts& steps)
      : product_(kGrid + 1), information_(kGrid + 1, kGrid + 1) {
    for (Index i = 0; i <= kGrid; ++i) {
      product_(i) = steps.product(time_of(i, steps.size()));
      for (Index j = 0; j <= kGrid; ++j)
        information_(i, j) = steps.information(time_of(i, steps.size()), time_of(j, steps.size()));
    }
  }
  static Index time_of(Index place, Index samples) { return place * samples / kGrid; }
  const Eigen::VectorXd& products() const { return product_; }
  double product(Index i) const { return product_(i); }
  double information(Index i, Index j) const { return information_(i, j); }
  auto informations(Index i) const { return information_.col(i); }
  /// Of a pulse that is 1 between two places.
  double pulse(Index i, Index j) const {
    return information_(i, i) + information_(j, j) - 2.0 * information_(i, j);
  }

 private:
  Eigen::VectorXd product_;
  Eigen::MatrixXd information_;
};

using Course = TwoLevelCourse;  // with places instead of samples until it is found

// The course as a sum of steps: +1 and -1 in turn.
struct Fit {
  double product = 0.0;
  double information = 0.0;
};
template <class Steps>
Fit fit_of(const Course& course, const Steps& steps) {
  Fit out;
  double up = course.start < 0.0 ? 1.0 : -1.0;
  for (const Index i : course.jumps) {
    out.product += up * steps.product(i);
    double other = course.start < 0.0 ? 1.0 : -1.0;
    for (const Index j : course.jumps) {
      out.information += up * other * steps.information(i, j);
      other = -other;
    }
    up = -up;
  }
  return out;
}

// The height that goes with the courses, and what it gains. False: they have none.
template <class Steps>
bool weigh(TwoLevels& found, const std::vector<Steps>& replicates) {
  Fit all;
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    const Fit one = fit_of(found.courses[k], replicates[k]);
    all.product += one.product;
    all.information += one.information;
  }
  if (!(all.product > 0.0)) return false;
  found.height = all.product / all.information;
  found.gain_nats = 0.5 * all.product * found.height;
  return true;
}

// Products of the steps with what a course of this height leaves.
Eigen::VectorXd left_by(const Course& course, const Grid& grid, double height) {
  Eigen::VectorXd out = grid.products();
  double up = course.start < 0.0 ? 1.0 : -1.0;
  for (const Index i : course.jumps) {
    out -= height * up * grid.informations(i);
    up = -up;
  }
  return out;
}

// The stretch within one level whose flip is worth most.
struct Flip {
  Index from = 0;
  Index to = 0;
  double worth = 0.0;  // nats, less the price of jumps
};

Flip best_flip(const Course& course, const Grid& grid, double height, double price) {
  const Eigen::VectorXd left = left_by(course, grid, height);
  Flip best;
  double level = course.start;
  for (std::size_t s = 0; s <= course.jumps.size(); ++s, level = -level) {
    const Index begin = s == 0 ? 0 : course.jumps[s - 1];
    const Index end = s == course.jumps.size() ? kGrid : course.jumps[s];
    const double change = -2.0 * level * height;
    for (Index i = begin; i < end; ++i) {
      const double first = i > begin ? 1.0 : i > 0 ? -1.0 : 0.0;
      for (Index j = i + 1; j <= end; ++j) {
        const double last = j < end ? 1.0 : j < kGrid ? -1.0 : 0.0;
        const double worth = change * (left(i) - left(j)) -
                             0.5 * change * change * grid.pulse(i, j) - price * (first + last);
        if (worth > best.worth) best = {i, j, worth};
      }
    }
  }
  return best;
}

void toggle(std::vector<Index>& jumps, Index place) {
  const auto at = std::lower_bound(jumps.begin(), jumps.end(), place);
  if (at != jumps.end() && *at == place) {
    jumps.erase(at);
  } else {
    jumps.insert(at, place);
  }
}

void climb(Course& course, const Grid& grid, double height, double price) {
  constexpr int kMostFlips = 200;
  for (int i = 0; i < kMostFlips; ++i) {
    const Flip flip = best_flip(course, grid, height, price);
    if (!(flip.worth > 1e-9)) return;
    if (flip.from == 0) {
      course.start = -course.start;
    } else {
      toggle(course.jumps, flip.from);
    }
    if (flip.to < kGrid) toggle(course.jumps, flip.to);
  }
}

double log_choices(double places, double chosen) {
  return std::lgamma(places + 1.0) - std::lgamma(chosen + 1.0) - std::lgamma(places - chosen + 1.0);
}

void count_places(TwoLevels& found) {
  found.jumps = 0;
  for (Course& one : found.courses) {
    found.jumps += one.jumps.size();
    one.log_places =
        std::log(2.0) + log_choices(kGrid - 1.0, static_cast<double>(one.jumps.size()));
  }
}

TwoLevels climb_all(const std::vector<Grid>& grids, double height, double price) {
  TwoLevels out{.courses = std::vector<Course>(grids.size()), .height = height};
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    for_each_index(grids.size(),
                   [&](std::size_t k) { climb(out.courses[k], grids[k], out.height, price); });
    const double before = out.height;
    if (!weigh(out, grids)) break;
    if (std::abs(out.height - before) < 1e-6 * before) break;
  }
  count_places(out);
  return out;
}

void to_samples(TwoLevels& found, const std::vector<StepProducts>& replicates) {
  for (std::size_t k = 0; k < replicates.size(); ++k) {
    for (Index& jump : found.courses[k].jumps) jump = Grid::time_of(jump, replicates[k].size());
  }
}

// What it is worth that one jump is at a sample, the others where they are; up to a constant.
double worth_at(Index at, std::size_t which, const Course& course, const StepProducts& steps,
                double height) {
  double up = course.start < 0.0 ? 1.0 : -1.0;
  double own = 0.0;
  double across = 0.0;
  for (std::size_t i = 0; i < course.jumps.size(); ++i, up = -up) {
    if (i == which) {
      own = up;
    } else {
      across += up * steps.information(at, course.jumps[i]);
    }
  }
  return height *
         (own * steps.product(at) - height * (own * across + 0.5 * steps.information(at, at)));
}

// Moves every jump to its best time within a cell of the grid.
void refine(TwoLevels& found, const std::vector<StepProducts>& replicates) {
  constexpr Index kParts = 8;
  for_each_index(replicates.size(), [&](std::size_t k) {
    const StepProducts& steps = replicates[k];
    Course& course = found.courses[k];
    const Index cell = steps.size() / kGrid;
    const Index stride = std::max<Index>(1, cell / kParts);
    const auto shift = [&](std::size_t i, Index reach, Index by) {
      const Index first = std::max(course.jumps[i] - reach, i > 0 ? course.jumps[i - 1] + 1 : 1);
      const Index last =
          std::min(course.jumps[i] + reach,
                   i + 1 < course.jumps.size() ? course.jumps[i + 1] - 1 : steps.size() - 1);
      Index best = course.jumps[i];
      double most = worth_at(best, i, course, steps, found.height);
      for (Index t = first; t <= last; t += by) {
        if (const double one = worth_at(t, i, course, steps, found.height); one > most) {
          most = one;
          best = t;
        }
      }
      course.jumps[i] = best;
    };
    for (std::size_t i = 0; i < course.jumps.size(); ++i) {
      shift(i, cell, stride);
      // A jump that stands out of the noise is known to the sample.
      for (Index by = stride; by > 1; by = (by + 1) / 2) shift(i, by, std::max<Index>(1, by / 2));
    }
  });
  weigh(found, replicates);
}

// The best flip of less than a cell within one level, from one sample to another.
Flip best_brief(const StepProducts& steps, const Eigen::VectorXd& left, Index begin, Index end,
                double change) {
  const Index cell = steps.size() / kGrid;
  Flip best;
  for (Index length = 1; length <= cell; length += 1 + length / 4) {
    for (Index i = begin + 1; i + length < end; ++i) {
      const Index j = i + length;
      const double pulse =
          steps.information(i, i) + steps.information(j, j) - 2.0 * steps.information(i, j);
      const double worth = change * (left(i) - left(j)) - 0.5 * change * change * pulse;
      if (worth > best.worth) best = {i, j, worth};
    }
  }
  return best;
}

// Levels far apart show dwells that are shorter than the grid: one between two jumps at a time.
void add_brief(TwoLevels& found, const std::vector<StepProducts>& replicates) {
  constexpr int kRounds = 4;
  for_each_index(replicates.size(), [&](std::size_t k) {
    const StepProducts& steps = replicates[k];
    Course& course = found.courses[k];
    const Index n = steps.size();
    const double price = 2.0 * std::log(static_cast<double>(n));
    const double longest =
        2.0 * (steps.information(n / 2, n / 2) - steps.information(n / 2, n / 2 + n / kGrid));
    if (0.5 * found.height * found.height * longest < price) return;
    for (int round = 0; round < kRounds; ++round) {
      Eigen::VectorXd left(n + 1);
      for (Index t = 0; t <= n; ++t) left(t) = steps.product(t);
      double up = course.start < 0.0 ? found.height : -found.height;
      for (const Index jump : course.jumps) {
        for (Index t = 0; t <= n; ++t) left(t) -= up * steps.information(t, jump);
        up = -up;
      }
      std::vector<Index> more;
      double level = course.start;
      for (std::size_t s = 0; s <= course.jumps.size(); ++s, level = -level) {
        const Index begin = s == 0 ? 0 : course.jumps[s - 1];
        const Index end = s == course.jumps.size() ? n : course.jumps[s];
        const Flip flip = best_brief(steps, left, begin, end, -2.0 * level * found.height);
        if (flip.worth > price) more.insert(more.end(), {flip.from, flip.to});
      }
      if (more.empty()) return;
      course.jumps.insert(course.jumps.end(), more.begin(), more.end());
      std::sort(course.jumps.begin(), course.jumps.end());
    }
  });
  count_places(found);
}

// How many places each jump could as well have, the others where they are: the sum of likelihoods
// over its times, relative to its best (the marginal likelihood that Laplace's method gives). In
// cells of the grid, as places are counted.
void widen(TwoLevels& found, const std::vector<StepProducts>& replicates) {
  constexpr Index kTimes = 256;  // at which each jump is tried
  for_each_index(replicates.size(), [&](std::size_t k) {
    const StepProducts& steps = replicates[k];
    Course& course = found.courses[k];
    const double cell = static_cast<double>(steps.size()) / kGrid;
    for (std::size_t i = 0; i < course.jumps.size(); ++i) {
      const Index first = i > 0 ? course.jumps[i - 1] + 1 : 1;
      const Index last = i + 1 < course.jumps.size() ? course.jumps[i + 1] - 1 : steps.size() - 1;
      const double best = worth_at(course.jumps[i], i, course, steps, found.height);
      // Near its best time in steps of one sample, then in wider and wider ones.
      double sum = 1.0;
      for (const Index direction : {-1, 1}) {
        const Index room = direction < 0 ? course.jumps[i] - first : last - course.jumps[i];
        Index done = 0;
        for (Index n = 0; n < kTimes && done < room; ++n) {
          const Index stride = std::min(room - done, 1 + done / 16);
          done += stride;
          const double moved =
              worth_at(course.jumps[i] + direction * done, i, course, steps, found.height);
          sum += static_cast<double>(stride) * std::exp(std::min(0.0, moved - best));
        }
      }
      course.log_width += std::log(sum / cell);
    }
  });
}

// The height of the pulse that gains most in any replicate.
double best_pulse(const std::vector<Grid>& grids) {
  double most = 0.0;
  double height = 0.0;
  for (const Grid& grid : grids) {
    for (Index i = 0; i < kGrid; ++i) {
      for (Index j = i + 1; j <= kGrid; ++j) {
        const double information = grid.pulse(i, j);
        const double product = grid.product(i) - grid.product(j);
        if (!(product * product > most * information)) continue;
        most = product * product / information;
        height = std::abs(product) / information;
      }
    }
  }
  return height;
}

Eigen::VectorXd samples_of(const Course& course, Index n) {
  Eigen::VectorXd out(n);
  Index begin = 0;
  double level = course.start;
  for (const Index jump : course.jumps) {
    out.segment(begin, jump - begin).setConstant(level);
    begin = jump;
    level = -level;
  }
  out.tail(n - begin).setConstant(level);
  return out;
}

}  // namespace

TwoLevels find_two_levels(const std::vector<StepProducts>& replicates) {
  const auto worth = [](const TwoLevels& one) { return one.gain_nats - log_places(one.courses); };
  std::vector<Grid> grids;
  for (const StepProducts& one : replicates) grids.emplace_back(one);
  const double height = best_pulse(grids);
  TwoLevels best;
  // A pulse among jumps that are not yet known looks lower, or higher, than it is; and a jump costs
  // the less the more there are.
  for (const double price : {2.5, 4.0}) {
    for (const double share : {0.6, 1.0}) {
      TwoLevels found = climb_all(grids, share * height, price);
      if (best.courses.empty() || worth(found) > worth(best)) best = std::move(found);
    }
  }
  to_samples(best, replicates);
  refine(best, replicates);
  const std::size_t known = best.jumps;
  add_brief(best, replicates);
  if (best.jumps > known) refine(best, replicates);
  widen(best, replicates);
  for (std::size_t k = 0; k < best.courses.size(); ++k)
    best.courses[k].cosines = cosine_transform(samples_of(best.courses[k], replicates[k].size()));
  return best;
}

double log_places(const std::vector<TwoLevelCourse>& courses) {
  double out = 0.0;
  double jumps = 0.0;
  for (const TwoLevelCourse& one : courses) {
    out += one.log_places;
    jumps += static_cast<double>(one.jumps.size());
  }
  return out + log_number(jumps);
}

TestOutcome more_levels(const FittedModel& fitted, const std::vector<TwoLevelCourse>& courses) {
  const std::vector<StepProducts> steps = step_products(current_of(fitted.regression, fitted.fit));
  double chi = 0.0;
  Index dof = -1;
  for (std::size_t k = 0; k < courses.size(); ++k) {
    const std::vector<Index>& jumps = courses[k].jumps;
    const auto count = static_cast<Index>(jumps.size());
    if (count == 0) continue;
    Eigen::VectorXd product(count);
    Eigen::MatrixXd information(count, count);
    for (Index i = 0; i < count; ++i) {
      product(i) = steps[k].product(jumps[static_cast<std::size_t>(i)]);
      for (Index j = 0; j < count; ++j) {
        information(i, j) = steps[k].information(jumps[static_cast<std::size_t>(i)],
                                                 jumps[static_cast<std::size_t>(j)]);
      }
    }
    chi += product.dot(pseudo_inverse(information).matrix * product);
    dof += count;
  }
  return chi_square_test(chi, std::max<Index>(0, dof));
}

}  // namespace imunoise
