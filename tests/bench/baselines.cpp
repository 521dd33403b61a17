#include "baselines.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include <zlib.h>

#if defined(SPINDRIFT_HAS_ZSTD)
#include <zstd.h>
#endif
#if defined(SPINDRIFT_HAS_MESHOPTIMIZER)
#include <meshoptimizer.h>
#endif
#if defined(SPINDRIFT_HAS_DRACO)
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif

namespace spindrift::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns the milliseconds that `work` takes.
template <typename Work>
double timeOf(Work work) {
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace

BaselineResult deflate(std::span<const std::uint32_t> words) {
  BaselineResult result;
  uLongf size = compressBound(words.size_bytes());
  std::vector<std::uint8_t> packed(size);
  const auto* plain = reinterpret_cast<const Bytef*>(words.data());
  result.encode_ms = timeOf([&] { compress2(packed.data(), &size, plain, words.size_bytes(), 6); });
  result.bytes = size;
  std::vector<std::uint32_t> back(words.size());
  uLongf back_size = words.size_bytes();
  result.decode_ms =
      timeOf([&] { uncompress(reinterpret_cast<Bytef*>(back.data()), &back_size, packed.data(), size); });
  result.is_exact = std::ranges::equal(back, words);
  return result;
}

#if defined(SPINDRIFT_HAS_ZSTD)
std::optional<BaselineResult> zstd(std::span<const std::uint32_t> words) {
  constexpr int kLevel = 3;
  BaselineResult result;
  std::vector<std::uint8_t> packed(ZSTD_compressBound(words.size_bytes()));
  result.encode_ms = timeOf(
      [&] { result.bytes = ZSTD_compress(packed.data(), packed.size(), words.data(), words.size_bytes(), kLevel); });
  std::vector<std::uint32_t> back(words.size());
  result.decode_ms =
      timeOf([&] { (void)ZSTD_decompress(back.data(), words.size_bytes(), packed.data(), result.bytes); });
  result.is_exact = std::ranges::equal(back, words);
  return result;
}
#else
std::optional<BaselineResult> zstd(std::span<const std::uint32_t>) {
  return std::nullopt;
}
#endif

#if defined(SPINDRIFT_HAS_MESHOPTIMIZER)
std::optional<BaselineResult> meshoptimizer(std::span<const std::uint16_t> places) {
  constexpr std::size_t kVertexBytes = 8;
  const std::size_t count = places.size() / 4;
  BaselineResult result;
  std::vector<std::uint8_t> packed(meshopt_encodeVertexBufferBound(count, kVertexBytes));
  result.encode_ms = timeOf([&] {
    result.bytes = meshopt_encodeVertexBuffer(packed.data(), packed.size(), places.data(), count, kVertexBytes);
  });
  std::vector<std::uint16_t> back(places.size());
  result.decode_ms =
      timeOf([&] { (void)meshopt_decodeVertexBuffer(back.data(), count, kVertexBytes, packed.data(), result.bytes); });
  result.is_exact = std::ranges::equal(back, places);
  return result;
}
#else
std::optional<BaselineResult> meshoptimizer(std::span<const std::uint16_t>) {
  return std::nullopt;
}
#endif

#if defined(SPINDRIFT_HAS_DRACO)
std::optional<BaselineResult> draco(std::span<const float> position_m, double quantum_m) {
  using ::draco::GeometryAttribute;
  BaselineResult result;
  float side_m = 0.0f;  // of the cube that Draco quantizes
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
    for (std::size_t i = axis; i < position_m.size(); i += 3) {
      low = std::min(low, position_m[i]);
      high = std::max(high, position_m[i]);
    }
    side_m = std::max(side_m, high - low);
  }
  const auto count = static_cast<::draco::PointIndex::ValueType>(position_m.size() / 3);
  ::draco::PointCloudBuilder builder;
  builder.Start(count);
  const int attribute = builder.AddAttribute(GeometryAttribute::POSITION, 3, ::draco::DT_FLOAT32);
  builder.SetAttributeValuesForAllPoints(attribute, position_m.data(), 0);
  const std::unique_ptr<::draco::PointCloud> cloud = builder.Finalize(false);
  ::draco::Encoder encoder;
  encoder.SetEncodingMethod(::draco::POINT_CLOUD_KD_TREE_ENCODING);
  encoder.SetSpeedOptions(5, 5);
  encoder.SetAttributeQuantization(GeometryAttribute::POSITION,
                                   static_cast<int>(std::ceil(std::log2(side_m / quantum_m + 1.0))));
  ::draco::EncoderBuffer packed;
  bool is_fine = false;
  result.encode_ms = timeOf([&] { is_fine = encoder.EncodePointCloudToBuffer(*cloud, &packed).ok(); });
  if (!is_fine) return std::nullopt;
  result.bytes = packed.size();
  ::draco::DecoderBuffer buffer;
  buffer.Init(packed.data(), packed.size());
  std::unique_ptr<::draco::PointCloud> back;
  result.decode_ms = timeOf([&] {
    ::draco::Decoder decoder;
    auto decoded = decoder.DecodePointCloudFromBuffer(&buffer);
    if (decoded.ok()) back = std::move(decoded).value();
  });
  if (!back) return std::nullopt;
  const auto* places = back->GetNamedAttribute(GeometryAttribute::POSITION);
  for (::draco::PointIndex i(0); i < back->num_points(); ++i) {
    std::array<float, 3> place{};
    places->GetMappedValue(i, place.data());
    result.position_m.insert(result.position_m.end(), place.begin(), place.end());
  }
  return result;
}
#else
std::optional<BaselineResult> draco(std::span<const float>, double) {
  return std::nullopt;
}
#endif

}  // namespace spindrift::bench
