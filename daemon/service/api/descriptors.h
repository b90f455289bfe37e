#pragma once

#include <string_view>

namespace imunoise::service {

/// The files of the API as a google.protobuf.FileDescriptorSet with comments, in binary form.
std::string_view descriptor_set();

}  // namespace imunoise::service
