// What clients of every minor version of the wire say (tests/golden/versions.txt), read by this server.
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <spindrift/wire/client_message.h>

namespace spindrift::wire {
namespace {

std::string bytesOf(const std::string& hex) {
  std::string bytes;
  for (std::size_t k = 0; k + 1 < hex.size(); k += 2) {
    bytes.push_back(static_cast<char>(std::stoi(hex.substr(k, 2), nullptr, 16)));
  }
  return bytes;
}

/// Messages of clients by minor version and kind. The file has lines for what differs from the version before.
std::vector<std::map<std::string, std::string>> saidByVersion() {
  std::ifstream file(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "tests" / "golden" / "versions.txt");
  std::vector<std::map<std::string, std::string>> said;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string version, side, kind, hex;
    words >> version >> side >> kind >> hex;
    if (side != "client") continue;
    const std::size_t minor = std::stoul(version.substr(2));
    while (said.size() <= minor) said.push_back(said.empty() ? decltype(said)::value_type() : said.back());
    said[minor][kind] = bytesOf(hex);
  }
  return said;
}

TEST(OlderClients, AreUnderstoodInAllThatTheySay) {
  const auto said = saidByVersion();
  ASSERT_EQ(said.size(), kWireMinor + 1) << "one version after the other";
  std::vector<int> commands_count;
  for (std::size_t minor = 0; minor < said.size(); ++minor) {
    int hello_count = 0, command_count = 0;
    for (const auto& [kind, bytes] : said[minor]) {
      const std::string what = "1." + std::to_string(minor) + " " + kind;
      const ClientMessage message = parseClientMessage(core::viewOf(bytes));
      if (const auto* hello = std::get_if<v1::Hello>(&message)) {
        EXPECT_EQ(kind, "hello");
        EXPECT_FALSE(checkVersion(hello->version())) << what;
        EXPECT_EQ(hello->version().minor(), minor);
        ++hello_count;
      } else if (const auto* command = std::get_if<v1::Command>(&message)) {
        const auto& reflection = *command->GetReflection();
        const auto* action = reflection.GetOneofFieldDescriptor(*command, v1::Command::descriptor()->oneof_decl(0));
        ASSERT_NE(action, nullptr) << what;
        EXPECT_EQ(std::string(action->name()), kind) << what;
        ++command_count;
      } else if (const auto* rejected = std::get_if<CommandRejection>(&message)) {
        ADD_FAILURE() << what << ": " << rejected->ShortDebugString();
      } else if (const auto* error = std::get_if<core::Error>(&message)) {
        ADD_FAILURE() << what << ": " << error->message;
      }
    }
    EXPECT_EQ(hello_count, 1) << minor;
    EXPECT_GE(command_count, 12) << minor;
    commands_count.push_back(command_count);
  }
  EXPECT_EQ(commands_count.front(), 12);
  EXPECT_EQ(commands_count.back(), v1::Command::descriptor()->oneof_decl(0)->field_count());
}

}  // namespace
}  // namespace spindrift::wire
