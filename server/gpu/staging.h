// Uploads to and downloads from device memory through host-visible buffers. Private to this module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

/// Two persistently mapped buffers of 1 MiB, each made at its first use; larger transfers are split. One per context,
/// on its thread.
class Staging {
 public:
  explicit Staging(Context& ctx) : ctx_(ctx) {}
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// Copies `bytes` into the buffer. Returns before the device has finished; waits only when the whole ring is in
  /// flight. Gives up, logged and counted in Context::debugErrorCount(), when the ring cannot be mapped or the device
  /// does not finish within kLimit, and without a log line when the device was lost.
  void upload(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<const std::byte> bytes);
  /// Copies out of the buffer and waits for it. Gives up as upload() does; `bytes` is then filled with zeros.
  void download(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<std::byte> bytes);

 private:
  static constexpr std::size_t kPartBytes = std::size_t{256} << 10;
  static constexpr std::size_t kPartCount = 4;
  /// Longer than the time after which drivers reset a hanging device.
  static constexpr std::chrono::seconds kLimit{30};

  struct Ring {
    std::uint32_t id = 0;
    std::byte* mapped = nullptr;
  };
  bool prepare(Ring& ring, bool is_for_upload);
  /// Waits for a part; returns false where upload() gives up.
  bool await(Fence& fence, const char* what);

  Context& ctx_;
  Ring up_;
  Ring down_;
  std::array<Fence, kPartCount> up_fences_;  ///< fence of the last use of each part
  std::size_t up_part_ = 0;
  std::size_t up_used_bytes_ = 0;  ///< bytes used of the part `up_part_`
};

}  // namespace spindrift::gpu
