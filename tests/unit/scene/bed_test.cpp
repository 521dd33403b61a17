// Beds and gauges in scene files: what loads, and what is refused with which words.
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <spindrift/scene/parameters.h>
#include <spindrift/scene/scene_loader.h>

#include "scene_error.h"
#include "temporary_folder.h"

namespace spindrift::scene {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Bed, LoadsRowsAsPointsFromTheSmallestZ) {
  const auto scene =
      parseSceneText("wave { depth_m: 5 } bed { grid { rows { depth_m: [1, 2, 3] } rows { depth_m: [4, 5, -0.5] } } }",
                     "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->bed().grid().rows_size(), 0) << "replaced by the points";
  const core::Scene in = toCore(*scene);
  ASSERT_TRUE(in.bed && in.bed->grid);
  EXPECT_EQ(in.bed->grid->columns_count, 3u);
  EXPECT_EQ(in.bed->grid->rows_count, 2u);
  EXPECT_THAT(*in.bed->grid->depths_m, ElementsAre(1.0F, 2.0F, 3.0F, 4.0F, 5.0F, -0.5F));
}

TEST(Bed, ReachesCoreShapeForShapeInOrder) {
  const auto scene = parseSceneText(
      "wave {} bed { floor_depth_m: 1.2 shapes { slope { gradient_ratio: 0.05 length_m: 3 } } "
      "shapes { cone { x_m: 2 crest_radius_m: 0 } } shapes { channel { cut_m: 0.2 } } shapes { sill { heading_deg: 90 "
      "} } }",
      "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::Scene in = toCore(*scene);
  ASSERT_TRUE(in.bed);
  EXPECT_EQ(in.bed->floor_depth_m, 1.2);
  const std::vector<core::BedShape> expected = {core::BedSlope{.gradient_ratio = 0.05, .length_m = 3},
                                                core::BedCone{.x_m = 2, .crest_radius_m = 0},
                                                core::BedChannel{.cut_m = 0.2}, core::BedSill{.heading_deg = 90}};
  EXPECT_EQ(in.bed->shapes, expected);
}

TEST(Bed, IsSentToClientsWithoutItsDepths) {
  const auto scene = parseSceneText(
      "wave { depth_m: 5 } bed { grid { rows { depth_m: [1, 2] } rows { depth_m: [4, 5] } } }", "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const v1::Scene sent = forClients(*scene);
  EXPECT_TRUE(sent.bed().has_grid());
  EXPECT_EQ(sent.bed().grid().points_size(), 0);
  EXPECT_EQ(scene->bed().grid().points_size(), 2);
}

TEST(Bed, NeedsARestartToChange) {
  auto scene = parseSceneText("wave {} bed {}", "pool.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_TRUE(setParameter(*scene, "bed.floor_depth_m", 1.0));
}

TEST(Bed, IsRefusedWithPlaceValueAndRemedy) {
  EXPECT_THAT(errorOf("particles {}\nbed {}"), HasSubstr("scene.textproto:2:1: bed: needs a wave"));
  EXPECT_THAT(errorOf("wave {} bed { shapes {} }"), HasSubstr("bed.shapes[0]: has no shape"));
  EXPECT_THAT(errorOf("wave {} bed { grid {} }"), HasSubstr("bed.grid: has no depths"));
  EXPECT_THAT(errorOf("wave {} bed { grid { rows { depth_m: [1, 2] } rows { depth_m: [1] } } }"),
              HasSubstr("bed.grid.rows[1]: 1 numbers, and the first row has 2"));
  EXPECT_THAT(errorOf("wave {} bed { grid { rows { depth_m: [1, 2] } } }"),
              HasSubstr("bed.grid.rows[0]: 1 rows; choose 2 to 1024"));
  EXPECT_THAT(errorOf("wave {} bed { grid { rows { depth_m: [1, 2] } rows { depth_m: [1, nan] } } }"),
              HasSubstr("bed.grid.rows[1]: nan is not a depth"));
  EXPECT_THAT(errorOf("wave {} bed { grid { rows { depth_m: [1, 101] } rows { depth_m: [1, 2] } } }"),
              HasSubstr("bed.grid.rows[0]: 101 is not a depth"));
  EXPECT_THAT(errorOf("wave {} bed { grid { rows { depth_m: [1, 2] } png: \"a.png\" } }"),
              HasSubstr("bed.grid.png: and rows are both given"));
  EXPECT_THAT(errorOf("wave {} bed { grid { points: \"abcd\" } }"), HasSubstr("bed.grid.points: is what"));
  EXPECT_THAT(errorOf("wave {} bed { grid { png: \"a.png\" } }"), HasSubstr("bed.grid.png: \"a.png\" cannot be read"));
  EXPECT_THAT(errorOf("wave {} bed { shapes { cone { crest_radius_m: 5 } } }"),
              HasSubstr("bed.shapes[0].cone.crest_radius_m: 5 m is more than the toe radius of 4 m"));
  EXPECT_THAT(errorOf("wave { depth_m: 1 } bed { floor_depth_m: 2 }"),
              HasSubstr("bed.floor_depth_m: 2 m is deeper than the water of 1 m"));
  std::string many = "wave {} bed {";
  for (int k = 0; k < 65; ++k) many += " shapes { cone {} }";
  EXPECT_THAT(errorOf(many + " }"), HasSubstr("bed.shapes[64]: 65 shapes are more than 64"));
}

TEST(Gauges, HaveNamesOfTheirOwnAndLieInTheWater) {
  const auto scene = parseSceneText(
      "wave { side_m: 8 } gauges { name: \"toe\" x_m: -3 } gauges { name: \"wall\" z_m: 4 }", "p.textproto");
  ASSERT_TRUE(scene) << scene.error().message;
  const std::vector<core::Gauge> expected = {{.name = "toe", .x_m = -3, .z_m = 0},
                                             {.name = "wall", .x_m = 0, .z_m = 4}};
  EXPECT_EQ(toCore(*scene).gauges, expected);
  EXPECT_THAT(errorOf("particles {} gauges { name: \"a\" }"), HasSubstr("gauges[0]: needs a wave"));
  EXPECT_THAT(errorOf("wave {} gauges {}"), HasSubstr("gauges[0].name: \"\" is not a name"));
  EXPECT_THAT(errorOf("wave {} gauges { name: \"a\" } gauges { name: \"a\" }"),
              HasSubstr("gauges[1].name: \"a\" names an earlier gauge"));
  EXPECT_THAT(errorOf("wave { side_m: 8 } gauges { name: \"a\" x_m: 4.1 }"),
              HasSubstr("gauges[0].x_m: 4.1 m lies outside of the water; choose -4 to 4 m"));
  std::string many = "wave {}";
  for (int k = 0; k < 65; ++k) many += " gauges { name: \"g" + std::to_string(k) + "\" }";
  EXPECT_THAT(errorOf(many), HasSubstr("gauges[64]: 65 gauges are more than 64"));
}

class BedImage : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_ / "scenes"); }

  /// Writes the values of a grayscale image, or of one with more components per pixel.
  void writeImage(const std::string& name, std::uint32_t width, std::uint32_t height, std::vector<std::uint16_t> values,
                  std::uint32_t format = PNG_FORMAT_LINEAR_Y) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    const int is_short = format == PNG_FORMAT_GRAY ? 1 : 0;
    ASSERT_TRUE(png_image_write_to_file(&image, (folder_ / name).c_str(), is_short, values.data(), 0, nullptr))
        << image.message;
  }

