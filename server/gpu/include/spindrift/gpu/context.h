// One OpenGL 4.5 core context without a window, owned by one thread at a time and passed to whoever needs it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/device.h>

namespace spindrift::gpu {

/// What the next reader of shader writes is going to be; combine with |.
enum class Barrier : std::uint32_t {
  kStorage = 1,          ///< shader storage reads and writes
  kTexel = 2,            ///< texelFetch from a buffer texture
  kStorageAndTexel = 3,  ///< both: the usual one between two passes
  kUniform = 4,          ///< uniform blocks
  kIndirect = 8,         ///< arguments of an indirect dispatch
  kBufferUpdate = 16,    ///< upload, download, clear, copy
};
constexpr Barrier operator|(Barrier a, Barrier b) {
  return static_cast<Barrier>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// What lives on the device now, and what happened since the context was made. Tests count it per scene.
struct Ledger {
  std::uint64_t buffer_count = 0;         ///< live buffers
  std::uint64_t buffer_bytes = 0;         ///< bytes of the live buffers
  std::uint64_t program_count = 0;        ///< live programs
  std::uint64_t dispatch_count = 0;       ///< dispatches since the start
  std::uint64_t buffers_made_count = 0;   ///< buffers ever made: constant while a room steps
  std::uint64_t programs_made_count = 0;  ///< programs ever compiled
};

/// Buffers, programs, timers and rings refer to their context and must be destroyed before it, on its thread.
class Context {
 public:
  /// Makes a context on the chosen device and makes it current on the calling thread. Error kNoDevice, with what was
  /// tried and what to install, when nothing works.
  static core::Result<std::unique_ptr<Context>> create(const DeviceChoice& choice);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Binds the context to the calling thread, which owns it from then on; false when the driver refuses (for example
  /// because another thread has not released it). A thread has one current context: the one before is unbound.
  [[nodiscard]] bool makeCurrent();
  /// Unbinds it, so that another thread can take it with makeCurrent().
  void release();
  /// Whether the calling thread owns the context and no other context has taken its place there.
  [[nodiscard]] bool isOwnedHere() const;

  [[nodiscard]] const DeviceInfo& device() const { return device_; }
  [[nodiscard]] const DeviceLimits& limits() const { return device_.limits; }
  /// One line: which device was chosen and why.
  [[nodiscard]] const std::string& why() const { return why_; }

  /// Makes shader writes so far visible to the readers named. Barriers between passes are the caller's.
  void barrier(Barrier readers);
  /// Hands queued work to the device; does not wait.
  void flush();
  /// Waits until the device is done. For tests and benchmarks: the simulation never waits.
  void finish();

  /// OpenGL errors seen by the debug callback, and refused dispatches. 0 in a healthy program.
  [[nodiscard]] std::uint64_t debugErrorCount() const { return debug_error_count_.load(); }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }

  // For the other classes of this room ---------------------------------------------------------------------------

  /// Written by Buffer and Program.
  Ledger& ledgerEntry() { return ledger_; }
  void countError() { debug_error_count_.fetch_add(1); }
  /// Takes over the storage of a readback ring that was destroyed while views of it were still held; it is deleted once
  /// `in_use` says false, at the latest with the context.
  void retire(std::uint32_t buffer_id, std::size_t size_bytes, std::function<bool()> in_use);
  /// Deletes retired storage that nobody reads any more.
  void collectRetired();
  /// Whether some is left.
  [[nodiscard]] bool hasRetired() const { return !retired_.empty(); }

 private:
  struct Egl;  // the EGL handles, kept out of the header
  struct Retired {
    std::uint32_t buffer_id;
    std::size_t size_bytes;
    std::function<bool()> in_use;
  };

  Context(std::unique_ptr<Egl> egl, DeviceInfo device, std::string why);

  std::unique_ptr<Egl> egl_;
  DeviceInfo device_;
  std::string why_;
  std::atomic<std::uint64_t> debug_error_count_{0};
  Ledger ledger_;
  std::vector<Retired> retired_;
};

}  // namespace spindrift::gpu
