#include <spindrift/foxglove/live_session.h>
#include <spindrift/service/translators.h>

namespace spindrift::service {

std::unique_ptr<core::Translator> translatorOf(const net::SessionOpening& opening) {
  return opening.subprotocol.starts_with("foxglove.") ? foxglove::makeLiveSession(opening.token) : nullptr;
}

}  // namespace spindrift::service
