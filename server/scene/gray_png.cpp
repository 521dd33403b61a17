#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>
#include <png.h>

#include <spindrift/core/files.h>

#include "scene_parts.h"

namespace spindrift::scene {
namespace {

using core::invalid;

/// Twice the pixels of the largest image: PNG may store noise with some overhead.
constexpr std::uintmax_t kFileMaxBytes = 4u << 20;
/// For ancillary chunks, which are not used.
constexpr png_alloc_size_t kChunkMaxBytes = 1u << 20;

/// Belongs to the caller of the functions that libpng may leave by longjmp, so that no object of theirs is lost.
struct Reader {
  std::FILE* stream = nullptr;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string error;
  GrayImage image;
  std::vector<png_bytep> rows;
  int bit_depth = 0;
  int color_type = 0;
  bool is_transparent = false;

  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void fail(png_structp png, png_const_charp message) {
  static_cast<Reader*>(png_get_error_ptr(png))->error = message;
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

/// Returns false after an error.
bool readHeader(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_chunk_malloc_max(reader.png, kChunkMaxBytes);
  png_init_io(reader.png, reader.stream);
  png_read_info(reader.png, reader.info);
  reader.image.width_count = png_get_image_width(reader.png, reader.info);
  reader.image.height_count = png_get_image_height(reader.png, reader.info);
  reader.bit_depth = png_get_bit_depth(reader.png, reader.info);
  reader.color_type = png_get_color_type(reader.png, reader.info);
  reader.is_transparent = png_get_valid(reader.png, reader.info, PNG_INFO_tRNS) != 0;
  return true;
}

/// Returns false after an error.
bool readPixels(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_swap(reader.png);  // PNG is big-endian
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  png_read_image(reader.png, reader.rows.data());
  png_read_end(reader.png, nullptr);
  return true;
}

std::string kindOf(const Reader& reader) {
  const bool is_gray = (reader.color_type & PNG_COLOR_MASK_COLOR) == 0;
  const bool is_transparent = reader.is_transparent || (reader.color_type & PNG_COLOR_MASK_ALPHA) != 0;
  return fmt::format("{}-bit {}{}", reader.bit_depth, is_gray ? "grayscale" : "color",
                     is_transparent ? " with transparency" : "");
}

/// Returns the kind of a file that is often taken for a bed, by its first bytes; empty for a PNG and for anything else.
std::string otherKind(std::string_view head) {
  struct Kind {
    std::string_view mark;
    const char* name;
  };
  using namespace std::string_view_literals;
  static constexpr std::array kKinds{
      Kind{"II*\0"sv, "a TIFF"},        Kind{"MM\0*"sv, "a TIFF"},       Kind{"II+\0"sv, "a TIFF"},
      Kind{"MM\0+"sv, "a TIFF"},        Kind{"CDF"sv, "netCDF"},         Kind{"\x89HDF"sv, "netCDF or HDF5"},
      Kind{"\xFF\xD8\xFF"sv, "a JPEG"}, Kind{"ncols"sv, "an ESRI grid"}, Kind{"NCOLS"sv, "an ESRI grid"}};
  const auto found = std::ranges::find_if(kKinds, [&](const Kind& kind) { return head.starts_with(kind.mark); });
  return found == kKinds.end() ? "" : found->name;
}

/// Returns the first bytes; the stream is at its start again.
std::string headOf(std::FILE* stream) {
  std::string head(8, '\0');
  head.resize(std::fread(head.data(), 1, head.size(), stream));
  std::rewind(stream);
  return head;
}

}  // namespace

core::Result<GrayImage> readGrayPng(const std::filesystem::path& file) {
  const auto stream = core::openFile(file, "a PNG");
  if (!stream) return stream.error();
  if (const std::string kind = otherKind(headOf(stream->get())); !kind.empty())
    return invalid("is " + kind + " and not a PNG; convert it with gdal_translate as docs/measured_beds.md shows");
  std::error_code error;
  if (const auto bytes = std::filesystem::file_size(file, error); error || bytes > kFileMaxBytes)
    return invalid(fmt::format("is bigger than {} bytes; choose an image of at most {} x {} pixels", kFileMaxBytes,
                               kImageSideMaxCount, kImageSideMaxCount));

  Reader reader;
  reader.stream = stream->get();
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, &fail, &ignore);
  reader.info = reader.png ? png_create_info_struct(reader.png) : nullptr;
  if (!reader.info) return core::Error{core::ErrorCode::kInternal, "libpng has no memory"};
  if (!readHeader(reader)) return invalid("cannot be read as PNG: " + reader.error);
  const bool is_gray16 = reader.bit_depth == 16 && reader.color_type == PNG_COLOR_TYPE_GRAY && !reader.is_transparent;
  if (!is_gray16) return invalid("is " + kindOf(reader) + "; save it as 16-bit grayscale");
  if (std::max(reader.image.width_count, reader.image.height_count) > kImageSideMaxCount)
    return invalid(fmt::format("is {} x {} pixels; choose at most {} x {}", reader.image.width_count,
                               reader.image.height_count, kImageSideMaxCount, kImageSideMaxCount));
  const std::size_t width = reader.image.width_count;
  const std::size_t height = reader.image.height_count;
  reader.image.values.resize(width * height);
  for (std::size_t row = 0; row < height; ++row)
    reader.rows.push_back(reinterpret_cast<png_bytep>(reader.image.values.data() + row * width));
  if (!readPixels(reader)) return invalid("cannot be read as PNG: " + reader.error);
  return std::move(reader.image);
}

}  // namespace spindrift::scene
