// A bucket of key-values on a NATS server that fails: what its readers see.
#include <boost/json.hpp>
#include <gmock/gmock.h>

#include <spindrift/bus/key_values.h>

#include "nats_process.h"
#include "tcp_link.h"
#include "temporary_folder.h"
#include "ws_client.h"

namespace spindrift::bus {
namespace {

using namespace std::chrono_literals;
using test::NatsProcess;

/// One process's connection and bucket.
struct Reader {
  explicit Reader(std::uint16_t port) {
    auto connected = Bus::connect({.url = "nats://127.0.0.1:" + std::to_string(port), .name = "test", .ca_file = {}});
    if (!connected) throw std::runtime_error(connected.error().message);
    bus = *std::move(connected);
    auto opened = KeyValues::open(*bus, "test");
    if (!opened) throw std::runtime_error(opened.error().message);
    values = *std::move(opened);
  }
  std::uint64_t set(const std::string& key, const std::string& value, std::uint64_t revision) const {
    const auto made = values->set(key, core::Bytes(value.begin(), value.end()), revision);
    EXPECT_TRUE(made) << made.error().message;
    return made ? *made : 0;
  }
  static std::string text(const core::Result<KeyValueMap>& values) {
    if (!values) return "error: " + values.error().message;
    std::string out;
    for (const auto& [key, value] : *values) {
      out += (out.empty() ? "" : " ") + key + "=" + std::string(value.value.begin(), value.value.end());
    }
    return out;
  }
  [[nodiscard]] std::string all() const { return text(values->all()); }
  /// Whether the copy becomes this within some seconds.
  [[nodiscard]] testing::AssertionResult follows(const std::string& expected,
                                                 std::chrono::seconds patience = 20s) const {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::string last;
    while (std::chrono::steady_clock::now() < deadline) {
      last = text(values->copy());
      if (last == expected) return testing::AssertionSuccess();
      std::this_thread::sleep_for(20ms);
    }
    return testing::AssertionFailure() << "the copy is '" << last << "', not '" << expected << "'";
  }

