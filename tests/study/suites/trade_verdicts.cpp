#include "trade_verdicts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <spindrift/study/trade.h>

namespace spindrift::study_suites {
namespace {

/// Differences below this share are chance: the error of the same scene with another seed varies by this much, and so
/// does its cost on a quiet machine.
constexpr double kChance = 0.05;
constexpr const char* kSeedKnob = "seed";

/// Returns whether the row simulates the same water: not with another seed, nor with less water.
bool isComparable(const TradeRow& row) {
  return row.knob != kSeedKnob && row.knob != "coupling";
}

/// Effect of chance on cost and error: the difference between another seed and `balanced` in the same run.
study::CostAndError chanceOf(const study::CostAndError& seed, const study::CostAndError& balanced) {
  const auto share = [](double a, double b) { return std::max(kChance, 1 - std::min(a / b, b / a)); };
  return {share(seed.cost, balanced.cost), share(seed.error, balanced.error)};
}

}  // namespace

void markFront(std::vector<TradeRow>& rows) {
  study::CostAndError chance{kChance, kChance};
  for (const TradeRow& row : rows) {
    if (row.knob == kSeedKnob && row.refused.empty())
      chance = chanceOf({row.cost_ms_per_s, row.errors.height_rms_ratio},
                        {rows[1].cost_ms_per_s, rows[1].errors.height_rms_ratio});
  }
  std::vector<study::CostAndError> points;
  for (const TradeRow& row : rows) {
    const bool counts = row.refused.empty() && isComparable(row);
    points.push_back(counts ? study::CostAndError{row.cost_ms_per_s, row.errors.height_rms_ratio}
                            : study::CostAndError{HUGE_VAL, HUGE_VAL});
  }
  const std::vector<bool> front = study::paretoFront(points, chance);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].is_on_front = front[i] && std::isfinite(points[i].cost);
}

void judgeScene(const std::vector<TradeRow>& rows, SuiteResult& result, std::FILE* out) {
  const TradeRow* closest = nullptr;
  const TradeRow* finest = nullptr;
  for (const TradeRow& row : rows) {
    if (row.knob != kLevelKnob) continue;
    finest = &row;
    if (closest == nullptr || row.errors.height_rms_ratio < closest->errors.height_rms_ratio) closest = &row;
  }
  const bool holds = (1 - kChance) * finest->errors.height_rms_ratio <= closest->errors.height_rms_ratio;
  ++(holds ? result.held_count : result.missed_count);
  fmt::print(out, "  {} the closest level is {}: {:.3g} %, {}: {:.3g} % (differences of {:.0f} % are chance)\n",
             holds ? "ok  " : "MISS", closest->setting, 100 * closest->errors.height_rms_ratio, finest->setting,
             100 * finest->errors.height_rms_ratio, 100 * kChance);
}

std::vector<MeanLevel> meansOver(const std::vector<std::vector<TradeRow>>& scenes) {
  std::vector<MeanLevel> means;
  const double share = 1.0 / static_cast<double>(scenes.size());
  for (const std::vector<TradeRow>& rows : scenes) {
    const TradeRow& balanced = rows[1];
    for (const TradeRow& row : rows) {
      if (row.knob != kLevelKnob) continue;
      auto mean = std::ranges::find(means, row.setting, &MeanLevel::setting);
      if (mean == means.end()) mean = means.insert(means.end(), MeanLevel{row.setting});
      mean->cost *= std::pow(row.cost_ms_per_s / balanced.cost_ms_per_s, share);
      mean->error *= std::pow(row.errors.height_rms_ratio / balanced.errors.height_rms_ratio, share);
    }
  }
  return means;
}

void judgeLevels(const std::vector<MeanLevel>& means, SuiteResult& result, std::FILE* out) {
  fmt::print(out, "over all scenes, against balanced\n");
  double before = HUGE_VAL;
  for (const MeanLevel& mean : means) {
    const bool holds = mean.error < before;
    fmt::print(out, "  {:<20} cost x {:>6.2f}  error x {:>5.2f}{}\n", mean.setting, mean.cost, mean.error,
               holds ? "" : "  MISS: no closer than the level before");
    ++(holds ? result.held_count : result.missed_count);
    before = mean.error;
  }
}

}  // namespace spindrift::study_suites
