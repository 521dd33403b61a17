#include <fstream>
#include <thread>

#include <boost/json.hpp>
#include <gmock/gmock.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <spindrift/access/audit_log.h>

#include "temporary_folder.h"

namespace spindrift::access {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::chrono::system_clock::time_point kTime{std::chrono::milliseconds(1'800'000'000'123)};

boost::json::object objectOf(const std::string& line) {
  EXPECT_TRUE(line.ends_with('\n'));
  return boost::json::parse(line).as_object();
}

std::vector<std::string> linesOf(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

TEST(AuditLine, SaysWhoDidWhatWhereAndWhen) {
  const auto line =
      objectOf(auditLine({.event = "command",
                          .kind = "set_parameter",
                          .content = R"({"path":"wave.depth_m","value":1.5})",
                          .outcome = "applied",
                          .tick = 0,
                          .has_tick = true,
                          .who = {.room = "main", .subject = "ada", .name = "Ada", .peer = "127.0.0.1:5000"},
                          .role = "operator",
                          .person_id = 3},
                         kTime));
  EXPECT_EQ(line.at("time").as_string(), "2027-01-15T08:00:00.123Z");
  EXPECT_EQ(line.at("content").at("value").as_double(), 1.5);
  EXPECT_EQ(line.at("tick").as_int64(), 0);
  EXPECT_EQ(line.at("subject").as_string(), "ada");
  EXPECT_FALSE(line.contains("reason"));
  EXPECT_FALSE(line.contains("left_out"));
}

TEST(AuditLine, NoTextCanEndALineOrForgeAField) {
  const std::string evil = "Ada\",\"role\":\"operator\"}\n{\"event\":\"room_closed\"\x1b[2J\u202E\xFF";
  const std::string text = auditLine(
      {.event = "command", .message = evil, .who = {.room = evil, .subject = evil, .name = evil, .peer = evil}}, kTime);
  EXPECT_EQ(std::ranges::count(text, '\n'), 1);
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  const auto line = objectOf(text);
  EXPECT_FALSE(line.contains("role"));
  EXPECT_EQ(line.at("event").as_string(), "command");
  EXPECT_EQ(line.at("name").as_string(), "Ada\",\"role\":\"operator\"}{\"event\":\"room_closed\"[2J");
}

TEST(AuditLine, LongValuesAreCut) {
  const std::string text = auditLine(
      {.event = "command", .content = "\"" + std::string(1 << 20, 'a') + "\"", .message = std::string(1 << 20, 'b')},
      kTime);
  EXPECT_LT(text.size(), 1000U);
  (void)objectOf(text);
}

TEST(AuditFile, AppendsLinesToAFileOfItsOwnerOnly) {
  test::TemporaryFolder folder;
  const auto path = folder.path() / "audit.jsonl";
  folder.write("audit.jsonl", "");
  std::filesystem::remove(path);
  for (const char* line : {"1\n", "2\n"}) {
    auto file = AuditFile::open(path);
    ASSERT_TRUE(file) << file.error().message;
    (*file)->add(line);
  }
  EXPECT_THAT(linesOf(path), ElementsAre("1", "2"));
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600U);
}

TEST(AuditFile, ReopensAfterARotation) {
  test::TemporaryFolder folder;
  const auto path = folder.path() / "audit.jsonl";
  {
    auto file = AuditFile::open(path);
    ASSERT_TRUE(file);
    (*file)->add("1\n");
    std::filesystem::rename(path, folder.path() / "audit.jsonl.1");
    (*file)->add("2\n");
    (*file)->reopen();
    (*file)->add("3\n");
  }
  EXPECT_THAT(linesOf(folder.path() / "audit.jsonl.1"), ElementsAre("1", "2"));
  EXPECT_THAT(linesOf(path), ElementsAre("3"));
}

TEST(AuditFile, CountsWhatAFullDiskLoses) {
  spdlog::set_level(spdlog::level::off);
  auto file = AuditFile::open("/dev/full");
  ASSERT_TRUE(file);
  for (int k = 0; k < 3; ++k) (*file)->add("line\n");
  for (int k = 0; k < 1000 && (*file)->lostCount() < 3; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ((*file)->lostCount(), 3U);
  EXPECT_EQ((*file)->writtenCount(), 0U);
  spdlog::set_level(spdlog::level::info);
}

TEST(AuditFile, NamesAFileThatCannotBeWritten) {
  const auto file = AuditFile::open("/nowhere/audit.jsonl");
  ASSERT_FALSE(file);
  EXPECT_THAT(file.error().message, HasSubstr("/nowhere/audit.jsonl"));
}

TEST(AuditFile, AddingNeverWaitsForALongQueue) {
  test::TemporaryFolder folder;
  auto file = AuditFile::open(folder.path() / "audit.jsonl");
  ASSERT_TRUE(file);
  constexpr std::uint64_t kCount = 20'000;
  for (std::uint64_t k = 0; k < kCount; ++k) (*file)->add("line\n");
  for (int k = 0; k < 1000 && (*file)->writtenCount() + (*file)->lostCount() < kCount; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ((*file)->writtenCount() + (*file)->lostCount(), kCount) << "each line is written or counted as lost";
  EXPECT_EQ(linesOf(folder.path() / "audit.jsonl").size(), (*file)->writtenCount());
}

}  // namespace
}  // namespace spindrift::access
