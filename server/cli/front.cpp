#include "front.h"

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include <pthread.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <spindrift/core/files.h>

#include "access_options.h"
#include "config_file.h"
#include "ready_text.h"
#include "terminal_qr.h"

namespace spindrift::cli {
namespace {

using core::ErrorCode;

constexpr std::size_t kFoxgloveSessionMaxCount = 16;

void reload(const FrontOptions& options, const RunningServer& server) {
  server.network.reloadCertificate();
  if (access::AuditFile* const audit = server.access.audit().file()) audit->reopen();
  auto access = loadAccess(options);
  if (!access) {
    spdlog::error("SIGHUP: tokens and keys stay as they were: {}", access.error().message);
    return;
  }
  spdlog::info("SIGHUP: {} tokens and {} keys for JWTs were read; sessions that are open keep their rights",
               access->tokenCount(), access->jwtKeyCount());
  server.access.replace(*std::move(access));
}

void drain(const FrontOptions& options, const StopSignals& signals, const RunningServer& server) {
  using Clock = std::chrono::steady_clock;
  constexpr timespec kLook{.tv_sec = 0, .tv_nsec = 20'000'000};
  const auto duration =
      std::chrono::milliseconds(static_cast<std::chrono::milliseconds::rep>(std::ceil(options.drain_s * 1e3)));
  const auto countSessions = [&] { return server.network.stats().open_session_count; };
  const std::uint64_t count = countSessions();
  if (duration.count() == 0 || count == 0) return;
  spdlog::info("draining: {} sessions have {:g} s to go{}", count, options.drain_s,
               options.drain_to.empty() ? "" : " to " + options.drain_to);
  server.drain(duration);
  for (const auto end = Clock::now() + duration; Clock::now() < end;) {
    if (countSessions() == 0) return;
    const int signal = sigtimedwait(&signals.set, nullptr, &kLook);
    if (signal == SIGINT || signal == SIGTERM) return spdlog::info("draining ends: a second signal");
  }
}

void sayReady(const FrontOptions& options, std::uint16_t port) {
  std::fputs(readyText(options, port).c_str(), stdout);
  if (const std::string url = phoneUrl(options, port); !url.empty()) {
    const TerminalQr code = terminalQr(url);
    if (showsQrCodes(STDOUT_FILENO, code.columns_count)) std::fputs(code.lines.c_str(), stdout);
  }
  std::fflush(stdout);
  if (options.operator_token.empty() || options.is_class) return;
  spdlog::info(
      "no roles are configured and other machines can reach this server: clients without a token are players; the link "
      "of the operator is on standard output and is valid until this process ends; --tokens-file gives lasting roles");
}

void warnIfOpenToAll(const FrontOptions& options) {
  if (!isReachable(options) || options.guest_role != "operator") return;
  spdlog::warn(
      "every client that can reach {} is an operator and may even close rooms, because of --guests operator: leave it "
      "out, or give --tokens-file",
      options.address);
}

int printConfig(const OptionSources& sources) {
  const std::string text = configText(sources);
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return 0;
  return fail({ErrorCode::kUnavailable,
               std::string("--print-config: standard output cannot be written: ") + std::strerror(errno)});
}

}  // namespace

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

StopSignals::StopSignals() {
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit for the size of files is an error that can be told
}

void runUntilSignal(const FrontOptions& options, const StopSignals& signals, const RunningServer& server) {
  if (networkOptions(options).web_root.empty())
    spdlog::warn("the web client is not built: no page is served; run ./dev build, or give --web-root");
  warnIfOpenToAll(options);
  sayReady(options, server.network.port());
  int signal = 0;
  for (sigwait(&signals.set, &signal); signal == SIGHUP; sigwait(&signals.set, &signal)) reload(options, server);
  spdlog::info("{}: closing", signal == SIGINT ? "interrupted" : "terminated");
  if (server.leave) server.leave();
  drain(options, signals, server);
}

void endThisProcess() {
  ::kill(::getpid(), SIGTERM);
}

net::ServerOptions networkOptions(const FrontOptions& options) {
  net::ServerOptions out;
  out.allowed_origins = options.origins;
  out.embedding_origins = options.parents;
  if (options.serves_foxglove) out.foxglove_session_max_count = kFoxgloveSessionMaxCount;
  out.address = options.address;
  out.port = options.port;
  out.thread_count = options.thread_count;
  out.max_session_count = options.max_session_count;
  if (!options.tls_cert_file.empty()) out.tls = net::TlsFiles{options.tls_cert_file, options.tls_key_file};
  out.trusted_proxies = options.trusted_proxies;
  out.address_session_share = options.address_session_share;
  out.web_root = options.web_root.empty() ? core::findWebRoot().string() : options.web_root;
  return out;
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
          .runs_rooms = runs_rooms,
          .on_name_lost = endThisProcess};
}

ProgramCommand frontCommand(CLI::App& program, CLI::App& command, const std::shared_ptr<FrontOptions>& options,
                            const std::function<int()>& run) {
  const auto sources = std::make_shared<std::optional<OptionSources>>();
  return {&command, [options, sources, run] { return options->prints_config ? printConfig(**sources) : run(); },
          [&program, &command, options, sources]() -> core::Result<void> {
            auto completed = completeFrontOptions(program, command, *options);
            if (!completed) return completed.error();
            *sources = *std::move(completed);
            return {};
          }};
}

void logNetwork(const net::ServerStats& stats) {
  spdlog::info("{} sessions, {} frames and {:.1f} MB sent, {} frames dropped for slow clients, {} sessions evicted",
               stats.accepted_session_count, stats.sent_frame_count, static_cast<double>(stats.sent_bytes_count) / 1e6,
               stats.dropped_frame_count, stats.evicted_session_count);
}

}  // namespace spindrift::cli
