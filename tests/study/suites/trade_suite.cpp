// The cost of accuracy: compares every choice for a scene with a run that is finer than the finest level.
#include <algorithm>
#include <cstdlib>
#include <optional>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/codec/frame_encoder.h>
#include <spindrift/core/files.h>
#include <spindrift/scene/fidelity.h>
#include <spindrift/scene/scene_loader.h>
#include <spindrift/study/known_results.h>
#include <spindrift/study/trade.h>
#include <spindrift/study/water_record.h>
#include <spindrift/study_suites/suites.h>

#include "trade_rows.h"
#include "trade_verdicts.h"

namespace spindrift::study_suites {
namespace {

/// A shipped scene and the time to simulate from its first event on.
struct TradeScene {
  const char* name;
  double seconds;
  double quick_seconds;  ///< of the quick form, which compares with REFERENCE itself; 0: not part of it
  bool has_knobs;        ///< BALANCED also runs with one setting changed
};
constexpr TradeScene kTradeScenes[] = {
    {"splash", 1.5, 0.5, true},  {"breaking_wave", 1.5, 0.0, false}, {"boat_wake", 1.5, 0.0, false},
    {"thesis", 1.0, 0.0, false}, {"dam_break", 1.2, 0.4, true},      {"harbor", 1.2, 0.0, false},
    {"beach", 3.0, 0.0, false},  {"flume", 4.0, 0.0, false},         {"boat_wake_wave", 2.0, 0.0, false}};
/// Wave cells per side of the run to judge by over those of REFERENCE. 4/3 would cost a fifth more of the whole study.
constexpr double kFinestScale = 1.25;
/// Runs shorter than this are timed three times.
constexpr double kRepeatBelow_s = 1.0;
/// Ticks of a state hash: enough for every effect to begin.
constexpr int kHashTicks = 20;
constexpr v1::Fidelity kLevels[] = {v1::FIDELITY_DRAFT, v1::FIDELITY_BALANCED, v1::FIDELITY_FINE,
                                    v1::FIDELITY_REFERENCE};
/// Each shipped effect as it is, with the wave alone, and with particles alone (thesis, section 3.8.1).
constexpr const char* kEffects[] = {"splash", "breaking_wave", "boat_wake"};

/// Counts the bytes that the room's encoder would send.
study::FrameBytes frameBytes() {
  auto encoder = std::make_shared<codec::FrameEncoder>();
  return [encoder](const core::FrameView& frame) {
    std::size_t bytes = 0;
    for (const v1::Layer layer : {v1::LAYER_SURFACE, v1::LAYER_PARTICLES, v1::LAYER_FOAM, v1::LAYER_BODIES}) {
      if (const auto message = encoder->encode(layer, frame)) bytes += message->size();
    }
    return bytes;
  };
}

core::Result<core::Scene> loadLevel(const std::string& name, v1::Fidelity level) {
  auto file = core::findScene(name);
  if (!file) return file.error();
  auto scene = scene::loadSceneFile(*file, level);
  if (!scene) return scene.error();
  core::Scene out = scene::toCore(*scene);
  if (out.events.empty()) return out;
  // Level water before the first event costs time and tells nothing.
  const double first_s = std::ranges::min(out.events, {}, &core::TimedEvent::at_s).at_s;
  for (core::TimedEvent& event : out.events) event.at_s -= first_s;
  return out;
}

core::Result<std::vector<TradeChoice>> levelsOf(const TradeScene& scene) {
  std::vector<TradeChoice> choices;
  for (const v1::Fidelity level : kLevels) {
    auto loaded = loadLevel(scene.name, level);
    if (!loaded) return loaded.error();
    choices.push_back({kLevelKnob, scene::fidelityName(level), *std::move(loaded)});
  }
  return choices;
}

/// Returns the levels first, then BALANCED with a simpler wave, then with one change each.
core::Result<std::vector<TradeChoice>> choicesOf(const TradeScene& scene, bool quick) {
  auto choices = levelsOf(scene);
  if (!choices || quick) return choices;
  const core::Scene balanced = (*choices)[1].scene;
  for (TradeChoice& simpler : study::simplerWaves(balanced)) choices->push_back(std::move(simpler));
  if (!scene.has_knobs) return choices;
  for (TradeChoice& knob : study::singleKnobs(balanced)) choices->push_back(std::move(knob));
  return choices;
}

double secondsOf(const TradeScene& scene, bool quick) {
  return quick ? scene.quick_seconds : scene.seconds;
}

/// Runs what is not yet in the journal; the finest run only if there is something left to compare.
class TradeRuns {
 public:
  TradeRuns(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal)
      : ctx_(ctx), options_(options), journal_(journal) {}

