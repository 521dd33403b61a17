// Descriptions of messages that travel with them.
#pragma once

#include <google/protobuf/descriptor.h>

#include <spindrift/core/bytes.h>

namespace spindrift::recording {

/// Returns a serialized google.protobuf.FileDescriptorSet with the message's file and all that it imports, each file
/// after those that it needs.
core::Bytes descriptorSetOf(const google::protobuf::Descriptor& message);

}  // namespace spindrift::recording
