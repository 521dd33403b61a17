// Messages described for readers that have no proto files.
#pragma once

#include <string>

#include <google/protobuf/descriptor.h>

namespace spindrift::foxglove {

/// Returns a serialized google.protobuf.FileDescriptorSet with the message and the types that it needs, files before
/// those that import them. Other types of their files and all options are left out: the set of a small message is
/// small, and needs no other file.
std::string schemaSetOf(const google::protobuf::Descriptor& message);

}  // namespace spindrift::foxglove
