// Uploads to and downloads from buffers that live in device memory, through memory that the processor sees. Private to
// this module.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <spindrift/gpu/context.h>
#include <spindrift/gpu/fence.h>

namespace spindrift::gpu {

/// Two persistently mapped buffers of 4 MiB, each made at its first use; larger transfers go in parts. One per context,
/// on its thread.
class Staging {
 public:
  explicit Staging(Context& ctx) : ctx_(ctx) {}
  ~Staging();
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  /// Copies `bytes` into the buffer. Returns before the device has done it; waits only when all of the ring is still on
  /// its way. False, logged and counted in Context::debugErrorCount(), when the ring cannot be mapped or the device
  /// does not take the data within kLimit; false without either when the device was lost.
  bool upload(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<const std::byte> bytes);
  /// Copies out of the buffer and waits for it. False as above; `bytes` is then filled with zeros.
  bool download(std::uint32_t buffer_id, std::size_t offset_bytes, std::span<std::byte> bytes);

 private:
  static constexpr std::size_t kPartBytes = std::size_t{1} << 20;
  static constexpr std::size_t kPartCount = 4;
  /// Longer than any driver lets a program run before it resets the device.
  static constexpr std::chrono::seconds kLimit{30};

  struct Ring {
    std::uint32_t id = 0;
    std::byte* mapped = nullptr;
  };
  bool prepare(Ring& ring, bool is_for_upload);
  /// Waits for a part; false as upload().
  bool await(Fence& fence, const char* what);

  Context& ctx_;
  Ring up_;
  Ring down_;
  std::array<Fence, kPartCount> up_fences_;  ///< of the last use of each part
  std::size_t up_part_ = 0;
  std::size_t up_used_bytes_ = 0;  ///< of the part `up_part_`
};

}  // namespace spindrift::gpu
