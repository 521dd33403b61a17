// The text of --config and --print-config.
#include "config_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <sstream>

#include "command_line.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class ConfigFile : public CommandLineTest {
 protected:
  std::string path(const std::string& name = "serve.textproto") const { return (folder_.path() / name).string(); }
  std::string file(const std::string& text) const {
    folder_.write("serve.textproto", text);
    return path();
  }
  /// Returns the error for a file with this text, without the folder.
  std::string refused(const std::string& text) const {
    const std::string error = CommandLine({"--config", file(text)}).error;
    EXPECT_THAT(error, StartsWith(path()));
    return error.substr(std::min(error.size(), path().size() - std::string("serve.textproto").size()));
  }
  const TemporaryFolder& folder() const { return folder_; }

 private:
  TemporaryFolder folder_;
};

TEST_F(ConfigFile, ErrorsNameLocationFieldValueAndBound) {
  EXPECT_EQ(refused("\nport: 65536\n"), "serve.textproto:2:1: port: Value 65536 not in range 0 to 65535");
  EXPECT_EQ(refused("port: -1\n"), "serve.textproto:1:1: port: Value -1 not in range 0 to 65535");
  EXPECT_EQ(refused("# a comment\n\tgrace_s: 3601\n"),
            "serve.textproto:2:9: grace_s: Value 3601 not in range 0 to 3600");
  EXPECT_EQ(refused("grace_s: nan"), "serve.textproto:1:1: grace_s: Value nan is not a number from 0 to 3600");
  EXPECT_EQ(refused("guests: \"king\""), "serve.textproto:1:1: guests: king not in {none,viewer,player,operator}");
  EXPECT_EQ(refused("tokens_file: \"\""),
            "serve.textproto:1:1: tokens_file: Value is empty; leave the option out instead");
  EXPECT_EQ(refused("threads: 2 log_level: \"loud\""),
            "serve.textproto:1:12: log_level: loud not in {trace,debug,info,warning,error,off}");
}

TEST_F(ConfigFile, UnknownFieldIsReportedWithARemedy) {
  EXPECT_EQ(refused("threads: 2\nprot: 80\n"),
            "serve.textproto:2:5: there is no field 'prot'; spindrift serve --print-config lists the fields");
}

TEST_F(ConfigFile, WrongTypeIsReportedWithARemedy) {
  EXPECT_EQ(refused("port: \"http\""),
            "serve.textproto:1:7: port: Expected integer, got: \"http\"; write a whole number in [0 - 65535]");
  EXPECT_EQ(refused("port\n:\n  # the port\n \"http\""),
            "serve.textproto:4:2: Expected integer, got: \"http\"; write lines of FIELD: VALUE");
  EXPECT_EQ(refused("port:\n \"http\""),
            "serve.textproto:2:2: port: Expected integer, got: \"http\"; write a whole number in [0 - 65535]");
  EXPECT_EQ(refused("\tport: 99999999999999999999"),
            "serve.textproto:1:15: port: Integer out of range (99999999999999999999); write a whole number in [0 - "
            "65535]");
  EXPECT_THAT(refused("grace_s: \"long\""), AllOf(HasSubstr(":1:10: grace_s: "), HasSubstr("number in [0 - 3600]")));
  EXPECT_THAT(refused("adapt: 3"), AllOf(HasSubstr(":1:8: adapt: "), HasSubstr("write true or false")));
  EXPECT_THAT(refused("scene: harbor"), AllOf(HasSubstr(":1:8: scene: "), HasSubstr("write text in quotes")));
}

TEST_F(ConfigFile, AFieldThatIsHereTwiceIsRefused) {
  EXPECT_THAT(refused("port: 1\nport: 2\n"),
              AllOf(HasSubstr("serve.textproto:2:"), HasSubstr("port: it is given twice")));
}

TEST_F(ConfigFile, AnotherEncodingIsReadOrNamed) {
  const CommandLine marked({"--config", file("\xEF\xBB\xBFport: 1001")});
  EXPECT_EQ(marked.error, "");
  EXPECT_EQ(marked.options.port, 1001);
  const CommandLine wide({"--config", file(std::string("\xFF\xFEp\0o\0", 6))});
  EXPECT_THAT(wide.error, AllOf(HasSubstr("serve.textproto: is UTF-16 text; save it as UTF-8")));
  EXPECT_THAT(refused("port:\xC2\xA0"
                      "1001"),
              HasSubstr("1:6: "));
}

