// Messages in parts: what a receiver puts together, and what it gives up and counts.
#include "parts.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace spindrift::bus {
namespace {

core::Bytes partOf(const PartHead& head, core::ByteView content) {
  core::Bytes out(kPartHeadBytes);
  writePartHead(head, out.data());
  out.insert(out.end(), content.begin(), content.end());
  return out;
}

core::Bytes partOf(const PartHead& head, const std::string& content) {
  return partOf(head, core::ByteView(reinterpret_cast<const std::uint8_t*>(content.data()), content.size()));
}

/// A collector whose messages are text.
struct Receiver {
  PartCollector collector;
  std::uint64_t lost = 0;

  /// "-": the part completes no message.
  std::string take(const core::Bytes& part) {
    const auto message = collector.take(part, lost);
    return message ? std::string(message->begin(), message->end()) : "-";
  }
};

TEST(PartHead, IsSixteenBytesLittleEndian) {
  const core::Bytes part = partOf({.message = 0x0102030405060708, .part = 9, .part_count = 10}, "");
  EXPECT_EQ(part, (core::Bytes{8, 7, 6, 5, 4, 3, 2, 1, 9, 0, 0, 0, 10, 0, 0, 0}));
  const auto head = readPartHead(part);
  ASSERT_TRUE(head);
  EXPECT_EQ(head->message, 0x0102030405060708U);
  EXPECT_EQ(head->part, 9U);
  EXPECT_EQ(head->part_count, 10U);
}

TEST(PartHead, OutOfBoundsIsRefused) {
  EXPECT_FALSE(readPartHead({})) << "no bytes";
  EXPECT_FALSE(readPartHead(core::ByteView(partOf({1, 0, 1}, "")).first(kPartHeadBytes - 1)));
  EXPECT_FALSE(readPartHead(partOf({1, 0, 0}, "")));
  EXPECT_FALSE(readPartHead(partOf({1, 2, 2}, "")));
  EXPECT_FALSE(readPartHead(partOf({1, 0, kPartMaxCount + 1}, "")));
  EXPECT_FALSE(readPartHead(partOf({1, 0, 0xFFFFFFFF}, "")));
  EXPECT_TRUE(readPartHead(partOf({1, kPartMaxCount - 1, kPartMaxCount}, "")));
}

TEST(Parts, AMessageOfOnePartIsTheWholeMessage) {
  Receiver receiver;
  EXPECT_EQ(receiver.take(partOf({1, 0, 1}, "wave")), "wave");
  EXPECT_EQ(receiver.take(partOf({1, 0, 1}, "")), "") << "also without content, and with the same number again";
  EXPECT_EQ(receiver.lost, 0U);
}

TEST(Parts, OrderedPartsMakeTheirMessage) {
  Receiver receiver;
  EXPECT_EQ(receiver.take(partOf({1, 0, 3}, "a")), "-");
  EXPECT_EQ(receiver.take(partOf({1, 1, 3}, "bc")), "-");
  EXPECT_EQ(receiver.take(partOf({1, 2, 3}, "d")), "abcd");
  EXPECT_EQ(receiver.take(partOf({2, 0, 2}, "e")), "-");
  EXPECT_EQ(receiver.take(partOf({2, 1, 2}, "f")), "ef");
  EXPECT_EQ(receiver.lost, 0U);
}

TEST(Parts, LargestMessageRoundTrips) {
  PartCollector collector;
  std::uint64_t lost = 0;
  core::Bytes content(kPartMaxBytes);
  for (std::uint32_t k = 0; k < kPartMaxCount; ++k) {
    content.assign(kPartMaxBytes, static_cast<std::uint8_t>(k));
    const auto message = collector.take(partOf({1, k, kPartMaxCount}, content), lost);
    ASSERT_EQ(message.has_value(), k + 1 == kPartMaxCount) << k;
    if (!message) continue;
    ASSERT_EQ(message->size(), kPartMaxCount * kPartMaxBytes);
    for (std::uint32_t part = 0; part < kPartMaxCount; ++part) EXPECT_EQ((*message)[part * kPartMaxBytes], part);
  }
  EXPECT_EQ(lost, 0U);
}

TEST(Parts, LostPartCostsOneMessage) {
  for (const std::uint32_t missing : {0U, 1U, 2U}) {
    Receiver receiver;
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (k != missing) {
        EXPECT_EQ(receiver.take(partOf({1, k, 3}, "x")), "-") << missing;
      }
    }
    EXPECT_EQ(receiver.take(partOf({2, 0, 2}, "e")), "-");
    EXPECT_EQ(receiver.take(partOf({2, 1, 2}, "f")), "ef") << missing;
    // A gap shows in the next part. Without a first part nothing shows that there was a message; without a last one the
    // message stays open until others push it out.
    EXPECT_EQ(receiver.lost, missing == 1 ? 1U : 0U);
  }
}

