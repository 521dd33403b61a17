#include "front.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/core/paths.h>

#include "commands.h"
#include "config_file.h"

namespace spindrift::cli {

using core::Error;
using core::ErrorCode;

core::Result<service::Access> loadAccess(const FrontOptions& options) {
  std::string text;
  std::string label = "SPINDRIFT_TOKENS";
  bool has_tokens = false;
  if (!options.token_file.empty()) {
    std::ifstream file(options.token_file);
    if (!file)
      return Error{ErrorCode::kUnavailable, "--tokens-file " + options.token_file + ": the file cannot be read"};
    text.assign(std::istreambuf_iterator<char>(file), {});
    label = options.token_file;
    has_tokens = true;
  } else if (!options.tokens.empty()) {
    text = options.tokens;
    std::ranges::replace(text, ';', '\n');  // environment variables are awkward with several lines
    has_tokens = true;
  }
  std::optional<core::Role> guest = has_tokens ? core::Role::kViewer : core::Role::kOperator;
  if (!options.guest_role.empty()) guest = core::parseRole(options.guest_role);  // "none" is not a role
  auto access = service::Access::parse(text, label, guest);
  if (access && has_tokens && access->tokenCount() == 0) {
    return Error{ErrorCode::kInvalidInput, label + ": there is no token in it: write lines of ROLE TOKEN"};
  }
  if (access && !guest && access->tokenCount() == 0) {
    return Error{ErrorCode::kInvalidInput,
                 "--guests none without tokens refuses every client: give --tokens-file FILE"};
  }
  return access;
}

StopSignals::StopSignals() {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

int StopSignals::wait() {
  int signal = 0;
  sigwait(&set_, &signal);
  return signal;
}

std::string forUrl(const std::string& address) {
  return address.find(':') != std::string::npos ? "[" + address + "]" : address;
}

net::ServerOptions networkOptions(const FrontOptions& options) {
  net::ServerOptions out;
  out.allowed_origins = options.origins;
  out.address = options.address;
  out.port = options.port;
  out.thread_count = options.thread_count;
  out.max_session_count = options.max_session_count;
  out.address_session_share = options.address_session_share;
  out.web_root = options.web_root.empty() ? core::findWebRoot().string() : options.web_root;
  return out;
}

bool isOpenToAll(const FrontOptions& options, const service::Access& access) {
  return access.guest() == core::Role::kOperator && !options.address.starts_with("127.") && options.address != "::1";
}

void warnOpenToAll(const FrontOptions& options) {
  spdlog::warn(
      "every client that can reach {} is an operator and may even close rooms: give --tokens-file or --guests player "
      "to restrict this",
      options.address);
}

cluster::NodeOptions nodeOptions(const FrontOptions& options, bool runs_rooms) {
  std::string name = options.node;
  if (name.empty()) {
    std::array<char, 256> host{};
    constexpr std::size_t kHostMaxBytes = 20;
    if (::gethostname(host.data(), host.size() - 1) != 0) host.fill('\0');
    for (const char c : std::string(host.data()).substr(0, kHostMaxBytes)) {
      name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ? c : '-';
    }
    name += (name.empty() ? "" : "-") +
            std::to_string(options.port == 0 ? static_cast<int>(::getpid()) : static_cast<int>(options.port));
  }
  return {.nats_url = options.nats_url,
          .ca_file = options.nats_ca_file,
          .cluster = options.cluster,
          .name = std::move(name),
          .runs_rooms = runs_rooms};
}

int printConfig(const OptionSources& sources) {
  const std::string text = configText(sources);
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return 0;
  return fail({ErrorCode::kUnavailable,
               std::string("--print-config: standard output cannot be written: ") + std::strerror(errno)});
}

void logNetwork(const net::ServerStats& stats) {
  spdlog::info("{} sessions, {} frames and {:.1f} MB sent, {} frames dropped for slow clients, {} sessions evicted",
               stats.accepted_session_count, stats.sent_frame_count, static_cast<double>(stats.sent_bytes_count) / 1e6,
               stats.dropped_frame_count, stats.evicted_session_count);
}

}  // namespace spindrift::cli