TEST_F(ConfigFile, TextThatIsNotAConfigurationIsRefused) {
  for (const char* text : {"{", "port", "port:", "[a.b]: 1", "port { }", "\"", "scene: \"a", "\xFF", "room: [\"a\""})
    EXPECT_THAT(refused(text), HasSubstr("serve.textproto:1:")) << text;
  EXPECT_THAT(refused("room: \"a=b\\0.textproto\""), AllOf(HasSubstr(":1:1: room: "), HasSubstr("zero byte")));
  EXPECT_THAT(refused(std::string("port: 1\0", 8)), HasSubstr("serve.textproto:1:"));
}

TEST_F(ConfigFile, DamagedTextIsReadOrRefusedWithALocation) {
  const std::string whole = cli::configText(*CommandLine({"--room", "a=b", "--room", "c=d", "--adapt"}).sources);
  std::mt19937 random(19);
  const auto below = [&](std::size_t bound) { return static_cast<std::size_t>(random() % bound); };
  int refused_count = 0;
  for (int i = 0; i < 500; ++i) {
    std::string text = whole;
    for (std::size_t edits = 1 + below(4); edits > 0; --edits) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0:
          text[at] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(at, below(20));
          break;
        case 2:
          text.insert(at, text.substr(below(text.size()), below(40)));
          break;
        default:
          text[at] = ":\"{}[]<>#\n\t\\'-9"[below(15)];
      }
    }
    CommandLine line({});
    const auto taken = cli::takeConfigText(text, "damaged", *line.sources);
    if (taken) continue;
    ++refused_count;
    EXPECT_THAT(taken.error().message, testing::ContainsRegex("^damaged:[0-9]+:[0-9]+: .")) << text;
  }
  EXPECT_GT(refused_count, 100);
}

TEST_F(ConfigFile, AnEmptyFileChangesNothing) {
  for (const char* text : {"", "\n", "# only a comment\n"}) {
    const CommandLine line({"--config", file(text)});
    EXPECT_EQ(line.error, "");
    EXPECT_EQ(cli::configText(*line.sources), cli::configText(*CommandLine({}).sources));
  }
}

TEST_F(ConfigFile, UnreadableFileIsNamedWithTheReason) {
  EXPECT_EQ(CommandLine({"--config", path("missing")}).error,
            "--config " + path("missing") + ": there is no such file; check the path");
  EXPECT_EQ(CommandLine({"--config", folder().path().string()}).error,
            "--config " + folder().path().string() + ": is a directory; name a configuration file in it");
  EXPECT_THAT(CommandLine({"--config", "/dev/zero"}).error, HasSubstr("is not a regular file"));
}

TEST_F(ConfigFile, SizeIsLimitedToOneMebibyte) {
  const std::string text = "port: 1003\n";
  const std::string comment(cli::kConfigFileMaxBytes - text.size(), '#');
  EXPECT_EQ(CommandLine({"--config", file(text + comment)}).options.port, 1003);
  EXPECT_THAT(CommandLine({"--config", file(text + comment + "#")}).error,
              AllOf(HasSubstr(path()), HasSubstr("is bigger than 1048576 bytes")));
}

TEST_F(ConfigFile, TheExampleOfTheDocumentsIsACompleteConfiguration) {
  std::ifstream in(SPINDRIFT_SOURCE_DIR "/docs/operations/run.md");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string fence = "```textproto\n";
  text.erase(0, text.find(fence) + fence.size());
  text.erase(text.find("```"));
  const CommandLine line({"--config", file(text)});
  ASSERT_EQ(line.error, "");
  for (const auto& entry : line.sources->entries()) {
    const std::string field = cli::fieldName(*entry.option);
    const bool is_left_out =
        field == "web_root" || field == "shader_dir" || field == "tls_cert" || field == "tls_key";  // as the text says
    EXPECT_NE(entry.source == cli::OptionSource::kFile, is_left_out) << field;
  }
  EXPECT_EQ(line.sources->at("threads").place, "file, line 14") << "as the text says below";
}

