#include "front.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/core/paths.h>

#include "access_files.h"
#include "commands.h"
#include "config_file.h"

namespace spindrift::cli {

using core::ErrorCode;

core::Result<service::AccessOptions> accessOptions(const FrontOptions& options) {
  auto access = loadAccess(options);
  if (!access) return access.error();
  service::AccessOptions out{.access = *std::move(access), .person_commands_per_s = options.person_commands_per_s};
  if (options.audit_file.empty()) return out;
  auto opened = access::AuditFile::open(options.audit_file);
  if (!opened) return opened.error();
  out.audit_file = *std::move(opened);
  return out;
}

void reload(const FrontOptions& options, service::AccessControl& control, access::AuditFile* audit_file) {
  if (audit_file != nullptr) audit_file->reopen();
  auto access = loadAccess(options);
  if (!access) {
    spdlog::error("SIGHUP: tokens and keys stay as they were: {}", access.error().message);
    return;
  }
  spdlog::info("SIGHUP: {} tokens and {} keys for JWTs were read; sessions that are open keep their rights",
               access->tokenCount(), access->jwtKeyCount());
  control.replace(*std::move(access));
}

StopSignals::StopSignals() {
  sigemptyset(&set_);
  sigaddset(&set_, SIGINT);
  sigaddset(&set_, SIGTERM);
  sigaddset(&set_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set_, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
}

int StopSignals::wait(const std::function<void()>& reload) {
  while (true) {
    int signal = 0;
    sigwait(&set_, &signal);
    if (signal != SIGHUP) return signal;
    reload();
  }
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

bool isOpenToAll(const FrontOptions& options, const access::Access& access) {
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
