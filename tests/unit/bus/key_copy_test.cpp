// The copy of a bucket: what it keeps of what the watch and this process's own writes tell.
#include "key_copy.h"

#include <gmock/gmock.h>

namespace spindrift::bus {
namespace {

core::Bytes bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

/// "key=value@revision" of each key.
std::string textOf(const KeyCopy& copy) {
  std::string out;
  for (const auto& [key, value] : copy.values()) {
    out += (out.empty() ? "" : " ") + key + "=" + std::string(value.value.begin(), value.value.end()) + "@" +
           std::to_string(value.revision);
  }
  return out;
}

TEST(KeyCopy, FollowsValuesAndRemovals) {
  KeyCopy copy;
  EXPECT_TRUE(copy.put("a", bytes("1"), 1));
  EXPECT_TRUE(copy.put("b", bytes("2"), 2));
  EXPECT_TRUE(copy.put("a", bytes("3"), 3));
  EXPECT_EQ(textOf(copy), "a=3@3 b=2@2");
  copy.remove("a", 4);
  EXPECT_EQ(textOf(copy), "b=2@2");
  copy.remove("never there", 5);
  EXPECT_EQ(copy.revision(), 5U);
}

TEST(KeyCopy, KeepsAnOwnWriteBeforeTheWatchReportsIt) {
  KeyCopy copy;
  copy.put("a", bytes("old"), 1);
  EXPECT_TRUE(copy.wrote("a", bytes("mine"), 4));
  EXPECT_EQ(copy.revision(), 1U) << "changes 2 and 3 of others are still to come";
  copy.put("a", bytes("another's"), 2);
  copy.remove("a", 3);
  EXPECT_EQ(textOf(copy), "a=mine@4");
  copy.put("a", bytes("mine"), 4);
  EXPECT_EQ(copy.revision(), 4U);
  copy.remove("a", 5);
  EXPECT_EQ(textOf(copy), "");
}

TEST(KeyCopy, IsCompleteAtARevisionOfAnotherKey) {
  KeyCopy copy;
  copy.complete(7);
  EXPECT_EQ(copy.revision(), 7U);
  copy.put("a", bytes("1"), 3);
  EXPECT_EQ(copy.revision(), 7U);
}

TEST(KeyCopy, IsBounded) {
  KeyCopy copy;
  std::uint64_t revision = 0;
  for (std::size_t k = 0; k < KeyCopy::kKeyMaxCount; ++k) {
    ASSERT_TRUE(copy.put("k" + std::to_string(k), {}, ++revision));
  }
  EXPECT_FALSE(copy.put("one more", {}, ++revision));
  EXPECT_EQ(copy.revision(), revision) << "it is told nevertheless";
  EXPECT_TRUE(copy.put("k0", bytes("new"), ++revision)) << "a known key";
  copy.remove("k1", ++revision);
  EXPECT_TRUE(copy.put("one more", {}, ++revision));
  EXPECT_EQ(copy.values().size(), KeyCopy::kKeyMaxCount);
  EXPECT_FALSE(copy.put("k0", core::Bytes(KeyCopy::kValueMaxBytes + 1), ++revision));
  EXPECT_FALSE(copy.values().contains("k0")) << "its old value is not valid any more";
  EXPECT_TRUE(copy.put("k0", core::Bytes(KeyCopy::kValueMaxBytes), ++revision));
}

}  // namespace
}  // namespace spindrift::bus
