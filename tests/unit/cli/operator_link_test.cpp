// Who is an operator where no roles are configured.
#include <gmock/gmock.h>

#include "access_options.h"
#include "command_line.h"
#include "ready_text.h"

namespace spindrift::test {
namespace {

using core::Role;
using std::chrono::system_clock;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class OperatorLink : public CommandLineTest {
 protected:
  /// The options of this command line, as `serve` uses them.
  static cli::ServeOptions started(const std::vector<std::string>& arguments) {
    cli::ServeOptions out = CommandLine(arguments).options;
    cli::makeOperatorToken(out);
    return out;
  }
  static std::optional<Role> guestsOf(const std::vector<std::string>& arguments) {
    return cli::loadAccess(started(arguments))->guest();
  }
  static std::string printed(const cli::ServeOptions& options) { return cli::readyText(options, 8080); }
};

TEST_F(OperatorLink, IsAbsentOnTheLoopback) {
  for (const char* address : {"127.0.0.1", "127.1.2.3", "::1"}) {
    EXPECT_EQ(guestsOf({"--address", address}), Role::kOperator);
    EXPECT_EQ(printed(started({"--address", "127.0.0.1"})), "Spindrift is ready: http://127.0.0.1:8080/\n");
  }
}

TEST_F(OperatorLink, GuestsOfAReachableServerArePlayers) {
  for (const char* address : {"0.0.0.0", "::", "192.0.2.7", "2001:db8::7"})
    EXPECT_EQ(guestsOf({"--address", address}), Role::kPlayer) << address;
  EXPECT_EQ(guestsOf({"--trust-proxy", "127.0.0.1"}), Role::kPlayer) << "others come through the proxy";
}

TEST_F(OperatorLink, TokenOfAnOperatorChangesAtEachStart) {
  const cli::ServeOptions first = started({"--address", "0.0.0.0"});
  const auto access = cli::loadAccess(first);
  const auto grant = access->resolve(first.operator_token, system_clock::now());
  ASSERT_TRUE(grant);
  EXPECT_TRUE(grant->allows("main"));
  EXPECT_EQ(grant->role, Role::kOperator);
  EXPECT_FALSE(grant->is_person);
  EXPECT_NE(started({"--address", "0.0.0.0"}).operator_token, first.operator_token);
  EXPECT_EQ(cli::loadAccess(first)->resolve(first.operator_token, system_clock::now())->role, Role::kOperator)
      << "after SIGHUP";
}

TEST_F(OperatorLink, HasAnOpenableHostAndTheTokenInItsFragment) {
  const cli::ServeOptions options = started({"--address", "0.0.0.0"});
  EXPECT_THAT(printed(options), StartsWith("Spindrift is ready: http://0.0.0.0:8080/\n"
                                           "Link of the operator: http://localhost:8080/#token=" +
                                           options.operator_token + "\n"));
  EXPECT_THAT(printed(started({"--address", "::"})), HasSubstr("Link of the operator: http://localhost:8080/#token="));
  EXPECT_THAT(printed(started({"--address", "2001:db8::7"})),
              HasSubstr("Link of the operator: http://[2001:db8::7]:8080/#token="));
}

TEST_F(OperatorLink, AClassHasAddressesForTheProjectorAndForPhones) {
  const cli::ServeOptions options = started({"--class", "--address", "192.0.2.7"});
  EXPECT_EQ(printed(options),
            "Spindrift is ready: http://192.0.2.7:8080/\n"
            "Projector: http://192.0.2.7:8080/?class#token=" +
                options.operator_token + "\nPhones: http://192.0.2.7:8080/pad\n");
  EXPECT_EQ(guestsOf({"--class"}), Role::kPlayer);
  EXPECT_THAT(printed(started({"--class", "--public-url", "https://water.example/sea/"})),
              AllOf(HasSubstr("Projector: http://localhost:8080/?class#token="),
                    HasSubstr("Phones: https://water.example/sea/pad\n")));
  EXPECT_THAT(printed(started({"--class", "--address", "127.0.0.1"})), HasSubstr("Phones cannot reach"));
  set("SPINDRIFT_TOKENS", "operator operator-operator-1");
  EXPECT_EQ(started({"--class"}).operator_token, "");
  EXPECT_EQ(guestsOf({"--class"}), Role::kPlayer) << "also beside tokens";
  EXPECT_THAT(printed(started({"--class"})), HasSubstr("Projector: http://localhost:8080/?class\n"));
}

TEST_F(OperatorLink, WhatIsGivenReplacesTheDefaultsOfAClass) {
  const cli::ServeOptions plain = started({"--class"});
  EXPECT_EQ(plain.scene, "regatta");
  EXPECT_EQ(plain.address, "0.0.0.0");
  EXPECT_EQ(plain.address_session_share, 1.0);
  EXPECT_EQ(plain.max_session_count, 512U);
  const cli::ServeOptions given = started({"--class", "--scene", "harbor", "--guests", "viewer"});
  EXPECT_EQ(given.scene, "harbor");
  EXPECT_EQ(given.guest_role, "viewer");
  EXPECT_THROW(CommandLine({"--public-url", "ftp://here"}), CLI::ValidationError);
}

TEST_F(OperatorLink, ConfiguredRolesReplaceIt) {
  set("SPINDRIFT_TOKENS", "operator operator-operator-1");
  EXPECT_EQ(guestsOf({"--address", "0.0.0.0"}), Role::kViewer);
  EXPECT_EQ(started({"--address", "0.0.0.0"}).operator_token, "");
  unset("SPINDRIFT_TOKENS");
  for (const char* role : {"viewer", "player", "operator"}) {
    EXPECT_EQ(started({"--address", "0.0.0.0", "--guests", role}).operator_token, "");
    EXPECT_EQ(guestsOf({"--address", "0.0.0.0", "--guests", role}), core::parseRole(role));
  }
  EXPECT_EQ(started({"--address", "0.0.0.0", "--jwt-key", "hs256:secret"}).operator_token, "");
  EXPECT_EQ(started({"--address", "0.0.0.0", "--jwt-keys", "keys.json"}).operator_token, "");
}

}  // namespace
}  // namespace spindrift::test
