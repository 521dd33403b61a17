#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include <spindrift/core/version.h>
#include <spindrift/study_suites/suites.h>

namespace spindrift::study_suites {

void showProgress(const std::string& text) {
  if (isatty(STDERR_FILENO) == 0) return;
  fmt::print(stderr, "\r{}\033[K", text);
  std::fflush(stderr);
}

std::string journalKey(const std::string& suite, const std::string& name, const SuiteOptions& options,
                       const gpu::Context& ctx) {
  return fmt::format("{} {} {} {} {}", suite, name, options.quick ? "quick" : "full", core::version(),
                     ctx.device().name);
}

}  // namespace spindrift::study_suites
