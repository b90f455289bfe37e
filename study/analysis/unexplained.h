#pragma once

// One number for the ladder: how much of the data a model leaves unexplained, against the best
// model that is known.

#include <optional>

#include "imunoise/v1/study.pb.h"

namespace imunoise::study {

/// Fills `unexplained`, its interval, `forecast`, `single_replicate_nats`, `consequence` and the
/// `best` of every integrated error in a report's ladder, and what its candidates promise.
/// `settled`: the rung on which a diagnosis found nothing more, if there is one.
///
/// unexplained = 1 + 2·(N* - N)/(scales × replicates), N the held-out log-likelihood of a rung and
/// N* the highest that any rung reaches, that its significant candidates promise on held-out data,
/// or that the misfits of the best rung stand for (promised_nats): 1 is the floor.
/// Rungs without held-out likelihoods are left as they are.
void tell_unexplained(v1::DiagnosisReport& report, std::optional<int> settled);

/// The same for all attempts of a study and the previews of its candidates.
void tell_unexplained(v1::Study& study);

}  // namespace imunoise::study