  core::Result<std::vector<TradeRow>> run(const TradeScene& scene) {
    auto choices = choicesOf(scene, options_.quick);
    if (!choices) return choices.error();
    // The quick form compares with the finest level, the full form with a run that is finer still.
    core::Scene finest_scene = (*choices)[3].scene;
    if (options_.quick)
      choices->resize(3);
    else
      finest_scene = study::finerThan(finest_scene, kFinestScale);
    return compare(scene, *choices, finest_scene);
  }

  /// Errors of each known result, level by level.
  core::Result<boost::json::array> known() {
    boost::json::array out;
    for (const study::KnownResult& result : study::knownResults()) {
      boost::json::array errors;
      for (const study::LevelScale& level : study::kLevelScales) {
        const std::string key =
            journalKey("trade", fmt::format("{}/{}/{}", result.name, level.name, all_hashes_), options_, ctx_);
        if (const auto kept = journal_.find(key)) {
          errors.push_back(*kept);
          continue;
        }
        showProgress(fmt::format("{}: {}", result.name, level.name));
        const auto error_ratio = result.error_ratio(ctx_, level);
        if (!error_ratio)
          return core::Error{error_ratio.error().code, result.name + ": " + error_ratio.error().message};
        if (auto added = journal_.add(key, *error_ratio); !added) return added.error();
        errors.push_back(*error_ratio);
      }
      out.push_back({{"name", result.name}, {"source", result.source}, {"error_ratio", std::move(errors)}});
    }
    showProgress("");
    return out;
  }

  /// Hash of the water of every scene. A journal's results count for this solver only.
  core::Result<boost::json::object> hashes() {
    boost::json::object out;
    for (const TradeScene& scene : kTradeScenes) {
      auto hash = tradeStateHash(ctx_, scene.name);
      if (!hash) return core::Error{hash.error().code, std::string(scene.name) + ": " + hash.error().message};
      all_hashes_ += hash->substr(0, 4);
      out[scene.name] = *std::move(hash);
    }
    return out;
  }

  /// Costs of scenes, without comparing their results.
  core::Result<std::vector<TradeRow>> costs(const std::vector<TradeChoice>& choices, double seconds) {
    std::vector<TradeRow> rows;
    for (const TradeChoice& choice : choices) {
      const std::string key =
          journalKey("trade", fmt::format("cost/{}/{}/{}", choice.knob, choice.setting, all_hashes_), options_, ctx_);
      if (const auto known = journal_.find(key)) {
        rows.push_back(rowFromJson(known->as_object()));
        continue;
      }
      showProgress(fmt::format("cost: {} {}", choice.knob, choice.setting));
      auto made = study::record(ctx_, choice.scene,
                                {.seconds = seconds,
                                 .sample_interval_s = 0.1,
                                 .has_samples = false,
                                 .frame_bytes = {},
                                 .repeat_below_s = kRepeatBelow_s});
      if (!made) return made.error();
      rows.push_back(rowOf(choice, *made));
      if (auto kept = journal_.add(key, toJson(rows.back())); !kept) return kept.error();
    }
    showProgress("");
    return rows;
  }

 private:
  core::Result<std::vector<TradeRow>> compare(const TradeScene& scene, const std::vector<TradeChoice>& choices,
                                              const core::Scene& finest_scene) {
    const std::string name = scene.name;
    const study::RecordOptions record{.seconds = secondsOf(scene, options_.quick),
                                      .sample_interval_s = 0.1,
                                      .frame_bytes = frameBytes(),
                                      .repeat_below_s = kRepeatBelow_s};
    std::vector<TradeRow> rows;
    std::optional<WaterRecord> finest_run;
    for (std::size_t i = 0; i < choices.size(); ++i) {
      const TradeChoice& choice = choices[i];
      const std::string key = journalKey(
          "trade", fmt::format("{}/{}/{}/{} s/{}", name, choice.knob, choice.setting, record.seconds, all_hashes_),
          options_, ctx_);
      if (const auto known = journal_.find(key)) {
        rows.push_back(rowFromJson(known->as_object()));
        continue;
      }
      if (!finest_run) {
        showProgress(fmt::format("{}: the run to judge by", name));
        auto finest = study::record(ctx_, finest_scene, record);
        if (!finest) return core::Error{finest.error().code, name + ": " + finest.error().message};
        finest_run = *std::move(finest);
      }
      showProgress(fmt::format("{}: [{}/{}] {} {}", name, i + 1, choices.size(), choice.knob, choice.setting));
      auto made = study::record(ctx_, choice.scene, record);
      TradeRow row;
      if (made) {
        row = rowOf(choice, *made);
        row.errors = study::compare(*made, *finest_run, choice.scene);
      } else if (made.error().code == core::ErrorCode::kInvalidInput) {
        row.knob = choice.knob;
        row.setting = choice.setting;
        row.refused = made.error().message;
      } else {
        return made.error();
      }
      if (auto kept = journal_.add(key, toJson(row)); !kept) return kept.error();
      rows.push_back(std::move(row));
    }
    showProgress("");
    markFront(rows);
    return rows;
  }

