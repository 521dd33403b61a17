#include <cerrno>
#include <cstring>

#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <unistd.h>

#include <spindrift/access/audit_log.h>
#include <spindrift/core/text.h>

namespace spindrift::access {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kTextMaxBytes = 512;
constexpr std::size_t kContentMaxBytes = 16 * 1024;
/// A disk that stays full is complained about once in this time.
constexpr std::chrono::seconds kSameErrorPause{60};

int openForAppending(const std::filesystem::path& file) {
  return ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC | O_NOCTTY, S_IRUSR | S_IWUSR);
}

}  // namespace

std::string auditLine(const AuditEvent& event, std::chrono::system_clock::time_point now) {
  boost::json::object out;
  const auto text = [&](const char* field, std::string_view value) {
    // Without control and direction characters, too: the log is read in terminals.
    if (!value.empty()) out[field] = core::cleanText(value, kTextMaxBytes);
  };
  const auto number = [&](const char* field, std::uint64_t value, bool is_there) {
    if (is_there) out[field] = value;
  };
  out["time"] = core::rfc3339(now);
  text("event", event.event);
  text("room", event.who.room);
  text("kind", event.kind);
  if (!event.content.empty()) {
    boost::system::error_code error;
    auto content = event.content.size() <= kContentMaxBytes ? boost::json::parse(event.content, error)
                                                            : boost::json::value("too long to show");
    out["content"] = error ? boost::json::value("not JSON") : std::move(content);
  }
  text("outcome", event.outcome);
  text("reason", event.reason);
  text("message", event.message);
  number("tick", event.tick, event.has_tick);
  text("role", event.role);
  text("subject", event.who.subject);
  text("name", event.who.name);
  number("person_id", event.person_id, event.person_id != 0);
  number("session_id", event.session_id, event.session_id != 0);
  text("peer", event.who.peer);
  number("left_out", event.left_out_count, event.left_out_count != 0);
  return boost::json::serialize(out) + "\n";
}

core::Result<std::unique_ptr<AuditFile>> AuditFile::open(std::filesystem::path file) {
  const int descriptor = openForAppending(file);
  if (descriptor < 0) {
    return core::Error{core::ErrorCode::kUnavailable,
                       "--audit-log " + file.string() + ": the file cannot be written: " + std::strerror(errno)};
  }
  return std::unique_ptr<AuditFile>(new AuditFile(std::move(file), descriptor));
}

AuditFile::AuditFile(std::filesystem::path file, int descriptor) : file_(std::move(file)), descriptor_(descriptor) {
  thread_ = std::thread([this] { run(); });
}

AuditFile::~AuditFile() {
  finish();
  ::close(descriptor_);
}

void AuditFile::finish() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void AuditFile::add(std::string line) {
  {
    const std::lock_guard lock(mutex_);
    if (lines_.size() >= kWaitingMaxCount) {
      ++lost_count_;
      return;
    }
    lines_.push_back(std::move(line));
  }
  wake_.notify_one();
}

void AuditFile::reopen() {
  {
    const std::lock_guard lock(mutex_);
    lines_.emplace_back();
  }
  wake_.notify_one();
}

std::uint64_t AuditFile::writtenCount() const {
  const std::lock_guard lock(mutex_);
  return written_count_;
}

std::uint64_t AuditFile::lostCount() const {
  const std::lock_guard lock(mutex_);
  return lost_count_;
}

void AuditFile::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [this] { return stopping_ || !lines_.empty(); });
    if (lines_.empty()) return;
    const std::string line = std::move(lines_.front());
    lines_.pop_front();
    lock.unlock();
    bool is_written = false;
    if (line.empty()) {
      if (const int next = openForAppending(file_); next >= 0)
        ::close(std::exchange(descriptor_, next));
      else
        spdlog::error("audit log {}: it cannot be opened again, the old file stays in use: {}", file_.string(),
                      std::strerror(errno));
    } else {
      is_written = write(line);
    }
    lock.lock();
    if (line.empty()) continue;
    ++(is_written ? written_count_ : lost_count_);
  }
}

bool AuditFile::write(const std::string& line) {
  struct stat before {};
  const bool has_size = ::fstat(descriptor_, &before) == 0 && S_ISREG(before.st_mode);
  std::size_t done = 0;
  while (done < line.size()) {
    const ssize_t count = ::write(descriptor_, line.data() + done, line.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) {
      noteFailure(count < 0 ? errno : ENOSPC);
      // Half a line would spoil the next one.
      if (has_size && done > 0 && ::ftruncate(descriptor_, before.st_size) != 0) noteFailure(errno);
      return false;
    }
    done += static_cast<std::size_t>(count);
  }
  if (std::exchange(has_complained_, false)) spdlog::info("audit log {}: it is written again", file_.string());
  return true;
}

void AuditFile::noteFailure(int error_number) {
  const auto now = Clock::now();
  if (has_complained_ && now - complained_ < kSameErrorPause) return;
  has_complained_ = true;
  complained_ = now;
  spdlog::error("audit log {}: lines are lost (metric audit_lost_total), the server continues: {}", file_.string(),
                std::strerror(error_number));
}

}  // namespace spindrift::access
