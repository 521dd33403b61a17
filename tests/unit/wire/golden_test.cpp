// Frozen bytes of the wire. SPINDRIFT_UPDATE_GOLDEN=1 rewrites tests/golden; look at the difference before committing
// it.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include <gtest/gtest.h>

#include <spindrift/codec/frame_decoder.h>

#include "golden_cases.h"

namespace spindrift::wire {
namespace {

std::filesystem::path goldenFolder() {
  return std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "tests" / "golden";
}

std::string readFile(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << file;
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Has read the packed frames before.
struct PackedDecoders {
  codec::PackedSurfaceDecoder surface;
  codec::PackedFoamDecoder foam;
  codec::PackedFloaterDecoder floaters;
};

bool decodes(const v1::LayerFrame& frame, PackedDecoders& packed) {
  switch (frame.layer()) {
    case v1::LAYER_SURFACE:
      return static_cast<bool>(frame.has_surface_predicted() ? packed.surface.decode(frame)
                                                             : codec::decodeSurface(frame));
    case v1::LAYER_FOAM:
      return static_cast<bool>(frame.has_foam_predicted() ? packed.foam.decode(frame) : codec::decodeFoam(frame));
    case v1::LAYER_BODIES:
      return static_cast<bool>(codec::decodeBodies(frame));
    case v1::LAYER_FLOATERS:
      return static_cast<bool>(frame.has_floaters_predicted() ? packed.floaters.decode(frame)
                                                              : codec::decodeFloaters(frame));
    default:
      return static_cast<bool>(frame.has_particles_by_cell() ? codec::decodePackedParticles(frame)
                                                             : codec::decodeParticles(frame));
  }
}

class Golden : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (const char* update = std::getenv("SPINDRIFT_UPDATE_GOLDEN"); update == nullptr || std::string(update) != "1")
      return;
    for (const GoldenCase& golden : goldenCases()) {
      std::ofstream(goldenFolder() / golden.file, std::ios::binary)
          .write(reinterpret_cast<const char*>(golden.bytes.data()), static_cast<std::streamsize>(golden.bytes.size()));
    }
    std::ofstream(goldenFolder() / "golden.json", std::ios::binary) << goldenJson(goldenCases());
  }
};

TEST_F(Golden, BytesAreStillTheSame) {
  for (const GoldenCase& golden : goldenCases()) {
    const std::string frozen = readFile(goldenFolder() / golden.file);
    EXPECT_EQ(frozen, std::string(golden.bytes.begin(), golden.bytes.end())) << golden.file;
  }
  EXPECT_EQ(readFile(goldenFolder() / "golden.json"), goldenJson(goldenCases()));
}

TEST_F(Golden, FolderHoldsNoOtherBytes) {
  std::set<std::string> expected;
  for (const GoldenCase& golden : goldenCases()) expected.insert(golden.file);
  for (const auto& entry : std::filesystem::directory_iterator(goldenFolder())) {
    if (entry.path().extension() != ".bin") continue;
    EXPECT_TRUE(expected.contains(entry.path().filename())) << entry.path();
  }
}

TEST_F(Golden, FilesGetTheVerdictInTheirNames) {
  PackedDecoders packed;
  for (const GoldenCase& golden : goldenCases()) {
    const std::string frozen = readFile(goldenFolder() / golden.file);
    const auto message =
        codec::parseServerMessage({reinterpret_cast<const std::uint8_t*>(frozen.data()), frozen.size()});
    ASSERT_EQ(static_cast<bool>(message), golden.verdict != GoldenVerdict::kBadMessage) << golden.file;
    if (!message || !message->has_frame()) continue;
    const v1::LayerFrame& frame = message->frame();
    EXPECT_EQ(decodes(frame, packed), golden.verdict == GoldenVerdict::kOk) << golden.file;
  }
}

}  // namespace
}  // namespace spindrift::wire
