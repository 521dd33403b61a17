// Protocols other than the wire that sessions may speak.
#pragma once

#include <memory>

#include <spindrift/net/server.h>

namespace spindrift::service {

/// Returns the translator of a session; null for the wire.
std::unique_ptr<core::Translator> translatorOf(const net::SessionOpening& opening);

}  // namespace spindrift::service
