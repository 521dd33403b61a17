// The forms of options: what is accepted, and what is said about the rest.
#include "forms.h"

#include "command_line.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class Forms : public CommandLineTest {
 protected:
  /// What is wrong with the value of an option; empty if nothing is.
  static std::string fault(const std::string& option, const std::string& value) {
    try {
      return CommandLine({option, value}).error;
    } catch (const CLI::ParseError& error) {
      return error.what();
    }
  }
};

TEST_F(Forms, EveryOptionWithAValueHasAForm) {
  CLI::App program;
  cli::ServeOptions serve_options;
  cli::FrontOptions edge_options;
  CLI::App& serve = *program.add_subcommand("serve");
  CLI::App& edge = *program.add_subcommand("edge");
  cli::addServeOptions(serve, serve_options);
  cli::addEdgeOptions(edge, edge_options);
  for (CLI::App* const command : {&serve, &edge}) {
    for (CLI::Option* const option : command->get_options()) {
      if (option->get_expected_max() == 0) continue;  // a flag
      EXPECT_NO_THROW(option->get_validator(0)) << option->get_name() << ": add a check of forms.h";
    }
  }
}

TEST_F(Forms, AnOriginIsWhatBrowsersSend) {
  for (const char* const origin :
       {"https://water.example", "http://water.example:8080", "https://[2001:db8::1]:8443", "http://localhost:5173",
        "capacitor://localhost", "https://xn--hhe-sna.example", "null", "*"}) {
    EXPECT_EQ(fault("--origin", origin), "") << origin;
  }
  EXPECT_THAT(CommandLine({"--origin", "  https://water.example "}).options.origins,
              ElementsAre("https://water.example"));
}

TEST_F(Forms, InvalidOriginIsRefusedWithARemedy) {
  const auto expectMeant = [](const std::string& text, const std::string& meant) {
    EXPECT_THAT(fault("--origin", text),
                AllOf(HasSubstr("'" + text + "' is not an Origin"), HasSubstr("write " + meant)));
  };
  expectMeant("https://water.example/", "https://water.example");
  expectMeant("https://water.example/page?x#y", "https://water.example");
  expectMeant("https://water.example:443", "https://water.example");
  expectMeant("http://water.example:80/", "http://water.example");
  expectMeant("wss://water.example", "https://water.example");
  expectMeant("https://user@water.example", "https://water.example");
  expectMeant("water.example", "https://water.example or http://water.example");
  expectMeant("https://*.water.example", "* for any");
  expectMeant("https://", "SCHEME://HOST");
  expectMeant("https://a.example:port", "SCHEME://HOST");
  expectMeant("\"https://a.example\"", "SCHEME://HOST");
  expectMeant("https://h\xC3\xB6he.example", "SCHEME://HOST");
  EXPECT_THAT(fault("--origin", "https://a.example https://b.example"), HasSubstr("write ',' between several"));
  EXPECT_THAT(fault("--origin", ""), HasSubstr("write SCHEME://HOST"));
}

TEST_F(Forms, PagesThatEmbedTheWaterAreNamedOneByOne) {
  for (const char* const origin : {"https://school.example", "http://localhost:5173", "http://127.0.0.1:8000"})
    EXPECT_EQ(fault("--embed", origin), "") << origin;
  EXPECT_THAT(CommandLine({"--embed", "https://a.example, https://b.example"}).options.parents,
              ElementsAre("https://a.example", "https://b.example"));
  for (const char* const many : {"*", "null", "https://*.school.example"})
    EXPECT_THAT(fault("--embed", many), AllOf(HasSubstr(many), HasSubstr("list the Origin of each"))) << many;
  EXPECT_THAT(fault("--embed", "https://school.example/page"), HasSubstr("write https://school.example"));
  EXPECT_THAT(fault("--embed", "capacitor://localhost"), HasSubstr("at http:// or https://"));
  EXPECT_THAT(fault("--embed", "http://[::1]:8000"), HasSubstr("name the host"));
  // It would begin another directive of the Content-Security-Policy.
  EXPECT_NE(fault("--embed", "https://a.example;script-src"), "");
  EXPECT_NE(fault("--embed", "x;script-src://a.example"), "");
}