  /// Loads a scene file in the folder "scenes" whose grid names this image.
  [[nodiscard]] core::Result<v1::Scene> load(const std::string& image) const {
    const auto file = folder_ / "scenes" / "pool.textproto";
    std::ofstream(file) << "wave { depth_m: 20 }\nbed { grid { black_depth_m: 20 white_depth_m: -5 png: \"" + image +
                               "\" } }\n";
    return loadSceneFile(file);
  }

  const test::TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

TEST_F(BedImage, GivesDepthsBetweenThoseOfBlackAndWhite) {
  writeImage("scenes/bed.png", 3, 2, {0, 65535, 13107, 26214, 1, 65534});
  const auto scene = load("bed.png");
  ASSERT_TRUE(scene) << scene.error().message;
  const core::DepthGrid grid = *toCore(*scene).bed->grid;
  EXPECT_EQ(grid.columns_count, 3u);
  EXPECT_EQ(grid.rows_count, 2u);
  const std::vector<double> expected = {20, -5, 15, 10, 20 - 25 / 65535.0, -5 + 25 / 65535.0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR((*grid.depths_m)[i], expected[i], 1e-6) << i;
}

TEST_F(BedImage, OfTheLargestSizeLoadsAndALargerOneIsRefused) {
  writeImage("scenes/large.png", 1024, 1024, std::vector<std::uint16_t>(1024 * 1024, 700));
  const auto large = load("large.png");
  ASSERT_TRUE(large) << large.error().message;
  EXPECT_EQ(toCore(*large).bed->grid->depths_m->size(), 1024u * 1024u);
  writeImage("scenes/larger.png", 1025, 2, std::vector<std::uint16_t>(1025 * 2, 700));
  EXPECT_THAT(errorOf(load("larger.png")), AllOf(HasSubstr("pool.textproto:2:"), HasSubstr("larger.png"),
                                                 HasSubstr("is 1025 x 2 pixels; choose at most 1024 x 1024")));
}

TEST_F(BedImage, OfAnotherKindIsRefusedWithItsKind) {
  writeImage("scenes/color.png", 2, 2, std::vector<std::uint16_t>(12, 700), PNG_FORMAT_LINEAR_RGB);
  EXPECT_THAT(errorOf(load("color.png")), HasSubstr("is 16-bit color; save it as 16-bit grayscale"));
  writeImage("scenes/alpha.png", 2, 2, std::vector<std::uint16_t>(8, 700), PNG_FORMAT_LINEAR_Y_ALPHA);
  EXPECT_THAT(errorOf(load("alpha.png")), HasSubstr("is 16-bit grayscale with transparency"));
  writeImage("scenes/eight.png", 2, 2, std::vector<std::uint16_t>(4, 700), PNG_FORMAT_GRAY);
  EXPECT_THAT(errorOf(load("eight.png")), HasSubstr("is 8-bit grayscale"));
}

TEST_F(BedImage, ThatIsMissingOrDamagedIsNamedWithTheReason) {
  EXPECT_THAT(errorOf(load("none.png")), AllOf(HasSubstr("bed.grid.png: \"none.png\""), HasSubstr("no such file")));
  EXPECT_THAT(errorOf(load(".")), HasSubstr("is a directory; name a PNG in it"));
  EXPECT_THAT(errorOf(load("none.png\\000")), HasSubstr("has a zero byte in its name"));
  std::ofstream(folder_ / "scenes" / "bay.tif") << std::string("II*\0\x08\0\0\0", 8);
  EXPECT_THAT(
      errorOf(load("bay.tif")),
      HasSubstr("\"bay.tif\" is a TIFF and not a PNG; convert it with gdal_translate as docs/measured_beds.md"));
  std::ofstream(folder_ / "scenes" / "bay.asc") << "ncols 4\nnrows 3\n";
  EXPECT_THAT(errorOf(load("bay.asc")), HasSubstr("is an ESRI grid and not a PNG; convert it with gdal_translate"));
  std::ofstream(folder_ / "scenes" / "text.png") << "this is not an image";
  EXPECT_THAT(errorOf(load("text.png")), HasSubstr("cannot be read as PNG: Not a PNG file"));
  writeImage("scenes/bed.png", 64, 64, std::vector<std::uint16_t>(64 * 64, 700));
  const auto file = folder_ / "scenes" / "bed.png";
  const auto bytes = std::filesystem::file_size(file);
  for (const std::uintmax_t kept : {std::uintmax_t{9}, bytes / 2, bytes - 13}) {
    std::filesystem::resize_file(file, kept);
    EXPECT_THAT(errorOf(load("bed.png")), HasSubstr("cannot be read as PNG")) << kept << " bytes";
  }
}

TEST_F(BedImage, MayNotLeaveTheFolderOfTheScene) {
  writeImage("outside.png", 2, 2, {1, 2, 3, 4});
  EXPECT_THAT(errorOf(load("../outside.png")), HasSubstr("goes up by"));
  EXPECT_THAT(errorOf(load((folder_ / "outside.png").string())), HasSubstr("is an absolute path"));
  std::filesystem::create_symlink(folder_ / "outside.png", folder_ / "scenes" / "link.png");
  EXPECT_THAT(errorOf(load("link.png")), HasSubstr("is a link that leads out of it"));
  std::filesystem::create_directory_symlink(folder_, folder_ / "scenes" / "up");
  EXPECT_THAT(errorOf(load("up/outside.png")), HasSubstr("is a link that leads out of it"));
  std::filesystem::create_directory(folder_ / "scenes" / "data");
  writeImage("scenes/data/inside.png", 2, 2, {1, 2, 3, 4});
  EXPECT_TRUE(load("data/inside.png")) << errorOf(load("data/inside.png"));
}

}  // namespace
}  // namespace spindrift::scene
