#include <spindrift/service/audit.h>
#include <spindrift/service/metrics.h>
#include <spindrift/wire/api_message.h>

namespace spindrift::service {
namespace {

/// Lines that anybody can cause: with 300 bytes each at most 26 MB per day.
constexpr double kRareLinesPerSecond = 1.0;
constexpr double kRareBurstCount = 60.0;

/// The field of Command that is set; null if none is.
const google::protobuf::FieldDescriptor* actionOf(const v1::Command& command) {
  return command.GetReflection()->GetOneofFieldDescriptor(command,
                                                          v1::Command::descriptor()->FindOneofByName("action"));
}

bool isOperatorsCommand(const v1::Command& command) {
  return rooms::roleFor(command) >= core::Role::kOperator;
}

/// Players may do the same with their own boats and gauges, and with the time of a room where they are alone; of an
/// operator it may be anybody's.
bool concernsThingsOfOthers(const v1::Command& command) {
  return command.has_take_boat() || command.has_remove_boat() || command.has_remove_gauge() || command.has_step() ||
         command.has_take_clock() || command.has_release_clock();
}

}  // namespace

Audit::Audit(std::shared_ptr<access::AuditFile> file)
    : file_(std::move(file)), rare_(kRareLinesPerSecond, kRareBurstCount, std::chrono::steady_clock::now()) {}

void Audit::applied(const rooms::Command& command, std::uint64_t tick) {
  if (!file_) return;
  this->command(command, {.event = "command", .outcome = "applied", .tick = tick, .has_tick = true});
}

void Audit::rejected(const rooms::Command& command, const wire::CommandRejection& rejection) {
  if (!file_) return;
  this->command(command, {.event = "command",
                          .outcome = "rejected",
                          .reason = nameOf(rejection.reason()),
                          .message = rejection.message()});
}

void Audit::command(const rooms::Command& command, access::AuditEvent event) {
  const core::Sender& sender = command.sender;
  const google::protobuf::FieldDescriptor* const action = actionOf(command.message);
  if (!sender.details || !action) return;  // the room's own
  const bool is_operator = sender.role >= core::Role::kOperator;
  if (!isOperatorsCommand(command.message) && !(is_operator && concernsThingsOfOthers(command.message))) return;
  event.kind = action->name();
  event.content = wire::toJson(command.message.GetReflection()->GetMessage(command.message, action));
  event.who = *sender.details;
  event.role = core::roleName(sender.role);
  event.person_id = sender.person_id;
  event.session_id = sender.session_id;
  // A flood of operators' commands ends here as BUSY. A stroke is 30 messages per second, and steps of a held clock may
  // be more.
  const bool is_frequent = !is_operator || command.message.has_stroke() || command.message.has_step() ||
                           event.reason == nameOf(v1::REJECT_REASON_BUSY);
  if (is_frequent)
    writeRarely(std::move(event));
  else
    write(event);
}

void Audit::request(std::string_view event, const core::SenderDetails& who, core::Role role, std::string content,
                    const std::string& error) {
  if (!file_) return;
  access::AuditEvent line{.event = event,
                          .content = std::move(content),
                          .outcome = error.empty() ? "applied" : "rejected",
                          .message = error,
                          .who = who,
                          .role = core::roleName(role)};
  if (role >= core::Role::kOperator)
    write(line);
  else
    writeRarely(std::move(line));
}

void Audit::refused(const core::SenderDetails& who, const std::string& why) {
  if (!file_) return;
  writeRarely({.event = "refused", .message = why, .who = who});
}

void Audit::write(const access::AuditEvent& event) {
  file_->add(access::auditLine(event, std::chrono::system_clock::now()));
}

void Audit::writeRarely(access::AuditEvent event) {
  {
    const std::lock_guard lock(mutex_);
    if (!rare_.take(std::chrono::steady_clock::now())) {
      ++left_out_count_;
      ++left_out_since_;
      return;
    }
    event.left_out_count = std::exchange(left_out_since_, 0);
  }
  write(event);
}

}  // namespace spindrift::service
