// The messages of cluster.proto as bytes.
#pragma once

#include <optional>

#include <google/protobuf/message_lite.h>

#include <spindrift/core/bytes.h>

namespace spindrift::cluster {

inline core::Bytes serialize(const google::protobuf::MessageLite& message) {
  core::Bytes bytes(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(bytes.data());
  return bytes;
}

/// Nullopt for bytes that are not such a message.
template <typename Message>
std::optional<Message> parse(core::ByteView bytes) {
  Message message;
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return std::nullopt;
  return message;
}

}  // namespace spindrift::cluster
