// A disk that takes no more, for a moment.
#pragma once

#include <csignal>

#include <sys/resource.h>

namespace spindrift::test {

/// Files of this process cannot grow beyond `bytes` while this lives.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit bound{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &bound);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

/// A FullDisk on which the files of snapshots cannot be written, but those of logs can.
inline constexpr rlim_t kLogsOnly = 4096;

}  // namespace spindrift::test
