#pragma once

#include <google/protobuf/repeated_ptr_field.h>

#include "imunoise/v1/preflight.pb.h"
#include "study/report/documents/document.h"
#include "study/words/number.h"

namespace imunoise::report {

/// Adds a section for each file: what was recognised, and every finding. For pages: the terminal
/// tells it before anything is computed.
void add_files(const google::protobuf::RepeatedPtrField<v1::Preflight>& files, Digits digits,
               Document& to);

}  // namespace imunoise::report
