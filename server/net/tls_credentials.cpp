#include "tls_credentials.h"

#include <ctime>
#include <utility>

#include <fmt/chrono.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include "tls_context.h"

namespace spindrift::net {
namespace {

void report(const TlsFiles& files, const TlsContext& context, const char* what) {
  const auto end = context.expires;
  const std::string text = fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::chrono::system_clock::to_time_t(end)));
  if (end < std::chrono::system_clock::now()) {
    spdlog::warn("--tls-cert {}: the certificate has expired on {}: clients refuse it", files.certificate_file, text);
  } else {
    spdlog::info("{} {}; it expires on {}", what, files.certificate_file, text);
  }
}

}  // namespace

core::Result<std::unique_ptr<TlsCredentials>> TlsCredentials::load(const TlsFiles& files) {
  auto out = std::unique_ptr<TlsCredentials>(new TlsCredentials(files));
  out->read_ = out->seen_ = out->stamps();
  auto context = TlsContext::forServer(files.certificate_file, files.key_file);
  if (!context) return context.error();
  out->context_ = *std::move(context);
  report(files, *out->context_, "TLS with the certificate");
  return out;
}

std::shared_ptr<TlsContext> TlsCredentials::context() const {
  const std::lock_guard lock(mutex_);
  return context_;
}

std::chrono::system_clock::time_point TlsCredentials::expires() const {
  return context()->expires;
}

void TlsCredentials::reload() {
  const std::lock_guard alone(reload_mutex_);
  read_ = seen_ = stamps();
  auto context = TlsContext::forServer(files_.certificate_file, files_.key_file);
  if (!context) {
    ++failure_count_;
    spdlog::error("the certificate could not be read again, the one before stays in use: {}", context.error().message);
    return;
  }
  ++reload_count_;
  report(files_, **context, "new connections use the certificate");
  const std::lock_guard lock(mutex_);
  context_ = *std::move(context);
}

void TlsCredentials::reloadIfChanged() {
  {
    const std::lock_guard alone(reload_mutex_);
    const Stamps now = stamps();
    const bool stands_still = now == std::exchange(seen_, now);
    if (now == read_ || !stands_still) return;
  }
  reload();
}

TlsCredentials::Stamp TlsCredentials::stampOf(const std::string& file) {
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0) return {};
  return {.inode = facts.st_ino,
          .size_bytes = facts.st_size,
          .modified_ns = facts.st_mtim.tv_sec * kNanosecondsPerSecond + facts.st_mtim.tv_nsec};
}

}  // namespace spindrift::net
