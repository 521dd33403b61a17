// The suites of `spindrift-study`. Each prints its table row by row, keeps finished cases in a journal, so that a long
// run can be continued, and counts the results outside their bounds.
#pragma once

#include <cstdio>
#include <string>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>
#include <spindrift/study_suites/journal.h>

namespace spindrift::study_suites {

struct SuiteOptions {
  std::string only;  ///< run only this case; empty: all
  bool quick = false;
};

struct SuiteResult {
  boost::json::object json;
  std::size_t held_count = 0;
  std::size_t missed_count = 0;
};

core::Result<SuiteResult> studyAccuracy(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                        std::FILE* out);
core::Result<SuiteResult> studyStability(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                         std::FILE* out);
core::Result<SuiteResult> studyTrade(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                     std::FILE* out);

/// Returns the hash, in hexadecimal digits, that the trade suite writes as `state_hashes` for a scene: of its water at
/// BALANCED some ticks after its first event. Another hash means that the suite's figures are those of another solver.
core::Result<std::string> tradeStateHash(gpu::Context& ctx, const std::string& scene_name);

/// Shows what is running, on standard error if that is a terminal; an empty text clears the line.
void showProgress(const std::string& text);

/// Returns "suite name quick|full version device": everything that a result depends on.
std::string journalKey(const std::string& suite, const std::string& name, const SuiteOptions& options,
                       const gpu::Context& ctx);

}  // namespace spindrift::study_suites
