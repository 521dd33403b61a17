#include <spindrift/study/known_results.h>

#include "cases.h"

namespace spindrift::study {

const std::vector<KnownResult>& knownResults() {
  static const std::vector<KnownResult> results = {
      {"run-up of a solitary wave, H/d = 0.019, slope 1:19.85; 10 cells a depth", "closed form (NTHMP benchmark 1)",
       gentleRunUpError},
      {"run-up of a breaking solitary wave, H/d = 0.28, the same slope and cells",
       "laboratory, Synolakis 1987 (NTHMP benchmark 4)", breakingRunUpError},
      {"height of a solitary wave, H/d = 0.3, after 30 depths; 10 cells a depth", "keeps its height",
       solitaryHeightError},
      {"surface of a wave that becomes a bore, mean over the height; 8 cells a depth", "central-upwind scheme",
       boreError},
      {"surface behind a boat of 2 m at 2.2 m/s; 16 cells a boat", "exact linear waves for the same pressure",
       wakeError},
      {"leading edge of a collapsing column; 20 particles high", "Martin & Moyce 1952", damBreakError},
  };
  return results;
}

}  // namespace spindrift::study
