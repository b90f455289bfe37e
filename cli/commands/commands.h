#pragma once

#include "cli/arguments.h"

namespace imunoise::cli {

/// Each runs one command and returns the exit status.
int run(const DriversArguments& arguments);
int run(const WvArguments& arguments);
int run(const FitArguments& arguments);
int run(const SimulateArguments& arguments);
int run(const TestArguments& arguments);
int run(const SelectArguments& arguments);
int run(const ArrayArguments& arguments);
int run(const MixedArguments& arguments);
int run(const FaultsArguments& arguments);
int run(const DynamicArguments& arguments);
int run(const DecodeArguments& arguments);
int run(const DiagnoseArguments& arguments);
int run(const StudyArguments& arguments);
int run(const OpenArguments& arguments);
int run(const EmulateArguments& arguments);
int run(const RecordArguments& arguments);
int run(const VerifyArguments& arguments);
int run(const CalibrateArguments& arguments);
int run(const ExportArguments& arguments);
int run(const DatasheetArguments& arguments);
int run(const RecordingsArguments& arguments);
int run(const CalibrationsArguments& arguments);
int run(const HistoryArguments& arguments);
int run(const DevicesArguments& arguments);
int run(const CampaignsArguments& arguments);
int run(const LiveArguments& arguments);
int run(const StatusArguments& arguments);
int run(const StartArguments& arguments);
int run(const StopArguments& arguments);
int run(const BatchNewArguments& arguments);
int run(const BatchRunArguments& arguments);
int run(const BatchShardArguments& arguments);
int run(const BatchStatusArguments& arguments);
int run(const BatchMergeArguments& arguments);

}  // namespace imunoise::cli
