#include "study/analysis/arrays/regressors.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "core/effect/subject.h"
#include "core/spectrum/cosine_transform.h"
#include "core/spectrum/cross_power.h"
#include "core/support/linear_algebra.h"

namespace imunoise::study {
namespace {

constexpr std::string_view kTime = "time";

// A regressor as it was written.
struct Written {
  std::string name;
  std::vector<std::string> channels;  // one for all series, or one each; none for the time
};

Written read(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    return {text, text == kTime ? std::vector<std::string>{} : std::vector<std::string>{text}};
  }
  Written out{text.substr(0, equals), {}};
  std::istringstream list(text.substr(equals + 1));
  for (std::string one; std::getline(list, one, ',');) out.channels.push_back(one);
  return out;
}

Result<const Series*> find(const std::vector<Series>& channels, const std::string& name) {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const Series& s) { return s.channel == name; });
  if (found != channels.end()) return &*found;
  std::string known;
  for (const Series& one : channels) known += (known.empty() ? "" : ", ") + one.channel;
  return fail(
      fmt::format("regress: there is no channel '{}'; there are {}, and time", name, known));
}

Result<Eigen::MatrixXd> values_of(const Written& written, const std::vector<Series>& channels,
                                  const Eigen::MatrixXd& response, Hertz rate) {
  const Eigen::Index n = response.rows();
  const Eigen::Index series = response.cols();
  if (written.channels.empty()) {
    return Eigen::VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / rate.value)
        .replicate(1, series)
        .eval();
  }
  const auto count = static_cast<Eigen::Index>(written.channels.size());
  if (count != 1 && count != series) {
    return fail(
        fmt::format("regress: {} names {} channels for {} series; name one for all, or one each",
                    written.name, count, series));
  }
  Eigen::MatrixXd out(n, series);
  for (Eigen::Index i = 0; i < series; ++i) {
    const std::string& name = written.channels[static_cast<std::size_t>(count == 1 ? 0 : i)];
    const Result<const Series*> found = find(channels, name);
    if (!found) return tl::unexpected(found.error());
    out.col(i) = samples_of(std::span((*found)->replicates).first(1));
    if ((out.col(i).array() == out(0, i)).all())
      return fail(fmt::format("regress: {} never changes: a constant is there already", name));
  }
  return out;
}

// "m/s²/K"; nothing where it is a bare number.
std::string unit_over(const Series& response, const Written& written,
                      const std::vector<Series>& channels) {
  const std::string above(si_symbol(response.replicates.front().quantity()));
  if (written.channels.empty()) return above + "/s";
  const auto found = find(channels, written.channels.front());
  const std::string below(si_symbol((*found)->replicates.front().quantity()));
  const std::string unit = per(above, below);
  return unit == "1" ? "" : unit;
}

// Regressors that depend on each other linearly, by name, less the constants of the series; "" if
// none do. Their products would be inverted without the direction that they share, and each would
// get a part of what they do together.
std::string dependent(const Regression& of) {
  constexpr double kLeast = 1e-9;  // of a regressor's power, that the others do not have
  constexpr double kPart = 0.05;   // of the direction that they share
  const auto count = static_cast<Eigen::Index>(of.data.regressors.size());
  Eigen::MatrixXd all(of.data.response.size(), count);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::MatrixXd& one = of.data.regressors[static_cast<std::size_t>(j)];
    all.col(j) = (one.rowwise() - one.colwise().mean()).reshaped().normalized();
  }
  const SymmetricEigen found = symmetric_eigen(all.transpose() * all);
  std::string out;
  if (!(found.values(0) < kLeast)) return out;
  for (Eigen::Index j = 0; j < count; ++j) {
    if (std::abs(found.vectors(j, 0)) < kPart) continue;
    out += (out.empty() ? "" : ", ") + of.names[static_cast<std::size_t>(j)];
  }
  return out;
}

}  // namespace

std::vector<std::string> channels_of(const std::vector<std::string>& texts) {
  std::vector<std::string> out;
  for (const std::string& text : texts) {
    for (std::string& name : read(text).channels) out.push_back(std::move(name));
  }
  return out;
}

Result<Regression> read_regressors(const std::vector<Series>& channels,
                                   const std::vector<std::string>& texts) {
  if (texts.empty()) {
    return fail(
        "regress: name a regressor: a channel, time, or name=a,b,c; without any, use imunoise "
        "array");
  }
  std::vector<Written> written;
  std::set<std::string> names;
  for (const std::string& text : texts) {
    written.push_back(read(text));
    if (!names.insert(written.back().name).second)
      return fail(fmt::format("regress: {} is named twice", written.back().name));
  }
  const std::vector<std::string> named = channels_of(texts);
  const std::set<std::string> used(named.begin(), named.end());
  Regression out;
  std::vector<Signal> signals;
  for (const Series& one : channels) {
    if (used.contains(one.channel)) continue;
    out.responses.push_back(one);
    signals.push_back(one.replicates.front());
  }
  if (signals.empty())
    return fail("regress: every channel is a regressor; none is left to explain");
  if (signals.front().size() < kFewestSamples)
    return fail(fmt::format("too short: at least {} samples are needed", kFewestSamples));
  out.data = {samples_of(signals), {}, signals.front().rate()};
  for (const Written& one : written) {
    Result<Eigen::MatrixXd> values = values_of(one, channels, out.data.response, out.data.rate);
    if (!values) return tl::unexpected(values.error());
    out.data.regressors.push_back(std::move(*values));
    out.names.push_back(one.name);
    out.units.push_back(unit_over(out.responses.front(), one, channels));
  }
  if (const std::string all = dependent(out); !all.empty())
    return fail(
        fmt::format("regress: {} depend on each other linearly, so that their effects "
                    "cannot be told apart: leave one out",
                    all));
  return out;
}

}  // namespace imunoise::study
