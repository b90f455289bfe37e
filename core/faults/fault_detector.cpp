#include "core/faults/fault_detector.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace imunoise {
namespace {

constexpr double kMostOften = 0.01;         // of a block: no test alarms by chance more often
constexpr std::size_t kFewestAwaited = 32;  // readings between an alarm and its verdict

// The directions along which more white noise of each sensor would show.
Eigen::MatrixXd noise_directions(const InnovationFilter& filter,
                                 const std::vector<Eigen::Index>& used) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(used.size()), filter.outputs());
  for (std::size_t i = 0; i < used.size(); ++i) {
    out.row(static_cast<Eigen::Index>(i)) =
        filter.step_response(used[i], 1).col(0).normalized().transpose();
  }
  return out;
}

}  // namespace

FaultDetector::FaultDetector(ArrayModel model, Hertz rate, FaultOptions options)
    : model_(std::move(model)),
      rate_(rate),
      options_(std::move(options)),
      used_(static_cast<std::size_t>(model_.sensors)) {
  std::iota(used_.begin(), used_.end(), Eigen::Index{0});
  options_.resolution.resize(used_.size(), 0.0);
  design();
  begin();
}

void FaultDetector::design() {
  designed_ = {};
  if (used_.size() < 2) used_.clear();
  if (used_.empty()) return;
  parity_ = parity_rows(model_.sensors, used_);
  const double share = options_.false_alarms_per_hour / (3600.0 * rate_.value) / kFaultKinds;
  std::size_t lengths = 1;
  while ((static_cast<std::size_t>(InnovationFilter::kHistory) << lengths) <= options_.longest) {
    ++lengths;
  }
  for (std::size_t l = 0; l < lengths; ++l) {
    const std::int64_t block = std::int64_t{1} << l;
    const double alarms = share * static_cast<double>(block) / static_cast<double>(lengths);
    const Eigen::Index fewest = l == 0 ? 1 : StepWatch::kMostBlocks / 2 + 1;
    designed_.steps.emplace_back(model_, options_.doubt, used_, block, fewest,
                                 std::min(kMostOften, alarms));
  }
  const auto count = static_cast<Eigen::Index>(used_.size());
  const InnovationFilter& parity = designed_.steps.front().filter();
  const Eigen::MatrixXd directions = noise_directions(parity, used_);
  designed_.noise.emplace_back(directions, options_.doubt.degrees(parity, directions), share);
  designed_.noise.emplace_back(Eigen::MatrixXd::Identity(count, count));
  for (const Eigen::Index sensor : used_) {
    designed_.own.emplace_back(InnovationFilter(model_, sensor_row(model_.sensors, sensor), 1));
  }
  designed_.stuck.emplace_back(model_, used_, options_.resolution, share);
}

void FaultDetector::begin() {
  now_ = designed_;
  half_.assign(now_.steps.size(), {});
  suspicion_.reset();
  learnt_ = 0;
}

void FaultDetector::restart() {
  taken_ = 0;
  begin();
}

std::vector<std::size_t> FaultDetector::repetitions() const {
  return now_.stuck.empty() ? std::vector<std::size_t>{} : now_.stuck.front().repetitions();
}

// Each returns for how many readings more evidence is worth waiting, 0 without an alarm.
std::size_t FaultDetector::step_alarm(const Eigen::VectorXd& readings) {
  Eigen::VectorXd mean = parity_ * readings;
  std::size_t wait = 0;
  blocks_ended_ = 0;
  for (std::size_t number = learnt_ - 1;; number /= 2) {
    StepWatch& watch = now_.steps[blocks_ended_];
    if (watch.feed(mean) && wait == 0) wait = static_cast<std::size_t>(4 * watch.block());
    if (++blocks_ended_ == now_.steps.size()) break;
    if (number % 2 == 0) {
      half_[blocks_ended_] = mean;
      break;
    }
    mean = 0.5 * (mean + half_[blocks_ended_]);
  }
  return wait;
}

std::size_t FaultDetector::noise_alarm(const Eigen::VectorXd& readings) {
  Eigen::VectorXd own(static_cast<Eigen::Index>(used_.size()));
  for (std::size_t i = 0; i < used_.size(); ++i) {
    now_.own[i].feed(readings.segment(used_[i], 1));
    own(static_cast<Eigen::Index>(i)) = now_.own[i].innovation()(0);
  }
  const Eigen::VectorXd* const innovation = now_.steps.front().innovation();
  noise_seen_ = innovation != nullptr;
  if (!noise_seen_) return 0;
  now_.noise[1].feed(own);
  if (!now_.noise[0].feed(*innovation)) return 0;
  std::size_t longest = 1;
  for (Eigen::Index i = 0; i < own.size(); ++i) {
    longest = std::max(longest, now_.noise[0].strongest(i).samples);
  }
  return longest;
}

std::size_t FaultDetector::stuck_alarm(const Eigen::Ref<const Eigen::VectorXd>& readings) {
  return now_.stuck.front().feed(readings) ? 1 : 0;
}

void FaultDetector::gather() {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    for (std::size_t l = 0; l < blocks_ended_; ++l) {
      const StepEvidence step = now_.steps[l].strongest(at);
      const auto readings = static_cast<std::size_t>(step.blocks * now_.steps[l].block());
      suspicion_->offer(FaultKind::kStep, i,
                        {0.5 * step.z * step.z, step.size, step.error, taken_ - readings, taken_});
    }
    const std::size_t repeated = now_.stuck.front().repeated(at);
    suspicion_->offer(FaultKind::kStuck, i,
                      {now_.stuck.front().gain(at), static_cast<double>(repeated), 0.0,
                       taken_ - repeated, taken_});
    if (!noise_seen_) continue;
    const NoiseEvidence noise = now_.noise[0].strongest(at);
    const double unit = now_.steps.front().filter().step_response(used_[i], 1).norm();
    suspicion_->offer(FaultKind::kNoisy, i,
                      {noise.gain, std::sqrt(std::max(0.0, noise.ratio - 1.0)) / unit, 0.0,
                       taken_ - noise.samples, taken_});
    suspicion_->offer_own_noise(i, now_.noise[1].strongest(at).gain);
  }
}

std::optional<Fault> FaultDetector::feed(const Eigen::Ref<const Eigen::VectorXd>& readings) {
  if (used_.empty()) return std::nullopt;
  if (learnt_++ == 0) first_ = readings;
  ++taken_;
  const Eigen::VectorXd moved = readings - first_;
  const std::size_t wait = std::max({step_alarm(moved), noise_alarm(moved), stuck_alarm(readings)});
  if (wait > 0 && !suspicion_) {
    suspicion_.emplace(used_, taken_ - 1, taken_ + std::max(wait, kFewestAwaited));
  }
  if (!suspicion_) return std::nullopt;
  gather();
  const bool decided = suspicion_->due(taken_) && !now_.stuck.front().in_doubt();
  return decided ? decide() : std::nullopt;
}

std::optional<Fault> FaultDetector::finish() { return suspicion_ ? decide() : std::nullopt; }

std::optional<Fault> FaultDetector::decide() {
  const Fault out = suspicion_->verdict();
  const bool stays_wrong = out.kind != FaultKind::kStep && out.end == 0;
  if (stays_wrong) {
    std::erase_if(used_, [&](Eigen::Index sensor) {
      return std::find(out.sensors.begin(), out.sensors.end(), sensor) != out.sensors.end();
    });
    design();
  }
  begin();
  return out;
}

}  // namespace imunoise
