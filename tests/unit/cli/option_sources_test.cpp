// Flags, environment and file of `serve`: which value counts, and what is refused.
#include <set>

#include <spindrift/v1/serve_config.pb.h>

#include "command_line.h"
#include "temporary_folder.h"

namespace spindrift::test {
namespace {

using cli::OptionSource;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Sources : public CommandLineTest {
 protected:
  std::string file(const std::string& text) const {
    folder_.write("serve.textproto", text);
    return (folder_.path() / "serve.textproto").string();
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Sources, EveryOptionHasAFieldAndEveryFieldAnOption) {
  const CommandLine line({});
  std::set<std::string> options;
  for (const auto& entry : line.sources->entries()) options.insert(cli::fieldName(*entry.option));
  std::set<std::string> fields;
  const auto& type = *v1::ServeConfig::descriptor();
  for (int i = 0; i < type.field_count(); ++i) {
    fields.insert(type.field(i)->name());
    const bool repeats = line.sources->at(type.field(i)->name()).option->get_items_expected_max() > 1;
    EXPECT_EQ(type.field(i)->is_repeated(), repeats) << type.field(i)->name();
  }
  EXPECT_EQ(fields, options) << "add the field to serve_config.proto, or the flag to serve_options.cpp";
}

TEST_F(Sources, AllOptionsButThreeAreConfigurable) {
  const CommandLine line({});
  std::set<std::string> names;
  for (const CLI::Option* option : line.serve->get_options([](CLI::Option* o) { return !o->get_configurable(); }))
    names.insert(option->get_name());
  EXPECT_EQ(names, (std::set<std::string>{"--config", "--print-config", "--help"}));
}

TEST_F(Sources, NamesFollowFromTheFlag) {
  const CommandLine line({});
  const CLI::Option& option = *line.sources->at("max_rooms").option;
  EXPECT_EQ(option.get_name(), "--max-rooms");
  EXPECT_EQ(cli::variableName(option), "SPINDRIFT_MAX_ROOMS");
  EXPECT_EQ(cli::fieldName(*line.serve->get_option("--tokens")), "tokens_file") << "by the first of its names";
}

TEST_F(Sources, DefaultsApplyWithoutASource) {
  const CommandLine line({});
  EXPECT_EQ(line.error, "");
  EXPECT_EQ(line.options.port, 8080);
  EXPECT_EQ(line.sourceOf("port"), OptionSource::kDefault);
}

TEST_F(Sources, AFlagBeatsTheEnvironmentAndThatTheFile) {
  const std::string config = file("port: 1003 threads: 3 max_rooms: 3 room: [\"a=x\", \"b=y\"] log_level: \"error\"");
  set("SPINDRIFT_PORT", "1002");
  set("SPINDRIFT_THREADS", "2");
  set("SPINDRIFT_ROOM", "c=z");
  set("SPINDRIFT_LOG_LEVEL", "debug");
  const CommandLine line({"--config", config, "--port", "1001", "--log-level", "trace"});
  ASSERT_EQ(line.error, "");
  EXPECT_EQ(line.options.port, 1001);
  EXPECT_EQ(line.options.thread_count, 2u);
  EXPECT_EQ(line.options.max_room_count, 3u);
  EXPECT_THAT(line.options.rooms, ElementsAre("c=z")) << "replaced, not appended";
  EXPECT_EQ(line.log.level, "trace");
  EXPECT_EQ(line.sourceOf("port"), OptionSource::kFlag);
  EXPECT_EQ(line.sourceOf("threads"), OptionSource::kEnvironment);
  EXPECT_EQ(line.sourceOf("max_rooms"), OptionSource::kFile);
  EXPECT_EQ(line.sourceOf("address"), OptionSource::kDefault);
}

TEST_F(Sources, SwitchOfTheFileCanBeTurnedOff) {
  const std::string config = file("adapt: true");
  EXPECT_TRUE(CommandLine({"--config", config}).options.adapts);
  EXPECT_FALSE(CommandLine({"--config", config, "--adapt=false"}).options.adapts);
  set("SPINDRIFT_ADAPT", "0");
  EXPECT_FALSE(CommandLine({"--config", config}).options.adapts);
}

TEST_F(Sources, SemicolonsSeparateRepeatedValuesOfAVariable) {
  set("SPINDRIFT_ORIGIN", " https://a.example; https://b.example ;;");
  EXPECT_THAT(CommandLine({}).options.origins, ElementsAre("https://a.example", "https://b.example"));
  set("SPINDRIFT_SCENE", "a;b.textproto");
  EXPECT_EQ(CommandLine({}).options.scene, "a;b.textproto") << "not repeated: as it is";
}

TEST_F(Sources, AnEmptyVariableCountsAsUnset) {
  set("SPINDRIFT_PORT", "");
  set("SPINDRIFT_ROOM", "");
  set("SPINDRIFT_CONFIG", "");
  const CommandLine line({});
  EXPECT_EQ(line.error, "");
  EXPECT_EQ(line.sourceOf("port"), OptionSource::kDefault);
  EXPECT_EQ(line.sourceOf("room"), OptionSource::kDefault);
}

TEST_F(Sources, TheFileCanBeNamedInTheEnvironment) {
  set("SPINDRIFT_CONFIG", file("port: 1003"));
  EXPECT_EQ(CommandLine({}).options.port, 1003);
  EXPECT_THAT(CommandLine({"--config", "/nonexistent"}).error, HasSubstr("/nonexistent"));
}

TEST_F(Sources, ABadVariableIsRefusedByNameWithTheBound) {
  const auto refused = [&](const std::string& name, const std::string& value) {
    set(name, value);
    const std::string error = CommandLine({}).error;
    unset(name);
    return error;
  };
  EXPECT_EQ(refused("SPINDRIFT_PORT", "65536"), "SPINDRIFT_PORT: Value 65536 not in range 0 to 65535");
  EXPECT_EQ(refused("SPINDRIFT_PORT", "http"), "SPINDRIFT_PORT: Value http is not a whole number from 0 to 65535");
  EXPECT_EQ(refused("SPINDRIFT_ADAPT", "maybe"), "SPINDRIFT_ADAPT: 'maybe' cannot be used; write true or false");
  EXPECT_EQ(refused("SPINDRIFT_GUESTS", "king"), "SPINDRIFT_GUESTS: king not in {none,viewer,player,operator}");
  EXPECT_EQ(refused("SPINDRIFT_GRACE_S", "nan"), "SPINDRIFT_GRACE_S: Value nan is not a number from 0 to 3600");
  EXPECT_THAT(refused("SPINDRIFT_SHADER_DIR", "/nonexistent"),
              AllOf(StartsWith("SPINDRIFT_SHADER_DIR: "), HasSubstr("/nonexistent")));
  EXPECT_THAT(refused("SPINDRIFT_LOG_FORMAT", "xml"), AllOf(StartsWith("SPINDRIFT_LOG_FORMAT: "), HasSubstr("json")));
}

TEST_F(Sources, VariableSetByKubernetesIsNamed) {
  set("SPINDRIFT_PORT", "tcp://10.96.14.7:80");
  EXPECT_THAT(CommandLine({}).error, AllOf(StartsWith("SPINDRIFT_PORT: 'tcp://10.96.14.7:80' was set by Kubernetes"),
                                           HasSubstr("enableServiceLinks: false")));
}

TEST_F(Sources, ListsInVariablesAndFlagsAreSplit) {
  set("SPINDRIFT_ORIGIN", "https://a.example, https://b.example;null");
  set("SPINDRIFT_TRUST_PROXY", "10.0.0.0/8, 2001:db8::/32");
  const CommandLine from_variables({});
  EXPECT_EQ(from_variables.error, "");
  EXPECT_THAT(from_variables.options.origins, ElementsAre("https://a.example", "https://b.example", "null"));
  EXPECT_THAT(from_variables.options.trusted_proxies, ElementsAre("10.0.0.0/8", "2001:db8::/32"));
  const CommandLine from_flags({"--origin", "https://a.example,https://b.example", "--origin", "https://c.example"});
  EXPECT_THAT(from_flags.options.origins, ElementsAre("https://a.example", "https://b.example", "https://c.example"));
}

TEST_F(Sources, ABadVariableBehindAFlagIsNotRead) {
  set("SPINDRIFT_PORT", "http");
  EXPECT_EQ(CommandLine({"--port", "1001"}).error, "");
}

TEST_F(Sources, FlagThatIsNotANumberIsRefused) {
  EXPECT_THROW(CommandLine({"--grace", "nan"}), CLI::ValidationError);
  EXPECT_THROW(CommandLine({"--address-share", "nan"}), CLI::ValidationError);
  EXPECT_THROW(CommandLine({"--tokens", ""}), CLI::ValidationError) << "not silently without tokens";
}

TEST_F(Sources, TheVariableWithTokensRanksBetweenFlagAndFile) {
  const std::string config = file("tokens_file: \"from_file\"");
  set("SPINDRIFT_TOKENS", "operator abcdefghijklmnop");
  const CommandLine from_variable({"--config", config});
  EXPECT_EQ(from_variable.options.tokens, "operator abcdefghijklmnop");
  EXPECT_EQ(from_variable.options.token_file, "");
  const CommandLine from_flag({"--config", config, "--tokens", "from_flag"});
  EXPECT_EQ(from_flag.options.tokens, "");
  EXPECT_EQ(from_flag.options.token_file, "from_flag");
  unset("SPINDRIFT_TOKENS");
  EXPECT_EQ(CommandLine({"--config", config}).options.token_file, "from_file");
}

TEST_F(Sources, TwoVariablesForTheTokensAreRefused) {
  set("SPINDRIFT_TOKENS", "operator abcdefghijklmnop");
  set("SPINDRIFT_TOKENS_FILE", "tokens");
  EXPECT_THAT(CommandLine({}).error,
              AllOf(HasSubstr("SPINDRIFT_TOKENS and SPINDRIFT_TOKENS_FILE"), HasSubstr("unset")));
}

}  // namespace
}  // namespace spindrift::test
