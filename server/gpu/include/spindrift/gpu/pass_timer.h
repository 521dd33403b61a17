// Device times of named passes, read without waiting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <spindrift/gpu/context.h>

namespace spindrift::gpu {

/// Cost of one name since the last take().
struct PassCost {
  std::string name;
  double total_ms = 0.0;          ///< of the scopes whose result has arrived
  std::uint64_t scope_count = 0;  ///< scopes whose result has arrived
};

/// Pairs of timestamp queries in a bounded ring, read when they are ready, on hardware and software alike. Timestamps
/// and not elapsed-time queries, because measured on llvmpipe 22.3 a dispatch returns when it is done: timestamps
/// around one of 126.68 ms wall time differ by 126.66 ms, while an elapsed-time query returns 0. Belongs to the
/// context's thread; must not outlive its context.
class PassTimers {
 public:
  /// `capacity_count`: scopes whose result may be outstanding; further scopes are counted but not measured.
  explicit PassTimers(Context& ctx, std::size_t capacity_count = 512);
  ~PassTimers();
  PassTimers(const PassTimers&) = delete;
  PassTimers& operator=(const PassTimers&) = delete;

  /// Measures until it is destroyed. Scopes may nest; the outer one includes the inner one.
  class [[nodiscard]] Scope {
   public:
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    friend class PassTimers;
    Scope(PassTimers& timers, std::size_t query_index) : timers_(timers), query_index_(query_index) {}
    PassTimers& timers_;
    std::size_t query_index_;
  };

  /// Measures the commands submitted until the scope ends, under `name`.
  Scope scope(std::string_view name) { return Scope(*this, openQuery(name)); }

  /// Returns costs since the last take(), in the order in which names first appeared; names without a new result are
  /// left out.
  [[nodiscard]] std::vector<PassCost> take();
  /// Returns the number of scopes that were not measured because the ring was full.
  [[nodiscard]] std::uint64_t droppedCount() const { return dropped_count_; }

 private:
  static constexpr std::size_t kNoQuery = static_cast<std::size_t>(-1);
  struct Query {
    std::uint32_t begin_id = 0;
    std::uint32_t end_id = 0;
    std::size_t name_index = 0;
    bool in_use = false;
    bool is_closed = false;
  };

  std::size_t openQuery(std::string_view name);
  void collect();

  [[maybe_unused]] Context& ctx_;  ///< for assertions
  std::vector<PassCost> costs_;
  std::vector<Query> queries_;
  std::size_t next_query_ = 0;
  std::uint64_t dropped_count_ = 0;
};

}  // namespace spindrift::gpu
