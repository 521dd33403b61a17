// Compares the lists in proto/README.md with the proto files and the server: fails when a kind, a field, a reason or a
// code is added without its line in the text.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>

#include <spindrift/net/server.h>
#include <spindrift/service/rest_api.h>
#include <spindrift/v1/api.pb.h>
#include <spindrift/v1/wire.pb.h>

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

  std::string text_;
};

TEST_F(WireReadme, ListsEveryReasonOfARejectionWithItsHttpStatus) {
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
  EXPECT_THAT(namesOf(rowsOf("| `Level` | surface, at most | foam, at most | particles, at most | frames/s, at most | "
                             "Mbit/s packed, at most |")),
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

TEST_F(WireReadme, HasASectionForEveryCodecAndNamesEveryFieldThatAClientNeeds) {
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
