// The suites of `spindrift study`. Each prints its table as it grows and returns what missed.
#pragma once

#include <cstdio>

#include <boost/json/object.hpp>

#include <spindrift/core/result.h>
#include <spindrift/gpu/context.h>

#include "commands.h"
#include "study_journal.h"

namespace spindrift::app {

struct SuiteResult {
  boost::json::object json;
  std::size_t held_count = 0;
  std::size_t missed_count = 0;
};

core::Result<SuiteResult> studyAccuracy(gpu::Context& ctx, const StudyOptions& options, StudyJournal& journal,
                                        std::FILE* out);
core::Result<SuiteResult> studyStability(gpu::Context& ctx, const StudyOptions& options, StudyJournal& journal,
                                         std::FILE* out);
core::Result<SuiteResult> studyTrade(gpu::Context& ctx, const StudyOptions& options, StudyJournal& journal,
                                     std::FILE* out);

/// On standard error while it is a terminal: what is being worked on; an empty text wipes it.
void showProgress(const std::string& text);

/// "suite name quick|full version device": what a result depends on.
std::string journalKey(const std::string& suite, const std::string& name, const StudyOptions& options,
                       const gpu::Context& ctx);

}  // namespace spindrift::app
