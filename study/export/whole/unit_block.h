#pragma once

#include <Eigen/Core>

#include "core/process/process.h"
#include "core/support/result.h"

namespace imunoise::study {

/// A process of unit power as a linear recursion: Q, R and P0 grow with its power.
struct UnitBlock {
  Eigen::MatrixXd phi = Eigen::MatrixXd(0, 0);
  Eigen::MatrixXd q = Eigen::MatrixXd(0, 0);
  Eigen::RowVectorXd h = Eigen::RowVectorXd(0);
  Eigen::MatrixXd p0 = Eigen::MatrixXd(0, 0);
  double r = 0.0;
};

/// Error: a filter of more than 64 taps. Precondition: not a rate ramp, whose state is the bias of
/// another process.
Result<UnitBlock> unit_block(const Process& process);

}  // namespace imunoise::study
