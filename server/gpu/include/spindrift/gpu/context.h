// One OpenGL 4.5 core context without a window, owned by one thread at a time and passed to whoever needs it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/checks.h>
#include <spindrift/gpu/device.h>

namespace spindrift::gpu {

class AccessTracker;
class ProgramCache;
class ShaderFolder;
class Staging;

/// What the next reader of shader writes is going to be; combine with |.
enum class Barrier : std::uint32_t {
  kStorage = 1,          ///< shader storage reads and writes
  kTexel = 2,            ///< texelFetch from a buffer texture
  kStorageAndTexel = 3,  ///< both: the usual one between two passes
  kUniform = 4,          ///< uniform blocks
  kIndirect = 8,         ///< arguments of an indirect dispatch
  kBufferUpdate = 16,    ///< upload, download, clear, copy; Buffer and ReadbackRing issue it themselves
};
constexpr Barrier operator|(Barrier a, Barrier b) {
  return static_cast<Barrier>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// What lives on the device now, and what happened since the context was made. Tests count it per scene. The context's
/// own memory (at most 8 MiB for uploads and downloads) is not in it.
struct Ledger {
  std::uint64_t buffer_count = 0;         ///< live buffers
  std::uint64_t buffer_bytes = 0;         ///< bytes of the live buffers
  std::uint64_t program_count = 0;        ///< live Program objects
  std::uint64_t dispatch_count = 0;       ///< dispatches since the start
  std::uint64_t buffers_made_count = 0;   ///< buffers ever made: constant while a room steps
  std::uint64_t programs_made_count = 0;  ///< programs ever compiled: one per shader and set of defines
  std::uint64_t barrier_count = 0;        ///< barriers since the start, both barrier() and those issued by Buffer
  std::uint64_t upload_count = 0;         ///< calls that copied bytes from the host into buffers
  std::uint64_t uploaded_bytes = 0;       ///< bytes that they copied
};

/// A slow device for tests, on top of the real one: a fence is held back until enough later ones were inserted.
class FenceDelay {
 public:
  /// Waits for a fence time out at once: a device that hangs.
  static constexpr std::uint64_t kForever = ~std::uint64_t{0};

  /// From now on the device lags this many fences behind; a wait for a fence lets it catch up to that one. 0: no lag.
  void set(std::uint64_t fence_count) { fence_count_ = fence_count; }

  /// Called by Fence: the number of a new fence, counted from 1.
  std::uint64_t insert() {
    ++inserted_;
    if (fence_count_ <= inserted_) reached_ = std::max(reached_, inserted_ - fence_count_);
    return inserted_;
  }
  /// Called by Fence: whether the fence may pass. `waits`: the caller gave it time.
  bool passes(std::uint64_t number, bool waits) {
    if (fence_count_ == 0 || (waits && fence_count_ != kForever)) reached_ = std::max(reached_, number);
    return number <= reached_;
  }

 private:
  std::uint64_t fence_count_ = 0;
  std::uint64_t inserted_ = 0;
  std::uint64_t reached_ = 0;  ///< fences up to this number may pass
};

/// Buffers, programs, timers, fences and rings refer to their context and must be destroyed before it, on its thread.
class Context {
 public:
  /// Makes a context on the chosen device and makes it current on the calling thread. Error kNoDevice, with what was
  /// tried and what to install, when nothing works; kInvalidInput when SPINDRIFT_GPU_CHECKS cannot be read.
  static core::Result<std::unique_ptr<Context>> create(const DeviceChoice& choice);
  /// The same with the given test modes instead of those of the environment.
  static core::Result<std::unique_ptr<Context>> create(const DeviceChoice& choice, const Checks& checks);
  /// Ends the process when faults of the barrier checker were not taken, so that no test can overlook them.
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

  /// Makes shader writes so far visible to the readers named. Barriers between passes are the caller's; those around
  /// upload, download, clear and copy are issued by Buffer and ReadbackRing where a shader's access makes them
  /// necessary.
  void barrier(Barrier readers);
  /// Hands queued work to the device; does not wait.
  void flush();
  /// Waits until the device is done. For tests and benchmarks: the simulation never waits.
  void finish();

  /// Asks the driver whether the device was reset (GPU hang, driver update, device unplugged). Once true it stays true,
  /// and the first time is logged. Afterwards nothing that the context holds is valid: fences answer
  /// Fence::Status::kFailed, downloads give zeros, and everything made in the context has to be destroyed and made anew
  /// in a new one. Stays false where the driver does not report resets (DeviceInfo::tells_of_resets). Costs a driver
  /// call; ask once per tick.
  [[nodiscard]] bool isLost();
  /// For tests: isLost() is true from now on, as after a reset by the driver.
  void simulateLoss() { is_lost_.store(true); }
  /// What isLost() last answered, without asking the driver. Any thread.
  [[nodiscard]] bool wasLost() const { return is_lost_.load(); }

  /// Compiles the programs anew whose files in DeviceChoice::shader_folder changed since the last look, at most one look
  /// in 0.3 s; does nothing without such a folder. What does not compile is logged with file and line, and the program
  /// goes on as it was. Headers in shared/ are C++ as well: what changes there needs a build.
  void reloadChangedShaders();

  /// OpenGL errors seen by the debug callback, and refused dispatches. 0 in a healthy program.
  [[nodiscard]] std::uint64_t debugErrorCount() const { return debug_error_count_.load(); }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }

  // Test modes -----------------------------------------------------------------------------------------------------

  [[nodiscard]] const Checks& checks() const { return checks_; }
  /// What the barrier checker found since the last call, one line per fault, each different one once and at most 64.
  [[nodiscard]] std::vector<std::string> takeFaults();
  /// Fills every scratch buffer (BufferContent::kScratch) with set bits, as Checks::poison does when they are made. For
  /// tests: what a tick computes must not depend on what scratch buffers held before it.
  void poisonScratch();
  /// Makes the device look slow or hanging to everybody who asks fences. Checks::lag_fences_count is where it begins.
  FenceDelay& fenceDelay() { return fence_delay_; }

  // For the other classes of this module ---------------------------------------------------------------------------

  /// Written by Buffer and Program.
  Ledger& ledgerEntry() { return ledger_; }
  void countError() { debug_error_count_.fetch_add(1); }
  AccessTracker& accesses() { return *accesses_; }
  Staging& staging() { return *staging_; }
  ProgramCache& programs() { return *programs_; }
  /// Null: shaders are the embedded ones.
  [[nodiscard]] const ShaderFolder* shaderFolder() const { return shader_folder_.get(); }
  /// Issues the barrier with these OpenGL bits; nothing for 0.
  void barrierBits(std::uint32_t bits);
  /// Takes over the storage of a readback ring that was destroyed while views of it were still held; it is deleted once
  /// `in_use` says false, at the latest with the context.
  void retire(std::uint32_t buffer_id, std::size_t size_bytes, std::function<bool()> in_use);
  /// Deletes retired storage that nobody reads any more.
  void collectRetired();
  /// Whether some is left.
  [[nodiscard]] bool hasRetired() const { return !retired_.empty(); }
  /// True the first time that the driver says the message with this id (at most 64 ids are remembered, further ones are
  /// never new). Any thread.
  bool isNewMessage(std::uint32_t id);

 private:
  struct Egl;  // the EGL handles, kept out of the header
  struct Messages;
  struct Retired {
    std::uint32_t buffer_id;
    std::size_t size_bytes;
    std::function<bool()> in_use;
  };

  Context(std::unique_ptr<Egl> egl, DeviceInfo device, std::string why, const Checks& checks,
          const std::string& shader_folder);

  std::unique_ptr<Egl> egl_;
  DeviceInfo device_;
  std::string why_;
  Checks checks_;
  std::atomic<bool> is_lost_{false};
  std::atomic<std::uint64_t> debug_error_count_{0};
  Ledger ledger_;
  FenceDelay fence_delay_;
  std::vector<Retired> retired_;
  std::unique_ptr<Messages> messages_;
  std::unique_ptr<AccessTracker> accesses_;
  std::unique_ptr<Staging> staging_;
  std::unique_ptr<ProgramCache> programs_;
  std::unique_ptr<ShaderFolder> shader_folder_;
};

}  // namespace spindrift::gpu
