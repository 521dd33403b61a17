// Compares the lists in proto/README.md with the proto files and the server: fails when a kind, a field, a reason or a
// code is added without its line in the text.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/net/server.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/v1/wire.pb.h>
#include <spindrift/wire/api_message.h>
#include <spindrift/wire/client_message.h>
#include <spindrift/wire/server_message.h>

#include "commands.h"

namespace spindrift::service {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::UnorderedElementsAreArray;

class WireReadme : public testing::Test {
 protected:
  void SetUp() override {
    std::ifstream stream(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "proto" / "README.md", std::ios::binary);
    ASSERT_TRUE(stream.is_open());
    text_.assign(std::istreambuf_iterator<char>(stream), {});
  }

  /// The rows of the table whose first line is this, without that line and the one below it.
  [[nodiscard]] std::vector<std::string> rowsOf(const std::string& first_line) const {
    std::vector<std::string> rows;
    std::size_t at = text_.find(first_line + "\n");
    EXPECT_NE(at, std::string::npos) << "no table begins with " << first_line;
    while (at < text_.size() && text_[at] == '|') {
      const std::size_t end = text_.find('\n', at);
      rows.push_back(text_.substr(at, end - at));
      at = end + 1;
    }
    rows.erase(rows.begin(), rows.begin() + std::min<std::ptrdiff_t>(2, std::ssize(rows)));
    return rows;
  }
  /// Returns the words in back quotes in the first cells of the rows.
  [[nodiscard]] static std::multiset<std::string> namesOf(const std::vector<std::string>& rows) {
    std::multiset<std::string> names;
    for (const std::string& row : rows) {
      const std::string cell = row.substr(0, row.find('|', 1));
      const std::regex name("`([A-Za-z_0-9]+)`");
      for (std::sregex_iterator it(cell.begin(), cell.end(), name), end; it != end; ++it) names.insert((*it)[1]);
    }
    return names;
  }
  /// Returns the names without UNSPECIFIED and without `prefix`.
  [[nodiscard]] static std::multiset<std::string> valuesOf(const EnumDescriptor& type, const std::string& prefix) {
    std::multiset<std::string> names;
    for (int i = 0; i < type.value_count(); ++i) {
      const std::string& name = type.value(i)->name();
      EXPECT_TRUE(name.starts_with(prefix)) << name;
      if (name != prefix + "UNSPECIFIED") names.insert(name.substr(prefix.size()));
    }
    return names;
  }
  void expectEveryFieldNamed(const Descriptor& type) const {
    for (int i = 0; i < type.field_count(); ++i) {
      EXPECT_THAT(text_, ContainsRegex("`([A-Za-z]+\\.)?" + type.field(i)->name() + "`")) << type.full_name();
    }
  }

  /// Returns the bytes of a message in the section "A first exchange in bytes": of the lines below `head`.
  [[nodiscard]] core::Bytes bytesOf(const std::string& head) const {
    core::Bytes bytes;
    const std::size_t at = text_.find("\n" + head + "\n");
    EXPECT_NE(at, std::string::npos) << "the first exchange has no line " << head;
    if (at == std::string::npos) return bytes;
    std::istringstream lines(text_.substr(at + head.size() + 2));
    const std::regex begin("^  ((?:[0-9a-f]{2} {1,2})+) +\\S");
    std::smatch match;
    for (std::string line; std::getline(lines, line) && std::regex_search(line, match, begin);) {
      std::istringstream words(match[1]);
      for (std::string word; words >> word;) bytes.push_back(static_cast<std::uint8_t>(std::stoi(word, nullptr, 16)));
    }
    return bytes;
  }
  static core::Bytes serialized(const google::protobuf::Message& message) {
    core::Bytes bytes(message.ByteSizeLong());
    message.SerializeWithCachedSizesToArray(bytes.data());
    return bytes;
  }