TEST_F(ConfigFile, PrintedTextReadAgainIsTheSameConfiguration) {
  set("SPINDRIFT_ROOM", "a=x; b=dir with space/y.textproto");
  set("SPINDRIFT_GRACE_S", "0.1");
  const CommandLine first(
      {"--config",
       file("address_share: 0.30000000000000004 record: \"logs\" log_format: \"json\" device: \"2\""),
       "--scene",
       "new\nline # \"quotes\" \\ \xFF \xC3\xA4.textproto",
       "--adapt",
       "--threads",
       "0x10",
       "--origin",
       "https://a",
       "--origin",
       "*",
       "--fidelity",
       "draft",
       "--guests",
       "none",
       "--tokens",
       "t",
       "--shader-dir",
       folder().path().string(),
       "--web-root",
       folder().path().string(),
       "--hash-every",
       "7",
       "--log-level",
       "off",
       "--port",
       "0",
       "--max-rooms",
       "64"});
  ASSERT_EQ(first.error, "");
  const std::string text = cli::configText(*first.sources);
  unset("SPINDRIFT_ROOM");
  unset("SPINDRIFT_GRACE_S");
  const CommandLine second({"--config", file(text)});
  ASSERT_EQ(second.error, "") << text;
  const auto withoutComments = [](const std::string& lines) {
    std::string kept;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) kept += line.substr(0, line.rfind("  # ")) + "\n";
    return kept;
  };
  EXPECT_EQ(withoutComments(cli::configText(*second.sources)), withoutComments(text));
  EXPECT_EQ(second.options.scene, first.options.scene);
  EXPECT_EQ(second.options.rooms, first.options.rooms);
  EXPECT_EQ(second.options.origins, first.options.origins);
  EXPECT_EQ(second.options.address_session_share, first.options.address_session_share);
  EXPECT_EQ(second.options.grace_s, 0.1);
  EXPECT_EQ(second.options.thread_count, 16u);
  EXPECT_EQ(second.options.adapts, true);
  EXPECT_EQ(second.log.format, "json");
  for (const auto& entry : first.sources->entries())
    EXPECT_NE(entry.source == cli::OptionSource::kDefault, entry.option->count() > 0) << cli::fieldName(*entry.option);
}

TEST_F(ConfigFile, PrintedTextSaysWhereEachValueComesFrom) {
  set("SPINDRIFT_THREADS", "2");
  const CommandLine line({"--config", file("\nmax_rooms: 3\n"), "--port", "1001"});
  const std::string text = cli::configText(*line.sources);
  for (const char* expected :
       {"port: 1001  # flag\n", "threads: 2  # environment: SPINDRIFT_THREADS\n", "max_rooms: 3  # file, line 2\n",
        "scene: \"harbor\"  # default\n", "# room: not set  # default\n", "adapt: false  # default\n"})
    EXPECT_THAT(text, HasSubstr(expected));
}

TEST_F(ConfigFile, TokensAreNeverPrinted) {
  set("SPINDRIFT_TOKENS", "operator secret-secret-secret");
  const CommandLine line({"--config", file("tokens_file: \"f\"")});
  ASSERT_EQ(line.options.tokens, "operator secret-secret-secret");
  const std::string text = cli::configText(*line.sources);
  EXPECT_THAT(text, Not(HasSubstr("secret")));
  EXPECT_THAT(text, HasSubstr("# tokens_file: not set  # environment: SPINDRIFT_TOKENS instead\n"));
}

TEST_F(ConfigFile, ATokenFileGivenByMistakeIsNotQuoted) {
  EXPECT_THAT(refused("operator 5f0c5f0c5f0c5f0c\n"), Not(HasSubstr("5f0c")));
  EXPECT_THAT(refused("# class\noperator abcdefghijklmnop until=2030-01-31T12:00:00Z\n"), Not(HasSubstr("abcdef")));
}

}  // namespace
}  // namespace spindrift::test