  std::unique_ptr<Bus> bus;
  std::unique_ptr<KeyValues> values;
};

class KeyValuesTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!NatsProcess::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
    nats_ = std::make_unique<NatsProcess>(folder_.path() / "nats");
  }
  /// Messages that NATS has received.
  [[nodiscard]] std::int64_t messageCount() const {
    const auto page = test::httpRequest(nats_->monitorPort(), "GET", "/varz").body;
    return boost::json::parse(page).at("in_msgs").as_int64();
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<NatsProcess> nats_;
};

TEST_F(KeyValuesTest, TheCopyFollowsWhatOthersWriteAndRemove) {
  const Reader writer(nats_->port());
  const auto first = writer.set("a", "1", 0);
  const Reader reader(nats_->port());
  EXPECT_EQ(reader.all(), "a=1") << "written before it opened the bucket";
  writer.set("a", "2", first);
  writer.set("b", "3", 0);
  EXPECT_EQ(reader.all(), "a=2 b=3") << "everything written before the call";
  EXPECT_TRUE(writer.values->remove("a"));
  EXPECT_EQ(reader.all(), "b=3");
  EXPECT_NE(writer.set("a", "4", 0), 0U) << "a removed key can be set anew";
  EXPECT_TRUE(reader.follows("a=4 b=3", 1s));
  EXPECT_EQ(Reader::text(writer.values->copy()), "a=4 b=3") << "one's own write is there at once";
}

TEST_F(KeyValuesTest, AWriteOnTopOfAnOldRevisionChangesNothing) {
  const Reader one(nats_->port());
  const Reader other(nats_->port());
  const auto first = one.set("a", "1", 0);
  EXPECT_EQ(other.set("a", "2", 0), 0U);
  EXPECT_NE(other.set("a", "3", first), 0U);
  EXPECT_EQ(one.set("a", "4", first), 0U);
  EXPECT_EQ(one.all(), "a=3");
}

TEST_F(KeyValuesTest, ReadingTheCopyCostsNatsNothing) {
  const Reader writer(nats_->port());
  for (int k = 0; k < 20; ++k) writer.set("k" + std::to_string(k), "value", 0);
  const Reader reader(nats_->port());
  const std::int64_t before = messageCount();
  const auto begin = std::chrono::steady_clock::now();
  for (int k = 0; k < 100; ++k) EXPECT_EQ(reader.values->copy()->size(), 20U);
  const auto took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(static_cast<double>(messageCount() - before), 2.0 + took) << "but for a check every 2 s";
}

TEST_F(KeyValuesTest, IsReadAgainAfterNatsWasGone) {
  const Reader writer(nats_->port());
  const Reader reader(nats_->port());
  const auto first = writer.set("a", "1", 0);
  nats_->kill();
  while (reader.bus->isConnected()) std::this_thread::sleep_for(10ms);
  EXPECT_THAT(reader.all(), testing::HasSubstr("there is no connection"));
  EXPECT_THAT(Reader::text(reader.values->copy()), testing::HasSubstr("there is no connection"));
  nats_->start();
  EXPECT_TRUE(reader.follows("a=1"));
  EXPECT_TRUE(writer.follows("a=1"));
  writer.set("a", "2", first);
  EXPECT_TRUE(reader.follows("a=2", 1s));
}

TEST_F(KeyValuesTest, IsMadeAnewAfterNatsLostItsData) {
  const Reader writer(nats_->port());
  const Reader reader(nats_->port());
  for (int k = 0; k < 5; ++k) writer.set("k" + std::to_string(k), "value", 0);
  nats_->kill();
  nats_->loseData();
  nats_->start();
  EXPECT_TRUE(reader.follows(""));
  EXPECT_TRUE(writer.follows(""));
  EXPECT_NE(writer.set("a", "1", 0), 0U);
  EXPECT_TRUE(reader.follows("a=1", 1s)) << "its revision is below those of the bucket of before";
}

TEST_F(KeyValuesTest, NoticesThatTheBucketWasReplaced) {
  const Reader reader(nats_->port());
  const Reader writer(nats_->port());
  const auto first = writer.set("a", "1", 0);
  EXPECT_EQ(reader.all(), "a=1");
  nats_->removeBucket("test");
  EXPECT_TRUE(reader.follows(""));
  EXPECT_TRUE(writer.follows(""));
  EXPECT_NE(writer.set("b", "2", 0), 0U);
  EXPECT_TRUE(reader.follows("b=2"));
  EXPECT_EQ(writer.set("a", "3", first), 0U);
}

TEST_F(KeyValuesTest, NoticesAWatchThatEndedWithoutAWord) {
  const Reader reader(nats_->port());
  const Reader writer(nats_->port());
  const auto first = writer.set("a", "1", 0);
  EXPECT_EQ(reader.all(), "a=1");
  EXPECT_EQ(nats_->endConsumers("test"), 2);
  writer.set("a", "2", first);
  EXPECT_TRUE(reader.follows("a=2", 4s)) << "the next check of the newest revision";
  EXPECT_TRUE(writer.values->remove("a"));
  EXPECT_EQ(reader.all(), "");
}

TEST_F(KeyValuesTest, AWriteOverACutLinkIsAnErrorWithinSeconds) {
  test::TcpLink link(nats_->port());
  const Reader far(link.port());
  const Reader near(nats_->port());
  const auto first = near.set("a", "1", 0);
  EXPECT_EQ(far.all(), "a=1");
  link.cut();
  near.set("a", "2", first);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(far.values->set("b", core::Bytes{1}, 0));
  EXPECT_FALSE(far.values->all());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
  link.restore();
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  while (far.all().find("a=2") == std::string::npos && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_THAT(far.all(), testing::HasSubstr("a=2"));
}

}  // namespace
}  // namespace spindrift::bus
