// What clients of every minor version of the wire say (tests/golden/versions.txt), read by this server.
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

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

TEST(OlderClients, AreUnderstoodInAllThatTheySay) {
  std::ifstream file(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "tests" / "golden" / "versions.txt");
  ASSERT_TRUE(file.is_open());
  std::map<std::uint32_t, int> commands_count;
  std::map<std::uint32_t, int> hellos_count;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string version, side, kind, hex;
    words >> version >> side >> kind >> hex;
    if (side != "client") continue;
    const std::string what = version + " " + kind;
    const std::string bytes = bytesOf(hex);
    const ClientMessage message = parseClientMessage(core::viewOf(bytes));
    if (const auto* hello = std::get_if<v1::Hello>(&message)) {
      EXPECT_EQ(kind, "hello");
      EXPECT_FALSE(checkVersion(hello->version())) << what;
      EXPECT_EQ("1." + std::to_string(hello->version().minor()), version);
      ++hellos_count[hello->version().minor()];
    } else if (const auto* command = std::get_if<v1::Command>(&message)) {
      const auto& reflection = *command->GetReflection();
      const auto* action = reflection.GetOneofFieldDescriptor(*command, v1::Command::descriptor()->oneof_decl(0));
      ASSERT_NE(action, nullptr) << what;
      EXPECT_EQ(std::string(action->name()), kind) << what;
      ++commands_count[static_cast<std::uint32_t>(std::stoi(version.substr(2)))];
    } else if (const auto* rejected = std::get_if<CommandRejection>(&message)) {
      ADD_FAILURE() << what << ": " << rejected->ShortDebugString();
    } else if (const auto* error = std::get_if<core::Error>(&message)) {
      ADD_FAILURE() << what << ": " << error->message;
    }
  }
  EXPECT_EQ(hellos_count.size(), kWireMinor + 1) << "one version after the other";
  EXPECT_EQ(commands_count.size(), kWireMinor + 1);
  EXPECT_EQ(commands_count[0], 12);
  EXPECT_EQ(commands_count[kWireMinor], v1::Command::descriptor()->oneof_decl(0)->field_count());
}

}  // namespace
}  // namespace spindrift::wire
