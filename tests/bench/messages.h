// Messages that the clients of bench send.
#pragma once

#include <string>

#include <spindrift/core/bytes.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/client_message.h>

namespace spindrift::bench {

inline core::SharedBytes bytesOf(const v1::ClientMessage& message) {
  core::Bytes out(message.ByteSizeLong());
  message.SerializeWithCachedSizesToArray(out.data());
  return core::share(std::move(out));
}

/// `resume_key`: empty for a new person.
inline v1::ClientMessage helloOf(const std::string& token, const std::string& resume_key) {
  v1::ClientMessage out;
  out.mutable_hello()->mutable_version()->set_major(wire::kWireMajor);
  out.mutable_hello()->mutable_version()->set_minor(wire::kWireMinor);
  out.mutable_hello()->set_client("spindrift-bench");
  out.mutable_hello()->set_token(token);
  out.mutable_hello()->set_resume_key(resume_key);
  return out;
}

}  // namespace spindrift::bench
