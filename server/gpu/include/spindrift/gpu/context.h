// An OpenGL 4.5 core context without a window. One thread at a time owns it; code that needs it gets it as an argument.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <spindrift/core/result.h>
#include <spindrift/gpu/checks.h>
#include <spindrift/gpu/device.h>
#include <spindrift/gpu/tuning_profile.h>

namespace spindrift::gpu {

namespace egl {
struct Attempt;
struct Handles;
}  // namespace egl
class AccessTracker;
class DispatchTimes;
struct BufferAccess;
class ProgramCache;
struct ProgramUses;
class ShaderFolder;
class Staging;

/// Kinds of access that have to see earlier shader writes; combine with |.
enum class Barrier : std::uint32_t {
  kStorage = 1,          ///< shader storage reads and writes
  kTexel = 2,            ///< texelFetch from a buffer texture
  kStorageAndTexel = 3,  ///< both; the usual barrier between two passes
  kUniform = 4,          ///< uniform blocks
  kIndirect = 8,         ///< arguments of an indirect dispatch
  kBufferUpdate = 16,    ///< upload, download, clear, copy; Buffer and ReadbackRing issue it themselves
};
constexpr Barrier operator|(Barrier a, Barrier b) {
  return static_cast<Barrier>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

/// Objects on the device now, and counters since the context was made. Tests check them per scene. The context's own
/// memory (at most 2 MiB for uploads and downloads) is not included.
struct Ledger {
  std::uint64_t buffer_count = 0;         ///< live buffers
  std::uint64_t buffer_bytes = 0;         ///< bytes of the live buffers
  std::uint64_t program_count = 0;        ///< live Program objects
  std::uint64_t dispatch_count = 0;       ///< dispatches since the start
  std::uint64_t buffers_made_count = 0;   ///< buffers ever made: constant while a room steps
  std::uint64_t programs_made_count = 0;  ///< programs compiled or read from disk: one per shader and set of defines
  std::uint64_t barrier_count = 0;        ///< barriers since the start, both barrier() and those issued by Buffer
  std::uint64_t upload_count = 0;         ///< calls that copied bytes from the host into buffers
  std::uint64_t uploaded_bytes = 0;       ///< bytes that they copied
};

/// Makes a device appear slow in tests: a fence is held back until enough later fences were inserted.
class FenceDelay {
 public:
  /// Every wait for a fence times out at once, as on a device that hangs.
  static constexpr std::uint64_t kForever = ~std::uint64_t{0};

  /// Sets how many fences the device lags behind; 0: no lag. A wait for a fence lets the device catch up to that fence.
  void set(std::uint64_t fence_count) { fence_count_ = fence_count; }

  /// Returns the number of the new fence, counted from 1. Called by Fence.
  std::uint64_t insert() {
    ++inserted_;
    if (fence_count_ <= inserted_) reached_ = std::max(reached_, inserted_ - fence_count_);
    return inserted_;
  }
  /// Returns whether the fence may pass. Called by Fence. `waits`: the caller waits for it with a timeout.
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
  /// Makes a context on the chosen device and makes it current on the calling thread. Errors: kNoDevice, listing the
  /// devices tried and what to install, when none works; kInvalidInput when SPINDRIFT_GPU_CHECKS or the file of
  /// SPINDRIFT_TUNING cannot be parsed.
  static core::Result<std::unique_ptr<Context>> create(const DeviceChoice& choice);
  /// Creates the same with the given test modes in place of those of the environment.
  static core::Result<std::unique_ptr<Context>> create(const DeviceChoice& choice, const Checks& checks);
  /// Ends the process if takeFaults() was not called after the barrier checker found faults, so that no test overlooks
  /// them.
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  /// Binds the context to the calling thread, which owns it from then on. Returns false when the driver refuses, for
  /// example because another thread has not released it. The thread's previous context is unbound.
  [[nodiscard]] bool makeCurrent();
  /// Unbinds it, so that another thread can take it with makeCurrent().
  void release();
  /// Returns whether the calling thread owns the context and it is the thread's current one.
  [[nodiscard]] bool isOwnedHere() const;

  [[nodiscard]] const DeviceInfo& device() const { return device_; }
  [[nodiscard]] const DeviceLimits& limits() const { return device_.limits; }
  [[nodiscard]] const TuningProfile& tuning() const { return tuning_; }
  /// Returns one line: which device was chosen and why.
  [[nodiscard]] const std::string& why() const { return device_.why; }

  /// Makes earlier shader writes visible to the kinds of access named in `readers`. The caller issues the barriers
  /// between passes. Buffer and ReadbackRing issue those around upload, download, clear and copy where they are needed.
  void barrier(Barrier readers);
  /// Waits until the device is done. For tests and benchmarks: the simulation never waits.
  void finish();

  /// Asks the driver whether the device was reset (GPU hang, driver update, device unplugged). Once true it stays true;
  /// the first time is logged. From then on nothing in the context is valid: fences return Fence::Status::kFailed,
  /// downloads return zeros, and all objects have to be destroyed and made again in a new context. Always false if the
  /// driver does not report resets (DeviceInfo::tells_of_resets). Costs a driver call; call it once per tick.
  [[nodiscard]] bool isLost();
  /// Makes isLost() true from now on, as after a reset by the driver. For tests.
  void simulateLoss() { is_lost_.store(true); }
  /// Returns the last result of isLost() without asking the driver. Any thread.
  [[nodiscard]] bool wasLost() const { return is_lost_.load(); }

  /// Recompiles the programs whose files in DeviceChoice::shader_folder have changed; checks at most once in 0.3 s, and
  /// does nothing without such a folder. A compile error is logged with file and line, and the old program stays in
  /// use. Headers in shared/ are also C++: changes there need a build.
  void reloadChangedShaders();

  /// Returns the number of OpenGL errors seen by the debug callback, and of refused dispatches. 0 in a healthy program.
  [[nodiscard]] std::uint64_t debugErrorCount() const { return debug_error_count_.load(); }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  /// Returns the memory that buffers can still take: that which the machine, or the control group of the process, has
  /// available where the device is software, otherwise what the driver says. None if unknown.
  [[nodiscard]] std::optional<std::uint64_t> freeMemory_bytes() const;

  // Test modes -----------------------------------------------------------------------------------------------------

  [[nodiscard]] const Checks& checks() const { return checks_; }
  /// Returns the faults that the barrier checker found since the last call: one line per distinct fault, at most 64.
  [[nodiscard]] std::vector<std::string> takeFaults();
  /// Fills every scratch buffer (BufferContent::kScratch) with set bits, as Checks::poison does at creation. For tests:
  /// the result of a tick must not depend on the earlier contents of scratch buffers.
  void poisonScratch();
  /// Returns id and name of the live buffers that a shader has written, without scratch buffers: their content may last
  /// beyond a tick.
  [[nodiscard]] std::vector<std::pair<std::uint32_t, std::string>> lastingBuffers() const;
  /// Makes the device appear slow or hanging to all users of fences. Starts with Checks::lag_fences_count.
  FenceDelay& fenceDelay() { return fence_delay_; }

  // For the other classes of this module ---------------------------------------------------------------------------

  /// Returns the ledger of this context, which Buffer and Program update.
  Ledger& ledgerEntry() { return ledger_; }
  void countError() { debug_error_count_.fetch_add(1); }
  AccessTracker& accesses() { return *accesses_; }
  Staging& staging() { return *staging_; }
  ProgramCache& programs() { return *programs_; }
  /// Returns null unless Checks::times is on.
  DispatchTimes* dispatchTimes() { return dispatch_times_.get(); }
  /// Returns the folder of shaders; null: the embedded shaders are used.
  [[nodiscard]] const ShaderFolder* shaderFolder() const { return shader_folder_.get(); }
  /// Issues the barrier that a dispatch needs; `indirect`: the buffer with its group counts, or null.
  void beforeDispatch(const ProgramUses& program, BufferAccess* indirect);
  /// Issues the barrier that an upload, download, clear or copy needs; `from` and `to` may be null.
  void beforeUpdate(BufferAccess* from, BufferAccess* to);
  /// Takes over the storage of a readback ring that was destroyed while views of it were still held. The storage is
  /// deleted once `in_use` returns false, at the latest with the context.
  void retire(std::uint32_t buffer_id, std::size_t size_bytes, std::function<bool()> in_use);
  /// Deletes retired storage that is no longer in use.
  void collectRetired();
  /// Returns whether retired storage is left.
  [[nodiscard]] bool hasRetired() const { return !retired_.empty(); }

 private:
  struct Retired {
    std::uint32_t buffer_id;
    std::size_t size_bytes;
    std::function<bool()> in_use;
  };

  Context(egl::Attempt chosen, const Checks& checks, const TuningProfile& tuning, const std::string& shader_folder);
  void issue(Barrier readers);

  std::unique_ptr<egl::Handles> egl_;
  DeviceInfo device_;
  Checks checks_;
  TuningProfile tuning_;
  std::atomic<bool> is_lost_{false};
  std::atomic<std::uint64_t> debug_error_count_{0};
  Ledger ledger_;
  FenceDelay fence_delay_;
  std::vector<Retired> retired_;
  std::unique_ptr<AccessTracker> accesses_;
  std::unique_ptr<Staging> staging_;
  std::unique_ptr<ProgramCache> programs_;
  std::unique_ptr<DispatchTimes> dispatch_times_;
  std::unique_ptr<ShaderFolder> shader_folder_;
};

}  // namespace spindrift::gpu
