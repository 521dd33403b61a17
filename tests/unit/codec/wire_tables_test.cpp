// Compares the tables in proto/README.md and proto/packed_codes.json with those of the code.
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gtest/gtest.h>

#include <spindrift/bitstream/format/particle_format.h>
#include <spindrift/bitstream/format/residual_format.h>

namespace spindrift::codec {
namespace {

std::string readFile(const std::string& name) {
  std::ifstream stream(std::filesystem::path(SPINDRIFT_SOURCE_DIR) / "proto" / name, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << name;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string arrayOf(std::string_view digits) {
  std::string text = "[";
  for (const char digit : digits) text += (text.size() > 1 ? ", " : "") + std::to_string(codeLengthOf(digit));
  return text + "]";
}

TEST(WireTables, CodesAreInTheReadmeAndInTheDataFile) {
  const std::string readme = readFile("README.md"), data = readFile("packed_codes.json");
  constexpr std::uint32_t kFirstClass = kLastSparseClass + 1;
  std::string expected = "{\n  \"residual_codes\": [\n";
  for (std::uint32_t c = kFirstClass; c <= kLastUnshiftedClass; ++c) {
    const std::string_view digits = kResidualLengths[c - kFirstClass];
    const bool is_single = c > kLastPairClass;
    const int together = is_single ? 1 : c > kLastFourClass ? 2 : 4;
    const std::string largest = is_single ? std::to_string(singleCodeOf(c).largest) : "";
    const std::string what = is_single       ? "one residual, L = " + largest
                             : together == 2 ? "two residuals"
                                             : "four residuals";
    const std::string row = "| class " + std::to_string(c) + " | " + what + " | `" + std::string(digits) + "` |\n";
    EXPECT_NE(readme.find(row), std::string::npos) << row;
    expected += "    {\"class\": " + std::to_string(c) + ", \"residuals_per_symbol\": " + std::to_string(together) +
                ", \"lengths\": " + arrayOf(digits) + (is_single ? ", \"largest\": " + largest : "") +
                (c < kLastUnshiftedClass ? "},\n" : "}\n");
  }
  expected += "  ],\n  \"class_codes\": [\n";
  constexpr std::array<std::string_view, 3> kNames = {"both 0", "one 0", "none 0"};
  for (std::size_t k = 0; k < kNames.size(); ++k) {
    const std::string row =
        "| " + std::string(kNames[k]) + " | class of a group | `" + std::string(kClassStepLengths[k]) + "` |\n";
    EXPECT_NE(readme.find(row), std::string::npos) << row;
    expected += "    {\"neighbours_of_class_0\": " + std::to_string(2 - k) +
                ", \"lengths\": " + arrayOf(kClassStepLengths[k]) + (k + 1 < kNames.size() ? "},\n" : "}\n");
  }
  EXPECT_EQ(data, expected + "  ]\n}\n");
}

TEST(WireTables, BoundsInTheReadmeAreThoseOfTheCode) {
  const std::string readme = readFile("README.md");
  EXPECT_EQ(kOffsetBitsMax, 8u);
  EXPECT_EQ(kCoordinateMaxCount, 1u << 16);
  EXPECT_EQ(kCellMaxCount, 1u << 24);
  for (const char* said :
       {"`count` at most 4 194 304; `offset_bits` 1 to 8;", "2^(16 − `offset_bits`); all cells together at most 2²⁴"}) {
    EXPECT_NE(readme.find(said), std::string::npos) << said;
  }
}

}  // namespace
}  // namespace spindrift::codec
