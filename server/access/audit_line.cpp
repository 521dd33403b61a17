#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <fmt/format.h>

#include <spindrift/access/audit_line.h>
#include <spindrift/core/text.h>

namespace spindrift::access {
namespace {

constexpr std::size_t kTextMaxBytes = 512;
constexpr std::size_t kContentMaxBytes = 16 * 1024;

/// RFC 3339 in UTC with milliseconds.
std::string rfc3339(std::chrono::system_clock::time_point time) {
  using namespace std::chrono;
  const auto day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss clock(floor<milliseconds>(time - day));
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

/// Control and direction characters are removed, too: the log is read in terminals.
std::string shown(std::string_view text) {
  return core::cleanText(text, kTextMaxBytes);
}

}  // namespace

std::string auditLine(const AuditEvent& event, std::chrono::system_clock::time_point now) {
  boost::json::object out;
  const auto text = [&](const char* field, std::string_view value) {
    if (!value.empty()) out[field] = shown(value);
  };
  const auto number = [&](const char* field, std::uint64_t value, bool is_there) {
    if (is_there) out[field] = value;
  };
  out["time"] = rfc3339(now);
  text("event", event.event);
  text("room", event.room);
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
  text("subject", event.subject);
  text("name", event.name);
  number("person_id", event.person_id, event.person_id != 0);
  number("session_id", event.session_id, event.session_id != 0);
  text("peer", event.peer);
  number("left_out", event.left_out_count, event.left_out_count != 0);
  return boost::json::serialize(out) + "\n";
}

}  // namespace spindrift::access
