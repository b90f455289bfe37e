#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "core/process/process.h"
#include "core/support/result.h"

namespace imunoise {

/// Whose a term is when several sensors are modelled together.
enum class Sharing {
  kOwn,         ///< each sensor has a process of its own, independent of the others': RW
  kCorrelated,  ///< each has its own, of one shape, correlated at equal times: RW[corr]
  kGroup,       ///< one process, the same in every sensor of a group: RW[group]
  kAll,         ///< one process, the same in every sensor: RW[all]
};
/// "corr", "group", "all"; "" for kOwn.
std::string_view word_of(Sharing sharing);

/// How a parameter follows a covariate.
enum class Link {
  kConstant,     ///< it does not
  kExponential,  ///< powers and times, exp(a + b·c): sigma2~exp
  kLinear,       ///< powers, a + b·c, nowhere negative: sigma2~linear
  kLogistic,     ///< all others, logistic(a + b·c) between their bounds: phi~logistic
};
/// "exp", "linear", "logistic"; "" for kConstant.
std::string_view word_of(Link link);

/// What becomes of a parameter away from the middle of the covariate's range; see trend.h.
struct Trend {
  Link link = Link::kConstant;
  double slope = 0.0;  ///< b, on the scale of the link, per half of the range
  friend bool operator==(const Trend&, const Trend&) = default;
};

/// One term of a model: a process, and which of its parameters the user gave (they stay as they
/// are).
struct Term {
  Process process;            ///< in the middle of the covariate's range where there is one
  std::vector<bool> given;    ///< one entry a parameter
  std::vector<Trend> trends;  ///< one entry a parameter
  Sharing sharing = Sharing::kOwn;

  explicit Term(Process p)
      : process(std::move(p)), given(parameters(process).size(), false), trends(given.size()) {}
  friend bool operator==(const Term&, const Term&) = default;
};

/// A noise model: independent processes that add up.
struct Model {
  std::vector<Term> terms;
  friend bool operator==(const Model&, const Model&) = default;
};

/// Reads a noise model as people write it: `2*AR1 + WN + RW`, `WN(sigma2=1e-4) + GM(tc=120)`,
/// `MA(2) + RW` (core/model/syntax.h has the rules).
///   item := number | name '=' value | name '~' [ link ];  sharing := corr | group | all;
///   link := exp | linear | logistic
/// Parameters are per sample, in SI units; GM's tc is in seconds (hence the rate). Names ignore
/// case. Error: what is wrong, with the text and a caret under the character.
Result<Model> parse_model(std::string_view text, Hertz rate);
/// The same for several sensors: only such a model may say how a process is shared.
Result<Model> parse_array_model(std::string_view text, Hertz rate);
/// The same over a covariate: only such a model may say which parameters follow it, and how.
Result<Model> parse_dynamic_model(std::string_view text, Hertz rate);

/// The model in the grammar, with the values that were given: parse_model(print(m)) == m.
std::string print(const Model& model);
/// The same with every value and no trends, as after a fit: what `imunoise simulate` takes.
std::string print_with_values(const Model& model);

/// A parameter of a model, by its place.
struct ParameterPlace {
  std::size_t term;
  std::size_t parameter;  ///< of its process; 0 is its power
};
/// Every parameter of all terms, in order: the one list that columns of jacobian(), covariances and
/// reports follow.
std::vector<ParameterPlace> parameter_places(const Model& model);
/// Number of parameters of all terms.
std::size_t parameter_count(const Model& model);
/// True when every parameter was given: such a model can be simulated.
bool complete(const Model& model);

/// Wavelet variance of the sum, in unit².
Eigen::ArrayXd variance(const Model& model, HalfWidths m);
/// dν / d(every parameter in order of the terms): scales × parameters.
Eigen::MatrixXd jacobian(const Model& model, HalfWidths m);
/// Two-sided spectrum of the sum at frequencies in cycles per sample, unit² per cycle/sample. A
/// ramp has none.
Eigen::ArrayXd spectrum(const Model& model, const Frequencies& frequency);
/// Of the longest filter of finite memory in it; 0 without one.
int most_taps(const Model& model);
/// Standard deviation of its innovations, from the mean logarithm of the spectrum (Szegő and
/// Kolmogorov: Brockwell & Davis 1991, Theorem 5.8.1).
double innovation_deviation(const Model& model);
/// Covariance of the prefix sums of the whole model.
SumCovariance sum_covariance(const Model& model);

/// Brings a fitted model into its unique form: equal processes are ordered by their shape, so that
/// of several AR1 the one with the longest correlation time comes first.
Model sorted(Model model);

/// One realisation of n samples. Each term has a stream of its own under (seed, replicate).
std::vector<double> simulate(const Model& model, std::size_t n, std::uint64_t seed,
                             std::uint32_t replicate);

}  // namespace imunoise