TEST(Parts, InvalidPartCostsItsMessage) {
  Receiver receiver;
  (void)receiver.take(partOf({1, 0, 2}, "a"));
  EXPECT_EQ(receiver.take(partOf({1, 0, 2}, "a")), "-");
  EXPECT_EQ(receiver.lost, 1U);
  EXPECT_EQ(receiver.take(partOf({1, 1, 2}, "b")), "-");
  (void)receiver.take(partOf({2, 0, 2}, "a"));
  EXPECT_EQ(receiver.take(partOf({2, 1, 3}, "b")), "-");
  EXPECT_EQ(receiver.lost, 2U);
  EXPECT_EQ(receiver.take(partOf({3, 0, 2}, core::Bytes(kPartMaxBytes + 1))), "-");
  EXPECT_EQ(receiver.lost, 3U);
  EXPECT_EQ(receiver.take(partOf({3, 1, 2}, "b")), "-") << "the rest of a message that was given up";
  EXPECT_EQ(receiver.lost, 3U);
}

TEST(Parts, SendersMayInterleave) {
  Receiver receiver;
  for (std::uint32_t k = 0; k < 3; ++k) {
    for (std::uint64_t sender = 1; sender <= PartCollector::kOpenMaxCount; ++sender) {
      const std::string expected = std::to_string(sender) + std::to_string(sender) + std::to_string(sender);
      EXPECT_EQ(receiver.take(partOf({sender << 32U, k, 3}, std::to_string(sender))), k == 2 ? expected : "-");
    }
  }
  EXPECT_EQ(receiver.lost, 0U);
}

TEST(Parts, OldestOpenMessageIsDroppedAtTheLimit) {
  Receiver receiver;
  for (std::uint64_t message = 0; message <= PartCollector::kOpenMaxCount; ++message) {
    EXPECT_EQ(receiver.take(partOf({message, 0, 2}, "a")), "-");
  }
  EXPECT_EQ(receiver.lost, 1U);
  EXPECT_EQ(receiver.take(partOf({0, 1, 2}, "b")), "-") << "the oldest";
  for (std::uint64_t message = 1; message <= PartCollector::kOpenMaxCount; ++message) {
    EXPECT_EQ(receiver.take(partOf({message, 1, 2}, "b")), "ab") << message;
  }
  EXPECT_EQ(receiver.lost, 1U);
}

TEST(Parts, GarbageIsCountedAndDisturbsNoMessage) {
  Receiver receiver;
  std::mt19937 random(42);
  (void)receiver.take(partOf({1, 0, 2}, "a"));
  for (std::uint64_t k = 1; k <= 1'000; ++k) {
    core::Bytes noise(random() % 40);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    if (noise.size() >= kPartHeadBytes) noise[15] |= 0x80;  // never a possible number of parts
    EXPECT_EQ(receiver.take(noise), "-");
    EXPECT_EQ(receiver.lost, k);
  }
  EXPECT_EQ(receiver.take(partOf({1, 1, 2}, "b")), "ab");
}

}  // namespace
}  // namespace spindrift::bus
