#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace imunoise {

/// A tone of constant amplitude in white noise of variance 1. Its phase diffuses; its frequency is
/// one of a few places of a band and moves between neighbours: a hidden Markov model of phase and
/// frequency (of frequency alone: Streit & Barrett 1990, IEEE Trans. ASSP 38:586).
struct WanderingTone {
  static constexpr Eigen::Index kPlaces = 16;  ///< frequencies
  /// How much of its time the tone is at each.
  using Occupancy = Eigen::Array<double, kPlaces, 1>;

  double from = 0.0;  ///< the band, cycles per sample
  double to = 0.5;
  double amplitude = 1.0;   ///< over the noise's standard deviation
  double diffusion = 0.03;  ///< variance that the phase gains, rad² a sample
  double pace = 0.1;        ///< chance of a move between places that are taken alike, a sample

  double frequency(Eigen::Index place) const {
    return from + (to - from) * (static_cast<double>(place) + 0.5) / static_cast<double>(kPlaces);
  }
};

/// What is known of a tone after each sample, from those before it.
class ToneFilter {
 public:
  ToneFilter(const WanderingTone& tone, const WanderingTone::Occupancy& occupancy);

  struct Passed {
    double nats = 0.0;  ///< log-likelihood over that of white noise alone
    WanderingTone::Occupancy occupancy{};
  };
  Passed pass(const Eigen::Ref<const Eigen::VectorXd>& samples) const;
  /// The same, and each sample as a normal number that says where it lies among what those before
  /// it make likely (Rosenblatt 1952, Ann. Math. Stat. 23:470). If the tone is as it says, these
  /// numbers are white noise.
  Passed pass(const Eigen::Ref<const Eigen::VectorXd>& samples, Eigen::VectorXd& normal) const;

 private:
  static constexpr Eigen::Index kPhases = 32;
  using Phases = Eigen::Array<float, kPhases, 1>;
  using Chances = Eigen::Array<float, kPhases, WanderingTone::kPlaces>;

  template <bool kNormal>
  Passed filter(const Eigen::Ref<const Eigen::VectorXd>& samples, Eigen::VectorXd* normal) const;
  void move(const Chances& before, Chances& after) const;
  double normal_number(double sample, const Phases& chances) const;

  // A turn of the phase: by whole places, and what remains as weights of the places around.
  struct Turn {
    Eigen::Index whole = 0;
    std::vector<float> weights{};
  };

  Phases tone_;  // at each phase
  std::vector<Turn> turns_;
  WanderingTone::Occupancy occupancy_;
  Eigen::Array<float, WanderingTone::kPlaces, 1> up_;
  Eigen::Array<float, WanderingTone::kPlaces, 1> down_;
};

/// White noise of variance 1 with a tone.
struct ToneSeries {
  Eigen::VectorXd samples;
  double unit = 1.0;  ///< how much one is of the unit that amplitudes are told in
};

/// A tone fitted to several series, which share all but how often it is at each frequency.
struct FittedTone {
  WanderingTone tone;                               ///< its amplitude in the unit
  std::vector<WanderingTone::Occupancy> occupancy;  ///< of each series
  double nats = 0.0;                                ///< gained over white noise, all samples
  /// Whether there is a tone at all. If not, noise alone would seem as much of one once in 20.
  bool seen = false;
  double amplitude_error = 0.0;  ///< standard error, by all samples; of one that is seen
  double highest = INFINITY;     ///< the most that the amplitude may be (95 %); of one that is not

  ToneFilter filter(const ToneSeries& series, std::size_t number) const;
};

/// Of most likelihood, by some stretches of each.
FittedTone fit_tone(double from, double to, const std::vector<ToneSeries>& series);

}  // namespace imunoise