  std::string text_;
};

TEST_F(WireReadme, FirstExchangeParsesAsTheServerDoes) {
  v1::ClientMessage hello;
  hello.mutable_hello()->mutable_version()->set_major(wire::kWireMajor);
  hello.mutable_hello()->mutable_version()->set_minor(wire::kWireMinor);
  hello.mutable_hello()->set_client("me");
  EXPECT_EQ(bytesOf("out  Hello"), serialized(hello));

  v1::ClientMessage subscribe;
  subscribe.mutable_subscribe()->set_layer(v1::LAYER_SURFACE);
  subscribe.mutable_subscribe()->set_max_rate_hz(10.0);
  EXPECT_EQ(bytesOf("out  Subscribe"), serialized(subscribe));
  const auto asked = wire::parseClientMessage(bytesOf("out  Subscribe"));
  ASSERT_TRUE(std::holds_alternative<wire::Subscribe>(asked));
  EXPECT_EQ(std::get<wire::Subscribe>(asked).packing, v1::PACKING_PLAIN);
  EXPECT_EQ(std::get<wire::Subscribe>(asked).level, core::Level::kFull);

  v1::ClientMessage splash;
  splash.mutable_command()->set_command_id(7);
  splash.mutable_command()->mutable_splash()->set_x_m(1.5);
  splash.mutable_command()->mutable_splash()->set_depth_m(0.25);
  EXPECT_EQ(bytesOf("out  Command"), serialized(splash));
  EXPECT_TRUE(std::holds_alternative<v1::Command>(wire::parseClientMessage(bytesOf("out  Command"))));
}

TEST_F(WireReadme, FirstExchangeHasTheBytesThatTheServersEncoderMakes) {
  EXPECT_EQ(bytesOf("in  Ack"), *wire::ack(test::ackOf(7, 300)));

  const auto samples = [](std::int16_t first, std::int16_t second) {
    return static_cast<std::uint16_t>(first) | std::uint32_t{static_cast<std::uint16_t>(second)} << 16;
  };
  const std::vector<std::uint32_t> words{samples(0, 256), samples(-256, 64)};
  core::FrameView frame;
  frame.tick = 301;
  frame.time_s = 5.0;
  frame.state_id = 302;
  frame.at(core::Level::kFull).surface = core::SurfaceView{{2, 2}, 8.0, 8.0, 1.0 / 1024.0, words};
  EXPECT_EQ(bytesOf("in  LayerFrame"), *codec::FrameEncoder().encode(v1::LAYER_SURFACE, frame));
}

TEST_F(WireReadme, ShowsTheAnswerOfTheRestInterfaceWithItsStrings) {
  v1::CommandAnswer answer;
  answer.mutable_ack()->set_command_id(7);
  answer.mutable_ack()->set_applied_tick(300);
  EXPECT_THAT(text_, HasSubstr("```json\n" + wire::toJson(answer) + "\n```\n"));
  const std::string rule = text_.substr(text_.find("**64-bit integers are strings in JSON**"), 400);
  for (const Descriptor* type : {v1::RoomInfo::descriptor(), v1::Ack::descriptor(), v1::Reject::descriptor(),
                                 v1::Scene::descriptor(), v1::People::descriptor(), v1::GaugeSeries::descriptor()}) {
    for (int i = 0; i < type->field_count(); ++i) {
      const auto kind = type->field(i)->cpp_type();
      if (kind == google::protobuf::FieldDescriptor::CPPTYPE_UINT64 ||
          kind == google::protobuf::FieldDescriptor::CPPTYPE_INT64) {
        EXPECT_THAT(rule, HasSubstr("`" + type->field(i)->name() + "`")) << type->full_name();
      }
    }
  }
}

TEST_F(WireReadme, ListsEveryReasonWithItsHttpStatus) {
  const auto rows = rowsOf("| `RejectReason` | HTTP status | when |");
  EXPECT_THAT(namesOf(rows), UnorderedElementsAreArray(valuesOf(*v1::RejectReason_descriptor(), "REJECT_REASON_")));
  for (const std::string& row : rows) {
    const std::string name = *namesOf({row}).begin();
    v1::RejectReason reason{};
    ASSERT_TRUE(v1::RejectReason_Parse("REJECT_REASON_" + name, &reason)) << name;
    EXPECT_THAT(row, HasSubstr("| `" + name + "` | " + std::to_string(httpStatusOf(reason)) + " | "));
  }
}

TEST_F(WireReadme, ListsEveryCommand) {
  std::multiset<std::string> actions;
  const auto* choice = v1::Command::descriptor()->FindOneofByName("action");
  for (int i = 0; i < choice->field_count(); ++i) actions.insert(choice->field(i)->name());
  EXPECT_THAT(namesOf(rowsOf("| action | does | limits besides the ranges |")), UnorderedElementsAreArray(actions));
}

TEST_F(WireReadme, ListsLayersLevelsAndRoles) {
  EXPECT_THAT(namesOf(rowsOf("| `Layer` | content | message |")), UnorderedElementsAreArray([] {
                std::multiset<std::string> names;
                for (const std::string& name : valuesOf(*v1::Layer_descriptor(), "LAYER_"))
                  names.insert("LAYER_" + name);
                return names;
              }()));
  EXPECT_THAT(namesOf(rowsOf("| `Level` | surface, at most | foam, at most | particles, at most | floaters, to | "
                             "frames/s, at most | Mbit/s packed, at most |")),
              UnorderedElementsAreArray(valuesOf(*v1::Level_descriptor(), "LEVEL_")));
  EXPECT_THAT(namesOf(rowsOf("| `Role` | may |")),
              UnorderedElementsAreArray(valuesOf(*v1::Role_descriptor(), "ROLE_")));
}

TEST_F(WireReadme, ListsEveryCloseCodeThatTheServerSends) {
  using net::CloseCode;
  std::string codes;
  for (const std::string& row : rowsOf("| WebSocket close code | means |"))
    codes += row.substr(0, row.find('|', 1)) + "\n";
  for (const CloseCode code :
       {CloseCode::kNormal, CloseCode::kGoingAway, CloseCode::kUnsupportedData, CloseCode::kPolicy, CloseCode::kTooBig,
        CloseCode::kInternalError, CloseCode::kTryAgainLater, CloseCode::kUnauthorized, CloseCode::kRoomClosed,
        CloseCode::kResumedElsewhere}) {
    EXPECT_THAT(codes, HasSubstr(std::to_string(static_cast<int>(code))));
  }
}

TEST_F(WireReadme, DescribesEveryCodecAndField) {
  const auto* codec = v1::LayerFrame::descriptor()->FindOneofByName("codec");
  for (int i = 0; i < codec->field_count(); ++i) {
    EXPECT_THAT(text_, HasSubstr("\n### `" + codec->field(i)->name() + "`\n"));
    if (codec->field(i)->message_type() != v1::ParticlesFixed12::descriptor())
      expectEveryFieldNamed(*codec->field(i)->message_type());
  }
  expectEveryFieldNamed(*v1::Limits::descriptor());
  for (const char* field :
       {"state_id", "tick", "time_s", "keyframe", "base_tick", "crc32c", "payload", "server_time_s", "codec"}) {
    EXPECT_THAT(text_, HasSubstr("`" + std::string(field) + "`"));
  }
}

TEST_F(WireReadme, NamesEveryKindOfMessage) {
  for (const Descriptor* type : {v1::ServerMessage::descriptor(), v1::ClientMessage::descriptor()}) {
    for (int i = 0; i < type->field_count(); ++i) {
      EXPECT_THAT(text_, ContainsRegex("`" + type->field(i)->message_type()->name() + "[`.]"));
    }
  }
}

TEST_F(WireReadme, ListsTheStatusesOfTheRestInterface) {
  std::string statuses;
  for (const std::string& row : rowsOf("| status | when |")) statuses += row.substr(0, row.find('|', 1)) + "\n";
  for (const int status : {200, 201, 204, 400, 401, 403, 404, 405, 409, 411, 413, 415, 422, 429, 431, 500, 503, 504}) {
    EXPECT_THAT(statuses, HasSubstr(std::to_string(status)));
  }
}

}  // namespace
}  // namespace spindrift::service