TEST_F(Forms, AnAddressToListenOnIsAnIpAddress) {
  for (const char* const address : {"127.0.0.1", "0.0.0.0", "::", "::1", "2001:db8::1", "fe80::1%lo"})
    EXPECT_EQ(fault("--address", address), "") << address;
  EXPECT_THAT(fault("--address", "fe80::1"), AllOf(HasSubstr("link-local"), HasSubstr("fe80::1%eth0")));
  EXPECT_THAT(fault("--address", "0.0.0.0:8080"), HasSubstr("write --address 0.0.0.0 --port 8080"));
  EXPECT_THAT(fault("--address", "[::1]:8080"), HasSubstr("write --address ::1 --port 8080"));
  EXPECT_THAT(fault("--address", "[::1]"), HasSubstr("write --address ::1"));
  EXPECT_THAT(fault("--address", "http://10.0.0.1:80/"), HasSubstr("write --address 10.0.0.1 --port 80"));
  EXPECT_THAT(fault("--address", "localhost"), HasSubstr("names of hosts cannot be listened on"));
  EXPECT_THAT(fault("--address", ""), HasSubstr("is not an IP address"));
}

TEST_F(Forms, NonNumberIsReportedAsSuch) {
  EXPECT_EQ(fault("--port", "8080.0"), "--port: Value 8080.0 is not a whole number from 0 to 65535");
  EXPECT_EQ(fault("--port", "http"), "--port: Value http is not a whole number from 0 to 65535");
  EXPECT_EQ(fault("--port", "65536"), "--port: Value 65536 not in range 0 to 65535");
  EXPECT_EQ(fault("--port", "-1"), "--port: Value -1 not in range 0 to 65535");
  EXPECT_EQ(fault("--grace-s", "soon"), "--grace-s: Value soon is not a number from 0 to 3600");
  EXPECT_EQ(fault("--grace-s", "inf"), "--grace-s: Value inf is not a number from 0 to 3600");
  EXPECT_EQ(fault("--grace-s", "3601"), "--grace-s: Value 3601 not in range 0 to 3600");
}

TEST_F(Forms, NatsUrlsAreCheckedWithoutTheirPasswords) {
  for (const char* const servers :
       {"nats://one:4222", "tls://ada:se/cret@one:4222,nats://two", "one:4222", "nats://[::1]:4222/"})
    EXPECT_EQ(fault("--nats", servers), "") << servers;
  for (const char* const servers :
       {"http://ada:secret@one:4222", "nats://ada:secret@one:port", "nats://ada:secret@",
        "nats://one, nats://ada:secret@two", "nats://ada:secret@one/path", "nats://one,,"}) {
    EXPECT_THAT(fault("--nats", servers),
                AllOf(HasSubstr("of the list"), HasSubstr("nats://[USER"), Not(HasSubstr("secret"))))
        << servers;
  }
}

TEST_F(Forms, BlanksAtTheEndsAreRefused) {
  EXPECT_EQ(fault("--jwt-issuer", "https://school.example/"), "");
  EXPECT_THAT(fault("--jwt-issuer", "https://school.example "), HasSubstr("has blanks at its ends"));
  EXPECT_THAT(fault("--jwt-audience", "water\n"), HasSubstr("'water\\n' has blanks at its ends"));
  EXPECT_THAT(fault("--room", "lab"), HasSubstr("write NAME=SCENE"));
  EXPECT_THAT(fault("--web-root", "/nonexistent"), HasSubstr("/nonexistent"));
  EXPECT_THAT(fault("--scene", ""), HasSubstr("is empty"));
}

TEST_F(Forms, AFileForResultsIsCheckedBeforeTheWork) {
  const TemporaryFolder folder;
  std::string good = (folder.path() / "out.json").string();
  std::string standard_output = "-";
  std::string is_folder = folder.path().string();
  std::string no_folder = (folder.path() / "none" / "out.json").string();
  const CLI::Validator form = cli::isOutputFile();
  EXPECT_EQ(form(good), "");
  EXPECT_EQ(form(standard_output), "");
  EXPECT_THAT(form(is_folder), HasSubstr("it is not a file"));
  EXPECT_THAT(form(no_folder), HasSubstr("there is no folder"));
}

}  // namespace
}  // namespace spindrift::test
