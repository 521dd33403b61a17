// Who may do what in a server: tokens of the server and of its rooms, limits per person, the audit log. Sessions and
// requests share one.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/access/access.h>
#include <spindrift/access/person_limits.h>
#include <spindrift/rooms/room.h>
#include <spindrift/service/audit.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/v1/kept_state.pb.h>

namespace spindrift::service {

struct AccessOptions {
  access::Access access;
  double person_commands_per_s = 200.0;             ///< of one person over all sessions; bursts of twice as many
  std::shared_ptr<access::AuditFile> audit_file{};  ///< null: no audit log
};

/// Tokens that were made for one room.
struct RoomTokens {
  std::string room;
  v1::RoomAccess tokens;
};

/// Any thread.
class AccessControl {
 public:
  explicit AccessControl(AccessOptions options);

  /// Returns what a token allows: first of the server's tokens, then of those that were made for one of the rooms. The
  /// error never contains the token.
  [[nodiscard]] core::Result<access::Grant> resolve(std::string_view token, const std::vector<RoomTokens>& rooms,
                                                    std::chrono::system_clock::time_point now) const;
  /// Returns the same for a request that another server shall answer, by the tokens of this one; nullopt for a token
  /// that only the other server may know.
  [[nodiscard]] core::Result<std::optional<access::Grant>> resolveForwarded(
      std::string_view authorization, std::chrono::system_clock::time_point now) const;
  /// Replaces the server's tokens and keys. Sessions that are open keep what they have.
  void replace(access::Access access);

  /// Takes a command from the budget of the person; true for guests and shared tokens, which have none. The line that
  /// says why not is busy().
  [[nodiscard]] bool takeCommand(const std::string& person);
  [[nodiscard]] std::string busy() const;

  [[nodiscard]] const access::PersonLimits& people() const { return people_; }
  [[nodiscard]] Audit& audit() { return audit_; }
  [[nodiscard]] const Audit& audit() const { return audit_; }

 private:
  [[nodiscard]] std::shared_ptr<const access::Access> present() const;

  mutable std::mutex mutex_;
  std::shared_ptr<const access::Access> access_;
  access::PersonLimits people_;
  Audit audit_;
};

/// Makes a token for each of the roles that a request asks for: `kept` belongs to the room, `shown` into the answer.
/// Error kInvalidInput for an unknown role, or too many.
struct MadeTokens {
  v1::RoomAccess kept;
  google::protobuf::RepeatedPtrField<v1::RoomToken> shown;
};
core::Result<MadeTokens> makeTokens(const v1::CreateRoom& wanted);

}  // namespace spindrift::service