  gpu::Context& ctx_;
  const SuiteOptions& options_;
  StudyJournal& journal_;
  std::string all_hashes_;  ///< empty: hashes() was not called
};

}  // namespace

core::Result<std::string> tradeStateHash(gpu::Context& ctx, const std::string& scene_name) {
  auto scene = loadLevel(scene_name, v1::FIDELITY_BALANCED);
  if (!scene) return scene.error();
  const auto hash = study::stateHashAfter(ctx, *scene, kHashTicks);
  if (!hash) return hash.error();
  return fmt::format("{:016x}", *hash);
}

core::Result<SuiteResult> studyTrade(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                     std::FILE* out) {
  SuiteResult result;
  TradeRuns runs(ctx, options, journal);
  if (!options.quick) {
    auto hashes = runs.hashes();
    if (!hashes) return hashes.error();
    result.json["state_hashes"] = *std::move(hashes);
  }
  boost::json::array json_scenes;
  bool found = false;
  std::vector<std::vector<TradeRow>> all_rows;
  for (const TradeScene& scene : kTradeScenes) {
    if (options.quick && scene.quick_seconds == 0.0) continue;
    if (!options.only.empty() && options.only != scene.name) continue;
    found = true;
    fmt::print(out, "{}, {} s, against {}; * = not beaten in cost and height both\n", scene.name,
               secondsOf(scene, options.quick), options.quick ? "reference" : "a run finer than reference");
    std::fflush(out);
    auto rows = runs.run(scene);
    if (!rows) return core::Error{rows.error().code, std::string(scene.name) + ": " + rows.error().message};
    printTradeHeader(out);
    for (const TradeRow& row : *rows) print(out, row, (*rows)[1]);
    judgeScene(*rows, result, out);
    all_rows.push_back(*rows);
    std::fflush(out);
    json_scenes.push_back(
        {{"scene", scene.name}, {"seconds", secondsOf(scene, options.quick)}, {"rows", toJson(*rows)}});
  }
  result.json["scenes"] = std::move(json_scenes);
  if (all_rows.size() > 1) {
    const std::vector<MeanLevel> means = meansOver(all_rows);
    judgeLevels(means, result, out);
    boost::json::array json_means;
    for (const MeanLevel& mean : means)
      json_means.push_back({{"setting", mean.setting}, {"cost_ratio", mean.cost}, {"error_ratio", mean.error}});
    result.json["over_all_scenes"] = std::move(json_means);
  }

  if (!options.quick && (options.only.empty() || options.only == "known")) {
    found = true;
    fmt::print(out, "error against theory or experiment at draft, balanced, fine, reference\n");
    std::fflush(out);
    auto known = runs.known();
    if (!known) return known.error();
    for (const boost::json::value& one : *known) {
      fmt::print(out, "  {:<80}", std::string(one.at("name").as_string()));
      for (const boost::json::value& error : one.at("error_ratio").as_array())
        fmt::print(out, " {:>7.3g}", 100 * error.to_number<double>());
      fmt::print(out, " %\n");
    }
    result.json["known"] = *std::move(known);
  }

  if (!options.quick && (options.only.empty() || options.only == "cost")) {
    found = true;
    fmt::print(out, "cost of particles, waves and both, and of the effects in each form\n");
    std::fflush(out);
    auto sweep = runs.costs(study::costSweep(), 0.25);
    if (!sweep) return sweep.error();
    std::vector<TradeChoice> effects;
    for (const std::string effect : kEffects) {
      for (const char* form : {"", "_wave", "_particles"}) {
        auto scene = loadLevel(effect + form, v1::FIDELITY_BALANCED);
        if (!scene) return scene.error();
        effects.push_back({effect, *form == '\0' ? "coupled" : form + 1, *std::move(scene)});
      }
    }
    auto shown = runs.costs(effects, 1.0);
    if (!shown) return shown.error();
    sweep->insert(sweep->end(), shown->begin(), shown->end());
    printCosts(out, *sweep);
    result.json["costs"] = toJson(*sweep);
  }
  if (!found) {
    return core::Error{core::ErrorCode::kInvalidInput, "--case: there is no '" + options.only + "'" +
                                                           (options.quick ? " in the quick form" : "") +
                                                           "; choose one of splash, breaking_wave, boat_wake, thesis, "
                                                           "dam_break, harbor, beach, flume, boat_wake_wave, "
                                                           "known, cost"};
  }
  return result;
}

}  // namespace spindrift::study_suites
