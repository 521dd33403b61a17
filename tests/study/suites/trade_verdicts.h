// What the trade suite concludes from the runs of its scenes.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include <spindrift/study_suites/suites.h>

#include "trade_rows.h"

namespace spindrift::study_suites {

/// Rows of this knob are the levels of fidelity.
inline constexpr const char* kLevelKnob = "fidelity";

/// Marks the rows of a scene that no other one beats in cost and error; the second row is BALANCED.
void markFront(std::vector<TradeRow>& rows);

/// Checks for a scene that no level is closer than REFERENCE by more than chance.
void judgeScene(const std::vector<TradeRow>& rows, SuiteResult& result, std::FILE* out);

/// A level over all scenes: geometric means of its cost and error over those of BALANCED.
struct MeanLevel {
  std::string setting;
  double cost = 1.0;
  double error = 1.0;
};

/// Returns the means of each level over the rows of each scene.
std::vector<MeanLevel> meansOver(const std::vector<std::vector<TradeRow>>& scenes);

/// Checks over all scenes that finer levels are closer.
void judgeLevels(const std::vector<MeanLevel>& means, SuiteResult& result, std::FILE* out);

}  // namespace spindrift::study_suites
