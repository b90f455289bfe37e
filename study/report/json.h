#pragma once

#include <google/protobuf/message.h>

#include <string>

namespace imunoise::report {

/// A message in protobuf's JSON mapping as the house writes it: proto field names, zeros and empty
/// lists printed, enums as words, 64-bit integers as strings, indented by two, each list of numbers
/// on one line.
///
/// A field that is NaN or infinite is absent. (protobuf's own printer writes the words "NaN" and
/// "Infinity", which are no numbers, and cannot leave out one field while it prints the zeros of
/// others.) A list has no absent entries: a non-finite one is a programming error and asserts;
/// without assertions it is written as null. Messages must have no maps, bytes or well-known types.
/// Thread-safe.
std::string to_json(const google::protobuf::Message& message);

}  // namespace imunoise::report
