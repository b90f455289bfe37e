#pragma once

#include <Eigen/Core>
#include <vector>

namespace imunoise {

/// A part of a series of independent normal numbers whose power is not that of the rest.
struct PowerSpell {
  Eigen::Index begin = 0;
  Eigen::Index end = 0;
  double nats = 0.0;   ///< gained by two powers over one
  double ratio = 1.0;  ///< of the power within to that outside
  double error = 0.0;  ///< standard error of its logarithm

  Eigen::Index size() const { return end - begin; }
};

/// The likelihood ratio of this part; without gain where a power is zero.
PowerSpell power_spell(const Eigen::VectorXd& white, Eigen::Index begin, Eigen::Index end);

/// The part of most likelihood between a 16th and seven eighths of the series; empty where it is
/// too short. By chance it gains more than x nats at most as often as the best of kSpells separate
/// parts would.
PowerSpell best_spell(const Eigen::VectorXd& white);
inline constexpr double kSpells = 800.0;

/// The part of most likelihood that begins where this one ends, or ends where it begins.
PowerSpell best_beside(const Eigen::VectorXd& white, const PowerSpell& spell);

/// Of two spells that were taken for one, with what lies between them, the clearer one; else the
/// spell itself.
PowerSpell without_gap(const Eigen::VectorXd& white, const PowerSpell& spell);

/// How much more the squares of such a series scatter than those of normal numbers of two powers;
/// at least 1.
double excess_scatter(const Eigen::VectorXd& white, const PowerSpell& spell);

/// Some series without their spells that are beyond doubt: these make tails on the whole.
std::vector<Eigen::VectorXd> beside_spells(std::vector<Eigen::VectorXd> white);

/// 1 in the spell, 0 elsewhere. Ends are slopes `width` samples wide, but where the series ends.
Eigen::VectorXd course_of(const PowerSpell& spell, Eigen::Index samples, double width);

/// Nats by which a power that changes at once is likelier than one that changes as slowly as the
/// spell is long, by slopes a quarter of it wide. The best of many places has sharp ends by chance.
double sharpness(const Eigen::VectorXd& white, const PowerSpell& spell);

}  // namespace imunoise
