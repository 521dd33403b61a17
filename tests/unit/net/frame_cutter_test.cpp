// Where bytes that were read ahead are cut, however they come.
#include "frame_cutter.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "frame_header.h"

namespace spindrift::net {
namespace {

constexpr std::size_t kAnySize = 1 << 20;

std::string text(core::ByteView bytes) {
  return {bytes.begin(), bytes.end()};
}

void add(FrameCutter& cutter, const std::string& bytes) {
  const auto room = cutter.room();
  ASSERT_LE(bytes.size(), room.size());
  std::ranges::copy(bytes, room.begin());
  cutter.added(bytes.size());
}

std::string take(FrameCutter& cutter, std::size_t max_bytes = kAnySize) {
  const core::ByteView next = cutter.next();
  std::string out = text(next.first(std::min(next.size(), max_bytes)));
  cutter.taken(out.size());
  return out;
}

std::string framed(const std::string& payload) {
  const FrameHeader header(payload.size());
  return std::string(header.bytes().begin(), header.bytes().end()) + payload;
}

std::size_t byteAt(const std::string& bytes, std::size_t at) {
  return static_cast<std::uint8_t>(bytes[at]);
}

FrameCutter inFrames() {
  FrameCutter out(1000);
  out.beginFrames();
  return out;
}

TEST(FrameCutter, CutsTheResponseAtTheEndOfItsHead) {
  const std::string head = "HTTP/1.1 101 Switching Protocols\r\nA: \r\r\n\r\n";
  const std::string all = head + framed("greeting");
  for (std::size_t first = 1; first < all.size(); ++first) {
    FrameCutter cutter(1000);
    add(cutter, all.substr(0, first));
    std::string read = take(cutter);
    if (read.size() < head.size()) {
      add(cutter, all.substr(first));
      read += take(cutter);
    }
    ASSERT_EQ(read, head) << first;
    cutter.beginFrames();
    // The rest of a short first part has not come.
    if (const auto message = cutter.takeMessage(kAnySize)) {
      EXPECT_EQ(text(*message), "greeting");
    } else {
      EXPECT_LT(first, all.size());
      EXPECT_EQ(text(cutter.next()).size(), first >= head.size() + 2 ? first - head.size() : 0U) << first;
    }
  }
}

TEST(FrameCutter, GivesTheBodyOfARefusalOnToo) {
  FrameCutter cutter(1000);
  add(cutter, "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 4\r\n\r\nfull");
  EXPECT_EQ(take(cutter), "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 4\r\n\r\n");
  EXPECT_EQ(take(cutter), "full");
  add(cutter, "\r\n\r\nmore");
  EXPECT_EQ(take(cutter), "\r\n\r\nmore");
}

TEST(FrameCutter, TakesWholeMessagesPastTheReader) {
  FrameCutter cutter = inFrames();
  add(cutter, framed("one") + framed("") + framed(std::string(300, 'x')) + "\x81\x03two");
  EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "one");
  EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "");
  EXPECT_FALSE(cutter.takeMessage(299)) << "longer than the reader allows";
  EXPECT_EQ(text(*cutter.takeMessage(300)), std::string(300, 'x'));
  EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "two");
  EXPECT_FALSE(cutter.takeMessage(kAnySize));
  EXPECT_TRUE(cutter.next().empty());
}

TEST(FrameCutter, LeavesEverythingElseToTheReaderFrameByFrame) {
  const std::string frames[] = {
      std::string("\x89\x02hi", 4),                 // ping
      std::string("\x88\x00", 2),                   // close
      std::string("\x02\x03one", 5),                // the first part of a message
      std::string("\x80\x03two", 5),                // its last
      std::string("\xC2\x01z", 3),                  // compressed
      std::string("\x82\x81\x01\x02\x03\x04y", 7),  // masked
  };
  for (const std::string& frame : frames) {
    FrameCutter cutter = inFrames();
    add(cutter, frame + framed("message"));
    EXPECT_FALSE(cutter.takeMessage(kAnySize));
    EXPECT_EQ(take(cutter), frame);
    EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "message");
  }
}

TEST(FrameCutter, GivesNoMessageWhileTheReaderIsInsideAFrame) {
  FrameCutter cutter = inFrames();
  add(cutter, framed("\x82\x01q") + framed("next"));
  EXPECT_EQ(take(cutter, 2), std::string("\x82\x03", 2));
  EXPECT_FALSE(cutter.takeMessage(kAnySize)) << "the payload looks like a frame";
  EXPECT_EQ(take(cutter), "\x82\x01q");
  EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "next");
}

TEST(FrameCutter, PassesAFrameOnThatDoesNotFit) {
  const std::string all = framed(std::string(70'000, 'l')) + framed("after");
  FrameCutter cutter = inFrames();
  std::string read;
  for (std::size_t at = 0; at < all.size(); at += 1000) {
    EXPECT_FALSE(cutter.takeMessage(kAnySize));
    add(cutter, all.substr(at, 1000));
    read += take(cutter);
  }
  EXPECT_EQ(read.size(), 70'000U + 10U);
  EXPECT_EQ(text(*cutter.takeMessage(kAnySize)), "after");
}

TEST(FrameCutter, AFrameOfTheLargestSizeIsPassedOn) {
  FrameCutter cutter = inFrames();
  add(cutter, "\x82\x7f" + std::string(8, '\xff') + "abc");
  EXPECT_FALSE(cutter.takeMessage(std::numeric_limits<std::size_t>::max()));
  EXPECT_EQ(take(cutter).size(), 13U);
}

TEST(FrameCutter, MeetsTheSameEndsHoweverTheBytesCome) {
  std::mt19937 random(19);
  for (int run = 0; run < 200; ++run) {
    std::string all, expected;
    for (int k = 0; k < 30; ++k) {
      const std::string payload(random() % (k % 5 == 0 ? 400 : 20), static_cast<char>('a' + k % 26));
      const bool is_ping = payload.size() < 126 && random() % 4 == 0;
      std::string frame = framed(payload);
      if (is_ping) frame[0] = '\x89';
      all += frame;
      expected += payload + (is_ping ? "?" : "!");
    }
    FrameCutter cutter = inFrames();
    std::string got, frame;
    for (std::size_t at = 0;;) {
      if (const auto message = frame.empty() ? cutter.takeMessage(kAnySize) : std::nullopt) {
        got += text(*message) + "!";
        continue;
      }
      if (cutter.next().empty()) {
        if (at == all.size()) break;
        const std::size_t count = std::min<std::size_t>(1 + random() % 300, all.size() - at);
        add(cutter, all.substr(at, count));
        at += count;
        continue;
      }
      frame += take(cutter, 1 + random() % 50);
      const std::size_t header_bytes = frame.size() > 1 && frame[1] == 126 ? 4 : 2;
      if (frame.size() < header_bytes) continue;
      const std::size_t size =
          header_bytes + (header_bytes == 2 ? byteAt(frame, 1) : byteAt(frame, 2) << 8 | byteAt(frame, 3));
      ASSERT_LE(frame.size(), size) << "a byte of the next frame";
      if (frame.size() < size) continue;
      got += frame.substr(header_bytes) + (frame[0] == '\x89' ? "?" : "!");
      frame.clear();
    }
    ASSERT_EQ(got, expected) << run;
  }
}

}  // namespace
}  // namespace spindrift::net
